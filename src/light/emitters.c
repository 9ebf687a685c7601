#include "light/emitters.h"

#include "spectrum/photometry.h"

#define POINTS_A_TRIANGLE 32
#define FLOOR_SHARE 0.02 /* of the part's brightest point, so that no lit texel is impossible */

static float luminance_at(const Scene *scene, const Material *material,
                          const TrianglePoint *point)
{
    float rgb[3];
    if (material->display_id != NO_ID) {
        const Display *display = &scene->displays[material->display_id];
        display_codes(scene, display, point, rgb);
        return panel_mean_luminance(display->panel, rgb) * display->level;
    }
    emitted_rgb(scene, material, point, rgb);
    return luminance_from_rgb(rgb);
}

static double triangle_area(const Scene *scene, uint32_t triangle)
{
    const uint32_t *v = scene->triangles[triangle].vertex;
    const float *a = scene->vertices[v[0]].position, *b = scene->vertices[v[1]].position,
                *c = scene->vertices[v[2]].position;
    Vec3 cross = vec3_cross(vec3(b[0] - a[0], b[1] - a[1], b[2] - a[2]),
                            vec3(c[0] - a[0], c[1] - a[1], c[2] - a[2]));
    return 0.5 * (double)vec3_length(cross);
}

/* Barycentric weights of a uniform point, from a low-discrepancy lattice (R2 sequence). */
static void lattice_point(int i, float *u, float *v)
{
    double a = 0.5 + 0.7548776662466927 * i, b = 0.5 + 0.5698402909980532 * i;
    a -= floor(a);
    b -= floor(b);
    *u = (float)(a + b > 1 ? 1 - a : a);
    *v = (float)(a + b > 1 ? 1 - b : b);
}

static double mean_luminance(const Scene *scene, const Material *material, uint32_t triangle,
                             double *brightest)
{
    double sum = 0;
    for (int i = 0; i < POINTS_A_TRIANGLE; i++) {
        float u, v;
        lattice_point(i, &u, &v);
        TrianglePoint point = triangle_point(scene, triangle, u, v);
        double luminance = (double)luminance_at(scene, material, &point);
        sum += luminance;
        *brightest = luminance > *brightest ? luminance : *brightest;
    }
    return sum / POINTS_A_TRIANGLE;
}

static void weigh_part(const Scene *scene, const Part *part, double *weights)
{
    const Material *material = &scene->materials[part->material_id];
    bool   both_sides = material->double_sided && material->display_id == NO_ID;
    double brightest = 0;
    for (uint32_t i = 0; i < part->triangle_count; i++)
        weights[i] = mean_luminance(scene, material, part->first_triangle + i, &brightest);
    if (!(brightest > 0)) brightest = 1; /* lit where no point fell, if at all */
    for (uint32_t i = 0; i < part->triangle_count; i++)
        weights[i] = (weights[i] + FLOOR_SHARE * brightest) * (both_sides ? 2 : 1) *
                     triangle_area(scene, part->first_triangle + i);
}

static int list_emitters(const Scene *scene, Emitters *emitters, Arena *arena)
{
    int count = 0;
    emitters->first_of_part = ARENA_NEW(arena, int, scene->part_count + 1);
    for (int p = 0; p < scene->part_count; p++) {
        const Part *part = &scene->parts[p];
        bool emits = scene->materials[part->material_id].is_emitter;
        emitters->first_of_part[p] = emits ? count : NO_ID;
        count += emits ? (int)part->triangle_count : 0;
    }
    return count;
}

Emitters emitters_build(const Scene *scene, Arena *arena)
{
    Emitters emitters = {0};
    emitters.count = list_emitters(scene, &emitters, arena);
    if (!emitters.count) return emitters;
    double *weights = ARENA_NEW(arena, double, emitters.count), total = 0;
    emitters.triangles = ARENA_NEW(arena, uint32_t, emitters.count);
    emitters.pdf_area = ARENA_NEW(arena, float, emitters.count);
    for (int p = 0; p < scene->part_count; p++) {
        int first = emitters.first_of_part[p];
        if (first == NO_ID) continue;
        weigh_part(scene, &scene->parts[p], weights + first);
        for (uint32_t i = 0; i < scene->parts[p].triangle_count; i++) {
            emitters.triangles[first + (int)i] = scene->parts[p].first_triangle + i;
            total += weights[first + (int)i];
        }
    }
    if (!(total > 0)) return (Emitters){.first_of_part = emitters.first_of_part};
    emitters.choice = alias_build(weights, emitters.count, arena);
    for (int i = 0; i < emitters.count; i++) {
        double area = triangle_area(scene, emitters.triangles[i]);
        emitters.pdf_area[i] = area > 0 ? (float)((double)emitters.choice.prob[i] / area) : 0;
    }
    return emitters;
}

uint32_t emitters_sample(const Emitters *emitters, const Scene *scene, const float u[3],
                         TrianglePoint *point, float *pdf_area)
{
    int   i = alias_sample(&emitters->choice, u[2]);
    float root = sqrtf(u[0]); /* uniform on the triangle */
    *point = triangle_point(scene, emitters->triangles[i], root * (1 - u[1]), root * u[1]);
    *pdf_area = emitters->pdf_area[i];
    return emitters->triangles[i];
}

float emitters_pdf_area(const Emitters *emitters, const Scene *scene, uint32_t triangle)
{
    int part = (int)scene->triangles[triangle].part_id;
    int first = emitters->count ? emitters->first_of_part[part] : NO_ID;
    if (first == NO_ID) return 0;
    return emitters->pdf_area[first + (int)(triangle - scene->parts[part].first_triangle)];
}
