/* SPDX-License-Identifier: Apache-2.0 */
/* arena_guard.h -- lets the address sanitizer see what is read or written behind an arena's
 * allocations. Private to arena.c.
 *
 * Builds for fuzzing define ARENA_GUARD (CMakeLists.txt): then some bytes behind every
 * allocation are poisoned, and a mark at the beginning of an arena's memory records how far
 * that reached, through copies of the arena as well. In other builds all of this is nothing.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

#ifdef ARENA_GUARD
#include <sanitizer/asan_interface.h>

enum { GUARD_ALIGN = 8, GUARD_BYTES = 32 };

/* The header at the beginning of an arena's memory. */
typedef struct GuardMark {
    char *reached;
    size_t tag; /* the mark's address with some bits turned: arena_reserve made this arena */
} GuardMark;

#define GUARD_TAG ((size_t)0x67756172643f7a21)

/* NULL for an arena over memory that is somebody else's: it has no guards. */
static inline GuardMark *guard_mark(const Arena *arena) {
    GuardMark *mark = (GuardMark *)(void *)arena->begin;
    bool has_room = mark && arena->end - arena->begin >= (ptrdiff_t)sizeof *mark;
    return has_room && mark->tag == ((size_t)mark ^ GUARD_TAG) ? mark : NULL;
}

/* A fresh arena: takes the mark's place. */
static inline void guard_start(Arena *arena) {
    GuardMark *mark = (GuardMark *)(void *)arena->begin;
    arena->next += GUARD_BYTES;
    *mark = (GuardMark){arena->next, (size_t)mark ^ GUARD_TAG};
}

/* `bytes` at `memory` are handed out; the arena's next is behind them. */
static inline void guard_open(Arena *arena, char *memory, size_t bytes) {
    GuardMark *mark = guard_mark(arena);
    if (!mark) return;
    size_t left = (size_t)(arena->end - arena->next);
    __asan_unpoison_memory_region(memory, bytes);
    arena->next += -(size_t)arena->next & (GUARD_ALIGN - 1) & left;
    left = (size_t)(arena->end - arena->next);
    size_t guard = left < GUARD_BYTES ? left : GUARD_BYTES;
    __asan_poison_memory_region(arena->next, guard);
    arena->next += guard;
    if (mark->reached < arena->next) mark->reached = arena->next;
}

/* Nothing in these bytes is guarded any more. */
static inline void guard_lift(char *memory, size_t bytes) {
    __asan_unpoison_memory_region(memory, bytes);
}

/* Before the memory goes back: its next owner may touch it. */
static inline void guard_end(Arena *arena) {
    GuardMark *mark = guard_mark(arena);
    if (mark) __asan_unpoison_memory_region(arena->begin, (size_t)(mark->reached - arena->begin));
}
#else
enum { GUARD_ALIGN = 1 };

static inline void guard_start(Arena *arena) {
    (void)arena;
}

static inline void guard_open(Arena *arena, char *memory, size_t bytes) {
    (void)arena, (void)memory, (void)bytes;
}

static inline void guard_lift(char *memory, size_t bytes) {
    (void)memory, (void)bytes;
}

static inline void guard_end(Arena *arena) {
    (void)arena;
}
#endif
