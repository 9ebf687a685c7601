/* SPDX-License-Identifier: Apache-2.0 */
#include "path/path.h"

#include "base/mathf.h"
#include "scene/point/ray_ends.h"
#include "path/direct.h"
#include "path/emitted.h"
#include "path/mirror_share.h"
#include "path/mirrored.h"
#include "path/path_collector.h"
#include "path/sunlit.h"
#include "path/unfollowed.h"
#include "sunlit/sunlit_build.h"
#include "path/windows.h"

#define ROULETTE_FIRST_BOUNCE 2
#define ROULETTE_GENEROSITY 1.7f
#define FROM_PDF 1.0f /* sr^-1, of PathStart.from */

typedef enum Step { STEP_ENDED, STEP_PASSED, STEP_SCATTERED } Step;

#define PASSES_MAX 512 /* windows and holes along one path: more is a closed loop of rounding */

/* ---- where it goes on -------------------------------------------------------------------- */

/* Ends dim paths; what survives is made stronger, so that the mean stays (Arvo and Kirk 1990).
 * The square root spares the light that reaches shadows via dark leather. Measured over
 * both cockpits, a guided path is worth more than that: what it finds costs little beside the
 * vertices before it. */
static bool roulette(PathState *path) {
    if (path->bounce < ROULETTE_FIRST_BOUNCE) return true;
    numbers_for(path, NUMBERS_ROULETTE);
    float share = spectrum_max_lane(path->throughput) / path->bright;
    float survival = min_f(ROULETTE_GENEROSITY * sqrtf(share), 1);
    if (sampler_1d(path->sampler) >= survival) return false;
    path->throughput *= spectrum_all(1 / survival);
    return true;
}

/* Does light via the first surface count, however dark that is? */
static bool asks_the_first(const PathState *path, const Surface *surface) {
    return path->context->is_probe || surface_is_display(path->context->scene, surface);
}

/* At the first surface: what is found from now on came via a display's mirror. */
static void note_mirror(PathState *path, const Surface *surface, const BsdfSample *next) {
    PathFirst *first = &path->first;
    bool is_mirror = next->is_delta && surface_is_display(path->context->scene, surface);
    if (!first->is_awaited || !is_mirror) return;
    first->by_mirror = true;
    first->before = path->gathered;
}

/* The path crosses the surface towards wi; of a solid it is inside or outside then. */
static void cross(PathState *path, const Surface *surface, Vec3 local_wi, Vec3 wi) {
    bool refracts = bsdf_is(&surface->bsdf, BSDF_REFRACTS);
    bool is_inside = refracts ? local_wi.z < 0 : vec3_dot(wi, surface->ng) < 0;
    const Material *m = &path->context->scene->materials[surface->material_id];
    if (refracts || material_is_translucent_solid(m))
        path->medium_id = is_inside ? surface->material_id : NO_ID;
}

/* Turns the path into direction next->wi (local) at a vertex that scatters. */
static Step turn(PathState *path, const Surface *surface, Vec3 wo, const BsdfSample *next) {
    Vec3 wi = frame_to_world(&surface->frame, next->wi), start;
    if (!direct_sides_agree(surface, next->wi, wi, wo)) return STEP_ENDED;
    if (next->along == 0) start = ray_start(&surface->point, wi);
    else if (!pane_image_start(path, surface, wi, next->along, &start)) return STEP_ENDED;
    Spectrum sun = mirrored_sun_share(path, surface, wo, next);
    bool samples_map = !next->is_delta && sunlit_is_sampled(path, surface);
    SunlitPair before = {.prob = 0};
    if (path->last.samples_map && !next->is_delta) before = emitted_pair(path, surface);
    if (next->wi.z * surface->local_wo.z < 0) cross(path, surface, next->wi, wi);
    path->way = mirrored_way(path, surface, wo, next);
    collect_turn(path, surface, wo, next);
    path->last =
        (PathVertex){.at = emitted_lit_point(path, surface),
                     .part_id = surface->part_id,
                     .pdf = next->pdf,
                     .is_delta = next->is_delta,
                     .is_back = vec3_dot(wo, surface->ng) < 0,
                     .mirrors = next->is_delta ? 0 : mirrored_rarity(path, BEAMS_OF_EMITTERS),
                     .mirrors_least = mirrored_least(path, surface, BEAMS_OF_EMITTERS),
                     .samples_map = samples_map,
                     .before = before,
                     .sun_share = sun};
    path->smooth = next->is_delta ? path->smooth + 1 + path->by_plates : 0;
    path->straight = path->sheets_from = 0;
    path->by_plates = false;
    sheets_none(path->stack);
    note_mirror(path, surface, next);
    if (!path->bounce && asks_the_first(path, surface))
        path->bright = spectrum_max_lane(path->throughput);
    if (!path->bounce && path->context->is_probe) path->statistics->sent_on += path->bright;
    path->bounce++;
    path->ray = (Ray){start, vec3_normalize(wi), 0, INFINITY};
    return path->manner.is_spared || roulette(path) ? STEP_SCATTERED : STEP_ENDED;
}

