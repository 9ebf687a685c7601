#include "sky/atmosphere.h"

#include <math.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "sky/diffuse_light.h"

#define SUN_ANGLES 17
#define SUN_STEP (1.5 * PI / 180)
#define SUN_RADIUS 0.00465
#define COLUMN_HEIGHTS 96
#define COLUMN_COSINES 192
#define DENSITY_NODES 2048
#define LIGHT_BYTES ((size_t)64 << 20) /* address space for one diffuse_light_build */

/* Tables that the rays share. */
typedef struct Builder {
    Atmosphere  *atmosphere;
    DiffuseLight light[SUN_ANGLES];
    double       first_zenith; /* of light[0]'s sun */
    float       *column;  /* [height][cosine][part]: to space */
    float       *density; /* [node][part], m^-1, evenly over the root of the altitude */
    Arena       *arena;   /* of the lights: one each */
} Builder;

/* ---- shared tables ----------------------------------------------------------------------- */

/* Cosine of the floor's edge as seen from an altitude. */
static double edge_cosine(double altitude_m, double floor_m)
{
    double ratio = (AIR_EARTH_M + floor_m) / (AIR_EARTH_M + fmax(altitude_m, floor_m));
    return -sqrt(fmax(0, 1 - ratio * ratio));
}

static double table_height(const Builder *b, int i)
{
    double share = i / (COLUMN_HEIGHTS - 1.0), floor = b->atmosphere->input.floor_m;
    return floor + (AIR_TOP_M - floor) * share * share;
}

static void fill_columns(void *context, int item, int worker)
{
    const Builder *b = context;
    double height = table_height(b, item), edge = edge_cosine(height,
                                                              b->atmosphere->input.floor_m);
    (void)worker;
    for (int j = 0; j < COLUMN_COSINES; j++) {
        double share = j / (COLUMN_COSINES - 1.0), column[AIR_PARTS];
        double cosine = edge + (1 - edge) * share * share + 1e-9;
        air_column(&b->atmosphere->optics, height, cosine, b->atmosphere->input.floor_m - 1,
                   column);
        for (int p = 0; p < AIR_PARTS; p++)
            b->column[(item * COLUMN_COSINES + j) * AIR_PARTS + p] = (float)column[p];
    }
}

static void fill_density(Builder *b)
{
    for (int i = 0; i < DENSITY_NODES; i++) {
        double share = i / (DENSITY_NODES - 1.0), z = AIR_TOP_M * share * share;
        for (int p = 0; p < AIR_PARTS; p++)
            b->density[i * AIR_PARTS + p] =
                (float)air_density(&b->atmosphere->optics, (AirPart)p, z);
    }
}

static void fill_light(void *context, int item, int worker)
{
    Builder *b = context;
    const AtmosphereInput *in = &b->atmosphere->input;
    DiffuseInput input = {&b->atmosphere->optics, in->floor_m, in->air.ground_albedo,
                          cos_d(b->first_zenith + item * SUN_STEP), 0};
    (void)worker;
    diffuse_light_build(&input, &b->arena[item], &b->light[item]);
}

/* ---- one point --------------------------------------------------------------------------- */

/* Transmittance from space to a point; below the floor's edge the edge's own. */
static Spectrum passing_at(const Builder *b, double altitude, double cosine)
{
    const AtmosphereInput *in = &b->atmosphere->input;
    double edge = edge_cosine(altitude, in->floor_m);
    double y = sqrt(fmax(0, altitude - in->floor_m) / (AIR_TOP_M - in->floor_m)) *
               (COLUMN_HEIGHTS - 1);
    double x = sqrt(fmax(0, fmin(1, (cosine - edge) / (1 - edge)))) * (COLUMN_COSINES - 1);
    int    i = (int)fmin(y, COLUMN_HEIGHTS - 1.001), j = (int)fmin(x, COLUMN_COSINES - 1.001);
    float  t = (float)(y - i), u = (float)(x - j);
    const float *low = b->column + (i * COLUMN_COSINES + j) * AIR_PARTS;
    const float *high = low + COLUMN_COSINES * AIR_PARTS;
    Spectrum depth = spectrum_all(0);
    for (int p = 0; p < AIR_PARTS; p++) {
        float column = lerpf(lerpf(low[p], low[p + AIR_PARTS], u),
                             lerpf(high[p], high[p + AIR_PARTS], u), t);
        depth += b->atmosphere->optics.depth[p] * spectrum_all(column);
    }
    return spectrum_exp(-depth);
}

