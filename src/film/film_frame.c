/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_frame.h"

#include <math.h>
#include <string.h>

#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "film/pixels.h"
#include "spectrum/photometry.h"

#define CHANNELS_MAX 80 /* besides those of lights */
#define FILL_PIXELS 64  /* whose sums stay in a cache while all layers read them */
#define FEW_ITEMS 256   /* of FILL_PIXELS: not worth threads */
#define MOST_THREADS 16 /* memory is the limit then */
#define BAND_BYTES ((size_t)128 << 20)

/* Reads at most three numbers of a pixel. */
typedef void PixelReader(const Film *film, const PixelSums *sums, float values[3]);

/* How a layer is read: by a PixelReader, as its sums' mean, or as XYZ of a group of lights. */
typedef enum ChannelKind { KIND_READ, KIND_MEAN, KIND_LIGHT } ChannelKind;

/* The source of a layer's values. */
typedef struct ChannelSource {
    ChannelKind kind;
    PixelReader *read;
    LayerSums mean;
    int group;
} ChannelSource;

/* Channels of one layer: up to three planes of floats. */
typedef struct LayerPlanes {
    float *of[3];
    ChannelSource from;
} LayerPlanes;

typedef struct ChannelFill {
    const Film *film;
    FrameImage *frame;
    Arena *arena;
    unsigned wanted; /* FilmLayer bits */
    LayerPlanes *layers;
    int layer_count;
    int threads;
    char *pixels; /* FILL_PIXELS of them for each thread, gathered */
} ChannelFill;

/* Rows of a film on their way into the planes. */
typedef struct FillRows {
    const ChannelFill *to;
    size_t begin, count; /* pixels */
} FillRows;

static void add_channel(ChannelFill *to, int index, const char *name, bool is_whole) {
    to->layers[to->layer_count - 1].of[index] =
        frame_add_channel(to->frame, name, is_whole, to->arena);
}

static void begin_layer(ChannelFill *to, ChannelSource from) {
    to->layers[to->layer_count++] = (LayerPlanes){{NULL}, from};
}

static void add_layer(ChannelFill *to, const char *layer, const char *letters, ChannelSource from) {
    begin_layer(to, from);
    for (int i = 0; letters[i] && i < 3; i++)
        add_channel(to, i,
                    *layer ? arena_format(to->arena, "%s.%c", layer, letters[i])
                           : arena_format(to->arena, "%c", letters[i]),
                    false);
}

/* Mean over `count` samples; NaN over none. */
static void mean_of(const Fixed *sums, int size, uint32_t count, float *out) {
    for (int i = 0; i < size; i++)
        out[i] = count ? (float)(double_from_fixed(sums[i], FIXED_BITS) / (double)count) : NAN;
}

static void mean_layer(const Film *film, const PixelSums *sums, LayerSums layer, float *out) {
    uint32_t count = layer >= SUMS_FIRST_DISPLAY ? sums->display_hits : sums->hits;
    mean_of(sums->layers + film->first[layer], sums_rows[layer].size, count, out);
}

/* A layer that is a mean of its sums; of displays the sums are XYZ and the layer RGB. */
static void read_sums_mean(const Film *film, const PixelSums *sums, LayerSums layer, float v[3]) {
    float mean[3];
    mean_layer(film, sums, layer, mean);
    if (layer >= SUMS_FIRST_DISPLAY) rgb_from_xyz(mean, v);
    else memcpy(v, mean, sizeof mean);
}

/* A mean over all samples, also those without such light, as the frame's own. */
static void read_light(const Film *film, const PixelSums *sums, int group, float v[3]) {
    float xyz[3];
    mean_of(sums->layers + film->first_light + 3 * group, 3, sums->samples, xyz);
    if (!sums->samples) xyz[0] = xyz[1] = xyz[2] = 0;
    rgb_from_xyz(xyz, v);
}

/* ---- what is more than a mean ------------------------------------------------------------ */

static void read_xyz(const Film *film, const PixelSums *sums, float v[3]) {
    (void)film;
    mean_of(sums->xyz, 3, sums->samples, v);
    if (!sums->samples) v[0] = v[1] = v[2] = 0;
}

static void read_rgb(const Film *film, const PixelSums *sums, float v[3]) {
    float xyz[3];
    read_xyz(film, sums, xyz);
    rgb_from_xyz(xyz, v);
}

