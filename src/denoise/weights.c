/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/weights.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/mathf.h"
#include "denoise/convolution.h"

enum { MAGIC = 0x41d7, VERSION = 2, DIMENSIONS_MAX = 4 };

/* ---- bytes ------------------------------------------------------------------------------- */

typedef struct Bytes {
    const unsigned char *data;
    size_t size, at;
    bool ended;
    const char *name;
} Bytes;

/* A little-endian number of 1 to 8 bytes; 0 once the file ended. */
static uint64_t take(Bytes *bytes, size_t size) {
    uint64_t value = 0;
    bytes->ended = bytes->ended || bytes->size - bytes->at < size;
    for (size_t i = 0; i < size && !bytes->ended; i++)
        value |= (uint64_t)bytes->data[bytes->at++] << 8 * i;
    return value;
}

/* The first bytes of a text of any length. */
static void take_text(Bytes *bytes, size_t length, char *out, size_t room) {
    for (size_t i = 0; i < length && !bytes->ended; i++) {
        char letter = (char)take(bytes, 1);
        if (i + 1 < room) out[i] = letter;
    }
}

static bool check_end(const Bytes *bytes, const char *what, Error *err) {
    return !bytes->ended || error_at(err, ERROR_INPUT, bytes->name, "",
                                     "ends at byte %zu, inside %s", bytes->size, what);
}

/* ---- tensors ----------------------------------------------------------------------------- */

typedef struct Tensor {
    char name[64];
    int dimensions;
    uint64_t sizes[DIMENSIONS_MAX];
    char layout[DIMENSIONS_MAX + 1], type[2];
    uint64_t offset;
} Tensor;

static bool take_tensor(Bytes *bytes, Tensor *out, Error *err) {
    Tensor tensor = {.name = ""};
    take_text(bytes, (size_t)take(bytes, 2), tensor.name, sizeof tensor.name);
    tensor.dimensions = (int)take(bytes, 1);
    if (tensor.dimensions > DIMENSIONS_MAX)
        return error_at(err, ERROR_INPUT, bytes->name, tensor.name,
                        "%d dimensions; required: at most %d", tensor.dimensions, DIMENSIONS_MAX);
    for (int i = 0; i < tensor.dimensions; i++) tensor.sizes[i] = take(bytes, 4);
    take_text(bytes, (size_t)tensor.dimensions, tensor.layout, sizeof tensor.layout);
    take_text(bytes, 1, tensor.type, sizeof tensor.type);
    tensor.offset = take(bytes, 8);
    *out = tensor;
    return check_end(bytes, "the table of tensors", err);
}

/* Half precision, IEEE 754: 1, 5 and 10 bits. */
static float from_half(unsigned half) {
    unsigned sign = half >> 15, exponent = half >> 10 & 31, fraction = half & 1023;
    float size = exponent == 0    ? (float)fraction * 0x1p-24f
                 : exponent == 31 ? (fraction ? NAN : INFINITY)
                                  : float_from_bits((exponent + 112) << 23 | fraction << 13);
    return sign ? -size : size;
}

static bool check_tensor(const Bytes *bytes, const Tensor *found, const char *layout,
                         const WeightShape *shape, Error *err) {
    uint64_t sizes[DIMENSIONS_MAX] = {(uint64_t)shape->outputs, (uint64_t)shape->inputs, 3, 3};
    uint64_t numbers = 1;
    int dimensions = (int)strlen(layout);
    bool fits = found->dimensions == dimensions && !strcmp(found->layout, layout);
    for (int i = 0; i < dimensions; i++) {
        fits = fits && found->sizes[i] == sizes[i];
        numbers *= sizes[i];
    }
    if (!fits)
        return error_at(err, ERROR_INPUT, bytes->name, found->name,
                        "%d dimensions %llu %llu %llu %llu of layout \"%s\"; required: %s "
                        "with %d outputs and %d inputs of 3x3",
                        found->dimensions, (unsigned long long)found->sizes[0],
                        (unsigned long long)found->sizes[1], (unsigned long long)found->sizes[2],
                        (unsigned long long)found->sizes[3], found->layout, layout, shape->outputs,
                        shape->inputs);
    if (strcmp(found->type, "h") != 0 && strcmp(found->type, "f") != 0)
        return error_at(err, ERROR_INPUT, bytes->name, found->name,
                        "numbers of type \"%s\"; required: h (16 bits) or f (32)", found->type);
    uint64_t needed = numbers * (found->type[0] == 'h' ? 2 : 4);
    if (found->offset > bytes->size || bytes->size - found->offset < needed)
        return error_at(err, ERROR_INPUT, bytes->name, found->name,
                        "%llu bytes of numbers from byte %llu on; the file ends at byte %zu",
                        (unsigned long long)needed, (unsigned long long)found->offset, bytes->size);
    return true;
}