/* How much of the sun's beam reaches a point; the disc sets behind the floor's edge. */
static Spectrum beam_at(const Builder *b, double altitude, double cosine)
{
    double edge = edge_cosine(altitude, b->atmosphere->input.floor_m);
    double seen = 0.5 + (acos_d(edge) - acos_d(fmax(-1, fmin(1, cosine)))) / (2 * SUN_RADIUS);
    if (seen <= 0) return spectrum_all(0);
    return passing_at(b, altitude, cosine) * spectrum_all((float)fmin(1, seen));
}

static void density_at(const Builder *b, double altitude, float density[AIR_PARTS])
{
    double x = sqrt(fmax(0, altitude) / AIR_TOP_M) * (DENSITY_NODES - 1);
    int    i = (int)fmin(x, DENSITY_NODES - 1.001);
    for (int p = 0; p < AIR_PARTS; p++)
        density[p] = lerpf(b->density[i * AIR_PARTS + p],
                           b->density[(i + 1) * AIR_PARTS + p], (float)(x - i));
}

/* A ray in the plane of x and z, the observer on the z axis; the sun anywhere. */
typedef struct AirRay {
    double radius;          /* of the observer */
    double direction[3], sun[3];
} AirRay;

/* What the local zenith makes of the ray at a distance. */
typedef struct AirPoint {
    double altitude, cosine, sun_cosine, azimuth_cosine;
} AirPoint;

static AirPoint place_at(const AirRay *ray, double distance)
{
    double x = distance * ray->direction[0], z = ray->radius + distance * ray->direction[2];
    double r = sqrt(x * x + z * z), ux = x / r, uz = z / r;
    double c = ray->direction[0] * ux + ray->direction[2] * uz;
    double s = ray->sun[0] * ux + ray->sun[2] * uz;
    double across = ray->direction[0] * ray->sun[0] + ray->direction[2] * ray->sun[2] - c * s;
    double norm = sqrt(fmax(0, 1 - c * c) * fmax(0, 1 - s * s));
    double azimuth = norm > 1e-12 ? across / norm : 1;
    return (AirPoint){r - AIR_EARTH_M, c, s, fmax(-1, fmin(1, azimuth))};
}

/* The two tables around a sun angle, and how far between them. */
static const DiffuseLight *light_at(const Builder *b, double sun_cosine, float *t)
{
    double x = (acos_d(fmax(-1, fmin(1, sun_cosine))) - b->first_zenith) / SUN_STEP;
    x = fmax(0, fmin(x, SUN_ANGLES - 1.0001));
    *t = (float)(x - (int)x);
    return &b->light[(int)x];
}

/* ---- one ray ----------------------------------------------------------------------------- */

/* Distance to the floor, or else to space. */
static double ray_length(const AirRay *ray, double floor_m, bool *meets_floor)
{
    double r = ray->radius, b = r * ray->direction[2];
    double floor = AIR_EARTH_M + floor_m, top = AIR_EARTH_M + AIR_TOP_M;
    double under = b * b - r * r + floor * floor;
    *meets_floor = b < 0 && under > 0;
    if (*meets_floor) return fmax(0, -b - sqrt(under));
    return -b + sqrt(fmax(0, b * b - r * r + top * top));
}

static Spectrum floor_radiance(const Builder *b, const AirPoint *at)
{
    float t;
    const DiffuseLight *light = light_at(b, at->sun_cosine, &t);
    Spectrum diffuse = light[0].ground_diffuse * spectrum_all(1 - t) +
                       light[1].ground_diffuse * spectrum_all(t);
    Spectrum direct = beam_at(b, at->altitude, at->sun_cosine) *
                      spectrum_all((float)fmax(0, at->sun_cosine));
    return (diffuse + direct) *
           spectrum_all((float)(b->atmosphere->input.air.ground_albedo / PI));
}

typedef struct Gathered {
    Spectrum molecules, aerosol, rest;
} Gathered;

