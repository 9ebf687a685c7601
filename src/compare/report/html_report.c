/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/html_report.h"

#include <math.h>
#include <stdio.h>
#include <strings.h>

#include "base/file.h"
#include "compare/report/html_pictures.h"
#include "compare/report/html_tables.h"
#include "page/page.h"
#include "text/escape.h"

#define PAIR_PIXELS 4000000L   /* of a picture in a report of two files */
#define FOLDER_PIXELS 1500000L /* of one among many */
#define THUMBNAIL 240
#define MOST_BYTES ((size_t)16 << 30) /* of address space for each text */
#define FRAME_BYTES ((size_t)1 << 28) /* for what stands around the pairs */

/* report.css and report.js beside this file; the build embeds them. */
extern const char COMPARE_STYLE[], COMPARE_SCRIPT[];

/* The index and the pairs grow side by side, each in an arena of its own. */
void html_report_start(HtmlReport *report, bool is_folder)
{
    *report = (HtmlReport){.is_folder = is_folder};
    for (int i = 0; i < 2; i++) report->own[i] = arena_reserve(MOST_BYTES);
    report->index.arena = &report->own[0];
    report->pairs.arena = &report->own[1];
}

void html_report_release(HtmlReport *report)
{
    for (int i = 0; i < 2; i++) arena_release(&report->own[i]);
    *report = (HtmlReport){0};
}

bool html_report_check_name(const char *path, Error *err)
{
    const char *ending = path_ending(path);
    if (!strcasecmp(ending, ".html") || !strcasecmp(ending, ".htm")) return true;
    return error_set(err, ERROR_USAGE, "--report %s: wanted a name that ends in .html", path);
}

/* ---- one pair ---------------------------------------------------------------------------- */

static void add_scale(Text *html, const ShotScale *scale)
{
    bool names_unit = scale->is_signed && scale->unit[0];
    text_add(html, "<div class=\"scale\"><i ");
    shot_ramp_gradient(html, scale->is_signed);
    text_add(html, "></i><div>");
    for (int i = 0; i < 5; i++) {
        text_add(html, "<span>");
        escape_markup(html, scale->ticks[i]);
        text_add(html, i == 4 && names_unit ? " " : "");
        escape_markup(html, i == 4 && names_unit ? scale->unit : "");
        text_add(html, "</span>");
    }
    text_add(html, "</div>");
    if (scale->also) page_element(html, "div", scale->also);
    text_add(html, "</div>");
}

static bool add_shot(Text *html, const Shot *shot, Arena scratch, Error *err)
{
    static const char *const KINDS[SHOT_COUNT] = {
        [SHOT_REFERENCE] = "reference", [SHOT_TEST] = "test", [SHOT_DIFFERENCE] = "difference",
        [SHOT_BLOCKS] = "blocks",       [SHOT_P_VALUE] = "p", [SHOT_FLIP] = "flip",
        [SHOT_DELTAE] = "deltae"};
    text_format(html, "<figure class=\"shot\" data-kind=\"%s\"", KINDS[shot->kind]);
    if (shot->has_scale)
        text_format(html, " data-ramp=\"%s\" data-low=\"%.9g\" data-high=\"%.9g\" "
                    "data-unit=\"%s\"", shot->scale.is_signed ? "signed" : "plain",
                    shot->scale.low, shot->scale.high, shot->scale.unit);
    text_add(html, ">");
    page_element(html, "h3", shot->title);
    if (!page_picture(html, shot->title, &shot->picture, false, scratch, err)) return false;
    if (shot->has_scale) add_scale(html, &shot->scale);
    page_element(html, "figcaption", shot->caption);
    text_add(html, "</figure>\n");
    return true;
}

