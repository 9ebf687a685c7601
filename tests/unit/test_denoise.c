/* SPDX-License-Identifier: Apache-2.0 */
/* The preview's network: the numbers that it computes, the file that it reads, what of a frame
 * it must leave alone, and that no light is lost on the way. */
#include "fixture.h"

#include "denoise/convolution.h"
#include "denoise/denoise.h"
#include "denoise/network.h"
#include "denoise/transfer.h"

static Error failure;

enum { WIDTH = 160, HEIGHT = 112, COUNT = WIDTH * HEIGHT, SAMPLES = 4 };

#define WEIGHTS_FILE PROJECT_DIR "/assets/denoise/rt_hdr_alb_nrm.tza"

static double uniform(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) * 0x1p-24;
}

static FileBytes shipped_weights(Arena *arena) {
    FileBytes bytes;
    assert_done(file_read(WEIGHTS_FILE, 1 << 24, arena, &bytes, &err));
    return bytes;
}

/* ---- the curve --------------------------------------------------------------------------- */

TEST(the_curve_and_its_inverse_agree) {
    float before = -1;
    for (double light = 1e-8; light < 65504; light *= 1.01) {
        float code = transfer_encode((float)light);
        assert_true(code > before && code <= 1);
        assert_close(transfer_decode(code), light, 2e-4);
        before = code;
    }
    assert_close(transfer_encode(TRANSFER_MOST), 1, 1e-6);
    /* at its joints */
    assert_close(transfer_curve(1.579e-6f), transfer_curve(1.580e-6f), 2e-3);
    assert_close(transfer_curve(0.032208f), transfer_curve(0.032209f), 1e-4);
}

/* ---- the network against its definition -------------------------------------------------- */

/* A picture of planes, evaluated as the table in README.md reads. */
typedef struct Planes {
    int width, height, channels;
    float *values; /* [channel][y][x] */
} Planes;

static Planes planes_of(int width, int height, int channels, Arena *arena) {
    return (Planes){width, height, channels,
                    ARENA_NEW(arena, float, (size_t)(width * height * channels))};
}

static float *plane_at(const Planes *planes, int c, int y, int x) {
    return &planes
                ->values[((size_t)c * (size_t)planes->height + (size_t)y) * (size_t)planes->width +
                         (size_t)x];
}

static float weight_of(const Weights *w, int room, int output, int tap, int input) {
    return w->weights[((output / 16 * 9 + tap) * room + input) * 16 + output % 16];
}

static Planes convolved(const Planes *in, const Weights *w, int outputs, Arena *arena) {
    Planes out = planes_of(in->width, in->height, outputs, arena);
    int room = (in->channels + 15) / 16 * 16;
    for (int o = 0; o < outputs; o++)
        for (int y = 0; y < in->height; y++)
            for (int x = 0; x < in->width; x++) {
                double sum = (double)w->biases[o];
                for (int tap = 0; tap < 9; tap++) {
                    int u = x + tap % 3 - 1, v = y + tap / 3 - 1;
                    if (u < 0 || v < 0 || u >= in->width || v >= in->height) continue;
                    for (int i = 0; i < in->channels; i++)
                        sum +=
                            (double)*plane_at(in, i, v, u) * (double)weight_of(w, room, o, tap, i);
                }
                *plane_at(&out, o, y, x) = (float)fmax(sum, 0);
            }
    return out;
}

static Planes pooled(const Planes *in, Arena *arena) {
    Planes out = planes_of(in->width / 2, in->height / 2, in->channels, arena);
    for (int c = 0; c < in->channels; c++)
        for (int y = 0; y < out.height; y++)
            for (int x = 0; x < out.width; x++)
                for (int k = 0; k < 4; k++)
                    *plane_at(&out, c, y, x) = fmaxf(
                        *plane_at(&out, c, y, x), *plane_at(in, c, 2 * y + k / 2, 2 * x + k % 2));
    return out;
}

static Planes joined(const Planes *coarse, const Planes *beside, Arena *arena) {
    Planes out =
        planes_of(beside->width, beside->height, coarse->channels + beside->channels, arena);
    for (int c = 0; c < out.channels; c++)
        for (int y = 0; y < out.height; y++)
            for (int x = 0; x < out.width; x++)
                *plane_at(&out, c, y, x) = c < coarse->channels
                                               ? *plane_at(coarse, c, y / 2, x / 2)
                                               : *plane_at(beside, c - coarse->channels, y, x);
    return out;
}

