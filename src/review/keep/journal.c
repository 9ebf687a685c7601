/* SPDX-License-Identifier: Apache-2.0 */
#include "review/keep/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "render/signals.h"

#define MAGIC "PRHLJRNL"
#define BYTE_ORDER_MARK 0x01020304u
#define VERSION 1
#define BUFFER_BYTES ((size_t)1 << 16)
#define FIRST_ROOM 1024 /* places of the index, a power of two */

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers go out as they lie");

typedef struct JournalHead {
    char     magic[8];
    uint32_t byte_order, version;
} JournalHead;

typedef struct JournalEntry {
    JournalKey key;
    uint64_t   size, checksum;
} JournalEntry;

/* Where an answer is; size and offset 0: a free place. */
typedef struct JournalPlace {
    JournalKey key;
    uint64_t   offset, size;
} JournalPlace;

struct Journal {
    const char   *path;
    Arena        *arena;
    int           file;
    uint64_t      end;    /* of the entries that count */
    JournalPlace *places; /* a hash table */
    size_t        room;
    int           count;
    bool          has_failed;
    Error         failure;
};

JournalKey journal_key(const char *text)
{
    XXH128_hash_t hash = XXH3_128bits(text, strlen(text));
    return (JournalKey){hash.low64, hash.high64};
}

/* ---- the index --------------------------------------------------------------------------- */

/* Its own, or the free one where it would be. */
static JournalPlace *place_of(JournalPlace *places, size_t room, JournalKey key)
{
    size_t at = key.low & (room - 1);
    while (places[at].offset &&
           (places[at].key.low != key.low || places[at].key.high != key.high))
        at = (at + 1) & (room - 1);
    return &places[at];
}

static void grow(Journal *journal)
{
    size_t        room = journal->room ? 2 * journal->room : FIRST_ROOM;
    JournalPlace *places = ARENA_NEW(journal->arena, JournalPlace, room);
    for (size_t i = 0; i < journal->room; i++)
        if (journal->places[i].offset)
            *place_of(places, room, journal->places[i].key) = journal->places[i];
    journal->places = places;
    journal->room = room;
}

static void remember(Journal *journal, const JournalPlace *place)
{
    if (2 * (size_t)journal->count >= journal->room) grow(journal);
    JournalPlace *to = place_of(journal->places, journal->room, place->key);
    if (to->offset) return;
    *to = *place;
    journal->count++;
}

/* ---- bytes ------------------------------------------------------------------------------- */

static bool read_at(int file, void *bytes, size_t size, uint64_t offset)
{
    char *to = bytes;
    while (size) {
        ssize_t n = pread(file, to, size, (off_t)offset);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        to += n;
        size -= (size_t)n;
        offset += (uint64_t)n;
    }
    return true;
}

static bool write_at(int file, const void *bytes, size_t size, uint64_t offset)
{
    const char *from = bytes;
    while (size) {
        ssize_t n = pwrite(file, from, size, (off_t)offset);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        from += n;
        size -= (size_t)n;
        offset += (uint64_t)n;
    }
    return true;
}

static void start_sum(XXH3_state_t *sum, const JournalEntry *entry)
{
    XXH3_64bits_reset(sum);
    XXH3_64bits_update(sum, entry, offsetof(JournalEntry, checksum));
}

static uint64_t sum_of(const JournalEntry *entry, const void *answer)
{
    XXH3_state_t sum;
    start_sum(&sum, entry);
    XXH3_64bits_update(&sum, answer, entry->size);
    return XXH3_64bits_digest(&sum);
}

/* The checksum of an answer in the file; false: it cannot be read. */
static bool sum_in_file(const Journal *journal, const JournalEntry *entry, uint64_t offset,
                        uint64_t *out)
{
    unsigned char buffer[BUFFER_BYTES];
    XXH3_state_t  sum;
    uint64_t      left = entry->size;
    start_sum(&sum, entry);
    while (left) {
        size_t part = left < sizeof buffer ? (size_t)left : sizeof buffer;
        if (!read_at(journal->file, buffer, part, offset)) return false;
        XXH3_64bits_update(&sum, buffer, part);
        offset += part;
        left -= part;
    }
    *out = XXH3_64bits_digest(&sum);
    return true;
}

/* ---- opening ----------------------------------------------------------------------------- */

