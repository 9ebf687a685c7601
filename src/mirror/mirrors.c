/* SPDX-License-Identifier: Apache-2.0 */
#include "mirror/mirrors.h"

#include "base/mathf.h"
#include "base/units.h"
#include "panel/query/panel_place.h"
#include "shaders/facets/microfacet.h"

#define STACK 64 /* the tree halves: no scene is as deep */

/* ---- which ------------------------------------------------------------------------------ */

/* Textures make a surface only smoother. */
static bool is_smooth_everywhere(float roughness) {
    return is_smooth(roughness * roughness);
}

static bool has_smooth_base(const Material *m) {
    if (!is_smooth_everywhere(m->roughness) || m->brushing) return false;
    if (m->is_solid && m->transmission > 0) return fabsf(m->ior - 1) > 1e-4f || m->film;
    return m->metallic > 0 || m->specular > 0;
}

static bool has_smooth_coat(const Material *m) {
    return m->clearcoat > 0 && is_smooth_everywhere(m->clearcoat_roughness);
}

bool mirrors_can_be(const Scene *scene, const Material *m) {
    if (m->unlit) return false;
    if (m->display_id != NO_ID) return panel_has_mirror(scene->displays[m->display_id].panel);
    bool is_bent = m->normal_texture.texture_id != NO_ID ||
                   (m->clearcoat > 0 && m->clearcoat_normal_texture.texture_id != NO_ID);
    return !is_bent && (has_smooth_base(m) || has_smooth_coat(m));
}

float mirrors_rough_alpha(const Material *m) {
    float alpha = m->roughness * m->roughness;
    bool reflects = m->metallic > 0 || m->specular > 0;
    bool is_plain = m->normal_texture.texture_id == NO_ID && m->display_id == NO_ID && !m->unlit &&
                    !m->brushing && !(m->is_solid && m->transmission > 0);
    return reflects && is_plain && !is_smooth(alpha) && alpha <= GLINT_ALPHA ? alpha : 0;
}

/* ---- queries ---------------------------------------------------------------------------- */

int mirrors_compare_pairs(const void *a, const void *b) {
    const MirrorPair *x = a, *y = b;
    int root_x = mirror_root(x->part_id, x->is_rough);
    int root_y = mirror_root(y->part_id, y->is_rough);
    if (root_x != root_y) return root_x < root_y ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

MirrorTriangle mirror_triangle(const Scene *scene, uint32_t id) {
    MirrorTriangle out;
    const Vec3 *normals = scene_part(scene, id)->normals;
    for (int i = 0; i < 3; i++) out.position[i] = scene_corner(scene, id, i);
    Vec3 flat = vec3_normalize(vec3_cross(vec3_sub(out.position[1], out.position[0]),
                                          vec3_sub(out.position[2], out.position[0])));
    for (int i = 0; i < 3; i++)
        out.normal[i] = normals ? normals[scene_corner_place(scene, id, i)] : flat;
    return out;
}

bool mirrors_have(const Mirrors *mirrors, MirrorPair pair) {
    uint32_t low = 0, high = mirrors->pair_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        int order = mirrors_compare_pairs(&mirrors->pairs[middle], &pair);
        if (order == 0) return true;
        if (order < 0) low = middle + 1;
        else high = middle;
    }
    return false;
}

/* Is h, or its opposite, within `reach` of all normals' planes? */
static bool may_be_normal(const MirrorNode *node, Vec3 h, float reach) {
    bool along = true, against = true;
    for (int i = 0; i < MIRROR_PLANES; i++) {
        float above = vec3_dot(node->plane[i], h);
        along &= above <= reach;
        against &= -above <= reach;
    }
    return along || against;
}

/* A query on its way through the tree. */
typedef struct MirrorSearch {
    const MirrorQuery *query;
    float lean;     /* by how much facets of alpha 1 lean; 0: of smooth mirrors */
    Vec2 direction; /* and along which slopes, unit */
    MirrorFound *found;
    void *user;
} MirrorSearch;

/* Over a ball the direction to a place of it, seen from `from`, stays within a chord of that to
 * its centre: sin beta = radius / distance, chord = 2 sin(beta / 2). False: `from` may lie in
 * it. */
static bool look_at_ball(const MirrorNode *node, Vec3 from, Vec3 *towards, float *chord) {
    Vec3 to = vec3_sub(node->centre, from);
    float far2 = vec3_dot(to, to), radius2 = node->radius * node->radius * 1.0001f;
    if (!(far2 > radius2)) return false;
    *chord = sqrtf(2 * (1 - sqrtf(1 - radius2 / far2)));
    *towards = vec3_scale(to, 1 / sqrtf(far2));
    return true;
}

