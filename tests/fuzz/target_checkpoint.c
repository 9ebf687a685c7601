/* Checkpoints: what a render goes on from. */
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "cli/render_identity.h"
#include "harness.h"
#include "render/checkpoint.h"

/* Of the head (checkpoint.c): magic, byte order and version, then how long the file is. */
enum { AT_FILE_BYTES = 16, LEAST_BYTES = 240 };
static const uint8_t begin[AT_FILE_BYTES] = {
    'P', 'R', 'H', 'L', 'C', 'K', 'P', 'T', 4, 3, 2, 1, CHECKPOINT_VERSION};

/* The checksum would keep everything from the reader: most changes get the right one. */
size_t fuzz_mutate_checkpoint(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    uint64_t state = seed, bytes, checksum;
    if (fuzz_random(&state) % 4)
        fuzz_mutate_places(data, size, fuzz_random(&state));
    else
        size = fuzz_mutate_bytes(data, size, max_size);
    if (size < LEAST_BYTES || fuzz_random(&state) % 16 == 0) return size;
    bytes = size;
    memcpy(data, begin, sizeof begin);
    memcpy(data + AT_FILE_BYTES, &bytes, sizeof bytes);
    checksum = XXH3_64bits(data, size - sizeof checksum);
    memcpy(data + size - sizeof checksum, &checksum, sizeof checksum);
    return size;
}

void fuzz_checkpoint(const uint8_t *data, size_t size, Arena *arena)
{
    const FilmRect crop = {1, 2, 6, 5};
    const FilmPart wanted = {.crop = crop, .first_sample = 3, .end_sample = FILM_SAMPLES_MAX};
    Error          err = {0};
    Checkpoint     found;
    Film          *film = film_create(7, 5, crop, 0, arena);
    FilmWorst      worst[4];
    if (!checkpoint_open(fuzz_file("a.checkpoint", data, size, arena), arena, &found, &err) ||
        !checkpoint_fits(&found, &wanted, &err) ||
        !checkpoint_load(&found, film, *arena, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    render_identity_difference(found.identity, "version\t1\nseed\t9\n", arena);
    render_identity_difference("version\t1\nseed\t9\n", found.identity, arena);
    uint32_t samples = found.done.end_sample - found.done.first_sample;
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++)
            fuzz_claim(film_pixel(film, x, y).samples <= samples, "no pixel has more samples");
    fuzz_claim(film_worst_pixels(film, 4, worst) == 4, "four of fifteen pixels are the worst");
    film_to_frame(film, 0, arena);
}
