/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/hour_sky.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "sky/sun_disc.h"

#define SUNS_AT_ONCE 64 /* in one piece of work */

/* ---- hours ------------------------------------------------------------------------------- */

static bool build_hour(const DaylightInput *input, HourSky *out, Error *err) {
    Daylight sky;
    Arena none = {0}; /* a Perez sky takes no memory */
    DaylightInput quick = *input;
    quick.integral_steps = HOUR_SKY_STEPS;
    if (!daylight_build(&quick, &none, &sky, err)) return false;
    double up = disc_share_above((sky.sun_elevation - sky.horizon) / sky.sun_radius);
    out->shape = sky.shape;
    out->scale = sky.shape_scale;
    light_bands_curve(&sky.sky_curve, out->sky_bands);
    light_bands_curve(&sky.floor_curve, out->floor_bands);
    light_bands_sun(&sky, out->sun_bands);
    for (int b = 0; b < LIGHT_BANDS; b++) out->sun_bands[b] *= (float)up;
    return true;
}

typedef struct HourBuild {
    const HourInputs *inputs;
    HourSky *list;
    bool *is_built;
} HourBuild;

static void build_one(void *user, int item, int worker) {
    (void)worker;
    Error err;
    HourBuild *build = user;
    build->is_built[item] = build_hour(&build->inputs->list[item], &build->list[item], &err);
}

bool hour_skies_build(const HourInputs *inputs, int threads, Arena *arena, const HourSky **out,
                      int *failed, Error *err) {
    int count = inputs->count;
    HourBuild build = {inputs, ARENA_NEW(arena, HourSky, count), ARENA_NEW(arena, bool, count)};
    parallel_for(threads, count, build_one, &build);
    *out = build.list;
    for (int i = 0; i < count; i++) {
        if (build.is_built[i]) continue;
        *failed = i;
        return build_hour(&inputs->list[i], &build.list[i], err); /* once more, for its error */
    }
    return true;
}

/* ---- a response's triangles -------------------------------------------------------------- */

/* Those of the sky that send anything, by sixteen; the last ones may be filled up with such as
 * send nothing. */
typedef struct OpenSky {
    Spectrum *x, *y, *z; /* [block] lanes are triangles: directions */
    Spectrum *shares;    /* [triangle] lanes are bands */
    int blocks;
    double floor[LIGHT_BANDS]; /* shares of all below the horizon */
} OpenSky;

static Spectrum shares_of(const Response *response, int cell) {
    Spectrum first, rest;
    size_t at = (size_t)cell * RESPONSE_BANDS;
    memcpy(&first, response->first + at, sizeof first);
    memcpy(&rest, response->rest + at, sizeof rest);
    return first + rest;
}

static Spectrum *new_spectra(Arena *arena, int count) {
    return arena_alloc(arena, sizeof(Spectrum), _Alignof(Spectrum), (size_t)count);
}

static OpenSky open_sky(const Response *response, Arena *arena) {
    int upper = response->cells.count / 2, room = upper / SPECTRUM_LANES + 1, count = 0;
    OpenSky open = {.x = new_spectra(arena, room),
                    .y = new_spectra(arena, room),
                    .z = new_spectra(arena, room),
                    .shares = new_spectra(arena, room * SPECTRUM_LANES)};
    for (int i = 0; i < room; i++) open.y[i] = spectrum_all(1);
    for (int cell = 0; cell < upper; cell++) {
        Spectrum shares = shares_of(response, cell);
        Vec3 at = response->centers[cell];
        int block = count / SPECTRUM_LANES, lane = count % SPECTRUM_LANES;
        if (!(spectrum_max_lane(shares) > 0)) continue;
        open.x[block][lane] = at.x;
        open.y[block][lane] = at.y;
        open.z[block][lane] = at.z;
        open.shares[count++] = shares;
    }
    open.blocks = (count + SPECTRUM_LANES - 1) / SPECTRUM_LANES;
    for (int cell = upper; cell < response->cells.count; cell++) {
        Spectrum shares = shares_of(response, cell);
        for (int b = 0; b < LIGHT_BANDS; b++) open.floor[b] += (double)shares[b];
    }
    return open;
}

/* ---- luminances -------------------------------------------------------------------------- */

/* sky_shape.h's formula in two factors, for sixteen directions. */
static Spectrum gradation(const SkyShape *shape, Spectrum cos_theta) {
    return spectrum_all(1) +
           spectrum_all((float)shape->a) * spectrum_exp(spectrum_all((float)shape->b) / cos_theta);
}

