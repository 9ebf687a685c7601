/* SPDX-License-Identifier: Apache-2.0 */
#include "light/sky_picture.h"

#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/photometry.h"

static const float *pixel(const SkyPicture *picture, int x, int y) {
    int column = (x + picture->width) % picture->width; /* the picture closes around the horizon */
    int row = y < 0 ? 0 : y >= picture->height ? picture->height - 1 : y;
    return picture->pixels + 4 * ((size_t)row * (size_t)picture->width + (size_t)column);
}

void sky_picture_rgb(const SkyPicture *picture, Vec2 at, float rgb[3]) {
    float left = floorf(at.x - 0.5f), top = floorf(at.y - 0.5f);
    float s = at.x - 0.5f - left, t = at.y - 0.5f - top;
    const float *a = pixel(picture, (int)left, (int)top),
                *b = pixel(picture, (int)left + 1, (int)top);
    const float *c = pixel(picture, (int)left, (int)top + 1);
    const float *d = pixel(picture, (int)left + 1, (int)top + 1);
    for (int i = 0; i < 3; i++)
        rgb[i] = picture->scale * lerpf(lerpf(a[i], b[i], s), lerpf(c[i], d[i], s), t);
}

static Vec2 picture_from_direction(const SkyPicture *picture, Vec3 d) {
    float turns = atan2_f(d.x, -d.z) * (0.5f * INV_PI_F) + picture->u_offset;
    return (Vec2){(turns - floorf(turns)) * (float)picture->width,
                  acos_f(d.y) * INV_PI_F * (float)picture->height};
}

/* The share of a cell in the bilinear picture: each axis takes 1/8, 6/8, 1/8 of its row. */
static double cell_luminance(const SkyPicture *picture, int x, int y) {
    static const double share[3] = {0.125, 0.75, 0.125};
    double sum = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            sum += share[i + 1] * share[j + 1] *
                   (double)luminance_from_rgb(pixel(picture, x + i, y + j));
    return sum;
}

/* Solid angle of one pixel of row y, sr. */
static double pixel_solid_angle(const SkyPicture *picture, int y) {
    return 2 * PI / picture->width *
           (cos_d(PI * y / picture->height) - cos_d(PI * (y + 1) / picture->height));
}

/* guide[k]: the last i with cdf[i] <= k / count (Chen and Asau 1974): one step or two from
 * there find any u of that cell. */
static void build_guide(const float *cdf, int count, uint16_t *guide) {
    int i = 0;
    for (int k = 0; k < count; k++) {
        while (i + 1 < count && cdf[i + 1] <= (float)k / (float)count) i++;
        guide[k] = (uint16_t)i;
    }
}

static void build_distribution(SkyPicture *picture, Arena *arena) {
    int width = picture->width, height = picture->height;
    double total = 0, *row_sum = ARENA_NEW(arena, double, height);
    float *row_cdf = ARENA_NEW(arena, float, height + 1);
    float *column_cdf = ARENA_NEW(arena, float, (size_t)height *(size_t)(width + 1));
    uint16_t *row_guide = ARENA_NEW(arena, uint16_t, height);
    uint16_t *column_guide = ARENA_NEW(arena, uint16_t, (size_t)height *(size_t)width);
    for (int y = 0; y < height; y++) {
        float *cdf = column_cdf + (size_t)y * (size_t)(width + 1);
        double sum = 0;
        for (int x = 0; x < width; x++) sum += cell_luminance(picture, x, y);
        double running = 0;
        for (int x = 0; x < width; x++) {
            running += sum > 0 ? cell_luminance(picture, x, y) / sum : 1.0 / width;
            cdf[x + 1] = (float)running;
        }
        cdf[width] = 1;
        build_guide(cdf, width, column_guide + (size_t)y * (size_t)width);
        row_sum[y] = sum * pixel_solid_angle(picture, y);
        total += row_sum[y];
    }
    double running = 0;
    for (int y = 0; y < height; y++) {
        running += total > 0 ? row_sum[y] / total : 1.0 / height;
        row_cdf[y + 1] = (float)running;
    }
    row_cdf[height] = 1;
    build_guide(row_cdf, height, row_guide);
    picture->row_cdf = row_cdf;
    picture->column_cdf = column_cdf;
    picture->row_guide = row_guide;
    picture->column_guide = column_guide;
}

