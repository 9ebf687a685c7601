/* SPDX-License-Identifier: Apache-2.0 */
#include "review/ask_colour.h"

#include <math.h>

#include "base/mathd.h"
#include "review/profile.h"
#include "review/quantity.h"
#include "spectrum/photometry.h"

/* Squares of a difference of no length are those of two normal variables: to say with 95 % that
 * it is not 0 takes 2 ln 20 of them, where along a direction that is known 1.96^2 are enough. */
#define ACROSS (5.991464547107982 / (NORMAL_QUANTILE * NORMAL_QUANTILE) - 1)

/* One of two colours at work. */
typedef struct ColourNow {
    double emitted[3], reflected[3], veil[3];
} ColourNow;

/* Two colours of which the difference is found: the second is seen, too, or is the first one's
 * emitted light alone. */
typedef struct ColourPair {
    ColourNow of[2];
    bool is_dark;
} ColourPair;

static void uv_seen(const ColourNow *light, double uv[2]) {
    double xyz[3];
    for (int k = 0; k < 3; k++) xyz[k] = light->emitted[k] + light->reflected[k] + light->veil[k];
    uv_from_xyz(xyz, uv);
}

static void apart(const ColourPair *pair, double d[2]) {
    double one[2], other[2];
    uv_seen(&pair->of[0], one);
    if (pair->is_dark) uv_from_xyz(pair->of[0].emitted, other);
    else uv_seen(&pair->of[1], other);
    for (int k = 0; k < 2; k++) d[k] = one[k] - other[k];
}

/* ColourHalf an interval along a difference, and across it; as squares while they add up. */
typedef struct ColourHalf {
    double along, across;
} ColourHalf;

/* How far a change of the pair moves the difference d. */
static ColourHalf moved(const ColourPair *changed, const double d[2]) {
    double then[2], length = hypot_d(d[0], d[1]);
    double u = length > 0 ? d[0] / length : 1, v = length > 0 ? d[1] / length : 0;
    apart(changed, then);
    double du = then[0] - d[0], dv = then[1] - d[1];
    return (ColourHalf){du * u + dv * v, dv * u - du * v};
}

static void add_square(ColourHalf *sum, ColourHalf of) {
    sum->along += of.along * of.along;
    sum->across += of.across * of.across;
}

static void scale(double xyz[3], double by) {
    for (int k = 0; k < 3; k++) xyz[k] *= by;
}

/* What the panel of one of the two states of itself. */
static void add_panel(const ColourPair *pair, int which, const ColourLight *light,
                      const double d[2], ColourHalf *sum) {
    for (int k = -2; k < 3; k++) {
        ColourPair changed = *pair;
        double emits = 1 + NORMAL_QUANTILE * light->emission_error;
        if (k == -2)
            scale(changed.of[which].reflected, 1 + NORMAL_QUANTILE * light->reflection_error);
        else if (k == -1) scale(changed.of[which].emitted, emits);
        else changed.of[which].emitted[k] *= emits;
        add_square(sum, moved(&changed, d));
    }
}

/* By the batches of both, each as a share of its mean. */
static ColourHalf by_batches(const ColourPair *pair, const ColourLight *const lights[2],
                             const double d[2]) {
    ColourHalf each[CASE_BATCHES], mean = {0, 0}, sum = {0, 0};
    int count = pair->is_dark ? 1 : 2;
    for (int i = 0; i < CASE_BATCHES; i++) {
        ColourPair without = *pair;
        for (int k = 0; k < 3 * count; k++) {
            const ColourLight *light = lights[k / 3];
            double all = light->reflected[k % 3], batch = light->batches[i][k % 3];
            if (all > 0)
                without.of[k / 3].reflected[k % 3] *=
                    (CASE_BATCHES - batch / all) / (CASE_BATCHES - 1);
        }
        each[i] = moved(&without, d);
        mean.along += each[i].along / CASE_BATCHES;
        mean.across += each[i].across / CASE_BATCHES;
    }
    for (int i = 0; i < CASE_BATCHES; i++)
        add_square(&sum, (ColourHalf){each[i].along - mean.along, each[i].across - mean.across});
    double times =
        student_quantile(CASE_BATCHES - 1) * sqrt((double)(CASE_BATCHES - 1) / CASE_BATCHES);
    return (ColourHalf){times * sqrt(sum.along), times * sqrt(sum.across)};
}

/* By the farther end of each one's interval. */
static ColourHalf by_ranges(const ColourPair *pair, const ColourLight *const lights[2],
                            const double d[2]) {
    ColourHalf sum = {0, 0};
    for (int k = 0; k < (pair->is_dark ? 1 : 2); k++) {
        double all = lights[k]->reflected[1];
        ColourHalf most = {0, 0};
        for (int end = 0; end < 2 && all > 0; end++) {
            ColourPair changed = *pair;
            scale(changed.of[k].reflected,
                  (end ? lights[k]->range.high : lights[k]->range.low) / all);
            ColourHalf to = moved(&changed, d);
            most =
                (ColourHalf){fmax(most.along, fabs(to.along)), fmax(most.across, fabs(to.across))};
        }
        add_square(&sum, most);
    }
    return (ColourHalf){sqrt(sum.along), sqrt(sum.across)};
}

