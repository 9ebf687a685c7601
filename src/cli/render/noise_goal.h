/* SPDX-License-Identifier: Apache-2.0 */
/* noise_goal.h -- what --noise asks for: a relative error, and the pixels whose error it is.
 *
 *     R                 of the whole frame (or crop)
 *     display:R         of the pixels that show a display
 *     display:NAME:R    of those that show this one
 *     X0,Y0,X1,Y1:R     of a rectangle of the frame, half-open as --crop's
 */
#pragma once
#include "film/film.h"
#include "scene/scene.h"

typedef struct NoiseGoal {
    double      error;   /* 0: none is asked for */
    FilmArea    area;
    bool        is_rect; /* a rectangle was named */
    const char *display; /* the name of the one that decides; NULL: none is named */
} NoiseGoal;

/* The area may not leave the crop. */
bool noise_goal_parse(const char *text, FilmRect crop, Arena *arena, NoiseGoal *out,
                      Error *err);

/* Finds the named display in the loaded scene. */
bool noise_goal_find(const Scene *scene, Arena scratch, NoiseGoal *goal, Error *err);

/* The pixels that count, in words: "the frame", "the displays". */
const char *noise_goal_words(const NoiseGoal *goal, Arena *arena);
