/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/mirrored.h"

#include "base/mathf.h"
#include "path/direct.h"
#include "path/mirror_share.h"
#include "path/windows.h"

#define ELSEWHERE 0.02f /* most of first vertices' samples that search all mirrors for lamps */

/* ---- one point of a mirror --------------------------------------------------------------- */

/* A lit surface in air that samples its mirrors one by one, and the light that it looks for. */
typedef struct MirrorWalk {
    PathState *path;
    const Surface *surface;
    Vec3 wo;
    LightSample sun;       /* its direction, with all that is the same for all mirrors */
    Spectrum sun_radiance; /* of it, over its density */
    PunctualPoint lamp;
    const CompactEmitter *emitter;
    CompactPoint at; /* on the emitter */
    const Guiding *guiding;
    const MirrorBeams *beams; /* is_elsewhere: mirrors that the part samples anyway are left */
    bool is_rough, is_elsewhere;
    float prob; /* of all choices before */
} MirrorWalk;

/* The two shadow rays of light via a mirror. */
typedef struct MirrorRays {
    ShadowRay to_mirror, to_light;
} MirrorRays;

/* Light on the mirror's point: irradiance of what faces it, or of a near light intensity. */
static bool light_at(const MirrorWalk *walk, Vec3 place, LightSample *light, Spectrum *strength) {
    const PathContext *context = walk->path->context;
    float times = 1;
    switch (walk->beams->set) {
    case BEAMS_OF_LAMPS:
        if (!lights_lamp_towards(context->lights, &walk->lamp, place, light)) return false;
        if (!walk->lamp.is_distant && !walk->is_rough) times = light->distance * light->distance;
        break;
    case BEAMS_OF_EMITTERS:
        if (!compact_emitter_towards(context->scene, walk->emitter, &walk->at, place, light,
                                     &times))
            return false;
        break;
    default:
        *light = walk->sun;
        *strength = walk->sun_radiance;
        return true;
    }
    *strength =
        lights_radiance(context->lights, light, walk->path->wavelengths) * spectrum_all(times);
    return true;
}

/* Light by a point that mirrors_find reported; hit->t is not used. False: none comes by it.
 * Occlusion is not tested.
 *
 * The sun's light that leaves the solid angle dw around wo reached the mirror from dw / spread
 * around the sun's direction: radiance is kept but for what the mirror takes, and the density
 * of directions is that of the sun's divided by the spread. Of a lamp nearby, spread is what a
 * candela gives. Facets of a rough mirror send f cos of the light on, and their directions have
 * the density of their slopes divided by the spread. */
static bool mirror_at(const MirrorWalk *walk, const Hit *at, float spread, MirrorLight *out) {
    const PathContext *context = walk->path->context;
    const Scene *scene = context->scene;
    TrianglePoint place = triangle_point(scene, at->triangle, at->u, at->v);
    Vec3 to = vec3_sub(place.position, walk->surface->position);
    float distance = vec3_length(to);
    Vec3 wi = vec3_scale(to, 1 / distance), wo = vec3_neg(wi);
    Hit hit = {distance, at->u, at->v, at->triangle};
    Surface *mirror = &out->surface;
    LightSample *source = &out->source;
    Spectrum strength;
    Plate plate;
    if (!(distance > 0) || !light_at(walk, place.position, source, &strength)) return false;
    surface_at(scene, context->tables, &hit, wo, walk->path->wavelengths, mirror);
    if (context->plates.count) plate_meet(walk->path, &hit, wi, mirror, &plate);
    mirror->plate = NULL; /* it turns light back: what lies behind it does not count */
    Vec3 local_wo = mirror->local_wo;
    if (!(mirror->alpha > 0) || !mirror_is_plain(scene, mirror, wo) || !(local_wo.z > 0) ||
        !(vec3_dot(source->wi, mirror->frame.z) > 0) ||
        !(vec3_dot(wo, mirror->ng) * vec3_dot(source->wi, mirror->ng) > 0))
        return false;
    Vec3 local_light = frame_to_local(&mirror->frame, source->wi);
    out->radiance = walk->is_rough ? bsdf_glint(&mirror->bsdf, local_wo, local_light) *
                                         spectrum_all(local_light.z)
                                   : bsdf_mirror(&mirror->bsdf, local_wo);
    out->share = spectrum_mean(out->radiance);
    out->radiance *= strength * spectrum_all(mirror->alpha * spread / walk->prob);
    out->light = (LightSample){.wi = wi,
                               .distance = distance,
                               .pdf = 1,
                               .is_emitter = true,
                               .triangle = at->triangle,
                               .point = place};
    return !spectrum_is_zero(out->radiance);
}

/* ---- all points -------------------------------------------------------------------------- */

