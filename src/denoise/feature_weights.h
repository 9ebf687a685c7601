/* SPDX-License-Identifier: Apache-2.0 */
/* feature_weights.h -- how alike the pixels around are by their surface alone.
 *
 * Where light is so noisy that no two patches of it look alike, the patches' weights leave a
 * pixel to itself; normal, albedo, depth and nearness still know what belongs together
 * (Rousselle, Manzi and Zwicker 2013, the filter that goes by features).
 *
 * Threads  any number: buffers are only read.
 */
#pragma once
#include "denoise/patch_weights.h"

/* Weights in [0, 1] of the window around a pixel; 0 where there is none or one of another
 * kind. */
void feature_weights(const DenoiseBuffers *buffers, int x, int y, float weights[PATCH_OFFSETS]);
