#include "light/sky.h"

#include "base/units.h"
#include "spectrum/photometry.h"

#define SUN_KELVIN 5500.0

/* ---- pictures --------------------------------------------------------------------------- */

static const float *pixel(const Sky *sky, int x, int y)
{
    int column = (x + sky->width) % sky->width; /* the picture closes around the horizon */
    int row = y < 0 ? 0 : y >= sky->height ? sky->height - 1 : y;
    return sky->pixels + 4 * ((size_t)row * (size_t)sky->width + (size_t)column);
}

/* Bilinear between pixel centres; x, y in pixels from the upper left corner. */
static void picture_rgb(const Sky *sky, float x, float y, float rgb[3])
{
    float left = floorf(x - 0.5f), top = floorf(y - 0.5f);
    float s = x - 0.5f - left, t = y - 0.5f - top;
    const float *a = pixel(sky, (int)left, (int)top), *b = pixel(sky, (int)left + 1, (int)top);
    const float *c = pixel(sky, (int)left, (int)top + 1);
    const float *d = pixel(sky, (int)left + 1, (int)top + 1);
    for (int i = 0; i < 3; i++)
        rgb[i] = sky->scale * lerpf(lerpf(a[i], b[i], s), lerpf(c[i], d[i], s), t);
}

static Vec2 picture_from_direction(const Sky *sky, Vec3 d)
{
    float turns = atan2_f(d.x, -d.z) * (0.5f * INV_PI_F) + sky->u_offset;
    return (Vec2){(turns - floorf(turns)) * (float)sky->width,
                  acos_f(d.y) * INV_PI_F * (float)sky->height};
}

/* The share of a cell in the bilinear picture: each axis takes 1/8, 6/8, 1/8 of its row. */
static double cell_luminance(const Sky *sky, int x, int y)
{
    static const double share[3] = {0.125, 0.75, 0.125};
    double sum = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            sum += share[i + 1] * share[j + 1] * (double)luminance_from_rgb(pixel(sky, x + i, y + j));
    return sum;
}

/* Solid angle of one pixel of row y, sr. */
static double pixel_solid_angle(const Sky *sky, int y)
{
    return 2 * PI / sky->width *
           (cos(PI * y / sky->height) - cos(PI * (y + 1) / sky->height));
}

static void build_distribution(Sky *sky, Arena *arena)
{
    int    width = sky->width, height = sky->height;
    double total = 0, *row_sum = ARENA_NEW(arena, double, height);
    sky->row_cdf = ARENA_NEW(arena, float, height + 1);
    sky->column_cdf = ARENA_NEW(arena, float, (size_t)height * (size_t)(width + 1));
    for (int y = 0; y < height; y++) {
        float *cdf = sky->column_cdf + (size_t)y * (size_t)(width + 1);
        double sum = 0;
        for (int x = 0; x < width; x++) sum += cell_luminance(sky, x, y);
        double running = 0;
        for (int x = 0; x < width; x++) {
            running += sum > 0 ? cell_luminance(sky, x, y) / sum : 1.0 / width;
            cdf[x + 1] = (float)running;
        }
        cdf[width] = 1;
        row_sum[y] = sum * pixel_solid_angle(sky, y);
        total += row_sum[y];
    }
    double running = 0;
    for (int y = 0; y < height; y++) {
        running += total > 0 ? row_sum[y] / total : 1.0 / height;
        sky->row_cdf[y + 1] = (float)running;
    }
    sky->row_cdf[height] = 1;
}

/* lx on a horizontal plane from the upper half of the picture, at scale 1. */
static double horizontal_illuminance(const Sky *sky)
{
    double sum = 0;
    for (int y = 0; y < sky->height; y++) {
        double low = sin(PI * y / sky->height), high = sin(PI * (y + 1) / sky->height);
        double middle = cos(PI * (y + 0.5) / sky->height);
        if (middle <= 0) continue;
        double end = cos(PI * (y + 1) / sky->height) < 0 ? 1.0 : high;
        double weight = PI / sky->width * (end * end - low * low); /* cosine-weighted sr */
        for (int x = 0; x < sky->width; x++) sum += weight * cell_luminance(sky, x, y);
    }
    return sum;
}

/* Negative and non-finite values are set to 0 in a copy, and counted. */
static void copy_pixels(Sky *sky, const Image *image, Arena *arena)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    const float *from = image->pixels;
    float *to = ARENA_NEW(arena, float, 4 * count);
    for (size_t p = 0; p < count; p++) {
        bool refused = false;
        for (int i = 0; i < 3; i++) {
            float value = from[4 * p + i];
            bool  good = value >= 0 && isfinite(value);
            to[4 * p + i] = good ? value : 0;
            refused |= !good;
        }
        sky->refused_pixels += refused;
    }
    sky->pixels = to;
}

