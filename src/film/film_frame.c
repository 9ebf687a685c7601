/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_frame.h"

#include <math.h>
#include <string.h>

#include "base/mathf.h"
#include "base/units.h"
#include "film/pixels.h"
#include "spectrum/photometry.h"

#define CHANNELS_MAX 64 /* besides those of lights */

/* One pass over the pixels fills the channels of one layer. */
typedef struct ChannelFill {
    const Film *film;
    FrameImage *frame;
    Arena      *arena;
} ChannelFill;

/* Channels of one layer: up to three planes of floats. */
typedef struct LayerPlanes {
    float *of[3];
} LayerPlanes;

static LayerPlanes add_planes(const ChannelFill *to, const char *layer, const char *letters)
{
    LayerPlanes planes = {{NULL}};
    for (int i = 0; letters[i] && i < 3; i++) {
        const char *name = *layer ? arena_format(to->arena, "%s.%c", layer, letters[i])
                                  : arena_format(to->arena, "%c", letters[i]);
        planes.of[i] = frame_add_channel(to->frame, name, false, to->arena);
    }
    return planes;
}

/* What a pixel shows: three numbers at most. */
typedef void PixelReader(const Film *film, const PixelSums *sums, float values[3]);

static void fill(const ChannelFill *to, LayerPlanes planes, PixelReader *read)
{
    const Film *film = to->film;
    size_t      index = 0;
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++, index++) {
            float values[3];
            read(film, film_sums(film, x, y), values);
            for (int i = 0; i < 3; i++)
                if (planes.of[i]) planes.of[i][index] = values[i];
        }
}

/* Mean over `count` samples; NaN over none. */
static void mean_of(const Fixed *sums, int size, uint32_t count, float *out)
{
    for (int i = 0; i < size; i++)
        out[i] = count ? (float)(double_from_fixed(sums[i], FIXED_BITS) / (double)count) : NAN;
}

static void mean_layer(const Film *film, const PixelSums *sums, LayerSums layer, float *out)
{
    uint32_t count = layer >= SUMS_FIRST_DISPLAY ? sums->display_hits : sums->hits;
    mean_of(sums->layers + film->first[layer], layer_sums_size(layer), count, out);
}

/* A layer that is a mean of its sums; of displays the sums are XYZ and the layer RGB. */
static void fill_mean(const ChannelFill *to, LayerPlanes planes, LayerSums layer)
{
    const Film *film = to->film;
    size_t      index = 0;
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++, index++) {
            float mean[3], rgb[3];
            mean_layer(film, film_sums(film, x, y), layer, mean);
            if (layer >= SUMS_FIRST_DISPLAY) rgb_from_xyz(mean, rgb);
            const float *values = layer >= SUMS_FIRST_DISPLAY ? rgb : mean;
            for (int i = 0; i < 3; i++)
                if (planes.of[i]) planes.of[i][index] = values[i];
        }
}

/* ---- what is more than a mean ------------------------------------------------------------ */

static void read_xyz(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    mean_of(sums->xyz, 3, sums->samples, v);
    if (!sums->samples) v[0] = v[1] = v[2] = 0;
}

static void read_rgb(const Film *film, const PixelSums *sums, float v[3])
{
    float xyz[3];
    read_xyz(film, sums, xyz);
    rgb_from_xyz(xyz, v);
}

/* theta and phi of the mean direction, degrees; phi in [0, 360). */
static void read_angles(const Film *film, const PixelSums *sums, float v[3])
{
    float d[3];
    mean_layer(film, sums, SUMS_DIRECTION, d);
    float across = sqrtf(d[0] * d[0] + d[1] * d[1]);
    float phi = (float)degrees_from_radians((double)atan2_f(d[1], d[0]));
    v[0] = isnan(d[0]) ? NAN : (float)degrees_from_radians((double)atan2_f(across, d[2]));
    v[1] = isnan(d[0]) ? NAN : phi < 0 ? phi + 360 : phi;
}

static void read_contrast(const Film *film, const PixelSums *sums, float v[3])
{
    float white[3], black[3], reflected[3];
    mean_layer(film, sums, SUMS_WHITE, white);
    mean_layer(film, sums, SUMS_BLACK, black);
    mean_layer(film, sums, SUMS_REFLECTED, reflected);
    v[0] = (white[1] + reflected[1]) / (black[1] + reflected[1]);
}

