/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/explain.h"

#include <math.h>
#include <string.h>

#include "scene/point/ray_ends.h"
#include "review/judge.h"
#include "review/request/request_check.h"
#include "review/chain/causes.h"
#include "review/run/sweep.h"
#include "text/text.h"

#define SETUP_BYTES ((size_t)1 << 36)

/* ---- names ------------------------------------------------------------------------------- */

/* A list of what has a name, its first member, and what it is called. */
typedef struct KnownNames {
    const char *what;
    const void *list;
    size_t size; /* of one */
    int count;
} KnownNames;

static const char *name_at(const KnownNames *names, int i) {
    const char *name;
    memcpy(&name, (const char *)names->list + (size_t)i * names->size, sizeof name);
    return name;
}

/* wanted NULL: the only one. */
static bool find_name(KnownNames names, const char *wanted, int *out, Arena scratch, Error *err) {
    Text all = {.arena = &scratch};
    for (*out = 0; *out < names.count && wanted; ++*out)
        if (!strcmp(name_at(&names, *out), wanted)) return true;
    *out = 0;
    if (!wanted && names.count == 1) return true;
    for (int i = 0; i < names.count; i++)
        text_format(&all, "%s'%s'", i ? ", " : "", name_at(&names, i));
    const char *known = all.size ? all.data : "none";
    if (!wanted)
        return error_set(err, ERROR_USAGE, "--%s: which one? There are %s", names.what, known);
    return error_set(err, ERROR_USAGE, "--%s '%s': there is none of this name, but %s", names.what,
                     wanted, known);
}

static bool find_condition(const ReviewRequest *request, const ExplainOptions *options,
                           const ReviewCondition **out, Arena scratch, Error *err) {
    KnownNames conditions = {"condition", request->conditions, sizeof *request->conditions,
                             request->condition_count};
    int id;
    if (!find_name(conditions, options->condition, &id, scratch, err)) return false;
    *out = &request->conditions[id];
    bool is_sweep = (*out)->kind != CONDITION_MOMENT;
    if (is_sweep == options->has_sun) return true;
    return error_set(err, ERROR_USAGE,
                     is_sweep ? "--sun AZ,EL: condition '%s' is a sweep: which of its suns?"
                              : "--sun: condition '%s' has its own sun",
                     (*out)->name);
}

/* ---- a symbol of a review ---------------------------------------------------------------- */

static bool light_setup(Setup *setup, const ExplainOptions *options, Arena *scratch, Error *err) {
    if (setup->condition->kind == CONDITION_MOMENT) return setup_light(setup, NULL, scratch, err);
    SweepSun sun = {.azimuth_deg = options->sun_deg[0],
                    .compass_deg = options->sun_deg[0],
                    .elevation_deg = options->sun_deg[1],
                    .step = -1};
    Environment sky = sweep_environment(setup, &sun);
    return setup_light(setup, &sky, scratch, err);
}

/* The setup is open. */
static bool explain_on(Setup *setup, const ExplainOptions *options, Arena *scratch, Arena *arena,
                       Explained *out, Error *err) {
    const ReviewRequest *request = setup->request;
    KnownNames known[2] = {
        {.what = "symbol", .size = sizeof(SetupSymbol)},
        {"eye", request->eyes, sizeof *request->eyes, request->eye_count},
    };
    SetupSymbol *symbols;
    CaseTools tools = {.setup = setup,
                       .profile = options->profile,
                       .cause_paths = options->paths,
                       .cause_rays = CHAIN_RAYS};
    ReviewCase *c = &out->of;
    int symbol, eye;
    if (!light_setup(setup, options, scratch, err) ||
        !setup_symbols(setup, scratch, &symbols, &known[0].count, err) ||
        (setup->condition->kind == CONDITION_MOMENT &&
         !setup_learn(setup, symbols, known[0].count, scratch, err)))
        return false;
    tools.symbols = known[0].list = symbols;
    tools.symbol_count = known[0].count;
    if (!find_name(known[0], options->symbol, &symbol, *scratch, err) ||
        !find_name(known[1], options->eye, &eye, *scratch, err) ||
        !setup_case(&tools, &symbols[symbol], &request->eyes[eye], arena, c, err))
        return false;
    c->symbol = arena_string(arena, c->symbol, strlen(c->symbol));
    out->paths = tools.cause_paths;
    out->shown = (double)NAN;
    return true;
}

