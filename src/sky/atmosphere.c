/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/atmosphere.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "sky/air/beam_table.h"
#include "sky/air/diffuse_light.h"
#include "sky/air/sphere_light.h"
#include "sky/cloud_view.h"
#include "sky/sun_position.h"

#define SUN_ANGLES 17
#define SUN_STEP (1.5 * PI / 180)
#define SUN_AHEAD 11 /* of them in twilight towards the sun, where its light comes from */
#define TWILIGHT_FIRST (-2 * PI / 180) /* a sun that is lower: twilight's own light begins */
#define TWILIGHT_ALONE (-4 * PI / 180) /* and is all there is */
#define DARK (-27 * PI / 180) /* the floor's edge so far over the sun: nothing is left to add */
#define RELIEF_LOWEST_M 20.0  /* over the deck: nearer it has no relief */
#define LIGHT_BYTES ((size_t)64 << 20) /* address space for a thread's flat lights */

/* Tables that the rays share. */
typedef struct Builder {
    Atmosphere *atmosphere;
    DiffuseLight light[SUN_ANGLES];
    double first_zenith; /* of light[0]'s sun */
    BeamTable beam;
    Arena *arena; /* of the flat lights: one a thread */
} Builder;

/* ---- shared tables ----------------------------------------------------------------------- */

static void fill_light(void *context, int item, int worker) {
    Builder *b = context;
    const AtmosphereInput *in = &b->atmosphere->input;
    DiffuseInput input = {&b->atmosphere->optics, in->floor_m, in->air.ground_albedo,
                          cos_d(b->first_zenith + item * SUN_STEP), 0};
    diffuse_light_build(&input, &b->arena[worker], &b->light[item]);
}

/* ---- one point --------------------------------------------------------------------------- */

/* A ray in the plane of x and z, the observer on the z axis. */
typedef struct AirRay {
    double radius;       /* of the observer */
    double direction[2]; /* x and z */
} AirRay;

/* A place on the ray, for any sun. */
typedef struct AirPoint {
    double up[2]; /* the local zenith, x and z */
    double altitude;
    double cosine; /* of the ray to the local zenith */
} AirPoint;

/* How the sun stands there. */
typedef struct AirSun {
    double cosine;         /* to the local zenith */
    double azimuth_cosine; /* to the ray */
} AirSun;

static AirPoint place_at(const AirRay *ray, double distance) {
    double x = distance * ray->direction[0], z = ray->radius + distance * ray->direction[1];
    double r = sqrt(x * x + z * z), ux = x / r, uz = z / r;
    return (AirPoint){{ux, uz}, r - AIR_EARTH_M, ray->direction[0] * ux + ray->direction[1] * uz};
}

static AirSun sun_over(const AirRay *ray, const AirPoint *at, const double sun[3]) {
    double c = at->cosine, s = sun[0] * at->up[0] + sun[2] * at->up[1];
    double across = ray->direction[0] * sun[0] + ray->direction[1] * sun[2] - c * s;
    double norm = sqrt(fmax(0, 1 - c * c) * fmax(0, 1 - s * s));
    double azimuth = norm > 1e-12 ? across / norm : 1;
    return (AirSun){s, fmax(-1, fmin(1, azimuth))};
}

/* The first of the two tables around a sun angle, and their weights. */
static int light_at(const Builder *b, double sun_cosine, float weight[2]) {
    double x = (acos_d(fmax(-1, fmin(1, sun_cosine))) - b->first_zenith) / SUN_STEP;
    x = fmax(0, fmin(x, SUN_ANGLES - 1.0001));
    sphere_light_weights((float)(x - (int)x), b->light[(int)x].rise, weight);
    return (int)x;
}

/* ---- one ray ----------------------------------------------------------------------------- */

/* Distance to the floor, or else to space. */
static double ray_length(const AirRay *ray, const BeamTable *air, bool *meets_floor) {
    double r = ray->radius, b = r * ray->direction[1];
    double floor = AIR_EARTH_M + air->floor_m, top = AIR_EARTH_M + air->optics.top_m;
    double under = b * b - r * r + floor * floor;
    *meets_floor = b < 0 && under > 0;
    if (*meets_floor) return fmax(0, -b - sqrt(under));
    return -b + sqrt(fmax(0, b * b - r * r + top * top));
}

