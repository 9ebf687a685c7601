/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_bar.h"

#include <math.h>

#include "base/mathd.h"
#include "review/output/review_words.h"
#include "review/quantity.h"
#include "text/text.h"

/* ---- margins and shares ----------------------------------------------------------------- */

#define HALF_WIDTH 44.0 /* pixels from the limit to a margin of -1, and to 1 */

/* From the left end. */
static double margin_place(double margin)
{
    return HALF_WIDTH * (1 + fmax(-1, fmin(1, margin)));
}

static double margin_at(const LimitVerdict *limit, double found)
{
    return quantity_margin(limit_kind_named(limit->kind), limit->is_upper, found, limit->value);
}

const char *review_bar_margin(const LimitVerdict *limit, Arena *arena)
{
    Text svg = {.arena = arena};
    if (!isfinite(limit->margin)) return "";
    double x = margin_place(limit->margin);
    double low = margin_place(margin_at(limit, limit->low));
    double high = margin_place(margin_at(limit, limit->high));
    text_format(&svg, "<svg class=\"margin\" width=\"%.0f\" height=\"12\" aria-hidden=\"true\">"
                "<rect class=\"%s\" x=\"%.1f\" y=\"2\" width=\"%.1f\" height=\"8\"/>",
                2 * HALF_WIDTH, words_class(limit->verdict),
                fmin(x, HALF_WIDTH), fabs(x - HALF_WIDTH));
    if (isfinite(low) && isfinite(high) && fabs(high - low) >= 1)
        text_format(&svg, "<path class=\"whisker\" d=\"M%.1f 6H%.1f\"/>", low, high);
    text_format(&svg, "<path class=\"limit\" d=\"M%.1f 0V12\"/></svg>", HALF_WIDTH);
    return svg.data;
}

const char *review_bar_percent(double share, Arena *arena)
{
    return arena_format(arena, "%.1f", share > 0 ? fmin(100 * share, 100) : 0);
}

/* ---- luminances ------------------------------------------------------------------------- */

typedef struct BarPart {
    const char *kind; /* its class */
    double      cd_m2;
} BarPart;

#define PARTS 4

typedef struct Bars {
    BarPart bright[PARTS], dark[PARTS];
    bool    has_veil;  /* the eye's veil is in the contrast that is judged */
    double  dark_sum;
    double  most;      /* the end of the scale */
    double  wanted;    /* contrast ratio; NaN: none that can be drawn */
    const char *words; /* of the mark */
} Bars;

static double or_zero(double value)
{
    return isfinite(value) && value > 0 ? value : 0;
}

static bool is_close(double a, double b)
{
    return fabs(a - b) <= 1e-4 * fabs(b);
}

/* Is the limit's figure made of this contrast ratio? */
static bool is_of(const LimitVerdict *limit, double ratio)
{
    return is_close(limit->found, contrast_from_ratio(limit_kind_named(limit->kind), ratio));
}

static double sum_of(const BarPart *parts)
{
    double sum = 0;
    for (int i = 0; i < PARTS; i++) sum += parts[i].cd_m2;
    return sum;
}

/* The sum that the contrast is taken of, and nothing else: a veil that the limit does not
 * include is no part of it. The mirror's and the scattered light share what is reflected. */
static void stack(const CaseLuminances *l, double emitted, bool has_veil, BarPart out[PARTS])
{
    double mirror = or_zero(l->mirror), both = mirror + or_zero(l->scattered);
    double reflected = or_zero(l->reflected);
    double shiny = isfinite(l->mirror) && isfinite(l->scattered) && both > 0
                       ? reflected * (mirror / both) : 0;
    out[0] = (BarPart){"veil", has_veil ? or_zero(l->veil) : 0};
    out[1] = (BarPart){"mirror", shiny};
    out[2] = (BarPart){"scatter", reflected - shiny};
    out[3] = (BarPart){"emit", or_zero(emitted)};
}

static const char *mark_words(const LimitVerdict *limit, Arena *arena)
{
    const char *value = words_limit(limit, arena);
    if (limit_kind_named(limit->kind) != LIMIT_CONTRAST_RATIO)
        value = arena_format(arena, "%s %s", words_kind(limit), value);
    return arena_format(arena, limit->is_upper ? "%s allows this much" : "%s needs this much",
                        value);
}

static Bars make_bars(const ReviewCase *c, Arena *arena)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    double bright = fmax(or_zero(l->foreground), or_zero(l->background));
    double dark = fmin(or_zero(l->foreground), or_zero(l->background));
    Bars   bars = {.wanted = NAN};
    if (c->limit_id >= 0 && c->limit_id < c->limit_count) {
        const LimitVerdict *limit = &c->limits[c->limit_id];
        LimitKind           kind = limit_kind_named(limit->kind);
        bars.has_veil = !is_of(limit, c->contrast_ratio) && is_of(limit, c->contrast_with_veil);
        if (kind < LIMIT_KIND_COUNT && limit_kinds[kind].is_contrast)
            bars.wanted = ratio_from_contrast(kind, limit->value);
        bars.words = mark_words(limit, arena);
    }
    stack(l, bright, bars.has_veil, bars.bright);
    stack(l, dark, bars.has_veil, bars.dark);
    bars.dark_sum = sum_of(bars.dark);
    bars.most = sum_of(bars.bright);
    if (bars.wanted > 0) bars.most = fmax(bars.most, 1.02 * bars.wanted * bars.dark_sum);
    return bars;
}

static void add_bar(Text *html, const BarPart *parts, double most, int y)
{
    double at = 0;
    for (int i = 0; i < PARTS; i++) {
        double width = 100 * parts[i].cd_m2 / most;
        if (width > 0)
            text_format(html, "<rect class=\"%s\" x=\"%.4f%%\" y=\"%d\" width=\"%.4f%%\" "
                        "height=\"16\"/>", parts[i].kind, at, y, width);
        at += width;
    }
}

static void add_mark(Text *html, const Bars *bars)
{
    double x = 100 * bars->wanted * bars->dark_sum / bars->most;
    if (!isfinite(x)) return;
    text_format(html, "<rect class=\"mark\" x=\"%.4f%%\" y=\"0\" width=\"2\" height=\"38\"/>"
                "<text x=\"%.2f%%\" y=\"11\" dx=\"%d\" text-anchor=\"%s\">", x, x,
                x > 50 ? -5 : 7, x > 50 ? "end" : "start");
    escape_markup(html, bars->words);
    text_add(html, "</text>");
}

const char *review_bar_luminances(const ReviewCase *c, bool *has_veil, Arena *arena)
{
    Text svg = {.arena = arena};
    Bars bars = make_bars(c, arena);
    *has_veil = bars.has_veil;
    if (!(bars.most > 0 && isfinite(bars.most))) return "";
    text_add(&svg, "<svg height=\"58\" aria-hidden=\"true\">");
    add_bar(&svg, bars.bright, bars.most, 18);
    add_bar(&svg, bars.dark, bars.most, 42);
    add_mark(&svg, &bars);
    text_add(&svg, "</svg>");
    return svg.data;
}
