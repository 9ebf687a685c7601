/* markup.h -- a text that grows, with what HTML and XML want of it.
 *
 * Memory   one stretch of address space of its own: bytes are appended where they stay, never
 *          copied. markup_release gives it back.
 * Threads  one thread at a time.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"

typedef struct Markup {
    Arena own;
} Markup;

Markup markup_start(void);
void   markup_release(Markup *markup);

static inline size_t markup_size(const Markup *markup)
{
    return (size_t)(markup->own.next - markup->own.begin);
}

static inline const char *markup_bytes(const Markup *markup)
{
    return markup->own.begin;
}

void markup_add(Markup *markup, const char *text);
void markup_add_bytes(Markup *markup, const void *bytes, size_t size);
void markup_format(Markup *markup, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* As the content of an element or of a quoted attribute, in HTML and in XML 1.0. What is no
 * UTF-8, and characters that XML does not allow, become '?'. */
void markup_escape(Markup *markup, const char *text);

/* RFC 4648, with padding. */
void markup_base64(Markup *markup, const void *bytes, size_t size);
