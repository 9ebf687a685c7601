/* SPDX-License-Identifier: Apache-2.0 */
#include "path/path.h"

#include "base/units.h"
#include "light/subpixels.h"
#include "path/footprint.h"
#include "path/lead.h"
#include "path/path_light.h"
#include "path/polarised.h"
#include "path/sheets.h"
#include "path/sun_mirror.h"
#include "spectrum/photometry.h"

#define ROULETTE_FIRST_BOUNCE 2
#define ROULETTE_GENEROSITY 1.7f
#define SHEET_SHARE 0.5f /* of the samples that follow what a thin sheet itself shows */
#define SPLITS 2         /* thin sheets along a camera ray that are followed both ways */
#define OFF_PANE 0.05f   /* of an image's shift: so far along its way its ray starts */
#define SHARP_ALPHA 0.2f /* of GGX: what ways follow besides mirrors */
#define ARRIVING_PDF 1.0f /* sr^-1, with which a guide that has learnt finds light, about */

#define PASSES_MAX 512 /* windows and holes along one path: more is a closed loop of rounding */

/* The numbers of a sample by their purpose: every surface that a path meets has its own, so
 * that what one sample spends shifts nothing in the samples beside it. Sheets that are followed
 * besides count on from far off. */
enum {
    NUMBERS_LIGHTS = 0, /* two pairs a set */
    NUMBERS_MIRRORS = 2 * LIGHT_SETS,
    NUMBERS_SPLIT = NUMBERS_MIRRORS + 3,
    NUMBERS_HOLE,
    NUMBERS_SCATTER,
    NUMBERS_ROULETTE = NUMBERS_SCATTER + 2,
    NUMBERS_STEP
};
#define NUMBERS_FIRST 2 /* before them: the place in the pixel, the wavelengths */
#define STEPS_FAR 4096  /* more than a path meets */

/* What a display that the eye sees scatters by its lambertian part: */
typedef struct LambertianPart {
    PathLight found;  /* of the light samples there */
    PathLight before; /* what the path had found in all when it went on from there, */
    Spectrum  share;  /* and how much counts of what it finds since, per lane */
} LambertianPart;

#define RECENT 16 /* hits that a shadow ray remembers */

/* Sheets that a shadow ray passed, the nearest first; of more than there is room for some. */
typedef struct Panes {
    int count;
    Hit hit[RECENT];
} Panes;

/* One path on its way. */
typedef struct PathWalk {
    const PathContext *context;
    const Wavelengths *wavelengths;
    Sampler           *sampler;
    PathStatistics    *statistics;
    Ray      ray;
    Spectrum throughput; /* what the path so far lets through, per lane */
    PathLight gathered;   /* found so far */
    PathResult *first;   /* waits for the first surface; NULL: recorded, or nobody asks */
    bool      by_mirror; /* the path goes on from the mirror of a display that the eye sees: */
    PathLight before_mirror; /* what it had found till then */
    LambertianPart *lambertian; /* NULL: nobody asks */
    float    straight;   /* m since the last scattering vertex (windows do not scatter) */
    LitPoint last;       /* that vertex */
    int      last_part_id;
    Lead    *lead;       /* with which it looked for light; and room for the next one */
    Lead    *spare;
    float    last_pdf;   /* with which it chose the direction, sr^-1 */
    bool     last_is_delta; /* no light sample could have found what comes now */
    Spectrum sun_share; /* of the sun met now; the rest was told to the last vertex but one */
    int      bounce;     /* scattering vertices so far */
    float    bright;     /* what a path lets through that is not dim; 1 but of a probe's
                            and behind a display */
    int      steps;       /* surfaces met so far */
    int      splits_left; /* thin sheets that may still be followed both ways */
    int      medium_id;  /* material of the solid that the ray is in; NO_ID: air */
    SheetStack *stack;   /* what else lies where the ray is; empty in scenes without sheets */
    float    sheets_from; /* m along the ray: sheets before it were in the stack */
    PathPlaces *places;  /* where it scatters is noted here; NULL: nobody asks */
    float   *arriving_sky; /* of a path to a point: the sky seen by it goes here; or NULL */
    const PathFar *far;   /* the path asks instead of being lit; or NULL */
    bool     sent_ways;   /* from the last vertex that scattered; mirrors may lie between */
    bool     is_way;      /* one of them: it follows mirrors, and */
    float    way_pdf;     /* ends behind a sharp lobe; its density there, sr^-1; 0: none yet */
    const PathListener *listener; /* NULL: nobody is told */
    PathTale *tale;       /* for it, of the path so far */
    Panes     *panes;     /* the last shadow ray's go here; NULL: nobody asks */
    Polarised *polarised; /* how light must be polarised to count; NULL: all the same */
    float    *stokes;     /* what analysers find goes here; NULL: nobody asks */
    RayFootprint *footprint; /* what a frame's pixel covers; NULL: not known or not asked */
} PathWalk;

/* What a walk needs room for besides. */
typedef struct WalkRoom {
    SheetStack stack;
    Lead       leads[2];
    Polarised  polarised;
    Panes      panes;
    RayFootprint footprint;
} WalkRoom;

/* The next numbers asked for are those of this purpose, at the surface met last. */
static void numbers_for(PathWalk *walk, int purpose)
{
    walk->sampler->dimension =
        (uint32_t)(NUMBERS_FIRST + walk->steps * NUMBERS_STEP + purpose);
}

/* ---- what a listener hears --------------------------------------------------------------- */

static void tale_step(PathTale *tale, const Surface *surface, PathEvent event)
{
    if (tale->count < PATH_STEPS_TOLD)
        tale->step[tale->count] =
            (PathStep){surface->part_id, event, tale->reached_by, surface->position};
    tale->count++;
    tale->reached_by = NO_ID;
}

static void note_step(PathWalk *walk, const Surface *surface, PathEvent event)
{
    if (!walk->tale || surface->part_id == NO_ID) return;
    tale_step(walk->tale, surface, event);
    walk->tale->pane_id = NO_ID;
}

/* Where the light that is found next begins. */
static void note_origin(PathWalk *walk, Vec3 from, bool is_far)
{
    if (!walk->tale) return;
    walk->tale->from = from;
    walk->tale->is_far = is_far;
}

static void tell(const PathWalk *walk, const PathTale *tale, const PathLight *light)
{
    float xyz[3];
    path_light_to_xyz(light, walk->wavelengths, xyz);
    walk->listener->hear(walk->listener->user, tale, xyz);
}

static bool has_listener(const PathWalk *walk, LightSet set)
{
    return walk->listener && (set == LIGHTS_EMITTERS || !walk->listener->of_emitters);
}

/* Light is found: of a set, and where it began. */
static void gather(PathWalk *walk, Spectrum radiance, LightSet set, int source_id)
{
    walk->gathered.radiance += radiance;
    if (!has_listener(walk, set)) return;
    PathLight light = {.radiance = radiance};
    walk->tale->source = set;
    walk->tale->source_id = source_id;
    walk->tale->lanes = (const float *)&light.radiance;
    tell(walk, walk->tale, &light);
}

/* ---- polarised light --------------------------------------------------------------------- */

/* Into the path's throughput. */
static void take_polarised(PathWalk *walk)
{
    walk->throughput *= polarised_take(walk->polarised);
}

static void turn_polarised(PathWalk *walk, const Surface *surface, Vec3 wo,
                           const BsdfSample *way)
{
    if (!walk->polarised) return;
    polarised_turn(walk->polarised, surface, wo, way);
    take_polarised(walk);
}

/* Through a window. */
static void pass_polarised(PathWalk *walk, const Surface *surface, Vec3 wo)
{
    polarised_pass(walk->polarised, surface, wo);
    take_polarised(walk);
}

/* The stretch to what gives light, along `direction`. */
static void pass_panes(const PathWalk *walk, const Panes *panes, Vec3 direction,
                       Polarised *light)
{
    const PathContext *context = walk->context;
    for (int i = 0; i < panes->count; i++) {
        Surface pane;
        Vec3    wo = vec3_neg(direction);
        surface_at(context->scene, context->tables, &panes->hit[i], wo, walk->wavelengths,
                   &pane);
        polarised_pass(light, &pane, wo);
    }
}

