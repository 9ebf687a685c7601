/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/sampling_make.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/tree/sampling_tree_build.h"
#include "hemisphere/specular_frame.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_reflection.h"
#include "spectrum/spectral_table.h"

#define CELLS 1200           /* of two octants, at most */
#define CELL_VARIANCE 0.018f /* of the weights at the incidences chosen */
#define UNIFORM_SHARE 0.004f
#define LAST_DEG 88.0
#define INCIDENCES_MAX 24
#define AZIMUTHS_LEAST 8
#define PROBES 3 /* azimuths at which incidences are chosen */
#define AZIMUTHS_MAX 32
#define INTERVALS 16  /* of incidences, at most */
#define PROBE_LEVEL 5 /* at which incidences and azimuths are chosen */
#define LEVEL 6       /* of the tree */
#define BETWEEN 0.004 /* variance of the weights half way between two of them, the more */

/* Places of the stored frame, and the weights of the lanes. */
typedef struct SamplingWork {
    const Panel *panel;
    int level, octants, leaves, azimuths, incidences;
    Vec3 *stored;
    double *area;
    PanelLanes lanes;
    double luminous[SPECTRUM_LANES];
    double theta[INCIDENCES_MAX];
} SamplingWork;

/* Lanes evenly over what is measured of the visible range, weighted as the eye does and a
 * little more, so that no wavelength is forgotten. */
static void choose_lanes(SamplingWork *work) {
    const PanelReflection *r = work->panel->reflection;
    Wavelengths wavelengths = {0};
    double first = fmax(400, (double)r->wavelength_nm[0]), total = 0;
    double last = fmin(700, (double)r->wavelength_nm[r->wavelengths - 1]);
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        double nm = first + fmax(0, last - first) * i / (SPECTRUM_LANES - 1);
        int k = (int)fmin(SPECTRAL_COUNT - 1, fmax(0, nm - SPECTRAL_FIRST_NM + 0.5));
        wavelengths.nm[i] = (float)nm;
        work->luminous[i] = (double)spectral_table[k].y + 0.002;
        total += work->luminous[i];
    }
    for (int i = 0; i < SPECTRUM_LANES; i++) work->luminous[i] /= total;
    panel_lanes(work->panel, &wavelengths, &work->lanes);
}

static void choose_places(SamplingWork *work, int level, Arena *arena) {
    uint32_t octant = 1u << 2 * level;
    work->level = level;
    work->octants = work->panel->reflection->azimuths > 1 ? 4 : 2;
    work->leaves = work->octants << 2 * level;
    work->stored = ARENA_NEW(arena, Vec3, work->leaves);
    work->area = ARENA_NEW(arena, double, octant);
    geodesic_areas(level, work->area);
    for (int i = 0; i < work->leaves; i++) work->stored[i] = geodesic_center(level, (uint32_t)i);
}

static double area_of(const SamplingWork *work, int leaf) {
    return work->area[leaf & ((1 << 2 * work->level) - 1)];
}

/* The integrals over the leaves of the luminous mean of f cos theta times the frame's
 * Jacobian, for a wo at theta and phi, scaled to a sum of 1. */
static void read_function(const SamplingWork *work, double theta, double phi, float *integral) {
    SpecularFrame frame = specular_frame((float)theta, PANEL_SAMPLING_EXPONENT);
    double s = sin_d(theta), total = 0;
    Vec3 wo = vec3((float)(s * cos_d(phi)), (float)(s * sin_d(phi)), (float)cos_d(theta));
    float ex = (float)-cos_d(phi), ey = (float)-sin_d(phi);
    for (int i = 0; i < work->leaves; i++) {
        float jacobian;
        double f = 0;
        Vec3 d = specular_frame_outer_jacobian(&frame, work->stored[i], &jacobian);
        Vec3 wi = vec3(ex * d.x - ey * d.y, ey * d.x + ex * d.y, d.z);
        Spectrum brdf = panel_brdf_at(work->panel, wo, wi, &work->lanes);
        for (int k = 0; k < SPECTRUM_LANES; k++) f += work->luminous[k] * (double)brdf[k];
        f *= (double)(fmaxf(0, d.z) * jacobian) * area_of(work, i);
        integral[i] = isfinite(f) ? (float)f : 0;
        total += (double)integral[i];
    }
    for (int i = 0; i < work->leaves; i++) /* black: any distribution will do */
        integral[i] = (float)(total > 0 ? (double)integral[i] / total
                                        : area_of(work, i) / (work->octants * 0.5 * PI));
}

/* Relative variance of weights when `wanted` is drawn with the mean of two others. */
static double mixed_variance(const SamplingWork *work, const float *wanted, const float *a,
                             const float *b) {
    double sum = 0;
    for (int i = 0; i < work->leaves; i++) {
        double uniform = area_of(work, i) / (work->octants * 0.5 * PI);
        double density = 0.5 * ((double)a[i] + (double)b[i]) + (double)UNIFORM_SHARE * uniform;
        sum += (double)(wanted[i] * wanted[i]) / density;
    }
    return sum - 1;
}

/* ---- incidences and azimuths ------------------------------------------------------------- */

