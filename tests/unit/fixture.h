/* SPDX-License-Identifier: Apache-2.0 */
/* fixture.h -- what tests of any module stand on: a temporary folder, memory, texts of errors.
 *
 * A test is a program of its own, so one folder and one arena serve it: make_folder or
 * make_arena as the group's setup, remove_folder, clear_folder or drop_arena at its end.
 *
 * Memory   a test's copy of the arena (test_arena) is dropped with all that it took.
 */
#pragma once
#include "check.h"

#include <dirent.h>
#include <ftw.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_write.h"

/* ---- memory ------------------------------------------------------------------------------ */

/* The program's arena: what is taken from it stays to the program's end. */
static inline Arena *test_memory(void) {
    static Arena arena;
    return &arena;
}

/* The test's copy of it. */
static inline Arena test_arena(void **state) {
    return *(Arena *)*state;
}

static inline int make_arena(void **state) {
    *test_memory() = arena_reserve((size_t)4 << 30);
    *state = test_memory();
    return 0;
}

static inline int drop_arena(void **state) {
    arena_release(*state);
    return 0;
}

/* A case with `Arena arena`, a copy of its own. */
#define ARENA_TEST(name) TEST_ON(name, NULL, NULL, Arena arena, test_arena(state))

/* A case with `Arena *arena`, the program's. */
#define MEMORY_TEST(name) TEST_ON(name, NULL, NULL, Arena *arena, *state)

/* ---- folders ----------------------------------------------------------------------------- */

enum { FOLDER_BYTES = 512 };

static inline bool folder_create_below(const char *base, char path[FOLDER_BYTES]) {
    snprintf(path, FOLDER_BYTES, "%s/parhelion-test-XXXXXX", base);
    return mkdtemp(path) != NULL;
}

static inline bool folder_create(char path[FOLDER_BYTES]) {
    const char *base = getenv("TMPDIR");
    return folder_create_below(base ? base : P_tmpdir, path);
}

