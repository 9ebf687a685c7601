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
            sum += share[i + 1] * share[j + 1] *
                   (double)luminance_from_rgb(pixel(sky, x + i, y + j));
    return sum;
}

/* Solid angle of one pixel of row y, sr. */
static double pixel_solid_angle(const Sky *sky, int y)
{
    return 2 * PI / sky->width *
           (cos(PI * y / sky->height) - cos(PI * (y + 1) / sky->height));
}

/* guide[k]: the last i with cdf[i] <= k / count (Chen and Asau 1974): one step or two from
 * there find any u of that cell. */
static void build_guide(const float *cdf, int count, uint16_t *guide)
{
    int i = 0;
    for (int k = 0; k < count; k++) {
        while (i + 1 < count && cdf[i + 1] <= (float)k / (float)count) i++;
        guide[k] = (uint16_t)i;
    }
}

static void build_distribution(Sky *sky, Arena *arena)
{
    int    width = sky->width, height = sky->height;
    double total = 0, *row_sum = ARENA_NEW(arena, double, height);
    float *row_cdf = ARENA_NEW(arena, float, height + 1);
    float *column_cdf = ARENA_NEW(arena, float, (size_t)height * (size_t)(width + 1));
    uint16_t *row_guide = ARENA_NEW(arena, uint16_t, height);
    uint16_t *column_guide = ARENA_NEW(arena, uint16_t, (size_t)height * (size_t)width);
    for (int y = 0; y < height; y++) {
        float *cdf = column_cdf + (size_t)y * (size_t)(width + 1);
        double sum = 0;
        for (int x = 0; x < width; x++) sum += cell_luminance(sky, x, y);
        double running = 0;
        for (int x = 0; x < width; x++) {
            running += sum > 0 ? cell_luminance(sky, x, y) / sum : 1.0 / width;
            cdf[x + 1] = (float)running;
        }
        cdf[width] = 1;
        build_guide(cdf, width, column_guide + (size_t)y * (size_t)width);
        row_sum[y] = sum * pixel_solid_angle(sky, y);
        total += row_sum[y];
    }
    double running = 0;
    for (int y = 0; y < height; y++) {
        running += total > 0 ? row_sum[y] / total : 1.0 / height;
        row_cdf[y + 1] = (float)running;
    }
    row_cdf[height] = 1;
    build_guide(row_cdf, height, row_guide);
    sky->row_cdf = row_cdf;
    sky->column_cdf = column_cdf;
    sky->row_guide = row_guide;
    sky->column_guide = column_guide;
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

/* The largest i with cdf[i] <= u, 0 <= i < count. */
static int find_interval(const float *cdf, const uint16_t *guide, int count, float u)
{
    int i = guide[(int)(u * (float)count)];
    while (i + 1 < count && cdf[i + 1] <= u) i++;
    return i;
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

static SkySample picture_seen(const Sky *sky, Vec3 direction)
{
    SkySample seen = {.direction = direction};
    Vec2 at = picture_from_direction(sky, direction);
    int  x = (int)at.x, y = (int)at.y;
    if (x >= sky->width) x = sky->width - 1;
    if (y >= sky->height) y = sky->height - 1;
    seen.pdf = picture_pdf(sky, x, y, safe_sqrtf(1 - direction.y * direction.y));
    picture_rgb(sky, at.x, at.y, seen.rgb);
    return seen;
}

SkySample sky_seen(const Sky *sky, Vec3 direction, Vec3 ns)
{
    SkySample seen = {.direction = direction};
    if (sky->kind == ENVIRONMENT_NONE) return seen;
    if (sky->kind == ENVIRONMENT_HDRI) return picture_seen(sky, direction);
    seen.pdf = fmaxf(vec3_dot(direction, ns), 0) * INV_PI_F;
    for (int i = 0; i < 3; i++) seen.rgb[i] = sky->constant_rgb[i];
    return seen;
}

static Vec3 sample_cosine(Vec3 ns, float u0, float u1)
{
    float sine, cosine, radius = safe_sqrtf(u0);
    Frame frame = frame_from_z(ns);
    sincos_turns(u1, &sine, &cosine);
    return frame_to_world(&frame, vec3(radius * cosine, radius * sine, safe_sqrtf(1 - u0)));
}

static void sample_picture(const Sky *sky, float u0, float u1, SkySample *sample)
{
    int    y = find_interval(sky->row_cdf, sky->row_guide, sky->height, u1);
    size_t row = (size_t)y * (size_t)sky->width;
    const float *columns = sky->column_cdf + row + (size_t)y;
    int    x = find_interval(columns, sky->column_guide + row, sky->width, u0);
    float  at_x = (float)x + inside_interval(columns, x, u0);
    float  at_y = (float)y + inside_interval(sky->row_cdf, y, u1);
    float  turns = at_x / (float)sky->width - sky->u_offset;
    float  sin_theta, cos_theta, sine, cosine;
    sincos_turns(0.5f * at_y / (float)sky->height, &sin_theta, &cos_theta);
    sincos_turns(turns - floorf(turns), &sine, &cosine);
    sample->direction = vec3(sin_theta * sine, cos_theta, -sin_theta * cosine);
    sample->pdf = picture_pdf(sky, x, y, sin_theta);
    picture_rgb(sky, at_x, at_y, sample->rgb);
}

bool sky_sample(const Sky *sky, Vec3 ns, float u0, float u1, SkySample *sample)
{
    if (sky->kind == ENVIRONMENT_NONE) return false;
    if (sky->kind == ENVIRONMENT_HDRI) {
        sample_picture(sky, u0, u1, sample);
        return sample->pdf > 0;
    }
    *sample = sky_seen(sky, sample_cosine(ns, u0, u1), ns);
    return sample->pdf > 0;
}
