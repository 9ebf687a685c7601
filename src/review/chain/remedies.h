/* SPDX-License-Identifier: Apache-2.0 */
/* remedies.h -- what a designer could change so that a case passes, and how much each gives.
 *
 * By kinds, in the order of RemedyKind: the display brighter, tilted, under a hood, coated,
 * another panel, another material of what it mirrors. Nothing blinds a pane, and a seat or who
 * sits in it is no trim (chain/places.h). Each is reckoned from what is known:
 *
 *   brightness, panel  closed forms: the contrast of what is emitted and reflected
 *   coating, trim      a quarter of the mirror's light is left; of a part's what MATT_BLACK
 *                      sends in the place of its base colour, as if light met it once
 *   hood               the light whose paths would cross it (scene/load/hood.h) is gone, and
 *                      its own is left out; none that would stand before the symbol is offered
 *   tilt               the light is read again, by fresh paths, with the display leaning where
 *                      it stands
 *
 * Units    cd m^-2; metres, world; degrees in words.
 * Memory   texts and lists live in the arena.
 * Threads  starts its own; the same figures for any count.
 * Fails    never.
 */
#pragma once
#include "review/chain/causes.h"
#include "review/profile.h"
#include "review/symbol/symbol_sight.h"

typedef struct RemedyArgs {
    const ReadingTools *tools;
    const ProbeAim     *aim;     /* at what is visible of the symbol */
    SymbolLook          look;    /* at all of it */
    SymbolPoint         middle;  /* of it */
    const ReviewDisplay *display;
    const double       *forward; /* [3] where the vehicle points, as the request says */
    const Profile      *profile; /* limits */
    const ReviewWith   *occupant; /* who was put there under this condition; NULL: nobody */
} RemedyArgs;

/* What the search for causes is to keep apart. */
ChainPlaces remedy_places(const RemedyArgs *args, Arena *arena);

/* The least level of the display at which a case keeps all of its limits of contrast that count
 * and are not upper ones, as it is reckoned for the remedy of brightness; its own light that is
 * reflected counts (own_reflected). Infinite: at no level up to ten times today's; NaN: it
 * cannot be judged, is dark, or has no such limit. */
typedef struct CaseLeast {
    double level; /* the figure is on the limit */
    double sure;  /* the limit is judged to be kept; at least `level` */
} CaseLeast;

CaseLeast case_least_level(const Profile *profile, const ReviewCase *c, Arena scratch);

/* Sets the case's remedies, and whether it is an empty seat that washes it out. They are for
 * the contrast limit that is missed by most, and judged as the case was; where none is missed,
 * or the case cannot be judged, there are none, nor is anything listed that leaves the figure
 * within the interval it has. Of what must not be read only what shows less of it to that eye
 * is: dimmer, not below a hundredth, and tilted. A brightness, and a panel, is that with which
 * the limit is judged to be kept although as much more (or less, where less contrast is
 * required) is reflected as the interval is wide. */
void case_remedies(const RemedyArgs *args, const CauseFacts *facts, ReviewCase *c,
                   Arena *arena);
