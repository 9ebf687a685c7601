/* SPDX-License-Identifier: Apache-2.0 */
/* setup_eyes.h -- where the eyes of a request are in a setup's scene.
 *
 * Units    m, in the coordinates of the scene.
 * Errors   an eye's camera is missing: with the request's file.
 * Threads  pure functions.
 */
#pragma once
#include "review/light/setup.h"

/* The points of an eye, m, as many as it has; in the arena. NULL: its camera is missing. */
Vec3 *setup_eye_points(const Setup *setup, const ReviewEye *eye, int *count, Arena *arena,
                       Error *err);

/* The point of an eye that is one; of a box its centre. */
bool setup_eye_middle(const Setup *setup, const ReviewEye *eye, Arena scratch, Vec3 *out,
                      Error *err);
