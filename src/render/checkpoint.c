/* SPDX-License-Identifier: Apache-2.0 */
#include "render/checkpoint.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file_write.h"
#include "film/film_add.h"
#include "film/film_state.h"

#define MAGIC "PRHLCKPT"
#define BYTE_ORDER_MARK 0x01020304u
#define IDENTITY_MAX ((size_t)1 << 24)
#define BUFFER_BYTES ((size_t)1 << 16)

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers go out as they lie");

/* The file's first bytes; every member lies where its size puts it. */
typedef struct CheckpointHead {
    char     magic[8];
    uint32_t byte_order, version;
    uint64_t file_bytes, identity_bytes;
    int32_t  width, height, crop[4];
    uint32_t layers, pixel_bytes, first_sample, end_sample, asked_end, has_features;
    uint64_t paths, camera_rays, bounce_rays, shadow_rays, dropped_count;
    double   seconds;
    struct {
        uint32_t sample_index;
        int32_t  x, y;
    } dropped[FILM_DROPPED_KEPT];
    uint32_t dropped_kept, zero;
} CheckpointHead;

_Static_assert(sizeof(CheckpointHead) ==
                   8 + 8 + 16 + 24 + 24 + 40 + 8 + 12 * FILM_DROPPED_KEPT + 8,
               "the head has no gaps");

static CheckpointHead head_of(const Checkpoint *what, size_t pixel_bytes)
{
    const FilmPart *done = &what->done;
    CheckpointHead head = {.byte_order = BYTE_ORDER_MARK, .version = CHECKPOINT_VERSION,
                 .identity_bytes = strlen(what->identity),
                 .width = done->width, .height = done->height,
                 .crop = {done->crop.x0, done->crop.y0, done->crop.x1, done->crop.y1},
                 .layers = done->layers, .pixel_bytes = (uint32_t)pixel_bytes,
                 .first_sample = done->first_sample, .end_sample = done->end_sample,
                 .asked_end = done->asked_end, .has_features = what->has_features,
                 .paths = done->paths, .camera_rays = done->camera_rays,
                 .bounce_rays = done->bounce_rays, .shadow_rays = done->shadow_rays,
                 .seconds = what->seconds, .dropped_count = done->dropped.count,
                 .dropped_kept = (uint32_t)done->dropped.kept};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    for (int i = 0; i < done->dropped.kept; i++) {
        head.dropped[i].sample_index = done->dropped.first[i].sample_index;
        head.dropped[i].x = done->dropped.first[i].x;
        head.dropped[i].y = done->dropped.first[i].y;
    }
    return head;
}

/* NULL with errno 0: it is no regular file. Opening a pipe would wait for its writer. */
static FILE *open_file(const char *path)
{
    struct stat info;
    errno = 0;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) return NULL;
    return fopen(path, "rbe");
}

bool checkpoint_is_there(const char *path)
{
    char  magic[sizeof MAGIC - 1] = "";
    FILE *file = open_file(path);
    if (!file) return false;
    size_t got = fread(magic, 1, sizeof magic, file);
    fclose(file);
    return got == sizeof magic && !memcmp(magic, MAGIC, sizeof magic);
}

/* ---- writing ----------------------------------------------------------------------------- */

/* A file and the checksum of what was written to it. */
typedef struct CheckpointOutput {
    FileWriter   writer;
    XXH3_state_t hash;
} CheckpointOutput;

static bool add(CheckpointOutput *output, const void *bytes, size_t size, Error *err)
{
    XXH3_64bits_update(&output->hash, bytes, size);
    return file_writer_add(&output->writer, bytes, size, err);
}

/* Each row is preceded by its size. */
static bool add_rows(CheckpointOutput *output, const Film *film, FilmRect crop,
                     unsigned char *buffer, Error *err)
{
    for (int y = crop.y0; y < crop.y1; y++) {
        uint32_t size = (uint32_t)film_pack_row(film, y, buffer + sizeof size);
        memcpy(buffer, &size, sizeof size);
        if (!add(output, buffer, sizeof size + size, err)) return false;
    }
    return true;
}

static uint64_t bytes_of_rows(const Film *film, FilmRect crop)
{
    uint64_t bytes = 0;
    for (int y = crop.y0; y < crop.y1; y++)
        bytes += sizeof(uint32_t) + film_packed_bytes(film, y);
    return bytes;
}