static void add_stokes(PathWalk *walk, Spectrum radiance, Vec3 way, const PolarisedLight *from)
{
    for (int i = 1; i < walk->polarised->row_count; i++) {
        float xyz[3] = {0};
        spectrum_add_xyz(walk->wavelengths,
                         radiance * polarised_seen(walk->polarised, i, way, from), xyz);
        walk->stokes[i - 1] += xyz[1];
    }
}

/* What of found light counts, that travels along `way`; from NULL: it is unpolarised. */
static Spectrum counted(PathWalk *walk, Spectrum radiance, Vec3 way, const PolarisedLight *from)
{
    if (!walk->polarised) return radiance;
    radiance *= walk->polarised->share;
    if (walk->stokes) add_stokes(walk, radiance, way, from);
    return radiance * polarised_seen(walk->polarised, 0, way, from);
}

/* Of sun or sky, from `towards`. */
static Spectrum count_distant(PathWalk *walk, Spectrum radiance, LightSet set, Vec3 towards)
{
    PolarisedLight sky;
    if (!walk->polarised) return radiance;
    bool is_some = set == LIGHTS_SKY &&
                   lights_sky_polarisation(walk->context->lights, towards, walk->wavelengths,
                                           &sky.axis, &sky.degree);
    return counted(walk, radiance, vec3_neg(towards), is_some ? &sky : NULL);
}

/* What leaves a triangle's point along `way` (unit); NULL: it is unpolarised. */
static const PolarisedLight *emitter_light(const PathWalk *walk, uint32_t triangle,
                                           const TrianglePoint *point, Vec3 way,
                                           PolarisedLight *out)
{
    float degree;
    if (!triangle_polarisation(walk->context->scene, triangle, point, way, &out->axis, &degree))
        return NULL;
    out->degree = spectrum_all(degree);
    return out;
}

static Spectrum count_emitter(PathWalk *walk, Spectrum radiance, uint32_t triangle,
                              const TrianglePoint *point, Vec3 way)
{
    PolarisedLight room;
    if (!walk->polarised) return radiance;
    return counted(walk, radiance, way, emitter_light(walk, triangle, point, way, &room));
}

/* By how much a display's XYZ count, all lanes being the same; found: their luminance. */
static float count_display(PathWalk *walk, float found, uint32_t triangle,
                           const TrianglePoint *point, Vec3 way)
{
    PolarisedLight        room;
    const Polarised      *light = walk->polarised;
    const PolarisedLight *from = emitter_light(walk, triangle, point, way, &room);
    for (int i = 1; walk->stokes && i < light->row_count; i++)
        walk->stokes[i - 1] += found * polarised_seen(light, i, way, from)[0];
    return polarised_seen(light, 0, way, from)[0];
}

/* ---- a display's lambertian part --------------------------------------------------------- */

/* Is this what is asked about? */
static bool tells_lambertian(const PathWalk *walk, const Surface *surface)
{
    return walk->lambertian && walk->first && surface->bsdf.kind == BSDF_DISPLAY;
}

/* Of what a display scatters from local_wi. */
static Spectrum lambertian_share(const Surface *surface, Vec3 local_wi)
{
    float    pdf;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, local_wi, &pdf);
    return display_lambertian_share(&surface->bsdf.display, f, local_wi);
}

/* Light from local_wi, which the surface scatters, has been gathered. */
static void note_sample(PathWalk *walk, const Surface *surface, Vec3 local_wi,
                        Spectrum radiance)
{
    walk->lambertian->found.radiance += radiance * lambertian_share(surface, local_wi);
}

/* The path goes on from there. */
static void note_way(PathWalk *walk, const Surface *surface, const BsdfSample *next)
{
    walk->lambertian->before = walk->gathered;
    if (next->is_delta) walk->lambertian->share = spectrum_all(0);
    else walk->lambertian->share = lambertian_share(surface, next->wi);
}

/* What measured XYZ come by a display on which nothing depends on wavelength: one lane's share
 * is all lanes'. */
static void tell_lambertian(const PathWalk *walk, float xyz[3])
{
    const LambertianPart *part = walk->lambertian;
    PathLight light = walk->gathered;
    path_light_take(&light, &part->before);
    light.radiance *= part->share;
    for (int i = 0; i < 3; i++) light.xyz[i] *= part->share[0];
    path_light_add(&light, &part->found);
    path_light_to_xyz(&light, walk->wavelengths, xyz);
}

/* ---- weights ---------------------------------------------------------------------------- */

/* The power heuristic (Veach 1997, 9.2.4) for two strategies. */
static float mis_weight(float pdf, float other)
{
    float ratio = other / pdf;
    return 1 / (1 + ratio * ratio);
}

/* How much of emitted light that the last vertex met by chance is counted: the rest belongs to
 * its light samples, which find the same light with density light_pdf. */
static float emission_weight(const PathWalk *walk, LightSet set, float light_pdf)
{
    const PathContext *context = walk->context;
    if (walk->last_is_delta || context->strategy == PATH_BSDF_ONLY) return 1;
    if (context->strategy == PATH_LIGHTS_ONLY) return 0;
    float prob = walk->lead->asked[set] * walk->lead->often;
    if (set == LIGHTS_SKY) light_pdf = lead_sky_pdf(walk->lead, walk->ray.direction, light_pdf);
    return mis_weight(walk->last_pdf, prob * light_pdf);
}

/* Solids keep their normal outside, whichever side is seen. */
static LitPoint lit_point(const PathWalk *walk, const Surface *surface)
{
    const Material *m = surface->material_id == NO_ID
                            ? NULL
                            : &walk->context->scene->materials[surface->material_id];
    return (LitPoint){surface->position, surface->frame.z,
                      m && (m->is_solid || material_sends_through(m))};
}

/* ---- emitted light ---------------------------------------------------------------------- */

/* The sky is told by itself, and no more. */
static void tell_sky(PathWalk *walk, Spectrum *radiance)
{
    float xyz[3] = {0};
    spectrum_add_xyz(walk->wavelengths, walk->throughput * *radiance, xyz);
    *walk->arriving_sky = xyz[1];
    *radiance = spectrum_all(0);
}

/* Vertices that scatter have asked for themselves. */
static void tell_escape(const PathWalk *walk)
{
    const PathFar *far = walk->far;
    const float   *share = (const float *)&walk->throughput;
    if (walk->sent_ways || !(walk->last_is_delta || walk->way_pdf > 0)) return;
    if (far->add_image) far->add_image(far->user, walk->tale, walk->ray.direction, share);
    else far->add_escaped(far->user, walk->ray.direction, walk->bounce, share, walk->way_pdf);
}

static void add_distant(PathWalk *walk)
{
    if (walk->far) {
        tell_escape(walk);
        return;
    }
    Spectrum radiance[2];
    float    pdf[2];
    lights_distant(walk->context->lights, walk->ray.direction, walk->last.ns, walk->wavelengths,
                   radiance, pdf);
    radiance[LIGHTS_SUN] *= walk->sun_share;
    if (walk->context->without_mirrored_sun && walk->by_mirror && walk->bounce == 1)
        radiance[LIGHTS_SUN] = spectrum_all(0);
    if (walk->arriving_sky && walk->bounce == 1) tell_sky(walk, &radiance[LIGHTS_SKY]);
    note_origin(walk, walk->ray.direction, true);
    for (int set = LIGHTS_SUN; set <= LIGHTS_SKY; set++) {
        float    weight = emission_weight(walk, (LightSet)set, pdf[set]);
        Spectrum found = walk->throughput * radiance[set] * spectrum_all(weight);
        gather(walk, count_distant(walk, found, (LightSet)set, walk->ray.direction),
               (LightSet)set, 0);
    }
}

/* Is this a display with sub-pixels, seen by the eye itself, straight, in mirrors or through
 * clear glass? What surfaces that scatter see is its even light. */
static bool comes_close(const PathWalk *walk, const Surface *surface, uint32_t triangle,
                        Vec3 wo, CloseView *out)
{
    const Scene *scene = walk->context->scene;
    int          display_id = scene->materials[surface->material_id].display_id;
    if (!walk->footprint || display_id == NO_ID || !scene->displays[display_id].subpixels)
        return false;
    const Display *display = &scene->displays[display_id];
    Frame          frame = display_frame(scene, display, triangle, &surface->point);
    *out = (CloseView){.scene = scene, .display = display, .point = &surface->point,
                       .triangle = triangle, .local = frame_to_local(&frame, wo)};
    footprint_across(walk->footprint, walk->straight, &frame, out->across);
    return true;
}

