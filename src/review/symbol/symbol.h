/* symbol.h -- what of a symbol is foreground and what background: two classes of the luminance
 * that the display shows within a rectangle of its content.
 *
 * The threshold is Otsu's (image/content_contrast.h). A pixel beside one of the other class that
 * has a neighbour of its own class clearly farther from it (by a twentieth of the classes'
 * distance) is covered in part only: it is left out of both, so that anti-aliased edges do not
 * lower the contrast. A stroke so thin that no pixel of it is whole keeps its best ones. A mask,
 * where one is given, says the classes instead: white foreground, black background, grey (a
 * quarter to three quarters) or transparent left out.
 *
 * Units    pixels of the content; uv of the content, v down; cd m^-2 along the panel's normal at
 *          level 1.
 * Memory   from the arena.  Threads  pure functions.
 */
#pragma once
#include "review/symbol/content_light.h"
#include "review/request/request.h"

typedef enum SymbolClass { SYMBOL_BACKGROUND, SYMBOL_FOREGROUND, SYMBOL_EDGE } SymbolClass;

typedef struct SymbolQuestion {
    const Panel   *panel;
    const Image   *content;  /* NULL: full white, which no symbol can be found in */
    const Image   *mask;     /* of the content's size; NULL: none */
    double         uv[4];    /* left, top, right, bottom */
    ReviewPolarity polarity; /* AUTO: the smaller class is the foreground. A mask decides
                                itself and needs AUTO or what it finds */
} SymbolQuestion;

typedef struct SymbolSplit {
    ContentLight light;
    uint8_t *class_of;         /* SymbolClass, light.width * light.height, row by row */
    long     foreground_count, background_count, edge_count;
    bool     is_light_on_dark; /* the foreground's mean is the brighter */
    double   separability;     /* share of the variance that the two classes explain, 0..1:
                                  below SYMBOL_SEPARABLE they are hardly two; NaN: by a mask */
    double   threshold_cd_m2;  /* NaN: by a mask */
    double   foreground_cd_m2, background_cd_m2; /* means of the classes, edges left out */
    double   box[4];           /* of the foreground in uv, partly covered rows and columns by
                                  their share */
    double   stroke_px;        /* median over the foreground's pixels of their shortest chord
                                  (level, upright, both diagonals; up to 8 % long on strokes
                                  between), partly covered pixels by their share of light */
    double   character_v;      /* height of a character: median of the parts (8-connected) of the
                                  line with the tallest, without those less than half as tall */
} SymbolSplit;

#define SYMBOL_SEPARABLE 0.8

/* Fails when the rectangle is as content_light refuses it, holds fewer than 16 pixels or one
 * luminance only, or the mask has another size or only one class there; the text does not name
 * the symbol. */
bool symbol_split(const SymbolQuestion *question, Arena *arena, SymbolSplit *out, Error *err);
