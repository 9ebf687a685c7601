/* SPDX-License-Identifier: Apache-2.0 */
/* bench_panel.c -- nanoseconds of a panel's queries beside flat tables of uncompressed data.
 *
 *     bench_panel RUNS RECIPE.json X.panel     X.panel was fitted to the recipe's set
 *
 * Every work is timed on the panel and, in the same run, on flat tables that hold the recipe's
 * closed form at even steps: emission over theta and phi, logarithms of all levels of the three
 * primaries, four floats a level, two levels a primary (weights looked up by code), one vector
 * exponential; BRDF over theta_i, theta_o and phi, linear values, the 16 wavelengths as the
 * lanes of one vector (the panel, too, goes to its wavelengths beforehand, as a path does; the
 * time of that stands by itself); sampling by inverse cumulative tables, two slices of theta.
 * One flat table has the step at which its rms relative error against the closed form is the
 * panel's, or just below; the other one fills 64 MB or more, beyond the caches.
 * Built once for each instruction set that hot sources are built for: bench_panel has the
 * baseline, bench_panel_avx2 and bench_panel_avx512 evaluate it as frames do on such CPUs.
 * Random arguments, CALLS of them, so many that they touch all of a table; the first run warms
 * up. Processor time of one thread; median and spread (least to most) of RUNS runs.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/sampler.h"
#include "tests/bench/bench_panel_files.h"
#include "tests/bench/bench_timing.h"
#include "tests/bench/flat_tables.h"
#include "panel/query/panel.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_sampling.h"

#define CALLS (1 << 17)
#define MAX_RUNS 99
#define LANES SPECTRUM_LANES
#define FILL_BYTES ((double)64 * 1048576)
#define MOST_BYTES ((double)1024 * 1048576) /* larger tables are counted, not made */

/* What every work walks through. */
typedef struct Arguments {
    Vec3 wo[CALLS], wi[CALLS];
    int code[CALLS][3];
    float u[CALLS][3];
} Arguments;

/* ---- errors: which step has the panel's error ------------------------------------------ */

#define PROBES 4000

typedef struct Probe {
    double theta_i, theta_o, phi; /* phi from the mirror direction */
    int code[3];
} Probe;

/* Leaving directions to 80 degrees, incidences of 10 to 60; half of them within 6 degrees of
 * the mirror direction, where a reflection changes fastest. */
static void make_probes(Probe *probe) {
    uint32_t seed = 1;
    for (int i = 0; i < PROBES; i++) {
        double u[6];
        for (int k = 0; k < 6; k++) u[k] = (double)unit_float(hash_u32(seed++));
        probe[i].theta_i = radians_from_degrees(10 + 50 * u[0]);
        probe[i].theta_o = acos(1 - u[1] * (1 - cos(radians_from_degrees(80))));
        probe[i].phi = PI * u[2];
        if (i % 2) {
            probe[i].theta_o = probe[i].theta_i + radians_from_degrees(12 * u[1] - 6);
            probe[i].phi = radians_from_degrees(6 * u[2]) / fmax(0.1, sin(probe[i].theta_o));
        }
        for (int k = 0; k < 3; k++) probe[i].code[k] = 31 + (int)(u[3 + k] * 224);
    }
}

static void truth_xyz(const SyntheticPanel *recipe, const Probe *probe, double xyz[3]) {
    double angles[2] = {probe->theta_o, probe->phi}, add[3];
    closed_form_black_xyz(recipe, angles, xyz);
    for (int p = 0; p < 3; p++) {
        closed_form_emission_xyz(recipe, p, probe->code[p], angles, add);
        for (int j = 0; j < 3; j++) xyz[j] += add[j];
    }
}

/* Bilinear in the nodes around the probe, which are made here: no table is needed. */
static void interpolated_xyz(const SyntheticPanel *recipe, const FlatEmission *flat,
                             const Probe *probe, float xyz[3]) {
    float nodes[4][4 * (3 * SYNTHETIC_LEVELS_MAX + 1)];
    const float *node[4] = {nodes[0], nodes[1], nodes[2], nodes[3]};
    int t, p;
    float x = place_on((float)probe->theta_o * flat->theta_scale, flat->thetas - 2, &t);
    float y = place_on((float)probe->phi * flat->phi_scale, flat->phis - 1, &p);
    for (int c = 0; c < 4; c++)
        emission_node(recipe, (t + c / 2) / (double)flat->theta_scale,
                      (p + c % 2) / (double)flat->phi_scale, nodes[c]);
    const float w[4] = {(1 - x) * (1 - y), (1 - x) * y, x * (1 - y), x * y};
    emission_from(flat, node, w, probe->code, xyz);
}

