/* SPDX-License-Identifier: Apache-2.0 */
/* A file leads to its neighbours and not beyond; an output is looked at before work is done;
 * an arena takes no more than half of a limited address space. */
#include "fixture.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include "base/count.h"
#include "base/file.h"
#include "base/reference.h"

/* folder/a/scenes/s.gltf may name what is below folder/a, but nothing in folder/secret. */
static int make_tree(void **state) {
    static const char *const FOLDERS[] = {"a", "a/scenes", "a/beside", "secret"};
    if (make_folder(state)) return -1;
    for (int i = 0; i < 4; i++)
        if (mkdir(in_folder(FOLDERS[i]), 0755)) return -1;
    write_text(in_folder("secret/x"), "x");
    write_text(in_folder("a/beside/x"), "x");
    bool made = !symlink("../../secret/x", in_folder("a/scenes/out")) &&
                !symlink("../../secret", in_folder("a/scenes/link")) &&
                !symlink("../beside/x", in_folder("a/scenes/near"));
    return made ? 0 : -1;
}

typedef struct Row {
    const char *relative, *root, *words; /* words NULL: it is taken */
} Row;

static void check_row(const char *from, const Row *row, bool own_folder, Arena arena) {
    const char *path = NULL;
    const ReferenceReach reach = {row->root ? in_folder(row->root) : NULL, own_folder};
    bool taken = reference_resolve(in_folder(from), row->relative, reach, &arena, &path, why());
    if (taken != !row->words) fail_msg("%s, '%s': %s", from, row->relative, why()->text);
    if (!taken && !strstr(why()->text, row->words))
        fail_msg("%s, '%s' says: %s", from, row->relative, why()->text);
    if (taken) assert_string_equal(path, path_beside(in_folder(from), row->relative, &arena));
}

ARENA_TEST(a_file_leads_to_its_neighbours_only) {
    static const Row rows[] = {
        {"../beside/x", NULL, NULL},
        {"near", NULL, NULL},
        {"../scenes/../beside/x", NULL, NULL},
        {"not there", NULL, NULL}, /* opening it reports more */
        {"out", NULL, "leaves the parent of the folder of the file that names it by a symb"},
        {"link/x", NULL, "by a symbolic link"},
        {"../../secret/x", NULL, "another folder is added by --root DIR"},
        {"../../not/there", NULL, "leaves the parent"},
        {"/etc/passwd", NULL, "\"/etc/passwd\" is an absolute path"},
        {"\\\\host\\x", NULL, "is an absolute path"},
        {"..\\x", NULL, "holds a backslash; / is required"},
        {"", NULL, "\"\" is empty; a path relative to the file that names it is required"},
        {"out", "secret", NULL},
        {"link/x", "secret", NULL},
        {"../../secret/x", "secret", NULL},
        {"../../secret/x", "a/beside", "leaves the parent"},
        {"out", "secre", "by a symbolic link"}, /* no folder of that name */
    };
    for (int i = 0; i < COUNT_OF(rows); i++) check_row("a/scenes/s.gltf", &rows[i], false, arena);
}

ARENA_TEST(somebody_elses_file_leads_to_its_own_folder) {
    static const Row rows[] = {
        {"near", NULL, "leaves the folder of the file that names it by a symbolic link;"},
        {"../beside/x", NULL, "leaves the folder of the file that names it;"},
        {"../../secret/x", NULL, "leaves the folder of the file that names it;"},
        {"../beside/x", "a/beside", NULL},
        {"s.bin", NULL, NULL},
        {"../scenes/s.bin", NULL, NULL},
    };
    for (int i = 0; i < COUNT_OF(rows); i++) check_row("a/scenes/s.gltf", &rows[i], true, arena);
}