/* What a floor reflects: of the beam, and of the sky's light. */
typedef struct FloorLight {
    Spectrum beam, sky;
} FloorLight;

/* Its exitance there over the albedo. */
static FloorLight floor_light(const Builder *b, double altitude, double sun_cosine) {
    float weight[2];
    Spectrum direct;
    int i = light_at(b, sun_cosine, weight);
    Spectrum diffuse = b->light[i].ground_diffuse * spectrum_all(weight[0]) +
                       b->light[i + 1].ground_diffuse * spectrum_all(weight[1]);
    BeamHeight height = beam_table_height(&b->beam, altitude);
    beam_table_sun(&b->beam, &height, sun_cosine, &direct);
    direct *= spectrum_all((float)fmax(0, sun_cosine));
    return (FloorLight){direct, diffuse};
}

static Spectrum reflected(const Builder *b, Spectrum irradiance) {
    return irradiance * spectrum_all((float)(b->atmosphere->input.air.ground_albedo / PI));
}

static Spectrum floor_radiance(const Builder *b, double altitude, double sun_cosine) {
    FloorLight light = floor_light(b, altitude, sun_cosine);
    return reflected(b, light.sky + light.beam);
}

/* A step of a ray: all that does not depend on where the sun stands. */
typedef struct Step {
    BeamHeight height;
    DiffusePlace place;
    Spectrum seen;          /* mean transmittance from the observer, times the length */
    Spectrum scattering[2]; /* of molecules and aerosol, m^-1 */
    bool is_read[SUN_ANGLES];
    Spectrum mode[SUN_ANGLES][DIFFUSE_MODES]; /* the lights' sources, once read */
} Step;

/* passing: transmittance from the observer to the step, then beyond it. */
static void start_step(const Builder *b, const AirPoint *at, float length, Spectrum *passing,
                       Step *step) {
    const AirOptics *optics = &b->beam.optics;
    float density[AIR_PARTS];
    Spectrum depth = spectrum_all(0);
    step->height = beam_table_height(&b->beam, at->altitude);
    /* the source sends towards the eye, against the ray */
    step->place = diffuse_light_place(&b->light[0], at->altitude, (float)-at->cosine);
    beam_table_density(&b->beam, at->altitude, density);
    for (int p = 0; p < AIR_PARTS; p++)
        depth += optics->depth[p] * spectrum_all(density[p] * length);
    for (int k = 0; k < SPECTRUM_LANES; k++) /* mean transmittance inside the step */
        step->seen[k] = depth[k] > 0.01f ? (1 - exp_f(-depth[k])) / depth[k] : 1 - 0.5f * depth[k];
    step->seen *= *passing * spectrum_all(length);
    for (int p = 0; p < 2; p++)
        step->scattering[p] = optics->scattering[p] * spectrum_all(density[p]);
    for (int i = 0; i < SUN_ANGLES; i++) step->is_read[i] = false;
    *passing *= spectrum_exp(-depth);
}

/* Source of one light in the direction of the eye. */
static Spectrum step_source(const Builder *b, Step *step, int light, float azimuth_cosine) {
    Spectrum source;
    if (!step->is_read[light])
        diffuse_light_modes(&b->light[light], &step->place, step->mode[light]);
    step->is_read[light] = true;
    diffuse_light_source(step->mode[light], azimuth_cosine, &source);
    return source;
}

/* Adds what a step sends to the eye under one sun to place `slot` of the tables. */
static void add_step(const Builder *b, Step *step, const AirSun *sun, size_t slot) {
    Atmosphere *a = b->atmosphere;
    float weight[2];
    Spectrum beam;
    beam_table_sun(&b->beam, &step->height, sun->cosine, &beam);
    beam *= step->seen;
    a->molecules[slot] += step->scattering[AIR_MOLECULES] * beam;
    a->aerosol[slot] += step->scattering[AIR_AEROSOL] * beam;
    int i = light_at(b, sun->cosine, weight);
    /* it sends against the ray, and the beam travels away from the sun: both turn round, so
     * that the azimuth between them stays */
    float azimuth = (float)sun->azimuth_cosine;
    a->rest[slot] += step->seen * (step_source(b, step, i, azimuth) * spectrum_all(weight[0]) +
                                   step_source(b, step, i + 1, azimuth) * spectrum_all(weight[1]));
}