/* Chooses where the path goes from the surface, by the spare guiding. Windows can be passed
 * after the last bounce. */
static Step scatter(PathState *path, const Surface *surface, Vec3 wo) {
    float u[4];
    BsdfSample next;
    numbers_for(path, NUMBERS_SCATTER);
    sampler_4d(path->sampler, u);
    if (!collect_choose(path, surface, &next) && !guiding_sample(path->spare, surface, u, &next))
        return STEP_ENDED;
    path_weigh(path, surface, next.weight);
    collect_leave(path, surface, wo, &next);
    if (spectrum_is_zero(path->throughput)) return STEP_ENDED;
    if (next.passes) {
        sheet_go_behind(path, surface);
        return STEP_PASSED;
    }
    if (path->bounce >= path->context->max_bounces) return STEP_ENDED;
    if (collect_refuse(path, surface, &next)) return STEP_ENDED;
    Guiding *last = path->guiding; /* the spare one becomes that of the last vertex */
    path->guiding = path->spare;
    path->spare = last;
    return turn(path, surface, wo, &next);
}

/* ---- what it meets ----------------------------------------------------------------------- */

/* The next surface along the ray; those that lie in one plane come one after the other. */
static bool next_hit(PathState *path, Hit *hit) {
    const PathContext *context = path->context;
    SheetStack *stack = path->stack;
    if (stack->next < stack->count) {
        *hit = stack->hit[stack->next++];
        return true;
    }
    *(path->bounce ? &path->statistics->bounce_rays : &path->statistics->camera_rays) += 1;
    bool is_met = bvh_intersect(context->bvh, path->ray, path->sheets_from, hit);
    if (unfollowed_emitters(path))
        unfollowed_add(path, is_met ? path->straight + hit->t : INFINITY);
    if (!is_met) return false;
    path->straight += hit->t;
    if (path->medium_id != NO_ID)
        direct_absorb(path->context->scene, path->wavelengths, path->medium_id, hit->t,
                      &path->throughput);
    sheets_none(stack);
    if (!bvh_has_sheets(context->bvh) || hit->t < path->sheets_from) return true;
    sheets_at(context->scene, context->bvh, hit, path->ray.direction, stack);
    *hit = stack->hit[stack->next++];
    return true;
}

static void see_first(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo) {
    if (!path->first.is_awaited) return;
    path->first.through = path->throughput;
    path->first.through_is_grey = path->is_grey;
    collect_see(path, surface, wo, hit->triangle);
}

static void record_first(PathState *path, const Hit *hit, float distance, Vec3 wo) {
    PathFirst *first = &path->first;
    if (!first->is_awaited) return;
    first->is_awaited = false;
    first->is_met = true;
    first->hit = *hit;
    first->hit.t = distance;
    first->direction = vec3_neg(wo);
}

/* At a surface that is no hole: adds its emission and its light samples, then goes on. */
static Step shade(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo) {
    Guiding *guiding = path->spare;
    if (!path->manner.is_dark) emitted_add(path, surface, hit, wo);
    guiding_at(path->context, surface, wo, path->bounce, guiding);
    bool is_done = collect_vertex(path, surface, wo, guiding);
    if (!is_done && path->bounce < path->context->max_bounces) {
        direct_add(path, surface, wo, guiding);
        mirrored_add(path, surface, wo, guiding);
        sunlit_add(path, surface, wo, guiding);
    }
    return scatter(path, surface, wo);
}

static void walk(PathState *path);

