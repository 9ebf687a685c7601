/* SPDX-License-Identifier: Apache-2.0 */
#include "path/mirror_beams.h"

#include <stdlib.h>
#include <string.h>

#include "base/mathf.h"
#include "base/parallel.h"
#include "base/sampler.h"
#include "scene/point/ray_ends.h"
#include "mirror/mirrors_build.h"
#include "path/sheets.h"
#include "shaders/facets/microfacet.h"

#define LEAST_RAYS \
    8 /* to every mirror's triangle, half as many of near lights, and by its \
         share of all their area: */
#define RAYS_BY_AREA 25000
#define DARK_RAYS 2      /* that do not get through, of a small mirror: it is left alone */
#define FIRST_ROOM 1024  /* of pairs, of glints */
#define SHEETS_PASSED 16 /* by one ray behind its mirror */
#define GENEROSITY 0.2f  /* times the root of mirrored over other light, of one mirror */
#define LEAST 0.0075f    /* probability where no ray came */
#define OF_NEAR 0.25f    /* times both of near lights, whose search takes longer; in a frame: */
#define OF_NEAR_IN_FRAMES 0.12f
#define OF_POINTS 0.25f /* most probability of points of no part to search all mirrors; */
#define OF_ALL 1.5f     /* so much over the root of their number, about as the search takes time */
#define CUBES 128       /* along the longest edge of a part's box, and at least so large: */
#define LEAST_EDGE_M 1e-4f
#define LEAST_LX 1e-6f   /* of other light */
#define ANY_SOURCE 0.15f /* of the choices, that go to all alike */

/* Where a ray of the light lands behind a mirror. */
typedef struct Glint {
    GlintPlace place;
    float lm;
    int source_id; /* as BeamSource */
} Glint;

/* Finds of some of the rays; other threads may follow others. */
typedef struct Beams {
    const BeamTools *tools;
    BeamSet set;
    Arena *arena; /* nothing else allocates from it meanwhile */
    MirrorPair *pairs;
    uint32_t count, room;
    Glint *glints;
    uint32_t glint_count, glint_room;
    const BeamSide *sides;          /* as in MirrorBeams */
    const Wavelengths *wavelengths; /* of all rays: what they bring is an estimate */
    const CompactEmitters *emitters;
} Beams;

/* One ray of the light behind its mirror. */
typedef struct Beam {
    Ray ray;
    uint32_t triangle;
    bool is_rough;
    float lm;
    int source_id; /* as BeamSource */
} Beam;

/* Rays of one mirror come one after the other. */
static void add_pair(Beams *beams, MirrorPair pair) {
    for (uint32_t i = beams->count; i > 0 && beams->pairs[i - 1].triangle == pair.triangle; i--)
        if (!mirrors_compare_pairs(&beams->pairs[i - 1], &pair)) return;
    if (beams->count == beams->room) {
        beams->room = beams->room ? 2 * beams->room : FIRST_ROOM;
        beams->pairs =
            ARENA_GROW(beams->arena, MirrorPair, beams->pairs, beams->count, beams->room);
    }
    beams->pairs[beams->count++] = pair;
}

static void add_glint(Beams *beams, Glint glint) {
    if (beams->glint_count == beams->glint_room) {
        beams->glint_room = beams->glint_room ? 2 * beams->glint_room : FIRST_ROOM;
        beams->glints =
            ARENA_GROW(beams->arena, Glint, beams->glints, beams->glint_count, beams->glint_room);
    }
    beams->glints[beams->glint_count++] = glint;
}

/* A part that scatters more narrowly than a rough mirror finds the light in it by itself. */
static bool is_asked_of(const Scene *scene, int part_id, const Beam *beam) {
    const Material *m = &scene->materials[scene->parts[part_id].material_id];
    return !beam->is_rough || m->roughness * m->roughness > 2 * GLINT_ALPHA;
}

