/* SPDX-License-Identifier: Apache-2.0 */
#include "keep/kept.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file_write.h"

#define BYTE_ORDER_MARK 0x01020304u
#define IDENTITY_MAX ((uint64_t)1 << 24)
#define BUFFER_BYTES ((size_t)1 << 16)

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers go out as they lie");
typedef struct KeptHead {
    char magic[8];
    uint32_t byte_order, version;
    uint64_t file_bytes, identity_bytes;
} KeptHead;

_Static_assert(sizeof(KeptHead) == 32, "the head has no gaps");

/* ---- writing ----------------------------------------------------------------------------- */

struct KeptWriter {
    FileWriter file;
    XXH3_state_t sum; /* of what was written */
};

uint64_t kept_bytes(const KeptFile *file) {
    return sizeof(KeptHead) + file->format->facts_bytes + strlen(file->identity) +
           file->body_bytes + sizeof(uint64_t);
}

bool kept_begin(const KeptFile *file, Arena *arena, KeptWriter **out, Error *err) {
    KeptWriter *writer = ARENA_NEW(arena, KeptWriter, 1);
    KeptHead head = {.byte_order = BYTE_ORDER_MARK,
                     .version = file->format->version,
                     .file_bytes = kept_bytes(file),
                     .identity_bytes = strlen(file->identity)};
    memcpy(head.magic, file->format->magic, sizeof head.magic);
    XXH3_64bits_reset(&writer->sum);
    if (!file_writer_open(file->path, &writer->file, err) ||
        !kept_add(writer, &head, sizeof head, err) ||
        !kept_add(writer, file->facts, file->format->facts_bytes, err) ||
        !kept_add(writer, file->identity, head.identity_bytes, err))
        return false;
    *out = writer;
    return true;
}

bool kept_add(KeptWriter *writer, const void *bytes, size_t size, Error *err) {
    XXH3_64bits_update(&writer->sum, bytes, size);
    return file_writer_add(&writer->file, bytes, size, err);
}

bool kept_commit(KeptWriter *writer, Error *err) {
    uint64_t checksum = XXH3_64bits_digest(&writer->sum);
    return file_writer_add(&writer->file, &checksum, sizeof checksum, err) &&
           file_writer_commit(&writer->file, err);
}

