/* SPDX-License-Identifier: Apache-2.0 */
#include "review/quantity.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"

#define QUANTITY_NAME(NAME, name) #name,
#define QUANTITY_AT(NAME, name) [LIMIT_##NAME] = &quantity_##name,

const char *const limit_kind_names[LIMIT_KIND_COUNT + 1] = {QUANTITIES(QUANTITY_NAME)};
const ReviewQuantity *const quantities[LIMIT_KIND_COUNT] = {QUANTITIES(QUANTITY_AT)};

LimitKind limit_kind_named(const char *name) {
    int kind = 0;
    while (kind < LIMIT_KIND_COUNT && (!name || strcmp(name, limit_kind_names[kind]) != 0)) kind++;
    return (LimitKind)kind;
}

const ReviewQuantity *quantity_of(const LimitVerdict *limit) {
    LimitKind kind = limit_kind_named(limit->kind);
    return kind < LIMIT_KIND_COUNT ? quantities[kind] : NULL;
}

bool quantity_is_contrast(LimitKind kind) {
    return kind < LIMIT_KIND_COUNT && quantities[kind]->from_ratio;
}

double contrast_from_ratio(LimitKind kind, double ratio) {
    return quantity_is_contrast(kind) ? quantities[kind]->from_ratio(ratio) : ratio;
}

double ratio_from_contrast(LimitKind kind, double contrast) {
    return quantity_is_contrast(kind) ? quantities[kind]->to_ratio(contrast) : contrast;
}

bool limit_wants_less(const LimitVerdict *limit) {
    const ReviewQuantity *of = quantity_of(limit);
    return limit->is_upper != (of && of->falls);
}

/* 0 at full wash-out, or of nothing; security is a logarithm as it stands, 0 in the dark. */
static double progress(LimitKind kind, double value) {
    bool is_logarithm = quantity_is_contrast(kind) && quantities[kind]->of != OF_PRIVATE;
    return is_logarithm ? log2_d(ratio_from_contrast(kind, value)) : value;
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

bool limit_is_worse(const LimitVerdict *a, const LimitVerdict *b) {
    int more = verdict_rank(a->verdict) - verdict_rank(b->verdict);
    return more > 0 ||
           (more == 0 && (a->margin < b->margin || (isnan(b->margin) && !isnan(a->margin))));
}
