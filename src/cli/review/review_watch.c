/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_watch.h"

#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "render/signals.h"

#define WATCH_BYTES ((size_t)1 << 30) /* address space: what is not touched costs nothing */
#define ROUND_NS 500000000L

struct WatchedFile {
    const char     *path;
    struct timespec written;
    off_t           size; /* -1: it is not there */
};

ReviewWatch review_watch_start(void)
{
    return (ReviewWatch){.arena = arena_reserve(WATCH_BYTES)};
}

void review_watch_end(ReviewWatch *watch)
{
    arena_release(&watch->arena);
}

static void look(WatchedFile *file)
{
    struct stat info;
    bool is_there = stat(file->path, &info) == 0;
    file->size = is_there ? info.st_size : -1;
    file->written = is_there ? info.st_mtim : (struct timespec){0, 0};
}

void review_watch_add(ReviewWatch *watch, const char *path)
{
    for (int i = 0; i < watch->count; i++)
        if (!strcmp(watch->files[i].path, path)) return;
    if (watch->count == watch->room) {
        watch->files = ARENA_GROW(&watch->arena, WatchedFile, watch->files, watch->count,
                                  2 * watch->room + 64);
        watch->room = 2 * watch->room + 64;
    }
    WatchedFile *file = &watch->files[watch->count++];
    file->path = arena_string(&watch->arena, path, strlen(path));
    look(file);
}

static bool is_other(WatchedFile *file)
{
    WatchedFile before = *file;
    look(file);
    return file->size != before.size || file->written.tv_sec != before.written.tv_sec ||
           file->written.tv_nsec != before.written.tv_nsec;
}

bool review_watch_wait(ReviewWatch *watch, const char **changed)
{
    *changed = NULL;
    for (;;) {
        const struct timespec round = {0, ROUND_NS};
        const char *now = NULL;
        nanosleep(&round, NULL);
        if (signals_stop_requested()) return false;
        for (int i = 0; i < watch->count; i++)
            if (is_other(&watch->files[i]) && !now) now = watch->files[i].path;
        if (!*changed) *changed = now;
        if (*changed && !now) return true;
    }
}
