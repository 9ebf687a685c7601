/* SPDX-License-Identifier: Apache-2.0 */
/* show_scene.h -- a bare display, the light on it and the eye that sees it, for `panel show`.
 *
 * Frame    the display's: metres from its centre, +X to its right as seen, +Y up, +Z towards
 *          who looks at it. Theta counts from +Z, phi from +X to +Y, as everywhere of a panel.
 * Memory   texts lie in the caller's arena.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

#define SHOW_DISPLAY "display" /* the material's name */

typedef struct ShowScene {
    double size_m[2];                    /* of the active area */
    double eye_m[3];                     /* z > 0; looks at the centre */
    double ambient_lx;                   /* on the display, from an even dome; 0: none */
    double directed_lx;                  /* on the display, from a disc; 0: none */
    double directed_theta, directed_phi; /* degrees */
} ShowScene;

/* Where theta, phi (degrees) and a distance lead. */
void show_place(double theta_deg, double phi_deg, double distance_m, double out_m[3]);

double show_distance(const double at_m[3]);

/* Degrees; phi from 0 to 360. */
void show_angles(const double at_m[3], double *theta_deg, double *phi_deg);

/* glTF: the display is a material without a panel or content. */
const char *show_scene_text(const ShowScene *scene, Arena *arena);

/* Frames the display: all of it, as large as it fits. size: pixels; given: as typed, else set,
 * 1280 the longer side. Fails where a corner does not lie before the eye. */
bool show_frame(const ShowScene *scene, bool given, int size[2], double *fov_deg, Error *err);
