/* SPDX-License-Identifier: Apache-2.0 */
/* panel.h -- a measured display: what it emits and reflects at any angle.
 *
 * Frame    the display's own: +z its normal, +x the viewer's right (phi 0), +y up (phi 90).
 *          Directions are unit vectors that leave the display.
 * Units    emission in CIE XYZ, Y in cd m^-2, or spectral radiance in W m^-2 sr^-1 nm^-1;
 *          reflection in sr^-1, the cosine not included.
 * Memory   the file is read once and queried as it stands; panel_close gives the copy back. A
 *          file that changes, shrinks or goes away afterwards makes no difference.
 * Threads  a Panel is const after panel_open: any number of threads may query it.
 */
#pragma once

typedef struct Panel Panel; /* opaque: the file's layout is private to src/panel */

/* How far the emitted light is linearly polarised, and along which azimuth its electric field
 * swings: radians in [0, pi), 0 right, pi/2 up as someone facing the display sees it. */
typedef struct PanelPolarisation {
    float degree;  /* 0 to 1; 0: unpolarised, or not in the file */
    float azimuth; /* 0 with degree 0 */
} PanelPolarisation;
