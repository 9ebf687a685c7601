/* SPDX-License-Identifier: Apache-2.0 */
/* Files are read whole or not at all, written whole or not at all; URIs mean what RFC 3986 and
 * RFC 2397 say. */
#include "fixture.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include "text/uri.h"

ARENA_TEST(what_was_written_is_read_back) {
    Error err;
    FileBytes bytes;
    const char *path = in_folder("a.bin");
    assert_true(file_write(path, "first", 5, &err));
    assert_true(file_write(path, "a\0b", 3, &err)); /* replaces */
    assert_true(file_read(path, 100, &arena, &bytes, &err));
    assert_int_equal(bytes.size, 3);
    assert_memory_equal(bytes.data, "a\0b", 4); /* and a zero behind */
    unlink(path);
}

ARENA_TEST(the_start_is_read_of_a_file_of_any_length) {
    FileBytes bytes;
    const char *path = in_folder("long.bin");
    assert_done(file_write(path, "abcdef", 6, &err));
    assert_done(file_read_start(path, 4, &arena, &bytes, &err));
    assert_int_equal(bytes.size, 4);
    assert_memory_equal(bytes.data, "abcd", 5); /* and a zero behind */
    assert_done(file_read_start(path, 9, &arena, &bytes, &err));
    assert_int_equal(bytes.size, 6);
    unlink(path);
    assert_fails(file_read_start(path, 4, &arena, &bytes, &err), "cannot be opened: No such file");
    assert_fails(file_read_start(test_folder(), 4, &arena, &bytes, &err),
                 "is a folder, a file is required");
}

ARENA_TEST(a_file_that_cannot_be_written_leaves_nothing) {
    assert_fails_as(file_write(in_folder("none/a.bin"), "x", 1, &err), ERROR_OUTPUT,
                    "cannot be created: No such file or directory");
    char *temporary = file_temporary_name(in_folder("b.bin"), &arena);
    FILE *file = fopen(temporary, "wb");
    assert_non_null(file);
    fclose(file);
    assert_fails(file_commit(temporary, in_folder("none/b.bin"), &err), "");
    assert_false(file_exists(temporary));
}

/* What stands in the file at `path`, read anew. */
static void assert_content(const char *path, const char *wanted) {
    FileBytes bytes;
    assert_done(file_read(path, 100, test_memory(), &bytes, &err));
    assert_string_equal((const char *)bytes.data, wanted);
}

TEST(nobody_sees_a_file_before_it_is_whole) {
    FileWriter writer;
    const char *path = in_folder("w.bin");
    for (int i = 0; i < 2; i++) { /* the second time there is one to replace */
        assert_done(file_writer_open(path, &writer, &err));
        assert_done(file_writer_add(&writer, "pie", 3, &err));
        assert_int_equal(files_in_folder(), i);
        assert_done(file_writer_add(&writer, i ? "ces" : "ce", 2 + (size_t)i, &err));
        assert_done(file_writer_commit(&writer, &err));
        assert_int_equal(files_in_folder(), 1);
        assert_content(path, i ? "pieces" : "piece");
    }
    assert_done(file_writer_open(path, &writer, &err));
    assert_done(file_writer_add(&writer, "other", 5, &err));
    file_writer_discard(&writer);
    assert_content(path, "pieces");
    assert_done(file_check_writable(path, &err));
    assert_int_equal(files_in_folder(), 1);
    unlink(path);
    char name[300]; /* too long for its temporary names, found before anything is written */
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    name[250] = '\0';
    assert_fails_with(file_writer_open(in_folder(name), &writer, &err),
                      "cannot be created: File name too long");
}