/* All parts along the ray, up to one that stops it. */
static void follow(Beams *beams, Beam beam) {
    const Scene *scene = beams->tools->scene;
    Hit hit;
    if (beams->set == BEAMS_OF_SUN)
        add_pair(beams, (MirrorPair){NO_ID, beam.is_rough, beam.triangle});
    for (int i = 0; i < SHEETS_PASSED && bvh_intersect(beams->tools->bvh, beam.ray, 0, &hit); i++) {
        TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
        int part_id = (int)scene->triangles[hit.triangle].part_id;
        if (is_asked_of(scene, part_id, &beam)) {
            add_pair(beams, (MirrorPair){part_id, beam.is_rough, beam.triangle});
            const BeamSide *side =
                &beams->sides[2 * part_id + (vec3_dot(point.ng, beam.ray.direction) > 0)];
            add_glint(beams,
                      (Glint){{side->row, side->edge_m, point.position}, beam.lm, beam.source_id});
        }
        if (hit.triangle < scene->opaque_count) return;
        beam.ray.origin = ray_start(&point, beam.ray.direction);
    }
}

/* Luminous flux that the light's ray takes on, per m2 of the mirror; of a rough one about. */
static double reflected_lx(const Lights *lights, const Surface *mirror, const LightSample *light,
                           Vec3 local_wo, const Wavelengths *wavelengths) {
    float xyz[3] = {0};
    Spectrum smooth = bsdf_mirror(&mirror->bsdf, local_wo);
    Spectrum share = spectrum_is_zero(smooth) ? bsdf_albedo(&mirror->bsdf, local_wo) : smooth;
    share *= spectrum_all(fabsf(vec3_dot(mirror->ng, light->wi)) / light->pdf);
    spectrum_add_xyz(wavelengths, share * lights_radiance(lights, light, wavelengths), xyz);
    return isfinite(xyz[1]) ? (double)xyz[1] : 0;
}

/* A rough mirror's facet, leaning as GGX facets do. */
static Vec3 facet_normal(Vec3 ns, float alpha, Vec2 u) {
    Frame frame = frame_from_z(ns);
    float sine, cosine, lean = alpha * sqrtf(u.x / (1 - u.x));
    sincos_turns(u.y, &sine, &cosine);
    return vec3_normalize(frame_to_world(&frame, vec3(lean * cosine, lean * sine, 1)));
}

/* A mirror's triangle that rays are sent to; alpha 0: smooth. */
typedef struct Aim {
    uint32_t triangle;
    float alpha;
    double ray_m2; /* that one ray stands for */
} Aim;

/* Light for a place of a mirror, that counts so many times. */
typedef struct BeamLight {
    LightSample sample;
    int source_id;
    float times;
} BeamLight;

/* u: two numbers which, two where on it. Compact emitters are chosen evenly. */
static bool choose_light(const Beams *beams, LitPoint place, const float u[4], BeamLight *out) {
    const Lights *lights = beams->tools->lights;
    const Scene *scene = beams->tools->scene;
    const float of_sun[3] = {u[2], u[3], 0}, of_lamp[3] = {u[0], u[2], u[3]};
    const float on_emitter[3] = {u[1], u[2], u[3]};
    out->source_id = 0;
    out->times = 1;
    if (beams->set == BEAMS_OF_SUN)
        return lights_sample(lights, LIGHTS_SUN, place, of_sun, &out->sample);
    if (beams->set == BEAMS_OF_LAMPS) {
        bool is_lit = lights_sample(lights, LIGHTS_PUNCTUAL, place, of_lamp, &out->sample);
        if (is_lit) out->source_id = out->sample.light_id;
        return is_lit;
    }
    int count = beams->emitters->count, which = (int)(u[0] * (float)count);
    out->source_id = which < count ? which : count - 1;
    const CompactEmitter *emitter = &beams->emitters->list[out->source_id];
    CompactPoint point = compact_emitter_point(scene, emitter, on_emitter);
    float m2;
    if (!compact_emitter_towards(scene, emitter, &point, place.position, &out->sample, &m2))
        return false;
    out->times = (float)count * m2 / (out->sample.distance * out->sample.distance);
    return true;
}

/* The sampler's numbers in turn: which lamp and a second for nothing, place, direction or place
 * of the lamp, facet. False: no light comes to the mirror there, or it goes nowhere. */
