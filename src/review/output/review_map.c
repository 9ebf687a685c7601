/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_map.h"

#include <math.h>
#include <string.h>

#include "base/calendar.h"
#include "base/count.h"
#include "base/mathd.h"
#include "image/picture.h"
#include "page/page.h"
#include "review/output/review_words.h"
#include "review/quantity.h"
#include "text/json_text.h"
#include "text/text.h"

/* ---- colours ---------------------------------------------------------------------------- */

typedef struct Colour {
    float srgb[3];
} Colour;

/* Fails: dark to light red; passes: a quiet blue. Told apart without red and green too. */
static const Colour WORST = {{0.50f, 0.06f, 0.09f}}, FAILING = {{0.97f, 0.68f, 0.50f}},
                    PASSING = {{0.86f, 0.93f, 0.97f}}, BEST = {{0.45f, 0.64f, 0.78f}},
                    CLOSE = {{0.98f, 0.84f, 0.33f}}, HIDDEN = {{0.36f, 0.34f, 0.42f}},
                    NONE = {{0.74f, 0.76f, 0.78f}}, NIGHT = {{0.25f, 0.28f, 0.33f}};

static Colour mix(Colour a, Colour b, double t) {
    Colour out;
    float part = t > 0 ? t < 1 ? (float)t : 1 : 0;
    for (int i = 0; i < 3; i++) out.srgb[i] = a.srgb[i] + part * (b.srgb[i] - a.srgb[i]);
    return out;
}

/* From margin -1, full wash-out, to 1. A case may fail for another reason than its contrast. */
static Colour colour_of(Verdict verdict, double margin) {
    if (verdict == VERDICT_TOO_CLOSE) return CLOSE;
    if (verdict == VERDICT_UNJUDGED) return HIDDEN;
    if (verdict == VERDICT_FAIL) return mix(FAILING, WORST, isnan(margin) ? 0.5 : -margin);
    return mix(PASSING, BEST, isnan(margin) ? 0.5 : margin);
}

static void put(const Picture *picture, int x, int y, Colour colour) {
    memcpy(picture_pixel(picture, x, y), colour.srgb, sizeof colour.srgb);
}

/* ---- what maps and calendars share ------------------------------------------------------ */

/* What a picture of cells is in both: one pixel each, and what the script says of each, which is
 * taken; NULL: nothing. False: it cannot be encoded. */
static bool set_cells(json_t *to, const Picture *cells, json_t *said, Arena scratch, Error *err) {
    Text json = {.arena = &scratch};
    json_t *picture = page_picture(cells, false, scratch, err);
    const char *values = NULL;
    if (said && json_dump_text(&json, said, JSON_COMPACT))
        values = page_deflated(json.data, json.size, &scratch, err);
    bool ok = picture && (values || !said);
    json_decref(said);
    json_object_set_new(to, "cells", picture);
    page_set(to, "values", values);
    page_set_count(to, "columns", cells->width);
    page_set_count(to, "rows", cells->height);
    return ok;
}

/* share: of the way along the axis, 0..1; from the left, or from the top. */
static json_t *add_tick(json_t *list, double share) {
    json_t *to = page_add(list);
    page_set(to, "end", share < 0.04 ? "begin" : share > 0.96 ? "last" : NULL);
    json_object_set_new(to, "at", json_real(100 * share));
    return to;
}

static void set_colour(json_t *to, const char *name, Colour colour) {
    char code[8];
    snprintf(code, sizeof code, "#%02x%02x%02x", (int)(colour.srgb[0] * 255 + 0.5f),
             (int)(colour.srgb[1] * 255 + 0.5f), (int)(colour.srgb[2] * 255 + 0.5f));
    page_set(to, name, code);
}

static json_t *colours(void) {
    json_t *to = json_object();
    set_colour(to, "worst", WORST);
    set_colour(to, "failing", FAILING);
    set_colour(to, "close", CLOSE);
    set_colour(to, "passing", PASSING);
    set_colour(to, "best", BEST);
    set_colour(to, "hidden", HIDDEN);
    set_colour(to, "none", NONE);
    set_colour(to, "night", NIGHT);
    return to;
}

