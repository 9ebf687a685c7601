/* SPDX-License-Identifier: Apache-2.0 */
#include "library/emission_draw.h"

#include <math.h>

#include "hemisphere/tree/sampling_tree_build.h"
#include "panel/query/panel_emission.h"

#define LEVEL 6
#define SOURCES 4 /* red, green, blue, black */
#define CELLS 2400
#define CELL_VARIANCE 0.01f
#define UNIFORM_SHARE 0.004f /* no direction above the surface has a density of 0 */

/* Luminance of the sources in a direction. */
static void read_sources(const Panel *panel, Vec3 direction, float luminance[SOURCES]) {
    float xyz[3], codes[SOURCES][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {0, 0, 0}};
    for (int s = SOURCES - 1; s >= 0; s--) {
        panel_emission_xyz(panel, direction, codes[s], xyz);
        luminance[s] = s == 3 ? xyz[1] : fmaxf(0, xyz[1] - luminance[3]);
    }
}

/* Integrals of luminance times the cosine over the leaves; of a dark source, of the cosine. */
static void read_integrals(const Panel *panel, const Geodesic *geodesic, float *integral) {
    uint32_t leaves = geodesic_count(LEVEL), octant = leaves / 4;
    double total[SOURCES] = {0};
    for (uint32_t i = 0; i < leaves; i++) {
        float luminance[SOURCES];
        Vec3 d = geodesic_center(LEVEL, i);
        read_sources(panel, d, luminance);
        for (uint32_t s = 0; s < SOURCES; s++) {
            float light = luminance[s] * d.z * geodesic->areas[LEVEL][i % octant];
            integral[s * leaves + i] = light;
            total[s] += (double)light;
        }
    }
    for (uint32_t s = 0; s < SOURCES; s++)
        for (uint32_t i = 0; i < leaves && !(total[s] > 0); i++)
            integral[s * leaves + i] =
                geodesic_center(LEVEL, i).z * geodesic->areas[LEVEL][i % octant];
}

bool emission_draw_make(const Panel *panel, Arena *arena, EmissionDraw *out, Error *err) {
    SamplingOptions options = {.level = LEVEL,
                               .octants = 4,
                               .functions = SOURCES,
                               .cells = CELLS,
                               .variance = CELL_VARIANCE,
                               .uniform_share = UNIFORM_SHARE};
    const float white[3] = {255, 255, 255};
    const void *blob;
    *out = (EmissionDraw){.tree = {.functions = 0}};
    if (!(panel_mean_luminance(panel, white) > 0)) return true;
    const Geodesic *geodesic = geodesic_create(LEVEL, arena);
    Arena scratch = *arena;
    float *integral = ARENA_NEW(&scratch, float, SOURCES *(size_t)geodesic_count(LEVEL));
    read_integrals(panel, geodesic, integral);
    if (!sampling_tree_build(&options, integral, &scratch, &blob, err)) return false;
    size_t size = sampling_tree_size(blob);
    blob = arena_keep(arena, blob, size, 8);
    return sampling_tree_open(blob, size, geodesic, arena, &out->tree, err);
}

/* The sources at codes by their mean luminance; false: nothing is emitted. */
static bool mix_sources(const EmissionDraw *draw, const Panel *panel, const float code[3],
                        SamplingMix *mix) {
    const float zero[3] = {0, 0, 0};
    if (!draw->tree.functions) return false;
    float black = panel_mean_luminance(panel, zero), all = panel_mean_luminance(panel, code);
    *mix = (SamplingMix){SOURCES, {0, 1, 2, 3}, {0}};
    if (!(all > 0)) return false;
    float rest = 1;
    for (int s = 0; s < SOURCES - 1; s++) {
        float one[3] = {0, 0, 0};
        one[s] = code[s];
        mix->weight[s] = fmaxf(0, panel_mean_luminance(panel, one) - black) / all;
        rest -= mix->weight[s];
    }
    mix->weight[3] = fmaxf(0, rest);
    return true;
}

bool emission_draw_sample(const EmissionDraw *draw, const Panel *panel, const float code[3],
                          const float u[3], Vec3 *direction, float *pdf) {
    SamplingMix mix;
    if (!mix_sources(draw, panel, code, &mix)) return false;
    SamplingResult drawn = sampling_tree_sample(&draw->tree, &mix, u);
    *direction = drawn.direction;
    *pdf = drawn.pdf;
    return drawn.direction.z > 0 && drawn.pdf > 0;
}

float emission_draw_pdf(const EmissionDraw *draw, const Panel *panel, const float code[3],
                        Vec3 direction) {
    SamplingMix mix;
    if (!(direction.z > 0) || !mix_sources(draw, panel, code, &mix)) return 0;
    return sampling_tree_pdf(&draw->tree, &mix, direction);
}
