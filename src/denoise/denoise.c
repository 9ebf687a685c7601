/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/denoise.h"

#include <math.h>

#include "base/file.h"
#include "base/program.h"
#include "denoise/balance.h"
#include "denoise/detail.h"
#include "denoise/network.h"
#include "denoise/transfer.h"

/* ---- the frame's layers ------------------------------------------------------------------ */

typedef struct Layers {
    const float *light[3], *normal[3], *albedo[3], *emitted[3];
    const float *coverage[3]; /* one */
    const float *fine[3];     /* NULL without that layer */
    const float *lamps[3];    /* NULL without `emitted` */
    const float *halves[3];   /* NULL without that layer */
} Layers;

typedef struct LayerRow {
    const char *name, *channels[3];
    size_t offset;
    bool may_miss;
} LayerRow;

static const LayerRow layer_rows[] = {
    {"R, G, B", {"R", "G", "B"}, offsetof(Layers, light), false},
    {"normal", {"normal.X", "normal.Y", "normal.Z"}, offsetof(Layers, normal), false},
    {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, offsetof(Layers, albedo), false},
    {"display.emitted",
     {"display.emitted.R", "display.emitted.G", "display.emitted.B"},
     offsetof(Layers, emitted),
     false},
    {"display.coverage", {"display.coverage"}, offsetof(Layers, coverage), false},
    {"display.fine",
     {"display.fine.R", "display.fine.G", "display.fine.B"},
     offsetof(Layers, fine),
     true},
    {"emitted", {"emitted.R", "emitted.G", "emitted.B"}, offsetof(Layers, lamps), true},
    {"halves", {"halves.R", "halves.G", "halves.B"}, offsetof(Layers, halves), true},
};

enum { LAYER_ROWS = sizeof layer_rows / sizeof *layer_rows };

static bool find_layer(const FrameImage *frame, const LayerRow *row, Layers *out) {
    const float **planes = (const float **)(void *)((char *)out + row->offset);
    bool is_there = true;
    for (int c = 0; c < 3 && row->channels[c]; c++) {
        planes[c] = frame_channel(frame, row->channels[c]);
        is_there = is_there && planes[c];
    }
    if (!is_there) planes[0] = NULL;
    return is_there || row->may_miss;
}

static bool find_layers(const FrameImage *frame, Arena scratch, Layers *out, Error *err) {
    const char *missing = "";
    for (int i = 0; i < LAYER_ROWS; i++)
        if (!find_layer(frame, &layer_rows[i], out))
            missing =
                arena_format(&scratch, "%s%s%s", missing, *missing ? ", " : "", layer_rows[i].name);
    return !*missing ||
           error_set(
               err, ERROR_INPUT,
               "lacks what --denoise requires (missing: %s) — render it with --layers " DENOISE_LAYERS,
               missing);
}

/* ---- one pixel --------------------------------------------------------------------------- */

static bool are_finite(const float *const planes[3], size_t i) {
    return isfinite(planes[0][i]) && isfinite(planes[1][i]) && isfinite(planes[2][i]);
}

