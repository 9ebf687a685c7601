/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_road.h"

#include <math.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_words.h"
#include "text/interval_text.h"
#include "text/text.h"

/* ---- which age --------------------------------------------------------------------------- */

/* That decides; without a limit the oldest, whose increment is the greatest; NULL: none is
 * known. */
static const RoadAge *shown_age(const GazeFinding *g) {
    const RoadAge *age = gaze_worst_age(g);
    return age || !g->road->age_count ? age : &g->road->ages[g->road->age_count - 1];
}

/* ---- words ------------------------------------------------------------------------------- */

const char *road_outcome(const GazeFinding *gaze) {
    if (gaze->road->left_out) return "not evaluated";
    const RoadAge *age = gaze_worst_age(gaze);
    return age ? verdict_names[age->limit.verdict] : "no limit";
}

static const char *road_name(const GazeFinding *gaze, Arena *arena) {
    return words_named(gaze->gaze, gaze->eye, gaze->condition, arena);
}

/* "all straight", "72 % by windscreen (glass)": by which way most of it comes. */
static const char *way_words(const RoadDisplay *d, Arena *arena) {
    if (isnan(d->straight_share)) return "";
    if (d->straight_share >= 0.5)
        return arena_format(arena, ", %s straight",
                            d->straight_share > 0.995 ? "all"
                                                      : words_share(d->straight_share, arena));
    if (d->mirrored_share >= d->scattered_share && d->mirrored_by)
        return arena_format(arena, ", %s by %s", words_share(d->mirrored_by_share, arena),
                            d->mirrored_by);
    return arena_format(arena, ", %s by surfaces that it lights",
                        words_share(d->scattered_share, arena));
}

/* What the displays make, and which of them most. */
static const char *displays_words(const RoadAge *age, Arena *arena) {
    double share = 0;
    for (int i = 0; i < age->display_count; i++) share += age->displays[i].share;
    if (!age->display_count) return "; no display makes any of it";
    const RoadDisplay *d = &age->displays[0];
    const char *all = age->display_count == 1 ? ""
                                              : arena_format(arena, "displays make %s of it, ",
                                                             words_share(fmin(share, 1), arena));
    return arena_format(arena, "; %s%s %s%s", all, d->display,
                        words_share(fmin(d->share, 1), arena), way_words(d, arena));
}

static const char *unjudged_because(const GazeFinding *gaze, Arena *arena) {
    const GazeRoad *road = gaze->road;
    if (gaze->unjudged == UNJUDGED_DATA)
        return arena_format(arena,
                            "cannot be judged: %s of the veil came via materials "
                            "without optical data; ",
                            words_share(road->without_data_share, arena));
    if (gaze->unjudged == UNJUDGED_PANEL)
        return "cannot be judged: the panel of a display that makes more than a tenth of the "
               "veil says of itself that it is not usable; ";
    return "";
}

const char *road_words(const GazeFinding *gaze, Arena *arena) {
    const GazeRoad *road = gaze->road;
    if (road->left_out)
        return arena_format(arena, "threshold increment not evaluated: %s",
                            road_left_outs[road->left_out]);
    const RoadAge *age = shown_age(gaze);
    LimitVerdict as = age->limit;
    as.unit = "%";
    as.age_years = 0; /* told behind it */
    as.found = age->increment_pct;
    as.low = age->increment_range.low;
    as.high = age->increment_range.high;
    const char *bound = age->limit.name ? words_bound(&as, arena) : "no limit in this profile";
    return arena_format(
        arena,
        "%s%sthreshold increment %s (%s), at %.4g years on a road of %.4g cd/m2 (veil by CIE 135: "
        "%.3g %%)%s",
        unjudged_because(gaze, arena),
        road->is_after_dark ? "after dark, without sun and sky: " : "", words_measured(&as, arena),
        bound, age->age_years, road->luminance_cd_m2, age->increment_by_spread_pct,
        displays_words(age, arena));
}

/* ---- windows ----------------------------------------------------------------------------- */

static const char *percent(double level, Arena *arena) {
    if (isnan(level)) return "–";
    if (level > 1) return "100 %"; /* all that it has */
    if (level > 0 && level < 1e-5) return "less than 0.001 %";
    return arena_format(arena, "%.3g %%", 100 * level);
}

static bool is_of(const RoadDimming *row, const char *display) {
    return !row->display == !display && words_same(row->display, display);
}

/* ---- values ------------------------------------------------------------------------------ */

static json_t *new_list(json_t *to, const char *name) {
    json_t *list = json_array();
    json_object_set_new(to, name, list);
    return list;
}

static const char *around(double low, double high, const char *unit, Arena *arena) {
    return low < high ? arena_format(arena, "%s%s", words_interval(low, high, arena), unit) : NULL;
}

