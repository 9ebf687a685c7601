/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/picture.h"

#include <cairo-svg.h>
#include <stdlib.h>
#include <string.h>

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
    Canvas canvas = {cr, spec->is_svg && spec->scale < 2 ? 2 : spec->scale, arena};
    cairo_scale(cr, spec->scale, spec->scale);
    cairo_rectangle(cr, 0, 0, spec->width, spec->height);
    canvas_fill(&canvas, INK_PAPER);
    spec->draw(&canvas, spec->context);
    cairo_status_t status = cairo_status(cr);
    if (status == CAIRO_STATUS_SUCCESS && !spec->is_svg)
        status = cairo_surface_write_to_png_stream(surface, sink_write, &sink);
    cairo_destroy(cr);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    bool ok = status == CAIRO_STATUS_SUCCESS;
    if (ok) {
        out->data = ARENA_NEW(arena, unsigned char, sink.bytes.size + 1);
        out->size = sink.bytes.size;
        memcpy(out->data, sink.bytes.data, sink.bytes.size);
    }
    arena_release(&own);
    return ok || error_set(err, ERROR_LIBRARY, "cairo cannot draw the picture: %s",
                           cairo_status_to_string(status));
}