/* A sweep goes by the middle of an eye's box. */
static json_t *values_of(const ReviewSweep *sweep) {
    json_t *to = json_object();
    json_object_set_new(to, "colour", colours());
    page_set_flag(to, "of_box", sweep && sweep_has_box(sweep));
    return to;
}

/* ---- the map ---------------------------------------------------------------------------- */

static size_t map_index(const ReviewMap *map, int azimuth, int elevation) {
    return (size_t)elevation * (size_t)map->azimuth_deg.count + (size_t)azimuth;
}

static bool has_answer(const ReviewMap *map, int azimuth, int elevation) {
    return !isnan(map->cells[map_index(map, azimuth, elevation)].contrast);
}

/* Outside the map nothing fails. */
static bool fails_at(const ReviewMap *map, int azimuth, int elevation) {
    bool is_inside = azimuth >= 0 && azimuth < map->azimuth_deg.count && elevation >= 0 &&
                     elevation < map->elevation_deg.count;
    return is_inside && has_answer(map, azimuth, elevation) &&
           map->cells[map_index(map, azimuth, elevation)].verdict == VERDICT_FAIL;
}

static Picture map_picture(const ReviewMap *map, Arena *arena) {
    int rows = map->elevation_deg.count;
    Picture out = picture_create(map->azimuth_deg.count, rows, arena);
    for (int e = 0; e < rows; e++)
        for (int a = 0; a < out.width; a++) {
            const ReviewStep *step = &map->cells[map_index(map, a, e)];
            put(&out, a, rows - 1 - e,
                has_answer(map, a, e) ? colour_of(step->verdict, step->margin) : NONE);
        }
    return out;
}

/* The border of what fails, along the edges of cells; runs of edges are one line. */
static const char *border(const ReviewMap *map, Arena *arena) {
    Text line = {.arena = arena};
    int columns = map->azimuth_deg.count, rows = map->elevation_deg.count;
    for (int e = 0; e <= rows; e++)
        for (int a = 0, from = 0; a <= columns; a++) {
            bool here = a < columns && fails_at(map, a, e) != fails_at(map, a, e - 1);
            bool before = a > 0 && fails_at(map, a - 1, e) != fails_at(map, a - 1, e - 1);
            if (here && !before) from = a;
            if (!here && before) text_format(&line, "M%d %dH%d", from, rows - e, a);
        }
    for (int a = 0; a <= columns; a++)
        for (int e = 0, from = 0; e <= rows; e++) {
            bool here = e < rows && fails_at(map, a, e) != fails_at(map, a - 1, e);
            bool before = e > 0 && fails_at(map, a, e - 1) != fails_at(map, a - 1, e - 1);
            if (here && !before) from = e;
            if (!here && before) text_format(&line, "M%d %dV%d", a, rows - from, rows - e);
        }
    return line.data ? line.data : "";
}

/* Where a cell's middle lies, in cells from the first edge. */
static double axis_place(const ReviewAxis *axis, double value) {
    return (value - axis->first) / axis->step + 0.5;
}

/* An azimuth as the axis counts it: 350 on an axis from -180 is -10. */
static double axis_azimuth(const ReviewAxis *axis, double azimuth_deg) {
    double low = axis->first - axis->step / 2;
    return low + 360 * ((azimuth_deg - low) / 360 - floor((azimuth_deg - low) / 360));
}

/* In per cent of the map, from its lower left. False: it lies outside. */
static bool set_place(json_t *to, const ReviewMap *map, double azimuth_deg, double elevation_deg) {
    double azimuth = axis_azimuth(&map->azimuth_deg, azimuth_deg);
    double x = axis_place(&map->azimuth_deg, azimuth) / map->azimuth_deg.count;
    double y = axis_place(&map->elevation_deg, elevation_deg) / map->elevation_deg.count;
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return false;
    json_object_set_new(to, "x", json_real(100 * x));
    json_object_set_new(to, "y", json_real(100 * y));
    return true;
}

/* Where it is worst, as it was read again: of the vehicle, as the map. */
static void set_worst(json_t *to, const ReviewMap *map, Arena *arena) {
    const ReviewCase *c = map->of ? &map->of->worst : NULL;
    json_t *worst = json_object();
    bool is_shown =
        c && c->has_sun && set_place(worst, map, c->sun_azimuth_deg, c->sun_elevation_deg);
    if (is_shown) page_set(worst, "sun", words_sun(c, words_directions(true), arena));
    json_object_set_new(to, "worst_sun", is_shown ? worst : json_null());
    if (!is_shown) json_decref(worst);
}