static bool send_ray(Beams *beams, const Aim *aim, Sampler sampler) {
    const BeamTools *tools = beams->tools;
    Surface mirror;
    BeamLight chosen;
    const LightSample *light = &chosen.sample;
    float first[4], last[4];
    sampler_4d(&sampler, first);
    sampler_4d(&sampler, last);
    Vec2 at = {first[2], first[3]}, lean = {last[2], last[3]};
    if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
    Hit hit = {0, at.x, at.y, aim->triangle};
    TrianglePoint point = triangle_point(tools->scene, aim->triangle, at.x, at.y);
    LitPoint place = {point.position, point.ns, true};
    const float u[4] = {first[0], first[1], last[0], last[1]};
    if (!choose_light(beams, place, u, &chosen)) return false;
    Vec3 n = aim->alpha > 0 ? facet_normal(point.ns, aim->alpha, lean) : point.ns;
    Vec3 r = vec3_sub(vec3_scale(n, 2 * vec3_dot(n, light->wi)), light->wi);
    if (!(vec3_dot(point.ng, r) * vec3_dot(point.ng, light->wi) > 0)) return false;
    Vec3 origin = ray_start(&point, r);
    if (bvh_occluded(tools->bvh, lights_ray(origin, light), sheets_let_pass, NULL)) return false;
    surface_at(tools->scene, tools->tables, &hit, r, beams->wavelengths, &mirror);
    double lx = reflected_lx(tools->lights, &mirror, light, frame_to_local(&mirror.frame, r),
                             beams->wavelengths);
    if (!(lx > 0)) return false;
    follow(beams, (Beam){{origin, r, 0, INFINITY},
                         aim->triangle,
                         aim->alpha > 0,
                         (float)(lx * aim->ray_m2) * chosen.times,
                         chosen.source_id});
    return true;
}

/* Sends more rays to large triangles; a small one that is dark at two well spread places is
 * left alone. all_m2: area of all mirrors. */
static void send_rays(Beams *beams, Aim aim, double all_m2) {
    double own = scene_triangle_m2(beams->tools->scene, aim.triangle);
    uint32_t least = beams->set == BEAMS_OF_SUN ? LEAST_RAYS : LEAST_RAYS / 2;
    uint32_t rays = least + (uint32_t)(RAYS_BY_AREA * own / all_m2), sent = 0;
    aim.ray_m2 = own / rays;
    for (uint32_t k = 0; k < rays && (sent || k < DARK_RAYS || rays > 2 * least); k++)
        sent += send_ray(beams, &aim, sampler_start(aim.alpha > 0, (int)aim.triangle, 0, k));
}

/* ---- all rays ---------------------------------------------------------------------------- */

#define PIECES 64                      /* of the rays; the same for any number of threads */
#define WORKER_BYTES ((size_t)1 << 30) /* address space: what is not touched costs nothing */

/* Lists every mirror's triangle: as a smooth one, then as a rough one, if its material is. */
static Aim *list_aims(const Scene *scene, int *count, double *all_m2, Arena *arena) {
    Arena scratch = *arena;
    bool *is_smooth_one = ARENA_NEW(&scratch, bool, scene->material_count + 1);
    for (int i = 0; i < scene->material_count; i++)
        is_smooth_one[i] = mirrors_can_be(scene, &scene->materials[i]);
    size_t most = 0;
    for (int i = 0; i < scene->part_count; i++) {
        int id = scene->parts[i].material_id;
        int ways = is_smooth_one[id] + (mirrors_rough_alpha(&scene->materials[id]) > 0);
        most += (size_t)ways * scene->parts[i].triangle_count;
    }
    Aim *aims = ARENA_NEW(&scratch, Aim, most);
    *count = 0;
    *all_m2 = 0;
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        int id = scene_part(scene, i)->material_id;
        float alpha = mirrors_rough_alpha(&scene->materials[id]);
        if (is_smooth_one[id] || alpha > 0) *all_m2 += scene_triangle_m2(scene, i);
        if (is_smooth_one[id]) aims[(*count)++] = (Aim){i, 0, 0};
        if (alpha > 0) aims[(*count)++] = (Aim){i, alpha, 0};
    }
    return arena_keep(arena, aims, (size_t)*count * sizeof *aims, _Alignof(Aim));
}