static Step show_sheet(PathState *sheet, const Surface *surface, const Hit *hit, Vec3 wo) {
    Surface pane;
    BsdfSample mirror;
    if (surface->alpha < 1) return shade(sheet, surface, hit, wo);
    if (pane_shows_itself(surface, &pane)) return shade(sheet, &pane, hit, wo);
    if (!window_reflects(sheet, surface, wo, &mirror)) return STEP_ENDED;
    return turn(sheet, surface, wo, &mirror);
}

/* First the light of a thin sheet itself: its mirror image, or its part that is no hole; then
 * what lies behind it. */
static void follow_both(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo) {
    SheetRoom room;
    PathState sheet;
    if (sheet_is_shown(path, surface, &room, &sheet)) {
        if (show_sheet(&sheet, surface, hit, wo) != STEP_ENDED) walk(&sheet);
        path_light_add(&path->gathered, &sheet.gathered);
    }
    sheet_pass(path, surface, wo);
}

/* The rendering equation (Kajiya 1986), y being what the ray from x along wi meets:
 *     L(x, wo) = Le(x, wo) + integral over wi of f(x, wo, wi) |cos wi| L(y, -wi)
 * A step adds Le and what light samples find of the integral, both by path_gather(), and
 * follows the rest in one direction: the throughput times f |cos wi| / pdf. */
static void walk(PathState *path) {
    const PathContext *context = path->context;
    for (int steps = 0; steps < PASSES_MAX + context->max_bounces; steps++) {
        Hit hit;
        Plate plate;
        Surface surface;
        if (!next_hit(path, &hit)) {
            emitted_distant(path);
            return;
        }
        Vec3 wo = vec3_neg(path->ray.direction);
        float distance = path->straight;
        path->steps++;
        surface_at(context->scene, context->tables, &hit, wo, path->wavelengths, &surface);
        if (context->plates.count) plate_meet(path, &hit, path->ray.direction, &surface, &plate);
        bsdf_carry(&surface.bsdf, &path->throughput);
        collect_meet(path);
        if (sheet_is_followed(path, &surface)) {
            follow_both(path, &surface, &hit, wo);
            continue;
        }
        numbers_for(path, NUMBERS_HOLE);
        if (surface.alpha < 1 && sampler_1d(path->sampler) >= surface.alpha) {
            sheet_go_behind(path, &surface);
            continue;
        }
        BsdfRoom room;
        bsdf_look(&surface.bsdf, surface.local_wo, &room);
        see_first(path, &surface, &hit, wo);
        Step step = shade(path, &surface, &hit, wo);
        if (step != STEP_PASSED) record_first(path, &hit, distance, wo);
        if (step == STEP_ENDED) return;
    }
}

void path_follow(PathState *path, const Surface *surface, Vec3 wo, const BsdfSample *next) {
    if (turn(path, surface, wo, next) == STEP_SCATTERED) walk(path);
}

/* ---- contexts ---------------------------------------------------------------------------- */

static PathContext context_of(const Scene *scene, const Bvh *bvh, int max_bounces,
                              SurfaceDetail detail, Arena *arena) {
    return (PathContext){.scene = scene,
                         .bvh = bvh,
                         .max_bounces = max_bounces,
                         .tables = surface_tables_build(scene, detail, arena),
                         .plates = plate_boxes_build(scene, arena),
                         .strategy = PATH_MIS};
}

PathContext path_context_unlit(const Scene *scene, const Bvh *bvh, int max_bounces, Arena *arena) {
    return context_of(scene, bvh, max_bounces, SURFACE_PLAIN, arena);
}

PathContext path_context_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                               int max_bounces, Arena *arena) {
    PathContext context = path_context_unlit(scene, bvh, max_bounces, arena);
    return path_context_relight(&context, lights, arena);
}

PathContext path_context_of_frame(const Scene *scene, const Bvh *bvh, const Lights *lights,
                                  int max_bounces, Arena *arena) {
    PathContext context = context_of(scene, bvh, max_bounces, SURFACE_PLAIN, arena);
    context.is_of_frame = true;
    return path_context_relight(&context, lights, arena);
}

PathContext path_context_sketch(const Scene *scene, const Bvh *bvh, const Lights *lights,
                                int max_bounces, Arena *arena) {
    PathContext context = context_of(scene, bvh, max_bounces, SURFACE_SKETCH, arena);
    context.is_of_frame = true;
    return path_context_relight(&context, lights, arena);
}

