/* SPDX-License-Identifier: Apache-2.0 */
#include "render/checkpoint.h"

#include <math.h>
#include <string.h>

#include "film/film_add.h"
#include "film/film_state.h"
#include "keep/kept.h"

/* Every member lies where its size puts it. */
typedef struct CheckpointFacts {
    int32_t width, height, crop[4];
    uint32_t layers, pixel_bytes, first_sample, end_sample, asked_end, has_features;
    uint64_t paths, camera_rays, bounce_rays, shadow_rays, dropped_count;
    double seconds;
    struct {
        uint32_t sample_index;
        int32_t x, y;
    } dropped[FILM_DROPPED_KEPT];
    uint32_t dropped_kept, zero;
} CheckpointFacts;

_Static_assert(sizeof(CheckpointFacts) == 24 + 24 + 40 + 8 + 12 * FILM_DROPPED_KEPT + 8,
               "the facts have no gaps");

static const KeptFormat format = {"PRHLCKPT", "a checkpoint", CHECKPOINT_VERSION,
                                  sizeof(CheckpointFacts)};

static CheckpointFacts facts_of(const Checkpoint *what, size_t pixel_bytes) {
    const FilmPart *done = &what->done;
    CheckpointFacts facts = {.width = done->width,
                             .height = done->height,
                             .crop = {done->crop.x0, done->crop.y0, done->crop.x1, done->crop.y1},
                             .layers = done->layers,
                             .pixel_bytes = (uint32_t)pixel_bytes,
                             .first_sample = done->first_sample,
                             .end_sample = done->end_sample,
                             .asked_end = done->asked_end,
                             .has_features = what->has_features,
                             .paths = done->paths,
                             .camera_rays = done->camera_rays,
                             .bounce_rays = done->bounce_rays,
                             .shadow_rays = done->shadow_rays,
                             .seconds = what->seconds,
                             .dropped_count = done->dropped.count,
                             .dropped_kept = (uint32_t)done->dropped.kept};
    for (int i = 0; i < done->dropped.kept; i++) {
        facts.dropped[i].sample_index = done->dropped.first[i].sample_index;
        facts.dropped[i].x = done->dropped.first[i].x;
        facts.dropped[i].y = done->dropped.first[i].y;
    }
    return facts;
}

bool checkpoint_is_there(const char *path) {
    return kept_is_there(&format, path);
}

/* ---- writing ----------------------------------------------------------------------------- */

/* Each row is preceded by its size. */
static bool add_rows(KeptWriter *writer, const Film *film, FilmRect crop, Arena scratch,
                     Error *err) {
    unsigned char *buffer =
        ARENA_NEW(&scratch, unsigned char, sizeof(uint32_t) + film_packed_bytes_max(film));
    for (int y = crop.y0; y < crop.y1; y++) {
        uint32_t size = (uint32_t)film_pack_row(film, y, buffer + sizeof size, scratch);
        memcpy(buffer, &size, sizeof size);
        if (!kept_add(writer, buffer, sizeof size + size, err)) return false;
    }
    return true;
}

static uint64_t bytes_of_rows(const Film *film, FilmRect crop, Arena scratch) {
    uint64_t bytes = 0;
    for (int y = crop.y0; y < crop.y1; y++)
        bytes += sizeof(uint32_t) + film_packed_bytes(film, y, scratch);
    return bytes;
}