static float luminance_of(const float rgb[3]) {
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

/* What the pixel's own samples saw of what displays emit. */
static void display_light(const Layers *layers, size_t i, float out[3]) {
    const float coverage = layers->coverage[0][i];
    const bool shows = coverage > 0 && are_finite(layers->emitted, i);
    for (int c = 0; c < 3; c++) out[c] = shows ? layers->emitted[c][i] * coverage : 0;
}

/* And of what lamps do. */
static void add_lamps(const Layers *layers, size_t i, float out[3]) {
    if (!layers->lamps[0] || !are_finite(layers->lamps, i)) return;
    for (int c = 0; c < 3; c++) out[c] += layers->lamps[c][i];
}

/* What sources send to the eye themselves: not filtered. */
static void own_light(const Layers *layers, size_t i, float out[3]) {
    display_light(layers, i, out);
    add_lamps(layers, i, out);
}

/* The rest, which is filtered; nothing where a pixel is not finite. */
static void other_light(const Layers *layers, size_t i, float out[3]) {
    float own[3];
    own_light(layers, i, own);
    for (int c = 0; c < 3; c++)
        out[c] = are_finite(layers->light, i) ? fmaxf(layers->light[c][i] - own[c], 0) : 0;
}

/* What is put back: of displays the mean emission by more camera rays than the pixel's
 * samples, where the frame has it. */
static void shown_light(const Layers *layers, size_t i, float out[3]) {
    const bool has_fine = layers->fine[0] && layers->coverage[0][i] > 0;
    display_light(layers, i, out);
    for (int c = 0; c < 3 && has_fine && are_finite(layers->fine, i); c++)
        out[c] = layers->fine[c][i];
    add_lamps(layers, i, out);
}

/* ---- the picture that the network sees --------------------------------------------------- */

typedef struct Filtering {
    const Layers *layers;
    int width, height;
    float exposure; /* relative light per cd m^-2 */
    float *out[3];
    long *left; /* pixels of each row that were not filtered */
} Filtering;

/* As far as the network's range goes: suns and what is not finite stay as they are. The sky is
 * filtered as well: alone it has no noise, but the mirror images of panes before it have. */
static bool is_filtered(const Filtering *work, size_t i) {
    const Layers *layers = work->layers;
    const float most = TRANSFER_MOST / work->exposure;
    if (!are_finite(layers->light, i)) return false;
    for (int c = 0; c < 3; c++)
        if (!(layers->light[c][i] < most)) return false;
    return true;
}

static void fill_row(void *user, int y, float *row) {
    const Filtering *work = user;
    const Layers *layers = work->layers;
    for (int x = 0; x < work->width; x++, row += NETWORK_STRIDE) {
        const size_t i = (size_t)y * (size_t)work->width + (size_t)x;
        float light[3];
        other_light(layers, i, light);
        for (int c = 0; c < 3; c++) {
            const float exposed = fminf(light[c] * work->exposure, TRANSFER_MOST);
            const float albedo = layers->albedo[c][i], normal = layers->normal[c][i];
            row[c] = transfer_encode(exposed);
            row[3 + c] = isfinite(albedo) ? clampf(albedo, 0, 1) : 0;
            row[6 + c] = isfinite(normal) ? 0.5f * clampf(normal, -1, 1) + 0.5f : 0.5f;
        }
    }
}

static void take_row(void *user, int y, const float *row) {
    const Filtering *work = user;
    const Layers *layers = work->layers;
    for (int x = 0; x < work->width; x++, row += NETWORK_STRIDE) {
        const size_t i = (size_t)y * (size_t)work->width + (size_t)x;
        const float light[3] = {layers->light[0][i], layers->light[1][i], layers->light[2][i]};
        float rgb[3], shown[3];
        const bool filtered = is_filtered(work, i);
        shown_light(layers, i, shown);
        for (int c = 0; c < 3; c++) {
            const float decoded = transfer_decode(fminf(row[c], 1)) / work->exposure;
            rgb[c] = filtered ? decoded + shown[c] : light[c];
            work->out[c][i] = rgb[c];
        }
        work->left[y] += !filtered;
    }
}

/* ---- what the network took besides noise ------------------------------------------------- */

/* Of the whole pixel, as its luminance is; variances hold the noise of displays' light, too,
 * where the frame's samples have it. */
static void difference_of_pixel(void *user, size_t i, DetailDifference *out) {
    const Filtering *work = user;
    const Layers *layers = work->layers;
    const float after[3] = {work->out[0][i], work->out[1][i], work->out[2][i]};
    const float level = luminance_of(after);
    float before[3], shown[3];
    *out = (DetailDifference){0, 0};
    if (!is_filtered(work, i) || !are_finite(layers->halves, i) || !(level > 0)) return;
    other_light(layers, i, before);
    shown_light(layers, i, shown);
    for (int c = 0; c < 3; c++) {
        const float difference = (before[c] + shown[c] - after[c]) / level;
        const float noise = layers->halves[c][i] / level;
        out->square += difference * difference;
        out->variance += noise * noise;
    }
}

static void give_back_detail(void *user, size_t i, float share) {
    const Filtering *work = user;
    float before[3], shown[3];
    if (!is_filtered(work, i)) return;
    other_light(work->layers, i, before);
    shown_light(work->layers, i, shown);
    for (int c = 0; c < 3; c++) work->out[c][i] += share * (before[c] + shown[c] - work->out[c][i]);
}

/* ---- the light that the network took ----------------------------------------------------- */

static void light_of_pixel(void *user, size_t i, BalanceLight *out) {
    const Filtering *work = user;
    const Layers *layers = work->layers;
    const float light[3] = {layers->light[0][i], layers->light[1][i], layers->light[2][i]};
    float before[3], after[3], shown[3];
    *out = (BalanceLight){0, 0, are_finite(layers->light, i) ? luminance_of(light) : 0};
    if (!is_filtered(work, i)) return;
    other_light(layers, i, before);
    shown_light(layers, i, shown);
    for (int c = 0; c < 3; c++) after[c] = fmaxf(work->out[c][i] - shown[c], 0);
    out->before = luminance_of(before);
    out->after = luminance_of(after);
}

static void scale_pixel(void *user, size_t i, float gain) {
    const Filtering *work = user;
    float shown[3];
    if (!(gain < 1 || gain > 1)) return;
    shown_light(work->layers, i, shown);
    for (int c = 0; c < 3; c++) work->out[c][i] = shown[c] + gain * (work->out[c][i] - shown[c]);
}

static double give_back(Filtering *work, int threads, Arena scratch) {
    const BalancePicture picture = {work->width, work->height, work, light_of_pixel, scale_pixel};
    return balance_run(&picture, threads, scratch);
}

/* ---- exposure ---------------------------------------------------------------------------- */

enum { BLOCK = 16 };

/* Mean luminance of a block of the filtered light. */
static double block_mean(const Filtering *work, int x0, int y0) {
    const int x1 = x0 + BLOCK < work->width ? x0 + BLOCK : work->width;
    const int y1 = y0 + BLOCK < work->height ? y0 + BLOCK : work->height;
    double sum = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            float light[3];
            other_light(work->layers, (size_t)y * (size_t)work->width + (size_t)x, light);
            sum += (double)luminance_of(light);
        }
    return sum / ((double)(y1 - y0) * (double)(x1 - x0));
}

