/* spectral_warp.h -- how the spectra of a panel's primaries bend to a measured colour (design:
 * panel, section 7). Private to src/panel.
 *
 * S = T exp(c0 + c1 t + c2 t^2), t = (lambda - 560 nm) / 180 nm, T the primary's spectrum, all
 * linear between whole nm. Only +, -, *, / and square roots, so that tables come out the same
 * everywhere.
 */
#pragma once
#include "panel/query/panel_file.h"

/* Where colours lie: `count` pairs (ln X/Y, ln Z/Y), which are overwritten. */
PanelBendRange panel_bend_range(float *const ratio[2], int count);

/* The table of coefficients over bend->range for a spectrum of 1 cd m^-2. Returns how many
 * colours cannot be reached: there the nearest ones on the way from its own colour serve. */
int panel_bend_fill(const float *spectrum, PanelBend *bend);

/* XYZ of a spectrum. */
void panel_spectrum_xyz(const float *spectrum, double xyz[3]);

/* Scales a spectrum to 1 cd m^-2; false: it has no light. */
bool panel_spectrum_normalise(float *spectrum);

/* Where a panel has no spectra of its own. */
typedef enum PanelSpectraKind {
    PANEL_SPECTRA_STORED = 0,
    PANEL_SPECTRA_TYPICAL = 1, /* peaks at 625, 535 and 455 nm */
    PANEL_SPECTRA_REC709 = 2   /* the Rec.709 primaries' smooth spectra under D65 */
} PanelSpectraKind;

/* Relative spectrum of primary 0..2. */
void panel_spectrum_default(PanelSpectraKind kind, int primary, float *out);
