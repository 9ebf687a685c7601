/* SPDX-License-Identifier: Apache-2.0 */
/* canvas.h -- what every figure is drawn with: inks, letters, lines, hatching.
 *
 * Units    "points" of the page, y down; a page is scaled to its picture as a whole.
 * Frame    angles of texts in radians, clockwise as y runs down.
 * Threads  one thread a canvas. Fails: never here; cairo's status is read once at the end.
 */
#pragma once
#include <cairo.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

typedef struct Ink {
    double red, green, blue, alpha; /* sRGB, 0 to 1 */
} Ink;

/* The few inks of a page. */
#define INK_PAPER ink_hex(0xffffff)
#define INK_TEXT ink_hex(0x1b2128)
#define INK_SOFT ink_hex(0x57616b)
#define INK_FAINT ink_hex(0x98a1a9)
#define INK_GRID ink_hex(0xe7eaed)
#define INK_ACCENT ink_hex(0xc77a12)

Ink ink_hex(unsigned rgb);
Ink ink_alpha(Ink ink, double alpha);
Ink ink_of_primary(int primary); /* red, green, blue of a display */

/* By false_colour.h, t in [0, 1] and cut off there; which ink reads on it; and opaque pixels of
 * AMOUNTS of them, evenly from 0 to 1. */
#define AMOUNTS 256
Ink ink_of_amount(double t);
Ink ink_on_amount(double t);
void amount_palette(uint32_t pixel[AMOUNTS]);

typedef struct Canvas {
    cairo_t *cr;
    double pixels_per_point; /* of the finished picture, for rasters inside it */
    Arena *arena;
} Canvas;

typedef struct Box {
    double x, y, w, h;
} Box;

/* ---- letters ---------------------------------------------------------------------------- */

#define SIZE_HEADING 20.0
#define SIZE_TITLE 13.0
#define SIZE_TEXT 10.5
#define SIZE_TICK 9.5
#define SIZE_SMALL 8.5

typedef struct Letters {
    double size; /* points */
    Ink ink;
    double across, down; /* 0 left/top .. 0.5 middle .. 1 right/bottom of the text is at x, y */
    double angle;
    bool is_bold;
    Ink halo; /* alpha 0: none */
} Letters;

/* UTF-8. */
void canvas_text(Canvas *canvas, double x, double y, Letters letters, const char *text);
double canvas_text_width(Canvas *canvas, double size, bool is_bold, const char *text);

/* Cuts the text so that it fits, with an ellipsis; from the arena where it is cut. */
const char *canvas_fit_text(Canvas *canvas, double size, bool is_bold, double width,
                            const char *text);

/* ---- lines and areas -------------------------------------------------------------------- */

typedef enum Dash { DASH_NONE, DASH_LONG, DASH_SHORT, DASH_DOT } Dash;

typedef struct Stroke {
    Ink ink;
    double width;
    Dash dash;
} Stroke;

/* The current path of canvas->cr, which is emptied. */
void canvas_stroke(Canvas *canvas, Stroke stroke);
void canvas_fill(Canvas *canvas, Ink ink);

void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1, Stroke stroke);

/* Adds a whole circle to the path. */
void canvas_circle(Canvas *canvas, double x, double y, double radius);

/* A pixel of a raster, 0xAARRGGBB with the colours multiplied by alpha. */
typedef uint32_t CanvasPixel(const void *context, int column, int row);

/* Rasters are smooth between their pixels, or every pixel is a cell of its own. */
typedef struct CanvasRaster {
    int columns, rows;
    bool has_cells;
    CanvasPixel *pixel;
    const void *context;
} CanvasRaster;

/* The raster, spread over the box. */
void canvas_image(Canvas *canvas, Box box, const CanvasRaster *raster);

/* The area inside the present clip is dimmed with paper and hatched: not measured. */
void canvas_hatch(Canvas *canvas, Box area);
