/* SPDX-License-Identifier: Apache-2.0 */
/* pane_images.h -- where an eye sees displays in glass: the passenger's screen in the
 * windscreen, by night above all.
 *
 * Each display is cut into small cells. The middle and the corners of each are looked for in
 * each pane by the point that turns the eye's ray to them (mirror/reflection_point.h): no path is
 * traced and no chance is in it. A point is shown where the pane has such a point, where the
 * display faces it, and where nothing stands between: neither before the pane nor behind it.
 * Windows and holes hide nothing, unless less than a hundredth of the light passes them. A cell
 * whose corners and middle differ in that is cut further.
 *
 * Panes        parts of the scene that let light through: glass. Of one with a thickness of its
 *              own (a solid) the face that is turned to the eye counts; of a laminated sheet
 *              the face that is met. The ghost by the other face stands beside by as much as
 *              the pane's thickness and wedge put it, some minutes of arc: paths that read the
 *              image (pane_image_reading.h) have it.
 * Approximate  512 cells are a display; the smallest, a sixteenth as wide, count as their
 *              middle does. What is shown or hidden within a large cell alone is missed. An
 *              image by two panes, one after the other, is none of these.
 * Units        metres, scene; directions unit, world; sr.
 * Memory       lists live in the arena. Threads: starts its own; the same for any count.
 */
#pragma once
#include "review/light/setup.h"
#include "scene/point/ray_ends.h"

/* A triangle of the field of view. */
typedef struct PaneCell {
    Vec3 corner[3];
    Vec3 place[3];        /* of the display, that the first face shows there, m, scene */
    Vec3 seen_from;       /* m, scene: as far along the way from the display to the pane as the eye
                             is: a flat pane shows what an eye there would see straight */
    int id;               /* among all cells of the display or raster */
    double sr, sr_before; /* of it, of all cells before it */
} PaneCell;

/* Of the display's area: they add up to 1. */
typedef struct PaneShares {
    double shown;
    double ends;    /* the pane ends before it */
    double away;    /* its back is turned to the pane */
    double covered; /* something stands between */
} PaneShares;

typedef struct PaneImage {
    int pane_id, part_id; /* scene parts: the pane's, the display's */
    PaneShares share;
    int covered_by;  /* scene part that covers most of it; NO_ID: nothing does */
    PaneCell *cells; /* that are shown; 0: there is no image */
    int cell_count;
    double sr;     /* of all */
    Vec3 towards;  /* their middle, by solid angle; 0 where there is none */
    Vec3 *outline; /* convex, once around them; at most PANE_OUTLINE */
    int outline_count;
} PaneImage;

#define PANE_OUTLINE 16

/* Of every display in every pane of the setup's scene, by panes, in the scene's order: also
 * those that have no image, whose shares say why. */
PaneImage *pane_images_find(const Setup *setup, Vec3 eye, int *count, Arena *arena);

/* Part of a display: a raster of side x side fields of two cells each. Corner (i, j) is
 * corner[j (side + 1) + i]; the cells of field f are 2f, with its corners (0, 0), (1, 0) and
 * (0, 1), and 2f + 1; middle[cell] lies in the middle of each. */
#define PANE_RASTER 16
typedef struct PaneRaster {
    int part_id; /* the display's */
    TrianglePoint corner[(PANE_RASTER + 1) * (PANE_RASTER + 1)];
    TrianglePoint middle[2 * PANE_RASTER * PANE_RASTER];
    /* false: the display has no such place */
    bool has_corner[(PANE_RASTER + 1) * (PANE_RASTER + 1)];
    bool has_middle[2 * PANE_RASTER * PANE_RASTER];
} PaneRaster;

/* The panes of a scene: parts, of which `out` has room for all; their number. */
int pane_images_panes(const Scene *scene, int *out);

/* A raster as one pane shows it; shares are of its cells, by number. Without an outline. */
PaneImage pane_image_of(const Setup *setup, Vec3 eye, int pane_id, const PaneRaster *raster,
                        Arena *arena);
