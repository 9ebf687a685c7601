/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/explain_answer.h"

#include <math.h>
#include <stdio.h>

#include "cli/options/answer.h"
#include "print/print.h"
#include "review/output/case_json.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/interval_text.h"
#include "text/json_text.h"

#define BAR 40 /* letters of the longest in the spectrum */

/* ---- a chain as bounces ------------------------------------------------------------------ */

/* One thing that a chain of objects does with light, in the order of the eye's ray. */
typedef struct Bounce {
    const char *what;
    int part_id;
    bool has_place;
    Vec3 at; /* on one of the chain's paths */
} Bounce;

/* A chain as it is told: of an answer about a scene. */
typedef struct LightWay {
    Bounce bounce[2 * CHAIN_STEPS + 2];
    int count;
    const char *light; /* as the scene has it */
    bool has_from;     /* the light is near: */
    Vec3 from;         /* where that path met it */
} LightWay;

static void add_bounce(LightWay *way, const char *what, int part_id, const Vec3 *at) {
    if (part_id == NO_ID) return;
    Bounce *bounce = &way->bounce[way->count++];
    *bounce = (Bounce){.what = what, .part_id = part_id, .has_place = at != NULL};
    if (at) bounce->at = *at;
}

static bool is_distant(const Scene *scene, const ChainKey *key) {
    if (key->source == LIGHTS_EMITTERS) return false;
    return key->source != LIGHTS_PUNCTUAL ||
           scene->lights[key->source_id].kind == LIGHT_DIRECTIONAL;
}

static LightWay way_of(const ExplainAnswer *answer, const Chain *chain) {
    static const char *const events[] = {"scatters", "mirror", "refracts"}; /* PathEvent */
    const Scene *scene = answer->found.chains.scene;
    const ChainKey *key = &chain->key;
    const ChainRay *ray = chain->ray_count ? &chain->rays[0] : NULL;
    int group = light_group_of(&answer->lights, (LightSet)key->source, key->source_id);
    LightWay way = {.light = answer->lights.said[group]};
    for (int i = 0; i < key->count; i++) {
        add_bounce(&way, "passes", key->link[i].pane_id, NULL);
        add_bounce(&way, events[key->link[i].event], key->link[i].part_id,
                   ray ? &ray->point[i + 1] : NULL);
    }
    add_bounce(&way, "passes", key->pane_id, NULL);
    way.has_from = ray && !ray->is_cut && !is_distant(scene, key);
    if (way.has_from) way.from = ray->point[ray->count - 1];
    return way;
}

/* ---- as text ----------------------------------------------------------------------------- */

static void print_where(const ExplainAnswer *answer) {
    const ReviewCase *c = &answer->found.of;
    if (answer->found.has_pixel)
        print("pixel      %d,%d of %dx%d, %ld paths\n", answer->pixel[0], answer->pixel[1],
              answer->size[0], answer->size[1], answer->found.paths);
    if (c->symbol)
        print("symbol     %s on %s, seen by %s, %s\n", c->symbol, c->display, c->eye, c->condition);
    else if (c->display) print("display    %s\n", c->display);
    print("eye        %.3f, %.3f, %.3f m\n", c->eye_m[0], c->eye_m[1], c->eye_m[2]);
}

static void print_pixel(const PixelLight *light) {
    const PixelFigure *xyz = light->xyz;
    double sum = xyz[0].mean + xyz[1].mean + xyz[2].mean;
    print("luminance  %.5g cd/m2, standard error %.2g", xyz[1].mean, xyz[1].sigma);
    if (sum > 0) print("; x %.4f, y %.4f", xyz[0].mean / sum, xyz[1].mean / sum);
    print("\n");
}

