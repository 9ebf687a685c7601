/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/diffuse_light.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "sky/air/phase_series.h"

#define SIDE PHASE_SIDE
#define DIRECTIONS (2 * SIDE)
#define MOMENTS PHASE_MOMENTS
#define ORDERS_MAX 60

/* Phase functions as series in the azimuth between two directions, for each scatterer. */
typedef struct PhaseModes {
    /* of directions i and j, mode m: [AIR_MOLECULES or AIR_AEROSOL][m][i][j]; times the
     * quadrature's weight of j */
    float between[2][DIFFUSE_MODES][DIRECTIONS][DIRECTIONS];
    float outwards[2][DIFFUSE_MODES][DIFFUSE_COSINES][DIRECTIONS];
    float from_sun[2][DIFFUSE_MODES][DIRECTIONS];
} PhaseModes;

/* Coefficients for light that crosses a layer at a slant. */
typedef struct Crossing {
    Spectrum pass;      /* the share of what came in */
    Spectrum near, far; /* weights of the source where light comes in, and leaves */
    float path;         /* m */
} Crossing;

typedef struct Solver {
    const DiffuseInput *input;
    DiffuseLight *light;
    PhaseModes *phase;
    double *direction;       /* DIRECTIONS cosines: up, then down */
    Spectrum *scattering[2]; /* per level: m^-1 */
    Spectrum *beam;          /* per level: the sun's transmittance */
    Spectrum *layer_depth;   /* per layer, vertical */
    Crossing *crossing;      /* [layer][cosine] */
    Spectrum *radiance;      /* [level][direction][mode]: one order */
    Spectrum *total;         /* all orders */
    Spectrum *order_source;  /* [level][direction][mode] */
} Solver;

static size_t slot(int level, int direction, int mode) {
    return ((size_t)level * DIRECTIONS + (size_t)direction) * DIFFUSE_MODES + (size_t)mode;
}

static void fill_phase(Solver *s) {
    double at[DIRECTIONS][MOMENTS], sun[MOMENTS], outwards[DIFFUSE_COSINES][MOMENTS];
    for (int m = 0; m < DIFFUSE_MODES; m++) {
        for (int i = 0; i < DIRECTIONS; i++) phase_legendre(m, s->direction[i], at[i]);
        for (int i = 0; i < DIFFUSE_COSINES; i++)
            phase_legendre(m, -1 + 2.0 * i / (DIFFUSE_COSINES - 1), outwards[i]);
        phase_legendre(m, -s->input->sun_cosine, sun); /* the beam travels down */
        for (int p = 0; p < 2; p++)
            for (int j = 0; j < DIRECTIONS; j++) {
                float weight = (float)phase_weight[j % SIDE];
                for (int i = 0; i < DIRECTIONS; i++)
                    s->phase->between[p][m][i][j] =
                        phase_series_mode((AirPart)p, at[i], at[j], m) * weight;
                for (int i = 0; i < DIFFUSE_COSINES; i++)
                    s->phase->outwards[p][m][i][j] =
                        phase_series_mode((AirPart)p, outwards[i], at[j], m) * weight;
                s->phase->from_sun[p][m][j] = phase_series_mode((AirPart)p, at[j], sun, m);
            }
    }
}

double diffuse_level_m(const DiffuseLight *light, int level) {
    return light->floor_m +
           (light->top_m - light->floor_m) * pow_d(level / (light->level_count - 1.0), 2.2);
}

static void fill_levels(Solver *s) {
    const AirOptics *o = s->input->optics;
    DiffuseLight *light = s->light;
    double column[AIR_PARTS];
    for (int k = 0; k < DIFFUSE_LEVELS; k++) {
        double z = diffuse_level_m(light, k);
        light->level_m[k] = z;
        for (int p = 0; p < 2; p++)
            s->scattering[p][k] =
                o->scattering[p] * spectrum_all((float)air_density(o, (AirPart)p, z));
        Spectrum depth = spectrum_all(0);
        bool lit = air_column(o, z, s->input->sun_cosine, light->floor_m, column);
        for (int p = 0; p < AIR_PARTS; p++) depth += o->depth[p] * spectrum_all((float)column[p]);
        s->beam[k] = lit ? spectrum_exp(-depth) : spectrum_all(0);
        if (!k) continue;
        air_vertical(o, light->level_m[k - 1], z, column);
        s->layer_depth[k - 1] = spectrum_all(0);
        for (int p = 0; p < AIR_PARTS; p++)
            s->layer_depth[k - 1] += o->depth[p] * spectrum_all((float)column[p]);
    }
}

