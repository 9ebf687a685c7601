/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/places.h"

#include <math.h>

/* A seated person about the eye, m. The shipped occupant's chest is 0.18 m behind the eye at
 * most, the headrest 0.42 m; `equip` proposes an eye 0.25 m before a headrest. */
#define CHEST_M 0.2f      /* what is farther behind the eye is no chest */
#define BACK_M 0.9f       /* nor is what is farther a seat's back */
#define HALF_WIDE_M 0.35f
#define OVER_M 0.15f      /* above the eye: a headrest's top */
#define UNDER_M 1.0f      /* below it: a cushion's edge */
#define CHIN_M 0.15f      /* below it: from there on a trunk, */
#define TRUNK_M 0.2f      /* so far ahead of it; */
#define LAP_M 0.5f        /* thighs and a cushion, from here on down, */
#define KNEE_M 0.5f       /* so far ahead */
#define CABIN_M 2.5f      /* from the display: what is farther is none of its cabin */
#define GAP_M 0.002f      /* as scene/load/hood.c has it */
#define FLAT 0.985f
#define LOOKING_GLASS 0.05f /* a metal so smooth is a mirror, which must stay one */

/* ---- a display's box --------------------------------------------------------------------- */

static Vec3 area_normal(const Scene *scene, const Part *part)
{
    Vec3 sum = vec3(0, 0, 0);
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        const uint32_t *v = scene->triangles[part->first_triangle + t].vertex;
        const Vec3     *p = scene->positions;
        sum = vec3_add(sum, vec3_cross(vec3_sub(p[v[1]], p[v[0]]), vec3_sub(p[v[2]], p[v[0]])));
    }
    return sum;
}

static void add_point(PlaceFace *face, Vec3 p)
{
    const float along[3] = {vec3_dot(p, face->right), vec3_dot(p, face->up),
                            vec3_dot(p, face->normal)};
    for (int a = 0; a < 3; a++) {
        face->low[a] = fminf(face->low[a], along[a]);
        face->high[a] = fmaxf(face->high[a], along[a]);
    }
}