static void take_sums(const Film *film, const PixelSums *sums, LayerSums layer, Fixed left[3])
{
    for (int i = 0; i < 3; i++) left[i] -= sums->layers[film->first[layer] + i];
}

/* What is not by way of the mirror. */
static void read_scattered(const Film *film, const PixelSums *sums, float v[3])
{
    Fixed left[3];
    float xyz[3];
    memcpy(left, sums->layers + film->first[SUMS_REFLECTED], sizeof left);
    take_sums(film, sums, SUMS_MIRROR, left);
    mean_of(left, 3, sums->display_hits, xyz);
    rgb_from_xyz(xyz, v);
}

/* And of that, what is not the panel's lambertian part. */
static void read_haze(const Film *film, const PixelSums *sums, float v[3])
{
    Fixed left[3];
    float xyz[3];
    memcpy(left, sums->layers + film->first[SUMS_REFLECTED], sizeof left);
    take_sums(film, sums, SUMS_MIRROR, left);
    take_sums(film, sums, SUMS_LAMBERTIAN, left);
    mean_of(left, 3, sums->display_hits, xyz);
    rgb_from_xyz(xyz, v);
}

static void read_coverage(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    v[0] = sums->samples ? (float)sums->display_hits / (float)sums->samples : 0;
}

static void read_variance(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    double variance[3];
    pixel_variance(sums, variance);
    for (int i = 0; i < 3; i++) v[i] = (float)variance[i];
}

static void read_halves(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    double halves[3];
    float  xyz[3];
    if (!pixel_halves(sums, BLOCK_LEAST, halves))
        halves[0] = halves[1] = halves[2] = (double)NAN;
    for (int i = 0; i < 3; i++) xyz[i] = (float)halves[i];
    rgb_from_xyz(xyz, v);
}

static void read_samples(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    v[0] = (float)sums->samples;
}

static void read_display_id(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    v[0] = (float)sums->display_id;
}

static void read_part_id(const Film *film, const PixelSums *sums, float v[3])
{
    (void)film;
    v[0] = (float)sums->part_id;
}

static void read_stokes(const Film *film, const PixelSums *sums, float v[3])
{
    mean_of(sums->layers + film->first[SUMS_STOKES], 3, sums->samples, v);
    if (!sums->samples) v[0] = v[1] = v[2] = 0;
}