static void print_light(const Explained *explained, Arena scratch) {
    const ReviewCase *c = &explained->of;
    const CaseLuminances *l = &c->luminance_cd_m2;
    if (explained->has_pixel) print_pixel(&explained->light);
    if (c->symbol)
        print("sends      %.4g cd/m2 foreground, %.4g background\n", l->foreground, l->background);
    else if (c->display)
        print("sends      %.4g cd/m2; white %.4g, black %.4g\n", explained->shown, l->foreground,
              l->background);
    if (!explained->has_pixel || c->display)
        print(
            "%-10s %s cd/m2", c->display ? "reflected" : "luminance",
            interval_text(l->reflected, c->reflected_range.low, c->reflected_range.high, &scratch));
    if (c->display)
        print(": mirror %.4g, scattered %.4g\n"
              "contrast   %s : 1; %.4g : 1 if nothing were reflected",
              l->mirror, l->scattered,
              interval_text(c->contrast_ratio, c->contrast_low, c->contrast_high, &scratch),
              luminance_contrast(l->foreground, l->background, 0));
    if (!explained->has_pixel || c->display) print("\n");
}

/* Of a review's case: the quantity of the limit that decides it. */
static void print_judged(const ReviewCase *c, Arena scratch) {
    const LimitVerdict *limit = case_worst_limit(c);
    if (!limit) return;
    print("judged     %s: %s %s, required %s\n", verdict_names[c->verdict], words_kind(limit),
          words_measured(limit, &scratch), words_required(limit, &scratch));
}

/* Each adds up to all of the light. */
static void print_groups(const ReviewCase *c) {
    static const char *const NAMES[CAUSE_GROUPS] = {"began at", "came by", "met at"};
    for (int g = 0; g < CAUSE_GROUPS; g++) {
        const CaseGroup *group = &c->groups[g];
        if (group->count && g) print("\n");
        for (int i = 0; i < group->count; i++)
            print("%s%.3g %% %s", i ? ", " : "", 100 * group->list[i].share, group->list[i].what);
        if (group->count) print(" (%s)", NAMES[g]);
    }
    print("\n");
}

static void print_place(const Scene *scene, Vec3 p) {
    double at[3];
    world_from_scene(scene->origin, p, at);
    print("  at %.3f, %.3f, %.3f m", at[0], at[1], at[2]);
}

/* A line for each thing that the eye's ray meets before the light. */
static void print_bounces(const ExplainAnswer *answer, const Chain *chain, int indent,
                          Arena scratch) {
    const Scene *scene = answer->found.chains.scene;
    LightWay way = way_of(answer, chain);
    print("  %s\n", way.light);
    for (int i = 0; i < way.count; i++) {
        const Bounce *bounce = &way.bounce[i];
        print("%*d %-8s %s", indent, i + 1, bounce->what,
              chain_part_words(scene, bounce->part_id, &scratch));
        if (bounce->has_place) print_place(scene, bounce->at);
        print("\n");
    }
    if (chain->key.is_longer) print("%*s further surfaces\n", indent, "");
    if (!way.has_from) return;
    print("%*s begins ", indent, "");
    print_place(scene, way.from);
    print("\n");
}

static void print_cause(const ExplainAnswer *answer, int index, bool has_contrast, Arena scratch) {
    const Explained *found = &answer->found;
    const CaseCause *cause = &found->of.causes[index];
    print("%6.1f %%  %8s  %8s to %-8s", 100 * cause->share,
          words_within(cause->cd_m2, cause->low, cause->high, &scratch),
          words_within(cause->low, cause->low, cause->high, &scratch),
          words_within(cause->high, cause->low, cause->high, &scratch));
    if (has_contrast && isnan(cause->contrast_without)) print("  %11s", "");
    else if (has_contrast) print("  %7.3g : 1", cause->contrast_without);
    if (found->has_pixel && index < found->chains.count) {
        print_bounces(answer, &found->chains.list[index], has_contrast ? 54 : 41, scratch);
        return;
    }
    for (int i = 0; i < cause->links; i++) print("%s%s", i ? " > " : "  ", cause->chain[i]);
    print("\n");
}

static void print_causes(const ExplainAnswer *answer, Arena scratch) {
    const ReviewCase *c = &answer->found.of;
    bool has_contrast = c->display != NULL;
    if (!c->cause_count) return;
    print("\n   share     cd/m2   95 %% interval     %s  %s\n", has_contrast ? "without it " : "",
          answer->found.has_pixel ? "light, and what the eye's ray meets before it" : "via");
    for (int i = 0; i < c->cause_count; i++) print_cause(answer, i, has_contrast, scratch);
}

