/* SPDX-License-Identifier: Apache-2.0 */
#include "keep/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "keep/kept.h"

#define VERSION 2
#define FIRST_ROOM 1024 /* places of the index, a power of two */
#define ANSWER_BYTES_MOST ((uint64_t)1 << 28)

static const KeptFormat format = {"PRHLJRNL", "a journal", VERSION, 0};

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

static uint64_t sum_of(const JournalEntry *entry, const void *answer)
{
    XXH3_state_t sum;
    XXH3_64bits_reset(&sum);
    XXH3_64bits_update(&sum, entry, offsetof(JournalEntry, checksum));
    XXH3_64bits_update(&sum, answer, entry->size);
    return XXH3_64bits_digest(&sum);
}

/* The answer, if it is whole. */
static const void *read_answer(const Journal *journal, const JournalEntry *entry,
                               uint64_t offset, Arena *arena)
{
    void *answer = arena_try(arena, entry->size, 1, 1);
    bool  is_whole = answer && read_at(journal->file, answer, entry->size, offset) &&
                     sum_of(entry, answer) == entry->checksum;
    return is_whole ? answer : NULL;
}

/* ---- opening ----------------------------------------------------------------------------- */

static bool refuse(const Journal *journal, const char *what, int reason, Error *err)
{
    return error_at(err, ERROR_OUTPUT, journal->path, "", "cannot be %s: %s", what,
                    strerror(reason));
}

static bool start_file(Journal *journal, Error *err)
{
    KeptHead head = kept_head(&format);
    journal->end = sizeof head;
    return (ftruncate(journal->file, 0) == 0 &&
            write_at(journal->file, &head, sizeof head, 0)) ||
           refuse(journal, "written", errno, err);
}

/* Takes entries up to the first that is not whole. */
static void take_entries(Journal *journal, uint64_t file_bytes)
{
    JournalEntry entry;
    journal->end = sizeof(KeptHead);
    while (file_bytes - journal->end >= sizeof entry &&
           read_at(journal->file, &entry, sizeof entry, journal->end)) {
        Arena    scratch = *journal->arena;
        uint64_t offset = journal->end + sizeof entry;
        if (entry.size > file_bytes - offset || entry.size > ANSWER_BYTES_MOST ||
            !read_answer(journal, &entry, offset, &scratch))
            return;
        remember(journal, &(JournalPlace){entry.key, offset, entry.size});
        journal->end = offset + entry.size;
    }
}

static bool has_our_head(const Journal *journal)
{
    KeptHead head;
    return read_at(journal->file, &head, sizeof head, 0) && kept_head_is(&head, &format);
}

static bool take_file(Journal *journal, Problems *problems, Error *err)
{
    struct stat info;
    if (fstat(journal->file, &info) != 0) return refuse(journal, "read", errno, err);
    uint64_t bytes = (uint64_t)info.st_size;
    if (bytes < sizeof(KeptHead)) return start_file(journal, err); /* killed as it was made */
    if (!has_our_head(journal)) {
        problems_add(problems, SEVERITY_WARNING, journal->path, "",
                     "is not what this program keeps of a review: it is begun anew");
        return start_file(journal, err);
    }
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

/* ---- look-up ----------------------------------------------------------------------------- */

bool journal_find(const Journal *journal, JournalKey key, void *answer, size_t size)
{
    if (!journal) return false;
    const JournalPlace *place = place_of(journal->places, journal->room, key);
    return place->offset && place->size == size &&
           read_at(journal->file, answer, size, place->offset);
}

bool journal_find_floats(const Journal *journal, JournalKey key, float *out, size_t count)
{
    bool is_sound = journal_find(journal, key, out, count * sizeof *out);
    for (size_t i = 0; is_sound && i < count; i++) is_sound = isfinite(out[i]);
    return is_sound;
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