#define BLOCK_NOTHING 1e-8 /* cd m^-2: blocks without light are left out */
#define KEY 0.18           /* what the geometric mean of the blocks becomes */

/* As in the network's training. */
static float exposure_of(const Filtering *work) {
    double sum = 0;
    long count = 0;
    for (int y = 0; y < work->height; y += BLOCK)
        for (int x = 0; x < work->width; x += BLOCK) {
            const double mean = block_mean(work, x, y);
            if (!(mean > BLOCK_NOTHING)) continue;
            sum += log2(mean);
            count++;
        }
    return count ? (float)(KEY / exp2(sum / (double)count)) : 1;
}

/* ---- the weights ------------------------------------------------------------------------- */

#define WEIGHTS "assets/denoise/rt_hdr_alb_nrm.tza"
enum { WEIGHTS_BYTES_MAX = 64 << 20 };

static bool find_weights(char path[PATH_MAX], Error *err) {
    static const ProgramPart part = {"the denoiser's file of weights", "../../" WEIGHTS,
                                     INSTALLED_SHARE "/" WEIGHTS};
    return program_find(&part, path, err) || error_in_file(err, path_name(WEIGHTS));
}

bool denoise_check(Error *err) {
    char path[PATH_MAX];
    return find_weights(path, err);
}

static bool read_weights(Arena *arena, Network *out, Error *err) {
    char path[PATH_MAX];
    FileBytes bytes;
    return find_weights(path, err) && file_read(path, WEIGHTS_BYTES_MAX, arena, &bytes, err) &&
           network_read(&(WeightFile){bytes.data, bytes.size, path}, arena, out, err);
}

/* ---- all of it --------------------------------------------------------------------------- */

static DenoiseReport report_of(const Filtering *work, double block_error) {
    const float *const *light = work->layers->light;
    const size_t count = (size_t)work->width * (size_t)work->height;
    double before = 0, after = 0, left = 0;
    for (size_t i = 0; i < count; i++) {
        if (!are_finite(light, i)) continue;
        before += (double)luminance_of((float[]){light[0][i], light[1][i], light[2][i]});
        after += (double)luminance_of((float[]){work->out[0][i], work->out[1][i], work->out[2][i]});
    }
    for (int y = 0; y < work->height; y++) left += (double)work->left[y];
    return (DenoiseReport){before > 0 ? after / before : 1, block_error, left / (double)count};
}

bool denoise_frame(const FrameImage *frame, int threads, Arena *arena, FrameImage *out,
                   DenoiseReport *report, Error *err) {
    Layers layers = {.fine = {NULL}};
    Network network;
    Filtering work = {.layers = &layers,
                      .width = frame->data.x1 - frame->data.x0,
                      .height = frame->data.y1 - frame->data.y0};
    if (!find_layers(frame, *arena, &layers, err)) return false;
    for (int c = 0; c < 3; c++) work.out[c] = ARENA_NEW(arena, float, frame_pixel_count(frame));
    FrameImage made = frame_with_rgb(frame, work.out, arena);
    Arena scratch = *arena;
    if (!read_weights(&scratch, &network, err)) return false;
    work.left = ARENA_NEW(&scratch, long, (size_t)work.height);
    work.exposure = exposure_of(&work);
    const NetworkPicture picture = {work.width, work.height, &work, fill_row, take_row};
    network_run(&network, &picture, threads, scratch);
    const DetailPicture detail = {work.width, work.height, &work, difference_of_pixel,
                                  give_back_detail};
    if (layers.halves[0]) detail_run(&detail, threads, scratch);
    *report = report_of(&work, give_back(&work, threads, scratch));
    *out = made;
    return true;
}