static bool refuse(const Journal *journal, const char *what, int reason, Error *err)
{
    return error_at(err, ERROR_OUTPUT, journal->path, "", "cannot be %s: %s", what,
                    strerror(reason));
}

static bool start_file(Journal *journal, Error *err)
{
    JournalHead head = {.byte_order = BYTE_ORDER_MARK, .version = VERSION};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    journal->end = sizeof head;
    return (ftruncate(journal->file, 0) == 0 &&
            write_at(journal->file, &head, sizeof head, 0)) ||
           refuse(journal, "written", errno, err);
}

/* Takes entries up to the first that is not whole. */
static void take_entries(Journal *journal, uint64_t file_bytes)
{
    JournalEntry entry;
    uint64_t     sum;
    while (file_bytes - journal->end >= sizeof entry &&
           read_at(journal->file, &entry, sizeof entry, journal->end)) {
        uint64_t offset = journal->end + sizeof entry;
        if (entry.size > file_bytes - offset || !sum_in_file(journal, &entry, offset, &sum) ||
            sum != entry.checksum)
            return;
        remember(journal, &(JournalPlace){entry.key, offset, entry.size});
        journal->end = offset + entry.size;
    }
}

static bool is_ours(const JournalHead *head)
{
    return !memcmp(head->magic, MAGIC, sizeof head->magic) &&
           head->byte_order == BYTE_ORDER_MARK && head->version == VERSION;
}

static bool take_file(Journal *journal, Problems *problems, Error *err)
{
    JournalHead head = {{0}, 0, 0};
    struct stat info;
    if (fstat(journal->file, &info) != 0) return refuse(journal, "read", errno, err);
    uint64_t bytes = (uint64_t)info.st_size;
    if (bytes < sizeof head) return start_file(journal, err); /* killed as it was made */
    if (!read_at(journal->file, &head, sizeof head, 0))
        return refuse(journal, "read", errno, err);
    if (!is_ours(&head)) {
        problems_add(problems, SEVERITY_WARNING, journal->path, "",
                     "is not what this program keeps of a review: it is begun anew");
        return start_file(journal, err);
    }
    journal->end = sizeof head;
    take_entries(journal, bytes);
    if (journal->end == bytes) return true;
    problems_add(problems, SEVERITY_WARNING, journal->path, "",
                 "is cut off or damaged at byte %llu of %llu: what was kept after that is "
                 "traced again", (unsigned long long)journal->end, (unsigned long long)bytes);
    return ftruncate(journal->file, (off_t)journal->end) == 0 ||
           refuse(journal, "written", errno, err);
}

