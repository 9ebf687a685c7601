/* SPDX-License-Identifier: Apache-2.0 */
/* polar_lines.h -- the lines of equal value of a polar map, each with its number on it.
 *
 * Units    points of the page. Memory: the canvas's arena. Threads: one thread a disc.
 */
#pragma once
#include "plot/draw/polar_disc.h"

void polar_lines_draw(PolarDisc *disc);
