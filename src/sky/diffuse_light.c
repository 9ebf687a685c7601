#include "sky/diffuse_light.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

#define SIDE 8 /* Gauss cosines up, and down */
#define DIRECTIONS (2 * SIDE)
#define MOMENTS 16
#define ORDERS_MAX 60

/* Gauss-Legendre on [0, 1]. */
static const double gauss_cosine[SIDE] = {
    0.01985507175123188, 0.10166676129318663, 0.23723379504183550, 0.40828267875217511,
    0.59171732124782489, 0.76276620495816450, 0.89833323870681337, 0.98014492824876812};
static const double gauss_weight[SIDE] = {
    0.05061426814518813, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
    0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.05061426814518813};

/* Phase functions as series in the azimuth between two directions, for each scatterer. */
typedef struct PhaseModes {
    /* of directions i and j, mode m: [AIR_MOLECULES or AIR_AEROSOL][m][i][j] */
    float between[2][DIFFUSE_MODES][DIRECTIONS][DIRECTIONS];
    float outwards[2][DIFFUSE_MODES][DIFFUSE_COSINES][DIRECTIONS];
    float from_sun[2][DIFFUSE_MODES][DIRECTIONS];
} PhaseModes;

typedef struct Solver {
    const DiffuseInput *input;
    DiffuseLight *light;
    PhaseModes   *phase;
    double       *direction; /* DIRECTIONS cosines: up, then down */
    Spectrum *scattering[2]; /* per level: m^-1 */
    Spectrum *beam;          /* per level: the sun's transmittance */
    Spectrum *layer_depth;   /* per layer, vertical */
    Spectrum *radiance;      /* [level][direction][mode]: one order */
    Spectrum *total;         /* all orders */
    Spectrum *order_source;  /* [level][direction][mode] */
} Solver;

static size_t slot(int level, int direction, int mode)
{
    return ((size_t)level * DIRECTIONS + (size_t)direction) * DIFFUSE_MODES + (size_t)mode;
}

/* Associated Legendre functions with sqrt((l-m)!/(l+m)!), for one m, l = 0 .. MOMENTS - 1. */
static void legendre(int m, double x, double value[MOMENTS])
{
    double sine = sqrt(fmax(0, 1 - x * x)), start = 1;
    for (int k = 1; k <= m; k++) start *= -sine * sqrt((2 * k - 1) / (2.0 * k));
    for (int l = 0; l < MOMENTS; l++) value[l] = 0;
    if (m >= MOMENTS) return;
    value[m] = start;
    if (m + 1 < MOMENTS) value[m + 1] = x * sqrt(2 * m + 1.0) * start;
    for (int l = m + 2; l < MOMENTS; l++)
        value[l] = ((2 * l - 1) * x * value[l - 1] -
                    sqrt((l - 1.0) * (l - 1) - m * m) * value[l - 2]) /
                   sqrt((double)l * l - m * m);
}

/* Mode m of the phase function (sr^-1 times 4 pi) between two cosines. */
static float phase_mode(AirPart part, const double a[MOMENTS], const double b[MOMENTS], int m)
{
    double sum = 0, moment = 1;
    for (int l = 0; l < MOMENTS; l++) {
        double of_molecules = l == 0 ? 1 : l == 2 ? 0.1 : 0;
        if (l >= m) sum += (2 * l + 1) * (part == AIR_MOLECULES ? of_molecules : moment) *
                           a[l] * b[l];
        moment *= (double)AIR_ASYMMETRY;
    }
    return (float)sum;
}

static void fill_phase(Solver *s)
{
    double at[DIRECTIONS][MOMENTS], sun[MOMENTS], outwards[DIFFUSE_COSINES][MOMENTS];
    for (int m = 0; m < DIFFUSE_MODES; m++) {
        for (int i = 0; i < DIRECTIONS; i++) legendre(m, s->direction[i], at[i]);
        for (int i = 0; i < DIFFUSE_COSINES; i++)
            legendre(m, -1 + 2.0 * i / (DIFFUSE_COSINES - 1), outwards[i]);
        legendre(m, -s->input->sun_cosine, sun); /* the beam travels down */
        for (int p = 0; p < 2; p++)
            for (int j = 0; j < DIRECTIONS; j++) {
                for (int i = 0; i < DIRECTIONS; i++)
                    s->phase->between[p][m][i][j] = phase_mode((AirPart)p, at[i], at[j], m);
                for (int i = 0; i < DIFFUSE_COSINES; i++)
                    s->phase->outwards[p][m][i][j] = phase_mode((AirPart)p, outwards[i], at[j],
                                                               m);
                s->phase->from_sun[p][m][j] = phase_mode((AirPart)p, at[j], sun, m);
            }
    }
}