TEST(what_a_killed_writer_leaves_is_cleared) {
    Error err;
    const char *path = in_folder("k.bin");
    pid_t child = fork();
    if (child == 0) {
        FileWriter writer;
        if (!file_writer_open(path, &writer, &err)) _exit(1);
        if (!file_writer_add(&writer, "half", 4, &err)) _exit(1);
        _exit(0); /* as if killed */
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_int_equal(files_in_folder(), 0);
    /* killed between link and rename: both names stand there */
    const char *left = in_folder("k.bin.parhelion-part");
    assert_true(file_write(path, "old", 3, &err));
    assert_int_equal(link(path, left), 0);
    assert_true(file_write(path, "new", 3, &err));
    assert_int_equal(files_in_folder(), 1);
    assert_content(path, "new");
    assert_int_equal(link(path, left), 0);
    file_remove(path);
    assert_int_equal(files_in_folder(), 0);
}

/* What the writer's own name leads to stays; nor is a link published in the path's place. */
static int write_over_planted(const char *path) {
    Error err;
    FileWriter writer;
    Arena arena = arena_reserve(1 << 20);
    const char *target = in_folder("precious"), *own = file_temporary_name(path, &arena);
    if (!file_write(target, "mine", 4, &err)) return 11;
    for (int kind = 0; kind < 3; kind++) {
        int failed = kind == 0 ? symlink(target, own) : kind == 1 ? mkfifo(own, 0666) : 0;
        if (failed || !file_write(path, kind ? "b" : "a", 1, &err)) return 12 + kind;
    }
    if (!file_writer_open(path, &writer, &err) || writer.kind != FILE_NAMED) return 15;
    if (unlink(own) || symlink(target, own)) return 16;
    if (file_writer_commit(&writer, &err)) return 17;
    if (access(own, F_OK) == 0) return 18; /* a name of its own does not stay */
    arena_release(&arena);
    return 0;
}

/* From here on the process knows no unnamed files. */
static bool forbid_unnamed_files(void) {
    struct sock_filter steps[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, args[2])),
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, O_TMPFILE & ~O_DIRECTORY, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
    struct sock_fprog filter = {sizeof steps / sizeof *steps, steps};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

static int write_without_unnamed_files(const char *path) {
    Error err;
    FileWriter writer;
    if (!forbid_unnamed_files()) return 77;
    if (!file_writer_open(path, &writer, &err) || writer.kind != FILE_NAMED) return 1;
    if (!file_writer_add(&writer, "name", 4, &err) || files_in_folder() != 1) return 2;
    if (file_exists(path)) return 3;
    if (!file_writer_commit(&writer, &err) || files_in_folder() != 1) return 4;
    if (!file_writer_open(path, &writer, &err) || files_in_folder() != 2) return 5;
    file_writer_discard(&writer);
    if (files_in_folder() != 1 || file_writer_open(in_folder("no/x"), &writer, &err)) return 6;
    return write_over_planted(in_folder("p.bin"));
}

TEST(file_systems_without_unnamed_files_get_named_ones) {
    const char *path = in_folder("n.bin");
    pid_t child = fork();
    if (child == 0) _exit(write_without_unnamed_files(path));
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) skip(); /* no filters here */
    assert_int_equal(status, 0);
    assert_content(path, "name");
    unlink(path);
    assert_content(in_folder("precious"), "mine");
    assert_content(in_folder("p.bin"), "b");
    unlink(in_folder("precious"));
    unlink(in_folder("p.bin"));
}

TEST(files_and_folders_of_ours_are_no_links) {
    int handle;
    bool is_new;
    const char *path = in_folder("lock"), *other = in_folder("other");
    for (int i = 0; i < 2; i++) {
        assert_done(file_open_own(path, &handle, &err));
        close(handle);
        assert_done(folder_make_own(other, &is_new, &err));
        assert_int_equal(is_new, !i);
    }
    assert_fails(folder_make_own(path, &is_new, &err), "is a link or a file");
    unlink(path);
    assert_int_equal(symlink(other, path), 0);
    assert_fails(folder_make_own(path, &is_new, &err), "is a link or a file");
    assert_fails(file_open_own(path, &handle, &err), "is no regular file");
    assert_fails(file_open_own(other, &handle, &err), "is no regular file");
    unlink(path);
    assert_int_equal(symlink(in_folder("none"), path), 0); /* and none is made behind one */
    assert_fails(file_open_own(path, &handle, &err), "is no regular file");
    unlink(path);
    assert_int_equal(mkfifo(path, 0666), 0);
    assert_fails(file_open_own(path, &handle, &err), "is no regular file");
    unlink(path);
    assert_int_equal(rmdir(other), 0);
}

ARENA_TEST(reading_names_what_is_wrong) {
    Error err;
    FileBytes bytes;
    const char *path = in_folder("c.bin");
    assert_false(file_read(path, 100, &arena, &bytes, &err));
    assert_string_equal(err.file, path);
    assert_string_equal(err.text, "cannot be opened: No such file or directory");
    assert_false(file_read(test_folder(), 100, &arena, &bytes, &err));
    assert_string_equal(err.text, "is a folder, a file is required");
    assert_true(file_write(path, "12345", 5, &err));
    assert_false(file_read(path, 4, &arena, &bytes, &err));
    assert_string_equal(err.text, "has 5 bytes, at most 4 are read");
    unlink(path);
}

/* One of several that make the same folder a thousand times, a step ahead of the others or
 * behind; its exit status. */
static int make_thousand(void) {
    char path[400];
    Error err;
    for (int i = 0; i < 1000; i++) {
        snprintf(path, sizeof path, "%s/%d", in_folder("many"), i);
        if (!folder_make(path, &err)) return 1;
    }
    return 0;
}

