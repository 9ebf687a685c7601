/* SPDX-License-Identifier: Apache-2.0 */
/* film_state.h -- rows of the film's exact sums as packed bytes, and back.
 *
 * A pixel is a row of 16-byte numbers (pixels.h), most of whose upper bytes repeat their sign.
 * A packed row holds, for each number of a pixel in turn, how many lower bytes the largest of
 * the row's pixels needs, and then those bytes of all pixels: half of the sums' size, for less
 * time than it takes to write the other half.
 *
 *     widths   one byte a number, 0 to 16
 *     columns  for each number: its lower `width` bytes of every pixel, left to right
 *
 * Layout   the machine's own byte order and PixelSums: film_pixel_bytes and the layers decide
 *          whether another program's rows can be meant for this one.
 * Memory   the caller's.  Threads  one film belongs to one thread.
 * Fails    on rows that no film packs, and on sums that no samples make.
 */
#pragma once
#include "base/error.h"
#include "film/film.h"

/* Bytes of a pixel's sums, not packed. */
size_t film_pixel_bytes(const Film *film);

/* Bytes of a row at most, packed. */
size_t film_packed_bytes_max(const Film *film);

/* y: a row of the crop. Bytes that it will take. */
size_t film_packed_bytes(const Film *film, int y, Arena scratch);

/* Returns how many bytes of `out` were filled. */
size_t film_pack_row(const Film *film, int y, unsigned char *out, Arena scratch);

typedef struct PackedRow {
    const unsigned char *bytes;
    size_t size;
} PackedRow;

/* Adds a packed row, which came from a film of the same crop and layers, to an empty row.
 * most_samples: what a pixel of it may hold. After a failure the film is worth nothing. */
bool film_unpack_row(Film *film, int y, PackedRow packed, uint32_t most_samples, Arena scratch,
                     Error *err);