static void print_remedies(const ReviewCase *c, Arena scratch) {
    if (c->remedy_count) print("\n");
    for (int i = 0; i < c->remedy_count; i++)
        print("remedy     %s: %s\n", c->remedies[i].what, words_remedy(&c->remedies[i], &scratch));
}

static int band_center_nm(int band) {
    return PIXEL_FIRST_NM + PIXEL_BAND_NM * band + PIXEL_BAND_NM / 2;
}

static void print_spectrum(const PixelLight *light) {
    double most = 0;
    for (int i = 0; i < PIXEL_BANDS; i++) most = fmax(most, light->radiance[i].mean);
    if (!(most > 0)) return;
    print("\n    nm  W m-2 sr-1 nm-1      error\n");
    for (int i = 0; i < PIXEL_BANDS; i++) {
        const PixelFigure *figure = &light->radiance[i];
        int length = (int)(BAR * fmax(figure->mean, 0) / most + 0.5);
        print("%6d  %15.4g  %9.2g  %.*s\n", band_center_nm(i), figure->mean, figure->sigma, length,
              "########################################");
    }
}

static void print_text(const ExplainAnswer *answer, Arena *arena) {
    const Explained *explained = &answer->found;
    const ReviewCase *c = &explained->of;
    print_where(answer);
    if (c->hider_count) print("hidden     %s\n", words_hiders(c, arena));
    if (!case_is_seen(c)) {
        print("%s\n", words_reason(c, arena));
        return;
    }
    print_light(explained, *arena);
    print_judged(c, *arena);
    print_groups(c);
    print_causes(answer, *arena);
    const char *seat = words_empty_seat(c, arena);
    if (seat[0]) print("\nnote       %s\n", seat);
    print_remedies(c, *arena);
    if (explained->has_pixel) print_spectrum(&explained->light);
}

/* ---- as JSON ----------------------------------------------------------------------------- */

static json_t *json_point(const double origin_m[3], Vec3 p) {
    double at[3];
    world_from_scene(origin_m, p, at);
    return json_world_point(at);
}

static json_t *json_rays(const ReviewCase *c, const CaseCause *cause) {
    json_t *out = json_array();
    for (int i = 0; i < cause->ray_count; i++) {
        json_t *ray = json_array();
        for (int k = 0; k < cause->rays[i].count; k++)
            json_array_append_new(ray, json_point(c->origin_m, cause->rays[i].points[k]));
        json_array_append_new(out, ray);
    }
    return out;
}

/* What a scene's chain has besides a review's. */
static void add_way(const ExplainAnswer *answer, const Chain *chain, json_t *to) {
    static const char *const kinds[] = {"sun", "sky", "surface", "lamp"}; /* LightSet */
    const Scene *scene = answer->found.chains.scene;
    LightWay way = way_of(answer, chain);
    json_t *bounces = json_array();
    for (int i = 0; i < way.count; i++) {
        const Bounce *bounce = &way.bounce[i];
        const Part *part = &scene->parts[bounce->part_id];
        json_array_append_new(
            bounces,
            json_pack("{s:s, s:o, s:o, s:o}", "what", bounce->what, "material",
                      json_text(scene->materials[part->material_id].name), "node",
                      json_text(part->name), "at_m",
                      bounce->has_place ? json_point(scene->origin, bounce->at) : json_null()));
    }
    json_object_set_new(to, "light", json_text(way.light));
    json_object_set_new(to, "kind", json_string(kinds[chain->key.source]));
    json_object_set_new(to, "from_m",
                        way.has_from ? json_point(scene->origin, way.from) : json_null());
    json_object_set_new(to, "bounces", bounces);
    json_object_set_new(to, "has_further_surfaces", json_boolean(chain->key.is_longer));
}

static json_t *json_chains(const ExplainAnswer *answer) {
    const ReviewCase *c = &answer->found.of;
    const Chains *chains = &answer->found.chains;
    json_t *out = json_array();
    for (int i = 0; i < c->cause_count; i++) {
        const CaseCause *cause = &c->causes[i];
        double without = c->display ? cause->contrast_without : (double)NAN;
        json_t *one = json_pack(
            "{s:o, s:o, s:o, s:[o,o], s:o, s:o, s:o}", "chain",
            json_texts(cause->chain, cause->links), "share", json_figure(cause->share), "cd_m2",
            json_figure(cause->cd_m2), "interval", json_figure(cause->low),
            json_figure(cause->high), "contrast_without", json_figure(without), "contrast_lost",
            json_figure(without - c->contrast_ratio), "rays", json_rays(c, cause));
        if (i < chains->count) add_way(answer, &chains->list[i], one);
        json_array_append_new(out, one);
    }
    return out;
}