/* lx on a horizontal plane from the upper half of the picture, at scale 1. */
static double horizontal_illuminance(const SkyPicture *picture) {
    double sum = 0;
    for (int y = 0; y < picture->height; y++) {
        double low = sin_d(PI * y / picture->height), high = sin_d(PI * (y + 1) / picture->height);
        double middle = cos_d(PI * (y + 0.5) / picture->height);
        if (middle <= 0) continue;
        double end = cos_d(PI * (y + 1) / picture->height) < 0 ? 1.0 : high;
        double weight = PI / picture->width * (end * end - low * low); /* cosine-weighted sr */
        for (int x = 0; x < picture->width; x++) sum += weight * cell_luminance(picture, x, y);
    }
    return sum;
}

bool sky_picture_build(const Environment *environment, float turn, Arena *arena, SkyPicture *out,
                       Error *err) {
    SkyPicture picture = {.width = environment->hdri.width,
                          .height = environment->hdri.height,
                          .pixels = environment->hdri.pixels};
    build_distribution(&picture, arena);
    picture.scale = environment->hdri_scale;
    if (environment->horizontal_illuminance_lx > 0) {
        double lux = horizontal_illuminance(&picture);
        if (!(lux > 0))
            return error_at(err, ERROR_INPUT, environment->hdri_path, "",
                            "the picture's upper half is black: it cannot be scaled to %g lx",
                            (double)environment->horizontal_illuminance_lx);
        picture.scale = (float)((double)environment->horizontal_illuminance_lx / lux);
    }
    picture.u_offset = (turn - environment->hdri_rotation) * (0.5f * INV_PI_F);
    *out = picture;
    return true;
}

/* The largest i with cdf[i] <= u, 0 <= i < count. */
static int find_interval(const float *cdf, const uint16_t *guide, int count, float u) {
    int i = guide[(int)(u * (float)count)];
    while (i + 1 < count && cdf[i + 1] <= u) i++;
    return i;
}

/* Position inside interval i, in [0, 1). */
static float inside_interval(const float *cdf, int i, float u) {
    float width = cdf[i + 1] - cdf[i];
    return width > 0 ? clampf((u - cdf[i]) / width, 0, 0x1.fffffep-1f) : 0.5f;
}

static float picture_pdf(const SkyPicture *picture, int x, int y, float sin_theta) {
    const float *columns = picture->column_cdf + (size_t)y * (size_t)(picture->width + 1);
    float cell = (picture->row_cdf[y + 1] - picture->row_cdf[y]) * (columns[x + 1] - columns[x]);
    float cells = (float)picture->width * (float)picture->height;
    return sin_theta > 0 ? cell * cells / (2 * PI_F * PI_F * sin_theta) : 0;
}

Vec2 sky_picture_place(const SkyPicture *picture, Vec3 direction, float *pdf) {
    Vec2 at = picture_from_direction(picture, direction);
    int x = (int)at.x, y = (int)at.y;
    if (x >= picture->width) x = picture->width - 1;
    if (y >= picture->height) y = picture->height - 1;
    *pdf = picture_pdf(picture, x, y, safe_sqrtf(1 - direction.y * direction.y));
    return at;
}

void sky_picture_sample(const SkyPicture *picture, float u0, float u1, Vec3 *direction, Vec2 *at,
                        float *pdf) {
    int y = find_interval(picture->row_cdf, picture->row_guide, picture->height, u1);
    size_t row = (size_t)y * (size_t)picture->width;
    const float *columns = picture->column_cdf + row + (size_t)y;
    int x = find_interval(columns, picture->column_guide + row, picture->width, u0);
    at->x = (float)x + inside_interval(columns, x, u0);
    at->y = (float)y + inside_interval(picture->row_cdf, y, u1);
    float turns = at->x / (float)picture->width - picture->u_offset;
    float sin_theta, cos_theta, sine, cosine;
    sincos_turns(0.5f * at->y / (float)picture->height, &sin_theta, &cos_theta);
    sincos_turns(turns - floorf(turns), &sine, &cosine);
    *direction = vec3(sin_theta * sine, cos_theta, -sin_theta * cosine);
    *pdf = picture_pdf(picture, x, y, sin_theta);
}
