/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/response_file.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/file_write.h"
#include "render/identity.h"

#define MAGIC "PRHLRESP"
#define BYTE_ORDER_MARK 0x01020304u
#define FILE_BYTES_MOST ((size_t)1 << 28)
#define LEVEL_MOST RESPONSE_LEVEL
#define CELL_BYTES (RESPONSE_BANDS * sizeof(float))
#define GROUP_BYTES (2 * RESPONSE_GROUPS * sizeof(float))

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers go out as they lie");

/* The file's first bytes; every member lies where its size puts it. */
typedef struct ResponseHead {
    char     magic[8];
    uint32_t byte_order, version;
    uint64_t file_bytes, identity_bytes;
    int32_t  level, paths, cells, kept; /* kept: cells that hold anything */
    double   relative_error, lamps, displays;
} ResponseHead;

_Static_assert(sizeof(ResponseHead) == 8 + 8 + 16 + 16 + 24, "the head has no gaps");

static size_t bytes_of(const ResponseHead *head)
{
    return sizeof *head + head->identity_bytes +
           (size_t)head->kept * (sizeof(int32_t) + PROBE_ORDERS * CELL_BYTES + GROUP_BYTES) +
           sizeof(uint64_t);
}

/* ---- writing ----------------------------------------------------------------------------- */

static bool is_empty(const float *shares)
{
    static const float zeros[RESPONSE_BANDS];
    return !memcmp(shares, zeros, CELL_BYTES);
}

static int32_t *find_kept(const Response *response, int32_t *count, Arena *arena)
{
    int32_t *kept = ARENA_NEW(arena, int32_t, response->cells.count);
    *count = 0;
    for (int i = 0; i < response->cells.count; i++) {
        size_t at = (size_t)i * RESPONSE_BANDS;
        if (!is_empty(response->first + at) || !is_empty(response->rest + at))
            kept[(*count)++] = i;
    }
    return kept;
}

static unsigned char *put(unsigned char *to, const void *bytes, size_t size)
{
    memcpy(to, bytes, size);
    return to + size;
}