typedef struct RayWork {
    Beams *pieces;
    Arena *arenas; /* one a worker */
    const Aim *aims;
    int count;
    double all_m2;
} RayWork;

static void send_piece(void *user, int item, int worker) {
    const RayWork *work = user;
    work->pieces[item].arena = &work->arenas[worker];
    int first = (int)((int64_t)work->count * item / PIECES);
    int end = (int)((int64_t)work->count * (item + 1) / PIECES);
    for (int i = first; i < end; i++) send_rays(&work->pieces[item], work->aims[i], work->all_m2);
}

/* Every mirror is sampled where no part is known (mirror_beams.h). */
static uint32_t add_all_mirrors(const Scene *scene, const RayWork *work, MirrorPair *pairs) {
    uint32_t count = 0;
    for (int i = 0; i < work->count; i++)
        if (!(work->aims[i].alpha > 0) && scene_triangle_m2(scene, work->aims[i].triangle) > 0)
            pairs[count++] = (MirrorPair){NO_ID, false, work->aims[i].triangle};
    return count;
}

/* Joins the pieces in order: the result is that of a single thread. most_lx: of each row. */
static void join_pieces(const Beams *pieces, const RayWork *work, Beams *out, GlintMap *map,
                        float *most_lx, Arena *arena) {
    bool has_all = out->set != BEAMS_OF_SUN && !out->tools->is_of_frame;
    for (int p = 0; p < PIECES; p++) out->count += pieces[p].count;
    for (int p = 0; p < PIECES; p++) out->glint_count += pieces[p].glint_count;
    out->pairs = ARENA_NEW(arena, MirrorPair, out->count + (has_all ? (uint32_t)work->count : 0));
    out->glints = ARENA_NEW(arena, Glint, out->glint_count);
    uint32_t count = has_all ? add_all_mirrors(out->tools->scene, work, out->pairs) : 0, glint = 0;
    for (int p = 0; p < PIECES; p++)
        for (uint32_t i = 0; i < pieces[p].count; i++) out->pairs[count++] = pieces[p].pairs[i];
    for (int p = 0; p < PIECES; p++)
        for (uint32_t i = 0; i < pieces[p].glint_count; i++) {
            const Glint *g = &pieces[p].glints[i];
            float *most = &most_lx[g->place.row];
            out->glints[glint++] = *g;
            *most = max_f(*most, glint_map_add(map, &g->place, g->lm, arena));
        }
    out->count = count;
}

static void send_all_rays(Beams *beams, GlintMap *map, float *most_lx, Arena *arena) {
    Beams pieces[PIECES];
    RayWork work = {.pieces = pieces};
    int threads = bvh_threads(beams->tools->bvh);
    Arena scratch = arena_reserve(WORKER_BYTES);
    work.arenas = ARENA_NEW(&scratch, Arena, threads);
    for (int i = 0; i < threads; i++) work.arenas[i] = arena_reserve(WORKER_BYTES);
    work.aims = list_aims(beams->tools->scene, &work.count, &work.all_m2, &scratch);
    for (int p = 0; p < PIECES; p++)
        pieces[p] = (Beams){.tools = beams->tools,
                            .set = beams->set,
                            .sides = beams->sides,
                            .wavelengths = beams->wavelengths,
                            .emitters = beams->emitters};
    parallel_for(threads, PIECES, send_piece, &work);
    join_pieces(pieces, &work, beams, map, most_lx, arena);
    for (int i = 0; i < threads; i++) arena_release(&work.arenas[i]);
    arena_release(&scratch);
}

/* The two sides of a part that lets light through share a row: it is lit from both. */
static void measure_sides(const Scene *scene, BeamSide *sides) {
    for (int id = 0; id < scene->part_count; id++) {
        const Part *part = &scene->parts[id];
        bool is_sheet = material_sends_through(&scene->materials[part->material_id]);
        float edge = max_f(scene_part_longest_m(scene, part) / CUBES, LEAST_EDGE_M);
        for (int k = 0; k < 2; k++)
            sides[2 * id + k] =
                (BeamSide){.row = (uint32_t)(2 * id + (is_sheet ? 0 : k)), .edge_m = edge};
    }
}