/* rms relative error; flat NULL: the panel's. */
static double emission_error(const SyntheticPanel *recipe, const Panel *panel,
                             const FlatEmission *flat, const Probe *probe) {
    double squares = 0;
    for (int i = 0; i < PROBES; i++) {
        double truth[3];
        float xyz[3], rgb[3];
        for (int k = 0; k < 3; k++) rgb[k] = (float)probe[i].code[k];
        truth_xyz(recipe, &probe[i], truth);
        if (flat) interpolated_xyz(recipe, flat, &probe[i], xyz);
        else panel_emission_xyz(panel, direction_of(probe[i].theta_o, probe[i].phi), rgb, xyz);
        double error = (double)xyz[1] / truth[1] - 1;
        squares += error * error;
    }
    return sqrt(squares / PROBES);
}

static double interpolated_brdf(const SyntheticPanel *recipe, const FlatBrdf *flat,
                                const Probe *probe) {
    int i, o, p;
    double sum = 0;
    int last = flat->thetas - 2;
    double x = (double)place_on((float)probe->theta_i * flat->theta_scale, last, &i);
    double y = (double)place_on((float)probe->theta_o * flat->theta_scale, last, &o);
    double z = (double)place_on((float)probe->phi * flat->phi_scale, flat->phis - 2, &p);
    for (int c = 0; c < 8; c++) {
        double w = (c & 4 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 1 ? z : 1 - z);
        sum += w * closed_form_brdf(recipe, (i + (c >> 2)) / (double)flat->theta_scale,
                                    (o + (c >> 1 & 1)) / (double)flat->theta_scale,
                                    (p + (c & 1)) / (double)flat->phi_scale, 550);
    }
    return sum;
}

static double brdf_error(const SyntheticPanel *recipe, const Panel *panel, const FlatBrdf *flat,
                         const Probe *probe) {
    Wavelengths w = {0};
    double squares = 0;
    for (int i = 0; i < LANES; i++) w.nm[i] = 550;
    for (int i = 0; i < PROBES; i++) {
        double truth =
            closed_form_brdf(recipe, probe[i].theta_i, probe[i].theta_o, probe[i].phi, 550);
        double found = flat
                           ? interpolated_brdf(recipe, flat, &probe[i])
                           : (double)panel_brdf(panel, direction_of(probe[i].theta_o, probe[i].phi),
                                                direction_of(probe[i].theta_i, PI), &w)[0];
        squares += (found / truth - 1) * (found / truth - 1);
    }
    return sqrt(squares / PROBES);
}

static const double STEPS[] = {10,   6,   5,   4,   3,    2,   1.5,  1,
                               0.75, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1};
#define STEP_COUNT ((int)(sizeof STEPS / sizeof *STEPS))

/* ---- time ------------------------------------------------------------------------------ */

typedef struct Input {
    const Panel *panel;
    const Arguments *arguments;
    const FlatEmission *emission;
    const FlatBrdf *brdf;
    const FlatSampling *sampling;
    Wavelengths wavelengths;
    PanelLanes lanes; /* the panel at the wavelengths */
    float sink;       /* keeps results alive */
} Input;

typedef void (*Work)(Input *in);

static void panel_emission(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        const int *code = in->arguments->code[i];
        float rgb[3] = {(float)code[0], (float)code[1], (float)code[2]}, xyz[3];
        panel_emission_xyz(in->panel, in->arguments->wo[i], rgb, xyz);
        in->sink += xyz[0] + xyz[1] + xyz[2];
    }
}

static void flat_emission_work(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        float xyz[3];
        flat_emission_xyz(in->emission, in->arguments->wo[i], in->arguments->code[i], xyz);
        in->sink += xyz[0] + xyz[1] + xyz[2];
    }
}

static void panel_brdf_work(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        Spectrum f =
            panel_brdf_at(in->panel, in->arguments->wo[i], in->arguments->wi[i], &in->lanes);
        in->sink += f[0] + f[15];
    }
}

