/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_map.h"

#include <math.h>
#include <string.h>

#include "base/calendar.h"
#include "base/mathd.h"
#include "image/picture.h"
#include "page/page.h"
#include "review/output/review_words.h"
#include "text/base64.h"
#include "text/text.h"

#define DRAWING_BYTES ((size_t)1 << 32) /* address space for cells and their picture */

/* ---- colours ---------------------------------------------------------------------------- */

typedef struct Colour {
    float srgb[3];
} Colour;

/* Fails: dark to light red; passes: a quiet blue. Told apart without red and green too. */
static const Colour WORST = {{0.50f, 0.06f, 0.09f}}, FAILING = {{0.97f, 0.68f, 0.50f}},
                    PASSING = {{0.86f, 0.93f, 0.97f}}, BEST = {{0.45f, 0.64f, 0.78f}},
                    CLOSE = {{0.98f, 0.84f, 0.33f}}, HIDDEN = {{0.36f, 0.34f, 0.42f}},
                    NONE = {{0.74f, 0.76f, 0.78f}}, NIGHT = {{0.25f, 0.28f, 0.33f}};

static Colour mix(Colour a, Colour b, double t)
{
    Colour out;
    float  part = t > 0 ? t < 1 ? (float)t : 1 : 0;
    for (int i = 0; i < 3; i++) out.srgb[i] = a.srgb[i] + part * (b.srgb[i] - a.srgb[i]);
    return out;
}

/* From margin -1, full wash-out, to 1. A case may fail for another reason than its contrast. */
static Colour colour_of(Verdict verdict, double margin)
{
    if (verdict == VERDICT_TOO_CLOSE) return CLOSE;
    if (verdict == VERDICT_UNJUDGED) return HIDDEN;
    if (verdict == VERDICT_FAIL) return mix(FAILING, WORST, isnan(margin) ? 0.5 : -margin);
    return mix(PASSING, BEST, isnan(margin) ? 0.5 : margin);
}

static void put(const Picture *picture, int x, int y, Colour colour)
{
    memcpy(picture_pixel(picture, x, y), colour.srgb, sizeof colour.srgb);
}

/* ---- what maps and calendars share ------------------------------------------------------ */

/* A picture that fills the drawing's box of so many units. */
static bool add_cells(Text *html, const Picture *cells, Arena scratch, Error *err)
{
    FileBytes   bytes;
    PictureFile file = {.bits = 8, .is_srgb = true};
    if (!picture_encode("a.png", cells, file, &scratch, &bytes, err)) return false;
    text_format(html, "<svg class=\"cells\" viewBox=\"0 0 %d %d\" preserveAspectRatio=\"none\" "
                "aria-hidden=\"true\"><image width=\"%d\" height=\"%d\" "
                "preserveAspectRatio=\"none\" href=\"data:image/png;base64,", cells->width,
                cells->height, cells->width, cells->height);
    base64_encode(html, bytes.data, bytes.size);
    text_add(html, "\"/>");
    return true;
}

/* The numbers for the pointer (review.js), 16 bits a cell. */
static void add_values(Text *html, const unsigned char *codes, size_t cells)
{
    text_add(html, "\" data-values=\"");
    base64_encode(html, codes, 2 * cells);
    text_add(html, "\">");
}

static void set_code(unsigned char *codes, size_t i, unsigned code)
{
    codes[2 * i] = (unsigned char)(code & 255);
    codes[2 * i + 1] = (unsigned char)(code >> 8);
}

/* share: of the way along the axis, 0..1; from the left, or from the top. */
static void begin_tick(Text *html, const char *side, double share)
{
    const char *end = share < 0.04 ? " class=\"begin\"" : share > 0.96 ? " class=\"last\"" : "";
    text_format(html, "<span%s style=\"%s:%.2f%%\">", end, side, 100 * share);
}

static void add_tick(Text *html, const char *side, double share, const char *text)
{
    begin_tick(html, side, share);
    escape_markup(html, text);
    text_add(html, "</span>");
}

static void set_colour(json_t *to, const char *name, Colour colour)
{
    char code[8];
    snprintf(code, sizeof code, "#%02x%02x%02x", (int)(colour.srgb[0] * 255 + 0.5f),
             (int)(colour.srgb[1] * 255 + 0.5f), (int)(colour.srgb[2] * 255 + 0.5f));
    page_set(to, name, code);
}

