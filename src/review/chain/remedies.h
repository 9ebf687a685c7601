/* SPDX-License-Identifier: Apache-2.0 */
/* remedies.h -- how bright a display must be so that a case passes: a closed form, the contrast
 * of what is emitted and reflected.
 *
 * Units    cd m^-2; levels.
 * Memory   texts and lists live in the arena.
 * Threads  pure functions.
 * Fails    never.
 */
#pragma once
#include "base/arena.h"
#include "review/profile.h"
#include "review/verdict.h"

/* The least level of the display at which a case keeps all of its limits of contrast that count
 * and are not upper ones, as it is reckoned for the remedy of brightness; its own light that is
 * reflected counts (own_reflected). Infinite: at no level up to ten times today's; NaN: it
 * cannot be judged, is dark, or has no such limit. Its brighter part has 0.01 cd/m2 at least. */
typedef struct CaseLeast {
    double level; /* the figure is on the limit */
    double sure;  /* the limit is judged to be kept; at least `level` */
} CaseLeast;

CaseLeast case_least_level(const Profile *profile, const ReviewCase *c, Arena scratch);

/* Sets the case's remedy: a brightness, for the contrast limit that is missed by most, judged as
 * the case was; where none is missed, or the case cannot be judged, there is none, nor one that
 * leaves the figure within the interval it has. Of what must not be read it is dimmer, not below
 * a hundredth, nor below 0.01 cd m^-2; nor is it brighter than level_most. It is the brightness
 * with which the limit is judged to be kept although as much more (or less, where less contrast is
 * required) is reflected as the interval is wide. */
void case_remedies(const Profile *profile, double level_most, ReviewCase *c, Arena *arena);

/* Sets what the remedies of one condition's cases, and the dimming of what stands in glass
 * (pane_level_share), break: of all that is judged of the same display at the same level, every
 * limit that counts and passes, by every eye (towards one eye: by that one), judged again. Of a
 * display that is brighter images in glass and roads, too; light is linear in its level. */
void remedies_judge(const Profile *profile, Review *review, Arena *arena);