/* Adds what the floor sends through the air to place `slot` of the tables. */
static void add_floor(const Builder *b, Spectrum passing, double altitude, double sun_cosine,
                      size_t slot) {
    Atmosphere *a = b->atmosphere;
    size_t below = (size_t)ATMOSPHERE_ROWS * ATMOSPHERE_COLUMNS;
    FloorLight light = floor_light(b, altitude, sun_cosine);
    a->rest[slot] += passing * reflected(b, light.sky + light.beam);
    if (!a->floor_beam || slot < below) return;
    a->floor_beam[slot - below] = passing * reflected(b, light.beam);
    a->floor_sky[slot - below] = passing * reflected(b, light.sky);
}

/* ---- the table --------------------------------------------------------------------------- */

static double row_elevation(const Atmosphere *a, bool below, int row) {
    double share = row / (ATMOSPHERE_ROWS - 1.0),
           reach = below ? -PI / 2 - a->horizon : PI / 2 - a->horizon;
    double nudge = row == 0 ? (below ? -1e-6 : 1e-6) : 0; /* on one side of the edge */
    return a->horizon + reach * share * share + nudge;
}

/* The sun's direction for a column of the tables, where the ray has azimuth 0. */
static void column_sun(const Atmosphere *a, int column, double sun[3]) {
    double elevation = a->input.sun_elevation, azimuth = PI * column / (ATMOSPHERE_COLUMNS - 1);
    sun[0] = cos_d(elevation) * cos_d(azimuth);
    sun[1] = cos_d(elevation) * sin_d(azimuth);
    sun[2] = sin_d(elevation);
}

/* One elevation: its ray is followed once for the suns of all columns. */
static void fill_row(void *context, int item, int worker) {
    Builder *b = context;
    Atmosphere *a = b->atmosphere;
    double elevation = row_elevation(a, item >= ATMOSPHERE_ROWS, item % ATMOSPHERE_ROWS);
    double sun[ATMOSPHERE_COLUMNS][3], from = 0;
    AirRay ray = {AIR_EARTH_M + a->input.observer_m, {cos_d(elevation), sin_d(elevation)}};
    bool meets_floor;
    double length = ray_length(&ray, &b->beam, &meets_floor);
    size_t first = (size_t)item * ATMOSPHERE_COLUMNS;
    Spectrum passing = spectrum_all(1);
    Step step;
    (void)worker;
    for (int j = 0; j < ATMOSPHERE_COLUMNS; j++) {
        size_t at = first + (size_t)j;
        a->molecules[at] = a->aerosol[at] = a->rest[at] = spectrum_all(0);
        column_sun(a, j, sun[j]);
    }
    for (int i = 0; i < a->input.steps; i++) {
        double share = (i + 1.0) / a->input.steps, to = length * share * share;
        AirPoint at = place_at(&ray, 0.5 * (from + to));
        start_step(b, &at, (float)(to - from), &passing, &step);
        for (int j = 0; j < ATMOSPHERE_COLUMNS; j++) {
            AirSun here = sun_over(&ray, &at, sun[j]);
            add_step(b, &step, &here, first + (size_t)j);
        }
        from = to;
    }
    if (!meets_floor) return;
    AirPoint end = place_at(&ray, length);
    for (int j = 0; j < ATMOSPHERE_COLUMNS; j++)
        add_floor(b, passing, end.altitude, sun_over(&ray, &end, sun[j]).cosine, first + (size_t)j);
}

static Spectrum *spectra(Arena *arena, size_t count) {
    return arena_alloc(arena, sizeof(Spectrum), 64, count);
}

/* Flat layers by day. One arena a thread: what it solves a light in, it solves the next in. */
static void build_flat_lights(Builder *b, int threads, Arena *scratch) {
    b->arena = ARENA_NEW(scratch, Arena, threads);
    for (int i = 0; i < threads; i++) b->arena[i] = arena_reserve(LIGHT_BYTES);
    b->first_zenith = PI / 2 - b->atmosphere->input.sun_elevation - SUN_STEP * (SUN_ANGLES / 2);
    b->first_zenith = fmax(0, fmin(PI - SUN_STEP * (SUN_ANGLES - 1), b->first_zenith));
    parallel_for(threads, SUN_ANGLES, fill_light, b);
}

