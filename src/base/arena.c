/* SPDX-License-Identifier: Apache-2.0 */
#include "base/arena.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/arena_guard.h"
#include "base/machine.h"
#include "print/print.h"
#include "print/printable.h"

/* Threads may still be at work: their libraries' tables must not be taken down under them. */
static void exit_when_full(size_t bytes_wanted, size_t bytes_left) {
    print_to(stderr, "parhelion: out of memory: %zu bytes required, %zu left\n", bytes_wanted,
             bytes_left);
    fflush(stderr);
    _exit(3);
}

#define PAGE ((size_t)1 << 16)

/* The most that one arena may take: libraries and further arenas need room too, and a file
 * that requests more than there is should exhaust the arena, not the system, nor the container,
 * which is killed then. */
static size_t most_bytes(void) {
    size_t space = machine_address_space_left() / 2;
    size_t memory = machine_installed_bytes() / 4 * 3;
    return (space < memory ? space : memory) / PAGE * PAGE;
}

/* Arenas of so many bytes hold scenes and tables, which paths read here and there: pages of
 * 2 MB spare most of these reads the search for their page. */
#define LARGE ((size_t)1 << 32)

bool arena_try_reserve(size_t bytes, Arena *out) {
    size_t size = (bytes + PAGE - 1) / PAGE * PAGE, most = most_bytes();
    if (size > most) size = most;
    char *memory = mmap(NULL, size, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    *out = (Arena){0};
    if (memory == MAP_FAILED) return false;
    if (bytes >= LARGE) madvise(memory, size, MADV_HUGEPAGE); /* or stays with small ones */
    *out =
        (Arena){.next = memory, .end = memory + size, .on_full = exit_when_full, .begin = memory};
    guard_start(out);
    return true;
}

Arena arena_reserve(size_t bytes) {
    Arena arena;
    if (!arena_try_reserve(bytes, &arena)) exit_when_full(bytes, 0);
    return arena;
}

void arena_trim(Arena *arena) {
    size_t used = ((size_t)(arena->next - arena->begin) + PAGE - 1) / PAGE * PAGE;
    char *end = arena->begin + used;
    if (end >= arena->end) return;
    guard_end(arena);
    munmap(end, (size_t)(arena->end - end));
    arena->end = end;
}

void arena_release(Arena *arena) {
    if (arena->begin) {
        guard_end(arena);
        munmap(arena->begin, (size_t)(arena->end - arena->begin));
    }
    *arena = (Arena){0};
}

/* Blocks of so many bytes are held against what the machine has now: together several arenas
 * may have more addresses than there is memory, and who touches too much of it is killed. */
#define LARGE_BLOCK ((size_t)1 << 22)

/* A block's size, and what is left for it. */
static size_t block_bytes(const Arena *arena, size_t size, size_t count, size_t *left) {
    size_t bytes;
    *left = arena_left(arena);
    if (__builtin_mul_overflow(size, count, &bytes)) bytes = SIZE_MAX;
    if (bytes >= LARGE_BLOCK) {
        size_t memory = machine_memory_left();
        if (memory < *left) *left = memory;
    }
    return bytes;
}

/* Bytes of any value, or NULL where they are more than what is left. */
static void *take_block(Arena *arena, size_t bytes, size_t align, size_t left) {
    if (align < GUARD_ALIGN) align = GUARD_ALIGN;
    size_t pad = (size_t)(-(uintptr_t)arena->next) & (align - 1);
    if (pad > left || bytes > left - pad) return NULL;
    char *memory = arena->next + pad;
    arena->next = memory + bytes;
    guard_open(arena, memory, bytes);
    return memory;
}

void *arena_try(Arena *arena, size_t size, size_t align, size_t count) {
    size_t left, bytes = block_bytes(arena, size, count, &left);
    void *memory = take_block(arena, bytes, align, left);
    return memory && bytes ? memset(memory, 0, bytes) : memory;
}

static void *block_or_end(Arena *arena, size_t size, size_t align, size_t count) {
    size_t left, bytes = block_bytes(arena, size, count, &left);
    void *memory = take_block(arena, bytes, align, left);
    if (memory) return memory;
    if (arena->way_out) longjmp(*arena->way_out, 1);
    arena->on_full(bytes, left);
    abort(); /* on_full must not return */
}

void *arena_alloc(Arena *arena, size_t size, size_t align, size_t count) {
    void *memory = block_or_end(arena, size, align, count);
    return size * count > 0 ? memset(memory, 0, size * count) : memory;
}

/* Whole pages become zero by being given back. */
void *arena_untouched(Arena *arena, size_t size, size_t align, size_t count) {
    char *memory = block_or_end(arena, size, align, count), *end = memory + size * count;
    char *first = memory + ((size_t)(-(uintptr_t)memory) & (PAGE - 1));
    char *last = end - ((uintptr_t)end & (PAGE - 1));
    bool is_given =
        size * count >= LARGE_BLOCK && !madvise(first, (size_t)(last - first), MADV_DONTNEED);
    if (is_given) madvise(first, (size_t)(last - first), MADV_NOHUGEPAGE);
    else first = last = end;
    memset(memory, 0, (size_t)(first - memory));
    memset(last, 0, (size_t)(end - last));
    return memory;
}

void *arena_grow(Arena *arena, void *bytes, size_t size, size_t wanted, size_t align) {
    if (bytes && (char *)bytes + size == arena->next) {
        arena_alloc(arena, 1, 1, wanted - size);
        return bytes;
    }
    void *bigger = arena_alloc(arena, 1, align, wanted);
    return bytes ? memcpy(bigger, bytes, size) : bigger;
}

void *arena_keep(Arena *arena, const void *bytes, size_t size, size_t align) {
    char *memory = arena->next + ((size_t)(-(uintptr_t)arena->next) & (align - 1));
    arena->next = memory + size;
    guard_lift(memory, size);
    memmove(memory, bytes, size);
    guard_open(arena, memory, size);
    return memory;
}

char *arena_string(Arena *arena, const char *text, size_t length) {
    char *copy = ARENA_NEW(arena, char, length + 1);
    memcpy(copy, text, length);
    return copy;
}

char *arena_printable(Arena *arena, const char *text) {
    size_t size = printable_size(text);
    char *copy = ARENA_NEW(arena, char, size);
    printable_copy(copy, size, text);
    return copy;
}

char *arena_format(Arena *arena, const char *format, ...) {
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, args);
    char *text = ARENA_NEW(arena, char, length + 1);
    vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(args);
    return text;
}

char *arena_format_list(Arena *arena, size_t most, const char *format, va_list list) {
    char text[ARENA_FORMAT_MOST + 1];
    vsnprintf(text, most < sizeof text ? most + 1 : sizeof text, format, list);
    return arena_string(arena, text, strlen(text));
}