/* The first order: the sun's beam scattered once. Direction cosines are those of travel. */
static void scatter_beam(Solver *s) {
    for (int k = 0; k < DIFFUSE_LEVELS; k++)
        for (int i = 0; i < DIRECTIONS; i++)
            for (int m = 0; m < DIFFUSE_MODES; m++) {
                Spectrum sum = spectrum_all(0);
                for (int p = 0; p < 2; p++)
                    sum += s->scattering[p][k] * spectrum_all(s->phase->from_sun[p][m][i]);
                float factor = (m ? 2 : 1) / (4 * PI_F);
                s->order_source[slot(k, i, m)] = sum * s->beam[k] * spectrum_all(factor);
            }
}

/* Four lanes: what a register of every x86-64 holds. */
typedef float Quad __attribute__((vector_size(16)));
#define QUADS (SPECTRUM_LANES / 4)

/* Light of a level and a mode in all directions, and what both scatterers do to it. */
typedef struct Scattering {
    Quad from[DIRECTIONS][QUADS];
    Spectrum share[2]; /* m^-1 */
    int first;         /* molecules have three modes: beyond, the aerosol is the first */
} Scattering;

static void start_scattering(const Solver *s, const Spectrum *from, int level, int mode,
                             Scattering *out) {
    for (int j = 0; j < DIRECTIONS; j++)
        memcpy(out->from[j], &from[slot(level, j, mode)], sizeof out->from[j]);
    for (int p = 0; p < 2; p++) out->share[p] = s->scattering[p][level];
    out->first = mode > 2;
}

/* Into one direction, whose phases towards all others are given. */
static void scattered(const Scattering *s, const float *const phase[2], Spectrum *out) {
    Spectrum sum[2] = {spectrum_all(0), spectrum_all(0)};
    for (int p = s->first; p < 2; p++) {
        Quad part[QUADS] = {{0}};
        for (int j = 0; j < DIRECTIONS; j++)
            for (int q = 0; q < QUADS; q++) part[q] += phase[p][j] * s->from[j][q];
        memcpy(&sum[p], part, sizeof part);
    }
    *out = (s->share[0] * sum[0] + s->share[1] * sum[1]) * spectrum_all(0.5f);
}

/* The next order's source from this order's radiance. */
static void scatter_again(Solver *s) {
    for (int k = 0; k < DIFFUSE_LEVELS; k++)
        for (int m = 0; m < DIFFUSE_MODES; m++) {
            Scattering all;
            start_scattering(s, s->radiance, k, m, &all);
            for (int i = 0; i < DIRECTIONS; i++) {
                const float *phase[2] = {s->phase->between[0][m][i], s->phase->between[1][m][i]};
                scattered(&all, phase, &s->order_source[slot(k, i, m)]);
            }
        }
}

/* The source lies between those of a layer's two ends, linear in optical depth. */
static void fill_crossings(Solver *s) {
    const double *level_m = s->light->level_m;
    for (int k = 0; k + 1 < DIFFUSE_LEVELS; k++)
        for (int i = 0; i < SIDE; i++) {
            Crossing *c = &s->crossing[k * SIDE + i];
            float cosine = (float)phase_cosine[i];
            Spectrum depth = s->layer_depth[k] * spectrum_all(1 / cosine);
            c->path = (float)(level_m[k + 1] - level_m[k]) / cosine;
            for (int lane = 0; lane < SPECTRUM_LANES; lane++) {
                float t = depth[lane], e = exp_f(-t);
                /* integrals of e^-x and of e^-x x/t over [0, t], over t */
                float mean = t > 0.01f ? (1 - e) / t : 1 - 0.5f * t;
                float tail = t > 0.05f ? (1 - e - t * e) / (t * t) : 0.5f - t / 3 + t * t / 8;
                c->pass[lane] = e;
                c->near[lane] = tail;
                c->far[lane] = mean - tail;
            }
        }
}

