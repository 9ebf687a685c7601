/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_card.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/plain/plain_png.h"
#include "page/page.h"
#include "review/output/review_bar.h"
#include "review/output/review_rays.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/base64.h"
#include "text/text.h"

#define FIRST_CAUSES 4
#define PICTURE_BYTES_MAX ((size_t)64 << 20)

/* ---- the line that opens it ------------------------------------------------------------- */

void review_card_add_chip(Text *html, Verdict verdict)
{
    text_format(html, "<span class=\"chip %s\">%s</span>", words_class(verdict),
                words_verdict(verdict));
}

static void add_summary(Text *html, const ReviewCase *c, Arena *arena)
{
    text_add(html, "<summary>");
    review_card_add_chip(html, c->verdict);
    text_add(html, " <b>");
    escape_markup(html, c->symbol);
    text_add(html, "</b> <span class=\"where\">");
    escape_markup(html, arena_format(arena, "seen by %s, %s", c->eye ? c->eye : "?",
                                     c->condition ? c->condition : "?"));
    text_format(html, "</span> <span class=\"ratio\">%s</span></summary>\n",
                words_judged(c, arena));
}

/* ---- figures ---------------------------------------------------------------------------- */

static void add_light_facts(Text *html, const ReviewCard *card, Arena *arena)
{
    const ReviewCase *c = card->of;
    const char *lux = isfinite(c->display_lux)
                          ? arena_format(arena, "%s, %s lx on the display's face",
                                         words_ambient(c->ambient),
                                         words_figure(c->display_lux, arena))
                          : words_ambient(c->ambient);
    if (c->when) page_fact(html, "When", c->when);
    page_fact(html, "Light", lux);
    page_fact(html, "Sun", words_sun(c, card->directions, arena));
    page_fact(html, "Display", c->display ? c->display : "–");
    if (isfinite(c->level))
        page_fact(html, "Brightness", arena_format(arena, "%s of what was measured",
                                                   words_share(c->level, arena)));
}

/* A figure in the middle of its words; nothing where there is none. */
static void add_figure(Text *html, const char *name, double value, const char *unit,
                       Arena *arena)
{
    if (!isnan(value))
        page_fact(html, name, arena_format(arena, "%s %s", words_figure(value, arena), unit));
}

/* Figures made for rooms. */
static void add_glare_facts(Text *html, const CaseGlare *g, Arena *arena)
{
    page_fact(html, "Daylight glare probability",
              words_glare(g->dgp, g->dgp_range, g->none, arena));
    page_fact(html, "Unified glare rating",
              words_glare(g->ugr, g->ugr_range, g->none, arena));
    page_fact(html, "Daylight glare index",
              words_glare(g->dgi, g->dgi_range, g->none, arena));
    page_fact(html, "… of these three, made for rooms", words_glare_settings(g, arena));
}

static void add_sight_facts(Text *html, const ReviewCase *c, Arena *arena)
{
    if (!isnan(c->contrast_ratio))
        page_fact(html, "Contrast",
                  arena_format(arena, "%s, 95 %% sure between %s and %s",
                               words_contrast(c, arena),
                               words_within(c->contrast_low, c->contrast_low,
                                            c->contrast_high, arena),
                               words_within(c->contrast_high, c->contrast_low,
                                            c->contrast_high, arena)));
    const char *whole = words_whole(c, arena);
    if (*whole) page_fact(html, "… of its worst part; of all of it", whole);
    add_figure(html, "… with the eye's own veil", c->contrast_with_veil, ": 1", arena);
    add_figure(html, "Height", c->height_arcmin, "arc minutes", arena);
    add_figure(html, "Told apart by", c->jnd, "just noticeable steps", arena);
    add_figure(html, "Above the eye's threshold", c->visibility, "times", arena);
    if (!isnan(c->visible_share))
        page_fact(html, "Can be seen", arena_format(arena, "%s of its area",
                                                    words_share(c->visible_share, arena)));
    if (c->hider_count) page_fact(html, "Hidden", words_hiders(c, arena));
    if (!isnan(c->eye_failed_share))
        page_fact(html, "Eyes that fail",
                  arena_format(arena, "%s of the places in the eye's box; the other figures "
                               "are of its worst place",
                               words_share(c->eye_failed_share, arena)));
    if (c->glare.threshold_cd_m2 > 0) add_glare_facts(html, &c->glare, arena);
}

static void add_facts(Text *html, const ReviewCard *card, Arena *arena)
{
    text_add(html, "<div><h4>The case</h4>\n<dl class=\"facts\">\n");
    add_light_facts(html, card, arena);
    add_sight_facts(html, card->of, arena);
    text_add(html, "</dl></div>\n");
}

