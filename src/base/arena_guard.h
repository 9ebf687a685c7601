/* arena_guard.h -- lets the address sanitizer see what is read or written behind an arena's
 * allocations. Private to arena.c.
 *
 * Builds for fuzzing define ARENA_GUARD (CMakeLists.txt): then some bytes behind every
 * allocation are poisoned, and the first word of an arena's memory tells how far that reached,
 * through copies of the arena as well. In every other build all of this is nothing.
 */
#pragma once
#include "base/arena.h"

#ifdef ARENA_GUARD
#include <sanitizer/asan_interface.h>

enum { GUARD_ALIGN = 8, GUARD_BYTES = 32 };

/* A fresh arena: takes the word. */
static inline void guard_start(Arena *arena)
{
    *(char **)(void *)arena->begin = arena->next += GUARD_BYTES;
}

/* `bytes` at `memory` are handed out; the arena's next is behind them. */
static inline void guard_open(Arena *arena, char *memory, size_t bytes)
{
    char **reached = (char **)(void *)arena->begin;
    size_t left = (size_t)(arena->end - arena->next);
    __asan_unpoison_memory_region(memory, bytes);
    arena->next += -(size_t)arena->next & (GUARD_ALIGN - 1) & left;
    left = (size_t)(arena->end - arena->next);
    size_t guard = left < GUARD_BYTES ? left : GUARD_BYTES;
    __asan_poison_memory_region(arena->next, guard);
    arena->next += guard;
    if (arena->begin && *reached < arena->next) *reached = arena->next;
}

/* Nothing in these bytes is guarded any more. */
static inline void guard_lift(char *memory, size_t bytes)
{
    __asan_unpoison_memory_region(memory, bytes);
}

/* Before the memory goes back: whoever gets it next may touch it. */
static inline void guard_end(Arena *arena)
{
    char *reached = *(char **)(void *)arena->begin;
    __asan_unpoison_memory_region(arena->begin, (size_t)(reached - arena->begin));
}
#else
enum { GUARD_ALIGN = 1 };

static inline void guard_start(Arena *arena)
{
    (void)arena;
}

static inline void guard_open(Arena *arena, char *memory, size_t bytes)
{
    (void)arena, (void)memory, (void)bytes;
}

static inline void guard_lift(char *memory, size_t bytes)
{
    (void)memory, (void)bytes;
}

static inline void guard_end(Arena *arena)
{
    (void)arena;
}
#endif
