/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_privacy.h"

#include <math.h>
#include <stdlib.h>

#include "page/page.h"
#include "review/output/review_words.h"
#include "review/private_image.h"
#include "text/json_text.h"
#include "text/text.h"
#include "vision/privacy.h"

#define ALL_SHOWN 1e-6

/* V and S with their 95 % intervals, whose ends are those of the contrast, the other way round.
 * NaN where the contrast is. */
typedef struct PrivacyFigures {
    double v, v_low, v_high, s, s_low, s_high;
} PrivacyFigures;

static PrivacyFigures privacy_figures(const ReviewCase *c) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double white = fmax(l->foreground, l->background);
    double black = fmin(l->foreground, l->background);
    double v = privacy_security(white, black, l->reflected);
    return (PrivacyFigures){v,
                            privacy_security_of_contrast(c->contrast_high),
                            privacy_security_of_contrast(c->contrast_low),
                            privacy_s(v),
                            privacy_s_of_contrast(c->contrast_high),
                            privacy_s_of_contrast(c->contrast_low)};
}

/* Of its image in a pane: "can be read, reversed: V 1.2 (1.1 to 1.3), S 0.08 (0.04 to 0.11);
 * 0.21 and 0.002 cd/m² over 0.1; 24 arc minutes high, all of it shown". */
static const char *privacy_image_words(const CaseImage *i, Arena *arena) {
    static const char *const READ[4] = {[VERDICT_PASS] = "surely cannot be read",
                                        [VERDICT_FAIL] = "can be read, reversed",
                                        [VERDICT_TOO_CLOSE] = "can perhaps be read, reversed",
                                        [VERDICT_UNJUDGED] = "cannot be judged"};
    double v[3], s[3], ratios[3] = {i->contrast_ratio, i->contrast_high, i->contrast_low};
    for (int k = 0; k < 3; k++) {
        v[k] = privacy_security_of_contrast(ratios[k]);
        s[k] = privacy_s(v[k]);
    }
    const char *share =
        i->shown_share > 1 - ALL_SHOWN ? "all of it" : words_share(i->shown_share, arena);
    return arena_format(
        arena,
        "%s: V %s (%s), S %s (%s); %s and %s cd/m² over %s; %s arc minutes high, %s "
        "shown",
        READ[i->verdict], words_within(v[0], v[1], v[2], arena), words_interval(v[1], v[2], arena),
        words_within(s[0], s[1], s[2], arena), words_interval(s[1], s[2], arena),
        words_figure(i->foreground, arena), words_figure(i->background, arena),
        words_figure(i->against, arena), words_figure(i->height_arcmin, arena), share);
}

/* ---- from where -------------------------------------------------------------------------- */

#define PLANS_MOST 9
#define PLAN 120.0     /* pixels, of each */
#define PLAN_ROOM 88.0 /* of that, for its points */
#define SAME_M 1e-4    /* heights that differ by less are one */

typedef struct Plans {
    double height_m[PLANS_MOST + 1]; /* from the top on; one more: too many */
    int count;
    double low[2], scale; /* of x and z */
} Plans;

static int plan_of(const Plans *plans, double height_m) {
    int i = 0;
    while (i < plans->count && fabs(plans->height_m[i] - height_m) > SAME_M) i++;
    return i;
}

static int compare_down(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

static Plans make_plans(const ReviewCase *c) {
    Plans plans = {.low = {INFINITY, INFINITY}};
    double high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < c->place_count; i++) {
        const double *at = c->places[i].eye_m;
        for (int k = 0; k < 2; k++) {
            plans.low[k] = fmin(plans.low[k], at[2 * k]);
            high[k] = fmax(high[k], at[2 * k]);
        }
        if (plans.count > PLANS_MOST || plan_of(&plans, at[1]) < plans.count) continue;
        plans.height_m[plans.count++] = at[1];
    }
    qsort(plans.height_m, (size_t)plans.count, sizeof *plans.height_m, compare_down);
    if (plans.count > PLANS_MOST) plans.count = 1;
    double widest = fmax(high[0] - plans.low[0], high[1] - plans.low[1]);
    plans.scale = widest > 0 ? PLAN_ROOM / widest : 0;
    return plans;
}