static bool build_picture(const Environment *environment, float turn, Arena *arena, Sky *sky,
                          Error *err)
{
    sky->width = environment->hdri.width;
    sky->height = environment->hdri.height;
    copy_pixels(sky, &environment->hdri, arena);
    build_distribution(sky, arena);
    sky->scale = environment->hdri_scale;
    if (environment->horizontal_illuminance_lx > 0) {
        double lux = horizontal_illuminance(sky);
        if (!(lux > 0))
            return error_at(err, ERROR_INPUT, environment->hdri_path, "",
                            "the picture's upper half is black: it cannot be scaled to %g lx",
                            (double)environment->horizontal_illuminance_lx);
        sky->scale = (float)((double)environment->horizontal_illuminance_lx / lux);
    }
    sky->u_offset = (turn - environment->hdri_rotation) * (0.5f * INV_PI_F);
    return true;
}

/* ---- the sun ---------------------------------------------------------------------------- */

static Vec3 direction_of(float scene_azimuth, float elevation)
{
    double c = cos((double)elevation);
    return vec3((float)(c * sin((double)scene_azimuth)), (float)sin((double)elevation),
                (float)(-c * cos((double)scene_azimuth)));
}

/* A black body scaled to a luminance of 1 cd m^-2. */
static void black_body_curve(double kelvin, Curve *out)
{
    for (int i = 0; i < CURVE_COUNT; i++)
        out->value[i] = (float)black_body_radiance(CURVE_FIRST_NM + i, kelvin);
    float scale = (float)(1 / luminance_cd_m2(out->value, CURVE_COUNT, CURVE_FIRST_NM, 1));
    for (int i = 0; i < CURVE_COUNT; i++) out->value[i] *= scale;
}

static void build_sun(const Environment *environment, float turn, Sky *sky)
{
    double radius = (double)environment->sun_angular_radius;
    double half = sin(radius / 2), disc = sin(radius);
    sky->has_sun = true;
    sky->sun_direction = vec3_normalize(
        direction_of(environment->sun_azimuth - turn, environment->sun_elevation));
    sky->sun_radius = (float)radius;
    sky->sun_chord2 = (float)(4 * half * half);
    sky->sun_solid_angle = (float)(4 * PI * half * half);
    sky->sun_luminance =
        (float)((double)environment->sun_illuminance_lx / (PI * disc * disc));
    black_body_curve(SUN_KELVIN, &sky->sun_curve);
}

static bool in_sun(const Sky *sky, Vec3 direction)
{
    Vec3 apart = vec3_sub(direction, sky->sun_direction);
    return sky->has_sun && vec3_dot(apart, apart) < sky->sun_chord2;
}

Spectrum sun_radiance(const Sky *sky, Vec3 direction, const Wavelengths *wavelengths)
{
    if (!in_sun(sky, direction)) return spectrum_all(0);
    return curve_lookup(&sky->sun_curve, wavelengths) * spectrum_all(sky->sun_luminance);
}

float sun_pdf(const Sky *sky, Vec3 direction)
{
    return in_sun(sky, direction) ? 1 / sky->sun_solid_angle : 0;
}

/* Uniform on the cone: 1 - cos = u (1 - cos r), kept as a small number for precision. A share
 * of 2e-5 of the radius is left out at the rim, so that rounding never leaves the disc. */
Vec3 sun_sample(const Sky *sky, float u0, float u1)
{
    float sine, cosine, away = 0.5f * sky->sun_chord2 * u0 * 0.99996f;
    float across = safe_sqrtf(away * (2 - away));
    Frame frame = frame_from_z(sky->sun_direction);
    sincos_turns(u1, &sine, &cosine);
    return frame_to_world(&frame, vec3(across * cosine, across * sine, 1 - away));
}

/* ---- the sky ---------------------------------------------------------------------------- */

static const char *kind_name(EnvironmentKind kind)
{
    switch (kind) {
    case ENVIRONMENT_CIE: return "cie";
    case ENVIRONMENT_PEREZ: return "perez";
    case ENVIRONMENT_SKY: return "sky";
    default: return "";
    }
}

