/* SPDX-License-Identifier: Apache-2.0 */
/* symbol.h -- what of a symbol is foreground and what background: two classes of the luminance
 * that the display shows within a rectangle of its content.
 *
 * The threshold is Otsu's (image/content_contrast.h). A pixel beside one of the other class
 * that has a neighbour of its own class clearly farther from it (by a twentieth of the classes'
 * distance) is covered in part only: it is left out of both, so that anti-aliased edges do not
 * lower the contrast. Of a stroke too thin to fill a pixel the best ones stay. A mask, where
 * one is given, sets the classes instead: white foreground, black background; grey (a quarter
 * to three quarters) and transparent are left out.
 *
 * Units    pixels of the content; uv of the content, v down; cd m^-2 along the panel's normal
 *          at level 1.
 * Memory   from the arena; the content must outlive the result.  Threads  pure function.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "review/request/request.h"
#include "review/symbol/content_light.h"

typedef enum SymbolClass { SYMBOL_BACKGROUND, SYMBOL_FOREGROUND, SYMBOL_EDGE } SymbolClass;

typedef struct SymbolQuestion {
    const Panel *panel;
    const Image *content;    /* NULL: full white, in which there is no symbol */
    const Image *mask;       /* of the content's size; NULL: none */
    double uv[4];            /* left, top, right, bottom */
    ReviewPolarity polarity; /* AUTO: the smaller class is the foreground; with a mask, the
                                mask's */
} SymbolQuestion;

typedef struct SymbolSplit {
    ContentLight light;
    uint8_t *class_of; /* SymbolClass of each pixel of `light`, row by row */
    long foreground_count, background_count, edge_count;
    bool is_light_on_dark;  /* the foreground's mean is the brighter */
    double separability;    /* share of the variance that the two classes explain, 0..1:
                               below SYMBOL_SEPARABLE they are hardly two; NaN: by a mask */
    double threshold_cd_m2; /* NaN: by a mask */
    double foreground_cd_m2, background_cd_m2; /* means of the classes, edges left out */
    double box[4];      /* of the foreground in uv; partly covered rows and columns
                           count by their share of light */
    double stroke_px;   /* median over the foreground's pixels of their shortest chord
                           (level, upright, both diagonals: on strokes between those up
                           to 8 % long); partly covered pixels by their share of light */
    double character_v; /* height of a character in v: median of the connected parts
                           (over gaps of less than a third of a stroke) beside the
                           tallest, without those less than half as tall */
} SymbolSplit;

#define SYMBOL_SEPARABLE 0.8

/* Fails, without naming the symbol, when the rectangle is one that content_light refuses, holds
 * fewer than 16 pixels or one luminance only, or the foreground is less than half a percent of
 * it; or when the mask has another size, only one class there, or another polarity than the one
 * that is required. */
bool symbol_split(const SymbolQuestion *question, Arena *arena, SymbolSplit *out, Error *err);