/* One of a checked tensor's numbers. */
static float number_at(const Bytes *bytes, const Tensor *tensor, size_t index) {
    const bool is_half = tensor->type[0] == 'h';
    const unsigned char *at = bytes->data + tensor->offset + index * (is_half ? 2 : 4);
    if (is_half) return from_half((unsigned)at[0] | (unsigned)at[1] << 8);
    return float_from_bits((uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 |
                           (uint32_t)at[3] << 24);
}

/* ---- into the order of the convolution --------------------------------------------------- */

static int filled_up(int channels) {
    return (channels + CONVOLUTION_GROUP - 1) / CONVOLUTION_GROUP * CONVOLUTION_GROUP;
}

static bool read_numbers(const Bytes *bytes, const Tensor *tensor, const WeightShape *shape,
                         Arena *arena, const float **out, Error *err) {
    const int taps = tensor->dimensions == DIMENSIONS_MAX ? 9 : 1;
    size_t inputs = taps == 9 ? (size_t)shape->inputs : 1;
    size_t room = taps == 9 ? (size_t)filled_up(shape->inputs) : 1, group = CONVOLUTION_GROUP;
    float *numbers = arena_alloc(arena, sizeof *numbers, 64,
                                 (size_t)filled_up(shape->outputs) * room * (size_t)taps);
    for (size_t o = 0, index = 0; o < (size_t)shape->outputs; o++)
        for (size_t i = 0; i < inputs; i++)
            for (size_t tap = 0; tap < (size_t)taps; tap++, index++) {
                float value = number_at(bytes, tensor, index);
                if (!isfinite(value))
                    return error_at(err, ERROR_INPUT, bytes->name, tensor->name,
                                    "number %zu is not finite", index);
                numbers[((o / group * (size_t)taps + tap) * room + i) * group + o % group] = value;
            }
    *out = numbers;
    return true;
}

/* The convolution that a tensor belongs to, and whether it is its biases. */
static int shape_of(const char *name, const WeightShape *shapes, int count, bool *is_bias) {
    for (int s = 0; s < count; s++) {
        size_t length = strlen(shapes[s].name);
        if (strncmp(name, shapes[s].name, length) != 0) continue;
        *is_bias = !strcmp(name + length, ".bias");
        if (*is_bias || !strcmp(name + length, ".weight")) return s;
    }
    return -1;
}

static bool read_tensor(Bytes *bytes, const WeightShape *shapes, int count, Arena *arena,
                        Weights *out, Error *err) {
    Tensor tensor;
    bool is_bias = false;
    if (!take_tensor(bytes, &tensor, err)) return false;
    int s = shape_of(tensor.name, shapes, count, &is_bias);
    if (s < 0)
        return error_at(err, ERROR_INPUT, bytes->name, tensor.name,
                        "this network has no such tensor");
    const float **numbers = is_bias ? &out[s].biases : &out[s].weights;
    if (*numbers) return error_at(err, ERROR_INPUT, bytes->name, tensor.name, "stands there twice");
    return check_tensor(bytes, &tensor, is_bias ? "x" : "oihw", &shapes[s], err) &&
           read_numbers(bytes, &tensor, &shapes[s], arena, numbers, err);
}

static bool check_all(const Weights *all, const WeightShape *shapes, int count, const char *name,
                      Error *err) {
    for (int s = 0; s < count; s++)
        if (!all[s].weights || !all[s].biases)
            return error_at(err, ERROR_INPUT, name, "", "tensor %s.%s is missing", shapes[s].name,
                            all[s].weights ? "bias" : "weight");
    return true;
}

/* Up to the table, at which the reader then stands. */
static bool read_head(Bytes *bytes, Error *err) {
    unsigned magic = (unsigned)take(bytes, 2), major = (unsigned)take(bytes, 1);
    unsigned minor = (unsigned)take(bytes, 1);
    uint64_t table = take(bytes, 8);
    if (!check_end(bytes, "its head", err)) return false;
    if (magic != MAGIC)
        return error_at(err, ERROR_INPUT, bytes->name, "",
                        "begins with %#06x; required: "
                        "%#06x, weights of Open Image Denoise (.tza)",
                        magic, MAGIC);
    if (major != VERSION)
        return error_at(err, ERROR_INPUT, bytes->name, "", "version %u.%u; required: %d", major,
                        minor, VERSION);
    if (table < bytes->at || table > bytes->size)
        return error_at(err, ERROR_INPUT, bytes->name, "",
                        "its table is at byte %llu, the file ends at byte %zu",
                        (unsigned long long)table, bytes->size);
    bytes->at = (size_t)table;
    return true;
}

bool weights_read(const WeightFile *file, const WeightShape *shapes, int count, Arena *arena,
                  Weights *out, Error *err) {
    Bytes bytes = {.data = file->bytes, .size = file->size, .name = file->name};
    Weights *made = ARENA_NEW(arena, Weights, (size_t)count);
    if (!read_head(&bytes, err)) return false;
    for (uint64_t left = take(&bytes, 4); left > 0; left--)
        if (!read_tensor(&bytes, shapes, count, arena, made, err)) return false;
    if (!check_end(&bytes, "the table of tensors", err) ||
        !check_all(made, shapes, count, file->name, err))
        return false;
    memcpy(out, made, (size_t)count * sizeof *out);
    return true;
}