TEST(processes_make_the_same_folders_at_once) {
    pid_t children[4];
    assert_done(folder_make(in_folder("many"), &err));
    for (int i = 0; i < 4; i++)
        if (!(children[i] = fork())) _exit(make_thousand());
    for (int i = 0; i < 4; i++) {
        int status;
        assert_int_equal(waitpid(children[i], &status, 0), children[i]);
        assert_int_equal(status, 0);
    }
    for (int i = 0; i < 1000; i++) {
        char path[400];
        snprintf(path, sizeof path, "%s/%d", in_folder("many"), i);
        assert_int_equal(rmdir(path), 0);
    }
    assert_int_equal(rmdir(in_folder("many")), 0);
}

TEST(a_file_is_no_folder) {
    const char *path = in_folder("file");
    assert_done(file_write(path, "x", 1, &err));
    assert_fails(folder_make(path, &err), "cannot be made: Not a directory");
    assert_fails(folder_make(in_folder("none/inner"), &err),
                 "cannot be made: No such file or directory");
    unlink(path);
}

ARENA_TEST(paths_are_joined_and_measured) {
    assert_string_equal(path_beside("a/b/c.gltf", "d.bin", &arena), "a/b/d.bin");
    assert_string_equal(path_beside("c.gltf", "d.bin", &arena), "d.bin");
    assert_string_equal(path_beside("a/c.gltf", "/d.bin", &arena), "/d.bin");
    assert_string_equal(path_ending("a.b/c"), "");
    assert_string_equal(path_ending("a/.hidden"), "");
    assert_string_equal(path_ending("a/c.tar.gz"), ".gz");
    assert_int_equal(path_climb("a/../b"), 0);
    assert_int_equal(path_climb("./a//b/../../c"), 0);
    assert_int_equal(path_climb("../b"), 1);
    assert_int_equal(path_climb("a/../../../b/c/d"), 2);
    assert_int_equal(path_climb("..a/..b"), 0);
}

TEST(schemes_are_told_from_paths) {
    assert_int_equal(uri_scheme_length("http://x"), 4);
    assert_int_equal(uri_scheme_length("C:/x"), 1);
    assert_int_equal(uri_scheme_length("a/b:c"), 0);
    assert_int_equal(uri_scheme_length("a b:c"), 0);
    assert_int_equal(uri_scheme_length(""), 0);
    assert_true(uri_is_data("DATA:,x"));
    assert_false(uri_is_data("date:,x"));
}

ARENA_TEST(percent_escapes_are_taken_out) {
    Error err;
    char *text;
    assert_true(uri_decode("a%20b%c3%A9c", &arena, &text, &err));
    assert_string_equal(text, "a b\xc3\xa9"
                              "c");
    static const char *const BROKEN[] = {"%", "%2", "a%2", "a%zz", "%2g"};
    for (int i = 0; i < 5; i++) assert_false(uri_decode(BROKEN[i], &arena, &text, &err));
    assert_false(uri_decode("a%00b", &arena, &text, &err));
}

/* RFC 4648, section 10. */
ARENA_TEST(base64_data_are_decoded) {
    static const char *const ENCODED[] = {"",         "Zg==",     "Zm8=",     "Zm9v",
                                          "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy", "Zm9vYg"};
    static const char *const PLAIN[] = {"", "f", "fo", "foo", "foob", "fooba", "foobar", "foob"};
    FileBytes bytes;
    const char *type;
    for (int i = 0; i < 8; i++) {
        char uri[64];
        snprintf(uri, sizeof uri, "data:text/plain;base64,%s", ENCODED[i]);
        assert_done(data_uri_decode(uri, &arena, &bytes, &type, &err));
        assert_int_equal(bytes.size, strlen(PLAIN[i]));
        assert_string_equal((const char *)bytes.data, PLAIN[i]);
        assert_string_equal(type, "text/plain");
    }
    assert_done(data_uri_decode("data:,a%20b", &arena, &bytes, &type, &err));
    assert_string_equal((const char *)bytes.data, "a b");
    assert_string_equal(type, "");
}

ARENA_TEST(broken_data_uris_are_refused) {
    static const char *const BROKEN[] = {
        "data:text/plain;base64", "data:;base64,Z",        "data:;base64,Zm9*",
        "data:a/b;;base64,Zg==",  "data:;base64,Zg==Zg==", "file:,x"};
    FileBytes bytes;
    for (int i = 0; i < 6; i++)
        assert_fails(data_uri_decode(BROKEN[i], &arena, &bytes, NULL, &err), "");
}

TEST_PROGRAM(make_folder, remove_folder)
