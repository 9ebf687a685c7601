/* SPDX-License-Identifier: Apache-2.0 */
/* primary_bands.h -- spectra for primaries whose colours were measured and whose spectra were
 * not.
 *
 * A backlight's kind has three bands (bell curves over wavelength, one each for red, green and
 * blue); a primary is the mixture of them, no part below 0, that has its measured colour. The
 * three bands' triangle must hold all three colours: where the kind's own does not, its bands
 * move as little as they need, and then become narrower. Bands are linear between even nm.
 *
 * Units    nm; XYZ in any unit. Memory: none. Threads: pure function.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "spectrum/spectral_table.h"

/* "wled-ysf" (white LEDs, yellow phosphor), "wled-ksf" (red phosphor of narrow lines), "oled",
 * "qd" (quantum dots), "rgb-led", "laser", NULL. The first is taken where none is stated. */
extern const char *const primary_backlights[];

/* 1 + the place of a name; 0: there is none. */
int primary_backlight_named(const char *name);

/* All of them, with commas between. */
const char *primary_backlight_names(Arena *arena);

/* delta u'v' of a colour that counts as reached; beyond the spectrum's own locus none does */
#define PRIMARY_BANDS_MISS 1e-4
#define PRIMARY_BANDS_MOST 2e-3 /* further off the bands are not the display's */

typedef struct PrimaryBands {
    int backlight; /* a place in the list */
    double peak_nm[3], fwhm_nm[3];
    double miss;     /* largest delta u'v' of a primary */
    double off_uv;   /* of white behind a filter, to the narrowest bands of the same colours: */
    double off_edge; /* a pane whose transmittance halves from 400 to 700 nm or rises so; an
                        edge at 480, 500, ... 620 nm */
    float spectrum[3][SPECTRAL_COUNT]; /* their XYZ are those that were given, but for a
                                          factor for all */
} PrimaryBands;

/* backlight: 1 + a place in the list, 0: not stated; peak_nm: stated (0: not), which stay if
 * they can. xyz: of red, green and blue, black not in it. False: the nearest miss a colour by
 * more than PRIMARY_BANDS_MOST. */
bool primary_bands_find(int backlight, const double peak_nm[3], const double xyz[3][3],
                        PrimaryBands *out);