/* Radiance of all modes at the far level of a layer from that at the near one. */
static void cross_layer(Solver *s, const Crossing *c, int direction, int near, int far) {
    const Spectrum *in = s->radiance + slot(near, direction, 0);
    const Spectrum *source[2] = {s->order_source + slot(near, direction, 0),
                                 s->order_source + slot(far, direction, 0)};
    Spectrum *out = s->radiance + slot(far, direction, 0);
    for (int m = 0; m < DIFFUSE_MODES; m++)
        out[m] = in[m] * c->pass +
                 (source[1][m] * c->far + source[0][m] * c->near) * spectrum_all(c->path);
}

static void reflect_on_floor(Solver *s, bool with_beam) {
    Spectrum down = spectrum_all(0);
    for (int j = 0; j < SIDE; j++)
        down += s->radiance[slot(0, SIDE + j, 0)] *
                spectrum_all((float)(2 * PI * phase_weight[j] * phase_cosine[j]));
    s->light->ground_diffuse += down;
    if (with_beam) down += s->light->ground_direct;
    Spectrum up = down * spectrum_all((float)(s->input->floor_albedo / PI));
    for (int i = 0; i < SIDE; i++)
        for (int m = 0; m < DIFFUSE_MODES; m++)
            s->radiance[slot(0, i, m)] = m ? spectrum_all(0) : up;
}

/* One order's radiance from its source, downwards and, from the floor, upwards. */
static void transport(Solver *s, bool with_beam) {
    int top = DIFFUSE_LEVELS - 1;
    for (int i = 0; i < SIDE; i++)
        for (int m = 0; m < DIFFUSE_MODES; m++)
            s->radiance[slot(top, SIDE + i, m)] = spectrum_all(0);
    for (int k = top - 1; k >= 0; k--)
        for (int i = 0; i < SIDE; i++)
            cross_layer(s, &s->crossing[k * SIDE + i], SIDE + i, k + 1, k);
    reflect_on_floor(s, with_beam);
    for (int k = 0; k < top; k++)
        for (int i = 0; i < SIDE; i++) cross_layer(s, &s->crossing[k * SIDE + i], i, k, k + 1);
}

static void leave_at_top(Solver *s) {
    for (int i = 0; i < SIDE; i++)
        s->light->top_exitance += s->total[slot(DIFFUSE_LEVELS - 1, i, 0)] *
                                  spectrum_all((float)(2 * PI * phase_weight[i] * phase_cosine[i]));
}

/* Adds an order to the total; returns its greatest share of it. */
static float add_order(Solver *s) {
    float most = 0;
    for (size_t i = 0; i < slot(DIFFUSE_LEVELS, 0, 0); i++) {
        s->total[i] += s->radiance[i];
        if (i % DIFFUSE_MODES == 0) {
            Spectrum ratio = s->radiance[i] / spectrum_max(s->total[i], spectrum_all(1e-30f));
            most = fmaxf(most, spectrum_max_lane(ratio));
        }
    }
    return most;
}

/* The source of all orders together in the output directions. */
static void fill_source(Solver *s) {
    for (int k = 0; k < DIFFUSE_LEVELS; k++)
        for (int m = 0; m < DIFFUSE_MODES; m++) {
            Spectrum *level = s->light->source + (size_t)(k * DIFFUSE_COSINES * DIFFUSE_MODES);
            Scattering all;
            start_scattering(s, s->total, k, m, &all);
            for (int i = 0; i < DIFFUSE_COSINES; i++) {
                const float *phase[2] = {s->phase->outwards[0][m][i], s->phase->outwards[1][m][i]};
                scattered(&all, phase, &level[i * DIFFUSE_MODES + m]);
            }
        }
}

static Spectrum *spectra(Arena *arena, size_t count) {
    Spectrum *out = arena_alloc(arena, sizeof *out, 64, count);
    for (size_t i = 0; i < count; i++) out[i] = spectrum_all(0);
    return out;
}

