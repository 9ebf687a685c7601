/* SPDX-License-Identifier: Apache-2.0 */
/* colour_map.h -- colours for numbers: ordered by lightness, so that order survives in print.
 *
 * Units    t in [0, 1], cut off there; colours are sRGB, each component in [0, 1].
 * Threads  pure functions.
 */
#pragma once
#include <stdint.h>

typedef enum ColourMap {
    MAP_AMOUNT,     /* dark violet, green, yellow: "viridis" */
    MAP_RATIO,      /* dark blue, grey, yellow: "cividis", the same to most colour-blind eyes */
    MAP_DIFFERENCE, /* nothing is cream, much is dark plum: lightness falls */
    MAP_SCATTER,    /* black, red, yellow: "inferno" */
    MAP_SIGNED,     /* blue below, light grey at 0.5, red above: lightness falls to both ends */
    MAP_COUNT
} ColourMap;

/* The colour at t. Along every map but MAP_SIGNED CIE L* is linear in t. */
void colour_map_at(ColourMap map, double t, double srgb[3]);

/* The same, as an opaque pixel 0xffRRGGBB. */
uint32_t colour_map_pixel(ColourMap map, double t);

/* Which ink reads on the colour at t, in black and white too: 1 light, 0 dark. */
int colour_map_wants_light_ink(ColourMap map, double t);
