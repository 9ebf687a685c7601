/* SPDX-License-Identifier: Apache-2.0 */
/* A measurement set is written whole or not at all, whatever stood in its place. */
#include "fixture.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "panel/set/set_writer.h"

static bool stands(const char *name) {
    struct stat status;
    return stat(in_folder(name), &status) == 0;
}

static bool holds(const char *name, const char *wanted) {
    Arena arena = *test_memory();
    return !strcmp(read_text(in_folder(name), &arena), wanted);
}

/* Everything below the folder but "." and "..". */
static int entries_below(const char *path) {
    int count = 0;
    struct dirent *entry;
    DIR *list = opendir(path);
    for (; list && (entry = readdir(list));)
        if (*entry->d_name != '.')
            count += 1 + entries_below(arena_format(test_memory(), "%s/%s", path, entry->d_name));
    if (list) closedir(list);
    return count;
}

static bool add(SetWriter *writer, const char *name, const char *content) {
    Arena arena = *test_memory();
    Text text = {.arena = &arena};
    text_add(&text, content);
    return set_writer_add(writer, name, &text);
}

/* Two tables and the manifest in set/. */
static bool add_all(SetWriter *writer) {
    json_t *root = json_pack("{s:f}", "third", 1 / 3.0);
    bool ok = add(writer, "emission/black.csv", "black") &&
              add(writer, "brdf/i30.csv", "reflection") && set_writer_add_manifest(writer, root, 3);
    json_decref(root);
    return ok;
}

static Lines inputs; /* that the set is made from */

static bool write_all(Error *err) {
    SetWriter writer;
    return set_writer_open(in_folder("set/MANIFEST.json"), &inputs, &writer, err) &&
           set_writer_close(&writer, add_all(&writer));
}

static void refused(const char *name, const char *reason) {
    assert_fails_as(write_all(&err), ERROR_OUTPUT, reason);
    assert_string_equal(why()->file, in_folder(name));
}

static void remove_all(void) {
    static const char *const names[] = {
        "set/emission/black.csv", "set/brdf/i30.csv", "set/MANIFEST.json",
        "set/emission",           "set/brdf",         "set"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_int_equal(remove(in_folder(names[i])), 0);
}

TEST(a_whole_set_has_its_names_at_the_end) {
    SetWriter writer;
    assert_true(set_writer_open(in_folder("set/MANIFEST.json"), &inputs, &writer, why()));
    assert_true(add_all(&writer));
    assert_true(add(&writer, "brdf/i30.csv", "again")); /* the last word counts */
    assert_false(stands("set/brdf/i30.csv"));
    assert_true(set_writer_close(&writer, true));
    assert_true(holds("set/emission/black.csv", "black"));
    assert_true(holds("set/brdf/i30.csv", "again"));
    assert_true(holds("set/MANIFEST.json", "{\n  \"third\": 0.333\n}\n"));
    assert_int_equal(entries_below(test_folder()), 6);
    assert_true(write_all(why())); /* over what stands there */
    assert_true(holds("set/brdf/i30.csv", "reflection"));
    assert_int_equal(entries_below(test_folder()), 6);
    remove_all();
}

TEST(a_set_that_is_not_whole_goes_again) {
    SetWriter writer;
    assert_true(set_writer_open(in_folder("set/MANIFEST.json"), &inputs, &writer, why()));
    assert_true(add_all(&writer));
    assert_false(set_writer_close(&writer, false));
    assert_int_equal(entries_below(test_folder()), 0);
}

/* Stopped by each signal, the one that cannot be caught too. */
TEST(a_process_that_is_stopped_leaves_nothing) {
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGKILL};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        pid_t child = fork();
        if (!child) {
            SetWriter writer;
            Error ignored;
            signal(signals[i], SIG_DFL);
            if (!set_writer_open(in_folder("set/MANIFEST.json"), &inputs, &writer, &ignored) ||
                !add_all(&writer))
                _exit(1);
            raise(signals[i]);
            _exit(2);
        }
        int status = 0;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == signals[i]);
        assert_int_equal(entries_below(test_folder()), 0);
    }
    assert_done(write_all(&err)); /* and again, from the start */
    remove_all();
}