static Spectrum emission_seen(const PathWalk *walk, const Surface *surface, uint32_t triangle,
                              Vec3 wo)
{
    CloseView close;
    if (comes_close(walk, surface, triangle, wo, &close))
        return subpixels_spectrum(&close, walk->wavelengths);
    return triangle_emission(walk->context->scene, triangle, &surface->point, wo,
                             walk->wavelengths);
}

/* A display seen along a path on which nothing depended on wavelength: its measured XYZ. */
static void add_display_xyz(PathWalk *walk, const Surface *surface, uint32_t triangle, Vec3 wo,
                            float weight)
{
    const Scene *scene = walk->context->scene;
    int          display_id = scene->materials[surface->material_id].display_id;
    float        xyz[3];
    CloseView    close;
    if (comes_close(walk, surface, triangle, wo, &close))
        subpixels_xyz(&close, xyz);
    else
        display_emission_xyz(scene, &scene->displays[display_id], triangle, &surface->point, wo,
                             xyz);
    PathLight light = {.radiance = spectrum_all(0)};
    float     share = walk->throughput[0] * weight;
    if (walk->polarised)
        share *= count_display(walk, share * xyz[1], triangle, &surface->point, wo);
    for (int i = 0; i < 3; i++) light.xyz[i] = share * xyz[i];
    path_light_add(&walk->gathered, &light);
    if (!walk->listener) return;
    Spectrum lanes;
    walk->tale->source = LIGHTS_EMITTERS;
    walk->tale->source_id = surface->part_id;
    walk->tale->lanes = NULL;
    if (walk->listener->with_lanes) {
        lanes = walk->throughput * spectrum_all(weight) *
                emission_seen(walk, surface, triangle, wo);
        walk->tale->lanes = (const float *)&lanes;
    }
    tell(walk, walk->tale, &light);
}

/* Of the light samples of the last vertex; nothing asks for it behind a mirror. */
static float emitter_pdf(const PathWalk *walk, const Surface *surface, const Hit *hit)
{
    Hit seen = {walk->straight, hit->u, hit->v, hit->triangle};
    if (walk->last_is_delta) return 0;
    return lights_emitter_pdf(walk->context->lights, &walk->last, &seen,
                              walk->ray.direction, surface->ng);
}

static void add_emitted(PathWalk *walk, const Surface *surface, const Hit *hit, Vec3 wo)
{
    if (!surface->emits) return;
    const Scene *scene = walk->context->scene;
    float weight = emission_weight(walk, LIGHTS_EMITTERS, emitter_pdf(walk, surface, hit));
    if (!(weight > 0)) return;
    note_origin(walk, surface->position, false);
    if (scene->materials[surface->material_id].display_id != NO_ID &&
        spectrum_is_grey(walk->throughput)) {
        add_display_xyz(walk, surface, hit->triangle, wo, weight);
        return;
    }
    Spectrum sent = walk->throughput * spectrum_all(weight) *
                    emission_seen(walk, surface, hit->triangle, wo);
    gather(walk, count_emitter(walk, sent, hit->triangle, &surface->point, wo), LIGHTS_EMITTERS,
           surface->part_id);
}

/* ---- solids ----------------------------------------------------------------------------- */

/* Beer's law inside a solid: the material's colour is what is left after its distance. */
static void absorb(const PathWalk *walk, int medium_id, float distance, Spectrum *light)
{
    const Material *m = &walk->context->scene->materials[medium_id];
    if (!isfinite(m->attenuation_distance_m)) return;
    Spectrum left = spectrum_from_rgb(walk->wavelengths, m->attenuation_color);
    for (int i = 0; i < SPECTRUM_LANES; i++)
        (*light)[i] *= pow_f(left[i], distance / m->attenuation_distance_m);
}

/* A translucent solid takes its part of what a lamp inside sends to its boundary. */
static void absorb_sample(const PathWalk *walk, const Surface *surface,
                          const LightSample *light, Spectrum *passed)
{
    if (surface->bsdf.kind != BSDF_METALLIC_ROUGHNESS ||
        !(surface->bsdf.metallic_roughness.across > 0) || !isfinite(light->distance))
        return;
    const Material *m = &walk->context->scene->materials[surface->material_id];
    if (material_is_translucent_solid(m) && vec3_dot(light->wi, surface->ng) < 0)
        absorb(walk, surface->material_id, light->distance, passed);
}

/* ---- light samples ---------------------------------------------------------------------- */

typedef struct ShadowQuestion {
    const PathWalk    *walk;
    const LightSample *light;
    Spectrum passed;
    float    step;     /* by which the ray starts off its surface, m */
    float    end;      /* m along the ray, to the emitter; and how well that is known, */
    float    rounding; /* across its plane */
    int      hit_count;
    Hit      recent[RECENT];
} ShadowQuestion;

/* A ray through the edge that two triangles share meets both: that is one sheet, not two. */
static bool was_asked(ShadowQuestion *question, const Hit *hit)
{
    const Scene *scene = question->walk->context->scene;
    for (int i = 0; i < question->hit_count && i < RECENT; i++)
        if (fabsf(hit->t - question->recent[i].t) <= 2e-6f * hit->t + question->step &&
            sheets_are_one(scene, hit->triangle, question->recent[i].triangle))
            return true;
    question->recent[question->hit_count++ % RECENT] = *hit;
    return false;
}

static bool passes(void *user, const Hit *hit)
{
    ShadowQuestion *question = user;
    const PathContext *context = question->walk->context;
    if (was_asked(question, hit)) return true;
    if (question->walk->tale)
        question->walk->tale->pane_id =
            (int)context->scene->triangles[hit->triangle].part_id;
    question->passed *= surface_pass(context->scene, context->tables, hit, question->light->wi,
                                     question->walk->wavelengths);
    return !spectrum_is_zero(question->passed);
}

/* Of sheets about the emitter: those that lie over it take their share. */
static bool passes_before_emitter(void *user, const Hit *hit)
{
    const ShadowQuestion *question = user;
    const LightSample    *light = question->light;
    float behind = (hit->t - question->end) * fabsf(vec3_dot(light->wi, light->ng));
    bool  is_over = behind < -question->rounding ||
                   (behind <= question->rounding && hit->triangle > light->triangle);
    return !is_over || passes(user, hit);
}

/* In the order in which the ray met them. */
static void keep_panes(const ShadowQuestion *question, Panes *out)
{
    out->count = question->hit_count < RECENT ? question->hit_count : RECENT;
    for (int i = 0; i < out->count; i++) {
        int k = i;
        for (; k > 0 && out->hit[k - 1].t > question->recent[i].t; k--)
            out->hit[k] = out->hit[k - 1];
        out->hit[k] = question->recent[i];
    }
}

/* Share of the light sample that arrives at the surface. */
static Spectrum visibility(PathWalk *walk, const Surface *surface, const LightSample *light)
{
    const Bvh *bvh = walk->context->bvh;
    Vec3  origin = ray_offset_origin(surface->position, surface->ng, light->wi);
    Vec3  moved = vec3_sub(origin, surface->position);
    float end = fmaxf(light->distance * (1 - 1e-4f) - 4 * vec3_length(moved), 0);
    ShadowQuestion question; /* most rays ask nothing: its hits are left as they are */
    question.walk = walk;
    question.light = light;
    question.passed = spectrum_all(1);
    question.step = ray_offset_step(surface->position);
    question.hit_count = 0;
    if (walk->tale) walk->tale->pane_id = NO_ID;
    walk->statistics->shadow_rays++;
    if (bvh_occluded(bvh, (Ray){origin, light->wi, 0, end}, passes, &question))
        return spectrum_all(0);
    if (light->is_emitter && bvh_has_sheets(bvh)) {
        Vec3 on_emitter = vec3_along(surface->position, light->wi, light->distance);
        question.end = light->distance -
                       vec3_dot(moved, light->ng) / vec3_dot(light->wi, light->ng);
        question.rounding = fmaxf(sheets_rounding(on_emitter), 0x1p-20f * light->distance);
        bvh_ask_sheets(bvh, (Ray){origin, light->wi, end, 2 * light->distance - end},
                       passes_before_emitter, &question);
    }
    if (walk->panes) keep_panes(&question, walk->panes);
    return question.passed;
}