/* theta and phi of the mean direction, degrees; phi in [0, 360). */
static void read_angles(const Film *film, const PixelSums *sums, float v[3]) {
    float d[3];
    mean_layer(film, sums, SUMS_DIRECTION, d);
    float across = sqrtf(d[0] * d[0] + d[1] * d[1]);
    float phi = (float)degrees_from_radians((double)atan2_f(d[1], d[0]));
    v[0] = isnan(d[0]) ? NAN : (float)degrees_from_radians((double)atan2_f(across, d[2]));
    v[1] = isnan(d[0]) ? NAN : phi < 0 ? phi + 360 : phi;
}

static void read_contrast(const Film *film, const PixelSums *sums, float v[3]) {
    float white[3], black[3], reflected[3];
    mean_layer(film, sums, SUMS_WHITE, white);
    mean_layer(film, sums, SUMS_BLACK, black);
    mean_layer(film, sums, SUMS_REFLECTED, reflected);
    v[0] = (white[1] + reflected[1]) / (black[1] + reflected[1]);
}

/* Reflected light without the first `count` of these parts. */
static void read_rest(const Film *film, const PixelSums *sums, int count, float v[3]) {
    static const LayerSums parts[] = {SUMS_MIRROR, SUMS_LAMBERTIAN};
    Fixed left[3];
    float xyz[3];
    memcpy(left, sums->layers + film->first[SUMS_REFLECTED], sizeof left);
    for (int k = 0; k < count; k++)
        for (int i = 0; i < 3; i++) left[i] -= sums->layers[film->first[parts[k]] + i];
    mean_of(left, 3, sums->display_hits, xyz);
    rgb_from_xyz(xyz, v);
}

static void read_scattered(const Film *film, const PixelSums *sums, float v[3]) {
    read_rest(film, sums, 1, v);
}

static void read_haze(const Film *film, const PixelSums *sums, float v[3]) {
    read_rest(film, sums, 2, v);
}

/* Noise may take a share of next to nothing out of its range. */
static float share_of(const Fixed *part, const Fixed *all) {
    return *all > 0 ? clampf((float)((double)*part / (double)*all), 0, 1) : 0;
}

/* Of the luminances. */
static void read_extrapolated(const Film *film, const PixelSums *sums, float v[3]) {
    const Fixed *layers = sums->layers, *part = layers + film->first[SUMS_EXTRAPOLATED];
    v[0] = v[1] = NAN;
    if (!sums->display_hits) return;
    v[0] = share_of(&part[0], layers + film->first[SUMS_EMITTED] + 1);
    v[1] = share_of(&part[1], layers + film->first[SUMS_REFLECTED] + 1);
}

static void read_coverage(const Film *film, const PixelSums *sums, float v[3]) {
    (void)film;
    v[0] = sums->samples ? (float)sums->display_hits / (float)sums->samples : 0;
}

/* Keeps 8 of 24 bits, to the nearest: an estimate of noise is not known to a part in 256, and
 * the file has half the bytes. */
static void round_noise(const Film *film, float v[3]) {
    for (int i = 0; i < 3 && film->layers & LAYER_ROUNDED; i++) {
        uint32_t bits;
        memcpy(&bits, &v[i], sizeof bits);
        bits = (bits + 0x8000u) & 0xffff0000u;
        if (!isnan(v[i])) memcpy(&v[i], &bits, sizeof bits);
    }
}

static void read_variance(const Film *film, const PixelSums *sums, float v[3]) {
    double variance[3];
    pixel_variance(sums, variance);
    for (int i = 0; i < 3; i++) v[i] = (float)variance[i];
    round_noise(film, v);
}

static void rgb_of_known(bool is_known, const double known[3], float v[3]) {
    float xyz[3];
    for (int i = 0; i < 3; i++) xyz[i] = is_known ? (float)known[i] : NAN;
    rgb_from_xyz(xyz, v);
}

static void read_halves(const Film *film, const PixelSums *sums, float v[3]) {
    double halves[3];
    rgb_of_known(pixel_halves(sums, BLOCK_LEAST, halves), halves, v);
    round_noise(film, v);
}

uint32_t film_halves_samples(uint32_t first) {
    uint32_t count = 0, odd = 0;
    while (odd < BLOCK_LEAST || count - odd < BLOCK_LEAST)
        odd += (first + count++) / BLOCK_SAMPLES % 2;
    return count;
}