static void add_place(Text *svg, const Plans *plans, const CasePlace *p, Arena *arena) {
    static const char *const FILLS[4] = {[VERDICT_PASS] = "good",
                                         [VERDICT_FAIL] = "bad",
                                         [VERDICT_TOO_CLOSE] = "close",
                                         [VERDICT_UNJUDGED] = "hidden"};
    int plan = plans->count > 1 ? plan_of(plans, p->eye_m[1]) : 0;
    double x = PLAN * plan + 16 + plans->scale * (p->eye_m[0] - plans->low[0]);
    double y = 30 + plans->scale * (p->eye_m[2] - plans->low[1]);
    text_format(svg,
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"6\" style=\"fill:var(--%s)\">"
                "<title>%.2f, %.2f, %.2f m: %s",
                x, y, FILLS[p->verdict], p->eye_m[0], p->eye_m[1], p->eye_m[2],
                verdict_names[p->verdict]);
    if (p->visible_share > 0)
        text_format(svg, ", S %s",
                    words_within(privacy_s_of_contrast(p->contrast_ratio),
                                 privacy_s_of_contrast(p->contrast_high),
                                 privacy_s_of_contrast(p->contrast_low), arena));
    text_add(svg, p->visible_share > 0 ? "</title></circle>" : ", hidden</title></circle>");
}

/* From where in an eye box or ellipse it can be read, as inline SVG: a plan of each height,
 * seen from above, x to the right and z down as the scene has them, the heights from the top
 * on; of more than nine one plan, those that can read it on top. NULL: it has one place. */
static const char *privacy_places_drawn(const ReviewCase *c, Arena *arena) {
    Text svg = {.arena = arena};
    Plans plans = make_plans(c);
    if (!c->place_count) return NULL;
    text_format(&svg,
                "<svg width=\"%.0f\" height=\"%.0f\" role=\"img\" aria-label=\"from "
                "which of the eye's places it can be read\">",
                PLAN * plans.count, PLAN + 8);
    for (int i = 0; i < plans.count && plans.count > 1; i++)
        text_format(&svg,
                    "<text x=\"%.0f\" y=\"14\" "
                    "style=\"font-size:11px;fill:currentColor\">y %.3g m</text>",
                    PLAN * i + 10, plans.height_m[i]);
    for (int rank = 0; rank <= verdict_rank(VERDICT_FAIL); rank++)
        for (int i = 0; i < c->place_count; i++)
            if (verdict_rank(c->places[i].verdict) == rank)
                add_place(&svg, &plans, &c->places[i], arena);
    text_add(&svg, "</svg>");
    return svg.data;
}

/* ---- on the page ------------------------------------------------------------------------- */

void privacy_set_values(json_t *to, const ReviewCase *c, Arena *arena) {
    PrivacyFigures of = privacy_figures(c);
    page_set(to, "places_drawn", privacy_places_drawn(c, arena));
    page_set(to, "security",
             !c->must_not_be_read || isnan(of.v)
                 ? NULL
                 : arena_format(arena, "V %s, S %s", words_within(of.v, of.v_low, of.v_high, arena),
                                words_within(of.s, of.s_low, of.s_high, arena)));
    json_t *images = json_array();
    json_object_set_new(to, "private_images", images);
    for (int i = 0; i < c->image_count; i++) {
        json_t *image = page_add(images);
        page_set(image, "pane", c->images[i].pane);
        page_set(image, "told", privacy_image_words(&c->images[i], arena));
    }
}

/* ---- as JSON ----------------------------------------------------------------------------- */

static void set_figure(json_t *to, const char *key, double value) {
    json_object_set_new(to, key, json_figure(value));
}

static void set_interval(json_t *to, const char *key, double low, double high) {
    json_object_set_new(to, key, json_pack("[o,o]", json_figure(low), json_figure(high)));
}

json_t *privacy_json(const ReviewCase *c) {
    PrivacyFigures of = privacy_figures(c);
    const char *by = kept_names[case_kept_by(c)];
    if (!c->must_not_be_read) return NULL;
    json_t *out = json_pack("{s:o}", "kept_by", by ? json_text(by) : json_null());
    set_figure(out, "visual_security", of.v);
    set_interval(out, "visual_security_interval", of.v_low, of.v_high);
    set_figure(out, "s", of.s);
    set_interval(out, "s_interval", of.s_low, of.s_high);
    return out;
}
