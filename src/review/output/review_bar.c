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

void review_bar_add_margin(Text *html, const LimitVerdict *limit)
{
    if (!isfinite(limit->margin)) return;
    double x = margin_place(limit->margin);
    double low = margin_place(margin_at(limit, limit->low));
    double high = margin_place(margin_at(limit, limit->high));
    text_format(html, "<svg class=\"margin\" width=\"%.0f\" height=\"12\" aria-hidden=\"true\">"
                "<rect class=\"%s\" x=\"%.1f\" y=\"2\" width=\"%.1f\" height=\"8\"/>",
                2 * HALF_WIDTH, words_class(limit->verdict),
                fmin(x, HALF_WIDTH), fabs(x - HALF_WIDTH));
    if (isfinite(low) && isfinite(high) && fabs(high - low) >= 1)
        text_format(html, "<path class=\"whisker\" d=\"M%.1f 6H%.1f\"/>", low, high);
    text_format(html, "<path class=\"limit\" d=\"M%.1f 0V12\"/></svg>", HALF_WIDTH);
}

void review_bar_add_share(Text *html, double share)
{
    double percent = share > 0 ? fmin(100 * share, 100) : 0;
    text_format(html, "<svg class=\"share\" height=\"5\" aria-hidden=\"true\">"
                "<rect width=\"%.1f%%\" height=\"5\"/></svg>", percent);
}

/* ---- luminances ------------------------------------------------------------------------- */

typedef struct BarPart {
    const char *kind; /* its class */
    double      cd_m2;
} BarPart;

#define PARTS 4

typedef struct Bars {
    BarPart bright[PARTS], dark[PARTS];
    double  dark_sum;  /* that contrast is taken of */
    double  most;      /* the end of the scale */
    double  wanted;    /* contrast ratio; NaN: none that can be drawn */
    const char *words; /* the limit that it stands for */
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

static double sum_of(const BarPart *parts, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += parts[i].cd_m2;
    return sum;
}

/* A veil that the limit does not ask for comes last, so that the sum before it is what the
 * contrast is taken of. */
static void stack(const ReviewCase *c, double emitted, bool has_veil, BarPart out[PARTS])
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    bool    is_split = isfinite(l->mirror) && isfinite(l->scattered);
    BarPart veil = {"veil", or_zero(l->veil)};
    BarPart parts[PARTS - 1] = {{"mirror", is_split ? or_zero(l->mirror) : 0},
                                {"scatter", or_zero(is_split ? l->scattered : l->reflected)},
                                {"emit", or_zero(emitted)}};
    out[has_veil ? 0 : PARTS - 1] = veil;
    for (int i = 0; i < PARTS - 1; i++) out[has_veil + i] = parts[i];
}

static Bars make_bars(const ReviewCase *c, Arena *arena)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    double bright = fmax(or_zero(l->foreground), or_zero(l->background));
    double dark = fmin(or_zero(l->foreground), or_zero(l->background));
    bool   has_veil = false;
    Bars   bars = {.wanted = NAN};
    if (c->limit_id >= 0 && c->limit_id < c->limit_count) {
        const LimitVerdict *limit = &c->limits[c->limit_id];
        LimitKind           kind = limit_kind_named(limit->kind);
        has_veil = !is_of(limit, c->contrast_ratio) && is_of(limit, c->contrast_with_veil);
        if (kind < LIMIT_KIND_COUNT && limit_kinds[kind].is_contrast)
            bars.wanted = ratio_from_contrast(kind, limit->value);
        bars.words = kind == LIMIT_CONTRAST_RATIO
                         ? words_limit(limit, arena)
                         : arena_format(arena, "%s %s", words_kind(limit),
                                        words_limit(limit, arena));
    }
    stack(c, bright, has_veil, bars.bright);
    stack(c, dark, has_veil, bars.dark);
    bars.dark_sum = sum_of(bars.dark, has_veil ? PARTS : PARTS - 1);
    bars.most = sum_of(bars.bright, PARTS);
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
    text_add(html, " needs this much</text>");
}

static void add_figure(Text *html, const char *kind, const char *name, double cd_m2,
                       Arena *arena)
{
    text_format(html, "<li><i class=\"%s\"></i><span>%s</span> <b>%s</b></li>\n", kind, name,
                words_figure(cd_m2, arena));
}

/* Below the bars, which show no numbers. */
static void add_figures(Text *html, const CaseLuminances *l, Arena *arena)
{
    text_add(html, "<ul class=\"parts\">\n");
    add_figure(html, "emit", "the symbol's own light", l->foreground, arena);
    add_figure(html, "emit", "its background's own light", l->background, arena);
    add_figure(html, "", "reflected by the display, in all", l->reflected, arena);
    add_figure(html, "mirror", "of that, as in a mirror", l->mirror, arena);
    add_figure(html, "scatter", "of that, scattered", l->scattered, arena);
    add_figure(html, "veil", "veil of stray light in the eye", l->veil, arena);
    text_add(html, "</ul>\n");
}

void review_bar_add_luminances(Text *html, const ReviewCase *c, Arena *arena)
{
    Bars bars = make_bars(c, arena);
    text_add(html, "<h4>What reaches the eye, in cd/m²</h4>\n");
    if (bars.most > 0 && isfinite(bars.most)) {
        text_add(html, "<div class=\"bars\"><div>bright part</div><div>dark part</div>"
                 "<svg height=\"58\" aria-hidden=\"true\">");
        add_bar(html, bars.bright, bars.most, 18);
        add_bar(html, bars.dark, bars.most, 42);
        add_mark(html, &bars);
        text_add(html, "</svg></div>\n");
    }
    add_figures(html, &c->luminance_cd_m2, arena);
}
