/* SPDX-License-Identifier: Apache-2.0 */
/* What control groups leave of the machine's memory, and how many threads can be had. */
#include "fixture.h"

#include <stdatomic.h>
#include <sys/stat.h>

#include "base/machine.h"
#include "base/parallel.h"

static void write_limit(const char *name, const char *text) {
    char *path = strdup(in_folder(name));
    for (char *end = strchr(path + strlen(test_folder()) + 1, '/'); end;
         end = strchr(end + 1, '/')) {
        *end = '\0';
        mkdir(path, 0700);
        *end = '/';
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    free(path);
}

static size_t least_of(const char *groups) {
    write_limit("groups", groups);
    return machine_group_bytes(in_folder("groups"), test_folder());
}

TEST(version_two_takes_the_least_of_all_that_hold_it) {
    write_limit("a/memory.max", "3000\n");
    write_limit("a/b/memory.max", "5000\n");
    write_limit("a/b/c/memory.max", "max\n");
    write_limit("d/memory.max", "max\n");
    assert_int_equal(least_of("0::/a/b/c\n"), 3000);
    assert_int_equal(least_of("0::/a\n"), 3000);
    assert_true(least_of("0::/d\n") == SIZE_MAX);
    assert_true(least_of("") == SIZE_MAX);
    assert_true(least_of("0\n0:\n::\n") == SIZE_MAX);
}

/* A container sees its own limit at the root, and a name that only the host knows. */
TEST(the_root_counts_where_the_name_is_not_there) {
    write_limit("memory.max", "7000\n");
    assert_int_equal(least_of("0::/\n"), 7000);
    assert_int_equal(least_of("0::/not/there\n"), 7000);
    write_limit("memory.max", "max\n");
}

TEST(version_one_has_a_tree_for_memory) {
    write_limit("memory/x/memory.limit_in_bytes", "9223372036854771712\n");
    write_limit("memory/x/y/memory.limit_in_bytes", "4000\n");
    assert_int_equal(least_of("9:name=systemd:/x\n4:cpu,memory:/x/y\n0::/\n"), 4000);
    assert_true(least_of("4:memory:/x\n") > (size_t)1 << 60);
    assert_true(least_of("4:cpuset:/x/y\n") == SIZE_MAX);
}

TEST(nobody_has_more_than_is_installed) {
    assert_true(machine_memory_bytes() <= machine_installed_bytes());
    assert_true(machine_installed_bytes() > (size_t)1 << 26);
}

TEST(threads_are_granted_one_by_one) {
    assert_int_equal(parallel_grantable_threads(1), 1);
    assert_int_equal(parallel_grantable_threads(3), 3);
    assert_true(parallel_grantable_threads(1 << 20) <= PARALLEL_THREADS_MAX);
}

enum { OUTER = 40, INNER = 300, WORKERS = 5 };

/* What one item's own items have done, and which of their workers is at work. */
typedef struct Within {
    atomic_int done[INNER], busy[WORKERS], clashes;
} Within;

static void count_within(void *user, int item, int worker) {
    Within *within = user;
    if (atomic_fetch_add(&within->busy[worker], 1)) atomic_fetch_add(&within->clashes, 1);
    atomic_fetch_add(&within->done[item], 1);
    atomic_fetch_sub(&within->busy[worker], 1);
}

static void call_within(void *user, int item, int worker) {
    (void)worker;
    parallel_for(WORKERS, INNER, count_within, (Within *)user + item);
}

/* Threads that wait serve calls within calls, and come again after they have gone. */
TEST(calls_within_calls_do_each_item_once) {
    for (int round = 0; round < 20; round++) {
        Within *all = calloc(OUTER, sizeof *all);
        parallel_for(WORKERS, OUTER, call_within, all);
        for (int i = 0; i < OUTER; i++) {
            assert_int_equal(all[i].clashes, 0);
            for (int k = 0; k < INNER; k++) assert_int_equal(all[i].done[k], 1);
        }
        free(all);
        if (round % 4 == 0) assert_int_equal(parallel_grantable_threads(WORKERS), WORKERS);
    }
}

TEST_PROGRAM(make_folder, clear_folder)
