/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/picture.h"

#include <cairo-svg.h>
#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the names in an SVG ---------------------------------------------------------------- */

/* Names seen so far, in a table with open addressing. */
typedef struct Names {
    const char **name;
    size_t *length;
    int *number;
    size_t capacity;
    int count;
} Names;

static int number_of(Names *names, const char *name, size_t length) {
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < length; i++) hash = (hash ^ (unsigned char)name[i]) * 16777619u;
    size_t at = hash & (names->capacity - 1);
    while (names->name[at] &&
           (names->length[at] != length || memcmp(names->name[at], name, length)))
        at = (at + 1) & (names->capacity - 1);
    if (!names->name[at]) {
        names->name[at] = name;
        names->length[at] = length;
        names->number[at] = names->count++;
    }
    return names->number[at];
}

static bool is_name_letter(char c) {
    return isalnum((unsigned char)c) || c == '-' || c == '_';
}

/* Behind id=" or inside href="#..." and url(#...)? Then the length of the name, else 0. */
static size_t name_at(const char *begin, const char *p) {
    size_t length = 0;
    bool is_id = p - begin >= 5 && !memcmp(p - 5, " id=\"", 5);
    bool is_use = p - begin >= 2 && p[-1] == '#' && (p[-2] == '"' || p[-2] == '(');
    if (!is_id && !is_use) return 0;
    while (is_name_letter(p[length])) length++;
    return length;
}

static const char *skip_declaration(const char *p) {
    if (strncmp(p, "<?xml", 5)) return p;
    const char *end = strstr(p, "?>");
    if (!end) return p;
    end += 2;
    while (*end == '\n' || *end == '\r') end++;
    return end;
}

/* A point and its decimals, three of them at most and no zeros at the end; how many letters
 * were read. */
static size_t add_decimals(const char *p, char **to) {
    size_t read = 1, kept = 0;
    while (isdigit((unsigned char)p[read])) read++;
    for (size_t i = 1; i < read && i <= 3; i++)
        if (p[i] != '0') kept = i;
    if (kept > 0) {
        memcpy(*to, p, kept + 1);
        *to += kept + 1;
    }
    return read;
}

PlotBytes picture_with_ids(PlotBytes svg, const char *prefix, bool is_inline, Arena *arena) {
    const char *begin = (const char *)svg.data, *end = begin + svg.size;
    size_t ids = 0;
    for (const char *p = begin; p < end; p++) ids += name_at(begin, p) > 0;
    Names names = {.capacity = 64};
    while (names.capacity < 2 * ids) names.capacity *= 2;
    names.name = ARENA_NEW(arena, const char *, names.capacity);
    names.length = ARENA_NEW(arena, size_t, names.capacity);
    names.number = ARENA_NEW(arena, int, names.capacity);
    size_t room = svg.size + ids * (strlen(prefix) + 12) + 1;
    char *out = ARENA_NEW(arena, char, room), *to = out;
    bool in_path = false;
    for (const char *p = is_inline ? skip_declaration(begin) : begin; p < end;) {
        size_t length = name_at(begin, p);
        if (*p == '"') in_path = p - begin >= 3 && !memcmp(p - 3, " d=", 3);
        if (in_path && *p == '.') {
            p += add_decimals(p, &to);
            continue;
        }
        if (length == 0) {
            *to++ = *p++;
            continue;
        }
        to += snprintf(to, room - (size_t)(to - out), "%s%d", prefix, number_of(&names, p, length));
        p += length;
    }
    *to = 0;
    return (PlotBytes){(unsigned char *)out, (size_t)(to - out)};
}

/* ---- drawing ---------------------------------------------------------------------------- */

typedef struct Sink {
    Arena *arena;
    PlotBytes bytes;
    size_t capacity;
} Sink;

static cairo_status_t sink_write(void *closure, const unsigned char *data, unsigned length) {
    Sink *sink = closure;
    if (sink->bytes.size + length + 1 > sink->capacity) {
        size_t capacity = 2 * (sink->bytes.size + length) + 65536;
        unsigned char *bigger = ARENA_NEW(sink->arena, unsigned char, capacity);
        if (sink->bytes.size > 0) memcpy(bigger, sink->bytes.data, sink->bytes.size);
        sink->bytes.data = bigger;
        sink->capacity = capacity;
    }
    memcpy(sink->bytes.data + sink->bytes.size, data, length);
    sink->bytes.size += length;
    sink->bytes.data[sink->bytes.size] = 0;
    return CAIRO_STATUS_SUCCESS;
}

static cairo_surface_t *open_surface(const PictureSpec *spec, Sink *sink) {
    double w = spec->width * spec->scale, h = spec->height * spec->scale;
    if (!spec->is_svg)
        return cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)(w + 0.5), (int)(h + 0.5));
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(sink_write, sink, w, h);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
    return surface;
}

/* cairo 1.16 crashes where it runs out of memory: it draws only where there is more of it than
 * a sheet needs. */
static bool has_room(Error *err) {
    void *volatile room = malloc((size_t)64 << 20); /* volatile: the pair is not left out */
    free(room);
    return room || error_set(err, ERROR_MEMORY, "out of memory for a picture");
}

bool picture_draw(const PictureSpec *spec, Arena *arena, PlotBytes *out, Error *err) {
    /* The sink grows while the drawing allocates: it has an arena of its own. */
    Arena own = arena_reserve((size_t)4 << 30);
    if (!has_room(err)) {
        arena_release(&own);
        return false;
    }
    Sink sink = {.arena = &own};
    cairo_surface_t *surface = open_surface(spec, &sink);
    cairo_t *cr = cairo_create(surface);
    Canvas canvas = {cr, spec->is_dark ? theme_dark() : theme_light(),
                     spec->is_svg && spec->scale < 2 ? 2 : spec->scale, arena};
    cairo_scale(cr, spec->scale, spec->scale);
    if (!spec->inline_prefix) {
        cairo_rectangle(cr, 0, 0, spec->width, spec->height);
        canvas_fill(&canvas, canvas.theme.paper);
    }
    spec->draw(&canvas, spec->context);
    cairo_status_t status = cairo_status(cr);
    if (status == CAIRO_STATUS_SUCCESS && !spec->is_svg)
        status = cairo_surface_write_to_png_stream(surface, sink_write, &sink);
    cairo_destroy(cr);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    bool ok = status == CAIRO_STATUS_SUCCESS;
    if (ok && spec->is_svg) {
        const char *prefix = spec->inline_prefix;
        *out = picture_with_ids(sink.bytes, prefix ? prefix : "p", prefix != NULL, arena);
    } else if (ok) {
        out->data = ARENA_NEW(arena, unsigned char, sink.bytes.size + 1);
        out->size = sink.bytes.size;
        memcpy(out->data, sink.bytes.data, sink.bytes.size);
    }
    arena_release(&own);
    return ok || error_set(err, ERROR_LIBRARY, "cairo cannot draw the picture: %s",
                           cairo_status_to_string(status));
}