/* Levels close together near the floor, where the aerosol is. */
static void fill_levels(Solver *s)
{
    const AirOptics *o = s->input->optics;
    DiffuseLight    *light = s->light;
    double height = AIR_TOP_M - light->floor_m, column[AIR_PARTS];
    for (int k = 0; k < DIFFUSE_LEVELS; k++) {
        double z = light->floor_m + height * pow_d(k / (DIFFUSE_LEVELS - 1.0), 2.2);
        light->level_m[k] = z;
        for (int p = 0; p < 2; p++)
            s->scattering[p][k] = o->scattering[p] *
                                  spectrum_all((float)air_density(o, (AirPart)p, z));
        Spectrum depth = spectrum_all(0);
        bool     lit = air_column(o, z, s->input->sun_cosine, light->floor_m, column);
        for (int p = 0; p < AIR_PARTS; p++)
            depth += o->depth[p] * spectrum_all((float)column[p]);
        s->beam[k] = lit ? spectrum_exp(-depth) : spectrum_all(0);
        if (!k) continue;
        air_vertical(o, light->level_m[k - 1], z, column);
        s->layer_depth[k - 1] = spectrum_all(0);
        for (int p = 0; p < AIR_PARTS; p++)
            s->layer_depth[k - 1] += o->depth[p] * spectrum_all((float)column[p]);
    }
}

/* The first order: the sun's beam scattered once. Direction cosines are those of travel. */
static void scatter_beam(Solver *s)
{
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

static Spectrum scattered(const Solver *s, const Spectrum *from, int level, int mode,
                          const float *const phase[2])
{
    Spectrum sum[2] = {spectrum_all(0), spectrum_all(0)};
    for (int p = mode > 2; p < 2; p++) /* molecules have three modes */
        for (int j = 0; j < DIRECTIONS; j++)
            sum[p] += spectrum_all(phase[p][j] * (float)gauss_weight[j % SIDE]) *
                      from[slot(level, j, mode)];
    return (s->scattering[0][level] * sum[0] + s->scattering[1][level] * sum[1]) *
           spectrum_all(0.5f);
}

/* The next order's source from this order's radiance. */
static void scatter_again(Solver *s)
{
    for (int k = 0; k < DIFFUSE_LEVELS; k++)
        for (int m = 0; m < DIFFUSE_MODES; m++)
            for (int i = 0; i < DIRECTIONS; i++) {
                const float *phase[2] = {s->phase->between[0][m][i],
                                         s->phase->between[1][m][i]};
                s->order_source[slot(k, i, m)] = scattered(s, s->radiance, k, m, phase);
            }
}

/* Radiance at the far side of a layer: what came in, thinned, and the source of the two ends,
 * linear in between (in optical depth). */
static Spectrum cross_layer(const Solver *s, int layer, float cosine, Spectrum in,
                            Spectrum near, Spectrum far)
{
    const DiffuseLight *light = s->light;
    float    path = (float)(light->level_m[layer + 1] - light->level_m[layer]) / cosine;
    Spectrum depth = s->layer_depth[layer] * spectrum_all(1 / cosine), pass, mean, tail;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float t = depth[i], e = exp_f(-t);
        pass[i] = e;
        /* integrals of e^-x and of e^-x x/t over [0, t], over t */
        mean[i] = t > 0.01f ? (1 - e) / t : 1 - 0.5f * t;
        tail[i] = t > 0.05f ? (1 - e - t * e) / (t * t) : 0.5f - t / 3 + t * t / 8;
    }
    return in * pass + (far * (mean - tail) + near * tail) * spectrum_all(path);
}

static void reflect_on_floor(Solver *s, bool with_beam)
{
    Spectrum down = spectrum_all(0);
    for (int j = 0; j < SIDE; j++)
        down += s->radiance[slot(0, SIDE + j, 0)] *
                spectrum_all((float)(2 * PI * gauss_weight[j] * gauss_cosine[j]));
    s->light->ground_diffuse += down;
    if (with_beam) down += s->light->ground_direct;
    Spectrum up = down * spectrum_all((float)(s->input->floor_albedo / PI));
    for (int i = 0; i < SIDE; i++)
        for (int m = 0; m < DIFFUSE_MODES; m++)
            s->radiance[slot(0, i, m)] = m ? spectrum_all(0) : up;
}

/* One order's radiance from its source, downwards and, from the floor, upwards. */
static void transport(Solver *s, bool with_beam)
{
    int top = DIFFUSE_LEVELS - 1;
    for (int i = 0; i < SIDE; i++)
        for (int m = 0; m < DIFFUSE_MODES; m++) {
            s->radiance[slot(top, SIDE + i, m)] = spectrum_all(0);
            for (int k = top - 1; k >= 0; k--)
                s->radiance[slot(k, SIDE + i, m)] = cross_layer(
                    s, k, (float)gauss_cosine[i], s->radiance[slot(k + 1, SIDE + i, m)],
                    s->order_source[slot(k + 1, SIDE + i, m)],
                    s->order_source[slot(k, SIDE + i, m)]);
        }
    reflect_on_floor(s, with_beam);
    for (int i = 0; i < SIDE; i++)
        for (int m = 0; m < DIFFUSE_MODES; m++)
            for (int k = 0; k < top; k++)
                s->radiance[slot(k + 1, i, m)] = cross_layer(
                    s, k, (float)gauss_cosine[i], s->radiance[slot(k, i, m)],
                    s->order_source[slot(k, i, m)], s->order_source[slot(k + 1, i, m)]);
}

