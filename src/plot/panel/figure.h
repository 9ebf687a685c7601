/* figure.h -- the figures that a panel gives, and how each is drawn into a box.
 *
 * Units    points of the page.
 * Memory   the arena's. Threads: one thread a canvas.
 */
#pragma once
#include "plot/panel/plot.h"
#include "plot/draw/polar.h"
#include "plot/panel/input.h"

struct Figure;

/* Where the values of a drawn figure lie, for a read-out under the pointer: points of the box's
 * page. */
typedef struct FigureMap {
    enum { FIGURE_PLAIN, FIGURE_POLAR, FIGURE_CHART } kind;
    PolarPlace  disc;
    Field       field; /* polar: the values */
    const char *unit;
    Box         plot;  /* chart: the axes' rectangle */
    double      low[2], high[2];
    bool        is_log[2];
    const char *axis[2];
} FigureMap;

typedef enum SheetRole {
    SHEET_NEVER, SHEET_SPARE, SHEET_ALWAYS /* spare: where a row of the sheet has room left */
} SheetRole;

typedef void FigureDraw(Canvas *canvas, Box box, const struct Figure *figure, FigureMap *map);

typedef struct Figure {
    PlotKind       kind;
    const char    *title;
    const char    *subtitle; /* "" or one line of small letters */
    const char    *caption;  /* for the report: what one sees, with units */
    FigureDraw    *draw;
    const Subject *subject;
    int            index;    /* which pattern, which section: the drawer's own */
    SheetRole      role;
    bool           needs_primaries; /* means nothing without measured primaries and levels */
} Figure;

#define FIGURES_MAX 48

typedef struct FigureList {
    int    count;
    Figure figure[FIGURES_MAX];
} FigureList;

/* Every figure that this panel's data allow, in the order of the page. */
FigureList *plot_figures(const Subject *subject, PlotKind kind, Arena *arena);

/* Asks the panel for what options->kind shows; *report is the caller's to release. NULL: *err
 * says why. */
Subject *plot_subject(const PlotInput *input, const PlotOptions *options, Arena *arena,
                      json_t **report, Error *err);

/* The parts of that list. */
void figures_add_emission(FigureList *list, const Subject *subject);
void figures_add_curves(FigureList *list, const Subject *subject);
void figures_add_colour(FigureList *list, const Subject *subject);
void figures_add_reflection(FigureList *list, const Subject *subject);
void figures_add_fit(FigureList *list, const Subject *subject);

/* A figure of primaries or levels of a set that is white only says so and leaves the sheet. */
void figure_add(FigureList *list, const Figure *figure);

/* The ink of the i-th of so many curves that stand in an order. */
Ink figure_series_ink(const Canvas *canvas, int i, int count);

/* Title, subtitle and the figure itself. */
void figure_draw(Canvas *canvas, Box box, const Figure *figure, FigureMap *map);

/* Notes the axes of a finished chart. */
struct Chart;
void figure_map_chart(FigureMap *map, const struct Chart *chart);
