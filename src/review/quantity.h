/* SPDX-License-Identifier: Apache-2.0 */
/* quantity.h -- what limits bound: each kind of quantity, its unit, how contrasts of one kind
 * become those of another, and how far a figure is from its limit.
 *
 * With L2 and L1 the luminances of the brighter and the darker part, all that is reflected
 * included:
 *   contrast ratio      C = L2 / L1
 *   luminance contrast  (L2 - L1) / L1 = C - 1                (Weber; MIL-L-85762A)
 *   modulation          (L2 - L1) / (L2 + L1) = (C - 1)/(C + 1)  (Michelson)
 *   visual security     S = log10(C/(C - 1))   (vision/privacy.h): it falls as C rises
 *
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

#include "review/verdict.h"

typedef enum LimitKind {
    LIMIT_CONTRAST_RATIO,
    LIMIT_LUMINANCE_CONTRAST,
    LIMIT_MODULATION,
    LIMIT_CHARACTER_HEIGHT, /* arc minutes */
    LIMIT_STROKE_RATIO,     /* stroke over the character's height */
    LIMIT_WIDTH_RATIO,      /* width over height: not measured here */
    LIMIT_VISIBILITY_LEVEL, /* times what somebody of an age just sees */
    LIMIT_VISUAL_SECURITY,  /* S, of what must not be read */
    LIMIT_KIND_COUNT
} LimitKind;

typedef struct LimitKindFacts {
    const char *name, *unit;
    bool is_contrast, is_measured;
    bool is_of_light; /* it hangs on the light, as contrasts do */
    bool falls;       /* as the contrast rises */
} LimitKindFacts;

extern const LimitKindFacts limit_kinds[LIMIT_KIND_COUNT];
extern const char *const limit_kind_names[LIMIT_KIND_COUNT + 1]; /* the last one NULL */

/* LIMIT_KIND_COUNT: none has that name, or it is NULL. */
LimitKind limit_kind_named(const char *name);

/* A contrast ratio, 1 to infinity, as a contrast of a kind; rising with it, or falling. */
double contrast_from_ratio(LimitKind kind, double ratio);

/* The way back; infinite where no ratio is enough: a modulation of 1. */
double ratio_from_contrast(LimitKind kind, double contrast);

/* Is the limit kept by less contrast, rather than by more? */
bool limit_wants_less(const LimitVerdict *limit);

/* LimitVerdict's (verdict.h); NaN where `found` is. */
double quantity_margin(LimitKind kind, bool is_upper, double found, double limit);

/* From its found, low, high and value: pass, fail or too close; what is NaN is unjudged. What
 * lies on the limit keeps it. */
Verdict quantity_verdict(const LimitVerdict *of);
