/* SPDX-License-Identifier: Apache-2.0 */
/* halo_square.h -- what the zones of a panel make of a test picture: a white square on black in
 * the middle of the display.
 *
 * Units    mm on the panel, cd m^-2. Memory: the arena's. Threads: const once made.
 * Fails    never.
 */
#pragma once
#include "base/vec.h"
#include "panel/query/panel_zones.h"

#define HALO_SQUARE_MM 10.0 /* its side; on a smaller display half of the shorter side */

typedef struct HaloSquare {
    const Panel *panel;
    const Backlight *backlight;
    double side_mm;
    double full_black;  /* along the normal, all zones full */
    double black_drive; /* mean drive of an all-black picture; of a white one 1 */
} HaloSquare;

/* Of a panel with zones. */
HaloSquare halo_square_make(const Panel *panel, Arena *arena);

/* The backlight over full so many mm to the right of the square's middle. */
double halo_square_backlight(const HaloSquare *halo, double mm);

/* The luminance that black sends there along `direction` (the display's frame). */
double halo_square_black(const HaloSquare *halo, double mm, Vec3 direction);