static Gathered march(const Builder *b, const AirRay *ray)
{
    const Atmosphere *a = b->atmosphere;
    int      steps = a->input.steps;
    bool     meets_floor;
    double   length = ray_length(ray, a->input.floor_m, &meets_floor), from = 0;
    Spectrum passing = spectrum_all(1), none = spectrum_all(0);
    Gathered sum = {none, none, none};
    for (int i = 0; i < steps; i++) {
        double share = (i + 1.0) / steps, to = length * share * share;
        AirPoint  at = place_at(ray, 0.5 * (from + to));
        float  density[AIR_PARTS], t, step = (float)(to - from);
        density_at(b, at.altitude, density);
        Spectrum depth = none, seen;
        for (int p = 0; p < AIR_PARTS; p++)
            depth += a->optics.depth[p] * spectrum_all(density[p] * step);
        for (int k = 0; k < SPECTRUM_LANES; k++) /* mean transmittance inside the step */
            seen[k] =
                depth[k] > 0.01f ? (1 - exp_f(-depth[k])) / depth[k] : 1 - 0.5f * depth[k];
        seen *= passing * spectrum_all(step);
        Spectrum beam = beam_at(b, at.altitude, at.sun_cosine) * seen;
        sum.molecules += a->optics.scattering[AIR_MOLECULES] *
                         spectrum_all(density[AIR_MOLECULES]) * beam;
        sum.aerosol += a->optics.scattering[AIR_AEROSOL] * spectrum_all(density[AIR_AEROSOL]) *
                       beam;
        const DiffuseLight *light = light_at(b, at.sun_cosine, &t);
        /* the source sends towards the eye: against the ray */
        float c = (float)-at.cosine, z = (float)-at.azimuth_cosine;
        Spectrum source[2];
        diffuse_light_source(&light[0], at.altitude, c, z, &source[0]);
        diffuse_light_source(&light[1], at.altitude, c, z, &source[1]);
        sum.rest += seen * (source[0] * spectrum_all(1 - t) + source[1] * spectrum_all(t));
        passing *= spectrum_exp(-depth);
        from = to;
    }
    if (meets_floor) {
        AirPoint end = place_at(ray, length);
        sum.rest += passing * floor_radiance(b, &end);
    }
    return sum;
}

/* ---- the table --------------------------------------------------------------------------- */

static double row_elevation(const Atmosphere *a, bool below, int row)
{
    double share = row / (ATMOSPHERE_ROWS - 1.0), reach = below ? -PI / 2 - a->horizon
                                                                : PI / 2 - a->horizon;
    double nudge = row == 0 ? (below ? -1e-6 : 1e-6) : 0; /* on one side of the edge */
    return a->horizon + reach * share * share + nudge;
}

static void fill_row(void *context, int item, int worker)
{
    Builder    *b = context;
    Atmosphere *a = b->atmosphere;
    double      elevation = row_elevation(a, item >= ATMOSPHERE_ROWS, item % ATMOSPHERE_ROWS);
    double      sun = a->input.sun_elevation;
    (void)worker;
    for (int j = 0; j < ATMOSPHERE_COLUMNS; j++) {
        double azimuth = PI * j / (ATMOSPHERE_COLUMNS - 1);
        AirRay ray = {AIR_EARTH_M + a->input.observer_m,
                      {cos_d(elevation), 0, sin_d(elevation)},
                      {cos_d(sun) * cos_d(azimuth), cos_d(sun) * sin_d(azimuth), sin_d(sun)}};
        Gathered g = march(b, &ray);
        size_t   at = (size_t)item * ATMOSPHERE_COLUMNS + (size_t)j;
        a->molecules[at] = g.molecules;
        a->aerosol[at] = g.aerosol;
        a->rest[at] = g.rest;
    }
}

static Spectrum *spectra(Arena *arena, size_t count)
{
    return arena_alloc(arena, sizeof(Spectrum), 64, count);
}

/* One arena a light, so that threads can fill them side by side. */
static void build_lights(Builder *b, Arena *scratch)
{
    b->arena = ARENA_NEW(scratch, Arena, SUN_ANGLES);
    for (int i = 0; i < SUN_ANGLES; i++) b->arena[i] = arena_reserve(LIGHT_BYTES);
    b->first_zenith = PI / 2 - b->atmosphere->input.sun_elevation - SUN_STEP * (SUN_ANGLES / 2);
    b->first_zenith = fmax(0, fmin(PI - SUN_STEP * (SUN_ANGLES - 1), b->first_zenith));
    parallel_for(b->atmosphere->input.threads, SUN_ANGLES, fill_light, b);
}

