#include "compare/report/html_report.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "compare/report/html_page.h"
#include "compare/report/html_pictures.h"
#include "compare/report/html_tables.h"

#define PAIR_PIXELS 4000000L   /* of a picture in a report of two files */
#define FOLDER_PIXELS 1500000L /* of one among many */
#define THUMBNAIL 240

void html_report_release(HtmlReport *report)
{
    markup_release(&report->index);
    markup_release(&report->pairs);
}

bool html_report_check_name(const char *path, Error *err)
{
    const char *ending = path_ending(path);
    if (!strcasecmp(ending, ".html") || !strcasecmp(ending, ".htm")) return true;
    return error_set(err, ERROR_USAGE, "--report %s: wanted a name that ends in .html", path);
}

/* ---- one pair ---------------------------------------------------------------------------- */

static void add_scale(Markup *html, const ShotScale *scale)
{
    markup_add(html, "<div class=\"scale\"><i ");
    markup_gradient(html, scale->is_signed);
    markup_add(html, "></i><div>");
    for (int i = 0; i < 5; i++) {
        markup_add(html, "<span>");
        markup_escape(html, scale->ticks[i]);
        if (i == 4 && scale->is_signed && scale->unit[0]) {
            markup_add(html, " ");
            markup_escape(html, scale->unit);
        }
        markup_add(html, "</span>");
    }
    markup_add(html, "</div>");
    if (scale->also) {
        markup_add(html, "<div><span>");
        markup_escape(html, scale->also);
        markup_add(html, "</span></div>");
    }
    markup_add(html, "</div>");
}

static bool add_shot(Markup *html, const Shot *shot, Arena scratch, Error *err)
{
    static const char *const KINDS[SHOT_COUNT] = {
        [SHOT_REFERENCE] = "reference", [SHOT_TEST] = "test", [SHOT_DIFFERENCE] = "difference",
        [SHOT_BLOCKS] = "blocks",       [SHOT_P_VALUE] = "p", [SHOT_FLIP] = "flip",
        [SHOT_DELTAE] = "deltae"};
    markup_format(html, "<figure class=\"shot\" data-kind=\"%s\"", KINDS[shot->kind]);
    if (shot->has_scale) {
        markup_format(html, " data-ramp=\"%s\" data-low=\"%.9g\" data-high=\"%.9g\" "
                      "data-unit=\"", shot->scale.is_signed ? "signed" : "plain",
                      shot->scale.low, shot->scale.high);
        markup_escape(html, shot->scale.unit);
        markup_add(html, "\"");
    }
    markup_format(html, "><h3>%s</h3><img alt=\"%s\" ", shot->title, shot->title);
    if (!markup_picture(html, &shot->picture, false, scratch, err)) return false;
    markup_add(html, ">");
    if (shot->has_scale) add_scale(html, &shot->scale);
    markup_add(html, "<figcaption>");
    markup_escape(html, shot->caption);
    markup_add(html, "</figcaption></figure>\n");
    return true;
}

static bool add_shots(Markup *html, const Comparison *c, long most_pixels, Arena scratch,
                      Error *err)
{
    int factor = shot_factor(&c->light[0], most_pixels);
    markup_format(html, "<div class=\"shots\" data-factor=\"%d\">\n", factor);
    for (int kind = 0; kind < SHOT_COUNT; kind++) {
        Shot  shot;
        Arena arena = scratch;
        if (!shot_make(c, (ShotKind)kind, factor, &arena, &shot)) continue;
        if (!add_shot(html, &shot, arena, err)) return false;
    }
    markup_add(html, "</div>\n");
    if (factor > 1)
        markup_format(html, "<p class=\"sub\">The pictures are reduced to 1 : %d; the figures "
                      "are of all pixels.</p>\n", factor);
    return true;
}

/* Sides that have no pixels in common, for those who wonder why. */
static bool add_both_sides(Markup *html, const Comparison *c, long most_pixels, Arena scratch,
                           Error *err)
{
    markup_add(html, "<div class=\"shots\">\n");
    for (int kind = SHOT_REFERENCE; kind <= SHOT_TEST; kind++) {
        Shot          shot;
        Arena         arena = scratch;
        const Planes *codes = kind == SHOT_TEST ? &c->test.codes : &c->reference.codes;
        shot_make(c, (ShotKind)kind, shot_factor(codes, most_pixels), &arena, &shot);
        if (!add_shot(html, &shot, arena, err)) return false;
    }
    markup_add(html, "</div>\n");
    return true;
}

static void add_verdict(Markup *html, const Comparison *c)
{
    markup_format(html, "<div class=\"verdict %s\"><h1><b>%s</b>: ",
                  c->same ? "same" : "different", c->same ? "Same" : "Different");
    markup_escape(html, c->verdict);
    markup_add(html, "</h1>\n");
    if (c->mean[0]) {
        markup_add(html, "<p class=\"mean\">");
        markup_escape(html, c->mean);
        markup_add(html, "</p>\n");
    }
    if (c->reasons.count > 1) {
        markup_add(html, "<ul class=\"reasons\">\n");
        for (int i = 1; i < c->reasons.count; i++) { /* the verdict says the first */
            markup_add(html, "<li>");
            markup_escape(html, c->reasons.list[i]);
            markup_add(html, "</li>\n");
        }
        markup_add(html, "</ul>\n");
    }
    markup_add(html, "</div>\n");
}

static void add_sides(Markup *html, const char *reference, const char *test)
{
    markup_add(html, "<p class=\"sub\">reference ");
    markup_escape(html, reference);
    markup_add(html, " · test ");
    markup_escape(html, test);
    markup_add(html, "</p>\n");
}