static void read_display_halves(const Film *film, const PixelSums *sums, float v[3]) {
    const Fixed *layers = sums->layers;
    double halves[3];
    bool is_known = pixel_display_halves(sums, layers + film->first[SUMS_REFLECTED],
                                         layers + film->first[SUMS_ODD], BLOCK_LEAST, halves);
    rgb_of_known(is_known, halves, v);
    round_noise(film, v);
}

static DisplaySums display_sums(const Film *film, const PixelSums *sums) {
    const int *first = film->first;
    const Fixed *layers = sums->layers;
    return (DisplaySums){(double)sums->display_hits, layers + first[SUMS_EMITTED],
                         layers + first[SUMS_REFLECTED], layers + first[SUMS_SQUARES],
                         first[SUMS_SHARED] < 0 ? NULL : layers + first[SUMS_SHARED]};
}

static void read_display_variance(const Film *film, const PixelSums *sums, float v[3]) {
    DisplaySums of = display_sums(film, sums);
    double variance[3];
    pixel_display_variance(&of, variance);
    for (int i = 0; i < 3; i++) v[i] = (float)variance[i];
    round_noise(film, v);
}

static SecondDisplay second_display(const Film *film, const PixelSums *sums) {
    DisplaySums of = display_sums(film, sums);
    return pixel_second_display(&of, sums->display_id);
}

static void read_second(const Film *film, const PixelSums *sums, float v[3]) {
    SecondDisplay second = second_display(film, sums);
    rgb_of_known(second.id >= 0, second.xyz, v);
}

static void read_second_variance(const Film *film, const PixelSums *sums, float v[3]) {
    SecondDisplay second = second_display(film, sums);
    for (int i = 0; i < 3; i++) v[i] = second.id >= 0 ? (float)second.variance[i] : NAN;
    round_noise(film, v);
}

static void read_second_id(const Film *film, const PixelSums *sums, float v[3]) {
    SecondDisplay second = second_display(film, sums);
    v[0] = (float)second.id;
    v[1] = second.id >= 0 ? (float)(second.samples / (double)sums->samples) : 0;
}

static void read_samples(const Film *film, const PixelSums *sums, float v[3]) {
    (void)film;
    v[0] = (float)sums->samples;
}

static void read_display_id(const Film *film, const PixelSums *sums, float v[3]) {
    (void)film;
    v[0] = (float)sums->display_id;
}

static void read_part_id(const Film *film, const PixelSums *sums, float v[3]) {
    (void)film;
    v[0] = (float)sums->part_id;
}

static void read_stokes(const Film *film, const PixelSums *sums, float v[3]) {
    mean_of(sums->layers + film->first[SUMS_STOKES], 3, sums->samples, v);
    if (!sums->samples) v[0] = v[1] = v[2] = 0;
}

/* A mean over all samples, also those that saw no light source. */
static void read_emitted(const Film *film, const PixelSums *sums, float v[3]) {
    float xyz[3];
    mean_of(sums->layers + film->first[SUMS_SOURCES], 3, sums->samples, xyz);
    rgb_from_xyz(xyz, v);
    if (!sums->samples) v[0] = v[1] = v[2] = 0;
}