bool response_write(ResponseFile *file, const Response *response, const OwnLight *own,
                    Arena scratch, Error *err)
{
    ResponseHead head = {.byte_order = BYTE_ORDER_MARK, .version = RESPONSE_VERSION,
                         .identity_bytes = strlen(file->identity),
                         .level = response->cells.level, .paths = response->paths,
                         .cells = response->cells.count,
                         .relative_error = response->relative_error, .lamps = own->lamps,
                         .displays = own->displays};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    int32_t *kept = find_kept(response, &head.kept, &scratch);
    head.file_bytes = bytes_of(&head);
    unsigned char *bytes = ARENA_NEW(&scratch, unsigned char, head.file_bytes), *to = bytes;
    to = put(to, &head, sizeof head);
    to = put(to, file->identity, head.identity_bytes);
    to = put(to, kept, (size_t)head.kept * sizeof *kept);
    for (int i = 0; i < head.kept; i++)
        to = put(to, response->first + (size_t)kept[i] * RESPONSE_BANDS, CELL_BYTES);
    for (int i = 0; i < head.kept; i++)
        to = put(to, response->rest + (size_t)kept[i] * RESPONSE_BANDS, CELL_BYTES);
    for (int i = 0; i < head.kept; i++)
        to = put(to, response->groups + (size_t)kept[i] * 2 * RESPONSE_GROUPS, GROUP_BYTES);
    uint64_t checksum = XXH3_64bits(bytes, (size_t)(to - bytes));
    put(to, &checksum, sizeof checksum);
    file->bytes = head.file_bytes;
    return file_write(file->path, bytes, head.file_bytes, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

static bool refuse(const ResponseFile *file, const char *what, Error *err)
{
    return error_at(err, ERROR_INPUT, file->path, "", "%s", what);
}

static bool check_kind(const ResponseFile *file, const FileBytes *bytes, ResponseHead *head,
                       Error *err)
{
    size_t got = bytes->size < sizeof *head ? bytes->size : sizeof *head;
    memcpy(head, bytes->data, got);
    if (got < sizeof head->magic || memcmp(head->magic, MAGIC, sizeof head->magic) != 0)
        return refuse(file, "is not a response", err);
    if (got < sizeof *head) return refuse(file, "is cut off within its head", err);
    if (head->byte_order != BYTE_ORDER_MARK)
        return refuse(file, "is a response of a machine of another byte order", err);
    return head->version == RESPONSE_VERSION ||
           error_at(err, ERROR_INPUT, file->path, "",
                    "is a response of format version %u, this program reads version %d",
                    head->version, RESPONSE_VERSION);
}

static bool check_bytes(const ResponseFile *file, const FileBytes *bytes,
                        const ResponseHead *head, Error *err)
{
    uint64_t wanted;
    if (bytes->size != head->file_bytes || bytes->size < sizeof *head + sizeof wanted)
        return error_at(err, ERROR_INPUT, file->path, "", "is %s: has %zu bytes of %llu",
                        bytes->size < head->file_bytes ? "cut off" : "damaged", bytes->size,
                        (unsigned long long)head->file_bytes);
    memcpy(&wanted, bytes->data + bytes->size - sizeof wanted, sizeof wanted);
    uint64_t found = XXH3_64bits(bytes->data, bytes->size - sizeof wanted);
    return found == wanted ||
           error_at(err, ERROR_INPUT, file->path, "",
                    "is damaged: its bytes have the checksum %016llx, required: %016llx",
                    (unsigned long long)found, (unsigned long long)wanted);
}

/* The checksum is right: only who makes one on purpose fails here. */
static bool check_head(const ResponseFile *file, const ResponseHead *head, Error *err)
{
    bool is_sound = head->level >= 0 && head->level <= LEVEL_MOST && head->paths > 0 &&
                    head->cells == 2 * (int32_t)geodesic_count(head->level) &&
                    head->kept >= 0 && head->kept <= head->cells &&
                    head->identity_bytes < head->file_bytes &&
                    bytes_of(head) == head->file_bytes && isfinite(head->lamps) &&
                    isfinite(head->displays);
    return is_sound || refuse(file, "is damaged: its head cannot be", err);
}

static bool check_identity(const ResponseFile *file, const char *there, Arena scratch,
                           Error *err)
{
    const char *difference = identity_difference(there, file->identity, &scratch);
    return !difference || error_at(err, ERROR_INPUT, file->path, "",
                                   "is the response of something else: %s", difference);
}

/* One of the file's parts: so many bytes a kept triangle. */
typedef struct FilePart {
    const unsigned char *values;
    size_t               bytes;
    float               *to;
} FilePart;

static bool spread(const ResponseFile *file, const ResponseHead *head,
                   const unsigned char *cells, FilePart part, Error *err)
{
    for (int i = 0; i < head->kept; i++, part.values += part.bytes) {
        int32_t cell;
        memcpy(&cell, cells + (size_t)i * sizeof cell, sizeof cell);
        if (cell < 0 || cell >= head->cells)
            return refuse(file, "is damaged: it has triangles that are not there", err);
        float *to = part.to + (size_t)cell * (part.bytes / sizeof(float));
        memcpy(to, part.values, part.bytes);
        for (size_t k = 0; k < part.bytes / sizeof(float); k++)
            if (!isfinite(to[k]))
                return refuse(file, "is damaged: it has light that is not finite", err);
    }
    return true;
}

static bool spread_all(const ResponseFile *file, const ResponseHead *head,
                       const unsigned char *cells, float *shares, Error *err)
{
    size_t kept = (size_t)head->kept, order = (size_t)head->cells * RESPONSE_BANDS;
    const unsigned char *first = cells + kept * sizeof(int32_t);
    const unsigned char *rest = first + kept * CELL_BYTES, *groups = rest + kept * CELL_BYTES;
    return spread(file, head, cells, (FilePart){first, CELL_BYTES, shares}, err) &&
           spread(file, head, cells, (FilePart){rest, CELL_BYTES, shares + order}, err) &&
           spread(file, head, cells, (FilePart){groups, GROUP_BYTES, shares + 2 * order}, err);
}

bool response_read(ResponseFile *file, Arena *arena, Response *out, OwnLight *own, Error *err)
{
    Arena        scratch = arena_reserve(2 * FILE_BYTES_MOST);
    ResponseHead head;
    FileBytes    bytes;
    bool ok = file_read(file->path, FILE_BYTES_MOST, &scratch, &bytes, err) &&
              check_kind(file, &bytes, &head, err) && check_bytes(file, &bytes, &head, err) &&
              check_head(file, &head, err);
    if (ok) {
        const unsigned char *text = bytes.data + sizeof head;
        const char *there = arena_string(&scratch, (const char *)text, head.identity_bytes);
        Response found;
        float   *shares = response_empty(head.level, arena, &found);
        ok = check_identity(file, there, scratch, err) &&
             spread_all(file, &head, text + head.identity_bytes, shares, err);
        found.paths = head.paths;
        found.relative_error = head.relative_error;
        if (ok) file->bytes = bytes.size;
        if (ok) *out = found;
        if (ok) *own = (OwnLight){head.lamps, head.displays};
    }
    arena_release(&scratch);
    return ok;
}