static void leave_at_top(Solver *s)
{
    for (int i = 0; i < SIDE; i++)
        s->light->top_exitance += s->total[slot(DIFFUSE_LEVELS - 1, i, 0)] *
                                  spectrum_all((float)(2 * PI * gauss_weight[i] *
                                                       gauss_cosine[i]));
}

/* Adds an order to the total; returns its greatest share of it. */
static float add_order(Solver *s)
{
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

/* What all orders together scatter into the output directions. */
static void fill_source(Solver *s)
{
    for (int k = 0; k < DIFFUSE_LEVELS; k++)
        for (int i = 0; i < DIFFUSE_COSINES; i++)
            for (int m = 0; m < DIFFUSE_MODES; m++) {
                const float *phase[2] = {s->phase->outwards[0][m][i],
                                         s->phase->outwards[1][m][i]};
                s->light->source[((size_t)k * DIFFUSE_COSINES + (size_t)i) * DIFFUSE_MODES +
                                 (size_t)m] = scattered(s, s->total, k, m, phase);
            }
}

static Spectrum *spectra(Arena *arena, size_t count)
{
    Spectrum *out = arena_alloc(arena, sizeof *out, 64, count);
    for (size_t i = 0; i < count; i++) out[i] = spectrum_all(0);
    return out;
}

void diffuse_light_build(const DiffuseInput *input, Arena *arena, DiffuseLight *out)
{
    double direction[DIRECTIONS];
    size_t slots = slot(DIFFUSE_LEVELS, 0, 0);
    *out = (DiffuseLight){.floor_m = input->floor_m, .sun_cosine = input->sun_cosine,
                          .ground_direct = spectrum_all(0), .ground_diffuse = spectrum_all(0),
                          .top_exitance = spectrum_all(0)};
    out->source = spectra(arena, (size_t)DIFFUSE_LEVELS * DIFFUSE_COSINES * DIFFUSE_MODES);
    Arena  scratch = *arena;
    Solver s = {.input = input, .light = out, .direction = direction,
                .phase = ARENA_NEW(&scratch, PhaseModes, 1)};
    for (int i = 0; i < SIDE; i++) {
        direction[i] = gauss_cosine[i];
        direction[SIDE + i] = -gauss_cosine[i];
    }
    for (int p = 0; p < 2; p++) s.scattering[p] = spectra(&scratch, DIFFUSE_LEVELS);
    s.beam = spectra(&scratch, DIFFUSE_LEVELS);
    s.layer_depth = spectra(&scratch, DIFFUSE_LEVELS);
    s.radiance = spectra(&scratch, slots);
    s.total = spectra(&scratch, slots);
    s.order_source = spectra(&scratch, slots);
    fill_phase(&s);
    fill_levels(&s);
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

void diffuse_light_source(const DiffuseLight *light, double altitude_m, float cosine,
                          float azimuth_cosine, Spectrum *out)
{
    double share = fmax(0, (altitude_m - light->floor_m) / (AIR_TOP_M - light->floor_m));
    double at = fmin(pow_d(share, 1 / 2.2) * (DIFFUSE_LEVELS - 1), DIFFUSE_LEVELS - 1.0001);
    int    k = (int)at;
    float  t = (float)((altitude_m - light->level_m[k]) /
                       (light->level_m[k + 1] - light->level_m[k]));
    float c = clampf((cosine + 1) * 0.5f * (DIFFUSE_COSINES - 1), 0, DIFFUSE_COSINES - 1.0001f);
    int    i = (int)c;
    float  u = c - (float)i, before = azimuth_cosine, now = 1;
    const Spectrum *low = light->source +
                          ((size_t)k * DIFFUSE_COSINES + (size_t)i) * DIFFUSE_MODES;
    const Spectrum *high = low + DIFFUSE_COSINES * DIFFUSE_MODES;
    Spectrum sum = spectrum_all(0);
    for (int m = 0; m < DIFFUSE_MODES; m++) {
        sum += (low[m] * spectrum_all((1 - t) * (1 - u)) +
                low[m + DIFFUSE_MODES] * spectrum_all((1 - t) * u) +
                high[m] * spectrum_all(t * (1 - u)) +
                high[m + DIFFUSE_MODES] * spectrum_all(t * u)) * spectrum_all(now);
        float next = 2 * azimuth_cosine * now - before; /* cos((m+1) x); cos(-x) = cos x */
        before = now;
        now = next;
    }
    *out = sum;
}