/* Noise raises it: S1, S2 and S3 are squared. */
static void read_degree(const Film *film, const PixelSums *sums, float v[3]) {
    float xyz[3], s[3];
    read_xyz(film, sums, xyz);
    read_stokes(film, sums, s);
    v[0] = xyz[1] > 0 ? sqrtf(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / xyz[1] : NAN;
}

static void read_luminance(const Film *film, const PixelSums *sums, float v[3]) {
    float xyz[3];
    read_xyz(film, sums, xyz);
    v[0] = xyz[1];
}

/* ---- all layers of a pixel --------------------------------------------------------------- */

static void read_source(const Film *film, const ChannelSource *from, const PixelSums *sums,
                        float v[3]) {
    switch (from->kind) {
    case KIND_READ: from->read(film, sums, v); break;
    case KIND_MEAN: read_sums_mean(film, sums, from->mean, v); break;
    case KIND_LIGHT: read_light(film, sums, from->group, v); break;
    }
}

/* Gathered pixels become the planes' values from `first` on. */
static void fill_layer(const Film *film, const LayerPlanes *layer, const char *next, size_t first,
                       size_t count) {
    for (size_t k = 0; k < count; k++, next += film->stride) {
        float values[3];
        read_source(film, &layer->from, (const PixelSums *)(const void *)next, values);
        for (int i = 0; i < 3; i++)
            if (layer->of[i]) layer->of[i][first + k] = values[i];
    }
}

/* A pixel with all its layers takes a kilobyte: it comes from memory once, not once a layer. */
static void fill_some(void *context, int item, int worker) {
    const FillRows *rows = context;
    const ChannelFill *to = rows->to;
    char *pixels = to->pixels + (size_t)worker * FILL_PIXELS * to->film->stride;
    size_t first = (size_t)item * FILL_PIXELS, left = rows->count - first;
    size_t count = left < FILL_PIXELS ? left : FILL_PIXELS;
    film_gather(to->film, rows->begin + first, count, pixels);
    for (int i = 0; i < to->layer_count; i++)
        fill_layer(to->film, &to->layers[i], pixels, first, count);
}

static void fill(void *user, int y0, int y1) {
    const ChannelFill *to = user;
    const Film *film = to->film;
    size_t begin = film_index(film, film->crop.x0, y0);
    FillRows rows = {to, begin, film_index(film, film->crop.x0, y1) - begin};
    size_t items = (rows.count + FILL_PIXELS - 1) / FILL_PIXELS;
    parallel_for(items < FEW_ITEMS ? 1 : to->threads, (int)items, fill_some, &rows);
}

/* ---- the frame --------------------------------------------------------------------------- */

#define read_mean NULL
#define LAYER_ROW(NAME, bit, of, option, letters, reader, sums) \
    {LAYER_##NAME, option, letters, read_##reader, SUMS_##sums},

/* Layers of a colour or a vector. */
static const struct {
    unsigned layer;
    const char *name, *letters; /* "": none here */
    PixelReader *read;          /* NULL: a mean of */
    LayerSums mean;
} layer_channels[] = {FILM_LAYERS(LAYER_ROW){LAYER_DISPLAY_SECOND, "display.second.variance", "RGB",
                                             read_second_variance, 0}};

/* Numbers with names of their own. */
static const struct {
    unsigned layers; /* any of them */
    const char *name;
    bool is_whole;
    PixelReader *read;
    int index; /* of what it reads; above 0: the row before reads it, too */
} number_channels[] = {
    {LAYER_SAMPLES | LAYER_DISPLAY_VARIANCE, "samples.N", true, read_samples, 0},
    {LAYER_ID, "id.part", true, read_part_id, 0},
    {LAYER_ID | LAYER_DISPLAYS, "id.display", true, read_display_id, 0},
    {LAYER_DISPLAY_ANGLES, "display.theta", false, read_angles, 0},
    {LAYER_DISPLAY_ANGLES, "display.phi", false, read_angles, 1},
    {LAYER_DISPLAY_EXTRAPOLATED, "display.extrapolated.emitted", false, read_extrapolated, 0},
    {LAYER_DISPLAY_EXTRAPOLATED, "display.extrapolated.reflected", false, read_extrapolated, 1},
    {LAYER_DISPLAY_CONTRAST, "display.contrast", false, read_contrast, 0},
    {LAYER_DISPLAY_SECOND, "id.second", true, read_second_id, 0},
    {LAYER_DISPLAY_SECOND, "display.second.coverage", false, read_second_id, 1},
    {LAYER_DISPLAY_FINE | LAYER_DISPLAY_VARIANCE, "display.coverage", false, read_coverage, 0},
    {LAYER_STOKES, "stokes.S0", false, read_luminance, 0},
    {LAYER_STOKES, "stokes.S1", false, read_stokes, 0},
    {LAYER_STOKES, "stokes.S2", false, read_stokes, 1},
    {LAYER_STOKES, "stokes.S3", false, read_stokes, 2},
    {LAYER_STOKES, "stokes.degree", false, read_degree, 0}};

static void add_layers(ChannelFill *to) {
    for (size_t i = 0; i < sizeof layer_channels / sizeof *layer_channels; i++) {
        PixelReader *read = layer_channels[i].read;
        if (!(to->wanted & layer_channels[i].layer) || !*layer_channels[i].letters) continue;
        add_layer(to, layer_channels[i].name, layer_channels[i].letters,
                  (ChannelSource){.kind = read ? KIND_READ : KIND_MEAN,
                                  .read = read,
                                  .mean = layer_channels[i].mean});
    }
}

static void add_numbers(ChannelFill *to) {
    for (size_t i = 0; i < sizeof number_channels / sizeof *number_channels; i++) {
        int index = number_channels[i].index;
        if (!(to->wanted & number_channels[i].layers)) continue;
        ChannelSource from = {.kind = KIND_READ, .read = number_channels[i].read};
        if (index == 0) begin_layer(to, from);
        add_channel(to, index, number_channels[i].name, number_channels[i].is_whole);
    }
}

static void add_light(ChannelFill *to, int group) {
    const char *name = arena_format(to->arena, "light.%s", to->film->lights.names[group]);
    add_layer(to, name, "RGB", (ChannelSource){.kind = KIND_LIGHT, .group = group});
}

static int channels_most(const Film *film) {
    return CHANNELS_MAX + 3 * film->lights.count;
}

/* rows: NULL, the planes are to hold all. */
static FrameImage make_frame(const Film *film, unsigned layers, ExrWindow data, int attribute_room,
                             ExrRows *rows, Arena *arena) {
    int most = channels_most(film);
    ChannelFill *to = ARENA_NEW(arena, ChannelFill, 1);
    FrameImage frame = frame_create(film->width, film->height, data, most, attribute_room, arena);
    frame.rows = rows;
    int processors = parallel_default_threads();
    int threads = processors < MOST_THREADS ? processors : MOST_THREADS;
    *to = (ChannelFill){.film = film,
                        .frame = &frame,
                        .arena = arena,
                        .wanted = layers & film->layers,
                        .layers = ARENA_NEW(arena, LayerPlanes, most),
                        .threads = threads,
                        .pixels = arena_alloc(arena, film->stride * FILL_PIXELS,
                                              _Alignof(PixelSums), (size_t)threads)};
    add_layer(to, "", "RGB", (ChannelSource){.kind = KIND_READ, .read = read_rgb});
    add_layers(to);
    add_numbers(to);
    for (int i = 0; i < film->lights.count && layers & LAYER_LIGHT; i++) add_light(to, i);
    to->frame = NULL; /* which the caller may move */
    if (rows) *rows = (ExrRows){rows->count, fill, to};
    else fill(to, data.y0, data.y1);
    return frame;
}

static ExrWindow window_of(const Film *film) {
    const FilmRect crop = film->crop;
    return (ExrWindow){crop.x0, crop.y0, crop.x1, crop.y1};
}

FrameImage film_to_frame(const Film *film, int attribute_room, Arena *arena) {
    return make_frame(film, film->layers, window_of(film), attribute_room, NULL, arena);
}

FrameImage film_to_picture(const Film *film, unsigned layers, int attribute_room, Arena *arena) {
    return make_frame(film, layers, window_of(film), attribute_room, NULL, arena);
}

FrameImage film_to_rows(const Film *film, int attribute_room, Arena *arena) {
    ExrRows *rows = ARENA_NEW(arena, ExrRows, 1);
    size_t row = (size_t)(film->crop.x1 - film->crop.x0) * (size_t)channels_most(film);
    rows->count = exr_rows_in(BAND_BYTES, row * sizeof(float), film->crop.y1 - film->crop.y0);
    return make_frame(film, film->layers, window_of(film), attribute_room, rows, arena);
}

/* An upper bound. */
static size_t frame_bytes_most(const Film *film, Arena scratch) {
    FilmRect crop = film->crop;
    size_t pixels = (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
    const ExrWindow none = {0, crop.y0, 0, crop.y0};
    size_t channels = (size_t)make_frame(film, film->layers, none, 0, NULL, &scratch).channel_count;
    return pixels * channels * sizeof(float) + ((size_t)1 << 20);
}

bool film_has_room(const Film *film, const Arena *arena, Error *err) {
    FilmRect crop = film->crop;
    size_t wanted = frame_bytes_most(film, *arena), left = arena_left(arena);
    return wanted <= left ||
           error_set(err, ERROR_MEMORY,
                     "the frame of %dx%d pixels needs %zu MB of memory beside its film, %zu MB "
                     "are left — use --crop or fewer --layers",
                     crop.x1 - crop.x0, crop.y1 - crop.y0, wanted >> 20, left >> 20);
}

size_t film_frame_bytes(FilmRect crop, unsigned layers, int light_count) {
    size_t pixels = (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
    size_t channels = 3 + 3 * (size_t)light_count;
    for (size_t i = 0; i < sizeof layer_channels / sizeof *layer_channels; i++)
        if (layers & layer_channels[i].layer) channels += strlen(layer_channels[i].letters);
    return pixels * channels * sizeof(float);
}