static json_t *azimuths(const ReviewMap *map) {
    static const char *const NAMES[4] = {"ahead", "right", "behind", "left"};
    const ReviewAxis *axis = &map->azimuth_deg;
    double range = axis->step * axis->count;
    int step = range > 180 ? 90 : range > 60 ? 30 : 10;
    json_t *list = json_array();
    for (int value = -360; value <= 720; value += step) {
        double share = axis_place(axis, value) / axis->count;
        if (share < 0 || share > 1) continue;
        json_t *tick = add_tick(list, share);
        page_set_count(tick, "degrees", value);
        page_set(tick, "name", value % 90 ? NULL : NAMES[(value + 360) / 90 % 4]);
    }
    return list;
}

static json_t *elevations(const ReviewMap *map) {
    const ReviewAxis *axis = &map->elevation_deg;
    double range = axis->step * axis->count;
    int step = range > 50 ? 20 : range > 20 ? 10 : range > 8 ? 5 : 1;
    json_t *list = json_array();
    for (int value = -90; value <= 90; value++) {
        double share = axis_place(axis, value) / axis->count;
        if (value % step == 0 && share >= 0 && share <= 1)
            page_set_count(add_tick(list, 1 - share), "degrees", value);
    }
    return list;
}

#define GAP (-1) /* instead of a verdict */

static bool holds(const ReviewMap *map, int wanted) {
    for (int e = 0; e < map->elevation_deg.count; e++)
        for (int a = 0; a < map->azimuth_deg.count; a++) {
            int here = has_answer(map, a, e) ? (int)map->cells[map_index(map, a, e)].verdict : GAP;
            if (here == wanted) return true;
        }
    return false;
}

/* Of each cell the row of its step, a list a column; null where there is none. */
static json_t *steps_said(const ReviewMap *map, Arena scratch) {
    static const char *const NAMES[] = {"kind",      "verdict", "contrast", "range", "margin",
                                        "elevation", "azimuth", "where",    "when",  "lux",
                                        "reflected", "mirror",  "level"};
    json_t *said = json_object();
    for (int k = 0; k < COUNT_OF(NAMES); k++) json_object_set_new(said, NAMES[k], json_array());
    for (int i = 0; i < map->azimuth_deg.count * map->elevation_deg.count; i++) {
        const ReviewStep *step = &map->cells[i];
        Arena own = scratch;
        const char *const words[COUNT_OF(NAMES)] = {
            words_class(step->verdict),
            words_verdict(step->verdict),
            words_within(step->contrast, step->low, step->high, &own),
            words_interval(step->low, step->high, &own),
            words_margin(step->margin, &own),
            arena_format(&own, "%.1f", step->elevation_deg),
            arena_format(&own, "%.1f", step->azimuth_deg),
            words_directions(true)[words_eighth(step->azimuth_deg)],
            step->when,
            words_figure(step->lux, &own),
            words_figure(step->reflected, &own),
            words_figure(step->mirror, &own),
            words_share(step->level, &own)};
        for (int k = 0; k < COUNT_OF(NAMES); k++)
            json_array_append_new(json_object_get(said, NAMES[k]),
                                  json_text_or_null(isnan(step->contrast) ? NULL : words[k]));
    }
    return said;
}

static void set_axes(json_t *to, const ReviewMap *map) {
    const ReviewAxis *across = &map->azimuth_deg, *up = &map->elevation_deg;
    json_object_set_new(to, "step", json_real(across->step));
    json_object_set_new(to, "low", json_real(up->first));
    json_object_set_new(to, "rise", json_real(up->step));
    json_object_set_new(to, "azimuths", azimuths(map));
    json_object_set_new(to, "elevations", elevations(map));
}

