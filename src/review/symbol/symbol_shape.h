/* SPDX-License-Identifier: Apache-2.0 */
/* symbol_shape.h -- size of what is drawn: extent, width of the strokes, height of characters.
 *
 * Units    pixels of the drawing, its first row's upper edge at 0.  Threads  pure function.
 */
#pragma once
#include "base/arena.h"

/* The share of each pixel that is drawn on: 1 is whole, less is an edge. */
typedef struct SymbolDrawing {
    int width, height;
    const float *share; /* width * height, row by row; at least one is whole */
} SymbolDrawing;

typedef struct SymbolShape {
    double left, top, right, bottom; /* of what is whole, and its edges by their share */
    double stroke_px;    /* median over whole pixels of their shortest chord (level, upright,
                            both diagonals) */
    double character_px; /* median height of the connected parts (over gaps of less than a third
                            of stroke_px) that stand beside the tallest, without those less
                            than half as tall */
} SymbolShape;

SymbolShape symbol_shape(const SymbolDrawing *drawing, Arena scratch);
