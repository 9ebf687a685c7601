/* SPDX-License-Identifier: Apache-2.0 */
/* glazing.h -- a laminated pane: its layers, its wedge, the dirt on it.
 *
 * The pane is one sheet of triangles without thickness; what stands here is what light would
 * meet in it.
 *
 * Units    m, radians; shares in [0, 1].
 * Threads  constant once loaded.
 */
#pragma once
#include "spectrum/thin_film.h"

#define GLAZING_LAYERS_MAX 8

typedef struct GlazingLayer {
    float thickness_m;
    float ior; /* 1 or more */
} GlazingLayer;

typedef struct Glazing {
    GlazingLayer layers[GLAZING_LAYERS_MAX]; /* the first is on the front of the triangles, from
                                              * where their vertices run counter-clockwise */
    int layer_count;
    Curve absorbance;    /* -ln of what all layers let through along the normal, no faces */
    float absorbing_ior; /* of what absorbs, a mean: for the length of a slanted way */
    float wedge[2];      /* by how much the thickness grows per length towards +u and +v */
    float wedge_ior;     /* of the layer that has the wedge */
    float haze_share;    /* of the light that passes: scattered forward */
    float haze_width;    /* sine of the angle to the straight way within which half of it is */
    const LayerStack *coating[2]; /* on the face of the first layer (outside: the front of the
                                   * triangles), of the last (inside); in air; NULL: bare */
} Glazing;