bool checkpoint_write(const Checkpoint *what, const Film *film, Arena scratch, Error *err)
{
    CheckpointOutput         output;
    FilmRect       crop = what->done.crop;
    unsigned char *buffer = ARENA_NEW(&scratch, unsigned char,
                                      sizeof(uint32_t) + film_packed_bytes_max(film));
    CheckpointHead           head = head_of(what, film_pixel_bytes(film));
    head.file_bytes = sizeof head + head.identity_bytes + bytes_of_rows(film, crop) +
                      sizeof(uint64_t);
    XXH3_64bits_reset(&output.hash);
    if (!file_writer_open(what->path, &output.writer, err) ||
        !add(&output, &head, sizeof head, err) ||
        !add(&output, what->identity, head.identity_bytes, err) ||
        !add_rows(&output, film, crop, buffer, err))
        return false;
    uint64_t checksum = XXH3_64bits_digest(&output.hash);
    return file_writer_add(&output.writer, &checksum, sizeof checksum, err) &&
           file_writer_commit(&output.writer, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

/* A file and the checksum of what was taken from it. */
typedef struct Input {
    FILE        *file;
    const char  *path;
    XXH3_state_t hash;
} Input;

static bool open_input(const char *path, Input *input, Error *err)
{
    input->path = path;
    input->file = open_file(path);
    if (!input->file && !errno)
        return error_at(err, ERROR_INPUT, path, "", "is not a checkpoint");
    if (!input->file)
        return error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(errno));
    XXH3_64bits_reset(&input->hash);
    return true;
}

static bool take(Input *input, void *bytes, size_t size, Error *err)
{
    errno = 0;
    if (fread(bytes, 1, size, input->file) == size) {
        XXH3_64bits_update(&input->hash, bytes, size);
        return true;
    }
    return error_at(err, ERROR_INPUT, input->path, "", "cannot be read: %s",
                    errno ? strerror(errno) : "it ended while it was read");
}

/* Takes the bytes for their checksum alone. */
static bool skip(Input *input, uint64_t bytes, Arena scratch, Error *err)
{
    unsigned char *buffer = ARENA_NEW(&scratch, unsigned char, BUFFER_BYTES);
    while (bytes) {
        size_t part = bytes < BUFFER_BYTES ? (size_t)bytes : BUFFER_BYTES;
        if (!take(input, buffer, part, err)) return false;
        bytes -= part;
    }
    return true;
}

static bool check_sum(Input *input, Error *err)
{
    uint64_t found = XXH3_64bits_digest(&input->hash), wanted;
    if (!take(input, &wanted, sizeof wanted, err)) return false;
    return found == wanted ||
           error_at(err, ERROR_INPUT, input->path, "",
                    "is damaged: its bytes have the checksum %016llx, required: %016llx",
                    (unsigned long long)found, (unsigned long long)wanted);
}

static bool damaged_head(const char *path, const char *what, Error *err)
{
    return error_at(err, ERROR_INPUT, path, "", "is damaged: its %s cannot be", what);
}

/* Checks first what decides the meaning of every other byte: magic, byte order, version. */
static bool check_kind(const Input *input, const CheckpointHead *head, size_t got, Error *err)
{
    if (got < sizeof head->magic || memcmp(head->magic, MAGIC, sizeof head->magic) != 0)
        return error_at(err, ERROR_INPUT, input->path, "", "is not a checkpoint");
    if (got < sizeof *head)
        return error_at(err, ERROR_INPUT, input->path, "",
                        "is cut off: has %zu bytes, its head alone %zu", got, sizeof *head);
    if (head->byte_order != BYTE_ORDER_MARK)
        return error_at(err, ERROR_INPUT, input->path, "",
                        "is a checkpoint of a machine of another byte order");
    return head->version == CHECKPOINT_VERSION ||
           error_at(err, ERROR_INPUT, input->path, "",
                    "is a checkpoint of format version %u, this program reads version %d",
                    head->version, CHECKPOINT_VERSION);
}

static bool check_length(const Input *input, const CheckpointHead *head, Error *err)
{
    uint64_t there = 0;
    if (fseeko(input->file, 0, SEEK_END) == 0) there = (uint64_t)ftello(input->file);
    fseeko(input->file, sizeof *head, SEEK_SET);
    return there == head->file_bytes ||
           error_at(err, ERROR_INPUT, input->path, "", "is %s: has %llu bytes of %llu",
                    there < head->file_bytes ? "cut off" : "damaged",
                    (unsigned long long)there, (unsigned long long)head->file_bytes);
}

static bool check_head(const Input *input, const CheckpointHead *head, Error *err)
{
    const int32_t *crop = head->crop;
    if (crop[0] < 0 || crop[1] < 0 || crop[0] >= crop[2] || crop[1] >= crop[3] ||
        crop[2] > head->width || crop[3] > head->height)
        return damaged_head(input->path, "crop", err);
    if (head->first_sample >= head->end_sample || head->end_sample > head->asked_end ||
        head->asked_end > FILM_SAMPLES_MAX)
        return damaged_head(input->path, "range of samples", err);
    if (head->dropped_kept > FILM_DROPPED_KEPT || head->dropped_kept > head->dropped_count)
        return damaged_head(input->path, "list of dropped samples", err);
    if (!(head->seconds >= 0)) return damaged_head(input->path, "duration", err);
    return (head->identity_bytes <= IDENTITY_MAX &&
            head->identity_bytes + sizeof *head + sizeof(uint64_t) <= head->file_bytes) ||
           damaged_head(input->path, "identity", err);
}

static Checkpoint checkpoint_of(const char *path, const CheckpointHead *head,
                                const char *identity)
{
    Checkpoint out = {
        .path = path, .identity = identity, .seconds = head->seconds,
        .has_features = head->has_features != 0, .body = sizeof *head + head->identity_bytes,
        .done = {.name = path, .width = head->width, .height = head->height,
                 .crop = {head->crop[0], head->crop[1], head->crop[2], head->crop[3]},
                 .layers = head->layers, .first_sample = head->first_sample,
                 .end_sample = head->end_sample, .asked_end = head->asked_end,
                 .dropped = {.count = head->dropped_count, .kept = (int)head->dropped_kept},
                 .paths = head->paths, .camera_rays = head->camera_rays,
                 .bounce_rays = head->bounce_rays, .shadow_rays = head->shadow_rays}};
    for (int i = 0; i < out.done.dropped.kept; i++) {
        out.done.dropped.first[i].sample_index = head->dropped[i].sample_index;
        out.done.dropped.first[i].x = head->dropped[i].x;
        out.done.dropped.first[i].y = head->dropped[i].y;
    }
    return out;
}

static bool read_all(Input *input, Arena *arena, Checkpoint *out, Error *err)
{
    CheckpointHead   head = {0};
    size_t got = fread(&head, 1, sizeof head, input->file);
    if (!check_kind(input, &head, got, err) || !check_length(input, &head, err)) return false;
    XXH3_64bits_update(&input->hash, &head, sizeof head);
    if (!check_head(input, &head, err)) return false;
    char *identity = ARENA_NEW(arena, char, head.identity_bytes + 1);
    Checkpoint found = checkpoint_of(input->path, &head, identity);
    if (!take(input, identity, head.identity_bytes, err) ||
        !skip(input, head.file_bytes - found.body - sizeof(uint64_t), *arena, err) ||
        !check_sum(input, err))
        return false;
    *out = found;
    return true;
}

bool checkpoint_open(const char *path, Arena *arena, Checkpoint *out, Error *err)
{
    Input input;
    if (!open_input(path, &input, err)) return false;
    bool done = read_all(&input, arena, out, err);
    fclose(input.file);
    return done;
}

/* ---- going on ---------------------------------------------------------------------------- */

bool checkpoint_fits(const Checkpoint *checkpoint, const FilmPart *wanted, Error *err)
{
    const FilmPart *done = &checkpoint->done;
    FilmRect        a = done->crop, b = wanted->crop;
    if (a.x0 != b.x0 || a.y0 != b.y0 || a.x1 != b.x1 || a.y1 != b.y1)
        return error_at(err, ERROR_INPUT, checkpoint->path, "",
                        "is of other pixels: %d,%d,%d,%d there, %d,%d,%d,%d here", a.x0, a.y0,
                        a.x1, a.y1, b.x0, b.y0, b.x1, b.y1);
    if (done->first_sample != wanted->first_sample)
        return error_at(err, ERROR_INPUT, checkpoint->path, "",
                        "is of other samples: from %u there, from %u here", done->first_sample,
                        wanted->first_sample);
    return done->end_sample <= wanted->end_sample ||
           error_at(err, ERROR_INPUT, checkpoint->path, "",
                    "has samples %u:%u of every pixel already, more than the %u:%u that are "
                    "asked for — ask for %u or more",
                    done->first_sample, done->end_sample, wanted->first_sample,
                    wanted->end_sample, done->end_sample - done->first_sample);
}

static bool load_rows(Input *input, const Checkpoint *checkpoint, Film *film, Arena scratch,
                      Error *err)
{
    const FilmPart *done = &checkpoint->done;
    size_t          most = film_packed_bytes_max(film);
    unsigned char  *row = ARENA_NEW(&scratch, unsigned char, most);
    uint32_t        size;
    for (int y = done->crop.y0; y < done->crop.y1; y++) {
        if (!take(input, &size, sizeof size, err)) return false;
        if (size > most) return damaged_head(input->path, "size of a row", err);
        if (!take(input, row, size, err)) return false;
        if (!film_unpack_row(film, y, (PackedRow){row, size},
                             done->end_sample - done->first_sample, scratch, err))
            return error_in_file(err, input->path);
    }
    film_add_dropped(film, &done->dropped);
    return true;
}

bool checkpoint_load(const Checkpoint *checkpoint, Film *film, Arena scratch, Error *err)
{
    Input input;
    if (!open_input(checkpoint->path, &input, err)) return false;
    bool done = skip(&input, checkpoint->body, scratch, err) &&
                load_rows(&input, checkpoint, film, scratch, err) && check_sum(&input, err);
    fclose(input.file);
    return done;
}
