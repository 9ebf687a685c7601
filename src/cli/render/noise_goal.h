/* SPDX-License-Identifier: Apache-2.0 */
/* noise_goal.h -- what --noise requests, [AREA:]R: a relative error R, and the pixels whose
 * error it is (frame_area.h). */
#pragma once
#include "cli/render/frame_area.h"

typedef struct NoiseGoal {
    double error; /* 0: none is requested */
    FrameArea of;
} NoiseGoal;

/* The area may not leave the crop. */
bool noise_goal_parse(const char *text, FilmRect crop, Arena *arena, NoiseGoal *out, Error *err);
