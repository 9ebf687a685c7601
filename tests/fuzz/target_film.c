/* SPDX-License-Identifier: Apache-2.0 */
/* What a render leaves for another: a checkpoint, a part of a frame. Sums that are taken are
 * such as samples make. */
#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "film/film_add.h"
#include "film/film_frame.h"
#include "film/film_merge.h"
#include "harness.h"
#include "render/checkpoint.h"
#include "render/identity.h"

#define FILM_BYTES_MAX ((size_t)1 << 24) /* the program compares with the machine's memory */

static Film *film_of(const FilmPart *part, Arena *arena) {
    fuzz_claim(part->crop.x0 >= 0 && part->crop.x0 < part->crop.x1 &&
                   part->crop.x1 <= part->width && part->crop.y0 >= 0 &&
                   part->crop.y0 < part->crop.y1 && part->crop.y1 <= part->height,
               "a film's crop lies in the frame");
    fuzz_claim(part->first_sample <= part->end_sample, "samples are a range");
    if (film_bytes(part->crop, part->layers, part->lights.count) > FILM_BYTES_MAX) return NULL;
    return film_create(part->width, part->height, part->crop, part->layers, &part->lights, arena);
}

static void claim_film(const Film *film, const FilmPart *part, Arena *arena) {
    for (int y = part->crop.y0; y < part->crop.y1; y++)
        for (int x = part->crop.x0; x < part->crop.x1; x++) {
            FilmPixel pixel = film_pixel(film, x, y);
            fuzz_claim(pixel.samples <= part->end_sample - part->first_sample,
                       "a pixel has no more samples than were taken");
            for (int c = 0; c < 3; c++)
                fuzz_claim(isfinite(pixel.mean_xyz[c]), "a pixel's mean is finite");
        }
    FilmWorst worst[4];
    film_relative_error(film);
    film_worst_pixels(film, 4, worst);
    film_to_frame(film, 0, arena);
}

/* ---- checkpoints ------------------------------------------------------------------------- */

/* Of the head (checkpoint.c): magic, byte order and version, then how long the file is. */
enum { AT_FILE_BYTES = 16, LEAST_BYTES = 240 };
static const uint8_t begin[AT_FILE_BYTES] = {
    'P', 'R', 'H', 'L', 'C', 'K', 'P', 'T', 4, 3, 2, 1, CHECKPOINT_VERSION};

/* The checksum would keep everything from the reader: most changes get the right one. */
size_t fuzz_mutate_checkpoint(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    uint64_t state = seed, bytes, checksum;
    if (fuzz_random(&state) % 4) fuzz_mutate_places(data, size, fuzz_random(&state));
    else size = fuzz_mutate_bytes(data, size, max_size);
    if (size < LEAST_BYTES || fuzz_random(&state) % 16 == 0) return size;
    bytes = size;
    memcpy(data, begin, sizeof begin);
    memcpy(data + AT_FILE_BYTES, &bytes, sizeof bytes);
    checksum = XXH3_64bits(data, size - sizeof checksum);
    memcpy(data + size - sizeof checksum, &checksum, sizeof checksum);
    return size;
}

void fuzz_checkpoint(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Checkpoint found;
    const char *path = fuzz_file("a.checkpoint", data, size, arena);
    checkpoint_is_there(path);
    if (!checkpoint_open(path, arena, &found, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    identity_difference(found.identity, "version\t1\nseed\t9\n", arena);
    identity_difference("version\t1\nseed\t9\n", found.identity, arena);
    if (!checkpoint_fits(&found, &found.done, &err)) fuzz_claim_refusal(&err);
    Film *film = film_of(&found.done, arena);
    if (!film) return;
    if (checkpoint_load(&found, film, *arena, &err)) claim_film(film, &found.done, arena);
    else fuzz_claim_refusal(&err);
}

/* ---- parts of a frame -------------------------------------------------------------------- */

/* Of one sample a pixel or some, with few layers or with all. */
size_t fuzz_make_part(uint8_t *data, size_t max_size, unsigned number, Arena *arena) {
    static const unsigned layers[] = {0, LAYER_VARIANCE, LAYER_DEPTH | LAYER_NORMAL, LAYER_ALL};
    Error err = {0};
    FileBytes bytes;
    const char *path = fuzz_path("made.exr", arena), *const names[] = {"lamp"};
    const FilmLights lights = {1, names};
    if (number > 3) return 0;
    Film *film = film_create(4, 3, (FilmRect){1, 0, 4, 2}, layers[number], &lights, arena);
    for (uint32_t i = 0; i < 1 + number; i++)
        for (int at = 0; at < 6; at++) {
            FilmSample sample = {.sample_index = i, .xyz = {1, 2, 3}, .hit = true, .depth = 2};
            film_add_sample(film, 1 + at % 3, at / 3, &sample);
        }
    FrameImage frame = film_to_frame(film, 0, arena);
    const FilmPart part = film_part_of(film, 0, 1 + number);
    film_part_attach(&frame, film, &part, arena);
    fuzz_claim(frame_write(path, &frame, &err) && file_read(path, max_size, arena, &bytes, &err),
               "a part can be written");
    memcpy(data, bytes.data, bytes.size);
    return bytes.size;
}

void fuzz_part(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    FilmPartReader from;
    const char *path = fuzz_file("part.exr", data, size, arena);
    if (!film_part_open(path, arena, &from, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    bool ok = true;
    Film *film = film_of(&from.part, arena);
    while (film && ok && from.next_y < from.part.crop.y1)
        ok = film_part_add_band(&from, film, *arena, &err);
    if (!ok) fuzz_claim_refusal(&err);
    else if (film) claim_film(film, &from.part, arena);
    film_part_close(&from);
}