static void find_mirrored(const MirrorWalk *walk, const MirrorLight *mirror, Vec3 local_wi,
                          const MirrorRays *rays, Spectrum radiance) {
    PathState *path = walk->path;
    const LightSample *source = &mirror->source;
    bool is_distant = !isfinite(source->distance);
    if (!collect_takes_sample(path)) {
        path->gathered.radiance += radiance;
        return;
    }
    PathFound found = {.set = source->set,
                       .is_distant = is_distant,
                       .from = is_distant ? source->wi : walk->lamp.at,
                       .way = vec3_neg(source->wi),
                       .radiance = radiance,
                       .by = walk->surface,
                       .wo = walk->wo,
                       .local_wi = local_wi,
                       .shadow = &rays->to_mirror,
                       .mirror = mirror,
                       .beyond = &rays->to_light,
                       .by_rough = walk->is_rough};
    if (source->set == LIGHTS_PUNCTUAL) found.source_id = source->light_id;
    if (source->set == LIGHTS_EMITTERS) {
        found.source_id = walk->emitter->part_id;
        found.from = source->point.position;
        found.triangle = source->triangle;
        found.point = &source->point;
    }
    path_gather(path, &found);
}

/* The power heuristic of an emitter's point that chance finds, too (mirror_share.h). */
static float heuristic(const MirrorWalk *walk, const MirrorLight *mirror, float spread,
                       float bsdf_pdf) {
    if (walk->beams->set != BEAMS_OF_EMITTERS || walk->path->context->strategy != PATH_MIS)
        return 1;
    float cosine = fabsf(vec3_dot(walk->at.point.ng, mirror->source.wi));
    float chance = guiding_pdf(walk->guiding, mirror->light.wi, bsdf_pdf) * mirror->share;
    return mis_weight(walk->prob / walk->emitter->area_m2, chance * spread * cosine);
}

static void add_point(void *user, uint32_t triangle, const ReflectionPoint *point) {
    MirrorWalk *walk = user;
    const Surface *surface = walk->surface;
    PathState *path = walk->path;
    MirrorRays rays;
    MirrorLight mirror;
    Hit place = {0, point->u, point->v, triangle};
    MirrorPair own = {surface->part_id, false, triangle};
    float pdf;
    if (walk->is_elsewhere && mirrors_have(walk->beams->mirrors, own)) return;
    if (!mirror_at(walk, &place, point->spread, &mirror)) return;
    Vec3 local_wi = frame_to_local(&surface->frame, mirror.light.wi);
    if (!direct_sides_agree(surface, local_wi, mirror.light.wi, walk->wo)) return;
    Spectrum share = path->throughput * mirror.radiance *
                     bsdf_eval(&surface->bsdf, surface->local_wo, local_wi, &pdf) *
                     spectrum_all(fabsf(local_wi.z));
    share *= spectrum_all(heuristic(walk, &mirror, point->spread, pdf));
    if (spectrum_is_zero(share)) return;
    share *= direct_arrival(path, &mirror.surface, &mirror.source, &rays.to_light);
    if (spectrum_is_zero(share)) return;
    share *= direct_visibility(path, surface, &mirror.light, &rays.to_mirror);
    find_mirrored(walk, &mirror, local_wi, &rays, share);
}

static void find(MirrorWalk *walk, const MirrorQuery *query) {
    mirrors_find(walk->beams->mirrors, query, add_point, walk);
}

/* choice, here and below: a number of the sampler's, small enough for mirrored_prob to be tried. */
static void add_suns(MirrorWalk *walk, float choice) {
    PathState *path = walk->path;
    const Surface *surface = walk->surface;
    const Lights *lights = path->context->lights;
    float u[4];
    walk->prob = mirrored_prob(path, surface, walk->wo, BEAMS_OF_SUN);
    if (choice >= walk->prob) return;
    numbers_for_mirrors(path, BEAMS_OF_SUN);
    sampler_4d(path->sampler, u);
    LitPoint point = {surface->position, surface->frame.z, true}; /* from any side */
    if (!lights_sample(lights, LIGHTS_SUN, point, u, &walk->sun)) return;
    walk->sun_radiance =
        lights_radiance(lights, &walk->sun, path->wavelengths) / spectrum_all(walk->sun.pdf);
    MirrorQuery query = {surface->part_id, false, surface->position, {walk->sun.wi, false}, {0, 0}};
    find(walk, &query);
    query.is_rough = walk->is_rough = true;
    query.u = (Vec2){u[2], u[3]};
    find(walk, &query);
}

/* What a vertex draws for near lights in mirrors. */
typedef struct NearNumbers {
    float place[4]; /* of the source */
    Vec2 which;     /* source, in the part's mirrors and in all others */
    Vec2 facet;     /* of rough mirrors */
} NearNumbers;

