/* SPDX-License-Identifier: Apache-2.0 */
#include "review/quantity.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "vision/privacy.h"

const char *const limit_kind_names[LIMIT_KIND_COUNT + 1] = {
    "contrast_ratio", "luminance_contrast", "modulation",       "character_height",
    "stroke_ratio",   "width_ratio",        "visibility_level", "visual_security"};

const LimitKindFacts limit_kinds[LIMIT_KIND_COUNT] = {
    [LIMIT_CONTRAST_RATIO] = {"contrast_ratio", "1", true, true, true, false},
    [LIMIT_LUMINANCE_CONTRAST] = {"luminance_contrast", "1", true, true, true, false},
    [LIMIT_MODULATION] = {"modulation", "1", true, true, true, false},
    [LIMIT_CHARACTER_HEIGHT] = {"character_height", "arcmin", false, true, false, false},
    [LIMIT_STROKE_RATIO] = {"stroke_ratio", "1", false, true, false, false},
    [LIMIT_WIDTH_RATIO] = {"width_ratio", "1", false, false, false, false},
    [LIMIT_VISIBILITY_LEVEL] = {"visibility_level", "1", false, true, true, false},
    [LIMIT_VISUAL_SECURITY] = {"visual_security", "1", true, true, true, true},
};

LimitKind limit_kind_named(const char *name) {
    int kind = 0;
    while (kind < LIMIT_KIND_COUNT && (!name || strcmp(name, limit_kinds[kind].name) != 0)) kind++;
    return (LimitKind)kind;
}

double contrast_from_ratio(LimitKind kind, double ratio) {
    if (kind == LIMIT_LUMINANCE_CONTRAST) return ratio - 1;
    if (kind == LIMIT_MODULATION) return isinf(ratio) ? 1 : (ratio - 1) / (ratio + 1);
    if (kind == LIMIT_VISUAL_SECURITY) return privacy_s_of_contrast(ratio);
    return ratio;
}

double ratio_from_contrast(LimitKind kind, double contrast) {
    if (kind == LIMIT_LUMINANCE_CONTRAST) return contrast + 1;
    if (kind == LIMIT_MODULATION)
        return contrast < 1 ? (1 + contrast) / (1 - contrast) : (double)INFINITY;
    if (kind == LIMIT_VISUAL_SECURITY) return privacy_contrast_of_s(contrast);
    return contrast;
}

bool limit_wants_less(const LimitVerdict *limit) {
    LimitKind kind = limit_kind_named(limit->kind);
    return limit->is_upper != (kind < LIMIT_KIND_COUNT && limit_kinds[kind].falls);
}

/* 0 at full wash-out, or of nothing; security is a logarithm as it stands, 0 in the dark. */
static double progress(LimitKind kind, double value) {
    bool is_contrast =
        kind < LIMIT_KIND_COUNT && limit_kinds[kind].is_contrast && !limit_kinds[kind].falls;
    return is_contrast ? log2_d(ratio_from_contrast(kind, value)) : value;
}

double quantity_margin(LimitKind kind, bool is_upper, double found, double limit) {
    if (isnan(found)) return (double)NAN;
    if (found == limit) return 0;
    double at = progress(kind, found), wanted = progress(kind, limit);
    if (!(wanted > 0)) wanted = 0; /* a ratio of 1, which any contrast keeps */
    return is_upper ? wanted / at - 1 : isinf(wanted) ? -1 : at / wanted - 1;
}

Verdict quantity_verdict(const LimitVerdict *of) {
    if (isnan(of->found) || isnan(of->low) || isnan(of->high)) return VERDICT_UNJUDGED;
    bool keeps = of->is_upper ? of->high <= of->value : of->low >= of->value;
    bool breaks = of->is_upper ? of->low > of->value : of->high < of->value;
    return keeps ? VERDICT_PASS : breaks ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
}
