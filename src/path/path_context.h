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
#include "surface/plates.h"
#include "path/polarised.h"
#include "sunlit/sunlit_map.h"
#include "surface/surface.h"

/* Which estimators reach the light; all three agree in the mean (a test). */
typedef enum PathStrategy { PATH_MIS, PATH_LIGHTS_ONLY, PATH_BSDF_ONLY } PathStrategy;

typedef struct PathContext {
    const Scene *scene;
    const Bvh *bvh;
    const Lights *lights;
    const SurfaceTables *tables;
    PlateBoxes plates;            /* without boxes: nothing is asked of plates */
    MirrorBeams beams[BEAM_SETS]; /* without mirrors: the sun in them is left to chance, lamps
                                     in them are left out */
    SunlitMap sunlit;             /* without nodes: what the sun lights is left to chance */
    LightSelection selection;
    bool is_of_frame; /* path_context_of_frame */
    bool knows_lamps; /* beams of lamps and emitters are there: no sky and no level changes them */
    int max_bounces;  /* 0: emission only, 1: plus direct light */
    PathStrategy strategy;
    const LightGuide *guide;   /* guides wide scattering; NULL: the surfaces alone decide */
    bool without_mirrored_sun; /* the sun in the mirror of a display that the eye sees is left
                                  out: the caller adds it */
    bool is_probe;             /* light via the first surface counts, however dark that is: roulette
                                  compares with the throughput behind it; in a frame only behind displays */
    const PolarisedEye *eye;   /* rays from it carry how light is polarised; NULL: unpolarised */
} PathContext;

static inline PlateView plate_view(const PathContext *context, const Wavelengths *wavelengths) {
    return (PlateView){context->scene, context->bvh, context->tables, &context->plates,
                       wavelengths};
}

/* Is there anything that this choice may sample? */
static inline bool path_context_has(const PathContext *context, int choice) {
    return choice == LIGHTS_SUNLIT ? context->sunlit.nodes != NULL
                                   : lights_has(context->lights, (LightSet)choice);
}
