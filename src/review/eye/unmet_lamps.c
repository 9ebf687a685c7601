/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/unmet_lamps.h"

#include <math.h>
#include <stdlib.h>

#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "spectrum/photometry.h"

static double part_luminance(const Scene *scene, const Part *part) {
    static const float WHITE[3] = {255, 255, 255};
    const Material *material = &scene->materials[part->material_id];
    if (material->display_id == NO_ID)
        return (double)luminance_from_rgb(material->unlit ? material->base_color
                                                          : material->emissive_cd_m2);
    const Display *display = &scene->displays[material->display_id];
    return (double)(panel_mean_luminance(display->panel, WHITE) * display->level);
}

static Lamp lamp_of_triangle(const Scene *scene, uint32_t triangle, double cd_m2) {
    const uint32_t *vertex = scene->triangles[triangle].vertex;
    Lamp lamp = {.middle = vec3(0, 0, 0), .cd_m2 = cd_m2};
    for (int k = 0; k < 3; k++)
        lamp.middle = vec3_along(lamp.middle, scene->positions[vertex[k]], 1 / 3.0f);
    for (int k = 0; k < 3; k++) {
        Vec3 off = vec3_sub(scene->positions[vertex[k]], lamp.middle);
        lamp.radius = fmax(lamp.radius, (double)vec3_length(off));
    }
    return lamp;
}

static int brightest_first(const void *a, const void *b) {
    double x = ((const Lamp *)a)->cd_m2, y = ((const Lamp *)b)->cd_m2;
    return (x < y) - (x > y);
}

UnmetLamps lamps_unmet(const PathContext *context, const bool *met, Arena *arena) {
    const Scene *scene = context->scene;
    int count = 0;
    for (int i = 0; i < scene->part_count; i++)
        if (!met[i] && part_luminance(scene, &scene->parts[i]) > 0)
            count += (int)scene->parts[i].triangle_count;
    const CompactEmitters *compact = &context->beams[BEAMS_OF_EMITTERS].emitters;
    UnmetLamps out = {.list = ARENA_NEW(arena, Lamp, count)};
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        double cd_m2 = met[i] ? 0 : part_luminance(scene, part);
        for (uint32_t t = 0; cd_m2 > 0 && t < part->triangle_count; t++) {
            out.list[out.count] = lamp_of_triangle(scene, part->first_triangle + t, cd_m2);
            out.list[out.count++].is_compact = compact->of_part && compact->of_part[i] != NO_ID;
        }
    }
    if (out.count) qsort(out.list, (size_t)out.count, sizeof *out.list, brightest_first);
    return out;
}

/* Is the lamp's ball within the angle? Most are far off: asin x is at most PI / 2 x, and a
 * cosine falls by no more than its angle grows. */
static bool may_be_seen(const Lamp *lamp, Ray ray, double half, double cos_half) {
    Vec3 to = vec3_sub(lamp->middle, ray.origin);
    double distance = (double)vec3_length(to);
    if (distance <= lamp->radius) return true;
    double cosine = (double)vec3_dot(to, ray.direction) / distance;
    if (cosine < cos_half - 0.5 * PI * lamp->radius / distance) return false;
    return acos(fmin(fmax(cosine, -1), 1)) <= half + asin(lamp->radius / distance);
}

double lamps_brightest(const UnmetLamps *lamps, Ray ray, double half, bool no_compact) {
    double cos_half = cos(half);
    for (int i = 0; i < lamps->count; i++)
        if (!(no_compact && lamps->list[i].is_compact) &&
            may_be_seen(&lamps->list[i], ray, half, cos_half))
            return lamps->list[i].cd_m2;
    return 0;
}

double lamps_point_lx(const Scene *scene, Ray ray, double half) {
    double most = 0, cos_half = cos(half);
    for (int i = 0; i < scene->light_count; i++) {
        const PunctualLight *light = &scene->lights[i];
        bool is_distant = light->kind == LIGHT_DIRECTIONAL;
        Vec3 to = is_distant ? vec3_neg(light->direction) : vec3_sub(light->position, ray.origin);
        Lamp ball = {.middle = vec3_add(ray.origin, to), .radius = (double)punctual_radius(light)};
        double d2 = fmax((double)vec3_dot(to, to), ball.radius * ball.radius);
        double lx = (double)luminance_from_rgb(light->intensity) / (is_distant ? 1 : d2);
        if (lx > most && may_be_seen(&ball, ray, half, cos_half)) most = lx;
    }
    return most;
}