/* A direction must lie on the same side of the triangle as of the shading normal's plane, or
 * light would leak through the surface. */
static bool sides_agree(const Surface *surface, Vec3 local_wi, Vec3 wi, Vec3 wo)
{
    return (local_wi.z * surface->local_wo.z > 0) ==
           (vec3_dot(wi, surface->ng) * vec3_dot(wo, surface->ng) > 0);
}

static bool asks_mirrors(const PathContext *context)
{
    return context->beams.mirrors && context->strategy != PATH_BSDF_ONLY &&
           lights_has(context->lights, LIGHTS_SUN);
}

/* Did the vertex before ask for the sun in this mirror, smooth or rough? */
static bool mirror_was_asked(const PathWalk *walk, const Surface *surface, Vec3 wo,
                             bool is_rough)
{
    MirrorPair pair = {walk->last_part_id, is_rough, surface->triangle};
    return asks_mirrors(walk->context) && !walk->last_is_delta && walk->medium_id == NO_ID &&
           sun_mirror_is_known(walk->context->scene, walk->context->beams.mirrors, pair,
                               surface, wo);
}

static int source_of(const PathWalk *walk, const LightSample *light)
{
    const Scene *scene = walk->context->scene;
    if (light->set == LIGHTS_EMITTERS) return (int)scene->triangles[light->triangle].part_id;
    return light->set == LIGHTS_PUNCTUAL ? light->light_id : 0;
}

/* Of a light sample: the surface scatters it, and then the path is what it was. */
static void gather_sample(PathWalk *walk, const Surface *surface, Spectrum radiance,
                          const LightSample *light)
{
    if (!has_listener(walk, light->set)) {
        walk->gathered.radiance += radiance;
        return;
    }
    PathTale before = *walk->tale;
    bool     is_far = !isfinite(light->distance);
    if (surface->part_id != NO_ID) tale_step(walk->tale, surface, PATH_SCATTERS);
    else walk->tale->towards = light->wi; /* a luxmeter's own sample */
    note_origin(walk, is_far ? light->wi
                             : vec3_along(surface->position, light->wi, light->distance),
                is_far);
    gather(walk, radiance, light->set, source_of(walk, light));
    *walk->tale = before;
}

/* A sample's way is gone once more, for what surface and panes do to polarised light. */
static Spectrum count_sample(PathWalk *walk, const Surface *surface, Vec3 wo,
                             Spectrum radiance, const LightSample *light)
{
    Polarised  room = *walk->polarised, *own = walk->polarised;
    BsdfSample way = {.wi = frame_to_local(&surface->frame, light->wi)};
    polarised_turn(&room, surface, wo, &way);
    pass_panes(walk, walk->panes, light->wi, &room);
    walk->polarised = &room;
    radiance = light->set == LIGHTS_EMITTERS
                   ? count_emitter(walk, radiance, light->triangle, &light->point,
                                   vec3_neg(light->wi))
                   : count_distant(walk, radiance, light->set, light->wi);
    walk->polarised = own;
    return radiance;
}

/* A light was asked for from a surface, with this probability. */
typedef struct LightAsked {
    LightSample light;
    Vec3        local_wi;
    float       prob;
} LightAsked;

/* Most samples end in shadow: what the light sends and how the surface scatters it is asked
 * once the ray has arrived. */
static void add_arriving(PathWalk *walk, const Surface *surface, Vec3 wo, const Lead *lead,
                         LightAsked *asked)
{
    const PathContext *context = walk->context;
    LightSample *light = &asked->light;
    Vec3     local_wo = surface->local_wo, local_wi = asked->local_wi;
    float    prob = asked->prob;
    Spectrum passed = visibility(walk, surface, light);
    if (spectrum_is_zero(passed)) return;
    absorb_sample(walk, surface, light, &passed);
    lead_weigh_light(lead, context->lights, lit_point(walk, surface), light);
    float    bsdf_pdf;
    Spectrum f = bsdf_eval(&surface->bsdf, local_wo, local_wi, &bsdf_pdf);
    if (light->set == LIGHTS_SUN && mirror_was_asked(walk, surface, wo, true))
        f = sun_mirror_left(&surface->bsdf, local_wo, local_wi, f);
    Spectrum share = walk->throughput * f *
                     lights_radiance(context->lights, light, walk->wavelengths) *
                     spectrum_all(fabsf(local_wi.z) / (light->pdf * prob));
    if (!light->is_delta && context->strategy == PATH_MIS)
        share *= spectrum_all(mis_weight(light->pdf * prob,
                                         lead_pdf(lead, light->wi, bsdf_pdf)));
    share *= passed;
    if (walk->polarised) share = count_sample(walk, surface, wo, share, light);
    gather_sample(walk, surface, share, light);
    if (tells_lambertian(walk, surface)) note_sample(walk, surface, local_wi, share);
}

static void add_light_sample(PathWalk *walk, const Surface *surface, Vec3 wo, const Lead *lead,
                             LightSet set)
{
    const PathContext *context = walk->context;
    LightAsked   asked;
    LightSample *light = &asked.light;
    float u[4];
    asked.prob = lead->asked[set] * lead->often;
    numbers_for(walk, NUMBERS_LIGHTS + 2 * (int)set);
    sampler_4d(walk->sampler, u);
    if (!unit_choose(&u[0], asked.prob)) return;
    LitPoint point = lit_point(walk, surface);
    if (!lead_choose_light(lead, context->lights, set, point, u, light)) return;
    if (!light->is_delta && context->strategy == PATH_BSDF_ONLY) return;
    asked.local_wi = frame_to_local(&surface->frame, light->wi);
    if (!sides_agree(surface, asked.local_wi, light->wi, wo)) return;
    if (!bsdf_reaches(&surface->bsdf, surface->local_wo, asked.local_wi)) return;
    add_arriving(walk, surface, wo, lead, &asked);
}

/* ---- the sun by way of one mirror ------------------------------------------------------- */

/* A lit surface on its way through its mirrors. */
typedef struct MirrorWalk {
    PathWalk         *walk;
    const Surface    *surface;
    Vec3              wo;
    SunMirrorQuestion question;
    int               sun_pane_id; /* between the mirror and the sun */
} MirrorWalk;

static void gather_mirrored(const MirrorWalk *asked, const SunMirror *mirror,
                            Spectrum radiance)
{
    PathWalk      *walk = asked->walk;
    const Surface *surface = asked->surface;
    if (!has_listener(walk, LIGHTS_SUN)) {
        walk->gathered.radiance += radiance;
        return;
    }
    PathTale before = *walk->tale;
    if (surface->part_id != NO_ID) tale_step(walk->tale, surface, PATH_SCATTERS);
    else walk->tale->towards = mirror->light.wi;
    walk->tale->reached_by = walk->tale->pane_id;
    tale_step(walk->tale, &mirror->surface, PATH_REFLECTS);
    walk->tale->pane_id = asked->sun_pane_id;
    note_origin(walk, asked->question.sun.wi, true);
    gather(walk, radiance, LIGHTS_SUN, 0);
    *walk->tale = before;
}

/* Surface, panes, mirror, panes. The sun's light is unpolarised. */
static Spectrum count_mirrored(const MirrorWalk *asked, const SunMirror *mirror,
                               const Panes *beyond, Spectrum found)
{
    PathWalk      *walk = asked->walk;
    const Surface *by = &mirror->surface;
    Vec3           wo = vec3_neg(mirror->light.wi), to_sun = asked->question.sun.wi;
    BsdfSample     out = {.wi = frame_to_local(&asked->surface->frame, mirror->light.wi)};
    BsdfSample     way = {.wi = frame_to_local(&by->frame, to_sun),
                          .is_delta = !asked->question.is_rough};
    Polarised      room = *walk->polarised, *own = walk->polarised;
    polarised_turn(&room, asked->surface, asked->wo, &out);
    pass_panes(walk, walk->panes, mirror->light.wi, &room);
    polarised_turn(&room, by, wo, &way);
    pass_panes(walk, beyond, to_sun, &room);
    walk->polarised = &room;
    found = counted(walk, found, vec3_neg(to_sun), NULL);
    walk->polarised = own;
    return found;
}