static Spectrum square_root(Spectrum value) {
    float lane[SPECTRUM_LANES];
    memcpy(lane, &value, sizeof lane);
    for (int i = 0; i < SPECTRUM_LANES; i++) lane[i] = sqrtf(lane[i]);
    memcpy(&value, lane, sizeof value);
    return value;
}

/* acos, absolute error 1e-6 (Abramowitz and Stegun 4.4.46, whose own is 2e-8). */
static Spectrum angle_of(Spectrum cosine) {
    static const float terms[] = {-0.0012624911f, 0.0066700901f, -0.0170881256f, 0.0308918810f,
                                  -0.0501743046f, 0.0889789874f, -0.2145988016f, 1.5707963050f};
    Spectrum sum = {0}, size = spectrum_min(spectrum_max(cosine, -cosine), spectrum_all(1));
    for (int i = 0; i < 8; i++) sum = sum * size + spectrum_all(terms[i]);
    sum = sum * square_root(spectrum_all(1) - size);
    return spectrum_select(spectrum_above(spectrum_all(0), cosine), spectrum_all(3.14159265f) - sum,
                           sum);
}

static Spectrum indicatrix(const SkyShape *shape, Spectrum cos_gamma) {
    return spectrum_all(1) +
           spectrum_all((float)shape->c) *
               spectrum_exp(spectrum_all((float)shape->d) * angle_of(cos_gamma)) +
           spectrum_all((float)shape->e) * cos_gamma * cos_gamma;
}

/* ---- readings ---------------------------------------------------------------------------- */

typedef struct SkyRead {
    const HourSkies *skies;
    const OpenSky *open;
    const Vec3 *suns;
    int count;
    double *out;
    Spectrum **gradations; /* one list a worker */
} SkyRead;

static void grade(const OpenSky *open, const SkyShape *shape, Spectrum *out) {
    for (int i = 0; i < open->blocks; i++) out[i] = gradation(shape, open->y[i]);
}

static double sum_bands(const HourSky *hour, const OpenSky *open, Spectrum sums) {
    double sky = 0, floor = 0;
    for (int b = 0; b < LIGHT_BANDS; b++) {
        sky += (double)hour->sky_bands[b] * (double)sums[b];
        floor += (double)hour->floor_bands[b] * open->floor[b];
    }
    return (double)hour->scale * sky + floor;
}

static double read_sun(const HourSky *hour, const OpenSky *open, const Spectrum *graded, Vec3 sun) {
    Spectrum sums = {0};
    Spectrum x = spectrum_all(sun.x), y = spectrum_all(sun.y), z = spectrum_all(sun.z);
    for (int i = 0; i < open->blocks; i++) {
        Spectrum cosine = open->x[i] * x + open->y[i] * y + open->z[i] * z;
        Spectrum luminance =
            spectrum_max(graded[i] * indicatrix(&hour->shape, cosine), spectrum_all(0));
        const Spectrum *shares = open->shares + i * SPECTRUM_LANES;
        for (int lane = 0; lane < SPECTRUM_LANES; lane++)
            sums += spectrum_all(luminance[lane]) * shares[lane];
    }
    return sum_bands(hour, open, sums);
}

static void read_suns(void *user, int item, int worker) {
    const SkyRead *read = user;
    Spectrum *graded = read->gradations[worker];
    int first = item * SUNS_AT_ONCE, last = -1;
    for (int sun = first; sun < first + SUNS_AT_ONCE && sun < read->count; sun++) {
        int id = read->skies->of_sun[sun];
        if (id < 0) continue;
        const HourSky *hour = &read->skies->list[id];
        if (id != last) grade(read->open, &hour->shape, graded);
        last = id;
        read->out[sun] = read_sun(hour, read->open, graded, read->suns[sun]);
    }
}

double *hour_skies_read(const HourSkies *skies, const Response *response, const Vec3 *suns,
                        int count, int threads, Arena *arena) {
    double *out = ARENA_NEW(arena, double, count);
    Arena scratch = *arena;
    OpenSky open = open_sky(response, &scratch);
    SkyRead read = {skies, &open, suns, count, out, ARENA_NEW(&scratch, Spectrum *, threads)};
    for (int i = 0; i < threads; i++) read.gradations[i] = new_spectra(&scratch, open.blocks);
    parallel_for(threads, (count + SUNS_AT_ONCE - 1) / SUNS_AT_ONCE, read_suns, &read);
    return out;
}