static Planes evaluated(const Network *network, const Planes *input, Arena *arena) {
    static const int OUTPUTS[NETWORK_CONVOLUTIONS] = {32,  32, 48, 64, 80, 96, 96, 112,
                                                      112, 96, 96, 64, 64, 64, 32, 3};
    Planes at = *input, pools[4];
    int layer = 0;
    for (int level = 0; level < 4; level++) {
        for (int k = 0; k < (level == 0 ? 2 : 1); k++)
            at = convolved(&at, &network->layers[layer], OUTPUTS[layer], arena), layer++;
        pools[level] = at = pooled(&at, arena);
    }
    for (int k = 0; k < 2; k++)
        at = convolved(&at, &network->layers[layer], OUTPUTS[layer], arena), layer++;
    for (int level = 3; level >= 0; level--) {
        at = joined(&at, level > 0 ? &pools[level - 1] : input, arena);
        for (int k = 0; k < 2; k++)
            at = convolved(&at, &network->layers[layer], OUTPUTS[layer], arena), layer++;
    }
    return convolved(&at, &network->layers[layer], OUTPUTS[layer], arena);
}

typedef struct Ends {
    const Planes *in;
    int width;
    float *out; /* [y][x][3] */
} Ends;

static void fill_row(void *user, int y, float *row) {
    const Ends *ends = user;
    for (int x = 0; x < ends->width; x++)
        for (int c = 0; c < NETWORK_INPUTS; c++)
            row[NETWORK_STRIDE * x + c] = *plane_at(ends->in, c, y, x);
}

static void take_row(void *user, int y, const float *row) {
    const Ends *ends = user;
    for (int x = 0; x < ends->width; x++)
        for (int c = 0; c < NETWORK_OUTPUTS; c++)
            ends->out[(y * ends->width + x) * 3 + c] = row[NETWORK_STRIDE * x + c];
}

static float *run(const Network *network, const Planes *in, int width, int height, int threads,
                  Arena *arena) {
    Ends ends = {in, width, ARENA_NEW(arena, float, (size_t)(3 * width * height))};
    NetworkPicture picture = {width, height, &ends, fill_row, take_row};
    network_run(network, &picture, threads, *arena);
    return ends.out;
}

/* Beyond the used part its last row and column go on. */
static Planes random_planes(int width, int height, int used_width, int used_height, Arena *arena) {
    Planes in = planes_of(width, height, NETWORK_INPUTS, arena);
    uint32_t random = 5;
    for (int c = 0; c < NETWORK_INPUTS; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                int v = y < used_height ? y : used_height - 1;
                int u = x < used_width ? x : used_width - 1;
                *plane_at(&in, c, y, x) =
                    u == x && v == y ? (float)uniform(&random) : *plane_at(&in, c, v, u);
            }
    return in;
}

static Network shipped_network(Arena *arena) {
    Network network;
    FileBytes bytes = shipped_weights(arena);
    WeightFile file = {bytes.data, bytes.size, "w"};
    assert_done(network_read(&file, arena, &network, &err));
    return network;
}

/* Wide, high enough that every row's memory is used again, and of sides that are no multiple of
 * 16. */
ARENA_TEST(the_network_is_what_its_table_says) {
    const Network network = shipped_network(&arena);
    const int sizes[][4] = {{48, 32, 48, 32}, {16, 272, 16, 272}, {48, 32, 35, 19}, {16, 16, 1, 1}};
    for (int k = 0; k < 4; k++) {
        const int *s = sizes[k];
        Arena scratch = arena;
        Planes in = random_planes(s[0], s[1], s[2], s[3], &scratch);
        Planes truth = evaluated(&network, &in, &scratch);
        float *out = run(&network, &in, s[2], s[3], 2, &scratch);
        for (int y = 0; y < s[3]; y++)
            for (int x = 0; x < s[2]; x++)
                for (int c = 0; c < 3; c++)
                    assert_near(out[(y * s[2] + x) * 3 + c], *plane_at(&truth, c, y, x), 2e-5);
    }
}

ARENA_TEST(threads_do_not_change_a_bit) {
    const Network network = shipped_network(&arena);
    Planes in = random_planes(80, 128, 80, 128, &arena);
    const float *one = run(&network, &in, 80, 128, 1, &arena);
    for (int threads = 2; threads < 8; threads += 3)
        assert_memory_equal(run(&network, &in, 80, 128, threads, &arena), one, 80 * 128 * 12);
}