void diffuse_light_build(const DiffuseInput *input, Arena *arena, DiffuseLight *out) {
    double direction[DIRECTIONS];
    size_t slots = slot(DIFFUSE_LEVELS, 0, 0);
    *out = (DiffuseLight){.floor_m = input->floor_m,
                          .top_m = input->optics->top_m,
                          .level_count = DIFFUSE_LEVELS,
                          .ground_direct = spectrum_all(0),
                          .ground_diffuse = spectrum_all(0),
                          .top_exitance = spectrum_all(0)};
    out->source = spectra(arena, (size_t)DIFFUSE_LEVELS * DIFFUSE_COSINES * DIFFUSE_MODES);
    Arena scratch = *arena;
    Solver s = {.input = input,
                .light = out,
                .direction = direction,
                .phase = ARENA_NEW(&scratch, PhaseModes, 1)};
    for (int i = 0; i < SIDE; i++) {
        direction[i] = phase_cosine[i];
        direction[SIDE + i] = -phase_cosine[i];
    }
    for (int p = 0; p < 2; p++) s.scattering[p] = spectra(&scratch, DIFFUSE_LEVELS);
    s.beam = spectra(&scratch, DIFFUSE_LEVELS);
    s.layer_depth = spectra(&scratch, DIFFUSE_LEVELS);
    s.crossing = arena_alloc(&scratch, sizeof(Crossing), 64, (DIFFUSE_LEVELS - 1) * SIDE);
    s.radiance = spectra(&scratch, slots);
    s.total = spectra(&scratch, slots);
    s.order_source = spectra(&scratch, slots);
    fill_phase(&s);
    fill_levels(&s);
    fill_crossings(&s);
    out->ground_direct = s.beam[0] * spectrum_all((float)fmax(0, input->sun_cosine));
    scatter_beam(&s);
    int orders = input->orders > 0 ? input->orders : ORDERS_MAX;
    for (int n = 0; n < orders; n++) {
        transport(&s, n == 0);
        if (add_order(&s) < 1e-3f) break;
        scatter_again(&s);
    }
    fill_source(&s);
    leave_at_top(&s);
}

/* ---- reading ----------------------------------------------------------------------------- */

DiffusePlace diffuse_light_place(const DiffuseLight *light, double altitude_m, float cosine) {
    double share = fmax(0, (altitude_m - light->floor_m) / (light->top_m - light->floor_m));
    double at = fmin(pow_d(share, 1 / 2.2) * (light->level_count - 1), light->level_count - 1.0001);
    int k = (int)at;
    float t =
        (float)((altitude_m - light->level_m[k]) / (light->level_m[k + 1] - light->level_m[k]));
    float c = clampf((cosine + 1) * 0.5f * (DIFFUSE_COSINES - 1), 0, DIFFUSE_COSINES - 1.0001f);
    int i = (int)c;
    float u = c - (float)i;
    return (DiffusePlace){k, i, {(1 - t) * (1 - u), (1 - t) * u, t * (1 - u), t * u}};
}

void diffuse_light_modes(const DiffuseLight *light, const DiffusePlace *at,
                         Spectrum mode[DIFFUSE_MODES]) {
    const Spectrum *low =
        light->source + ((size_t)at->level * DIFFUSE_COSINES + (size_t)at->cosine) * DIFFUSE_MODES;
    const Spectrum *high = low + DIFFUSE_COSINES * DIFFUSE_MODES;
    for (int m = 0; m < DIFFUSE_MODES; m++)
        mode[m] = low[m] * spectrum_all(at->weight[0]) +
                  low[m + DIFFUSE_MODES] * spectrum_all(at->weight[1]) +
                  high[m] * spectrum_all(at->weight[2]) +
                  high[m + DIFFUSE_MODES] * spectrum_all(at->weight[3]);
}

void diffuse_light_source(const Spectrum mode[DIFFUSE_MODES], float azimuth_cosine, Spectrum *out) {
    float before = azimuth_cosine, now = 1;
    Spectrum sum = spectrum_all(0);
    for (int m = 0; m < DIFFUSE_MODES; m++) {
        sum += mode[m] * spectrum_all(now);
        float next = 2 * azimuth_cosine * now - before; /* cos((m+1) x); cos(-x) = cos x */
        before = now;
        now = next;
    }
    *out = sum;
}