/* With probability q an answer of the worth c adds c^2 / q to a pixel's variance, and takes q
 * times its time: the least of both together has q along c over the root of the time, and the
 * time grows about as the root of the mirrors sampled. Measured over views of both cockpits the
 * root of c does better than c, which is known by a few rays. */
MirrorBeams mirror_beams_weighed(const MirrorBeams *beams, const BeamTools *tools,
                                 const LightSelection *selection, Arena *arena) {
    const Scene *scene = tools->scene;
    const Mirrors *all = beams->mirrors;
    MirrorBeams out = *beams;
    if (!all) return out;
    BeamSide *sides = ARENA_NEW(arena, BeamSide, 2 * ((size_t)scene->part_count + 1));
    Arena scratch = *arena;
    uint32_t *mirrors = ARENA_NEW(&scratch, uint32_t, scene->part_count + 1);
    float of_near = tools->is_of_frame ? OF_NEAR_IN_FRAMES : OF_NEAR;
    memcpy(sides, beams->sides, 2 * (size_t)scene->part_count * sizeof *sides);
    out.sides = sides;
    for (uint32_t i = 0; i < all->pair_count; i++)
        if (all->pairs[i].part_id != NO_ID) mirrors[all->pairs[i].part_id]++;
    for (int row = 0; row < 2 * scene->part_count; row++) {
        BeamSide *side = &sides[row];
        float time = sqrtf(sqrtf((float)mirrors[row / 2]));
        if (!mirrors[row / 2]) continue;
        float share = beams->set == BEAMS_OF_SUN ? 1 : of_near;
        side->least = share * LEAST;
        side->by_root = share * GENEROSITY / (time * sqrtf(max_f(selection->lx[row], LEAST_LX)));
        side->most = min_f(side->least + side->by_root * sqrtf(beams->most_lx[side->row]), 1);
    }
    return out;
}

/* ---- which source ------------------------------------------------------------------------ */

/* Luminous flux of a source that landed in a row. */
typedef struct SourceGlint {
    uint32_t row;
    int id;
    float lm;
} SourceGlint;

static int compare_source_glints(const void *a, const void *b) {
    const SourceGlint *x = a, *y = b;
    if (x->row != y->row) return x->row < y->row ? -1 : 1;
    if (x->id != y->id) return x->id < y->id ? -1 : 1;
    return (x->lm > y->lm) - (x->lm < y->lm); /* so that sums do not depend on the order */
}

/* Every row's sources, each with its share of the row's flux. */
static void list_sources(const Beams *beams, MirrorBeams *out, Arena *arena) {
    int rows = 2 * beams->tools->scene->part_count;
    uint32_t *first = ARENA_NEW(arena, uint32_t, rows + 1), count = 0, at = 0;
    BeamSource *sources = ARENA_NEW(arena, BeamSource, beams->glint_count + 1);
    Arena scratch = *arena;
    SourceGlint *glints = ARENA_NEW(&scratch, SourceGlint, beams->glint_count + 1);
    for (uint32_t i = 0; i < beams->glint_count; i++) {
        const Glint *g = &beams->glints[i];
        glints[i] = (SourceGlint){g->place.row, g->source_id, g->lm};
    }
    qsort(glints, beams->glint_count, sizeof *glints, compare_source_glints);
    for (int row = 0; row < rows; row++) {
        double all = 0;
        first[row] = count;
        for (; at < beams->glint_count && glints[at].row == (uint32_t)row; at++) {
            bool is_new = count == first[row] || sources[count - 1].id != glints[at].id;
            if (is_new) sources[count++] = (BeamSource){glints[at].id, 0};
            sources[count - 1].prob += glints[at].lm;
            all += (double)glints[at].lm;
        }
        for (uint32_t i = first[row]; i < count; i++) sources[i].prob /= (float)all;
    }
    first[rows] = count;
    out->sources = sources;
    out->first = first;
}

/* A row's sources; any: share of the choices that go to all there are alike. */
typedef struct RowSources {
    const BeamSource *list;
    int count;
    float any;
} RowSources;