static void add_mirrored_sun(void *user, uint32_t triangle, const ReflectionPoint *point)
{
    MirrorWalk       *asked = user;
    const Surface    *surface = asked->surface;
    PathWalk *walk = asked->walk;
    SunMirror mirror;
    Hit       place = {0, point->u, point->v, triangle};
    float     pdf;
    if (!sun_mirror_at(&asked->question, &place, point->spread, &mirror)) return;
    Vec3 local_wi = frame_to_local(&surface->frame, mirror.light.wi);
    if (!sides_agree(surface, local_wi, mirror.light.wi, asked->wo)) return;
    Spectrum share = walk->throughput * mirror.radiance *
                     bsdf_eval(&surface->bsdf, surface->local_wo, local_wi, &pdf) *
                     spectrum_all(fabsf(local_wi.z));
    if (spectrum_is_zero(share)) return;
    share *= visibility(walk, &mirror.surface, &asked->question.sun);
    if (spectrum_is_zero(share)) return;
    if (walk->tale) asked->sun_pane_id = walk->tale->pane_id;
    Panes beyond;
    if (walk->panes) beyond = *walk->panes;
    share *= visibility(walk, surface, &mirror.light);
    if (walk->polarised && !spectrum_is_zero(share))
        share = count_mirrored(asked, &mirror, &beyond, share);
    gather_mirrored(asked, &mirror, share);
    if (tells_lambertian(walk, surface)) note_sample(walk, surface, local_wi, share);
}

/* u: of the sun's disc. */
static void ask_mirrors(PathWalk *walk, const Surface *surface, Vec3 wo, const float u[4],
                        float prob)
{
    const PathContext *context = walk->context;
    MirrorWalk asked = {walk, surface, wo,
                        {.scene = context->scene, .tables = context->tables,
                         .wavelengths = walk->wavelengths, .from = surface->position},
                        NO_ID};
    LitPoint     point = {surface->position, surface->frame.z, true}; /* from any side */
    LightSample *sun = &asked.question.sun;
    if (!lights_sample(context->lights, LIGHTS_SUN, point, u, sun)) return;
    asked.question.radiance = lights_radiance(context->lights, sun, walk->wavelengths);
    sun->pdf *= prob;
    MirrorQuery query = {surface->part_id, false, surface->position, sun->wi, {0, 0}};
    mirrors_find(context->beams.mirrors, &query, add_mirrored_sun, &asked);
    query.is_rough = asked.question.is_rough = true;
    query.u = sampler_2d(walk->sampler);
    mirrors_find(context->beams.mirrors, &query, add_mirrored_sun, &asked);
}

/* The mirror is one more vertex: none is asked where the path would end before it. */
static void add_mirrored_suns(PathWalk *walk, const Surface *surface, Vec3 wo)
{
    const PathContext *context = walk->context;
    if (!asks_mirrors(context) || walk->medium_id != NO_ID ||
        walk->bounce + 1 >= context->max_bounces)
        return;
    float prob = mirror_beams_prob(&context->beams, surface->part_id,
                                   vec3_dot(wo, surface->ng) < 0, surface->position);
    for (int i = 0; i < walk->bounce && i < DEEP_BOUNCE; i++) prob *= DEEP_SHARE;
    if (!(prob > 0)) return;
    float u[4];
    numbers_for(walk, NUMBERS_MIRRORS);
    sampler_4d(walk->sampler, u);
    if (unit_choose(&u[0], prob)) ask_mirrors(walk, surface, wo, u, prob);
}

/* ---- light from far away as a question --------------------------------------------------- */

static bool is_sharp(const Surface *surface)
{
    return surface->bsdf.kind == BSDF_METALLIC_ROUGHNESS &&
           surface->bsdf.metallic_roughness.alpha <= SHARP_ALPHA;
}

static void ask_far(PathWalk *walk, const Surface *surface, Vec3 wo, const Lead *lead)
{
    const PathFar *far = walk->far;
    Vec3 local_wo = surface->local_wo;
    int  ways = walk->sent_ways && is_sharp(surface) ? PATH_WAYS : 0;
    for (int i = 0; i < far->count; i++) {
        LightSample light = {.wi = far->towards[i], .distance = INFINITY};
        Vec3  local_wi = frame_to_local(&surface->frame, light.wi);
        float pdf;
        if (!sides_agree(surface, local_wi, light.wi, wo)) continue;
        if (!bsdf_reaches(&surface->bsdf, local_wo, local_wi)) continue;
        Spectrum passed = visibility(walk, surface, &light);
        if (spectrum_is_zero(passed)) continue;
        Spectrum share = walk->throughput * passed *
                         bsdf_eval(&surface->bsdf, local_wo, local_wi, &pdf) *
                         spectrum_all(fabsf(local_wi.z));
        far->add(far->user, i, walk->bounce, (const float *)&share,
                 ways ? (float)ways * lead_pdf(lead, light.wi, pdf) : 0);
    }
}

typedef enum Step { STEP_ENDED, STEP_PASSED, STEP_SCATTERED } Step;

static Step turn(PathWalk *walk, const Surface *surface, Vec3 wo, const BsdfSample *next);
static void walk_path(PathWalk *walk);

/* Towards what lies where the surface scatters to; its own mirror the path itself follows. */
static void send_way(const PathWalk *from, const Surface *surface, Vec3 wo, const Lead *lead,
                     int i)
{
    PathWalk   way = *from;
    SheetStack stack;
    Lead       leads[2] = {*lead, *lead};
    BsdfSample next;
    float      u[4];
    way.steps += STEPS_FAR * (SPLITS + 1) * (1 + i);
    numbers_for(&way, NUMBERS_SCATTER);
    sampler_4d(way.sampler, u);
    if (!lead_sample(lead, surface, u, &next) || next.is_delta || next.passes) return;
    way.throughput *= next.weight * spectrum_all(1.0f / PATH_WAYS);
    way.stack = &stack;
    way.lead = &leads[0];
    way.spare = &leads[1];
    way.splits_left = 1;
    way.is_way = true;
    way.sent_ways = false;
    if (turn(&way, surface, wo, &next) == STEP_SCATTERED) walk_path(&way);
}

/* A path that goes on by a mirror is one of few that do, and tells of one direction: sunlight
 * by way of a pane or of a satin ring would hang on a handful of paths. Ways cost a ray or two;
 * a vertex asks hundreds. */
static void send_ways(const PathWalk *walk, const Surface *surface, Vec3 wo, const Lead *lead)
{
    if (!walk->far->has_ways || walk->bounce + 1 >= walk->context->max_bounces) return;
    for (int i = 0; i < PATH_WAYS; i++) send_way(walk, surface, wo, lead, i);
}

static void add_light_samples(PathWalk *walk, const Surface *surface, Vec3 wo,
                              const Lead *lead)
{
    if (!bsdf_scatters(&surface->bsdf)) return;
    if (walk->far) {
        ask_far(walk, surface, wo, lead);
        send_ways(walk, surface, wo, lead);
        return;
    }
    for (int set = 0; set < LIGHT_SETS; set++)
        if (lights_has(walk->context->lights, (LightSet)set))
            add_light_sample(walk, surface, wo, lead, (LightSet)set);
    add_mirrored_suns(walk, surface, wo);
}

/* ---- the walk --------------------------------------------------------------------------- */

static bool is_glazed(const Surface *surface)
{
    return surface->bsdf.kind == BSDF_GLAZED_WINDOW;
}

/* Along the surface from where it was met, towards wi, by so much: images of a pane's far face
 * start there, and what is seen through a pane goes on there. A pane may be curved: the ray
 * starts a little along its way. */
static Vec3 beside(const Surface *surface, Vec3 wi, float along)
{
    Vec3 n = surface->frame.z;
    Vec3 towards = vec3_normalize(vec3_along(wi, n, -vec3_dot(wi, n)));
    Vec3 place = vec3_along(surface->position, towards, along);
    return ray_offset_origin(vec3_along(place, wi, OFF_PANE * fabsf(along)), surface->ng, wi);
}