/* How often each set of lights is sampled, and each mirror searched, of what is known of them. */
static PathContext weigh(PathContext context, const BeamTools *tools, Arena *arena) {
    const SunlitTools sun = {tools->scene, tools->bvh, tools->lights};
    Wavelengths middle;
    wavelengths_sample(0.5f, &middle);
    PlateView plates = plate_view(&context, &middle);
    context.selection = light_selection_build(&sun, &context.sunlit, &plates, arena);
    for (int set = 0; set < BEAM_SETS; set++)
        context.beams[set] =
            mirror_beams_weighed(&context.beams[set], tools, &context.selection, arena);
    return context;
}

PathContext path_context_relight(const PathContext *before, const Lights *lights, Arena *arena) {
    PathContext context = *before;
    const BeamTools tools = {context.scene, context.bvh, lights, context.tables,
                             context.is_of_frame};
    const SunlitTools sun = {context.scene, context.bvh, lights};
    context.lights = lights;
    context.guide = NULL;
    context.sunlit = sunlit_build(&sun, arena);
    for (int set = 0; set < BEAM_SETS; set++)
        if (set == BEAMS_OF_SUN || !context.knows_lamps)
            context.beams[set] = mirror_beams_build(&tools, (BeamSet)set, arena);
    context.knows_lamps = true;
    return weigh(context, &tools, arena);
}

PathContext path_context_relevel(const PathContext *before, const Lights *lights, Arena *arena) {
    PathContext context = *before;
    const BeamTools tools = {context.scene, context.bvh, lights, context.tables,
                             context.is_of_frame};
    context.lights = lights;
    context.guide = NULL;
    return weigh(context, &tools, arena);
}

void path_context_know_lamps(PathContext *context, const Lights *lights, Arena *arena) {
    const BeamTools tools = {context->scene, context->bvh, lights, context->tables,
                             context->is_of_frame};
    context->beams[BEAMS_OF_LAMPS] = mirror_beams_build(&tools, BEAMS_OF_LAMPS, arena);
    context->beams[BEAMS_OF_EMITTERS] = mirror_beams_build(&tools, BEAMS_OF_EMITTERS, arena);
    context->knows_lamps = true;
}

/* ---- from a ray, from a point ------------------------------------------------------------ */

/* Memory that a PathState points to. */
typedef struct PathRoom {
    SheetStack stack;
    Guiding guidings[2];
} PathRoom;

static PathState state_of(const PathStart *start, PathRoom *room) {
    start->statistics->samples++;
    sheets_none(&room->stack);
    guiding_none(start->context, &room->guidings[0]);
    return (PathState){.context = start->context,
                       .wavelengths = start->wavelengths,
                       .sampler = start->sampler,
                       .statistics = start->statistics,
                       .collector = start->collector,
                       .manner = start->manner,
                       .throughput = spectrum_all(1),
                       .is_grey = true,
                       .bright = 1,
                       .gathered.radiance = spectrum_all(0),
                       .last = {.at.ns = vec3(0, 0, 1),
                                .is_delta = true,
                                .part_id = NO_ID,
                                .sun_share = spectrum_all(1)},
                       .guiding = &room->guidings[0],
                       .spare = &room->guidings[1],
                       .splits_left = SPLITS,
                       .medium_id = NO_ID,
                       .stack = &room->stack};
}

static void report(const PathState *path, PathResult *out) {
    const PathFirst *first = &path->first;
    *out = (PathResult){.hit = first->is_met,
                        .first = first->hit,
                        .direction = first->direction,
                        .through = first->through,
                        .through_is_grey = first->through_is_grey};
    path_light_to_xyz(&path->gathered, path->wavelengths, out->xyz);
    if (!first->by_mirror) return;
    PathLight since = path->gathered;
    path_light_take(&since, &first->before);
    path_light_to_xyz(&since, path->wavelengths, out->mirror);
}

void path_from_ray(const PathStart *start, Ray ray, PathResult *out) {
    PathRoom room;
    PathState path = state_of(start, &room);
    path.ray = ray;
    path.smooth = -PASSES_MAX; /* what an eye sees of lamps by mirrors is no light of a reading */
    path.first.is_awaited = out != NULL;
    if (start->from) {
        path.last.at = *start->from;
        path.last.is_delta = false;
        path.last.pdf = FROM_PDF;
        path.smooth = 0;
        path.bounce = 1;
    }
    collect_start(&path);
    walk(&path);
    collect_finish(&path);
    if (out) report(&path, out);
}

