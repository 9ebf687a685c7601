/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/canvas.h"

#include <math.h>

#include "base/units.h"
#include "image/false_colour.h"
#include "print/utf8.h"

#define FACE "DejaVu Sans"
#define FACE_WIDTH 0.92 /* the face is drawn a little narrower than it is cut */

Ink ink_hex(unsigned rgb) {
    return (Ink){(rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0, 1};
}

Ink ink_alpha(Ink ink, double alpha) {
    ink.alpha = alpha;
    return ink;
}

Ink ink_of_primary(int primary) {
    return ink_hex((const unsigned[]){0xc7362b, 0x1e8a4f, 0x2858c6}[primary]);
}

Ink ink_of_amount(double t) {
    float srgb[3];
    false_colour_of((float)fmin(fmax(t, 0), 1), srgb);
    return (Ink){(double)srgb[0], (double)srgb[1], (double)srgb[2], 1};
}

/* The amount's lightness L* is 8 + 88 t. */
Ink ink_on_amount(double t) {
    return ink_hex(t < 0.57 ? 0xffffff : 0x14181c);
}

void amount_palette(uint32_t pixel[AMOUNTS]) {
    for (int i = 0; i < AMOUNTS; i++) {
        float srgb[3];
        false_colour_of((float)i / (AMOUNTS - 1), srgb);
        pixel[i] = 0xff;
        for (int c = 0; c < 3; c++) pixel[i] = pixel[i] << 8 | (uint32_t)(srgb[c] * 255 + 0.5f);
    }
}

/* ---- letters ---------------------------------------------------------------------------- */

static void set_face(Canvas *canvas, double size, bool is_bold) {
    cairo_matrix_t matrix;
    cairo_select_font_face(canvas->cr, FACE, CAIRO_FONT_SLANT_NORMAL,
                           is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_matrix_init_scale(&matrix, size * FACE_WIDTH, size);
    cairo_set_font_matrix(canvas->cr, &matrix);
}

double canvas_text_width(Canvas *canvas, double size, bool is_bold, const char *text) {
    cairo_text_extents_t extents;
    set_face(canvas, size, is_bold);
    cairo_text_extents(canvas->cr, text, &extents);
    return extents.x_advance;
}

void canvas_text(Canvas *canvas, double x, double y, Letters letters, const char *text) {
    double width = canvas_text_width(canvas, letters.size, letters.is_bold, text);
    double rise = 0.73 * letters.size; /* height of a capital of this face */
    cairo_t *cr = canvas->cr;
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_rotate(cr, letters.angle);
    cairo_move_to(cr, -letters.across * width, rise * (1 - letters.down));
    if (letters.halo.alpha > 0) {
        cairo_text_path(cr, text);
        cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
        canvas_stroke(canvas, (Stroke){letters.halo, 0.28 * letters.size, DASH_NONE});
        cairo_move_to(cr, -letters.across * width, rise * (1 - letters.down));
    }
    cairo_set_source_rgba(cr, letters.ink.red, letters.ink.green, letters.ink.blue,
                          letters.ink.alpha);
    cairo_show_text(cr, text);
    cairo_new_path(cr);
    cairo_restore(cr);
}

/* Bytes of the UTF-8 letter at `text`. */
static size_t letter_bytes(const char *text) {
    size_t n = 1;
    while (utf8_continues(text[n])) n++;
    return n;
}

const char *canvas_fit_text(Canvas *canvas, double size, bool is_bold, double width,
                            const char *text) {
    if (canvas_text_width(canvas, size, is_bold, text) <= width) return text;
    size_t fits = 0;
    for (size_t n = 0; text[n]; n += letter_bytes(text + n)) {
        const char *cut = arena_format(canvas->arena, "%.*s…", (int)n, text);
        if (canvas_text_width(canvas, size, is_bold, cut) > width) break;
        fits = n;
    }
    while (fits > 0 && text[fits - 1] == ' ') fits--;
    return arena_format(canvas->arena, "%.*s…", (int)fits, text);
}

/* ---- lines and areas -------------------------------------------------------------------- */

void canvas_stroke(Canvas *canvas, Stroke stroke) {
    static const struct {
        int count;
        double length[2];
    } DASHES[] = {[DASH_NONE] = {0, {0}},
                  [DASH_LONG] = {2, {7, 3}},
                  [DASH_SHORT] = {2, {3.2, 2.2}},
                  [DASH_DOT] = {2, {0.1, 2.6}}};
    cairo_t *cr = canvas->cr;
    double scale = stroke.width > 1 ? sqrt(stroke.width) : 1, length[2];
    for (int i = 0; i < 2; i++) length[i] = DASHES[stroke.dash].length[i] * scale;
    cairo_set_dash(cr, length, DASHES[stroke.dash].count, 0);
    cairo_set_line_cap(cr, stroke.dash == DASH_DOT ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(cr, stroke.width);
    cairo_set_source_rgba(cr, stroke.ink.red, stroke.ink.green, stroke.ink.blue, stroke.ink.alpha);
    cairo_stroke(cr);
}

void canvas_fill(Canvas *canvas, Ink ink) {
    cairo_set_source_rgba(canvas->cr, ink.red, ink.green, ink.blue, ink.alpha);
    cairo_fill(canvas->cr);
}

void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1, Stroke stroke) {
    cairo_move_to(canvas->cr, x0, y0);
    cairo_line_to(canvas->cr, x1, y1);
    canvas_stroke(canvas, stroke);
}

void canvas_circle(Canvas *canvas, double x, double y, double radius) {
    cairo_new_sub_path(canvas->cr);
    cairo_arc(canvas->cr, x, y, radius, 0, 2 * PI);
}

void canvas_image(Canvas *canvas, Box box, const CanvasRaster *raster) {
    int columns = raster->columns, rows = raster->rows;
    cairo_t *cr = canvas->cr;
    cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, columns, rows);
    unsigned char *bytes = cairo_image_surface_get_data(image);
    for (int row = 0; row < rows && bytes; row++) {
        uint32_t *pixel = (uint32_t *)(void *)(bytes + row * cairo_image_surface_get_stride(image));
        for (int column = 0; column < columns; column++)
            pixel[column] = raster->pixel(raster->context, column, row);
    }
    cairo_surface_mark_dirty(image);
    cairo_save(cr);
    cairo_translate(cr, box.x, box.y);
    cairo_scale(cr, box.w / columns, box.h / rows);
    cairo_set_source_surface(cr, image, 0, 0);
    if (raster->has_cells) cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    cairo_paint(cr);
    cairo_restore(cr);
    cairo_surface_destroy(image);
}

void canvas_hatch(Canvas *canvas, Box area) {
    cairo_t *cr = canvas->cr;
    cairo_rectangle(cr, area.x, area.y, area.w, area.h);
    canvas_fill(canvas, ink_alpha(INK_PAPER, 0.55));
    cairo_save(cr);
    cairo_rectangle(cr, area.x, area.y, area.w, area.h);
    cairo_clip(cr);
    for (double at = -area.h; at < area.w; at += 5) {
        cairo_move_to(cr, area.x + at, area.y + area.h);
        cairo_line_to(cr, area.x + at + area.h, area.y);
    }
    canvas_stroke(canvas, (Stroke){ink_alpha(INK_SOFT, 0.55), 0.6, DASH_NONE});
    cairo_restore(cr);
}