/* ---- limits ----------------------------------------------------------------------------- */

static void add_limit(Text *html, const LimitVerdict *l, Arena *arena)
{
    bool        passes = l->verdict == VERDICT_PASS;
    const char *kind = l->is_advice ? "n" : arena_format(arena, "n %s",
                                                         words_class(l->verdict));
    page_row_begin(html, "");
    page_cell(html, "", l->name);
    page_cell(html, "n", words_found(l, arena));
    page_cell(html, "n", words_interval(l->low, l->high, arena));
    page_cell(html, "n", words_required(l, arena));
    page_cell(html, kind, words_margin(l->margin, arena));
    text_add(html, "<td>");
    review_bar_add_margin(html, l);
    text_add(html, "</td>");
    if (l->is_advice) page_cell(html, "sub", passes ? "kept" : "advice, not required");
    else page_cell(html, words_class(l->verdict), words_verdict(l->verdict));
    page_row_end(html);
}

/* Limits without a figure are named behind the table. */
static void add_limits(Text *html, const ReviewCase *c, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Limit", false, NULL}, {"found", true, NULL}, {"95 % interval", true, NULL},
        {"required", true, NULL}, {"margin", true, NULL}, {"", false, NULL},
        {"", false, NULL}};
    Text missing = {.arena = arena};
    int  found = 0;
    for (int i = 0; i < c->limit_count; i++) {
        if (!isnan(c->limits[i].found)) found++;
        else text_format(&missing, "%s%s", missing.size ? "; " : "", c->limits[i].name);
    }
    if (found > 0) page_table_begin(html, "", "limits", COLUMNS, 7);
    for (int i = 0; i < c->limit_count; i++)
        if (!isnan(c->limits[i].found)) add_limit(html, &c->limits[i], arena);
    if (found > 0) page_table_end(html);
    if (missing.size > 0) {
        text_add(html, "<p class=\"sub missing\">No figure to hold against: ");
        escape_markup(html, missing.data);
        text_add(html, ".</p>\n");
    }
}

/* ---- causes and remedies ---------------------------------------------------------------- */

static void add_chain(Text *html, const ReviewCard *card, int i, Arena *arena)
{
    bool has_rays = review_rays_has(card->of, i);
    if (has_rays) text_format(html, "<a href=\"#%s\">", review_rays_id(card->id, i, arena));
    escape_markup(html, words_chain(&card->of->causes[i], arena));
    if (has_rays) text_add(html, "</a>");
}

static const char *without_words(const ReviewCase *c, const CaseCause *cause, Arena *arena)
{
    if (isnan(cause->contrast_without)) return "";
    return arena_format(arena, "; without it %s",
                        words_ratio_as(c, cause->contrast_without, arena));
}

static void add_cause(Text *html, const ReviewCard *card, int i, Arena *arena)
{
    const CaseCause *cause = &card->of->causes[i];
    text_add(html, "<li><div>");
    page_element(html, "b", words_share(cause->share, arena));
    add_chain(html, card, i, arena);
    text_add(html, "</div>");
    review_bar_add_share(html, cause->share);
    page_element(html, "small", arena_format(arena, "%s cd/m², 95 %% sure between %s and %s%s",
                                             words_within(cause->cd_m2, cause->low,
                                                          cause->high, arena),
                                             words_within(cause->low, cause->low, cause->high,
                                                          arena),
                                             words_within(cause->high, cause->low, cause->high,
                                                          arena),
                                             without_words(card->of, cause, arena)));
    text_add(html, "</li>\n");
}

/* The light by where it began, came in and shines from: each adds up to all of it. */
static void add_groups(Text *html, const ReviewCase *c, Arena *arena)
{
    static const char *const HEADS[CAUSE_GROUPS] = {
        "Where the light began", "By which opening it came",
        "What the display mirrors or is lit by"};
    for (int g = 0; g < CAUSE_GROUPS; g++) {
        const CaseGroup *group = &c->groups[g];
        if (!group->count) continue;
        text_format(html, "<p class=\"sub\"><b>%s</b>: ", HEADS[g]);
        for (int i = 0; i < group->count; i++)
            escape_markup(html, arena_format(arena, "%s%s %s", i ? " · " : "",
                                             words_share(group->list[i].share, arena),
                                             group->list[i].what));
        text_add(html, "</p>\n");
    }
}

static double share_left(const ReviewCase *c)
{
    double left = 1;
    for (int i = 0; i < c->cause_count; i++) left -= c->causes[i].share;
    return left;
}

