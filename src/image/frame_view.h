/* SPDX-License-Identifier: Apache-2.0 */
/* frame_view.h -- into which directions the pixels of a frame look, and what each is of space.
 *
 * A frame of this program says so by "worldToCamera" and one of "parhelion:yfov_deg" (a
 * perspective view), "parhelion:ymag_m" (an orthographic one) and "parhelion:projection" (a
 * fisheye, image/fisheye.h); one read from a Radiance picture by that picture's line VIEW=,
 * which is kept as the attribute "VIEW".
 *
 * Frame    pixels of the display window from its upper left corner, x right, y down; directions
 *          in the head's axes: right, up, ahead along the line of sight.
 * Threads  pure functions.
 * Fails    where the frame does not say it, or says something that is none.
 */
#pragma once
#include "image/fisheye.h"
#include "image/frame.h"

typedef struct FrameView {
    bool is_perspective; /* rays from one point: of a fisheye, too */
    Fisheye fisheye;
    double half_width, half_height; /* perspective: at distance 1; orthographic: m; fisheye:
                                       radii of its circle */
    double shift[2];   /* of the middle, right and up, in pictures (Radiance's -vs, -vl) */
    int width, height; /* pixels */
    double eye[3], right[3], up[3], ahead[3]; /* m, world; unit */
} FrameView;

/* The frame's attribute for frame_view_find and frame_fisheye. */
void frame_set_fisheye(FrameImage *frame, Fisheye kind, Arena *arena);

/* FISHEYE_NONE of other views. */
Fisheye frame_fisheye(const FrameImage *frame);

bool frame_view_find(const FrameImage *frame, FrameView *out, Error *err);

/* The same for frame_view_sees alone: all is seen where the frame does not say its view. */
FrameView frame_view_circle(const FrameImage *frame);

/* False of a pixel that lies outside a fisheye's circle altogether: it has no light. */
bool frame_view_sees(const FrameView *view, int x, int y);

/* A pixel of space: not of orthographic views. */
typedef struct ViewPixel {
    double direction[3]; /* of its middle, unit: right, up, ahead; out of a circle its rim */
    double sr;           /* its solid angle before the eye, and */
    double projected_sr; /* that times the cosine to the line of sight */
} ViewPixel;

/* Exact: the pixels of a fisheye have 2 pi and pi sr together. The integral of (1 - cos a) and
 * of half of sin^2 a, a the angle to the line of sight, over the angle about it along the
 * pixel's edges (Green's theorem), by Gauss's rule of five points. */
ViewPixel frame_view_pixel(const FrameView *view, int x, int y);

/* ---- Radiance's VIEW ----------------------------------------------------------------------
 *
 * Options of rpict: -vtv perspective, -vta equidistant ("angular") fisheye, -vtl parallel; -vp,
 * -vd, -vu, -vh, -vv, -vs, -vl, -vo, -va (G. Ward, "Radiance File Formats"). */

/* The options of a crop of the view, in the arena. An equisolid fisheye has no type there. */
bool frame_view_words(const FrameView *view, ExrWindow crop, Arena *arena, const char **out,
                      Error *err);