/* Every build of the convolution that this processor has, against the one for all of them. */
ARENA_TEST(instruction_sets_do_not_change_a_bit) {
    enum { INPUTS = 48, OUTPUTS = 32, LONG = 45 };
    enum { ROW = (LONG + 2 + CONVOLUTION_SLACK) * INPUTS };
    float *rows = arena_alloc(&arena, sizeof *rows, 64, 3 * ROW);
    float *weights = arena_alloc(&arena, sizeof *weights, 64, 9 * INPUTS * 16 + 16);
    float *out[CONVOLUTION_BUILDS];
    Convolve *builds[CONVOLUTION_BUILDS];
    int count = convolution_builds(builds);
    uint32_t random = 8;
    assert_ptr_equal(builds[count - 1], convolve);
    for (int i = 0; i < 3 * ROW; i++) rows[i] = (float)uniform(&random);
    for (int i = 0; i < 9 * INPUTS * 16 + 16; i++) weights[i] = (float)uniform(&random) - 0.5f;
    for (int k = count - 1; k >= 0; k--) {
        out[k] = arena_alloc(&arena, sizeof **out, 64, (LONG + 1) * OUTPUTS);
        ConvolutionRow row = {
            rows,        rows + ROW, rows + 2 * ROW, weights, weights + 9 * INPUTS * 16,
            out[k] + 16, LONG,       INPUTS,         OUTPUTS};
        builds[k](&row);
        assert_memory_equal(out[k], out[count - 1], (LONG + 1) * OUTPUTS * sizeof **out);
    }
    for (int i = 0; i < 16; i++) /* the other group and what lies behind the row */
        assert_true(out[0][i] == 0 && out[0][LONG * OUTPUTS + i] == 0);
}

/* ---- the file ---------------------------------------------------------------------------- */

static bool network_of(const unsigned char *bytes, size_t size, Arena arena) {
    Network network;
    return network_read(&(WeightFile){bytes, size, "w.tza"}, &arena, &network, &failure);
}

/* Where the table begins: bytes 4 to 11. */
static size_t table_of(FileBytes bytes) {
    size_t at = 0;
    for (int i = 7; i >= 0; i--) at = at << 8 | bytes.data[4 + i];
    return at;
}

ARENA_TEST(every_prefix_of_the_table_is_refused) {
    FileBytes bytes = shipped_weights(&arena);
    const size_t table = table_of(bytes), length = bytes.size - table;
    unsigned char *copy = ARENA_NEW(&arena, unsigned char, bytes.size);
    memcpy(copy, bytes.data, bytes.size);
    assert_true(network_of(copy, bytes.size, arena));
    for (size_t size = 0; size < 12; size++) {
        assert_false(network_of(copy, size, arena));
        assert_string_equal(failure.file, "w.tza");
        assert_int_equal(failure.code, ERROR_INPUT);
    }
    for (size_t left = 0; left < length; left++) {
        assert_false(network_of(copy, table + left, arena));
        assert_non_null(strstr(failure.text, "ends at byte"));
    }
}

/* Any byte of head and table set to any of some values: read or refused in one line. */
ARENA_TEST(no_damaged_table_is_read_past_its_end) {
    FileBytes bytes = shipped_weights(&arena);
    unsigned char *copy = ARENA_NEW(&arena, unsigned char, bytes.size);
    const unsigned char values[] = {0, 1, 0x7f, 0xff};
    memcpy(copy, bytes.data, bytes.size);
    int refused = 0;
    for (size_t at = table_of(bytes); at < bytes.size; at += 3)
        for (int k = 0; k < 4; k++) {
            copy[at] = values[k];
            refused += !network_of(copy, bytes.size, arena);
            copy[at] = bytes.data[at];
        }
    assert_true(refused > 800);
}

/* Replaces what stands once in the table. */
static const char *refusal(Arena arena, const char *from, const char *to, int length) {
    FileBytes bytes = shipped_weights(&arena);
    unsigned char *copy = ARENA_NEW(&arena, unsigned char, bytes.size);
    memcpy(copy, bytes.data, bytes.size);
    for (size_t at = table_of(bytes); at + (size_t)length <= bytes.size; at++)
        if (!memcmp(copy + at, from, (size_t)length)) {
            memcpy(copy + at, to, (size_t)length);
            break;
        }
    assert_false(network_of(copy, bytes.size, arena));
    return failure.text;
}

