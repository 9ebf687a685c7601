/* SPDX-License-Identifier: Apache-2.0 */
/* path_context.h -- what all paths of a scene share.
 *
 * Threads  const once built (path.h).
 */
#pragma once
#include "bvh/bvh.h"
#include "guide/guide.h"
#include "light/light.h"
#include "path/light_selection.h"
#include "path/mirror_beams.h"
#include "path/polarised.h"
#include "path/surface.h"

/* Which estimators reach the light; all three agree in the mean (a test). */
typedef enum PathStrategy { PATH_MIS, PATH_LIGHTS_ONLY, PATH_BSDF_ONLY } PathStrategy;

typedef struct PathContext {
    const Scene         *scene;
    const Bvh           *bvh;
    const Lights        *lights;
    const SurfaceTables *tables;
    MirrorBeams          beams; /* without mirrors: the sun in them is left to chance */
    LightSelection       selection;
    int                  max_bounces; /* 0: emission only, 1: plus direct light */
    PathStrategy         strategy;
    const LightGuide    *guide; /* leads wide scattering; NULL: the surfaces alone decide */
    bool without_mirrored_sun; /* the sun in the mirror of a display that the eye sees is left
                                  out: who asks knows it */
    bool is_probe; /* what the first surface reflects is asked for, be it ever so dark: which
                      paths are dim counts from there; of a frame's those that a display
                      starts */
    bool    has_subpixels; /* some display: the frame's rays carry what its pixels cover */
    RayCone cone; /* of the frame whose rays these are: displays with sub-pixels show them to a
                     ray of a frame that sees them large enough */
    const PolarisedEye *eye; /* rays from it carry how light is polarised; NULL: unpolarised */
} PathContext;