typedef struct Interval {
    double theta[2];
    float *function[2]; /* of every probe, one after the other */
} Interval;

static int probes(const SamplingWork *work) {
    return work->octants == 4 ? PROBES : 1;
}

static float *read_probes(const SamplingWork *work, double theta, Arena *arena) {
    float *all = ARENA_NEW(arena, float, probes(work) * work->leaves);
    for (int a = 0; a < probes(work); a++)
        read_function(work, theta, 2 * PI * 0.3 * a, all + a * work->leaves);
    return all;
}

/* Halves an interval until its middle is drawn well by its ends; appends its nodes but the
 * first. */
static void divide(SamplingWork *work, Interval all, int room, Arena scratch) {
    double middle = 0.5 * (all.theta[0] + all.theta[1]), worst = 0;
    float *at_middle = read_probes(work, middle, &scratch);
    for (int a = 0; a < probes(work); a++) {
        int from = a * work->leaves;
        worst = fmax(worst, mixed_variance(work, at_middle + from, all.function[0] + from,
                                           all.function[1] + from));
    }
    if (worst > BETWEEN && room > 1) {
        Interval low = {{all.theta[0], middle}, {all.function[0], at_middle}};
        Interval high = {{middle, all.theta[1]}, {at_middle, all.function[1]}};
        divide(work, low, room / 2, scratch);
        divide(work, high, room / 2, scratch);
        return;
    }
    work->theta[work->incidences++] = all.theta[1];
}

static void choose_incidences(SamplingWork *work, Arena scratch) {
    double first = 0, last = radians_from_degrees(LAST_DEG);
    Interval all = {{first, last},
                    {read_probes(work, first, &scratch), read_probes(work, last, &scratch)}};
    work->theta[work->incidences++] = first;
    divide(work, all, INTERVALS, scratch);
}

/* Azimuths evenly, so many that half way between two of them is drawn well by these. */
static void choose_azimuths(SamplingWork *work, Arena scratch) {
    float *read[2 * AZIMUTHS_MAX + 1] = {NULL};
    work->azimuths = 1;
    if (work->octants < 4) return;
    for (int n = AZIMUTHS_LEAST; n <= AZIMUTHS_MAX; n *= 2) {
        double worst = 0;
        int half = AZIMUTHS_MAX / n; /* between two of them, of what is read */
        work->azimuths = n;
        for (int at = 0; at < COUNT_OF(read); at += half)
            if (!read[at]) {
                read[at] = ARENA_NEW(&scratch, float, work->leaves);
                read_function(work, radians_from_degrees(45), PI * at / AZIMUTHS_MAX, read[at]);
            }
        for (int at = half; at < COUNT_OF(read); at += 2 * half)
            worst = fmax(worst, mixed_variance(work, read[at], read[at - half], read[at + half]));
        if (worst <= BETWEEN) return;
    }
}

/* ---- the section ------------------------------------------------------------------------- */

static void write_section(const SamplingWork *work, const void *tree, Arena *arena,
                          SamplingSection *out) {
    uint16_t counts[2] = {(uint16_t)work->incidences, (uint16_t)work->azimuths};
    size_t behind = panel_sampling_tree_bytes(sampling_tree_size(tree));
    size_t size = behind + sizeof counts + sizeof(float) * (size_t)work->incidences;
    unsigned char *bytes = arena_alloc(arena, 1, 8, size);
    memcpy(bytes, tree, sampling_tree_size(tree));
    memcpy(bytes + behind, counts, sizeof counts);
    for (int i = 0; i < work->incidences; i++) {
        float theta = (float)work->theta[i];
        memcpy(bytes + behind + sizeof counts + sizeof theta * (size_t)i, &theta, sizeof theta);
    }
    *out = (SamplingSection){bytes, size, work->incidences, work->azimuths};
}

bool sampling_make(const Panel *panel, Arena *arena, SamplingSection *out, Error *err) {
    SamplingWork work = {.panel = panel};
    Arena scratch = *arena;
    const void *tree;
    choose_lanes(&work);
    choose_places(&work, PROBE_LEVEL, &scratch);
    choose_incidences(&work, scratch);
    choose_azimuths(&work, scratch);
    choose_places(&work, LEVEL, &scratch);
    int functions = work.incidences * work.azimuths;
    float *integrals = ARENA_NEW(&scratch, float, (size_t)functions *(size_t)work.leaves);
    for (int i = 0; i < functions; i++)
        read_function(&work, work.theta[i % work.incidences],
                      2 * PI * (i / work.incidences) / work.azimuths,
                      integrals + (size_t)i * (size_t)work.leaves);
    SamplingOptions options = {.level = LEVEL,
                               .octants = work.octants,
                               .functions = functions,
                               .cells = CELLS * work.octants / 2,
                               .variance = CELL_VARIANCE,
                               .uniform_share = UNIFORM_SHARE};
    bool ok = sampling_tree_build(&options, integrals, &scratch, &tree, err) ||
              error_prefix(err, "sampling of the reflection");
    if (!ok) return false;
    write_section(&work, tree, &scratch, out);
    out->bytes = arena_keep(arena, out->bytes, out->size, 8);
    return true;
}