bool checkpoint_write(const Checkpoint *what, const Film *film, Arena scratch, Error *err) {
    FilmRect crop = what->done.crop;
    CheckpointFacts facts = facts_of(what, film_pixel_bytes(film));
    const KeptFile file = {&format, what->path, what->identity, &facts,
                           bytes_of_rows(film, crop, scratch)};
    KeptWriter *writer;
    return kept_begin(&file, &scratch, &writer, err) &&
           add_rows(writer, film, crop, scratch, err) && kept_commit(writer, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

static bool check_facts(const KeptReader *reader, const CheckpointFacts *facts, Error *err) {
    const int32_t *crop = facts->crop;
    if (crop[0] < 0 || crop[1] < 0 || crop[0] >= crop[2] || crop[1] >= crop[3] ||
        crop[2] > facts->width || crop[3] > facts->height)
        return kept_damaged(reader, err, "its crop cannot be");
    if (facts->first_sample >= facts->end_sample || facts->end_sample > facts->asked_end ||
        facts->asked_end > FILM_SAMPLES_MAX)
        return kept_damaged(reader, err, "its range of samples cannot be");
    if (facts->dropped_kept > FILM_DROPPED_KEPT || facts->dropped_kept > facts->dropped_count)
        return kept_damaged(reader, err, "its list of dropped samples cannot be");
    return (facts->seconds >= 0 && isfinite(facts->seconds)) ||
           kept_damaged(reader, err, "its duration cannot be");
}

static Checkpoint checkpoint_of(const KeptReader *reader, const CheckpointFacts *facts) {
    Checkpoint out = {
        .path = reader->path,
        .identity = reader->identity,
        .seconds = facts->seconds,
        .has_features = facts->has_features != 0,
        .done = {.name = reader->path,
                 .width = facts->width,
                 .height = facts->height,
                 .crop = {facts->crop[0], facts->crop[1], facts->crop[2], facts->crop[3]},
                 .layers = facts->layers,
                 .first_sample = facts->first_sample,
                 .end_sample = facts->end_sample,
                 .asked_end = facts->asked_end,
                 .dropped = {.count = facts->dropped_count, .kept = (int)facts->dropped_kept},
                 .paths = facts->paths,
                 .camera_rays = facts->camera_rays,
                 .bounce_rays = facts->bounce_rays,
                 .shadow_rays = facts->shadow_rays}};
    for (int i = 0; i < out.done.dropped.kept; i++) {
        out.done.dropped.first[i].sample_index = facts->dropped[i].sample_index;
        out.done.dropped.first[i].x = facts->dropped[i].x;
        out.done.dropped.first[i].y = facts->dropped[i].y;
    }
    return out;
}

bool checkpoint_open(const char *path, Arena *arena, Checkpoint *out, Error *err) {
    KeptReader reader;
    CheckpointFacts facts;
    if (!kept_open(&format, path, &facts, arena, &reader, err)) return false;
    bool ok = check_facts(&reader, &facts, err);
    if (ok) *out = checkpoint_of(&reader, &facts);
    kept_close(&reader);
    return ok;
}

/* ---- going on ---------------------------------------------------------------------------- */

bool checkpoint_fits(const Checkpoint *checkpoint, const FilmPart *wanted, Error *err) {
    const FilmPart *done = &checkpoint->done;
    FilmRect a = done->crop, b = wanted->crop;
    if (a.x0 != b.x0 || a.y0 != b.y0 || a.x1 != b.x1 || a.y1 != b.y1)
        return error_at(err, ERROR_INPUT, checkpoint->path, "",
                        "is of other pixels: %d,%d,%d,%d there, %d,%d,%d,%d here", a.x0, a.y0, a.x1,
                        a.y1, b.x0, b.y0, b.x1, b.y1);
    if (done->first_sample != wanted->first_sample)
        return error_at(err, ERROR_INPUT, checkpoint->path, "",
                        "is of other samples: from %u there, from %u here", done->first_sample,
                        wanted->first_sample);
    return done->end_sample <= wanted->end_sample ||
           error_at(err, ERROR_INPUT, checkpoint->path, "",
                    "has samples %u:%u of every pixel already, more than the %u:%u that are "
                    "asked for — ask for %u or more",
                    done->first_sample, done->end_sample, wanted->first_sample, wanted->end_sample,
                    done->end_sample - done->first_sample);
}

static bool load_rows(KeptReader *reader, const Checkpoint *checkpoint, Film *film, Arena scratch,
                      Error *err) {
    const FilmPart *done = &checkpoint->done;
    size_t most = film_packed_bytes_max(film);
    unsigned char *row = ARENA_NEW(&scratch, unsigned char, most);
    uint32_t size;
    for (int y = done->crop.y0; y < done->crop.y1; y++) {
        if (!kept_take(reader, &size, sizeof size, err)) return false;
        if (size > most) return kept_damaged(reader, err, "its size of a row cannot be");
        if (!kept_take(reader, row, size, err)) return false;
        if (!film_unpack_row(film, y, (PackedRow){row, size}, done->end_sample - done->first_sample,
                             scratch, err))
            return error_in_file(err, reader->path);
    }
    film_add_dropped(film, &done->dropped);
    return kept_has_left(reader, 0, err);
}

/* A checkpoint that another process replaced meanwhile is of other samples. */
static bool is_same(const KeptReader *reader, const CheckpointFacts *facts,
                    const Checkpoint *checkpoint, Error *err) {
    const FilmPart *done = &checkpoint->done;
    return (!strcmp(reader->identity, checkpoint->identity) &&
            facts->first_sample == done->first_sample && facts->end_sample == done->end_sample) ||
           error_at(err, ERROR_INPUT, reader->path, "", "was replaced while it was read");
}

bool checkpoint_load(const Checkpoint *checkpoint, Film *film, Arena scratch, Error *err) {
    KeptReader reader;
    CheckpointFacts facts;
    if (!kept_open(&format, checkpoint->path, &facts, &scratch, &reader, err)) return false;
    bool done = is_same(&reader, &facts, checkpoint, err) &&
                load_rows(&reader, checkpoint, film, scratch, err);
    kept_close(&reader);
    return done;
}