json_t *review_map_values(const ReviewMap *map, bool for_script, Arena scratch, Error *err) {
    json_t *to = values_of(map->of);
    Picture cells = map_picture(map, &scratch);
    if (!set_cells(to, &cells, for_script ? steps_said(map, scratch) : NULL, scratch, err)) {
        json_decref(to);
        return NULL;
    }
    set_axes(to, map);
    set_worst(to, map, &scratch);
    page_set(to, "border", border(map, &scratch));
    json_object_set_new(to, "holds",
                        json_pack("{s:b, s:b, s:b}", "close", holds(map, VERDICT_TOO_CLOSE),
                                  "hidden", holds(map, VERDICT_UNJUDGED), "gap", holds(map, GAP)));
    page_set_flag(to, "hides", map->of && map->of->worst.must_not_be_read);
    page_set_flag(to, "is_between_steps", map->is_between_steps);
    return to;
}

/* ---- the calendar ----------------------------------------------------------------------- */

static int failing_at(const ReviewCalendar *calendar, int day, int step) {
    return calendar->failing[(size_t)day * (size_t)calendar->steps_a_day + (size_t)step];
}

static Picture calendar_picture(const ReviewCalendar *calendar, Arena *arena) {
    int rows = calendar->steps_a_day;
    Picture out = picture_create(calendar->days, rows, arena);
    for (int day = 0; day < calendar->days; day++)
        for (int step = 0; step < rows; step++) {
            int failing = failing_at(calendar, day, step);
            Colour colour = failing < 0 ? NIGHT
                            : failing   ? mix(FAILING, WORST, (double)failing / calendar->headings)
                                        : PASSING;
            put(&out, day, rows - 1 - step, colour);
        }
    return out;
}

static json_t *months(const ReviewCalendar *calendar) {
    static const char *const NAMES[12] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    json_t *list = json_array();
    int day = 0;
    for (int month = 0; month < 12; month++) {
        int length = calendar_days_of_month(calendar->year, month + 1);
        if (day + length / 2 < calendar->days)
            page_set(add_tick(list, (day + length / 2.0) / calendar->days), "name", NAMES[month]);
        day += length;
    }
    return list;
}

/* Of each cell the headings that fail: null where the sun is down. */
static json_t *headings_said(const ReviewCalendar *calendar) {
    json_t *said = json_array();
    for (int step = 0; step < calendar->steps_a_day; step++)
        for (int day = 0; day < calendar->days; day++) {
            int failing = failing_at(calendar, day, step);
            json_array_append_new(said, failing < 0 ? json_null() : json_integer(failing));
        }
    return said;
}

json_t *review_calendar_values(const ReviewCalendar *calendar, Arena scratch, Error *err) {
    json_t *to = values_of(calendar->of);
    Picture cells = calendar_picture(calendar, &scratch);
    if (!set_cells(to, &cells, headings_said(calendar), scratch, err)) {
        json_decref(to);
        return NULL;
    }
    json_object_set_new(to, "months", months(calendar));
    page_set_count(to, "year", calendar->year);
    page_set_count(to, "headings", calendar->headings);
    page_set_flag(to, "has_headings", calendar->headings > 1);
    return to;
}

/* ---- margins and shares ----------------------------------------------------------------- */

#define HALF_WIDTH 44.0 /* pixels from the limit to a margin of -1, and to 1 */

/* From the left end. */
static double margin_place(double margin) {
    return HALF_WIDTH * (1 + fmax(-1, fmin(1, margin)));
}

static double margin_at(const LimitVerdict *limit, double found) {
    return quantity_margin(limit_kind_named(limit->kind), limit->is_upper, found, limit->value);
}

const char *review_bar_margin(const LimitVerdict *limit, Arena *arena) {
    Text svg = {.arena = arena};
    if (!isfinite(limit->margin)) return "";
    double x = margin_place(limit->margin);
    double low = margin_place(margin_at(limit, limit->low));
    double high = margin_place(margin_at(limit, limit->high));
    text_format(&svg,
                "<svg class=\"margin\" width=\"%.0f\" height=\"12\" aria-hidden=\"true\">"
                "<rect class=\"%s\" x=\"%.1f\" y=\"2\" width=\"%.1f\" height=\"8\"/>",
                2 * HALF_WIDTH, words_class(limit->verdict), fmin(x, HALF_WIDTH),
                fabs(x - HALF_WIDTH));
    if (isfinite(low) && isfinite(high) && fabs(high - low) >= 1)
        text_format(&svg, "<path class=\"whisker\" d=\"M%.1f 6H%.1f\"/>", low, high);
    text_format(&svg, "<path class=\"limit\" d=\"M%.1f 0V12\"/></svg>", HALF_WIDTH);
    return svg.data;
}

