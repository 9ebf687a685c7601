/* page.h -- figures side by side on one page, as the bytes of an SVG or PNG picture.
 *
 * Units    points of the page; a PNG has pixels_per_point of them.
 * Memory   the arena's. Threads: one page at a time per arena.
 * Fails    with cairo's reason.
 */
#pragma once
#include "base/error.h"
#include "plot/panel/figure.h"
#include "plot/draw/picture.h"

typedef struct PageSpec {
    const FigureList *list;
    const Subject    *subject;
    PlotKind kind;
    int      width, height; /* pixels; 0: chosen */
    bool     is_dark;
} PageSpec;

/* The picture of a whole page with heading and legend. */
bool page_svg(const PageSpec *spec, Arena *arena, PlotBytes *out, Error *err);
bool page_png(const PageSpec *spec, Arena *arena, PlotBytes *out, Error *err);

typedef struct FigureFrame {
    double      width, height; /* points */
    const char *prefix;        /* of the drawing's ids */
    bool        is_dark;
} FigureFrame;

/* One figure alone, without its title, to stand inside another document. */
bool page_figure_svg(const Figure *figure, const FigureFrame *frame, Arena *arena,
                     PlotBytes *out, FigureMap *map, Error *err);
