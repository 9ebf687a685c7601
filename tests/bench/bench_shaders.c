/* SPDX-License-Identifier: Apache-2.0 */
/* bench_shaders.c -- nanoseconds per call of what every path evaluates of a surface.
 *
 *     bench_shaders [RUNS]      one thread, fixed seeds, median and spread (least to most)
 */
#include <stdio.h>
#include <stdlib.h>

#include "bench_timing.h"
#include "base/arena.h"
#include "base/sampler.h"
#include "shaders/bsdf.h"

#define CALLS 20000
#define MAX_RUNS 99

/* Inputs that every work walks through, and a sink that keeps results from being dropped. */
typedef struct Inputs {
    Bsdf  bsdf;
    Vec3  wo[256], wi[256];
    float u[256][3];
    float sink;
} Inputs;

typedef void (*Work)(Inputs *in, int call);

typedef struct Bench {
    const char *name;
    Work        work;
    int         model;
} Bench;

static void work_eval(Inputs *in, int call)
{
    float    pdf;
    Spectrum f = bsdf_eval(&in->bsdf, in->wo[call & 255], in->wi[call >> 8 & 255], &pdf);
    in->sink += f[0] + pdf;
}

static void work_sample(Inputs *in, int call)
{
    BsdfSample s = {0};
    if (bsdf_sample(&in->bsdf, in->wo[call & 255], in->u[call >> 8 & 255], &s))
        in->sink += s.weight[0] + s.pdf;
}

static void work_wavelengths(Inputs *in, int call)
{
    Wavelengths w;
    wavelengths_sample(in->u[call & 255][0], &w);
    in->sink += w.xyz[1][3];
}

static void work_sampler(Inputs *in, int call)
{
    Sampler sampler = sampler_start(1, 2, 3, (uint32_t)call);
    in->sink += sampler_2d(&sampler).x;
}

static const char *const MODEL_NAMES[] = {"plastic", "metal", "lacquer", "frosted glass"};

static void make_model(int model, const EnergyTable *energy, const CoatTable *coat, Bsdf *bsdf)
{
    bsdf->kind = BSDF_METALLIC_ROUGHNESS;
    MetallicRoughness *m = &bsdf->metallic_roughness;
    *m = metallic_roughness_default(energy);
    m->clearcoat_energy = energy;
    m->coat = coat;
    m->base_color = spectrum_all(0.5f);
    m->metallic = model == 1;
    m->alpha = 0.2f;
    m->clearcoat = model == 2;
    m->clearcoat_alpha = 0.01f;
    if (model == 3)
        *bsdf = (Bsdf){.kind = BSDF_DIELECTRIC,
                       .dielectric = {.tint = spectrum_all(1), .ior = 1.5f, .alpha = 0.2f}};
}

static Vec3 upper_direction(Vec2 u)
{
    float r = sqrtf(1 - u.x * u.x), sine, cosine;
    sincos_turns(u.y, &sine, &cosine);
    return vec3(r * cosine, r * sine, u.x);
}

static void fill_inputs(Inputs *in)
{
    for (uint32_t i = 0; i < 256; i++) {
        Sampler sampler = sampler_start(1, 0, 0, i);
        in->wo[i] = upper_direction(sampler_2d(&sampler));
        in->wi[i] = upper_direction(sampler_2d(&sampler));
        for (int k = 0; k < 3; k++) in->u[i][k] = sampler_1d(&sampler);
    }
}

static void run(const char *name, Work work, Inputs *in, int runs)
{
    double times[MAX_RUNS];
    for (int r = 0; r < runs; r++) {
        double start = clock_seconds(CLOCK_MONOTONIC);
        for (int call = 0; call < CALLS; call++) work(in, call);
        times[r] = 1e9 * (clock_seconds(CLOCK_MONOTONIC) - start) / CALLS;
    }
    double median = median_of(times, runs);
    printf("%-24s %8.1f ns a call (%.1f to %.1f)\n", name, median, times[0],
           times[runs - 1]);
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 9;
    runs = runs < 1 ? 1 : runs > MAX_RUNS ? MAX_RUNS : runs;
    Arena arena = arena_reserve(1 << 24);
    const EnergyTable *energy = energy_table_build(1.5f, &arena);
    const CoatTable   *coat = coat_table_build(energy, energy, &arena);
    static Inputs in;
    fill_inputs(&in);
    for (int model = 0; model < 4; model++) {
        char name[64];
        make_model(model, energy, coat, &in.bsdf);
        snprintf(name, sizeof name, "eval, %s", MODEL_NAMES[model]);
        run(name, work_eval, &in, runs);
        snprintf(name, sizeof name, "sample, %s", MODEL_NAMES[model]);
        run(name, work_sample, &in, runs);
    }
    run("wavelengths_sample", work_wavelengths, &in, runs);
    run("sampler_2d", work_sampler, &in, runs);
    arena_release(&arena);
    return in.sink == 0.125f; /* used, never true */
}