bool kept_write(const KeptFile *file, const void *body, Arena scratch, Error *err) {
    KeptWriter *writer;
    return kept_begin(file, &scratch, &writer, err) &&
           kept_add(writer, body, file->body_bytes, err) && kept_commit(writer, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

/* NULL with errno 0: it is no regular file. Opening a pipe would wait for its writer. */
static FILE *open_file(const char *path) {
    struct stat info;
    errno = 0;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) return NULL;
    return fopen(path, "rbe");
}

/* So many letters of the magic. */
static bool begins_with(const char *magic, size_t letters, const char *path) {
    KeptHead head = {{0}, 0, 0, 0, 0};
    FILE *file = open_file(path);
    if (!file) return false;
    size_t got = fread(head.magic, 1, sizeof head.magic, file);
    fclose(file);
    return got == sizeof head.magic && !memcmp(head.magic, magic, letters);
}

bool kept_is_there(const KeptFormat *format, const char *path) {
    return begins_with(format->magic, sizeof format->magic - 1, path);
}

bool kept_is_ours(const char *path) {
    return begins_with("PRHL", 4, path);
}

bool kept_damaged(const KeptReader *reader, Error *err, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_list(err, ERROR_INPUT, reader->path, "", format, list);
    va_end(list);
    return error_prefix(err, "is damaged");
}

static bool read_bytes(const KeptReader *reader, void *to, size_t bytes, Error *err) {
    errno = 0;
    return fread(to, 1, bytes, reader->file) == bytes ||
           error_at(err, ERROR_INPUT, reader->path, "", "cannot be read: %s",
                    errno ? strerror(errno) : "it ended while it was read");
}

/* First what decides the meaning of every other byte: magic, byte order, version. */
static bool check_kind(const KeptReader *reader, const KeptFormat *format, const KeptHead *head,
                       size_t got, Error *err) {
    if (got < sizeof head->magic || memcmp(head->magic, format->magic, sizeof head->magic) != 0)
        return error_at(err, ERROR_INPUT, reader->path, "", "is not %s", format->name);
    if (got < sizeof *head)
        return error_at(err, ERROR_INPUT, reader->path, "",
                        "is cut off: has %zu bytes, its head alone %zu", got,
                        sizeof *head + format->facts_bytes);
    if (head->byte_order != BYTE_ORDER_MARK)
        return error_at(err, ERROR_INPUT, reader->path, "",
                        "is %s of a machine of another byte order", format->name);
    return head->version == format->version ||
           error_at(err, ERROR_INPUT, reader->path, "",
                    "is %s of format version %u, this program reads version %u", format->name,
                    head->version, format->version);
}

static bool check_length(KeptReader *reader, const KeptFormat *format, const KeptHead *head,
                         Error *err) {
    uint64_t least = sizeof *head + format->facts_bytes + sizeof(uint64_t);
    if (fseeko(reader->file, 0, SEEK_END) == 0) reader->bytes = (uint64_t)ftello(reader->file);
    if (reader->bytes != head->file_bytes || reader->bytes < least)
        return error_at(err, ERROR_INPUT, reader->path, "", "is %s: has %llu bytes of %llu",
                        reader->bytes < head->file_bytes ? "cut off" : "damaged",
                        (unsigned long long)reader->bytes, (unsigned long long)head->file_bytes);
    if (head->identity_bytes > IDENTITY_MAX || head->identity_bytes > reader->bytes - least)
        return kept_damaged(reader, err, "its identity cannot be");
    reader->left = reader->bytes - least - head->identity_bytes;
    return true;
}

static bool check_sum(const KeptReader *reader, Error *err) {
    unsigned char buffer[BUFFER_BYTES];
    XXH3_state_t sum;
    uint64_t left = reader->bytes - sizeof left, required;
    XXH3_64bits_reset(&sum);
    rewind(reader->file);
    while (left) {
        size_t part = left < sizeof buffer ? (size_t)left : sizeof buffer;
        if (!read_bytes(reader, buffer, part, err)) return false;
        XXH3_64bits_update(&sum, buffer, part);
        left -= part;
    }
    uint64_t found = XXH3_64bits_digest(&sum);
    return read_bytes(reader, &required, sizeof required, err) &&
           (found == required ||
            kept_damaged(reader, err, "its bytes have the checksum %016llx, required: %016llx",
                         (unsigned long long)found, (unsigned long long)required));
}

static bool read_start(KeptReader *reader, const KeptFormat *format, void *facts, Arena *arena,
                       Error *err) {
    KeptHead head = {{0}, 0, 0, 0, 0};
    size_t got = fread(&head, 1, sizeof head, reader->file);
    if (!check_kind(reader, format, &head, got, err) || !check_length(reader, format, &head, err) ||
        !check_sum(reader, err))
        return false;
    char *identity = ARENA_NEW(arena, char, head.identity_bytes + 1);
    reader->identity = identity;
    fseeko(reader->file, sizeof head, SEEK_SET);
    return read_bytes(reader, facts, format->facts_bytes, err) &&
           read_bytes(reader, identity, head.identity_bytes, err);
}

bool kept_open(const KeptFormat *format, const char *path, void *facts, Arena *arena,
               KeptReader *out, Error *err) {
    KeptReader reader = {.path = path, .file = open_file(path)};
    if (!reader.file)
        return errno ? error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(errno))
                     : error_at(err, ERROR_INPUT, path, "", "is not %s", format->name);
    if (!read_start(&reader, format, facts, arena, err)) {
        fclose(reader.file);
        return false;
    }
    *out = reader;
    return true;
}

void kept_close(KeptReader *reader) {
    fclose(reader->file);
}

bool kept_take(KeptReader *reader, void *to, size_t bytes, Error *err) {
    if (bytes > reader->left)
        return kept_damaged(reader, err, "its body has %llu bytes more, required: %zu",
                            (unsigned long long)reader->left, bytes);
    reader->left -= bytes;
    return read_bytes(reader, to, bytes, err);
}

bool kept_has_left(const KeptReader *reader, uint64_t bytes, Error *err) {
    return reader->left == bytes ||
           kept_damaged(reader, err, "its body has %llu bytes more, required: %llu",
                        (unsigned long long)reader->left, (unsigned long long)bytes);
}