static json_t *json_light(const Explained *explained) {
    const CaseLuminances *l = &explained->of.luminance_cd_m2;
    double all = explained->has_pixel ? explained->light.xyz[1].mean : l->reflected;
    json_t *out = json_object();
    if (explained->has_pixel || !explained->of.display)
        json_object_set_new(out, "all", json_figure(all));
    if (!explained->of.display) return out;
    bool is_symbol = explained->of.symbol != NULL;
    json_object_set_new(out, "reflected", json_figure(l->reflected));
    json_object_set_new(out, "mirror", json_figure(l->mirror));
    json_object_set_new(out, "scattered", json_figure(l->scattered));
    json_object_set_new(out, is_symbol ? "foreground" : "white", json_figure(l->foreground));
    json_object_set_new(out, is_symbol ? "background" : "black", json_figure(l->background));
    if (!is_symbol) json_object_set_new(out, "emitted", json_figure(explained->shown));
    return out;
}

static json_t *json_spectrum(const PixelLight *light) {
    json_t *nm = json_array(), *radiance = json_array(), *error = json_array();
    for (int i = 0; i < PIXEL_BANDS; i++) {
        json_array_append_new(nm, json_integer(band_center_nm(i)));
        json_array_append_new(radiance, json_real(light->radiance[i].mean));
        json_array_append_new(error, json_real(light->radiance[i].sigma));
    }
    return json_pack("{s:s, s:i, s:o, s:o, s:o}", "unit", "W m-2 sr-1 nm-1", "band_nm",
                     PIXEL_BAND_NM, "nm", nm, "radiance", radiance, "standard_error", error);
}

static void add_pixel(const ExplainAnswer *answer, json_t *to) {
    const PixelFigure *xyz = answer->found.light.xyz;
    json_object_set_new(to, "pixel", json_pack("[i, i]", answer->pixel[0], answer->pixel[1]));
    json_object_set_new(to, "size", json_pack("[i, i]", answer->size[0], answer->size[1]));
    json_object_set_new(to, "XYZ", json_pack("[f, f, f]", xyz[0].mean, xyz[1].mean, xyz[2].mean));
    json_object_set_new(to, "standard_error_cd_m2", json_real(xyz[1].sigma));
    json_object_set_new(to, "spectrum", json_spectrum(&answer->found.light));
}

static bool print_json(const ExplainAnswer *answer, Error *err) {
    const Explained *explained = &answer->found;
    const ReviewCase *c = &explained->of;
    json_t *out = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:[o,o], s:I}", "condition",
        json_text_or_null(c->condition), "eye", json_text_or_null(c->eye), "symbol",
        json_text_or_null(c->symbol), "display", json_text_or_null(c->display), "eye_m",
        json_world_point(c->eye_m), "luminance_cd_m2", json_light(explained), "contrast_ratio",
        json_figure(c->contrast_ratio), "contrast_interval", json_figure(c->contrast_low),
        json_figure(c->contrast_high), "paths", (json_int_t)explained->paths);
    json_object_set_new(out, "visible_share", json_figure(c->visible_share));
    case_whole_json(c, out);
    json_object_set_new(out, "hidden_by", case_hiders_json(c));
    json_object_set_new(out, "reflected_interval",
                        json_pack("[o,o]", json_figure(c->reflected_range.low),
                                  json_figure(c->reflected_range.high)));
    json_object_set_new(out, "cause_groups", case_groups_json(c));
    json_object_set_new(out, "chains", json_chains(answer));
    json_object_set_new(out, "remedies", case_remedies_json(c));
    if (explained->has_pixel) add_pixel(answer, out);
    return cli_print_json(out, err);
}

bool explain_answer(const Cli *cli, const ExplainAnswer *answer, Arena *arena, Error *err) {
    if (cli->json) return print_json(answer, err);
    print_text(answer, arena);
    return true;
}