static bool lets_pass(void *user, const Hit *hit)
{
    (void)user, (void)hit;
    return true;
}

/* Does the pane's frame, or what else is opaque, stand before where the image of its far face
 * starts? Near the rim that is under the frame, or beyond it. Asked along the ray: a pane goes
 * on under its seal. along: above 0. */
static bool is_framed(const PathWalk *walk, const Surface *surface, Vec3 wi, float along)
{
    float cosine = vec3_dot(wi, surface->frame.z), flat2 = 1 - cosine * cosine;
    float reach = along * (1 / sqrtf(fmaxf(flat2, 1e-6f)) + 2 * OFF_PANE); /* and a little */
    Ray   ray = {ray_offset_origin(surface->position, surface->ng, wi), wi, 0, reach};
    walk->statistics->shadow_rays++;
    return bvh_occluded(walk->context->bvh, ray, lets_pass, NULL);
}

/* Only what the eye itself sees through a pane is moved: no light sample has asked for it. */
static Vec3 behind_pane(const PathWalk *walk, const Surface *surface)
{
    Vec3  way = walk->ray.direction;
    float cosine = fabsf(vec3_dot(surface->frame.z, way));
    return beside(surface, way, glazing_shift(surface->bsdf.glazed_window.pane, cosine));
}

/* Goes straight on behind the surface, a hole or a window: to what else lies there; then past
 * it, from where an opaque surface in the same plane is still met. */
static void go_on_behind(PathWalk *walk, const Surface *surface)
{
    if (walk->tale) walk->tale->pane_id = surface->part_id;
    Vec3  direction = walk->ray.direction, ng = surface->ng;
    float cosine = fabsf(vec3_dot(ng, direction));
    if (walk->stack->next < walk->stack->count) return;
    walk->sheets_from =
        walk->stack->count ? 2 * ray_offset_step(surface->position) / fmaxf(cosine, 1e-6f) : 0;
    Vec3 side = walk->stack->count ? vec3_neg(direction) : direction;
    walk->ray = (Ray){ray_offset_origin(surface->position, ng, side), direction, 0, INFINITY};
    if (is_glazed(surface) && !walk->bounce && !walk->stack->count)
        walk->ray.origin = behind_pane(walk, surface);
}

/* Ends dim paths; what survives is made stronger, so that the mean stays (Arvo and Kirk 1990).
 * The square root spares the light that reaches shadows by way of dark leather. Measured over
 * both cockpits, a guided path is worth more than that: what it finds costs little beside the
 * vertices before it. */
static bool roulette(PathWalk *walk)
{
    if (walk->bounce < ROULETTE_FIRST_BOUNCE) return true;
    numbers_for(walk, NUMBERS_ROULETTE);
    float share = spectrum_max_lane(walk->throughput) / walk->bright;
    float survival = fminf(ROULETTE_GENEROSITY * sqrtf(share), 1);
    if (sampler_1d(walk->sampler) >= survival) return false;
    walk->throughput *= spectrum_all(1 / survival);
    return true;
}

/* What of the sun that the path may meet in this direction was not told before. */
static Spectrum sun_share(const PathWalk *walk, const Surface *surface, Vec3 wo,
                          const BsdfSample *next)
{
    if (!(next->wi.z > 0) || !mirror_was_asked(walk, surface, wo, !next->is_delta))
        return spectrum_all(1);
    return sun_mirror_share(&surface->bsdf, surface->local_wo, next);
}

static bool is_display(const Scene *scene, const Surface *surface)
{
    return surface->material_id != NO_ID &&
           scene->materials[surface->material_id].display_id != NO_ID;
}

/* What the first surface reflects is asked for, be it ever so dark. */
static bool asks_the_first(const PathWalk *walk, const Surface *surface)
{
    return walk->context->is_probe || is_display(walk->context->scene, surface);
}

/* At the first surface: what comes from now on came by way of a display's mirror. */
static void note_mirror(PathWalk *walk, const Surface *surface, const BsdfSample *next)
{
    if (!walk->first || !next->is_delta || !is_display(walk->context->scene, surface)) return;
    walk->by_mirror = true;
    walk->before_mirror = walk->gathered;
}

/* The path goes on, towards wi, on the other side of the surface: of a solid that is inside or
 * outside. */
static void cross(PathWalk *walk, const Surface *surface, Vec3 local_wi, Vec3 wi)
{
    bool refracts = surface->bsdf.kind == BSDF_DIELECTRIC;
    bool is_inside = refracts ? local_wi.z < 0 : vec3_dot(wi, surface->ng) < 0;
    const Material *m = &walk->context->scene->materials[surface->material_id];
    if (refracts || material_is_translucent_solid(m))
        walk->medium_id = is_inside ? surface->material_id : NO_ID;
}

/* Turns the path into direction next->wi (local) at a scattering vertex. */
static Step turn(PathWalk *walk, const Surface *surface, Vec3 wo, const BsdfSample *next)
{
    Vec3 wi = frame_to_world(&surface->frame, next->wi);
    Vec3 start = next->along == 0 ? ray_offset_origin(surface->position, surface->ng, wi)
                                  : beside(surface, wi, next->along);
    float way = next->wi.z * surface->local_wo.z; /* below 0: across */
    if (!sides_agree(surface, next->wi, wi, wo)) return STEP_ENDED;
    if (next->along != 0 && is_framed(walk, surface, wi, next->along)) return STEP_ENDED;
    walk->sun_share = sun_share(walk, surface, wo, next);
    if (way < 0) cross(walk, surface, next->wi, wi);
    note_step(walk, surface,
              !next->is_delta ? PATH_SCATTERS
                              : way > 0 ? PATH_REFLECTS : PATH_TRANSMITS);
    if (walk->footprint && !footprint_turn(walk->footprint, walk->context->scene, surface, wo,
                                           next, walk->straight))
        walk->footprint = NULL;
    walk->last = lit_point(walk, surface);
    walk->last_part_id = surface->part_id;
    walk->last_pdf = next->pdf;
    walk->last_is_delta = next->is_delta;
    if (walk->far && walk->far->has_ways && !walk->is_way) walk->sent_ways |= !next->is_delta;
    walk->straight = walk->sheets_from = 0;
    sheets_none(walk->stack);
    note_mirror(walk, surface, next);
    if (!walk->bounce && asks_the_first(walk, surface))
        walk->bright = spectrum_max_lane(walk->throughput);
    walk->bounce++;
    walk->ray = (Ray){start, vec3_normalize(wi), 0, INFINITY};
    return walk->is_way || roulette(walk) ? STEP_SCATTERED : STEP_ENDED;
}

/* The spare lead becomes that of the last vertex. */
static void keep_lead(PathWalk *walk)
{
    Lead *last = walk->lead;
    walk->lead = walk->spare;
    walk->spare = last;
}

/* The way by a first display's mirror, of which nothing is left to chance; false: that is not
 * what is asked. */
static bool take_mirror(const PathWalk *walk, const Surface *surface, BsdfSample *next)
{
    Vec3 local_wo = surface->local_wo;
    if (!walk->far || !walk->far->is_of_mirror || walk->bounce ||
        !is_display(walk->context->scene, surface))
        return false;
    *next = (BsdfSample){.wi = vec3(-local_wo.x, -local_wo.y, local_wo.z), .pdf = 1,
                         .weight = bsdf_mirror(&surface->bsdf, local_wo), .is_delta = true};
    return true;
}

/* Does the way go on? Vertices behind a sharp lobe send out their own. */
static bool keeps_way(PathWalk *walk, const Surface *surface, const BsdfSample *next)
{
    if (walk->way_pdf > 0) return false;
    if (next->is_delta) return true;
    if (!is_sharp(surface)) return false;
    walk->way_pdf = PATH_WAYS * next->pdf;
    return true;
}

/* Chooses where the path goes from the surface, by the spare lead. Windows can be passed after
 * the last bounce. */
