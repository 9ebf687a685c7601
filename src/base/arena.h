/* SPDX-License-Identifier: Apache-2.0 */
/* arena.h -- hands out zeroed memory that is released all at once.
 *
 * Memory   arena_reserve maps address space; pages cost nothing until they are touched.
 * Threads  one arena belongs to one thread at a time.
 * Fails    running out is one exit path: on_full is called and must not return. The one that
 *          arena_reserve sets prints one line and ends the process with status 3. A library
 *          sets way_out instead: a place to jump to, in a function that has not returned. What
 *          an arena does not hold must not be open then.
 *
 * A function that keeps memory takes an `Arena *`; one that needs only scratch takes an
 * `Arena` by value: the copy is dropped at return, and the memory is back.  Scratch that was
 * used before is zeroed again by arena_alloc.
 */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Arena {
    char *next;
    char *end;
    void (*on_full)(size_t bytes_wanted, size_t bytes_left); /* must not return */
    char *begin;
    jmp_buf *way_out; /* NULL: on_full */
} Arena;

/* An arena over `bytes` of fresh address space (rounded up to pages), but at most over three
 * quarters of the memory (machine_granted_bytes) and half of what the process may still take
 * (ulimit -v). */
Arena arena_reserve(size_t bytes);

/* The same; false, *out empty: the system refuses the address space. */
bool arena_try_reserve(size_t bytes, Arena *out);

/* Bytes that it still has. */
static inline size_t arena_left(const Arena *arena) {
    return (size_t)(arena->end - arena->next);
}

/* Gives back what nothing was made in yet; the arena is full then but for a page's rest. */
void arena_trim(Arena *arena);

/* Gives the address space back; everything from the arena is gone. */
void arena_release(Arena *arena);

/* count * size zeroed bytes; align is a power of two. Never NULL; count 0 is fine. */
void *arena_alloc(Arena *arena, size_t size, size_t align, size_t count);

/* The same for large tables that are filled by many threads, or only here and there: a page is
 * taken from the system when it is touched, one of few bytes, by the thread that touches it. */
void *arena_untouched(Arena *arena, size_t size, size_t align, size_t count);

/* arena_alloc; NULL: there is no room, nothing has changed. */
void *arena_try(Arena *arena, size_t size, size_t align, size_t count);

/* Keeps what was made in a copy of the arena: moves `size` bytes that lie behind the arena's
 * start to that start. They may overlap; everything else behind it is gone. */
void *arena_keep(Arena *arena, const void *bytes, size_t size, size_t align);

/* The first `size` bytes of an allocation with room for `wanted` of them, the new ones zero: at
 * the same place when it is the arena's last, else copied. NULL is an empty allocation. */
void *arena_grow(Arena *arena, void *bytes, size_t size, size_t wanted, size_t align);

/* A copy of a string of `length` bytes, terminated. */
char *arena_string(Arena *arena, const char *text, size_t length);

/* A copy of a text as it may be shown (print/printable.h). */
char *arena_printable(Arena *arena, const char *text);

/* printf into the arena. */
char *arena_format(Arena *arena, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same for a function that is itself like printf, cut at `most` bytes (ARENA_FORMAT_MOST at
 * most). The arguments may lie in scratch behind the arena's end. */
#define ARENA_FORMAT_MOST 2047
char *arena_format_list(Arena *arena, size_t most, const char *format, va_list list)
    __attribute__((format(printf, 3, 0)));

#ifdef __cplusplus
}
#endif

#define ARENA_NEW(arena, Type, count) \
    ((Type *)arena_alloc((arena), sizeof(Type), _Alignof(Type), (size_t)(count)))

/* A list of `count` items with room for `wanted` of them. */
#define ARENA_GROW(arena, Type, list, count, wanted) \
    ((Type *)arena_grow((arena), (list), sizeof(Type) * (size_t)(count), \
                        sizeof(Type) * (size_t)(wanted), _Alignof(Type)))