static void build_sphere_lights(Builder *b, Arena *scratch) {
    const AtmosphereInput *in = &b->atmosphere->input;
    b->first_zenith =
        fmin(PI - SUN_STEP * (SUN_ANGLES - 1), PI / 2 - in->sun_elevation - SUN_STEP * SUN_AHEAD);
    SphereInput input = {
        &b->beam, in->air.ground_albedo, b->first_zenith, SUN_STEP, SUN_ANGLES, 0, in->threads};
    sphere_light_build(&input, scratch, b->light);
}

/* Fills *out, whose input and tables are there, for the air of `optics`. */
static void build_tables(Atmosphere *out, const AirOptics *optics, bool in_twilight,
                         Arena scratch) {
    const AtmosphereInput *in = &out->input;
    int threads = in->threads < SUN_ANGLES ? in->threads : SUN_ANGLES;
    Builder *b = arena_alloc(&scratch, sizeof *b, 64, 1);
    b->atmosphere = out;
    if (in_twilight) {
        beam_table_build_bent(optics, in->floor_m, in->threads, &scratch, &b->beam);
        build_sphere_lights(b, &scratch);
    } else {
        beam_table_build(optics, in->floor_m, in->threads, &scratch, &b->beam);
        build_flat_lights(b, threads, &scratch);
    }
    parallel_for(in->threads, 2 * ATMOSPHERE_ROWS, fill_row, b);
    double sine = sin_d(in->sun_elevation);
    BeamHeight height = beam_table_height(&b->beam, in->observer_m);
    beam_table_passing(&b->beam, &height, sine, &out->sun_passing);
    out->floor_exitance = floor_radiance(b, in->floor_m, sine) * spectrum_all(PI_F);
    for (int i = 0; i < threads && b->arena; i++) arena_release(&b->arena[i]);
}

static void take_tables(Atmosphere *out, Arena *arena) {
    size_t count = (size_t)2 * ATMOSPHERE_ROWS * ATMOSPHERE_COLUMNS;
    out->molecules = spectra(arena, count);
    out->aerosol = spectra(arena, count);
    out->rest = spectra(arena, count);
    if (!(out->input.relief_m > 0)) return;
    out->floor_beam = spectra(arena, count / 2);
    out->floor_sky = spectra(arena, count / 2);
}

static void mix(Spectrum *to, const Spectrum *with, size_t count, float share) {
    for (size_t i = 0; i < count; i++)
        to[i] = to[i] * spectrum_all(1 - share) + with[i] * spectrum_all(share);
}

/* Where the sun stands if it is seen at an elevation: refraction has lifted it. */
static double true_elevation(const AtmosphereInput *in) {
    double mbar, celsius, place = in->sun_elevation;
    standard_atmosphere(in->observer_m, &mbar, &celsius);
    for (int i = 0; i < 30; i++)
        place =
            in->sun_elevation -
            radians_from_degrees(sun_refraction_deg(degrees_from_radians(place), mbar, celsius));
    return place;
}

/* The disc itself is seen straight, as by day: from an aircraft it may still be up. */
static void see_sun(Atmosphere *out) {
    const AtmosphereInput *in = &out->input;
    double column[AIR_PARTS], cosine = sin_d(fmax(in->sun_elevation, out->horizon)) + 1e-9;
    Spectrum depth = spectrum_all(0);
    air_column(&out->optics, in->observer_m, cosine, in->floor_m - 1, column);
    for (int p = 0; p < AIR_PARTS; p++)
        depth += out->optics.depth[p] * spectrum_all((float)column[p]);
    out->sun_passing = spectrum_exp(-depth);
}

/* By day the table as it is; below TWILIGHT_ALONE twilight's; in between a mixture. Deep in the
 * night the tables stay empty: no direction has a thousandth of the background's light. */