TEST(a_set_has_more_tables_than_the_system_first_allows_open_files) {
    struct rlimit before, few;
    SetWriter writer;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
    few = (struct rlimit){32, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &few), 0);
    assert_true(set_writer_open(in_folder("MANIFEST.json"), &inputs, &writer, why()));
    for (int i = 0; i < 100; i++)
        assert_true(add(&writer, arena_format(test_memory(), "%d.csv", i), "x"));
    assert_false(set_writer_close(&writer, false));
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &before), 0);
    assert_int_equal(entries_below(test_folder()), 0);
}

TEST(a_file_where_a_folder_is_wanted_is_named) {
    write_text(in_folder("set"), "a file");
    refused("set", "cannot be made: Not a directory");
    assert_true(holds("set", "a file"));
    assert_int_equal(remove(in_folder("set")), 0);
    assert_int_equal(mkdir(in_folder("set"), 0777), 0);
    write_text(in_folder("set/brdf"), "a file");
    refused("set/brdf", "cannot be made: Not a directory");
    assert_int_equal(entries_below(test_folder()), 2);
    assert_int_equal(remove(in_folder("set/brdf")), 0);
    assert_int_equal(rmdir(in_folder("set")), 0);
}

TEST(a_folder_where_a_file_is_wanted_is_named) {
    assert_done(write_all(&err));
    assert_int_equal(remove(in_folder("set/brdf/i30.csv")), 0);
    assert_int_equal(mkdir(in_folder("set/brdf/i30.csv"), 0777), 0);
    write_text(in_folder("set/emission/black.csv"), "the older one");
    refused("set/brdf/i30.csv", "cannot be written: Is a directory");
    assert_true(holds("set/emission/black.csv", "the older one"));
    assert_int_equal(entries_below(test_folder()), 6);
    assert_int_equal(remove(in_folder("set/MANIFEST.json")), 0);
    assert_int_equal(mkdir(in_folder("set/MANIFEST.json"), 0777), 0);
    refused("set/MANIFEST.json", "cannot be written: Is a directory");
    remove_all();
}

/* What happens between the tables and their names: the first one has its name already. */
TEST(names_that_were_given_are_taken_back) {
    SetWriter writer;
    assert_true(set_writer_open(in_folder("set/MANIFEST.json"), &inputs, &writer, why()));
    assert_true(add_all(&writer));
    assert_int_equal(entries_below(test_folder()), 0);
    assert_int_equal(mkdir(in_folder("set"), 0777), 0);
    assert_int_equal(mkdir(in_folder("set/brdf"), 0777), 0);
    assert_int_equal(mkdir(in_folder("set/brdf/i30.csv"), 0777), 0);
    assert_false(set_writer_close(&writer, true));
    assert_string_equal(why()->file, in_folder("set/brdf/i30.csv"));
    assert_int_equal(entries_below(test_folder()), 3); /* what is in the way, and its folders */
    assert_int_equal(remove(in_folder("set/brdf/i30.csv")), 0);
    assert_int_equal(rmdir(in_folder("set/brdf")), 0);
    assert_int_equal(rmdir(in_folder("set")), 0);
}

TEST(a_full_disk_leaves_what_stood_there) {
    struct rlimit before, limit;
    assert_done(write_all(&err));
    write_text(in_folder("set/emission/black.csv"), "old");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = (struct rlimit){8, before.rlim_max}; /* black.csv fits, i30.csv does not */
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    bool ok = write_all(why());
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_false(ok);
    assert_string_equal(why()->file, in_folder("set/brdf/i30.csv"));
    assert_error_has(why(), "cannot be written: File too large");
    assert_true(holds("set/emission/black.csv", "old"));
    assert_int_equal(entries_below(test_folder()), 6);
    remove_all();
}

/* The superuser may write everywhere: then there is nothing to see. */
TEST(a_read_only_folder_is_named) {
    if (geteuid() == 0) skip();
    assert_int_equal(mkdir(in_folder("set"), 0555), 0);
    refused("set/emission/black.csv", "cannot be created: Permission denied");
    assert_int_equal(rmdir(in_folder("set")), 0);
}

TEST_PROGRAM(make_folder, remove_folder)