ARENA_TEST(wrong_weights_are_named) {
    FileBytes bytes = shipped_weights(&arena);
    unsigned char *copy = ARENA_NEW(&arena, unsigned char, bytes.size);
    assert_non_null(strstr(refusal(arena, "enc_conv2.weight", "enc_conv9.weight", 16),
                           "this network has no such tensor"));
    assert_string_equal(failure.path, "enc_conv9.weight");
    assert_non_null(
        strstr(refusal(arena, "dec_conv4b.bias", "dec_conv4a.bias", 15), "stands there twice"));
    assert_non_null(strstr(refusal(arena, "oihwh", "oihwq", 5), "of type \"q\""));
    assert_non_null(strstr(refusal(arena, "oihwh", "ohiwh", 5), "required: oihw with 32"));
    memcpy(copy, bytes.data, bytes.size);
    copy[65] = 0x7e; /* a NaN among the first weights */
    assert_false(network_of(copy, bytes.size, arena));
    assert_string_equal(failure.text, "number 0 is not finite");
    copy[0] = 1;
    assert_false(network_of(copy, bytes.size, arena));
    assert_non_null(strstr(failure.text, "required: 0x41d7"));
    memcpy(copy, bytes.data, bytes.size);
    copy[2] = 3;
    assert_false(network_of(copy, bytes.size, arena));
    assert_string_equal(failure.text, "version 3.0; required: 2");
}

/* ---- frames ------------------------------------------------------------------------------ */

static float *plane(FrameImage *frame, const char *name, Arena *arena) {
    const float *found = frame_channel(frame, name);
    return found ? (float *)(uintptr_t)found : frame_add_channel(frame, name, false, arena);
}

static void set(FrameImage *frame, const char *layer, const char *letters, float value,
                Arena *arena) {
    for (; *letters; letters++) {
        const char *name = arena_format(arena, "%s%s%c", layer, *layer ? "." : "", *letters);
        float *values = plane(frame, name, arena);
        for (size_t i = 0; i < frame_pixel_count(frame); i++) values[i] = value;
    }
}

/* A grey wall of 100 cd/m2 that faces the eye. */
static FrameImage wall(int width, int height, ExrWindow data, Arena *arena) {
    FrameImage frame = frame_create(width, height, data, 24, 4, arena);
    set(&frame, "", "RGB", 100, arena);
    set(&frame, "normal", "XY", 0, arena);
    set(&frame, "normal", "Z", 1, arena);
    set(&frame, "albedo", "RGB", 0.5f, arena);
    set(&frame, "display.emitted", "RGB", NAN, arena);
    set(&frame, "display.fine", "RGB", NAN, arena);
    float *coverage = plane(&frame, "display.coverage", arena);
    for (size_t i = 0; i < frame_pixel_count(&frame); i++) coverage[i] = 0;
    return frame;
}

static FrameImage whole_wall(Arena *arena) {
    return wall(WIDTH, HEIGHT, (ExrWindow){0, 0, WIDTH, HEIGHT}, arena);
}

static FrameImage denoised(const FrameImage *frame, DenoiseReport *report, Arena *arena) {
    FrameImage out;
    assert_done(denoise_frame(frame, 2, arena, &out, report, &err));
    assert_memory_equal(&out.data, &frame->data, sizeof out.data);
    assert_memory_equal(&out.display, &frame->display, sizeof out.display);
    return out;
}

static const float *green(const FrameImage *frame) {
    return frame_channel(frame, "G");
}

/* Each pixel the mean of a few exponentially distributed samples. */
static void make_noisy(FrameImage *frame, Arena *arena) {
    uint32_t state = 7;
    for (const char *c = "R\0G\0B\0"; *c; c += 2) {
        float *light = plane(frame, c, arena);
        for (size_t i = 0; i < frame_pixel_count(frame); i++) {
            double sum = 0;
            for (int k = 0; k < SAMPLES; k++) sum -= log(1 - uniform(&state));
            light[i] *= (float)(sum / SAMPLES);
        }
    }
}

static double spread(const float *values, double *mean) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < COUNT; i++) {
        sum += (double)values[i];
        squares += (double)values[i] * (double)values[i];
    }
    *mean = sum / COUNT;
    return sqrt(squares / COUNT - *mean * *mean) / *mean;
}