static bool add_pair(Markup *html, const Comparison *c, const CompareOptions *options,
                     long most_pixels, Arena scratch, Error *err)
{
    add_verdict(html, c);
    add_sides(html, c->reference.name, c->test.name);
    html_add_keys(html, c, options);
    if (c->has_pixels ? !add_shots(html, c, most_pixels, scratch, err)
                      : !add_both_sides(html, c, most_pixels, scratch, err))
        return false;
    html_add_tables(html, c, options);
    html_add_notes(html, c);
    return true;
}

/* ---- folders ----------------------------------------------------------------------------- */

static bool add_card(HtmlReport *report, const char *name, const Comparison *c, Arena scratch,
                     Error *err)
{
    Markup  *html = &report->index;
    ShotKind kind = c->same ? SHOT_REFERENCE : SHOT_TEST;
    markup_format(html, c->same ? "<div class=\"card same\">"
                                : "<a class=\"card\" href=\"#pair-%d\">", report->count);
    Picture small = shot_thumbnail(c, kind, THUMBNAIL, &scratch);
    markup_add(html, "<img alt=\"\" ");
    if (!markup_picture(html, &small, true, scratch, err)) return false;
    markup_add(html, "><div><strong>");
    markup_escape(html, name);
    markup_format(html, "</strong><em>%s</em>: ", c->same ? "same" : "different");
    markup_escape(html, c->verdict);
    if (!isnan(c->value[METRIC_FLIP]))
        markup_format(html, "<br>FLIP %.3g", c->value[METRIC_FLIP]);
    markup_add(html, c->same ? "</div></div>\n" : "</div></a>\n");
    return true;
}

static void begin_pair(HtmlReport *report, const char *name)
{
    markup_format(&report->pairs, "<details class=\"pair\" id=\"pair-%d\"%s><summary>",
                  report->count, report->shown++ == 0 ? " open" : "");
    markup_escape(&report->pairs, name);
    markup_add(&report->pairs, "</summary>\n");
}

bool html_report_add(HtmlReport *report, const char *name, const Comparison *c,
                     const CompareOptions *options, Arena scratch, Error *err)
{
    bool ok = true;
    if (!report->is_folder) {
        markup_add(&report->pairs, "<section class=\"pair\">\n");
        ok = add_pair(&report->pairs, c, options, PAIR_PIXELS, scratch, err);
        markup_add(&report->pairs, "</section>\n");
    } else {
        ok = add_card(report, name, c, scratch, err);
        if (ok && !c->same) {
            begin_pair(report, name);
            ok = add_pair(&report->pairs, c, options, FOLDER_PIXELS, scratch, err);
            markup_add(&report->pairs, "</details>\n");
        }
    }
    report->count++;
    report->different += !c->same;
    return ok;
}

void html_report_add_failure(HtmlReport *report, const char *name, const char *why)
{
    markup_format(&report->index, "<div class=\"card\" id=\"pair-%d\"><div><strong>",
                  report->count);
    markup_escape(&report->index, name);
    markup_add(&report->index, "</strong><em>failed</em>: ");
    markup_escape(&report->index, why);
    markup_add(&report->index, "</div></div>\n");
    report->count++;
    report->different++;
}

/* ---- the page ---------------------------------------------------------------------------- */

static void add_head(Markup *html, const char *reference, const char *test)
{
    markup_add(html, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
               "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
               "<title>");
    markup_escape(html, path_name(test));
    markup_add(html, " against ");
    markup_escape(html, path_name(reference));
    markup_add(html, "</title>\n<style>\n");
    markup_add(html, REPORT_TEXT_css);
    markup_add(html, "</style></head>\n<body><main>\n");
}

static void add_index(Markup *html, const HtmlReport *report, const char *reference,
                      const char *test)
{
    markup_format(html, "<div class=\"verdict %s\"><h1><b>%s</b>: ",
                  report->different ? "different" : "same",
                  report->different ? "Different" : "Same");
    if (report->different)
        markup_format(html, "%d of %d pairs differ", report->different, report->count);
    else
        markup_format(html, "%s %d pair%s", report->count == 1 ? "the" : "all", report->count,
                      report->count == 1 ? "" : "s");
    markup_add(html, "</h1></div>\n");
    add_sides(html, reference, test);
    markup_add(html, "<p class=\"sub\" hidden style=\"margin-top:14px\"><label>"
               "<input type=\"checkbox\" id=\"only\"> only what differs</label></p>\n"
               "<div class=\"cards\">\n");
    markup_append(html, &report->index);
    markup_add(html, "</div>\n");
}

bool html_report_write(const HtmlReport *report, const char *reference, const char *test,
                       const char *path, Error *err)
{
    Markup html = {0};
    add_head(&html, reference, test);
    if (report->is_folder) add_index(&html, report, reference, test);
    markup_append(&html, &report->pairs);
    markup_add(&html, "<footer>parhelion " PARHELION_VERSION ", compare --report</footer>\n"
               "</main>\n<script>\nvar ramps={\"signed\":\"");
    markup_ramp(&html, true);
    markup_add(&html, "\",\"plain\":\"");
    markup_ramp(&html, false);
    markup_add(&html, "\"};\n");
    markup_add(&html, REPORT_TEXT_js);
    markup_add(&html, "</script>\n</body></html>\n");
    bool ok = markup_write(&html, path, err);
    markup_release(&html);
    return ok;
}