static void add_cause_list(Text *html, const ReviewCard *card, int from, int to, Arena *arena)
{
    text_add(html, "<ol class=\"causes\">\n");
    for (int i = from; i < to; i++) add_cause(html, card, i, arena);
    text_add(html, "</ol>\n");
}

static void add_causes(Text *html, const ReviewCard *card, Arena *arena)
{
    const ReviewCase *c = card->of;
    int first = c->cause_count > FIRST_CAUSES + 1 ? FIRST_CAUSES : c->cause_count;
    if (c->cause_count == 0) return;
    text_add(html, "<div><h4>Where the light that washes it out comes from</h4>\n");
    add_groups(html, c, arena);
    const char *seat = words_empty_seat(c, arena);
    if (seat[0]) page_element(html, "p class=\"sub seat\"", seat);
    add_cause_list(html, card, 0, first, arena);
    if (first < c->cause_count) {
        page_more_begin(html, arena_format(arena, "%d more ways", c->cause_count - first));
        add_cause_list(html, card, first, c->cause_count, arena);
        page_more_end(html);
    }
    if (share_left(c) >= 0.001)
        page_element(html, "p class=\"sub\"",
                     arena_format(arena, "All other ways together: %s.",
                                  words_share(share_left(c), arena)));
    text_add(html, "</div>\n");
}

/* The remedy's effect, behind its own words. */
static const char *remedy_result(const ReviewCase *c, const CaseRemedy *r, Arena *arena)
{
    const char *then = words_remedy(r, arena);
    if (isnan(r->level) || r->level == c->level) return then;
    return arena_format(arena, "%s; brightness %s of what was measured", then,
                        words_share(r->level, arena));
}

static void add_remedies(Text *html, const ReviewCase *c, Arena *arena)
{
    if (c->remedy_count == 0) return;
    text_add(html, "<div><h4>What would change it</h4>\n<ul class=\"remedies\">\n");
    for (int i = 0; i < c->remedy_count; i++) {
        text_add(html, "<li>");
        escape_markup(html, c->remedies[i].what);
        page_element(html, "small", remedy_result(c, &c->remedies[i], arena));
        text_add(html, "</li>\n");
    }
    text_add(html, "</ul></div>\n");
}

/* ---- pictures --------------------------------------------------------------------------- */

static void add_data(Text *html, const FileBytes *bytes, const char *kind)
{
    text_format(html, "\"data:image/%s;base64,", kind);
    base64_encode(html, bytes->data, bytes->size);
    text_add(html, "\"");
}

/* An <img> cannot be shown again elsewhere: what several cards show is an image of an SVG. */
static void add_shared(Text *html, const ReviewPicture *p, const PlainPng *png)
{
    FileBytes bytes = {png->bytes, png->size};
    text_format(html, "<svg viewBox=\"0 0 %d %d\" preserveAspectRatio=\"xMidYMid slice\" "
                "role=\"img\" aria-label=\"", png->width, png->height);
    escape_markup(html, p->title ? p->title : "");
    if (p->is_again) {
        text_format(html, "\"><use href=\"#%s\"/></svg>", p->id);
        return;
    }
    text_format(html, "\"><image id=\"%s\" width=\"%d\" height=\"%d\" href=", p->id,
                png->width, png->height);
    add_data(html, &bytes, "png");
    text_add(html, "/></svg>");
}

/* It takes its room before it is there. */
static void add_link(Text *html, const ReviewPicture *p, const PlainPng *png)
{
    text_add(html, "<img loading=\"lazy\" alt=\"");
    escape_markup(html, p->title ? p->title : "");
    text_add(html, "\"");
    if (png) text_format(html, " width=\"%d\" height=\"%d\"", png->width, png->height);
    text_add(html, " src=\"");
    escape_markup(html, p->beside);
    text_add(html, "\">");
}

/* The bytes of a picture's file, as they stand, or its name. */
static bool add_file(Text *html, const ReviewPicture *p, Arena scratch, Error *err)
{
    FileBytes   bytes;
    PlainPng    png;
    const char *ending = path_ending(p->file);
    bool        is_png = !strcasecmp(ending, ".png");
    if (!is_png && strcasecmp(ending, ".jpg") != 0 && strcasecmp(ending, ".jpeg") != 0)
        return error_at(err, ERROR_INPUT, p->file, "",
                        "required: a picture ending in .png or .jpg");
    if (!file_read(p->file, PICTURE_BYTES_MAX, &scratch, &bytes, err)) return false;
    bool is_plain = is_png && plain_png_open(bytes.data, bytes.size, &png);
    if (p->beside) {
        add_link(html, p, is_plain ? &png : NULL);
        return true;
    }
    if (p->id && is_plain) {
        add_shared(html, p, &png);
        return true;
    }
    text_add(html, "<img alt=\"");
    escape_markup(html, p->title ? p->title : "");
    text_add(html, "\" src=");
    add_data(html, &bytes, is_png ? "png" : "jpeg");
    text_add(html, ">");
    return true;
}

