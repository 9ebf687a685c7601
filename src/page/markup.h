/* markup.h -- a text that grows, with what HTML and XML want of it.
 *
 * Memory   pieces in an address space of its own, taken with the first byte; what was added is
 *          never copied again. markup_release gives it back.
 * Threads  one thread at a time.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

typedef struct MarkupPiece MarkupPiece;

/* {0} is empty. */
typedef struct Markup {
    Arena        own;
    MarkupPiece *first, *last;
    size_t       size;
} Markup;

void markup_release(Markup *markup);

void markup_add(Markup *markup, const char *text);
void markup_add_bytes(Markup *markup, const void *bytes, size_t size);
void markup_format(Markup *markup, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

void markup_append(Markup *markup, const Markup *other);

/* As the content of an element or of a quoted attribute, in HTML and in XML 1.0. What is no
 * UTF-8, and characters that XML does not allow, become '?'. */
void markup_escape(Markup *markup, const char *text);

/* RFC 4648, with padding. */
void markup_base64(Markup *markup, const void *bytes, size_t size);

/* The whole text, terminated, in an arena; and into a file. */
const char *markup_text(const Markup *markup, Arena *arena);
bool        markup_write(const Markup *markup, const char *path, Error *err);