static RowSources sources_of(const MirrorBeams *beams, int part_id, bool is_back) {
    if (part_id == NO_ID) return (RowSources){.any = 1};
    uint32_t row = beams->sides[2 * part_id + is_back].row, first = beams->first[row];
    int count = (int)(beams->first[row + 1] - first);
    return (RowSources){beams->sources + first, count, count ? ANY_SOURCE : 1};
}

static float prob_of(const RowSources *row, int id, int count) {
    float own = 0;
    for (int i = 0; i < row->count; i++)
        if (row->list[i].id == id) own = row->list[i].prob;
    return row->any / (float)count + (1 - row->any) * own;
}

int mirror_beams_source(const MirrorBeams *beams, const Lights *lights, int part_id, bool is_back,
                        float pick, float *prob) {
    RowSources row = sources_of(beams, part_id, is_back);
    bool is_lamp = beams->set == BEAMS_OF_LAMPS;
    int count = is_lamp ? lights_lamp_count(lights) : beams->emitters.count, id;
    if (unit_choose(&pick, row.any)) {
        int which = (int)(pick * (float)count);
        which = which < count ? which : count - 1;
        id = is_lamp ? lights_lamp_id(lights, which) : which;
    } else {
        int i = 0;
        for (; i + 1 < row.count && pick >= row.list[i].prob; i++) pick -= row.list[i].prob;
        id = row.list[i].id;
    }
    *prob = prob_of(&row, id, count);
    return id;
}

float mirror_beams_source_prob(const MirrorBeams *beams, int part_id, bool is_back, int id) {
    RowSources row = sources_of(beams, part_id, is_back);
    return prob_of(&row, id, beams->emitters.count);
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool has_lights(const Lights *lights, const MirrorBeams *beams) {
    if (beams->set == BEAMS_OF_EMITTERS) return beams->emitters.count > 0;
    return lights_has(lights, beams->set == BEAMS_OF_SUN ? LIGHTS_SUN : LIGHTS_PUNCTUAL);
}

MirrorBeams mirror_beams_build(const BeamTools *tools, BeamSet set, Arena *arena) {
    MirrorBeams out = {.set = set};
    if (set == BEAMS_OF_EMITTERS) out.emitters = compact_emitters_build(tools->scene, arena);
    if (!has_lights(tools->lights, &out)) return out;
    BeamSide *sides = ARENA_NEW(arena, BeamSide, 2 * ((size_t)tools->scene->part_count + 1));
    Wavelengths middle;
    Beams beams = {.tools = tools,
                   .set = set,
                   .sides = sides,
                   .wavelengths = &middle,
                   .emitters = &out.emitters};
    wavelengths_sample(0.5f, &middle);
    measure_sides(tools->scene, sides);
    float *most_lx = ARENA_NEW(arena, float, 2 * ((size_t)tools->scene->part_count + 1));
    send_all_rays(&beams, &out.map, most_lx, arena);
    if (!beams.count) return out;
    if (set != BEAMS_OF_SUN) list_sources(&beams, &out, arena);
    qsort(beams.pairs, beams.count, sizeof *beams.pairs, mirrors_compare_pairs);
    while (out.all_count < beams.count && beams.pairs[out.all_count].part_id == NO_ID)
        out.all_count++;
    out.of_all = min_f(OF_POINTS, OF_ALL / sqrtf((float)out.all_count + 1));
    out.sides = sides;
    out.most_lx = most_lx;
    out.mirrors =
        mirrors_build(tools->scene, beams.pairs, beams.count, bvh_threads(tools->bvh), arena);
    return out;
}

float mirror_beams_most(const MirrorBeams *beams, int part_id, bool is_back) {
    if (part_id == NO_ID) return beams->of_all;
    return beams->sides[2 * part_id + is_back].most;
}

/* Parts whose cubes share a tag see each other's light: most holds it down to what rows are told.
 */
float mirror_beams_prob(const MirrorBeams *beams, int part_id, bool is_back, Vec3 position) {
    if (part_id == NO_ID) return mirror_beams_most(beams, part_id, is_back);
    const BeamSide *side = &beams->sides[2 * part_id + is_back];
    GlintPlace place = {side->row, side->edge_m, position};
    if (!(side->least > 0)) return 0;
    return min_f(side->least + side->by_root * sqrtf(glint_map_lx(&beams->map, &place)),
                 side->most);
}
