/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/explain_answer.h"

#include <math.h>

#include "base/count.h"
#include "cli/options/answer.h"
#include "review/output/case_json.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/json_text.h"

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

/* ---- what people read -------------------------------------------------------------------- */

static const Column HIDERS[] = {COLUMN_TEXT("what", "hidden by"), COLUMN_SHARE("share", "share")};
static const TableKind HIDERS_KIND = TABLE_KIND("hidden_by", NULL, HIDERS);

/* Each of the three adds up to all of the light. */
#define GROUP(kind, columns, words) \
    static const Column columns[] = {COLUMN_TEXT("what", words), COLUMN_SHARE("share", "share"), \
                                     COLUMN_DIGITS("cd_m2", "luminance", "cd/m2", 4)}; \
    static const TableKind kind = TABLE_KIND("cause_groups", NULL, columns)
GROUP(LIGHTS_KIND, LIGHTS, "source");
GROUP(OPENINGS_KIND, OPENINGS, "path");
GROUP(SURFACES_KIND, SURFACES, "last surface");

static const Column BOUNCES[] = {
    {.key = "what",
     .words = "what",
     .about = "in the order of the eye's ray: `mirror`, `scatters`, `refracts`, or `passes`, of a "
              "pane, whose `at_m` is null"},
    COLUMN_TEXT("node", "node"),
    COLUMN_TEXT("material", "material"),
    {.key = "at_m", .words = "at", .unit = "m", .is_fixed = true, .places = 3}};
static const TableKind BOUNCES_KIND = TABLE_KIND("bounces", NULL, BOUNCES);

static const Column CHAINS[] = {
    COLUMN_SHARE("share", "share"),
    COLUMN_MEASURED("cd_m2", "luminance", "cd/m2", "interval"),
    {.key = "contrast_without",
     .words = "contrast without it",
     .unit = ": 1",
     .places = 3,
     .hides_zero = true},
    COLUMN_TEXT("light", "light"),
    {.key = "from_m",
     .words = "from",
     .unit = "m",
     .is_fixed = true,
     .places = 3,
     .hides_zero = true},
    {.key = "has_further_surfaces", .words = "further surfaces", .hides_zero = true},
    {.key = "bounces|chain", .words = "what the eye's ray meets", .of = &BOUNCES_KIND}};
static const TableKind CHAINS_KIND = TABLE_KIND("chains", NULL, CHAINS);

static const Column SPECTRUM[] = {
    COLUMN_TEXT("spectrum.nm", "nm"),
    COLUMN_DIGITS("spectrum.radiance", "radiance", "W m-2 sr-1 nm-1", 4),
    COLUMN_DIGITS("spectrum.standard_error", "standard error", NULL, 2),
    {.key = "spectrum.radiance", .words = "", .is_bar = true}};
static const TableKind SPECTRUM_KIND = TABLE_KIND("spectrum", NULL, SPECTRUM);

static const Column EXPLAIN[] = {
    COLUMN_TEXT("pixel", "pixel"),
    COLUMN_TEXT("size", "of a frame"),
    COLUMN_TEXT("condition", "condition"),
    {.key = "symbol", .words = "symbol", .about = "null: of a scene"},
    {.key = "display", .words = "display", .about = "null: none is seen"},
    COLUMN_TEXT("eye", "eye"),
    COLUMN_FIXED("eye_m", "eye at", "m", 3),
    COLUMN_TEXT("paths", "paths"),
    COLUMN_DIGITS("XYZ.1", "luminance", "cd/m2", 5),
    COLUMN_DIGITS("standard_error_cd_m2", "standard error", "cd/m2", 2),
    {.key = "luminance_cd_m2.all",
     .words = "luminance",
     .unit = "cd/m2",
     .interval = "reflected_interval",
     .unless = "pixel"},
    {.key = "xy", .words = "colour", .parts = "x|y", .is_fixed = true, .places = 4},
    COLUMN_DIGITS("luminance_cd_m2.emitted", "emitted", "cd/m2", 4),
    COLUMN_DIGITS("luminance_cd_m2.foreground", "emitted, foreground", "cd/m2", 4),
    COLUMN_DIGITS("luminance_cd_m2.background", "background", "cd/m2", 4),
    COLUMN_DIGITS("luminance_cd_m2.white", "white", "cd/m2", 4),
    COLUMN_DIGITS("luminance_cd_m2.black", "black", "cd/m2", 4),
    COLUMN_MEASURED("luminance_cd_m2.reflected", "reflected", "cd/m2", "reflected_interval"),
    COLUMN_DIGITS("luminance_cd_m2.mirror", "by the mirror", "cd/m2", 4),
    COLUMN_DIGITS("luminance_cd_m2.scattered", "scattered", "cd/m2", 4),
    COLUMN_MEASURED("contrast_ratio", "contrast", ": 1", "contrast_interval"),
    {.key = "contrast_unlit",
     .words = "contrast without reflection",
     .unit = ": 1",
     .places = 4,
     .none = "infinite"},
    COLUMN_TEXT("verdict", "verdict"),
    {.key = "judged_line",
     .words = "judged",
     .about = "what was found and is required, or why it is not judged; null of a scene"},
    COLUMN_TEXT("notes", "note"),
    COLUMN_TEXT("remedy_lines", "remedy"),
    {.key = "hidden_by", .of = &HIDERS_KIND},
    {.key = "cause_groups.light", .of = &LIGHTS_KIND},
    {.key = "cause_groups.opening", .of = &OPENINGS_KIND},
    {.key = "cause_groups.surface", .of = &SURFACES_KIND},
    {.key = "chains", .of = &CHAINS_KIND},
    {.key = "spectrum.nm", .lists = &SPECTRUM_KIND}};