static Step scatter(PathWalk *walk, const Surface *surface, Vec3 wo)
{
    float u[4];
    BsdfSample next;
    numbers_for(walk, NUMBERS_SCATTER);
    sampler_4d(walk->sampler, u);
    if (!take_mirror(walk, surface, &next) && !lead_sample(walk->spare, surface, u, &next))
        return STEP_ENDED;
    walk->throughput *= next.weight;
    turn_polarised(walk, surface, wo, &next);
    if (spectrum_is_zero(walk->throughput)) return STEP_ENDED;
    if (next.passes) {
        go_on_behind(walk, surface);
        return STEP_PASSED;
    }
    if (walk->bounce >= walk->context->max_bounces) return STEP_ENDED;
    if (walk->far && walk->far->add_image && !next.is_delta) return STEP_ENDED;
    if (walk->is_way && !keeps_way(walk, surface, &next)) return STEP_ENDED;
    keep_lead(walk);
    if (tells_lambertian(walk, surface)) note_way(walk, surface, &next);
    return turn(walk, surface, wo, &next);
}

/* What the ray meets; of what lies in one plane, one after the other. */
static bool next_hit(PathWalk *walk, Hit *hit)
{
    const PathContext *context = walk->context;
    SheetStack *stack = walk->stack;
    if (stack->next < stack->count) {
        *hit = stack->hit[stack->next++];
        return true;
    }
    *(walk->bounce ? &walk->statistics->bounce_rays : &walk->statistics->camera_rays) += 1;
    if (!bvh_intersect(context->bvh, walk->ray, walk->sheets_from, hit)) return false;
    walk->straight += hit->t;
    if (walk->medium_id != NO_ID) absorb(walk, walk->medium_id, hit->t, &walk->throughput);
    sheets_none(stack);
    if (!bvh_has_sheets(context->bvh) || hit->t < walk->sheets_from) return true;
    sheets_at(context->scene, context->bvh, hit, walk->ray.direction, stack);
    *hit = stack->hit[stack->next++];
    return true;
}

static void record_first(PathWalk *walk, const Hit *hit, float distance, Vec3 wo)
{
    if (!walk->first) return;
    walk->first->hit = true;
    walk->first->first = *hit;
    walk->first->first.t = distance;
    walk->first->direction = vec3_neg(wo);
    walk->first = NULL;
}

/* For a guide that is to learn. */
static void note_place(PathWalk *walk, const Lead *lead, const Surface *surface, Vec3 wo)
{
    PathPlaces *places = walk->places;
    if (!places || !lead->is_wide || places->count == PATH_PLACES_MAX) return;
    Vec3 origin = ray_offset_origin(surface->position, surface->ng, wo);
    places->place[places->count++] = (LitPoint){origin, surface->frame.z, false};
}

/* What happens at a surface that is there. */
static Step shade(PathWalk *walk, const Surface *surface, const Hit *hit, Vec3 wo)
{
    Lead *lead = walk->spare;
    if (!walk->far) add_emitted(walk, surface, hit, wo);
    lead_at(walk->context, surface, wo, walk->bounce, lead);
    note_place(walk, lead, surface, wo);
    if (walk->bounce < walk->context->max_bounces && !walk->is_way)
        add_light_samples(walk, surface, wo, lead);
    return scatter(walk, surface, wo);
}

/* The images of a pane and its haze. */
static Step show_pane(PathWalk *walk, const Surface *surface, const Hit *hit, Vec3 wo)
{
    Surface pane = *surface;
    pane.bsdf.glazed_window.shows_itself = true;
    return shade(walk, &pane, hit, wo);
}

static Step reflect_window(PathWalk *walk, const Surface *surface, Vec3 wo)
{
    Vec3 local_wo = surface->local_wo;
    BsdfSample mirror = {.wi = vec3(-local_wo.x, -local_wo.y, local_wo.z), .is_delta = true,
                         .pdf = 1};
    if (walk->bounce >= walk->context->max_bounces) return STEP_ENDED;
    walk->throughput *= thin_window_reflectance(&surface->bsdf.thin_window, local_wo.z);
    turn_polarised(walk, surface, wo, &mirror);
    return turn(walk, surface, wo, &mirror);
}

/* What the sheet itself shows to the eye: its mirror image, or what of it is not a hole. share:
 * of samples that ask. */
static void add_sheet(PathWalk *walk, const Surface *surface, const Hit *hit, Vec3 wo,
                      float share)
{
    PathWalk   sheet = *walk;
    SheetStack rest;
    PathTale   tale;
    Polarised  polarised;
    RayFootprint footprint;
    if (walk->stack->count) rest = *walk->stack;
    else sheets_none(&rest);
    sheet.stack = &rest;
    sheet.splits_left = 0;
    sheet.steps += STEPS_FAR * (1 + walk->splits_left);
    sheet.first = NULL;
    sheet.gathered = (PathLight){.radiance = spectrum_all(0)};
    sheet.throughput *= spectrum_all(surface->alpha / share);
    if (walk->tale) {
        tale = *walk->tale;
        sheet.tale = &tale;
    }
    if (walk->polarised) {
        polarised = *walk->polarised;
        sheet.polarised = &polarised;
    }
    if (walk->footprint) {
        footprint = *walk->footprint;
        sheet.footprint = &footprint;
    }
    Step step = surface->alpha < 1    ? shade(&sheet, surface, hit, wo)
                : is_glazed(surface) ? show_pane(&sheet, surface, hit, wo)
                                     : reflect_window(&sheet, surface, wo);
    if (step != STEP_ENDED) walk_path(&sheet);
    path_light_add(&walk->gathered, &sheet.gathered);
}

/* From the eye, or a way's first. */
static bool may_split(const PathWalk *walk)
{
    bool is_first = walk->is_way ? !walk->last_is_delta && !(walk->way_pdf > 0)
                                 : !walk->bounce;
    return is_first && walk->splits_left;
}

/* The first thin sheets (windows, holes) that the eye looks through are followed both ways, the
 * sheet itself in every second sample. By chance, one sample in twelve would show the cabin's
 * mirror image and not the street: noise that everyone sees. False: this is no such sheet. */
static bool split(PathWalk *walk, const Surface *surface, const Hit *hit, Vec3 wo)
{
    bool is_hole = surface->alpha > 0 && surface->alpha < 1;
    bool is_window = surface->alpha >= 1 &&
                     (surface->bsdf.kind == BSDF_THIN_WINDOW || is_glazed(surface));
    float share = walk->is_way ? 1 : SHEET_SHARE;
    if (!may_split(walk) || !(is_hole || is_window)) return false;
    walk->splits_left--;
    numbers_for(walk, NUMBERS_SPLIT);
    if (sampler_1d(walk->sampler) < share) add_sheet(walk, surface, hit, wo, share);
    walk->throughput *=
        is_hole ? spectrum_all(1 - surface->alpha)
                : bsdf_pass(&surface->bsdf, surface->local_wo);
    if (is_window && walk->polarised) pass_polarised(walk, surface, wo);
    go_on_behind(walk, surface);
    return true;
}

/* What counts of light that a surface sends to the eye itself. */
static Spectrum through_to(PathWalk *walk, const Surface *surface, const Hit *hit, Vec3 wo)
{
    PolarisedLight room;
    if (!walk->polarised) return walk->throughput;
    const PolarisedLight *from =
        emitter_light(walk, hit->triangle, &surface->point, wo, &room);
    return walk->throughput * polarised_seen(walk->polarised, 0, wo, from);
}

/* The loop: what is hit, what it emits, what the lights send it, where the path goes on. */
static void walk_path(PathWalk *walk)
{
    const PathContext *context = walk->context;
    for (int steps = 0; steps < PASSES_MAX + context->max_bounces; steps++) {
        Hit     hit;
        Surface surface;
        if (!next_hit(walk, &hit)) {
            add_distant(walk);
            return;
        }
        Vec3  wo = vec3_neg(walk->ray.direction);
        float distance = walk->straight;
        walk->steps++;
        surface_at(context->scene, context->tables, &hit, wo, walk->wavelengths, &surface);
        if (surface.bsdf.kind == BSDF_DIELECTRIC)
            surface.bsdf.dielectric.light = &walk->throughput;
        if (walk->tale) walk->tale->reached_by = walk->tale->pane_id;
        if (split(walk, &surface, &hit, wo)) continue;
        numbers_for(walk, NUMBERS_HOLE);
        if (surface.alpha < 1 && sampler_1d(walk->sampler) >= surface.alpha) {
            go_on_behind(walk, &surface);
            continue;
        }
        BsdfRoom room;
        bsdf_look(&surface.bsdf, surface.local_wo, &room);
        if (walk->first) walk->first->through = through_to(walk, &surface, &hit, wo);
        Step step = shade(walk, &surface, &hit, wo);
        if (step != STEP_PASSED) record_first(walk, &hit, distance, wo);
        if (step == STEP_ENDED) return;
    }
}