bool sky_build(const Environment *environment, Arena *arena, Sky *out, Error *err)
{
    /* Compass azimuth of scene azimuth 0 (-Z): the heading, less the forward vector's own. */
    float turn = environment->heading -
                 atan2_f(environment->forward.x, -environment->forward.z);
    Sky sky = {.kind = environment->kind, .scale = 1};
    if (kind_name(sky.kind)[0])
        return error_set(err, ERROR_INPUT, "environment type \"%s\" is not available in this "
                         "version: use \"constant\" or \"hdri\"", kind_name(sky.kind));
    for (int i = 0; i < 3; i++)
        sky.constant_rgb[i] = environment->luminance_cd_m2 * environment->color[i];
    if (sky.kind == ENVIRONMENT_CONSTANT && !(luminance_from_rgb(sky.constant_rgb) > 0))
        sky.kind = ENVIRONMENT_NONE;
    if (sky.kind == ENVIRONMENT_HDRI && !build_picture(environment, turn, arena, &sky, err))
        return false;
    if (environment->has_sun && environment->sun_illuminance_lx > 0)
        build_sun(environment, turn, &sky);
    *out = sky;
    return true;
}

Spectrum sky_radiance(const Sky *sky, Vec3 direction, const Wavelengths *wavelengths)
{
    if (sky->kind == ENVIRONMENT_NONE) return spectrum_all(0);
    if (sky->kind == ENVIRONMENT_CONSTANT)
        return spectrum_from_rgb_emission(wavelengths, sky->constant_rgb);
    float rgb[3];
    Vec2  at = picture_from_direction(sky, direction);
    picture_rgb(sky, at.x, at.y, rgb);
    return spectrum_from_rgb_emission(wavelengths, rgb);
}

/* The largest i with cdf[i] <= u, 0 <= i < count. */
static int find_interval(const float *cdf, int count, float u)
{
    int low = 0, high = count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (cdf[middle] <= u) low = middle;
        else high = middle;
    }
    return low;
}

/* Position inside interval i, in [0, 1). */
static float inside_interval(const float *cdf, int i, float u)
{
    float width = cdf[i + 1] - cdf[i];
    return width > 0 ? clampf((u - cdf[i]) / width, 0, 0x1.fffffep-1f) : 0.5f;
}

static float picture_pdf(const Sky *sky, int x, int y, float sin_theta)
{
    const float *columns = sky->column_cdf + (size_t)y * (size_t)(sky->width + 1);
    float cell = (sky->row_cdf[y + 1] - sky->row_cdf[y]) * (columns[x + 1] - columns[x]);
    float cells = (float)sky->width * (float)sky->height;
    return sin_theta > 0 ? cell * cells / (2 * PI_F * PI_F * sin_theta) : 0;
}

float sky_pdf(const Sky *sky, Vec3 direction, Vec3 ns)
{
    if (sky->kind == ENVIRONMENT_NONE) return 0;
    if (sky->kind == ENVIRONMENT_CONSTANT) return fmaxf(vec3_dot(direction, ns), 0) * INV_PI_F;
    Vec2 at = picture_from_direction(sky, direction);
    int  x = (int)at.x, y = (int)at.y;
    if (x >= sky->width) x = sky->width - 1;
    if (y >= sky->height) y = sky->height - 1;
    return picture_pdf(sky, x, y, safe_sqrtf(1 - direction.y * direction.y));
}

static Vec3 sample_cosine(Vec3 ns, float u0, float u1)
{
    float sine, cosine, radius = safe_sqrtf(u0);
    Frame frame = frame_from_z(ns);
    sincos_turns(u1, &sine, &cosine);
    return frame_to_world(&frame, vec3(radius * cosine, radius * sine, safe_sqrtf(1 - u0)));
}

bool sky_sample(const Sky *sky, Vec3 ns, float u0, float u1, Vec3 *direction)
{
    if (sky->kind == ENVIRONMENT_NONE) return false;
    if (sky->kind == ENVIRONMENT_CONSTANT) {
        *direction = sample_cosine(ns, u0, u1);
        return true;
    }
    int    y = find_interval(sky->row_cdf, sky->height, u1);
    float *columns = sky->column_cdf + (size_t)y * (size_t)(sky->width + 1);
    int    x = find_interval(columns, sky->width, u0);
    float  u = ((float)x + inside_interval(columns, x, u0)) / (float)sky->width;
    float  v = ((float)y + inside_interval(sky->row_cdf, y, u1)) / (float)sky->height;
    float  sin_theta, cos_theta, sine, cosine;
    sincos_turns(0.5f * v, &sin_theta, &cos_theta);
    sincos_turns(u - sky->u_offset - floorf(u - sky->u_offset), &sine, &cosine);
    *direction = vec3(sin_theta * sine, cos_theta, -sin_theta * cosine);
    return sin_theta > 0;
}