static void add_points(PlaceFace *face, const Scene *scene, const Part *part)
{
    for (uint32_t t = 0; t < part->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            add_point(face, scene->positions[scene->triangles[part->first_triangle + t]
                                                 .vertex[k]]);
}

PlaceFace place_face(const Scene *scene, const int *part_ids, int part_count)
{
    PlaceFace face = {.low = {INFINITY, INFINITY, INFINITY},
                      .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < part_count; i++)
        face.normal = vec3_add(face.normal, area_normal(scene, &scene->parts[part_ids[i]]));
    face.normal = vec3_normalize(face.normal);
    face.is_upright = fabsf(face.normal.y) < FLAT;
    face.right = vec3_normalize(vec3_cross(vec3(0, 1, 0), face.normal));
    face.up = vec3_cross(face.normal, face.right);
    for (int i = 0; i < part_count; i++)
        add_points(&face, scene, &scene->parts[part_ids[i]]);
    return face;
}

/* ---- a hood ------------------------------------------------------------------------------ */

/* Where a line crosses the plane at `at` along an axis: false, nowhere before `distance`. */
static bool crosses(const float from[3], const float step[3], int axis, float at,
                    float distance, float out[3])
{
    float t = (at - from[axis]) / step[axis];
    if (!(t > 0) || !(t < distance)) return false;
    for (int a = 0; a < 3; a++) out[a] = from[a] + t * step[a];
    return true;
}

static bool meets_plate(const PlaceFace *face, float depth, const float p[3])
{
    return p[0] >= face->low[0] - GAP_M && p[0] <= face->high[0] + GAP_M &&
           p[2] >= face->low[2] && p[2] <= face->high[2] + depth;
}

/* A cheek narrows to nothing at the lower edge. */
static bool meets_cheek(const PlaceFace *face, float depth, const float p[3])
{
    float height = face->high[1] + GAP_M - face->low[1];
    float share = (p[1] - face->low[1]) / height;
    return share >= 0 && share <= 1 && p[2] >= face->low[2] &&
           p[2] <= face->high[2] + depth * share;
}

bool place_is_hooded(const PlaceFace *face, float depth_m, Vec3 from, Vec3 towards,
                     float distance)
{
    const Vec3  axes[3] = {face->right, face->up, face->normal};
    float       start[3], step[3], p[3];
    const float sides[2] = {face->low[0] - GAP_M, face->high[0] + GAP_M};
    for (int a = 0; a < 3; a++) {
        start[a] = vec3_dot(from, axes[a]);
        step[a] = vec3_dot(towards, axes[a]);
    }
    if (crosses(start, step, 1, face->high[1] + GAP_M, distance, p) &&
        meets_plate(face, depth_m, p))
        return true;
    for (int s = 0; s < 2; s++)
        if (crosses(start, step, 0, sides[s], distance, p) && meets_cheek(face, depth_m, p))
            return true;
    return false;
}

/* ---- a seat, and what is none ------------------------------------------------------------ */

typedef struct FromEye {
    float ahead, aside, above;
} FromEye;

static FromEye from_eye(const ChainPlaces *places, Vec3 p)
{
    Vec3  d = vec3_sub(p, places->eye);
    float ahead = vec3_dot(d, places->ahead);
    Vec3  across = vec3_cross(vec3(0, 1, 0), places->ahead);
    return (FromEye){ahead, fabsf(vec3_dot(d, across)), d.y};
}

/* Any seat's back and who sits in it, and this one's trunk and lap. */
static bool may_be_seat(const ChainPlaces *places, Vec3 p)
{
    FromEye at = from_eye(places, p);
    bool    is_behind = at.ahead < 0 && at.above < OVER_M;
    float   ahead = at.above < -LAP_M ? KNEE_M : TRUNK_M;
    bool    is_own = at.ahead < ahead && at.aside < HALF_WIDE_M && at.above < -CHIN_M &&
                  at.above > -UNDER_M;
    return is_behind || is_own;
}

static bool is_own_back(const ChainPlaces *places, Vec3 p)
{
    FromEye at = from_eye(places, p);
    return at.ahead < -CHEST_M && at.ahead > -BACK_M && at.aside < HALF_WIDE_M &&
           at.above < OVER_M && at.above > -UNDER_M;
}

/* What lets light through must go on doing so, what mirrors and what shines likewise; an
 * occupant is no trim. */
static bool is_plain(const ChainPlaces *places, int part_id)
{
    const Scene    *scene = places->scene;
    const Material *m = &scene->materials[scene->parts[part_id].material_id];
    if (places->is_occupant[part_id]) return false;
    bool is_mirror = m->metallic >= 0.5f && m->roughness <= LOOKING_GLASS;
    return !m->lets_light_through && m->transmission <= 0 && !m->is_emitter && !is_mirror;
}

/* ---- sums -------------------------------------------------------------------------------- */

PlaceSums place_sums(const Scene *scene, Arena *arena)
{
    return (PlaceSums){.by_trim = ARENA_NEW(arena, double, scene->part_count),
                       .by_seat = ARENA_NEW(arena, double, scene->part_count)};
}

/* Beyond a pane is outside. */
static void add_trims(const ChainPlaces *places, const int *alike, const PathHistory *history,
                      double y, PlaceSums *to)
{
    Vec3 display = history->step[0].position;
    int  met[PATH_STEPS_MAX], count = 0;
    for (int i = 1; i < path_steps_kept(history); i++) {
        const PathStep *step = &history->step[i];
        int             id = alike[step->part_id];
        bool            is_met = false;
        if (step->pane_id != NO_ID || !is_plain(places, step->part_id)) return;
        for (int k = 0; k < count; k++) is_met |= met[k] == id;
        if (is_met || may_be_seat(places, step->position) ||
            vec3_length(vec3_sub(step->position, display)) > CABIN_M)
            continue;
        met[count++] = id;
        to->by_trim[id] += y;
    }
}

static void add_seat(const ChainPlaces *places, const int *alike, const PathHistory *history,
                     double y, PlaceSums *to)
{
    const PathStep *next = &history->step[1];
    if (history->count < 2 || next->pane_id != NO_ID) return;
    if (is_own_back(places, next->position)) to->by_seat[alike[next->part_id]] += y;
}

void place_add(const ChainPlaces *places, const int *alike, const PathHistory *history,
               double y, PlaceSums *to)
{
    Vec3  display = history->step[0].position, towards = history->from;
    float distance = INFINITY;
    if (history->count > 1 || !history->is_distant) {
        Vec3 next = history->count > 1 ? history->step[1].position : history->from;
        towards = vec3_sub(next, display);
        distance = vec3_length(towards);
        towards = vec3_normalize(towards);
    }
    for (int i = 0; i < PLACE_HOODS && places->face.is_upright; i++)
        if (place_is_hooded(&places->face, places->hood_m[i], display, towards, distance))
            to->hooded[i] += y;
    add_trims(places, alike, history, y, to);
    add_seat(places, alike, history, y, to);
}

void place_merge(const PlaceSums *from, int part_count, double scale, PlaceSums *to)
{
    for (int i = 0; i < part_count; i++) {
        to->by_trim[i] += scale * from->by_trim[i];
        to->by_seat[i] += scale * from->by_seat[i];
    }
    for (int i = 0; i < PLACE_HOODS; i++) to->hooded[i] += scale * from->hooded[i];
}