/* One source in the part's mirrors; is_elsewhere: in all others. prob: of the search. */
static void add_source(MirrorWalk *walk, const NearNumbers *u, float prob) {
    const Surface *surface = walk->surface;
    const PathContext *context = walk->path->context;
    bool is_of_lamp = walk->beams->set == BEAMS_OF_LAMPS;
    MirrorQuery query = {.part_id = walk->is_elsewhere ? NO_ID : surface->part_id,
                         .from = surface->position,
                         .u = u->facet};
    float chosen;
    int id = mirror_beams_source(walk->beams, context->lights, surface->part_id,
                                 vec3_dot(walk->wo, surface->ng) < 0,
                                 walk->is_elsewhere ? u->which.y : u->which.x, &chosen);
    walk->prob = prob * chosen;
    walk->is_rough = false;
    if (is_of_lamp) {
        walk->lamp = lights_lamp_point(context->lights, id, u->place);
        query.light = (ReflectionLight){walk->lamp.at, !walk->lamp.is_distant};
    } else {
        walk->emitter = &walk->beams->emitters.list[id];
        walk->at = compact_emitter_point(context->scene, walk->emitter, u->place);
        query.light = (ReflectionLight){walk->at.point.position, true};
    }
    find(walk, &query);
    if (walk->is_elsewhere || !is_of_lamp) return;
    query.is_rough = walk->is_rough = true;
    find(walk, &query);
}

/* of_all: the probability with which all mirrors are searched, and are; 0: they are not. */
static void add_near(MirrorWalk *walk, float choice, float of_all) {
    PathState *path = walk->path;
    BeamSet set = walk->beams->set;
    float prob = mirrored_prob(path, walk->surface, walk->wo, set);
    bool has_own = choice < prob;
    NearNumbers u;
    if (!has_own && !(of_all > 0)) return;
    numbers_for_mirrors(path, set);
    sampler_4d(path->sampler, u.place);
    u.which = sampler_2d(path->sampler);
    u.facet = sampler_2d(path->sampler);
    if (has_own) add_source(walk, &u, prob);
    if (!(of_all > 0)) return;
    walk->is_elsewhere = true;
    add_source(walk, &u, of_all);
}

/* Does a reading's first vertex search all mirrors for lamps? As add_near has it. */
static float all_mirrors(const PathState *path, const Surface *surface, float choice) {
    float of_all = min_f(ELSEWHERE, path->context->beams[BEAMS_OF_LAMPS].of_all);
    bool does = surface->part_id != NO_ID && !path->bounce && !path->context->is_of_frame;
    return does && choice < of_all ? of_all : 0;
}

/* What a vertex chose: whether its part's mirrors are left, by a number that else says it; of_all:
 * the probability with which all mirrors are searched, and are; 0: they are not. */
typedef struct MirrorChoice {
    BeamSet set;
    bool is_left;
    float u, of_all;
} MirrorChoice;

/* Lights of one set. Few vertices come here: most leave their mirrors. */
static __attribute__((noinline)) void add_set(PathState *path, const Surface *surface, Vec3 wo,
                                              const Guiding *guiding, const MirrorChoice *choice) {
    const MirrorBeams *beams = &path->context->beams[choice->set];
    MirrorWalk walk = {
        .path = path, .surface = surface, .wo = wo, .guiding = guiding, .beams = beams};
    if (choice->set == BEAMS_OF_SUN) add_suns(&walk, choice->u);
    else add_near(&walk, choice->is_left ? INFINITY : choice->u, choice->of_all);
}

/* The mirror is one more vertex: none is sampled where the path would end before it. */
void mirrored_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding) {
    const PathContext *context = path->context;
    bool is_sampled[BEAM_SETS], is_any = false, is_back = vec3_dot(wo, surface->ng) < 0;
    float u[BEAM_SETS + 1];
    if (!bsdf_scatters(&surface->bsdf) || path->medium_id != NO_ID ||
        path->bounce + 1 >= context->max_bounces)
        return;
    for (int set = 0; set < BEAM_SETS; set++)
        is_any |= is_sampled[set] = mirrors_are_sampled(context, (BeamSet)set);
    if (!is_any) return;
    numbers_for(path, NUMBERS_MIRRORS);
    sampler_4d(path->sampler, u);
    for (int set = 0; set < BEAM_SETS; set++) {
        if (!is_sampled[set]) continue;
        MirrorChoice choice = {.set = (BeamSet)set, .u = u[set]};
        choice.is_left = !mirror_beams_has(&context->beams[set], surface->part_id, is_back) ||
                         mirrored_is_left(path, surface, wo, choice.set, choice.u);
        if (set == BEAMS_OF_LAMPS) choice.of_all = all_mirrors(path, surface, u[BEAM_SETS]);
        if (choice.is_left && !(choice.of_all > 0)) continue;
        add_set(path, surface, wo, guiding, &choice);
    }
}