/* A file system without locks is no reason to fail. */
static bool lock(const Journal *journal, Error *err)
{
    return flock(journal->file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK ||
           error_at(err, ERROR_OUTPUT, journal->path, "",
                    "another review is at work in this folder: wait for it, or name another "
                    "folder");
}

/* A folder that came from somewhere may have a link or a pipe in its place. */
static bool is_regular(const Journal *journal, Error *err)
{
    struct stat info;
    return (fstat(journal->file, &info) == 0 && S_ISREG(info.st_mode)) ||
           error_at(err, ERROR_OUTPUT, journal->path, "", "is not a regular file");
}

bool journal_open(const char *path, Arena *arena, Problems *problems, Journal **out, Error *err)
{
    Journal *journal = ARENA_NEW(arena, Journal, 1);
    *journal = (Journal){.path = path, .arena = arena};
    grow(journal);
    journal->file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (journal->file < 0) return refuse(journal, "created", errno, err);
    bool is_free = is_regular(journal, err) && lock(journal, err);
    if (is_free && take_file(journal, problems, err)) {
        *out = journal;
        return true;
    }
    struct stat info;
    if (is_free && fstat(journal->file, &info) == 0 && info.st_size == 0) unlink(path);
    close(journal->file);
    return false;
}

/* ---- asking ------------------------------------------------------------------------------ */

bool journal_find(const Journal *journal, JournalKey key, void *answer, size_t size)
{
    if (!journal) return false;
    const JournalPlace *place = place_of(journal->places, journal->room, key);
    return place->offset && place->size == size &&
           read_at(journal->file, answer, size, place->offset);
}

/* Half an entry would only be in the way of the next. */
static void fail(Journal *journal, int reason)
{
    journal->has_failed = true;
    if (ftruncate(journal->file, (off_t)journal->end) != 0) reason = errno;
    refuse(journal, "written", reason, &journal->failure);
}

void journal_add(Journal *journal, JournalKey key, const void *answer, size_t size)
{
    JournalEntry entry = {key, size, 0};
    if (!journal || journal->has_failed ||
        place_of(journal->places, journal->room, key)->offset)
        return;
    entry.checksum = sum_of(&entry, answer);
    uint64_t offset = journal->end + sizeof entry;
    if (!write_at(journal->file, &entry, sizeof entry, journal->end) ||
        !write_at(journal->file, answer, size, offset)) {
        fail(journal, errno);
        return;
    }
    remember(journal, &(JournalPlace){key, offset, size});
    journal->end = offset + size;
}

bool journal_ok(const Journal *journal, Error *err)
{
    if (!journal || !journal->has_failed) return true;
    *err = journal->failure;
    return false;
}

/* ---- files of others --------------------------------------------------------------------- */

/* To be closed, unless false. *bytes: of the file. */
static bool open_other(const char *path, Arena *scratch, Journal *out, uint64_t *bytes)
{
    JournalHead head;
    struct stat info;
    *out = (Journal){.path = path, .arena = scratch, .end = sizeof head,
                     .file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (out->file < 0) return false;
    if (fstat(out->file, &info) != 0 || !S_ISREG(info.st_mode) ||
        (size_t)info.st_size < sizeof head ||
        !read_at(out->file, &head, sizeof head, 0) || !is_ours(&head)) {
        close(out->file);
        return false;
    }
    grow(out);
    *bytes = (uint64_t)info.st_size;
    take_entries(out, *bytes);
    return true;
}

/* An answer may be as large as a file: it goes over piece by piece, with its checksum. */
static void copy_entry(Journal *journal, const Journal *from, const JournalPlace *place)
{
    unsigned char buffer[BUFFER_BYTES];
    uint64_t      size = sizeof(JournalEntry) + place->size, done = 0;
    uint64_t      start = place->offset - sizeof(JournalEntry);
    if (journal->has_failed || place_of(journal->places, journal->room, place->key)->offset)
        return;
    while (done < size) {
        size_t part = size - done < sizeof buffer ? (size_t)(size - done) : sizeof buffer;
        if (!read_at(from->file, buffer, part, start + done)) break;
        if (!write_at(journal->file, buffer, part, journal->end + done)) {
            fail(journal, errno);
            return;
        }
        done += part;
    }
    if (done < size) { /* it cannot be read: what was written of it goes */
        if (ftruncate(journal->file, (off_t)journal->end) != 0) fail(journal, errno);
        return;
    }
    remember(journal, &(JournalPlace){place->key, journal->end + sizeof(JournalEntry),
                                      place->size});
    journal->end += size;
}

bool journal_take_over(Journal *journal, const char *path, Arena scratch)
{
    Journal  other;
    uint64_t bytes;
    if (!open_other(path, &scratch, &other, &bytes)) return false;
    for (size_t i = 0; i < other.room; i++)
        if (other.places[i].offset) copy_entry(journal, &other, &other.places[i]);
    close(other.file);
    return true;
}

bool journal_file_has(const char *path, JournalKey key, Arena scratch)
{
    Journal  other;
    uint64_t bytes;
    if (!open_other(path, &scratch, &other, &bytes)) return false;
    close(other.file);
    return other.end == bytes && place_of(other.places, other.room, key)->offset;
}

int journal_file_count(const char *path, Arena scratch)
{
    Journal  other;
    uint64_t bytes;
    if (!open_other(path, &scratch, &other, &bytes)) return 0;
    close(other.file);
    return other.count;
}

int journal_count(const Journal *journal)
{
    return journal ? journal->count : 0;
}

void journal_close(Journal *journal)
{
    if (!journal) return;
    if (!journal->count) unlink(journal->path);
    close(journal->file);
}

/* ---- whether a review goes on ------------------------------------------------------------ */

bool review_goes_on(const Journal *journal, Error *err)
{
    int stop = signals_stop_requested();
    if (stop) return error_set(err, (ErrorCode)(128 + stop), "stopped");
    return journal_ok(journal, err);
}