const char *review_bar_percent(double share, Arena *arena) {
    return arena_format(arena, "%.1f", share > 0 ? fmin(100 * share, 100) : 0);
}

/* ---- luminances ------------------------------------------------------------------------- */

typedef struct BarPart {
    const char *kind; /* its class */
    double cd_m2;
} BarPart;

#define PARTS 4

typedef struct Bars {
    BarPart bright[PARTS], dark[PARTS];
    bool has_veil; /* the eye's veil is in the contrast that is judged */
    double dark_sum;
    double most;       /* the end of the scale */
    double wanted;     /* contrast ratio; NaN: none that can be drawn */
    const char *words; /* of the mark */
} Bars;

static double or_zero(double value) {
    return isfinite(value) && value > 0 ? value : 0;
}

static double sum_of(const BarPart *parts) {
    double sum = 0;
    for (int i = 0; i < PARTS; i++) sum += parts[i].cd_m2;
    return sum;
}

/* The sum that the contrast is taken of, and nothing else: a veil that the limit does not
 * include is no part of it. The mirror's and the scattered light share what is reflected. */
static void stack(const CaseLuminances *l, double emitted, bool has_veil, BarPart out[PARTS]) {
    double mirror = or_zero(l->mirror), both = mirror + or_zero(l->scattered);
    double reflected = or_zero(l->reflected);
    double shiny =
        isfinite(l->mirror) && isfinite(l->scattered) && both > 0 ? reflected * (mirror / both) : 0;
    out[0] = (BarPart){"veil", has_veil ? or_zero(l->veil) : 0};
    out[1] = (BarPart){"mirror", shiny};
    out[2] = (BarPart){"scatter", reflected - shiny};
    out[3] = (BarPart){"emit", or_zero(emitted)};
}

static Bars make_bars(const ReviewCase *c, Arena *arena) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double bright = fmax(or_zero(l->foreground), or_zero(l->background));
    double dark = fmin(or_zero(l->foreground), or_zero(l->background));
    Bars bars = {.wanted = NAN};
    if (c->limit_id >= 0 && c->limit_id < c->limit_count) {
        const LimitVerdict *limit = &c->limits[c->limit_id];
        LimitKind kind = limit_kind_named(limit->kind);
        bars.has_veil = limit->has_veil;
        if (quantity_is_contrast(kind)) bars.wanted = ratio_from_contrast(kind, limit->value);
        const char *of = kind == LIMIT_CONTRAST_RATIO ? "" : words_kind(limit);
        bars.words = arena_format(arena, "%s%s%s", of, of[0] ? " " : "", words_bound(limit, arena));
    }
    stack(l, bright, bars.has_veil, bars.bright);
    stack(l, dark, bars.has_veil, bars.dark);
    bars.dark_sum = sum_of(bars.dark);
    bars.most = sum_of(bars.bright);
    if (bars.wanted > 0) bars.most = fmax(bars.most, 1.02 * bars.wanted * bars.dark_sum);
    return bars;
}

static void add_bar(Text *html, const BarPart *parts, double most, int y) {
    double at = 0;
    for (int i = 0; i < PARTS; i++) {
        double width = 100 * parts[i].cd_m2 / most;
        if (width > 0)
            text_format(html,
                        "<rect class=\"%s\" x=\"%.4f%%\" y=\"%d\" width=\"%.4f%%\" "
                        "height=\"16\"/>",
                        parts[i].kind, at, y, width);
        at += width;
    }
}

static void add_mark(Text *html, const Bars *bars) {
    double x = 100 * bars->wanted * bars->dark_sum / bars->most;
    if (!isfinite(x)) return;
    text_format(html,
                "<rect class=\"mark\" x=\"%.4f%%\" y=\"0\" width=\"2\" height=\"38\"/>"
                "<text x=\"%.2f%%\" y=\"11\" dx=\"%d\" text-anchor=\"%s\">",
                x, x, x > 50 ? -5 : 7, x > 50 ? "end" : "start");
    escape_markup(html, bars->words);
    text_add(html, "</text>");
}

const char *review_bar_luminances(const ReviewCase *c, bool *has_veil, Arena *arena) {
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