static bool add_shots(Text *html, const Comparison *c, long most_pixels, Arena scratch,
                      Error *err)
{
    int factor = shot_factor(&c->light[0], most_pixels);
    text_format(html, "<div class=\"shots\" data-factor=\"%d\">\n", factor);
    for (int kind = 0; kind < SHOT_COUNT; kind++) {
        Shot  shot;
        Arena arena = scratch;
        if (!shot_make(c, (ShotKind)kind, factor, &arena, &shot)) continue;
        if (!add_shot(html, &shot, arena, err)) return false;
    }
    text_add(html, "</div>\n");
    if (factor > 1)
        text_format(html, "<p class=\"sub\">The pictures are reduced to 1 : %d; the metrics "
                    "are of all pixels.</p>\n", factor);
    return true;
}

/* Sides that have no pixels in common, for those who wonder why. */
static bool add_both_sides(Text *html, const Comparison *c, long most_pixels, Arena scratch,
                           Error *err)
{
    text_add(html, "<div class=\"shots\">\n");
    for (int kind = SHOT_REFERENCE; kind <= SHOT_TEST; kind++) {
        Shot          shot;
        Arena         arena = scratch;
        const Planes *codes = kind == SHOT_TEST ? &c->test.codes : &c->reference.codes;
        shot_make(c, (ShotKind)kind, shot_factor(codes, most_pixels), &arena, &shot);
        if (!add_shot(html, &shot, arena, err)) return false;
    }
    text_add(html, "</div>\n");
    return true;
}

/* <h1> begins: what follows is the verdict's sentence. */
static void begin_verdict(Text *html, bool is_same)
{
    text_format(html, "<div class=\"verdict %s\"><h1><b>%s</b>: ",
                is_same ? "same" : "different", is_same ? "Same" : "Different");
}

static void add_verdict(Text *html, const Comparison *c)
{
    begin_verdict(html, c->same);
    escape_markup(html, c->verdict);
    text_add(html, "</h1>\n");
    if (c->mean[0]) page_element(html, "p class=\"mean\"", c->mean);
    if (c->reasons.count > 1) /* the verdict states the first */
        page_list(html, "reasons", c->reasons.list + 1, c->reasons.count - 1);
    text_add(html, "</div>\n");
}

static void add_sides(Text *html, const char *reference, const char *test)
{
    text_add(html, "<p class=\"sub\">reference ");
    escape_markup(html, reference);
    text_add(html, " · test ");
    escape_markup(html, test);
    text_add(html, "</p>\n");
}

static bool has_planes(const Comparison *c)
{
    return !input_is_packed(&c->reference) && !input_is_packed(&c->test);
}

static bool add_pair(Text *html, const Comparison *c, const CompareOptions *options,
                     long most_pixels, Arena scratch, Error *err)
{
    add_verdict(html, c);
    add_sides(html, c->reference.name, c->test.name);
    html_add_keys(html, c, options);
    if (!has_planes(c))
        text_add(html, "<p class=\"sub\">Too large to be shown.</p>\n");
    else if (c->has_pixels ? !add_shots(html, c, most_pixels, scratch, err)
                      : !add_both_sides(html, c, most_pixels, scratch, err))
        return false;
    html_add_tables(html, c, options);
    html_add_notes(html, c);
    return true;
}

/* ---- folders ----------------------------------------------------------------------------- */

/* The text below a card's picture; `more` is markup. */
static void add_card_text(Text *html, const char *name, const char *answer, const char *why,
                          const char *more)
{
    text_add(html, "<div><strong>");
    escape_markup(html, name);
    text_format(html, "</strong><em>%s</em>: ", answer);
    escape_markup(html, why);
    text_format(html, "%s</div>", more);
}

static bool add_card(HtmlReport *report, const char *name, const Comparison *c, Arena scratch,
                     Error *err)
{
    char     flip[64] = "";
    Text    *html = &report->index;
    ShotKind kind = c->same ? SHOT_REFERENCE : SHOT_TEST;
    text_format(html, c->same ? "<div class=\"card same\">"
                              : "<a class=\"card\" href=\"#pair-%d\">", report->count);
    if (has_planes(c)) {
        Picture small = shot_thumbnail(c, kind, THUMBNAIL, &scratch);
        if (!page_picture(html, "", &small, true, scratch, err)) return false;
    }
    if (!isnan(c->value[METRIC_FLIP]))
        snprintf(flip, sizeof flip, "<br>FLIP %.3g", c->value[METRIC_FLIP]);
    add_card_text(html, name, c->same ? "same" : "different", c->verdict, flip);
    text_add(html, c->same ? "</div>\n" : "</a>\n");
    return true;
}