bool review_card_add_picture(Text *html, const ReviewPicture *p, Arena scratch, Error *err)
{
    return p->picture ? page_picture(html, p->title ? p->title : "", p->picture, false, scratch,
                                     err)
                      : add_file(html, p, scratch, err);
}

static bool add_picture(Text *html, const ReviewCard *card, const ReviewPicture *p,
                        Arena scratch, Error *err)
{
    const char *title = p->title ? p->title : "";
    text_add(html, p->is_frame ? "<figure class=\"frame\">" : "<figure>");
    page_element(html, "h3", title);
    if (p->view) text_add(html, "<div class=\"shown\">");
    if (!review_card_add_picture(html, p, scratch, err)) return false;
    if (p->view) {
        review_rays_add(html, card->of, card->id, &scratch);
        text_add(html, "</div>");
    }
    if (p->caption) page_element(html, "figcaption", p->caption);
    text_add(html, "</figure>\n");
    return true;
}

static bool add_pictures(Text *html, const ReviewCard *card, Arena scratch, Error *err)
{
    bool is_open = false;
    for (int i = 0; i < card->picture_count; i++) {
        if (card->pictures[i].of != card->of) continue;
        if (!is_open) text_add(html, "<div class=\"figures\">\n");
        is_open = true;
        if (!add_picture(html, card, &card->pictures[i], scratch, err)) return false;
    }
    if (is_open) text_add(html, "</div>\n");
    return true;
}

/* ---- the card --------------------------------------------------------------------------- */

const char *review_card_id(const Review *review, const ReviewCase *c, Arena *arena)
{
    for (int i = 0; i < review->sweep_count; i++)
        if (c == &review->sweeps[i].worst) return arena_format(arena, "s%d", i);
    return arena_format(arena, "c%td", c - review->cases);
}

bool review_card_is_here(const Review *review, const ReviewCase *c, Arena scratch)
{
    const ReviewCase **ranked = review_rank(review, &scratch);
    for (int i = 0; review->main_cards && i < review_case_count(review); i++)
        if (ranked[i] == c) return (i < review->main_cards) != review->is_beside;
    return true;
}

const char *review_card_link(const Review *review, const ReviewCase *c, Arena *arena)
{
    const char *page = "";
    if (review->whole) {
        const ReviewCase *same = review_case_like(review->whole, c);
        const char       *link = review_card_link(review->whole, same, arena);
        return link[0] == '#' ? arena_format(arena, "index.html%s", link) : link;
    }
    if (!review_card_is_here(review, c, *arena))
        page = review->is_beside ? "index.html" : REVIEW_PAGE_BESIDE;
    return arena_format(arena, "%s#%s", page, review_card_id(review, c, arena));
}

void review_card_begin_cell(Text *html, const Review *review, const ReviewCase *c,
                            Arena *arena)
{
    text_format(html, "<td class=\"%s\"><a href=\"%s\" title=\"", words_class(c->verdict),
                review_card_link(review, c, arena));
    escape_markup(html, arena_format(arena, "%s: %s", words_verdict(c->verdict),
                                     words_reason(c, arena)));
    text_add(html, "\">");
}

bool review_card_add(Text *html, const ReviewCard *card, Arena *arena, Error *err)
{
    const ReviewCase *c = card->of;
    text_format(html, "<details class=\"case %s\" id=\"%s\"%s>", words_class(c->verdict),
                card->id, card->is_open ? " open" : "");
    add_summary(html, c, arena);
    page_element(html, "p class=\"reason\"", arena_format(arena, "%s.",
                                                           words_reason(c, arena)));
    text_add(html, "<div class=\"two\">\n");
    if (c->verdict != VERDICT_UNJUDGED) {
        text_add(html, "<div>");
        review_bar_add_luminances(html, c, arena);
        text_add(html, "</div>\n");
    }
    add_facts(html, card, arena);
    add_causes(html, card, arena);
    add_remedies(html, c, arena);
    text_add(html, "</div>\n");
    add_limits(html, c, arena);
    bool ok = add_pictures(html, card, *arena, err);
    text_add(html, "</details>\n");
    return ok;
}