ARENA_TEST(noise_goes_and_light_stays) {
    DenoiseReport report;
    double before, after;
    const float levels[] = {0.01f, 100, 1e5f};
    for (int k = 0; k < 6; k++) {
        FrameImage frame = whole_wall(&arena);
        set(&frame, "", "RGB", levels[k / 2], &arena);
        if (k % 2) { /* sky */
            set(&frame, "normal", "XYZ", NAN, &arena);
            set(&frame, "albedo", "RGB", NAN, &arena);
        }
        make_noisy(&frame, &arena);
        FrameImage out = denoised(&frame, &report, &arena);
        double noisy = spread(green(&frame), &before), left = spread(green(&out), &after);
        print_message("%g cd/m2: noise %.3f, left %.4f, light %.4f\n", (double)levels[k / 2], noisy,
                      left, report.energy_ratio);
        assert_true(noisy > 0.45 && left < 0.1 * noisy);
        assert_close(report.energy_ratio, 1, 0.0085);
        assert_true(report.block_error < 0.0085);
        assert_true(report.left_share == 0);
    }
}

/* The exposure follows the light: what is k times as bright comes back k times as bright. */
ARENA_TEST(the_unit_of_light_does_not_matter) {
    DenoiseReport report;
    FrameImage frame = whole_wall(&arena), brighter = whole_wall(&arena);
    set(&brighter, "", "RGB", 25600, &arena);
    make_noisy(&frame, &arena);
    make_noisy(&brighter, &arena);
    FrameImage out = denoised(&frame, &report, &arena);
    FrameImage bright = denoised(&brighter, &report, &arena);
    for (size_t i = 0; i < COUNT; i++) assert_close(green(&bright)[i], 256 * green(&out)[i], 1e-3);
}

ARENA_TEST(suns_and_what_is_not_finite_stay_bit_for_bit) {
    DenoiseReport report;
    FrameImage frame = whole_wall(&arena);
    make_noisy(&frame, &arena);
    float *light = plane(&frame, "G", &arena);
    float before[COUNT];
    light[70] = NAN, light[COUNT / 2] = INFINITY, light[COUNT - 1] = -INFINITY;
    light[COUNT / 3] = 1e9f; /* beyond the network's range */
    memcpy(before, light, sizeof before);
    FrameImage out = denoised(&frame, &report, &arena);
    const size_t single[] = {70, COUNT / 2, COUNT - 1, COUNT / 3};
    for (int k = 0; k < 4; k++)
        assert_memory_equal(&green(&out)[single[k]], &before[single[k]], sizeof *before);
    assert_close(report.left_share, 4.0 / COUNT, 1e-9);
    for (size_t i = 0; i < COUNT; i++)
        if (i != 70) assert_false(isnan(green(&out)[i])); /* nothing spread */
}

/* What displays show goes around the filter: a change of it comes out as it went in. */
ARENA_TEST(the_displays_own_light_is_never_filtered) {
    DenoiseReport report;
    FrameImage frame = whole_wall(&arena), shown = whole_wall(&arena);
    uint32_t random = 4;
    set(&frame, "", "RGB", 0, &arena); /* displays alone, nothing reflected */
    set(&shown, "", "RGB", 0, &arena);
    for (int k = 0; k < 2; k++) {
        FrameImage *f = k ? &shown : &frame;
        set(f, "display.emitted", "RGB", 50, &arena);
        float *coverage = plane(f, "display.coverage", &arena);
        for (size_t i = 0; i < COUNT; i++) coverage[i] = 1;
        set(f, "", "RGB", 50, &arena);
        set(f, "display.fine", "RGB", 0, &arena);
    }
    float *fine = plane(&shown, "display.fine.G", &arena);
    for (size_t i = 0; i < COUNT; i++) fine[i] = (float)(400 * uniform(&random));
    FrameImage without = denoised(&frame, &report, &arena);
    FrameImage with = denoised(&shown, &report, &arena);
    for (size_t i = 0; i < COUNT; i++) {
        float expected = green(&without)[i] + fine[i];
        assert_true(green(&with)[i] == expected);
        assert_true(green(&without)[i] < 0.05f); /* the rest is nothing */
    }
}

/* A lamp of one pixel on a dark wall: what it sends itself goes around the filter. Without that
 * layer it is spread. */
ARENA_TEST(a_lamp_that_is_seen_keeps_its_light) {
    enum { LAMP = HEIGHT / 2 * WIDTH + WIDTH / 2 };
    DenoiseReport report;
    FrameImage dark = whole_wall(&arena);
    set(&dark, "", "RGB", 1, &arena);
    FrameImage plain = denoised(&dark, &report, &arena);
    for (const char *c = "R\0G\0B\0"; *c; c += 2) plane(&dark, c, &arena)[LAMP] += 3000;
    assert_true(green(&(FrameImage[]){denoised(&dark, &report, &arena)}[0])[LAMP] < 2500);
    set(&dark, "emitted", "RGB", 0, &arena);
    for (const char *c = "R\0G\0B\0"; *c; c += 2)
        plane(&dark, arena_format(&arena, "emitted.%s", c), &arena)[LAMP] = 3000;
    FrameImage lit = denoised(&dark, &report, &arena);
    assert_close(green(&lit)[LAMP], 3001, 1e-3);
    assert_close(green(&lit)[LAMP + 1], green(&plain)[LAMP + 1], 1e-3);
    assert_close(report.energy_ratio, 1, 0.0085);
}