/* Where a mirror turns w, the direction from the point to it, into s, towards the light, its
 * normal lies along h = s - w, on one side or the other. h stays within the chords of w and s
 * over the node. A leaning facet's normal is off by no more than its slope. */
static bool may_reflect(const MirrorNode *node, const MirrorSearch *asking) {
    const ReflectionLight *light = &asking->query->light;
    Vec3 w, s;
    float chord, chord_of_light;
    if (!look_at_ball(node, asking->query->from, &w, &chord)) return true;
    if (!light->is_near) {
        s = light->at;
    } else {
        if (!look_at_ball(node, light->at, &s, &chord_of_light)) return true;
        s = vec3_neg(s);
        chord += chord_of_light;
    }
    Vec3 h = vec3_sub(s, w);
    float lean = asking->lean * node->alpha;
    return may_be_normal(node, h, chord * (1 + lean) + lean * vec3_length(h) + 1e-5f);
}

/* The point and the light lie on one side of a triangle that reflects. */
static bool is_on_one_side(const MirrorTriangle *t, Vec3 from, const ReflectionLight *light) {
    Vec3 n = vec3_cross(vec3_sub(t->position[1], t->position[0]),
                        vec3_sub(t->position[2], t->position[0]));
    Vec3 towards = light->is_near ? vec3_sub(light->at, t->position[0]) : light->at;
    return vec3_dot(n, towards) * vec3_dot(n, vec3_sub(from, t->position[0])) > 0;
}

/* Slopes m of GGX facets lie at density alpha^2 / (pi (alpha^2 + m^2)^2) (Walter 2007, written
 * by slopes): m^2 = alpha^2 u / (1 - u). */
static int leaning_points(const MirrorPatch *patch, const MirrorSearch *asking,
                          ReflectionPoint points[REFLECTION_POINTS_MAX]) {
    const MirrorQuery *query = asking->query;
    float m = asking->lean * patch->alpha, a2 = patch->alpha * patch->alpha;
    float density = a2 / (PI_F * (a2 + m * m) * (a2 + m * m));
    MirrorTriangle leaning = reflection_leaning(
        &patch->corners, (Vec2){m * asking->direction.x, m * asking->direction.y});
    int count = reflection_points_find(&leaning, query->from, &query->light, points);
    for (int i = 0; i < count; i++)
        points[i].spread =
            reflection_slope_spread(&patch->corners, query->from, &query->light, &points[i]) /
            density;
    return count;
}

static void find_on_patch(const MirrorPatch *patch, const MirrorSearch *asking) {
    const MirrorQuery *query = asking->query;
    ReflectionPoint points[REFLECTION_POINTS_MAX];
    if (!is_on_one_side(&patch->corners, query->from, &query->light)) return;
    int count = query->is_rough
                    ? leaning_points(patch, asking, points)
                    : reflection_points_find(&patch->corners, query->from, &query->light, points);
    for (int i = 0; i < count; i++) {
        const Vec2 *uv = patch->uv;
        float u = points[i].u, v = points[i].v, w = 1 - u - v;
        points[i].u = w * uv[0].x + u * uv[1].x + v * uv[2].x;
        points[i].v = w * uv[0].y + u * uv[1].y + v * uv[2].y;
        if (points[i].spread < 1e30f) asking->found(asking->user, patch->id, &points[i]);
    }
}

float mirror_spread_at(const Scene *scene, uint32_t triangle, Vec3 from, Vec3 light, Vec3 point) {
    MirrorTriangle corners = mirror_triangle(scene, triangle);
    return reflection_spread(&corners, from, &(ReflectionLight){light, true}, point);
}

uint32_t mirrors_find(const Mirrors *mirrors, const MirrorQuery *query, MirrorFound *found,
                      void *user) {
    uint32_t stack[STACK], depth = 1, taken = 0;
    MirrorSearch asking = {.query = query, .found = found, .user = user};
    stack[0] = mirrors->roots[mirror_root(query->part_id, query->is_rough)];
    if (stack[0] == MIRROR_NO_TREE) return 0;
    if (query->is_rough) {
        asking.lean = sqrtf(query->u.x / (1 - query->u.x));
        sincos_turns(query->u.y, &asking.direction.y, &asking.direction.x);
    }
    while (depth) {
        const MirrorNode *node = &mirrors->nodes[stack[--depth]];
        taken++;
        if (!may_reflect(node, &asking)) continue;
        if (node->children) {
            stack[depth++] = node->children + 1;
            stack[depth++] = node->children;
        } else {
            find_on_patch(&mirrors->patches[node->patch], &asking);
        }
    }
    return taken;
}