bool atmosphere_build(const AtmosphereInput *input, Arena *arena, Atmosphere *out, Error *err)
{
    if (!(input->observer_m >= input->floor_m && input->observer_m <= 60000))
        return error_set(err, ERROR_INPUT, "the observer stands at %g m, wanted between the "
                         "ground (or cloud deck) at %g m and 60000 m", input->observer_m,
                         input->floor_m);
    size_t count = (size_t)2 * ATMOSPHERE_ROWS * ATMOSPHERE_COLUMNS;
    *out = (Atmosphere){.input = *input, .optics = air_optics(&input->air)};
    if (!out->input.steps) out->input.steps = 48;
    out->molecules = spectra(arena, count);
    out->aerosol = spectra(arena, count);
    out->rest = spectra(arena, count);
    out->horizon = -acos_d((AIR_EARTH_M + input->floor_m) / (AIR_EARTH_M + input->observer_m));
    Arena    scratch = *arena;
    Builder *b = ARENA_NEW(&scratch, Builder, 1);
    b->atmosphere = out;
    b->column = ARENA_NEW(&scratch, float, COLUMN_HEIGHTS * COLUMN_COSINES * AIR_PARTS);
    b->density = ARENA_NEW(&scratch, float, DENSITY_NODES * AIR_PARTS);
    fill_density(b);
    parallel_for(input->threads, COLUMN_HEIGHTS, fill_columns, b);
    build_lights(b, &scratch);
    parallel_for(input->threads, 2 * ATMOSPHERE_ROWS, fill_row, b);
    out->sun_passing = passing_at(b, input->observer_m, sin_d(input->sun_elevation));
    AirPoint under = {input->floor_m, 1, sin_d(input->sun_elevation), 1};
    out->floor_exitance = floor_radiance(b, &under) * spectrum_all(PI_F);
    for (int i = 0; i < SUN_ANGLES; i++) arena_release(&b->arena[i]);
    return true;
}

Spectrum atmosphere_radiance(const Atmosphere *a, float elevation, float azimuth)
{
    bool  below = (double)elevation < a->horizon;
    float horizon = (float)a->horizon, reach = below ? -PI_F / 2 - horizon : PI_F / 2 - horizon;
    float y = safe_sqrtf((elevation - horizon) / reach) * (ATMOSPHERE_ROWS - 1);
    float turns = azimuth * (0.5f * INV_PI_F), around = turns - floorf(turns); /* [0, 1) */
    float x = (around > 0.5f ? 1 - around : around) * 2 * (ATMOSPHERE_COLUMNS - 1);
    y = clampf(y, 0, ATMOSPHERE_ROWS - 1.001f), x = clampf(x, 0, ATMOSPHERE_COLUMNS - 1.001f);
    int   i = (int)y, j = (int)x;
    float t = y - (float)i, u = x - (float)j;
    size_t at = ((size_t)(i + (below ? ATMOSPHERE_ROWS : 0))) * ATMOSPHERE_COLUMNS + (size_t)j;
    const float weight[4] = {(1 - t) * (1 - u), (1 - t) * u, t * (1 - u), t * u};
    const size_t from[4] = {at, at + 1, at + ATMOSPHERE_COLUMNS, at + ATMOSPHERE_COLUMNS + 1};
    Spectrum molecules = spectrum_all(0), aerosol = spectrum_all(0), sum = spectrum_all(0);
    for (int k = 0; k < 4; k++) {
        Spectrum w = spectrum_all(weight[k]);
        molecules += w * a->molecules[from[k]];
        aerosol += w * a->aerosol[from[k]];
        sum += w * a->rest[from[k]];
    }
    float s[3], c[3];
    sincos_turns(elevation * (0.5f * INV_PI_F), &s[0], &c[0]);
    sincos_turns((float)a->input.sun_elevation * (0.5f * INV_PI_F), &s[1], &c[1]);
    sincos_turns(azimuth * (0.5f * INV_PI_F), &s[2], &c[2]);
    float cosine = s[0] * s[1] + c[0] * c[1] * c[2];
    return sum + molecules * spectrum_all(air_phase_molecules(cosine)) +
           aerosol * spectrum_all(air_phase_aerosol(cosine));
}

Spectrum atmosphere_diffuse(const Atmosphere *a)
{
    const int rows = 200, columns = 96;
    Spectrum  sum = spectrum_all(0);
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