static json_t *colours(void)
{
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

/* The drawing goes into a template (map.html, calendar.html) that names and explains it. A
 * sweep goes by the middle of an eye's box. */
static json_t *values_of(const Text *drawing, const ReviewSweep *sweep)
{
    json_t *to = json_object();
    json_object_set_new(to, "drawing", json_stringn(drawing->data, drawing->size));
    json_object_set_new(to, "colour", colours());
    page_set_flag(to, "of_box", sweep && sweep_has_box(sweep));
    return to;
}

/* ---- the map ---------------------------------------------------------------------------- */

static size_t map_index(const ReviewMap *map, int azimuth, int elevation)
{
    return (size_t)elevation * (size_t)map->azimuth_deg.count + (size_t)azimuth;
}

static bool has_answer(const ReviewMap *map, int azimuth, int elevation)
{
    return !isnan(map->contrast[map_index(map, azimuth, elevation)]);
}

/* Outside the map nothing fails. */
static bool fails_at(const ReviewMap *map, int azimuth, int elevation)
{
    bool is_inside = azimuth >= 0 && azimuth < map->azimuth_deg.count && elevation >= 0 &&
                     elevation < map->elevation_deg.count;
    return is_inside && has_answer(map, azimuth, elevation) &&
           map->verdict[map_index(map, azimuth, elevation)] == VERDICT_FAIL;
}

static Picture map_picture(const ReviewMap *map, Arena *arena)
{
    int     rows = map->elevation_deg.count;
    Picture out = picture_create(map->azimuth_deg.count, rows, arena);
    for (int e = 0; e < rows; e++)
        for (int a = 0; a < out.width; a++) {
            size_t i = map_index(map, a, e);
            put(&out, a, rows - 1 - e,
                has_answer(map, a, e)
                    ? colour_of((Verdict)map->verdict[i], (double)map->margin[i]) : NONE);
        }
    return out;
}

/* The border of what fails, along the edges of cells; runs of edges are one line. */
static void add_border(Text *html, const ReviewMap *map)
{
    int columns = map->azimuth_deg.count, rows = map->elevation_deg.count;
    text_add(html, "<path class=\"border\" d=\"");
    for (int e = 0; e <= rows; e++)
        for (int a = 0, from = 0; a <= columns; a++) {
            bool here = a < columns && fails_at(map, a, e) != fails_at(map, a, e - 1);
            bool before = a > 0 && fails_at(map, a - 1, e) != fails_at(map, a - 1, e - 1);
            if (here && !before) from = a;
            if (!here && before) text_format(html, "M%d %dH%d", from, rows - e, a);
        }
    for (int a = 0; a <= columns; a++)
        for (int e = 0, from = 0; e <= rows; e++) {
            bool here = e < rows && fails_at(map, a, e) != fails_at(map, a - 1, e);
            bool before = e > 0 && fails_at(map, a, e - 1) != fails_at(map, a - 1, e - 1);
            if (here && !before) from = e;
            if (!here && before) text_format(html, "M%d %dV%d", a, rows - from, rows - e);
        }
    text_add(html, "\"/>");
}

/* Where a cell's middle lies, in cells from the first edge. */
static double axis_place(const ReviewAxis *axis, double value)
{
    return (value - axis->first) / axis->step + 0.5;
}

/* An azimuth as the axis counts it: 350 on an axis from -180 is -10. */
static double axis_azimuth(const ReviewAxis *axis, double azimuth_deg)
{
    double low = axis->first - axis->step / 2;
    return low + 360 * ((azimuth_deg - low) / 360 - floor((azimuth_deg - low) / 360));
}

/* A path is lifted where it leaves the map on one side and comes back on the other. */
static void add_path(Text *html, const ReviewMap *map, const SunPath *path)
{
    double last = NAN;
    text_add(html, "<path class=\"sun\" d=\"");
    for (int i = 0; i < path->count; i++) {
        double azimuth = axis_azimuth(&map->azimuth_deg, path->azimuth_deg[i]);
        double x = axis_place(&map->azimuth_deg, azimuth);
        double y = map->elevation_deg.count -
                   axis_place(&map->elevation_deg, path->elevation_deg[i]);
        text_format(html, "%c%.2f %.2f", fabs(azimuth - last) < 180 ? 'L' : 'M', x, y);
        last = azimuth;
    }
    text_add(html, "\"/>");
}

/* Its name stands where the sun is highest. */
static void add_path_name(Text *html, const ReviewMap *map, const SunPath *path)
{
    int top = 0;
    for (int i = 1; i < path->count; i++)
        if (path->elevation_deg[i] > path->elevation_deg[top]) top = i;
    if (path->count == 0 || !path->name) return;
    double azimuth = axis_azimuth(&map->azimuth_deg, path->azimuth_deg[top]);
    double x = axis_place(&map->azimuth_deg, azimuth) / map->azimuth_deg.count;
    double y = axis_place(&map->elevation_deg, path->elevation_deg[top]) /
               map->elevation_deg.count;
    if (x < 0 || x > 1 || y < 0 || y > 1) return;
    text_format(html, "<span class=\"path\" style=\"left:%.2f%%;bottom:%.2f%%\">", 100 * x,
                100 * y);
    escape_markup(html, path->name);
    text_add(html, "</span>");
}

/* The degrees are left out where there is no room. */
static void add_azimuths(Text *html, const ReviewMap *map)
{
    static const char *const VEHICLE[4] = {"ahead", "right", "behind", "left"};
    static const char *const WORLD[4] = {"north", "east", "south", "west"};
    const ReviewAxis *axis = &map->azimuth_deg;
    text_add(html, "<div class=\"x\">");
    for (int quarter = -4; quarter <= 8; quarter++) {
        double share = axis_place(axis, 90.0 * quarter) / axis->count;
        if (share < 0 || share > 1) continue;
        begin_tick(html, "left", share);
        text_format(html, "<b>%d° </b>%s</span>", 90 * quarter,
                    (map->is_of_vehicle ? VEHICLE : WORLD)[(quarter + 4) % 4]);
    }
    text_add(html, "</div>");
}

static void add_elevations(Text *html, const ReviewMap *map, Arena *arena)
{
    const ReviewAxis *axis = &map->elevation_deg;
    double range = axis->step * axis->count;
    int    step = range > 50 ? 20 : range > 20 ? 10 : range > 8 ? 5 : 1;
    text_add(html, "<div class=\"y\">");
    for (int value = -90; value <= 90; value++) {
        double share = axis_place(axis, value) / axis->count;
        if (value % step == 0 && share >= 0 && share <= 1)
            add_tick(html, "top", 1 - share, arena_format(arena, "%d°", value));
    }
    text_add(html, "</div>");
}

#define GAP (-1) /* instead of a verdict */

static bool holds(const ReviewMap *map, int wanted)
{
    for (int e = 0; e < map->elevation_deg.count; e++)
        for (int a = 0; a < map->azimuth_deg.count; a++) {
            int here = has_answer(map, a, e) ? map->verdict[map_index(map, a, e)] : GAP;
            if (here == wanted) return true;
        }
    return false;
}

/* Contrast of 1 to 10,000 by its logarithm, within 0.06 %. */
static unsigned code_of(float contrast, unsigned verdict)
{
    double decades = contrast > 1 ? fmin(log10_d((double)contrast), 4) : 0;
    return isnan(contrast) ? 0 : verdict << 14 | (unsigned)(1.5 + 16382 * decades / 4);
}

/* Opens the map's area; the box is on which the pointer is read. */
static void begin_map(Text *html, const ReviewMap *map, Arena scratch)
{
    const ReviewAxis  *across = &map->azimuth_deg, *up = &map->elevation_deg;
    const char *const *words = words_directions(map->is_of_vehicle);
    size_t         cells = (size_t)across->count * (size_t)up->count;
    unsigned char *codes = ARENA_NEW(&scratch, unsigned char, 2 * cells);
    for (size_t i = 0; i < cells; i++)
        set_code(codes, i, code_of(map->contrast[i], map->verdict[i]));
    text_format(html, "<div class=\"chart\"><div class=\"area\" data-kind=\"map\" "
                "data-columns=\"%d\" data-rows=\"%d\" data-first=\"%.9g\" data-step=\"%.9g\" "
                "data-low=\"%.9g\" data-rise=\"%.9g\" data-words=\"", across->count, up->count,
                across->first, across->step, up->first, up->step);
    for (int i = 0; i < 8; i++) text_format(html, i ? "|%s" : "%s", words[i]);
    add_values(html, codes, cells);
}

json_t *review_map_values(const ReviewMap *map, Arena scratch, Error *err)
{
    Text    html = {.arena = &scratch};
    Arena   own = arena_reserve(DRAWING_BYTES);
    Picture cells = map_picture(map, &own);
    begin_map(&html, map, own);
    bool ok = add_cells(&html, &cells, own, err);
    add_border(&html, map);
    for (int i = 0; i < map->path_count; i++) add_path(&html, map, &map->paths[i]);
    text_add(&html, "</svg>");
    for (int i = 0; i < map->path_count; i++) add_path_name(&html, map, &map->paths[i]);
    text_add(&html, "</div>");
    add_elevations(&html, map, &own);
    add_azimuths(&html, map);
    text_add(&html, "</div>\n");
    arena_release(&own);
    json_t *to = ok ? values_of(&html, map->of) : NULL;
    json_t *holds_of = json_pack("{s:b, s:b, s:b}", "close", holds(map, VERDICT_TOO_CLOSE),
                                 "hidden", holds(map, VERDICT_UNJUDGED), "gap",
                                 holds(map, GAP));
    json_object_set_new(to, "holds", holds_of);
    page_set_flag(to, "is_of_vehicle", map->is_of_vehicle);
    page_set_flag(to, "is_between_steps", map->is_between_steps);
    page_set_flag(to, "has_paths", map->path_count > 0);
    return to;
}

/* ---- the calendar ----------------------------------------------------------------------- */

static float share_at(const ReviewCalendar *calendar, int day, int step)
{
    return calendar->failed_share[(size_t)day * (size_t)calendar->steps_a_day + (size_t)step];
}

static Picture calendar_picture(const ReviewCalendar *calendar, Arena *arena)
{
    int     rows = calendar->steps_a_day;
    Picture out = picture_create(calendar->days, rows, arena);
    for (int day = 0; day < calendar->days; day++)
        for (int step = 0; step < rows; step++) {
            float  share = share_at(calendar, day, step);
            Colour colour = isnan(share) ? NIGHT
                            : share > 0  ? mix(FAILING, WORST, (double)share) : PASSING;
            put(&out, day, rows - 1 - step, colour);
        }
    return out;
}

static void add_months(Text *html, const ReviewCalendar *calendar)
{
    static const char *const NAMES[12] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    int day = 0;
    text_add(html, "<div class=\"x months\">");
    for (int month = 0; month < 12; month++) {
        int length = calendar_days_of_month(calendar->year, month + 1);
        if (day + length / 2 < calendar->days)
            add_tick(html, "left", (day + length / 2.0) / calendar->days, NAMES[month]);
        day += length;
    }
    text_add(html, "</div>");
}

static void add_hours(Text *html, Arena *arena)
{
    text_add(html, "<div class=\"y\">");
    for (int hour = 0; hour <= 24; hour += 6)
        add_tick(html, "top", 1 - hour / 24.0, arena_format(arena, "%d h", hour));
    text_add(html, "</div>");
}

static void begin_calendar(Text *html, const ReviewCalendar *calendar, Arena scratch)
{
    size_t         days = (size_t)calendar->days, steps = (size_t)calendar->steps_a_day;
    unsigned char *codes = ARENA_NEW(&scratch, unsigned char, 2 * days * steps);
    for (size_t day = 0; day < days; day++)
        for (size_t step = 0; step < steps; step++) {
            float share = share_at(calendar, (int)day, (int)step);
            set_code(codes, step * days + day,
                     isnan(share) ? 0 : (unsigned)(1.5f + 10000 * share));
        }
    text_format(html, "<div class=\"chart\"><div class=\"area\" data-kind=\"calendar\" "
                "data-columns=\"%d\" data-rows=\"%d\" data-year=\"%d\" data-headings=\"%d\" "
                "data-clock=\"", calendar->days, calendar->steps_a_day, calendar->year,
                calendar->headings);
    escape_markup(html, calendar->clock);
    add_values(html, codes, days * steps);
}

json_t *review_calendar_values(const ReviewCalendar *calendar, Arena scratch, Error *err)
{
    Text    html = {.arena = &scratch};
    Arena   own = arena_reserve(DRAWING_BYTES);
    Picture cells = calendar_picture(calendar, &own);
    begin_calendar(&html, calendar, own);
    bool ok = add_cells(&html, &cells, own, err);
    text_add(&html, "</svg></div>");
    add_hours(&html, &own);
    add_months(&html, calendar);
    text_add(&html, "</div>\n");
    arena_release(&own);
    json_t *to = ok ? values_of(&html, calendar->of) : NULL;
    page_set_count(to, "year", calendar->year);
    page_set_count(to, "headings", calendar->headings);
    page_set_flag(to, "has_headings", calendar->headings > 1);
    page_set(to, "clock", calendar->clock);
    return to;
}