/* A reflection's edge in a display, without noise: 10 % to 90 % of the step within 2 pixels. */
ARENA_TEST(a_reflections_edge_is_softened_by_this_much) {
    DenoiseReport report;
    FrameImage frame = whole_wall(&arena);
    set(&frame, "display.emitted", "RGB", 20, &arena);
    set(&frame, "display.fine", "RGB", 20, &arena);
    float *coverage = plane(&frame, "display.coverage", &arena);
    for (size_t i = 0; i < COUNT; i++) {
        coverage[i] = 1;
        for (const char *c = "R\0G\0B\0"; *c; c += 2)
            plane(&frame, c, &arena)[i] = 20 + (i % WIDTH < WIDTH / 2 ? 10.0f : 40.0f);
    }
    FrameImage out = denoised(&frame, &report, &arena);
    const float *row = green(&out) + HEIGHT / 2 * WIDTH;
    int between = 0;
    for (int x = 0; x < WIDTH; x++) between += row[x] > 33 && row[x] < 57;
    print_message("edge of a reflection: %d pixels between 10 and 90 %%\n", between);
    assert_true(between <= 2);
    assert_close(row[WIDTH / 4], 30, 0.02);
    assert_close(row[3 * WIDTH / 4], 60, 0.02);
}

/* A fine texture, and the frame says by `halves` how noisy it is: not at all, so that it comes
 * back; as noisy as that; or nothing, and the network has the last word. */
ARENA_TEST(what_the_frame_shows_beyond_its_noise_comes_back) {
    DenoiseReport report;
    const float noise[] = {0, 20, NAN};
    double error[3];
    for (int k = 0; k < 3; k++) {
        FrameImage frame = whole_wall(&arena);
        uint32_t random = 5;
        for (size_t i = 0; i < COUNT; i++) {
            const float light = uniform(&random) < 0.5 ? 90 : 110;
            for (const char *c = "R\0G\0B\0"; *c; c += 2) plane(&frame, c, &arena)[i] = light;
        }
        set(&frame, "halves", "RGB", noise[k], &arena);
        FrameImage out = denoised(&frame, &report, &arena);
        error[k] = 0;
        for (size_t i = 0; i < COUNT; i++)
            error[k] += fabs((double)(green(&out)[i] - green(&frame)[i])) / COUNT;
    }
    print_message("off by %.3g, %.3g, %.3g of 10 cd/m2\n", error[0], error[1], error[2]);
    assert_true(error[0] < 0.1 && error[2] > 5);
    assert_close(error[1], error[2], 1e-6);
}

ARENA_TEST(small_frames_and_crops_are_filtered) {
    DenoiseReport report;
    const ExrWindow windows[] = {
        {0, 0, 1, 1}, {0, 0, 1, 40}, {3, 2, 40, 3}, {30, 20, 66, 49}, {-5, -5, 30, 30}};
    for (int k = 0; k < 5; k++) {
        FrameImage frame = wall(WIDTH, HEIGHT, windows[k], &arena);
        FrameImage out = denoised(&frame, &report, &arena);
        for (size_t i = 0; i < frame_pixel_count(&frame); i++)
            assert_close(green(&out)[i], 100, 0.25);
    }
}

ARENA_TEST(missing_layers_are_named) {
    FrameImage frame = frame_create(2, 2, (ExrWindow){0, 0, 2, 2}, 8, 0, &arena), out;
    DenoiseReport report;
    set(&frame, "", "RGB", 1, &arena);
    set(&frame, "depth", "Z", 1, &arena);
    assert_false(denoise_frame(&frame, 1, &arena, &out, &report, &failure));
    assert_int_equal(failure.code, ERROR_INPUT);
    assert_string_equal(
        failure.text,
        "lacks what --denoise requires (missing: normal, albedo, "
        "display.emitted, display.coverage) — render it with --layers " DENOISE_LAYERS);
}

TEST_PROGRAM(make_arena, drop_arena)
