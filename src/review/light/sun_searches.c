/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/sun_searches.h"

#include <string.h>

#define BYTES ((size_t)1 << 34) /* address space: what is not touched costs nothing */

struct SunSearch {
    const char      *identity; /* the scene's */
    Vec3             eye;
    FalseSunRays     rays;
    const SunSearch *before;
};

SunSearches sun_searches_start(void)
{
    return (SunSearches){arena_reserve(BYTES), NULL};
}

void sun_searches_end(SunSearches *searches)
{
    arena_release(&searches->arena);
}

static bool is_of(const SunSearch *search, const Setup *setup, Vec3 eye)
{
    return search->eye.x == eye.x && search->eye.y == eye.y && search->eye.z == eye.z &&
           !strcmp(search->identity, setup->identity);
}

/* Nothing but the scene and the eye decides it. */
static JournalKey key_of(const Setup *setup, Vec3 eye, const char *what, Arena scratch)
{
    return journal_key(arena_format(&scratch, "suns in mirrors, %s\n%016llx%016llx\n%a %a %a",
                                    what, (unsigned long long)setup->tools.base.high,
                                    (unsigned long long)setup->tools.base.low, (double)eye.x,
                                    (double)eye.y, (double)eye.z));
}

static bool find_kept(const Setup *setup, Vec3 eye, Arena *arena, FalseSunRays *out)
{
    const Journal *journal = setup->tools.journal;
    int            count;
    if (!journal_find(journal, key_of(setup, eye, "count", *arena), &count, sizeof count))
        return false;
    size_t bytes = (size_t)count * sizeof(FalseSunRay);
    JournalKey   rays = key_of(setup, eye, "rays", *arena);
    JournalKey   cells = key_of(setup, eye, "cells", *arena);
    FalseSunRay *list = ARENA_NEW(arena, FalseSunRay, count);
    int         *first = ARENA_NEW(arena, int, FALSE_SUN_CELLS + 1);
    *out = (FalseSunRays){list, first, count};
    return (!count || journal_find(journal, rays, list, bytes)) &&
           journal_find(journal, cells, first, (FALSE_SUN_CELLS + 1) * sizeof *first);
}

/* The count comes last: the others are there when it is. */
static void keep(const Setup *setup, Vec3 eye, const FalseSunRays *rays, Arena scratch)
{
    Journal *journal = setup->tools.journal;
    if (rays->count)
        journal_add(journal, key_of(setup, eye, "rays", scratch), rays->list,
                    (size_t)rays->count * sizeof *rays->list);
    journal_add(journal, key_of(setup, eye, "cells", scratch), rays->first,
                (FALSE_SUN_CELLS + 1) * sizeof *rays->first);
    journal_add(journal, key_of(setup, eye, "count", scratch), &rays->count,
                sizeof rays->count);
}

const FalseSunRays *sun_searches_ask(SunSearches *searches, const Setup *setup, Vec3 eye)
{
    Arena *arena = &searches->arena;
    for (const SunSearch *search = searches->last; search; search = search->before)
        if (is_of(search, setup, eye)) return &search->rays;
    SunSearch *search = ARENA_NEW(arena, SunSearch, 1);
    *search = (SunSearch){.identity = arena_string(arena, setup->identity,
                                                   strlen(setup->identity)),
                          .eye = eye, .before = searches->last};
    if (!setup->lessons || !find_kept(setup, eye, arena, &search->rays)) {
        false_suns_search(setup, eye, arena, &search->rays);
        if (setup->lessons) keep(setup, eye, &search->rays, *arena);
    }
    searches->last = search;
    return &search->rays;
}