/* A white surface sends back a pi-th part of its illuminance: the throughput begins at pi. */
void path_from_point(const PathStart *start, LitPoint point, float xyz_lx[3]) {
    PathRoom room;
    Surface head;
    PathState path = state_of(start, &room);
    surface_white(path.context->tables, point.position, point.ns, &head);
    path.throughput = spectrum_all(PI_F);
    guiding_none(path.context, path.spare);
    if (!collect_vertex(&path, &head, point.ns, path.spare)) {
        direct_add(&path, &head, point.ns, path.spare);
        mirrored_add(&path, &head, point.ns, path.spare);
        sunlit_add(&path, &head, point.ns, path.spare);
    }
    if (scatter(&path, &head, point.ns) == STEP_SCATTERED) {
        collect_start(&path);
        walk(&path);
    }
    path_light_to_xyz(&path.gathered, path.wavelengths, xyz_lx);
}

/* ---- how often a luxmeter searches all mirrors ------------------------------------------- */

#define METER_PATHS 32   /* of a pilot, and of its searches of each set */
#define METER_OFTEN 4.0f /* root of a path's time by that of a search of one mirror */
#define METER_EVEN 0.1f  /* least deviation of paths that is believed, by their mean */

/* One path's answer, lx: all of it, or by no mirrors but the first vertex' own of the context. */
static double meter_sample(const PathContext *context, LitPoint head, uint32_t i, bool is_first) {
    PathStatistics ignored = {0};
    Sampler sampler = sampler_start(METER_PATHS, (int)is_first, 0, i);
    Wavelengths wavelengths;
    float xyz[3];
    wavelengths_sample(sampler_1d(&sampler), &wavelengths);
    PathStart start = {.context = context,
                       .wavelengths = &wavelengths,
                       .sampler = &sampler,
                       .statistics = &ignored};
    if (!is_first) {
        path_from_point(&start, head, xyz);
        return (double)xyz[1];
    }
    PathRoom room;
    Surface white;
    PathState path = state_of(&start, &room);
    surface_white(context->tables, head.position, head.ns, &white);
    path.throughput = spectrum_all(PI_F);
    guiding_none(context, path.spare);
    mirrored_add(&path, &white, head.ns, path.spare);
    path_light_to_xyz(&path.gathered, path.wavelengths, xyz);
    return (double)xyz[1];
}

/* The root of the mean square of what a search of the set's mirrors finds. */
static double meter_mirrored(const PathContext *context, LitPoint head, int set) {
    PathContext one = *context;
    double squares = 0;
    for (int other = 0; other < BEAM_SETS; other++)
        if (other != set) one.beams[other].mirrors = NULL;
    for (uint32_t i = 0; i < METER_PATHS; i++) {
        double lx = meter_sample(&one, head, i, true);
        squares += lx * lx;
    }
    return sqrt(squares / METER_PATHS);
}

PathContext path_context_of_meter(const PathContext *context, LitPoint head) {
    PathContext often = *context, out = *context;
    double sum = 0, squares = 0;
    bool is_any = false;
    for (int set = 0; set < BEAM_SETS; set++) {
        is_any |= mirrors_are_sampled(context, (BeamSet)set);
        often.beams[set].of_all = 1;
    }
    if (!is_any) return out;
    for (uint32_t i = 0; i < METER_PATHS; i++) {
        double lx = meter_sample(&often, head, i, false);
        sum += lx;
        squares += lx * lx;
    }
    double mean = sum / METER_PATHS;
    double spread = sqrt(fmax(squares / METER_PATHS - mean * mean, 0));
    double others = fmax(spread, (double)METER_EVEN * mean);
    for (int set = 0; set < BEAM_SETS; set++) {
        MirrorBeams *beams = &out.beams[set];
        if (!mirrors_are_sampled(context, (BeamSet)set)) continue;
        double time = sqrt(sqrt((double)beams->all_count + 1));
        double share = meter_mirrored(&often, head, set) / fmax(others, 1e-30);
        beams->of_all = min_f(max_f(beams->of_all, (float)(METER_OFTEN * share / time)), 1);
    }
    return out;
}
