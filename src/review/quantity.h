/* SPDX-License-Identifier: Apache-2.0 */
/* quantity.h -- what a review judges: one row a quantity, with its unit, its words, and how its
 * figure is found in what was read. A limit on any of them is a line of a profile.
 *
 * A new quantity is a file ask_NAME.c with its row, and its name in QUANTITIES.
 *
 * With L2 and L1 the luminances of the brighter and the darker part, all that is reflected
 * included:
 *   contrast ratio      C = L2 / L1
 *   luminance contrast  (L2 - L1) / L1 = C - 1                (Weber; MIL-L-85762A)
 *   modulation          (L2 - L1) / (L2 + L1) = (C - 1)/(C + 1)  (Michelson)
 *   visual security     S = log10(C/(C - 1))   (vision/privacy.h): it falls as C rises
 *
 * Memory   constant rows.
 * Threads  pure functions.
 * Fails    never: NaN where a figure is not known.
 */
#pragma once
#include <math.h>
#include <stdbool.h>

#include "review/verdict.h"

/* In files by these names. */
#define QUANTITIES(Q) \
    Q(CONTRAST_RATIO, contrast_ratio) \
    Q(LUMINANCE_CONTRAST, luminance_contrast) \
    Q(MODULATION, modulation) \
    Q(CHARACTER_HEIGHT, character_height) \
    Q(STROKE_RATIO, stroke_ratio) \
    Q(WIDTH_RATIO, width_ratio) \
    Q(VISIBILITY_LEVEL, visibility_level) \
    Q(VISUAL_SECURITY, visual_security) \
    Q(COLOUR_SHIFT, colour_shift) \
    Q(COLOUR_DIFFERENCE, colour_difference) \
    Q(THRESHOLD_INCREMENT, threshold_increment) \
    Q(GAZE_VEIL, gaze_veil) \
    Q(GAZE_CONTRAST, gaze_contrast) \
    Q(IMAGE_CONTRAST, image_contrast) \
    Q(MIRRORED_SUN, mirrored_sun)

#define QUANTITY_KIND(NAME, name) LIMIT_##NAME,
typedef enum LimitKind { QUANTITIES(QUANTITY_KIND) LIMIT_KIND_COUNT } LimitKind;

/* What a quantity is a property of, and so what it is evaluated for. */
typedef enum QuantityOf {
    OF_SYMBOL,  /* what must be read */
    OF_PRIVATE, /* what must not be read, and each of its images in glass: more contrast is worse */
    OF_GAZE,    /* an eye that looks elsewhere than at a symbol */
    OF_PANE,    /* a display as glass shows it */
    OF_MIRROR,  /* the sun as a mirror throws it into an eye, over a sweep */
    QUANTITY_OFS
} QuantityOf;

struct Profile;

/* What was read of one subject; of those members that its kind has none are NULL. */
typedef struct Evidence {
    const struct Profile *profile;
    const ReviewCase *c;
    const GazeFinding *gaze;
    int age; /* of its road's */
    const struct PaneFinding *pane;
    const ReviewFalseSun *sun;
    Ambient ambient;
    bool is_seen, is_usable, has_data; /* of it; of the panels; of the materials by which most
                                          of its light came */
} Evidence;

/* What was found, with its 95 % interval. sampling: the share, 0..1, of what more paths lessen in
 * its doubt below and above; is_veils: is more of the rest the veil's than the panel's? */
typedef struct Figure {
    double found, low, high;
    double age_years; /* whose it is; 0: nobody's */
    double sampling[2];
    bool is_veils[2];
    bool has_veil;      /* the veil in the eye counts in it */
    const char *beside; /* the other of two things that it is about; NULL: it is about one */
} Figure;

static inline Figure figure_unknown(void) {
    return (Figure){.found = (double)NAN, .low = (double)NAN, .high = (double)NAN};
}

static inline Figure figure_exact(double found) {
    return (Figure){.found = found, .low = found, .high = found};
}

typedef struct ReviewQuantity {
    const char *unit;  /* in files */
    const char *words; /* its label */
    const char *sign;  /* behind a figure in place of the unit; NULL: the unit */
    QuantityOf of;
    bool is_of_light;    /* it hangs on the light, as contrasts do */
    bool falls;          /* as the contrast rises */
    bool may_be_missing; /* of a shape, or unasked, it has no meaning: then it does not count */
    bool has_one_bound;  /* `is_upper` is its only bound; else a limit's own is "least" unless
                            it says "most" */
    bool is_upper;
    double below;                                      /* each limit is less; 0: any is possible */
    Figure (*find)(const Evidence *of, bool is_upper); /* NULL: it is not measured */
    double (*from_ratio)(double ratio);                /* of contrasts; NULL: it is none */
    double (*to_ratio)(double contrast);
} ReviewQuantity;

#define QUANTITY_ROW(NAME, name) extern const ReviewQuantity quantity_##name;
QUANTITIES(QUANTITY_ROW)

extern const ReviewQuantity *const quantities[LIMIT_KIND_COUNT];
extern const char *const limit_kind_names[LIMIT_KIND_COUNT + 1]; /* the last one NULL */

/* LIMIT_KIND_COUNT: none has that name, or it is NULL. */
LimitKind limit_kind_named(const char *name);

/* The row of a limit's kind; NULL: of a file that a newer program wrote. */
const ReviewQuantity *quantity_of(const LimitVerdict *limit);

/* Is it of a contrast: has it a contrast ratio? */
bool quantity_is_contrast(LimitKind kind);

/* A contrast ratio, 1 to infinity, as a contrast of a kind, rising with it, or falling; of what
 * is none, and of LIMIT_KIND_COUNT, the ratio itself. */
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

/* Of two limits the worse: by verdict, then by the least margin; NaN is behind every margin. */
bool limit_is_worse(const LimitVerdict *a, const LimitVerdict *b);