static void add_twilight(Atmosphere *out, float share, Arena scratch) {
    size_t count = (size_t)2 * ATMOSPHERE_ROWS * ATMOSPHERE_COLUMNS;
    AirOptics optics = out->optics;
    Atmosphere twilight = *out;
    optics.top_m = AIR_HIGHEST_TOP_M;
    twilight.input.sun_elevation = true_elevation(&out->input);
    if (share < 1) take_tables(&twilight, &scratch);
    build_tables(&twilight, &optics, true, scratch);
    if (share < 1) {
        mix(out->molecules, twilight.molecules, count, share);
        mix(out->aerosol, twilight.aerosol, count, share);
        mix(out->rest, twilight.rest, count, share);
    }
    if (share < 1 && out->floor_beam) {
        mix(out->floor_beam, twilight.floor_beam, count / 2, share);
        mix(out->floor_sky, twilight.floor_sky, count / 2, share);
    }
    if (share >= 1) see_sun(out);
    mix(&out->floor_exitance, &twilight.floor_exitance, 1, share);
}

/* Of a deck that lies under the observer, and not around him. */
static void add_relief(Atmosphere *out, Arena *arena) {
    const AtmosphereInput *in = &out->input;
    double height = in->observer_m - in->floor_m;
    if (!(in->relief_m > 0) || height < RELIEF_LOWEST_M) return;
    CloudViewInput input = {height,          in->relief_m,      out->horizon,
                            in->sun_azimuth, in->sun_elevation, in->threads};
    out->relief = ARENA_NEW(arena, CloudRelief, 1);
    cloud_view_build(&input, arena, out->relief);
}

/* Smooth, with no corner at either end. */
static float twilight_share(double sun_elevation) {
    double x = (TWILIGHT_FIRST - sun_elevation) / (TWILIGHT_FIRST - TWILIGHT_ALONE);
    x = fmax(0, fmin(1, x));
    return (float)(x * x * (3 - 2 * x));
}

/* The same as the tables' makers find. */
static void build_sun(Atmosphere *out, Arena scratch) {
    const AtmosphereInput *in = &out->input;
    if (twilight_share(in->sun_elevation) >= 1) {
        see_sun(out);
        return;
    }
    BeamTable beam;
    beam_table_build(&out->optics, in->floor_m, in->threads, &scratch, &beam);
    BeamHeight height = beam_table_height(&beam, in->observer_m);
    beam_table_passing(&beam, &height, sin_d(in->sun_elevation), &out->sun_passing);
}

bool atmosphere_build(const AtmosphereInput *input, Arena *arena, Atmosphere *out, Error *err) {
    if (!(input->observer_m >= input->floor_m && input->observer_m <= 60000))
        return error_set(err, ERROR_INPUT,
                         "the observer stands at %g m, required: between the "
                         "ground (or cloud deck) at %g m and 60000 m",
                         input->observer_m, input->floor_m);
    *out = (Atmosphere){.input = *input, .optics = air_optics(&input->air)};
    if (!out->input.steps) out->input.steps = 48;
    out->horizon = -acos_d((AIR_EARTH_M + input->floor_m) / (AIR_EARTH_M + input->observer_m));
    float share = twilight_share(input->sun_elevation);
    bool is_dark = input->sun_elevation < out->horizon + DARK;
    out->sun_passing = out->floor_exitance = spectrum_all(0);
    if (input->sun_alone) {
        if (!is_dark) build_sun(out, *arena);
        return true;
    }
    take_tables(out, arena);
    if (share < 1) build_tables(out, &out->optics, false, *arena);
    if (share > 0 && !is_dark) add_twilight(out, share, *arena);
    if (share < 1 || !is_dark) add_relief(out, arena);
    return true;
}

/* The values of the tables in a direction, and its cosine to the sun. */
typedef struct SkyParts {
    Spectrum molecules, aerosol, rest;
    float cosine;
} SkyParts;

/* The four entries around a direction. */
typedef struct Entries {
    bool below;
    size_t from[4]; /* of the tables' half below the horizon, or above */
    float weight[4];
} Entries;

