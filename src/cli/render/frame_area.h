/* SPDX-License-Identifier: Apache-2.0 */
/* frame_area.h -- an area of the frame that an option names.
 *
 *     display        the pixels that show a display
 *     display:NAME   those that show this one
 *     X0,Y0,X1,Y1    a rectangle of the frame, half-open as --crop's
 */
#pragma once
#include "film/film.h"
#include "scene/scene.h"

typedef struct FrameArea {
    const char *option;  /* who names it, for messages: "--noise"; NULL: nobody does */
    const char *instead; /* what else it takes, for messages: "noise, "; NULL: nothing */
    const char *text;    /* as it was typed */
    FilmArea area;       /* the frame, if nobody names another */
    bool is_rect;        /* a rectangle was named */
    const char *display; /* the name of the one that was named; NULL: none */
} FrameArea;

/* The whole of the rectangle. */
FrameArea frame_area_all(FilmRect rect);

/* out: what frame_area_all made of the rectangle that the area may not leave, and the option.
 * more: what follows the area in the option's text, for messages. */
bool frame_area_parse(const char *text, const char *more, FrameArea *out, Error *err);

/* Finds the named display in the loaded scene. */
bool frame_area_find(const Scene *scene, Arena scratch, FrameArea *area, Error *err);

/* In words: "the frame", "the displays". */
const char *frame_area_words(const FrameArea *area, Arena *arena);