static void panel_lanes_work(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        panel_lanes(in->panel, &in->wavelengths, &in->lanes);
        in->sink += in->lanes.basis[0][i % LANES];
    }
}

static void flat_brdf_work(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        Spectrum f = flat_brdf_value(in->brdf, in->arguments->wo[i], in->arguments->wi[i]);
        in->sink += f[0] + f[15];
    }
}

static void panel_sampling(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        Vec3 wi = {0, 0, 0};
        float pdf = 0;
        panel_sample(in->panel, in->arguments->wo[i], in->arguments->u[i], &wi, &pdf);
        in->sink += wi.x + pdf;
    }
}

static void flat_sampling_work(Input *in) {
    for (int i = 0; i < CALLS; i++) {
        Vec3 wi;
        in->sink += flat_sample(in->sampling, in->arguments->wo[i], in->arguments->u[i], &wi);
        in->sink += wi.x;
    }
}

/* Median nanoseconds a call, and the line about it; beside: what the ratio refers to. */
static double time_work(const char *name, Work work, Input *in, int runs, double bytes,
                        double beside) {
    double ns[MAX_RUNS];
    for (int run = -1; run < runs; run++) { /* the first warms up */
        double start = thread_seconds();
        work(in);
        if (run >= 0) ns[run] = (thread_seconds() - start) * 1e9 / CALLS;
    }
    double median = median_of(ns, runs);
    printf("%-52s %8.1f ns  (%.1f to %.1f) %10.3f MB", name, median, ns[0], ns[runs - 1],
           bytes / 1e6);
    if (beside > 0) printf("  panel takes %.2f of its time", beside / median);
    printf("\n");
    fflush(stdout);
    return median;
}

static void make_arguments(Arguments *a) {
    uint32_t seed = 7;
    for (int i = 0; i < CALLS; i++) {
        float u[7];
        for (int k = 0; k < 7; k++) u[k] = unit_float(hash_u32(seed++));
        a->wo[i] = direction_of(acos((double)(1 - 0.95f * u[0])), 2 * PI * (double)u[1]);
        a->wi[i] = direction_of(acos((double)(1 - 0.95f * u[2])), 2 * PI * (double)u[3]);
        for (int k = 0; k < 3; k++) {
            a->code[i][k] = (int)(unit_float(hash_u32(seed++)) * 256) & 255;
            a->u[i][k] = u[4 + k];
        }
    }
}

/* ---- the three works ------------------------------------------------------------------- */

typedef struct Setting {
    const SyntheticPanel *recipe;
    const Panel *panel;
    const Probe *probe;
    double panel_bytes;
    int runs;
} Setting;

static void name_table(char name[96], const char *what, double step, const char *which,
                       double error) {
    snprintf(name, 96, "%s, flat, %g deg, %s (%.3f%%)", what, step, which, 100 * error);
}

static void bench_emission(const Setting *s, Input *in, Arena arena) {
    double error = emission_error(s->recipe, s->panel, NULL, s->probe);
    double panel = time_work("emission XYZ, panel", panel_emission, in, s->runs, s->panel_bytes, 0);
    int equal = -1, large = STEP_COUNT - 1;
    for (int i = 0; i < STEP_COUNT && equal < 0; i++) {
        FlatEmission shape = flat_emission_shape(s->recipe, STEPS[i]);
        if (emission_error(s->recipe, s->panel, &shape, s->probe) <= error) equal = i;
    }
    for (int i = STEP_COUNT - 1; i >= 0; i--)
        if ((double)flat_emission_shape(s->recipe, STEPS[i]).bytes >= FILL_BYTES) large = i;
    printf("  rms error of the panel %.3f%%\n", 100 * error);
    for (int k = 0; k < 2; k++) {
        Arena scratch = arena;
        char name[96];
        int i = k ? large : equal < 0 ? STEP_COUNT - 1 : equal;
        FlatEmission flat = flat_emission(s->recipe, STEPS[i], &scratch);
        in->emission = &flat;
        name_table(name, "emission XYZ", STEPS[i], k ? "large" : "equal error",
                   emission_error(s->recipe, s->panel, &flat, s->probe));
        time_work(name, flat_emission_work, in, s->runs, (double)flat.bytes, panel);
    }
}