static void set_age(json_t *to, const RoadAge *age, bool has_limit, Arena *arena) {
    const MeanInterval *range = &age->increment_range;
    json_t *displays = new_list(to, "displays");
    page_set(to, "age", arena_format(arena, "%.4g", age->age_years));
    page_set(to, "increment", words_within(age->increment_pct, range->low, range->high, arena));
    page_set(to, "range", around(range->low, range->high, " %", arena));
    page_set(to, "veil", words_within(age->veil, age->veil_range.low, age->veil_range.high, arena));
    page_set(to, "by_cie_135", words_figure(age->increment_by_spread_pct, arena));
    page_set(to, "class", has_limit ? words_class(age->limit.verdict) : "");
    page_set(to, "mark", has_limit ? words_mark(age->limit.verdict) : "");
    page_set(to, "margin", has_limit ? words_from_limit(&age->limit, arena) : "");
    for (int i = 0; i < age->display_count; i++) {
        const RoadDisplay *d = &age->displays[i];
        json_t *row = page_add(displays);
        page_set(row, "name", d->display);
        page_set(row, "level", percent(d->level, arena));
        page_set(row, "share", words_share(d->share, arena));
        page_set(
            row, "increment",
            words_within(d->increment_pct, d->increment_range.low, d->increment_range.high, arena));
        page_set(row, "straight", words_share(d->straight_share, arena));
        page_set(row, "mirrored", words_share(d->mirrored_share, arena));
        page_set(row, "mirrored_by", d->mirrored_by);
        page_set(row, "scattered", words_share(d->scattered_share, arena));
        page_set(row, "level_most",
                 isnan(d->level_most) ? NULL
                 : d->level_most > 0  ? percent(d->level_most, arena)
                                      : "none, even dark");
    }
}

static void set_row(json_t *to, const RoadDimming *row, Arena *arena) {
    const char *most = row->level_most > 0 ? percent(row->level_most, arena) : "none, even dark";
    page_set(to, "age", arena_format(arena, "%.4g", row->age_years));
    page_set(to, "road", arena_format(arena, "%.4g", row->road_cd_m2));
    page_set(to, "most", isnan(row->level_most) ? "–" : most);
    page_set(to, "most_range",
             row->level_most_range.high < 1 ? around(100 * row->level_most_range.low,
                                                     100 * row->level_most_range.high, " %", arena)
                                            : NULL);
    page_set(to, "window", row->window ? road_windows[row->window] : "–");
    page_set(to, "class",
             row->window == ROAD_WINDOW_EMPTY   ? "bad"
             : row->window == ROAD_WINDOW_CLOSE ? "close"
                                                : "");
}

static void set_least(json_t *to, const RoadDimming *first, Arena *arena) {
    double sure = first->level_least_sure;
    page_set(to, "display", first->display ? first->display : "all displays by one factor");
    page_set(to, "level", percent(first->level, arena));
    page_set(to, "symbol", first->symbol);
    page_set(to, "least",
             isnan(sure)   ? NULL
             : isinf(sure) ? "above what it has"
             : !(sure > 0) ? "none"
                           : percent(sure, arena));
}

static void add_dimming(json_t *to, const GazeRoad *road, Arena *arena) {
    json_t *list = new_list(to, "dimmed");
    for (int i = 0; i < road->dimming_count; i++) {
        const RoadDimming *first = &road->dimming[i];
        bool is_first = true;
        for (int k = 0; k < i; k++) is_first &= !is_of(&road->dimming[k], first->display);
        if (!is_first) continue;
        json_t *of = page_add(list), *rows = new_list(of, "rows");
        set_least(of, first, arena);
        for (int k = i; k < road->dimming_count; k++)
            if (is_of(&road->dimming[k], first->display))
                set_row(page_add(rows), &road->dimming[k], arena);
    }
}

static void add_road(json_t *list, const GazeFinding *gaze, Arena *arena) {
    const GazeRoad *road = gaze->road;
    json_t *to = page_add(list), *ages = new_list(to, "ages");
    page_set(to, "name", road_name(gaze, arena));
    page_set(to, "words", road_words(gaze, arena));
    page_set(to, "outcome", road_outcome(gaze));
    page_set(to, "class", road_has_limit(road) ? words_class(gaze->verdict) : "");
    page_set(to, "road", arena_format(arena, "%.4g", road->luminance_cd_m2));
    page_set(to, "s_p", isnan(road->s_p) ? NULL : arena_format(arena, "%.4g", road->s_p));
    page_set(to, "mesopic",
             isnan(road->mesopic_cd_m2) ? NULL : arena_format(arena, "%.4g", road->mesopic_cd_m2));
    page_set_flag(to, "is_evaluated", !road->left_out);
    page_set_flag(to, "has_limit", road_has_limit(road));
    if (road->age_count) page_set(to, "limit", words_number(road->ages[0].limit.value, arena));
    for (int i = 0; i < road->age_count; i++)
        set_age(page_add(ages), &road->ages[i], road_has_limit(road), arena);
    add_dimming(to, road, arena);
}

void road_add_values(json_t *document, const Review *review, Arena *arena) {
    json_t *roads = new_list(document, "roads");
    for (int i = 0; i < review->gaze_count; i++)
        if (review->gazes[i].road) add_road(roads, &review->gazes[i], arena);
}
