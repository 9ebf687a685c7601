/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_state.h"

#include <assert.h>
#include <string.h>

#include "film/film_add.h"
#include "film/pixels.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the lower bytes come first");

/* Numbers of a pixel with all layers. */
#define MOST_NUMBERS (sizeof(PixelSums) / sizeof(Fixed) + 4 * SUMS_COUNT + 3 * FILM_LIGHTS_MAX)

__extension__ typedef unsigned __int128 Bits;

size_t film_pixel_bytes(const Film *film) {
    return film->stride;
}

static size_t number_count(const Film *film) {
    return film->stride / sizeof(Fixed);
}

static size_t row_pixels(const Film *film) {
    return (size_t)(film->crop.x1 - film->crop.x0);
}

size_t film_packed_bytes_max(const Film *film) {
    return number_count(film) + row_pixels(film) * film->stride;
}

static const Fixed *gather_row(const Film *film, int y, Arena *scratch) {
    Fixed *row = ARENA_NEW(scratch, Fixed, row_pixels(film) * number_count(film));
    film_gather(film, film_index(film, film->crop.x0, y), row_pixels(film), row);
    return row;
}

/* ---- packing ----------------------------------------------------------------------------- */

/* Bytes that hold a number whose bits differ from its sign only in those of `bits`. */
static int width_of(Bits bits) {
    int width = 1;
    while (width < 16 && bits >> (8 * width - 1)) width++;
    return width;
}

/* For every number of a pixel: its width in this row. */
static void find_widths(const Fixed *row, size_t pixels, size_t numbers, unsigned char *widths) {
    for (size_t n = 0; n < numbers; n++) {
        Bits magnitude = 0, any = 0;
        for (size_t i = 0; i < pixels; i++) {
            Fixed value = row[i * numbers + n];
            magnitude |= (Bits)(value ^ (value >> 127));
            any |= (Bits)value;
        }
        widths[n] = (unsigned char)(any ? width_of(magnitude) : 0);
    }
}

size_t film_packed_bytes(const Film *film, int y, Arena scratch) {
    unsigned char widths[MOST_NUMBERS];
    size_t numbers = number_count(film), pixels = row_pixels(film), bytes = numbers;
    assert(numbers <= MOST_NUMBERS);
    find_widths(gather_row(film, y, &scratch), pixels, numbers, widths);
    for (size_t n = 0; n < numbers; n++) bytes += widths[n] * pixels;
    return bytes;
}

size_t film_pack_row(const Film *film, int y, unsigned char *out, Arena scratch) {
    size_t numbers = number_count(film), pixels = row_pixels(film);
    const Fixed *row = gather_row(film, y, &scratch);
    unsigned char *next = out + numbers;
    find_widths(row, pixels, numbers, out);
    for (size_t n = 0; n < numbers; n++)
        for (size_t i = 0; i < pixels; i++, next += out[n])
            memcpy(next, &row[i * numbers + n], out[n]);
    return (size_t)(next - out);
}

/* ---- and back ---------------------------------------------------------------------------- */

static bool damaged(int y, Error *err) {
    return error_set(err, ERROR_INPUT, "damaged sums: row %d is not as a film packs it", y);
}

static Fixed number_of(const unsigned char *bytes, int width) {
    Bits value = 0;
    if (!width) return 0;
    memcpy(&value, bytes, (size_t)width);
    int free_bits = 8 * (16 - width);
    return (Fixed)(value << free_bits) >> free_bits;
}

bool film_unpack_row(Film *film, int y, PackedRow packed, uint32_t most_samples, Arena scratch,
                     Error *err) {
    const unsigned char *widths = packed.bytes;
    size_t numbers = number_count(film), pixels = row_pixels(film), wanted = numbers;
    if (packed.size < numbers) return damaged(y, err);
    for (size_t n = 0; n < numbers; n++) {
        if (widths[n] > sizeof(Fixed)) return damaged(y, err);
        wanted += widths[n] * pixels;
    }
    if (packed.size != wanted) return damaged(y, err);
    Fixed *row = ARENA_NEW(&scratch, Fixed, numbers * pixels);
    const unsigned char *next = widths + numbers;
    for (size_t n = 0; n < numbers; n++)
        for (size_t i = 0; i < pixels; i++, next += widths[n])
            row[i * numbers + n] = number_of(next, widths[n]);
    FilmRect rect = {film->crop.x0, y, film->crop.x1, y + 1};
    return film_add_pixels(film, rect, row, most_samples, err);
}
