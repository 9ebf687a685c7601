/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/outlook_picture.h"

#include <math.h>

#include "image/false_colour.h"
#include "text/text.h"

#define SCALE 3 /* pixels of the picture to one that was seen */
#define SUN 5

static float *enlarged(const float *values, Arena *arena)
{
    const int side = SCALE * OUTLOOK_SIZE;
    float    *out = ARENA_NEW(arena, float, side * side);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            out[y * side + x] = values[(y / SCALE) * OUTLOOK_SIZE + x / SCALE];
    return out;
}

/* code: grey, 0..1. */
static void dot(Picture *picture, double x, double y, float code)
{
    if (!(x >= 0 && y >= 0 && x < picture->width && y < picture->height)) return;
    float *rgb = picture_pixel(picture, (int)x, (int)y);
    rgb[0] = rgb[1] = rgb[2] = code;
}

/* White within black, to be seen on any ground. */
static void ring(Picture *picture, double x, double y, double radius)
{
    for (double r = radius - 2; r <= radius + 2; r += 0.5)
        for (int i = 0; i < 720; i++) {
            double a = i * 3.14159265358979 / 360;
            dot(picture, x + r * cos(a), y + r * sin(a), fabs(r - radius) <= 1 ? 1.0f : 0.0f);
        }
}

static void sun(Picture *picture, double x, double y)
{
    for (int i = 0; i < 8; i++) {
        double a = i * 3.14159265358979 / 4;
        for (double r = 0; r <= 2.4 * SUN; r += 0.5)
            if (r < SUN || r > 1.5 * SUN)
                for (int k = -1; k <= 1; k++)
                    dot(picture, x + r * cos(a) - 0.7 * k * sin(a),
                        y + r * sin(a) + 0.7 * k * cos(a), 1);
    }
    for (double r = 0; r <= SUN; r += 0.5)
        for (int i = 0; i < 180; i++)
            dot(picture, x + r * cos(i * 0.0349), y + r * sin(i * 0.0349),
                r > SUN - 1 ? 0.0f : 1.0f);
}

Picture outlook_picture(const Outlook *outlook, Arena *arena)
{
    const int  side = SCALE * OUTLOOK_SIZE;
    ScaleRange range =
        scale_range_of(outlook->cd_m2, (size_t)OUTLOOK_SIZE * OUTLOOK_SIZE, true, *arena);
    Picture out = false_colour_picture(enlarged(outlook->cd_m2, arena), side, side, range,
                                       "cd/m^2", arena);
    ring(&out, SCALE * outlook->mirror_x, SCALE * outlook->mirror_y,
         side * OUTLOOK_MIRROR_DEG / 180.0);
    if (outlook->has_sun) sun(&out, SCALE * outlook->sun_x, SCALE * outlook->sun_y);
    return out;
}

const char *outlook_words(const Outlook *outlook, Arena *arena)
{
    Text text = {.arena = arena};
    text_format(&text, outlook->lux < 100 ? "%.3g lx: " : "%.0f lx: ", outlook->lux);
    for (int i = 0; i < outlook->share_count; i++)
        if (outlook->shares[i].share >= 0.005)
            text_format(&text, "%s%.0f %% %s", i ? ", " : "", 100 * outlook->shares[i].share,
                        outlook->shares[i].what);
    if (outlook->rest >= 0.005) text_format(&text, ", %.0f %% other", 100 * outlook->rest);
    if (outlook->mirror_what)
        text_format(&text, ". Where the eye sees it mirrored (ring): %s, %.3g cd/m2",
                    outlook->mirror_what, outlook->mirror_cd_m2);
    return text.data;
}