static void set_apart(const ColourPair *pair, const ColourLight *const lights[2], CaseColour *out) {
    double d[2];
    apart(pair, d);
    out->apart = hypot_d(d[0], d[1]);
    ColourHalf batches = by_batches(pair, lights, d), ranges = by_ranges(pair, lights, d);
    ColourHalf sampling = {fmax(batches.along, ranges.along), fmax(batches.across, ranges.across)};
    ColourHalf sum = {0, 0};
    add_square(&sum, sampling);
    for (int k = 0; k < (pair->is_dark ? 1 : 2); k++) add_panel(pair, k, lights[k], d, &sum);
    double half = sqrt(sum.along);
    double shorter = fmax(out->apart * out->apart - ACROSS * sum.across, 0);
    out->low = fmax(sqrt(shorter) - half, 0);
    out->high = out->apart + half;
    out->sampling = half > 0 ? sampling.along / half : 0;
}

/* As bright as the luminances say; brighter: times as the display was when it was read. */
static ColourNow light_now(const ColourLight *read, double brighter, double reflected,
                           double veil) {
    ColourNow out;
    for (int k = 0; k < 3; k++) {
        out.emitted[k] = brighter * read->emitted[k];
        out.reflected[k] = read->reflected[1] > 0
                               ? reflected * read->reflected[k] / read->reflected[1]
                               : read->reflected[k];
        out.veil[k] = read->veil[1] > 0 ? veil * read->veil[k] / read->veil[1] : read->veil[k];
    }
    return out;
}

const CaseColour *case_colours(const ReviewCase *c, Arena *arena) {
    if (!c->colour_count || !c->colours[0].light) return c->colours;
    const CaseLuminances *l = &c->luminance_cd_m2;
    const ColourLight *own = c->colours[0].light;
    double lit = fmax(l->foreground, l->background);
    double brighter = own->lit > 0 ? lit / own->lit : 1;
    CaseColour *list = ARENA_NEW(arena, CaseColour, c->colour_count);
    for (int i = 0; i < c->colour_count; i++) {
        CaseColour *out = &list[i];
        *out = c->colours[i];
        const ColourLight *of = out->light;
        ColourPair pair = {
            .of = {light_now(own, brighter, l->reflected, l->veil),
                   light_now(of, of->is_on_display ? brighter : 1, of->reflected[1], of->veil[1])},
            .is_dark = i == 0};
        uv_seen(&pair.of[i > 0], out->uv);
        uv_from_xyz(pair.of[i > 0].emitted, out->dark_uv);
        set_apart(&pair, (const ColourLight *const[2]){own, of}, out);
    }
    return list;
}

/* ---- quantities -------------------------------------------------------------------------- */

static Figure figure_from(const Evidence *e, const CaseColour *of) {
    return (Figure){.found = of->apart,
                    .has_veil = e->profile->uses_veil,
                    .low = of->low,
                    .high = of->high,
                    .sampling = {of->sampling, of->sampling}};
}

static Figure find_shift(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return e->c->colour_count ? figure_from(e, &e->c->colours[0]) : figure_unknown();
}

/* The least, each end the least of theirs; one that is not known comes before all. */
static Figure find_difference(const Evidence *e, bool is_upper) {
    Figure least = {.found = INFINITY, .low = INFINITY, .high = INFINITY};
    (void)is_upper;
    for (int i = 1; i < e->c->colour_count; i++) {
        const CaseColour *of = &e->c->colours[i];
        Figure own = figure_from(e, of);
        if (isnan(of->apart)) return figure_unknown();
        if (of->apart < least.found) own.beside = of->symbol;
        else own = least;
        own.low = fmin(least.low, of->low);
        own.high = fmin(least.high, of->high);
        least = own;
    }
    return e->c->colour_count > 1 ? least : figure_unknown();
}

const ReviewQuantity quantity_colour_shift = {.unit = "1",
                                              .words = "colour shift Δu′v′",
                                              .is_of_light = true,
                                              .falls = true,
                                              .may_be_missing = true,
                                              .has_one_bound = true,
                                              .is_upper = true,
                                              .find = find_shift};

const ReviewQuantity quantity_colour_difference = {.unit = "1",
                                                   .words = "colour difference Δu′v′",
                                                   .is_of_light = true,
                                                   .may_be_missing = true,
                                                   .has_one_bound = true,
                                                   .find = find_difference};