bool explain_review(const ReviewRequest *request, const ExplainOptions *options, Arena *arena,
                    Explained *out, Error *err) {
    SetupOptions setup_options = {.request = request, .means = options->means};
    Setup setup;
    *out = (Explained){.has_pixel = false};
    if (!find_condition(request, options, &setup_options.condition, *arena, err)) return false;
    Arena scratch = arena_reserve(SETUP_BYTES);
    bool ok = setup_open(&setup_options, &scratch, options->problems, &setup, err);
    if (ok) {
        ok = (!options->read || options->read(options->user, setup.scene, err)) &&
             (review_request_check(request, setup.scene, options->problems) ||
              problems_verdict(options->problems, err)) &&
             explain_on(&setup, options, &scratch, arena, out, err);
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}

/* ---- a display, a part of a picture ------------------------------------------------------ */

#define PANES 16 /* before a display, at most */

static void note_display(const ProbePart *to, const ProbeLook *look) {
    ((bool *)to->user)[to->piece->path] = look->is_found;
}

/* Leaves the targets that show a display, if at least half of them do. */
static bool aim_at_displays(const ExplainPlace *place, ProbeAim *aim, Arena *arena) {
    const ProbeAim *all = &place->aim;
    Vec3 *targets = ARENA_NEW(arena, Vec3, all->target_count);
    ProbePatch *patches = all->patches ? ARENA_NEW(arena, ProbePatch, all->target_count) : NULL;
    bool *shows = ARENA_NEW(arena, bool, all->target_count);
    ProbeGoal goal = {.pieces = 1, .paths = all->target_count};
    ProbeFold fold = {.user = shows, .look = note_display};
    int count = 0;
    probe_read(aim, &goal, place->tools, &fold, 1, *arena);
    for (int i = 0; i < all->target_count; i++) {
        if (!shows[i]) continue;
        if (patches) patches[count] = all->patches[i];
        targets[count++] = all->targets[i];
    }
    if (count == 0 || 2 * count < all->target_count) return false;
    aim->targets = targets;
    aim->patches = patches;
    aim->target_count = count;
    return true;
}

/* The first surface along the look that is no pane, or NO_ID; of a display its face. */
static bool meet(const ExplainPlace *place, Vec3 target, bool wants_display, Hit *hit) {
    const Scene *scene = place->aim.context->scene;
    Ray ray = {place->aim.eye, vec3_normalize(vec3_sub(target, place->aim.eye)), 0, INFINITY};
    for (int i = 0; i < PANES && bvh_intersect(place->aim.context->bvh, ray, 0, hit); i++) {
        const Part *part = &scene->parts[scene->triangles[hit->triangle].part_id];
        const Material *m = &scene->materials[part->material_id];
        if (wants_display ? m->display_id != NO_ID : !m->lets_light_through) return true;
        ray = ray_behind(scene, ray, hit);
    }
    return false;
}

#define STRATA 16 /* of SPECTRUM_LANES wavelengths each */

/* Adds the Y of white, of black and of what the display there shows, as they come to the eye. */
static bool add_sent(const ExplainPlace *place, Vec3 target, double sent[3], int *display_id) {
    const Scene *scene = place->aim.context->scene;
    float codes[3][3] = {{255, 255, 255}, {0, 0, 0}};
    double bare[3] = {0}, passed[3] = {0};
    Hit hit;
    if (!meet(place, target, true, &hit)) return false;
    TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
    const Part *part = &scene->parts[scene->triangles[hit.triangle].part_id];
    *display_id = scene->materials[part->material_id].display_id;
    const Display *display = &scene->displays[*display_id];
    Frame frame = display_frame(scene, display, hit.triangle, &point);
    Vec3 wo = vec3_normalize(vec3_sub(place->aim.eye, point.position));
    Vec3 local = frame_to_local(&frame, wo);
    SymbolPoint at = {hit.triangle, hit.u, hit.v, .position = point.position, .ng = frame.z};
    display_codes(scene, display, &point, codes[2]);
    for (int s = 0; s < STRATA; s++) {
        Wavelengths w;
        Spectrum lets = spectrum_all(0);
        wavelengths_sample(((float)s + 0.5f) / STRATA, &w);
        symbol_point_passed(&at, place->aim.context, &w, place->aim.eye, &lets);
        for (int k = 0; k < 3; k++) {
            Spectrum light = (k ? display_panel_spectrum
                                : display_full_spectrum)(display, &point, local, codes[k], &w) *
                             w.xyz[1];
            bare[k] += (double)spectrum_mean(light);
            passed[k] += (double)spectrum_mean(light * lets);
        }
    }
    for (int k = 0; k < 3; k++) {
        float xyz[3];
        (k ? display_panel_xyz : display_full_xyz)(display, &point, local, codes[k], xyz);
        if (bare[k] > 0) sent[k] += (double)(xyz[1] * display->level) * (passed[k] / bare[k]);
    }
    return true;
}

static void set_sent(const ExplainPlace *place, const ProbeAim *aim, Explained *out) {
    const Scene *scene = place->aim.context->scene;
    double sent[3] = {0, 0, 0};
    int count = 0, display_id = NO_ID;
    for (int i = 0; i < aim->target_count; i++)
        count += add_sent(place, aim->targets[i], sent, &display_id);
    if (!count) return;
    out->of.luminance_cd_m2.foreground = sent[0] / count;
    out->of.luminance_cd_m2.background = sent[1] / count;
    out->shown = sent[2] / count;
    out->of.display = scene->displays[display_id].name;
    out->of.level = (double)scene->displays[display_id].level;
}

static ReviewCase fresh_case(const Scene *scene, Vec3 eye) {
    const double nan = (double)NAN;
    ReviewCase c = {.luminance_cd_m2 = {nan, nan, nan, nan, nan, nan},
                    .contrast_ratio = nan,
                    .contrast_low = nan,
                    .contrast_high = nan,
                    .limit_id = -1,
                    .level = nan,
                    .visible_share = 1};
    memcpy(c.origin_m, scene->origin, sizeof c.origin_m);
    world_from_scene(scene->origin, eye, c.eye_m);
    return c;
}

/* Of a pixel's light some is what the display itself sends. */
static void set_light(const Chains *chains, bool is_display, ReviewCase *c) {
    CaseLuminances *l = &c->luminance_cd_m2;
    const ChainFigure *found = is_display ? &chains->reflected : &chains->all;
    l->reflected = found->cd_m2;
    c->reflected_range = (MeanInterval){found->low, found->high};
    if (!is_display) return;
    l->mirror = chains->mirror.cd_m2;
    l->scattered = l->reflected - l->mirror;
    judge_contrasts(c, c->reflected_range);
}

void explain_place(const ExplainPlace *place, Arena *arena, Explained *out) {
    ProbeAim aim = place->aim;
    const ProbePixel *pixel = aim.pixel;
    aim.pixel = NULL; /* its targets are asked what they show */
    bool is_display = aim_at_displays(place, &aim, arena);
    *out = (Explained){.of = fresh_case(aim.context->scene, aim.eye),
                       .shown = (double)NAN,
                       .has_pixel = pixel != NULL};
    if (is_display) set_sent(place, &aim, out);
    if (pixel) aim = place->aim;
    PixelLightSums light = {.chunks = 0};
    ProbeFold fold = pixel_light_fold(&light);
    ChainArgs args = {.aim = &aim,
                      .tools = place->tools,
                      .paths = place->paths,
                      .most = place->most,
                      .with_direct = pixel || !is_display,
                      .with_first_pane = pixel != NULL,
                      .beside = pixel ? &fold : NULL};
    out->chains = chains_find(&args, arena);
    out->paths = out->chains.paths;
    set_light(&out->chains, is_display, &out->of);
    case_causes_of(&out->chains, CHAIN_RAYS, &out->of, arena);
    if (pixel) out->light = pixel_light_of(&light);
}