static Entries place_of(const Atmosphere *a, float elevation, float azimuth) {
    bool below = (double)elevation < a->horizon;
    float horizon = (float)a->horizon, reach = below ? -PI_F / 2 - horizon : PI_F / 2 - horizon;
    float y = safe_sqrtf((elevation - horizon) / reach) * (ATMOSPHERE_ROWS - 1);
    float turns = azimuth * (0.5f * INV_PI_F), around = turns - floorf(turns); /* [0, 1) */
    float x = (around > 0.5f ? 1 - around : around) * 2 * (ATMOSPHERE_COLUMNS - 1);
    y = clampf(y, 0, ATMOSPHERE_ROWS - 1.001f), x = clampf(x, 0, ATMOSPHERE_COLUMNS - 1.001f);
    int i = (int)y, j = (int)x;
    float t = y - (float)i, u = x - (float)j;
    size_t at = (size_t)i * ATMOSPHERE_COLUMNS + (size_t)j;
    return (Entries){below,
                     {at, at + 1, at + ATMOSPHERE_COLUMNS, at + ATMOSPHERE_COLUMNS + 1},
                     {(1 - t) * (1 - u), (1 - t) * u, t * (1 - u), t * u}};
}

static SkyParts look_up(const Atmosphere *a, float elevation, float azimuth) {
    Entries at = place_of(a, elevation, azimuth);
    size_t half = at.below ? (size_t)ATMOSPHERE_ROWS * ATMOSPHERE_COLUMNS : 0;
    Spectrum molecules = spectrum_all(0), aerosol = spectrum_all(0), sum = spectrum_all(0);
    for (int k = 0; k < 4; k++) {
        Spectrum w = spectrum_all(at.weight[k]);
        molecules += w * a->molecules[half + at.from[k]];
        aerosol += w * a->aerosol[half + at.from[k]];
        sum += w * a->rest[half + at.from[k]];
    }
    float s[3], c[3];
    sincos_turns(elevation * (0.5f * INV_PI_F), &s[0], &c[0]);
    sincos_turns((float)a->input.sun_elevation * (0.5f * INV_PI_F), &s[1], &c[1]);
    sincos_turns(azimuth * (0.5f * INV_PI_F), &s[2], &c[2]);
    float cosine = s[0] * s[1] + c[0] * c[1] * c[2];
    return (SkyParts){molecules, aerosol, sum, cosine};
}

Spectrum atmosphere_radiance(const Atmosphere *a, float elevation, float azimuth) {
    SkyParts at = look_up(a, elevation, azimuth);
    return at.rest + at.molecules * spectrum_all(air_phase_molecules(at.cosine)) +
           at.aerosol * spectrum_all(air_phase_aerosol(at.cosine));
}

Spectrum atmosphere_relief(const Atmosphere *a, float elevation, float azimuth) {
    Spectrum sum = spectrum_all(0);
    if (!a->relief) return sum;
    Entries at = place_of(a, elevation, azimuth);
    if (!at.below) return sum;
    Spectrum share = spectrum_all(a->relief->diffuse);
    for (int k = 0; k < 4; k++)
        sum += spectrum_all(at.weight[k]) *
               (a->floor_beam[at.from[k]] + share * a->floor_sky[at.from[k]]);
    return sum * spectrum_all(cloud_relief_factor(a->relief, elevation, azimuth) - 1);
}

/* The phase function is (1 + cos^2) times a constant; of it (1 - cos^2) is polarised. */
Spectrum atmosphere_polarised(const Atmosphere *a, float elevation, float azimuth) {
    SkyParts at = look_up(a, elevation, azimuth);
    float square = min_f(at.cosine * at.cosine, 1);
    return at.molecules *
           spectrum_all(air_phase_molecules(at.cosine) * (1 - square) / (1 + square));
}

Spectrum atmosphere_diffuse(const Atmosphere *a) {
    const int rows = 200, columns = 96;
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < rows; i++) {
        double s0 = (double)i / rows, s1 = (i + 1.0) / rows;
        double low = PI / 2 * s0 * s0, high = PI / 2 * s1 * s1;
        double weight =
            0.5 * (sin_d(high) * sin_d(high) - sin_d(low) * sin_d(low)) * 2 * PI / columns;
        for (int j = 0; j < columns; j++)
            sum += spectrum_all((float)weight) *
                   atmosphere_radiance(a, (float)(0.5 * (low + high)),
                                       (float)(PI * (j + 0.5) / columns));
    }
    return sum;
}