static bool has_subpixels(const Scene *scene)
{
    for (int i = 0; i < scene->display_count; i++)
        if (scene->displays[i].subpixels) return true;
    return false;
}

PathContext path_context_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                               int max_bounces, Arena *arena)
{
    PathContext context = {.scene = scene, .bvh = bvh, .max_bounces = max_bounces,
                           .tables = surface_tables_build(scene, false, arena),
                           .has_subpixels = has_subpixels(scene), .strategy = PATH_MIS};
    return path_context_relight(&context, lights, arena);
}

PathContext path_context_relight(const PathContext *before, const Lights *lights, Arena *arena)
{
    PathContext     context = *before;
    const BeamTools tools = {context.scene, context.bvh, lights, context.tables};
    context.lights = lights;
    context.guide = NULL;
    context.selection = light_selection_build(context.scene, context.bvh, lights, arena);
    context.beams = mirror_beams_build(&tools, &context.selection, arena);
    return context;
}

static PathWalk walk_start(const PathContext *context, const Wavelengths *wavelengths,
                           Sampler *sampler, PathStatistics *statistics, WalkRoom *room)
{
    statistics->samples++;
    sheets_none(&room->stack);
    lead_alone(context, &room->leads[0]);
    return (PathWalk){.context = context, .wavelengths = wavelengths, .sampler = sampler,
                  .statistics = statistics, .throughput = spectrum_all(1), .bright = 1,
                  .gathered.radiance = spectrum_all(0), .last.ns = vec3(0, 0, 1),
                  .last_is_delta = true, .last_part_id = NO_ID,
                  .sun_share = spectrum_all(1),
                  .lead = &room->leads[0], .spare = &room->leads[1],
                  .splits_left = SPLITS,
                  .medium_id = NO_ID, .stack = &room->stack};
}

/* The camera's ray carries how light must be polarised to count. */
static void put_eye(PathWalk *walk, Vec3 direction, PathResult *out, WalkRoom *room)
{
    const PolarisedEye *eye = walk->context->eye;
    if (!eye) return;
    walk->polarised = &room->polarised;
    walk->panes = &room->panes;
    polarised_start(eye, direction, walk->polarised);
    take_polarised(walk);
    if (eye->with_stokes) walk->stokes = out->stokes;
}

/* The rays of a frame carry what its pixels cover, where a display wants to know. */
static void put_footprint(PathWalk *walk, Vec3 direction, WalkRoom *room)
{
    const PathContext *context = walk->context;
    if (!context->has_subpixels || !(context->cone.width + context->cone.spread > 0)) return;
    walk->footprint = &room->footprint;
    room->footprint = footprint_of_cone(context->cone, direction);
}

/* The analysers found S0 too. */
static void stokes_of_analysers(PathResult *out)
{
    for (int i = 0; i < 3; i++) out->stokes[i] -= out->xyz[1];
}

static void trace(PathWalk *walk, Ray ray, PathResult *out, WalkRoom *room)
{
    *out = (PathResult){.hit = false};
    walk->ray = ray;
    walk->first = out;
    put_eye(walk, ray.direction, out, room);
    put_footprint(walk, ray.direction, room);
    walk_path(walk);
    path_light_to_xyz(&walk->gathered, walk->wavelengths, out->xyz);
    if (walk->stokes) stokes_of_analysers(out);
    if (walk->lambertian) tell_lambertian(walk, out->lambertian);
    if (!walk->by_mirror) return;
    path_light_take(&walk->gathered, &walk->before_mirror);
    path_light_to_xyz(&walk->gathered, walk->wavelengths, out->mirror);
}

void path_trace(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                Sampler *sampler, PathResult *out, PathStatistics *statistics)
{
    WalkRoom room;
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    trace(&walk, ray, out, &room);
}

static PathTale tale_start(const Wavelengths *wavelengths)
{
    return (PathTale){.pane_id = NO_ID, .reached_by = NO_ID, .wavelengths = wavelengths};
}

void path_trace_apart(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                      Sampler *sampler, const PathApart *apart, PathStatistics *statistics)
{
    WalkRoom       room;
    LambertianPart part = {.share = spectrum_all(0)};
    PathTale       tale = tale_start(wavelengths);
    PathWalk       walk = walk_start(context, wavelengths, sampler, statistics, &room);
    if (apart->with_lambertian) walk.lambertian = &part;
    if (apart->listener) {
        tale.towards = ray.direction;
        walk.listener = apart->listener;
        walk.tale = &tale;
    }
    trace(&walk, ray, apart->result, &room);
}

void path_trace_told(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                     Sampler *sampler, const PathListener *listener,
                     PathStatistics *statistics)
{
    WalkRoom room;
    PathTale tale = tale_start(wavelengths);
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    tale.towards = ray.direction;
    walk.ray = ray;
    walk.listener = listener;
    walk.tale = &tale;
    put_footprint(&walk, ray.direction, &room);
    walk_path(&walk);
}

void path_ask_far(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                  Sampler *sampler, const PathFar *far, PathStatistics *statistics)
{
    WalkRoom room;
    PathTale tale = {.towards = ray.direction, .pane_id = NO_ID};
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    walk.ray = ray;
    walk.far = far;
    if (far->add_image) walk.tale = &tale;
    walk_path(&walk);
}

void path_find_places(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                      Sampler *sampler, PathPlaces *out, PathStatistics *statistics)
{
    WalkRoom room;
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    out->count = 0;
    walk.ray = ray;
    walk.places = out;
    walk_path(&walk);
}

void path_arriving(const PathContext *context, const PathArrival *at,
                   const Wavelengths *wavelengths, Sampler *sampler, float cd_m2[GUIDE_AIMS],
                   PathStatistics *statistics)
{
    WalkRoom room;
    float    xyz[3];
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    cd_m2[GUIDE_SKY] = 0;
    walk.arriving_sky = &cd_m2[GUIDE_SKY];
    walk.ray = (Ray){at->point.position, at->towards, 0, INFINITY};
    walk.last = at->point;
    walk.last_is_delta = false;
    walk.last_pdf = ARRIVING_PDF;
    walk.bounce = 1;
    walk_path(&walk);
    path_light_to_xyz(&walk.gathered, wavelengths, xyz);
    cd_m2[GUIDE_LIGHT] = xyz[1];
}

/* A white surface sends pi-th parts of its illuminance. */
static void walk_from_head(PathWalk *walk, LitPoint point)
{
    Surface head;
    surface_white(walk->context->tables, point.position, point.ns, &head);
    walk->throughput = spectrum_all(PI_F);
    lead_alone(walk->context, walk->spare);
    add_light_samples(walk, &head, point.ns, walk->spare);
    if (scatter(walk, &head, point.ns) != STEP_SCATTERED) return;
    if (walk->tale) walk->tale->towards = walk->ray.direction;
    walk_path(walk);
}

void path_illuminance_told(const PathContext *context, LitPoint point,
                           const Wavelengths *wavelengths, Sampler *sampler,
                           const PathListener *listener, PathStatistics *statistics)
{
    WalkRoom room;
    PathTale tale = tale_start(wavelengths);
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    walk.listener = listener;
    walk.tale = &tale;
    walk_from_head(&walk, point);
    if (listener->all) path_light_to_xyz(&walk.gathered, wavelengths, listener->all);
}

void path_ask_far_at(const PathContext *context, LitPoint point, const Wavelengths *wavelengths,
                     Sampler *sampler, const PathFar *far, PathStatistics *statistics)
{
    WalkRoom room;
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    walk.far = far;
    walk_from_head(&walk, point);
}

void path_illuminance(const PathContext *context, LitPoint point,
                      const Wavelengths *wavelengths, Sampler *sampler, float xyz_lx[3],
                      PathStatistics *statistics)
{
    WalkRoom room;
    PathWalk walk = walk_start(context, wavelengths, sampler, statistics, &room);
    walk_from_head(&walk, point);
    path_light_to_xyz(&walk.gathered, wavelengths, xyz_lx);
}
