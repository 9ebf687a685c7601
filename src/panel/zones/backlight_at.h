/* SPDX-License-Identifier: Apache-2.0 */
/* backlight_at.h -- the backlight at a place, and the codes that pixels get there. HOT.
 *
 * Places, threads: backlight.h. Fails: never.
 */
#pragma once
#include "panel/zones/backlight.h"

/* b, BACKLIGHT_DARK to 1. */
float backlight_at(const Backlight *backlight, const float place[2]);

/* The codes that pixels get where the backlight is b: those of the picture, or compensated
 * ones. */
void backlight_codes(const Backlight *backlight, float b, const float shown[3], float codes[3]);