static inline int folder_remove_entry(const char *path, const struct stat *status, int kind,
                                      struct FTW *walk) {
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

/* With all that lies in it; 0 when it is gone. */
static inline int folder_destroy(const char *path) {
    return nftw(path, folder_remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

/* What a test had for itself: a folder, an arena, and `owner`, which holds both. */
static inline int drop_owner(const char *folder, Arena *arena, void *owner) {
    folder_destroy(folder);
    arena_release(arena);
    free(owner);
    return 0;
}

/* Names in it but "." and "..". */
static inline int folder_count(const char *path) {
    int count = -2;
    DIR *list = opendir(path);
    assert_non_null(list);
    while (readdir(list)) count++;
    closedir(list);
    return count;
}

/* ---- the program's own folder ------------------------------------------------------------ */

static inline char *test_folder(void) {
    static char path[FOLDER_BYTES];
    return path;
}

/* And an arena. */
static inline int make_folder(void **state) {
    make_arena(state);
    return folder_create(test_folder()) ? 0 : -1;
}

/* Fails when a test left anything behind. */
static inline int remove_folder(void **state) {
    drop_arena(state);
    return rmdir(test_folder());
}

static inline int clear_folder(void **state) {
    drop_arena(state);
    return folder_destroy(test_folder());
}

static inline int files_in_folder(void) {
    return folder_count(test_folder());
}

/* The path of a name in it; good until the eighth call after this one. */
static inline const char *in_folder(const char *name) {
    static char paths[8][2 * FOLDER_BYTES];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", test_folder(), name);
    return path;
}

/* ---- files ------------------------------------------------------------------------------- */

/* Not by file_write, which waits for the disk: some tests write thousands. */
static inline void write_bytes(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        fail_msg("%s cannot be written", path);
}

static inline void write_text(const char *path, const char *text) {
    write_bytes(path, text, strlen(text));
}

static inline FileBytes read_bytes(const char *path, Arena *arena) {
    FileBytes bytes = {0};
    Error err = {0};
    if (!file_read(path, (size_t)1 << 28, arena, &bytes, &err)) fail_msg("%s: %s", path, err.text);
    return bytes;
}

/* A zero byte stands behind a file's bytes, so a text file is a string. */
static inline const char *read_text(const char *path, Arena *arena) {
    return (const char *)read_bytes(path, arena).data;
}

/* ---- errors ------------------------------------------------------------------------------ */

/* Where a call says why it failed, for what checks it later: f(..., why()). */
static inline Error *why(void) {
    static Error err;
    return &err;
}

static inline void fail_told(const char *call, const Error *err) {
    char line[2048];
    error_line(err, line, sizeof line);
    fail_msg("%s: %s", line, call);
}

/* A call that may fail, with &err for its last argument: an Error of the macro's own. */
#define assert_done(...) \
    do { \
        Error err = {0}; \
        if (!(__VA_ARGS__)) fail_told(#__VA_ARGS__, &err); \
    } while (0)

/* It fails, of `code_wanted`, in one line that has the part; all that it reported is in
 * why(). */
#define assert_fails_as(call, code_wanted, part) \
    do { \
        Error err = {0}; \
        if (call) fail_msg("%s is done, required: \"%s\"", #call, part); \
        *why() = err; \
        assert_int_equal(err.code, code_wanted); \
        assert_error_has(&err, part); \
    } while (0)

/* What the last call said: by this code, of this place in the file, in one line with words. */
#define assert_told(wanted, place, words) \
    do { \
        const char *place_ = (place), *words_ = (words); \
        if (why()->code != (wanted) || strcmp(why()->path, place_) != 0 || \
            !strstr(why()->text, words_) || strchr(why()->text, '\n')) \
            fail_msg("code %d, \"%s: %s\", required: %d, \"%s: %s\"", (int)why()->code, \
                     why()->path, why()->text, (int)(wanted), place_, words_); \
    } while (0)

/* ---- processes that run out of memory ---------------------------------------------------- */

#define FULL_STATUS 42

static inline void leave_when_full(size_t wanted, size_t left) {
    (void)wanted, (void)left;
    _exit(FULL_STATUS);
}

/* The exit status of a forked process; 1000 and its signal when one ended it. */
static inline int status_of(pid_t child) {
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

/* ---- texts ------------------------------------------------------------------------------- */

#define assert_text_has(text, part) \
    do { \
        const char *text_ = (text), *part_ = (part); \
        if (!strstr(text_, part_)) fail_msg("\"%s\" lacks \"%s\"", text_, part_); \
    } while (0)

/* A message is one line. */
#define assert_error_has(err, part) \
    do { \
        assert_text_has((err)->text, part); \
        assert_null(strchr((err)->text, '\n')); \
    } while (0)

/* It fails, of any code, in one line that has the part. */
#define assert_fails(call, part) \
    do { \
        Error err = {0}; \
        if (call) fail_msg("%s is done, required: \"%s\"", #call, part); \
        assert_error_has(&err, part); \
    } while (0)

/* It fails, with this message and no more. */
#define assert_fails_with(call, text_wanted) \
    do { \
        Error err = {0}; \
        if (call) fail_msg("%s is done, required: \"%s\"", #call, text_wanted); \
        assert_string_equal(err.text, text_wanted); \
    } while (0)

/* The whole line of what a user did wrong, its place too, has the parts. */
static inline void assert_line_has(const Error *err, const char *const *part, int count) {
    char line[2048];
    error_line(err, line, sizeof line);
    assert_int_equal(err->code, ERROR_INPUT);
    for (int i = 0; i < count; i++) assert_text_has(line, part[i]);
}

/* Words that may be reported in one of several lines (notes, reasons, warnings). */
static inline bool lines_have(const char *const *line, int count, const char *part) {
    for (int i = 0; i < count; i++)
        if (strstr(line[i], part)) return true;
    return false;
}

/* How often a text holds another. */
static inline int count_of(const char *text, const char *part) {
    int count = 0;
    for (const char *p = text; (p = strstr(p, part)); p++) count++;
    return count;
}
