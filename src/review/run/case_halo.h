/* SPDX-License-Identifier: Apache-2.0 */
/* case_halo.h -- the halo that a display's zones lay on the black about a symbol, and whether
 * the eye sees it above its own scatter.
 *
 * The display's active area, as far as the symbol's rectangle and three spreads of a zone's
 * light around it, is parted into cells. In each the halo is what its black leaks towards the
 * eye, less what it would with the zones at their least drive; the veil is the stray light
 * (eye_spread.h) of what all other cells show. The halo is taken for a patch as wide as twice a
 * zone's spread (60' at most), before a background of what the cell shows without it, reflected
 * light, and the larger of this veil and the case's own; its level is the halo over Adrian's
 * least difference (visibility.h), in the cell where that is largest. A halo has no edge and is
 * harder to see than such a patch: the level errs towards visible. What the controller does not
 * compensate of a lit background is no halo here.
 *
 * Memory   the arena's. Threads: pure. Fails: never; what is not known is NaN.
 */
#pragma once
#include "path/path_context.h"
#include "review/run/symbols.h"
#include "review/verdict.h"
#include "vision/human_eye.h"

typedef struct HaloLook {
    const SetupSymbol *symbol;
    Vec3               eye;
    HumanEye           observer;
    double             transmittance; /* of what lies between */
} HaloLook;

/* Sets c->halo of a case whose luminances are known, where its display has zones. */
void case_halo(const HaloLook *look, ReviewCase *c, Arena scratch);