/* The home folder, what holds it, and "/" are in nobody's reach but their own files'. */
ARENA_TEST(home_is_not_reached) {
    static const struct {
        const char *home, *from;
        Row row;
    } rows[] = {
        {"a", "a/scenes/s.gltf", {"../beside/x", NULL, "leaves the folder of the file that"}},
        {"a/scenes", "a/scenes/s.gltf", {"../beside/x", NULL, "leaves the files beside the"}},
        {"a/scenes/deep", "a/scenes/s.gltf", {"deep/x", NULL, "in the home folder or above"}},
        {"a/scenes", "a/scenes/s.gltf", {".x", NULL, "leaves the files beside the one that"}},
        {"a/scenes", "a/scenes/s.gltf", {"x", NULL, NULL}},
        {"a/scenes", "a/scenes/s.gltf", {"../beside/x", "a", NULL}},
        {"a/scenes", "a/scenes/deep/s.gltf", {"../x", NULL, "leaves the folder of the file"}},
        {"a/scenes", "a/scenes/deep/s.gltf", {"x", NULL, NULL}},
        {"secret", "a/scenes/s.gltf", {"../beside/x", NULL, NULL}},
        {"nowhere", "a/scenes/s.gltf", {"../beside/x", NULL, NULL}},
    };
    const char *before = getenv("HOME");
    mkdir(in_folder("a/scenes/deep"), 0755);
    write_text(in_folder("a/scenes/deep/x"), "x");
    write_text(in_folder("a/scenes/x"), "x");
    write_text(in_folder("a/scenes/.x"), "x");
    for (int i = 0; i < COUNT_OF(rows); i++) {
        setenv("HOME", in_folder(rows[i].home), 1);
        check_row(rows[i].from, &rows[i].row, false, arena);
    }
    if (before) setenv("HOME", before, 1);
    else unsetenv("HOME");
    const char *path;
    assert_false(
        reference_resolve("/etc/s.gltf", "../bin/sh", (ReferenceReach){0}, &arena, &path, why()));
    assert_error_has(why(), "leaves the folder of the file that names it");
}

/* A file that is named without a folder stands in the folder where the program was started. */
ARENA_TEST(the_folder_may_be_unnamed) {
    char before[4096];
    const char *path;
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(in_folder("a/scenes")), 0);
    assert_done(reference_resolve("s.gltf", "near", (ReferenceReach){0}, &arena, &path, &err));
    assert_string_equal(path, "near");
    assert_false(reference_resolve("s.gltf", "out", (ReferenceReach){0}, &arena, &path, why()));
    assert_int_equal(chdir(before), 0);
}

TEST(a_root_must_be_a_folder) {
    assert_done(reference_check_root(NULL, &err));
    assert_done(reference_check_root(in_folder("secret"), &err));
    assert_false(reference_check_root(in_folder("secret/x"), why()));
    assert_string_equal(why()->text, "--root wants a folder: Not a directory");
    assert_false(reference_check_root(in_folder("nowhere"), why()));
    assert_string_equal(why()->text, "--root wants a folder: No such file or directory");
    assert_int_equal(why()->code, ERROR_INPUT);
}

TEST(an_output_is_looked_at_first) {
    assert_done(file_check_writable(in_folder("new"), &err));
    assert_int_equal(access(in_folder("new"), F_OK), -1); /* nothing is left */
    assert_done(file_check_writable(in_folder("secret/x"), &err));
    assert_done(file_check_writable("/dev/null", &err));
    assert_false(file_check_writable(in_folder("secret"), why()));
    assert_string_equal(why()->text, "cannot be written: Is a directory");
    assert_fails_as(file_check_writable(in_folder("nowhere/new"), &err), ERROR_OUTPUT,
                    "No such file or directory");
    assert_string_equal(why()->file, in_folder("nowhere/new"));
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIMITS_WORK 0 /* sanitizers take terabytes of addresses */
#else
#define LIMITS_WORK 1
#endif

/* In a process of its own: the size of an arena of 8 GB where only 2 GB may be had. */
TEST(an_arena_leaves_room) {
    if (!LIMITS_WORK) skip();
    pid_t child = fork();
    if (child == 0) {
        const size_t gigabyte = (size_t)1 << 30;
        struct rlimit limit = {2 * gigabyte, 2 * gigabyte};
        drop_arena(state);
        if (setrlimit(RLIMIT_AS, &limit)) _exit(1);
        Arena first = arena_reserve(8 * gigabyte), second = arena_reserve(8 * gigabyte);
        size_t a = (size_t)(first.end - first.begin), b = (size_t)(second.end - second.begin);
        _exit(a <= gigabyte && a > gigabyte / 2 && b <= a / 2 + 65536 && b > a / 4 ? 0 : 2);
    }
    assert_int_equal(status_of(child), 0);
}

TEST_PROGRAM(make_tree, clear_folder)