static void begin_pair(HtmlReport *report, const char *name)
{
    text_format(&report->pairs, "<details class=\"pair\" id=\"pair-%d\"%s>", report->count,
                report->shown++ == 0 ? " open" : "");
    page_element(&report->pairs, "summary", name);
}

bool html_report_add(HtmlReport *report, const char *name, const Comparison *c,
                     const CompareOptions *options, Arena scratch, Error *err)
{
    bool ok = true;
    if (!report->is_folder) {
        text_add(&report->pairs, "<section class=\"pair\">\n");
        ok = add_pair(&report->pairs, c, options, PAIR_PIXELS, scratch, err);
        text_add(&report->pairs, "</section>\n");
    } else {
        ok = add_card(report, name, c, scratch, err);
        if (ok && !c->same) {
            begin_pair(report, name);
            ok = add_pair(&report->pairs, c, options, FOLDER_PIXELS, scratch, err);
            text_add(&report->pairs, "</details>\n");
        }
    }
    report->count++;
    report->different += !c->same;
    return ok;
}

void html_report_add_failure(HtmlReport *report, const char *name, const char *why)
{
    text_format(&report->index, "<div class=\"card\" id=\"pair-%d\">", report->count);
    add_card_text(&report->index, name, "failed", why, "");
    text_add(&report->index, "</div>\n");
    report->count++;
    report->different++;
}

/* ---- the page ---------------------------------------------------------------------------- */

static void begin_page(Text *html, const char *reference, const char *test)
{
    page_begin(html, &(PageHead){.title = arena_format(html->arena, "%s against %s",
                                                       path_name(test), path_name(reference)),
                                 .style = COMPARE_STYLE});
}

static void begin_index(Text *html, const HtmlReport *report, const char *reference,
                        const char *test)
{
    begin_verdict(html, report->different == 0);
    if (report->different)
        text_format(html, "%d of %d pairs differ", report->different, report->count);
    else
        text_format(html, "%s %d pair%s", report->count == 1 ? "the" : "all", report->count,
                    report->count == 1 ? "" : "s");
    text_add(html, "</h1></div>\n");
    add_sides(html, reference, test);
    text_add(html, "<p class=\"sub only-differing\" hidden><label>"
             "<input type=\"checkbox\" id=\"only\"> only what differs</label></p>\n"
             "<div class=\"cards\">\n");
}

static void end_page(Text *html)
{
    Text ramps = {.arena = html->arena};
    text_add(&ramps, "var ramps={\"signed\":\"");
    shot_ramp_digits(&ramps, true);
    text_add(&ramps, "\",\"plain\":\"");
    shot_ramp_digits(&ramps, false);
    text_add(&ramps, "\"};\n");
    page_end(html, "compare --report", (const char *const[]){ramps.data, COMPARE_SCRIPT, NULL});
}

bool html_report_write(const HtmlReport *report, const char *reference, const char *test,
                       const char *path, Error *err)
{
    Arena arena = arena_reserve(FRAME_BYTES);
    Text  begin = {.arena = &arena}, between = {.arena = &arena}, end = {.arena = &arena};
    begin_page(&begin, reference, test);
    if (report->is_folder) {
        begin_index(&begin, report, reference, test);
        text_add(&between, "</div>\n");
    }
    end_page(&end);
    const Text *const parts[] = {&begin, &report->index, &between, &report->pairs, &end};
    bool ok = page_write(parts, 5, path, err);
    arena_release(&arena);
    return ok;
}