static double bench_brdf(const Setting *s, Input *in, Arena arena) {
    double error = brdf_error(s->recipe, s->panel, NULL, s->probe);
    panel_lanes(in->panel, &in->wavelengths, &in->lanes);
    double panel =
        time_work("BRDF at 16 wavelengths, panel", panel_brdf_work, in, s->runs, s->panel_bytes, 0);
    time_work("its 16 wavelengths, once a path", panel_lanes_work, in, s->runs, s->panel_bytes, 0);
    int equal = -1, large = STEP_COUNT - 1;
    for (int i = 0; i < STEP_COUNT && equal < 0; i++) {
        FlatBrdf shape = flat_brdf_shape(STEPS[i]);
        if (brdf_error(s->recipe, s->panel, &shape, s->probe) <= error) equal = i;
    }
    for (int i = STEP_COUNT - 1; i >= 0; i--)
        if ((double)flat_brdf_shape(STEPS[i]).bytes >= FILL_BYTES) large = i;
    printf("  rms error of the panel %.3f%%\n", 100 * error);
    for (int k = 0; k < 2; k++) {
        Arena scratch = arena;
        char name[96];
        int i = k ? large : equal < 0 ? STEP_COUNT - 1 : equal;
        FlatBrdf shape = flat_brdf_shape(STEPS[i]);
        double at = 100 * brdf_error(s->recipe, s->panel, &shape, s->probe);
        if (!k)
            printf("  a flat table of equal error: %g deg (%.3f%%), %.0f MB\n", STEPS[i], at,
                   (double)shape.bytes / 1e6);
        while ((double)flat_brdf_shape(STEPS[i]).bytes > MOST_BYTES) i--;
        FlatBrdf flat = flat_brdf(s->recipe, STEPS[i], &scratch);
        in->brdf = &flat;
        name_table(name, "BRDF", STEPS[i], k ? "large" : "equal error or the largest",
                   brdf_error(s->recipe, s->panel, &flat, s->probe));
        time_work(name, flat_brdf_work, in, s->runs, (double)flat.bytes, panel);
    }
    return panel;
}

static void bench_sampling(const Setting *s, Input *in, double brdf, Arena arena) {
    static const double steps[2][2] = {{2, 1}, {1, 0.25}}; /* slices, cells, degrees */
    double panel =
        time_work("sample and pdf, panel", panel_sampling, in, s->runs, s->panel_bytes, 0);
    printf("  %.2f BRDF queries\n", panel / brdf);
    for (int k = 0; k < 2; k++) {
        Arena scratch = arena;
        char name[96];
        FlatSampling flat = flat_sampling(s->recipe, steps[k][0], steps[k][1], &scratch);
        in->sampling = &flat;
        snprintf(name, sizeof name, "sample and pdf, flat, slices of %g, cells of %g deg",
                 steps[k][0], steps[k][1]);
        time_work(name, flat_sampling_work, in, s->runs, (double)flat.bytes, panel);
    }
}

static double file_bytes(const char *path) {
    FILE *file = fopen(path, "rb");
    long size = file && !fseek(file, 0, SEEK_END) ? ftell(file) : 0;
    if (file) fclose(file);
    return (double)size;
}

int main(int argc, char **argv) {
    if (argc != 4 || atoi(argv[1]) < 1 || atoi(argv[1]) > MAX_RUNS) {
        fprintf(stderr, "bench_panel RUNS RECIPE.json X.panel\n");
        return 2;
    }
    Arena arena = arena_reserve((size_t)8 << 30);
    SyntheticPanel recipe;
    Panel *panel = NULL;
    if (!bench_panel_files("bench_panel", argv + 2, &arena, &recipe, &panel)) return 3;
    Probe *probe = ARENA_NEW(&arena, Probe, PROBES);
    Arguments *arguments = ARENA_NEW(&arena, Arguments, 1);
    make_probes(probe);
    make_arguments(arguments);
    Setting setting = {&recipe, panel, probe, file_bytes(argv[3]), atoi(argv[1])};
    Input in = {.panel = panel, .arguments = arguments};
    for (int i = 0; i < LANES; i++) in.wavelengths.nm[i] = 400 + 20 * (float)i;
    bench_emission(&setting, &in, arena);
    if (panel_reflects(panel)) {
        double brdf = bench_brdf(&setting, &in, arena);
        bench_sampling(&setting, &in, brdf, arena);
    }
    if (in.sink == 1) printf(" \n"); /* never; the works must not be left out */
    panel_close(panel);
    arena_release(&arena);
    return 0;
}