/* Noise adds to it: S1, S2 and S3 are squared. */
static void read_degree(const Film *film, const PixelSums *sums, float v[3])
{
    float xyz[3], s[3];
    read_xyz(film, sums, xyz);
    read_stokes(film, sums, s);
    v[0] = xyz[1] > 0 ? sqrtf(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / xyz[1] : NAN;
}

static void read_luminance(const Film *film, const PixelSums *sums, float v[3])
{
    float xyz[3];
    read_xyz(film, sums, xyz);
    v[0] = xyz[1];
}

/* ---- the frame --------------------------------------------------------------------------- */

static const struct {
    unsigned     layer;
    const char  *name, *letters;
    PixelReader *read; /* NULL: a mean of */
    LayerSums    mean;
} layer_channels[] = {
    {LAYER_XYZ, "xyz", "XYZ", read_xyz, 0},
    {LAYER_DEPTH, "depth", "Z", NULL, SUMS_DEPTH},
    {LAYER_POSITION, "position", "XYZ", NULL, SUMS_POSITION},
    {LAYER_NORMAL, "normal", "XYZ", NULL, SUMS_NORMAL},
    {LAYER_ALBEDO, "albedo", "RGB", NULL, SUMS_ALBEDO},
    {LAYER_UV, "uv", "UV", NULL, SUMS_UV},
    {LAYER_VARIANCE, "variance", "RGB", read_variance, 0},
    {LAYER_HALVES, "halves", "RGB", read_halves, 0},
    {LAYER_DISPLAY_EMITTED, "display.emitted", "RGB", NULL, SUMS_EMITTED},
    {LAYER_DISPLAY_REFLECTED, "display.reflected", "RGB", NULL, SUMS_REFLECTED},
    {LAYER_DISPLAY_MIRROR, "display.mirror", "RGB", NULL, SUMS_MIRROR},
    {LAYER_DISPLAY_SCATTERED, "display.scattered", "RGB", read_scattered, 0},
    {LAYER_DISPLAY_HAZE, "display.haze", "RGB", read_haze, 0},
    {LAYER_DISPLAY_LAMBERTIAN, "display.lambertian", "RGB", NULL, SUMS_LAMBERTIAN},
    {LAYER_DISPLAY_WHITE, "display.white", "RGB", NULL, SUMS_WHITE},
    {LAYER_DISPLAY_BLACK, "display.black", "RGB", NULL, SUMS_BLACK},
    {LAYER_DISPLAY_FINE, "display.fine", "RGB", NULL, SUMS_FINE},
};

static void add_layers(const ChannelFill *to)
{
    for (size_t i = 0; i < sizeof layer_channels / sizeof *layer_channels; i++) {
        if (!(to->film->layers & layer_channels[i].layer)) continue;
        LayerPlanes planes =
            add_planes(to, layer_channels[i].name, layer_channels[i].letters);
        if (layer_channels[i].read) fill(to, planes, layer_channels[i].read);
        else fill_mean(to, planes, layer_channels[i].mean);
    }
}

static LayerPlanes add_named(const ChannelFill *to, const char *first, const char *second,
                             bool is_whole)
{
    LayerPlanes planes = {{NULL}};
    planes.of[0] = frame_add_channel(to->frame, first, is_whole, to->arena);
    if (second) planes.of[1] = frame_add_channel(to->frame, second, is_whole, to->arena);
    return planes;
}

static void add_stokes(const ChannelFill *to)
{
    fill(to, add_named(to, "stokes.S0", NULL, false), read_luminance);
    LayerPlanes planes = add_named(to, "stokes.S1", "stokes.S2", false);
    planes.of[2] = frame_add_channel(to->frame, "stokes.S3", false, to->arena);
    fill(to, planes, read_stokes);
    fill(to, add_named(to, "stokes.degree", NULL, false), read_degree);
}

/* Of samples that had none of it too: a mean over all, as the frame's own. */
static void add_light(const ChannelFill *to, int group)
{
    const Film *film = to->film;
    const char *name = arena_format(to->arena, "light.%s", film->lights.names[group]);
    LayerPlanes planes = add_planes(to, name, "RGB");
    size_t      index = 0;
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++, index++) {
            const PixelSums *sums = film_sums(film, x, y);
            float            xyz[3], rgb[3];
            mean_of(sums->layers + film->first_light + 3 * group, 3, sums->samples, xyz);
            if (!sums->samples) xyz[0] = xyz[1] = xyz[2] = 0;
            rgb_from_xyz(xyz, rgb);
            for (int i = 0; i < 3; i++) planes.of[i][index] = rgb[i];
        }
}

static int channels_most(const Film *film)
{
    return CHANNELS_MAX + 3 * film->lights.count;
}

FrameImage film_to_frame(const Film *film, int attribute_room, Arena *arena)
{
    ExrWindow  data = {film->crop.x0, film->crop.y0, film->crop.x1, film->crop.y1};
    FrameImage frame = frame_create(film->width, film->height, data, channels_most(film),
                                    attribute_room, arena);
    ChannelFill    to = {film, &frame, arena};
    fill(&to, add_planes(&to, "", "RGB"), read_rgb);
    add_layers(&to);
    if (film->layers & LAYER_SAMPLES)
        fill(&to, add_named(&to, "samples.N", NULL, true), read_samples);
    if (film->layers & LAYER_ID)
        fill(&to, add_named(&to, "id.part", NULL, true), read_part_id);
    if (film->layers & (LAYER_ID | LAYER_DISPLAYS))
        fill(&to, add_named(&to, "id.display", NULL, true), read_display_id);
    if (film->layers & LAYER_DISPLAY_ANGLES)
        fill(&to, add_named(&to, "display.theta", "display.phi", false), read_angles);
    if (film->layers & LAYER_DISPLAY_CONTRAST)
        fill(&to, add_named(&to, "display.contrast", NULL, false), read_contrast);
    if (film->layers & LAYER_DISPLAY_FINE)
        fill(&to, add_named(&to, "display.coverage", NULL, false), read_coverage);
    if (film->layers & LAYER_STOKES) add_stokes(&to);
    for (int i = 0; i < film->lights.count; i++) add_light(&to, i);
    return frame;
}

size_t film_frame_bytes_most(const Film *film)
{
    FilmRect crop = film->crop;
    size_t   pixels = (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
    return pixels * (size_t)channels_most(film) * sizeof(float) + ((size_t)1 << 20);
}

void film_add_error(const Film *film, FrameImage *frame, Arena *arena)
{
    float *error = frame_add_channel(frame, "error.Y", false, arena);
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++)
            *error++ = (float)film_pixel(film, x, y).sigma_y;
}