static const TableKind EXPLAIN_KIND = TABLE_KIND("explain", NULL, EXPLAIN);

/* Those of JSON alone. */
static const Column CHAIN_KEYS[] = {
    COLUMN_KEY("contrast_lost", "`contrast_without` less `contrast_ratio`"),
    COLUMN_KEY("rays", "lists of points, m, from the eye on"),
    COLUMN_KEY("kind", "of a scene's light: `sun`, `sky`, `surface`, `lamp`"),
};
static const TableKind CHAIN_KEYS_KIND = TABLE_KIND("chains", NULL, CHAIN_KEYS);
static const Column KEYS[] = {
    COLUMN_KEY("visible_share", "of the symbol's box, or the display"),
    COLUMN_KEY("symbol_mean", "of a symbol, as a case's in `review.json`, as the two that follow"),
    COLUMN_KEY("lit_share", NULL),
    COLUMN_KEY("judged_part_uv", NULL),
    COLUMN_KEY("remedies", "as a case's; `remedy_lines` in words"),
    COLUMN_KEY("spectrum.unit", "of `radiance`"),
    COLUMN_KEY("spectrum.band_nm", "width of each; `nm` are their middles"),
    {.key = "chains", .of = &CHAIN_KEYS_KIND},
};
static const TableKind KEYS_KIND = TABLE_KIND("explain", NULL, KEYS);

const Answer explain_answers[] = {{"", &EXPLAIN_KIND}, {"", &KEYS_KIND}, {0}};

/* ---- the answer -------------------------------------------------------------------------- */

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
        int middle = PIXEL_FIRST_NM + PIXEL_BAND_NM * i + PIXEL_BAND_NM / 2;
        json_array_append_new(nm, json_integer(middle));
        json_array_append_new(radiance, json_real(light->radiance[i].mean));
        json_array_append_new(error, json_real(light->radiance[i].sigma));
    }
    return json_pack("{s:s, s:i, s:o, s:o, s:o}", "unit", "W m-2 sr-1 nm-1", "band_nm",
                     PIXEL_BAND_NM, "nm", nm, "radiance", radiance, "standard_error", error);
}

static void add_pixel(const ExplainAnswer *answer, json_t *to) {
    const PixelFigure *xyz = answer->found.light.xyz;
    double sum = xyz[0].mean + xyz[1].mean + xyz[2].mean;
    json_object_set_new(to, "pixel", json_pack("[i, i]", answer->pixel[0], answer->pixel[1]));
    json_object_set_new(to, "size", json_pack("[i, i]", answer->size[0], answer->size[1]));
    json_object_set_new(to, "XYZ", json_pack("[f, f, f]", xyz[0].mean, xyz[1].mean, xyz[2].mean));
    if (sum > 0)
        json_object_set_new(to, "xy", json_pack("[f, f]", xyz[0].mean / sum, xyz[1].mean / sum));
    json_object_set_new(to, "standard_error_cd_m2", json_real(xyz[1].sigma));
    json_object_set_new(to, "spectrum", json_spectrum(&answer->found.light));
}

/* Of a review's case: the quantity of the limit that decides it; what is not seen is not judged. */
static void add_judged(const ReviewCase *c, json_t *to, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    const char *line = NULL, *seat = words_empty_seat(c, arena);
    json_t *remedies = json_array();
    if (!case_is_seen(c)) line = words_reason(c, arena);
    else if (limit)
        line = arena_format(arena, "%s %s, required %s", words_kind(limit),
                            words_measured(limit, arena), words_required(limit, arena));
    for (int i = 0; i < c->remedy_count; i++)
        json_array_append_new(remedies,
                              json_text(arena_format(arena, "%s: %s", c->remedies[i].what,
                                                     words_remedy(&c->remedies[i], arena))));
    json_object_set_new(to, "verdict", json_text_or_null(line ? verdict_names[c->verdict] : NULL));
    json_object_set_new(to, "judged_line", json_text_or_null(line));
    json_object_set_new(to, "notes", json_texts(&seat, seat[0] != '\0'));
    json_object_set_new(to, "remedy_lines", remedies);
}

bool explain_answer(const Cli *cli, const ExplainAnswer *answer, Arena *arena, Error *err) {
    const Explained *explained = &answer->found;
    const ReviewCase *c = &explained->of;
    const CaseLuminances *l = &c->luminance_cd_m2;
    json_t *out = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:[o,o], s:I}", "condition",
        json_text_or_null(c->condition), "eye", json_text_or_null(c->eye), "symbol",
        json_text_or_null(c->symbol), "display", json_text_or_null(c->display), "eye_m",
        json_world_point(c->eye_m), "luminance_cd_m2", json_light(explained), "contrast_ratio",
        json_figure(c->contrast_ratio), "contrast_interval", json_figure(c->contrast_low),
        json_figure(c->contrast_high), "paths", (json_int_t)explained->paths);
    if (c->display && case_is_seen(c))
        json_object_set_new(out, "contrast_unlit",
                            json_figure(luminance_contrast(l->foreground, l->background, 0)));
    json_object_set_new(out, "visible_share", json_figure(c->visible_share));
    case_whole_json(c, out);
    json_object_set_new(out, "hidden_by", case_hiders_json(c));
    json_object_set_new(out, "reflected_interval",
                        json_pack("[o,o]", json_figure(c->reflected_range.low),
                                  json_figure(c->reflected_range.high)));
    json_object_set_new(out, "cause_groups", case_groups_json(c));
    json_object_set_new(out, "chains", json_chains(answer));
    json_object_set_new(out, "remedies", case_remedies_json(c));
    add_judged(c, out, arena);
    if (explained->has_pixel) add_pixel(answer, out);
    return cli_print_answer(&EXPLAIN_KIND, out, cli->json, err);
}
