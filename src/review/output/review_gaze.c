/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_gaze.h"

#include <math.h>
#include <stdlib.h>

#include "page/page.h"
#include "review/output/review_words.h"

/* ---- the worst first --------------------------------------------------------------------- */

/* Unknown contrast (NaN) comes last; equal findings keep their order. */
static int by_contrast(const void *a, const void *b)
{
    const GazeFinding *x = *(const GazeFinding *const *)a, *y = *(const GazeFinding *const *)b;
    if (isnan(x->contrast_left) != isnan(y->contrast_left))
        return isnan(x->contrast_left) ? 1 : -1;
    if (x->contrast_left < y->contrast_left) return -1;
    if (x->contrast_left > y->contrast_left) return 1;
    return (x > y) - (x < y);
}

static const GazeFinding **ranked(const Review *review, Arena *arena)
{
    const GazeFinding **list = ARENA_NEW(arena, const GazeFinding *, review->gaze_count);
    for (int i = 0; i < review->gaze_count; i++) list[i] = &review->gazes[i];
    qsort(list, (size_t)review->gaze_count, sizeof *list, by_contrast);
    return list;
}

/* ---- words ------------------------------------------------------------------------------- */

static const char *of(const char *name)
{
    return name && name[0] ? name : "?";
}

/* Where most of the veil in the eye begins that takes of the contrast; "" without one. */
static const char *first_part(const GazeVeil *parts)
{
    static const char *const WORDS[] = {"the sun", "the sky", "lamps and displays",
                                        "glints", "lit surfaces"};
    const double value[] = {parts->sun, parts->sky, parts->lamps, parts->glints,
                            parts->surfaces};
    int most = 0;
    for (int i = 1; i < 5; i++)
        if (value[i] > value[most]) most = i;
    return value[most] > 0 ? WORDS[most] : "";
}

/* Light near the gaze is what the eye looks at, no veil. */
static double far_veil(const GazeFinding *g)
{
    return g->veil - g->veil_parts.near;
}

const char *review_gaze_mirrored(const GazeFinding *g, Arena *arena)
{
    return words_within(g->mirrored, g->mirrored_range.low, g->mirrored_range.high, arena);
}

const char *review_gaze_veil(const GazeFinding *g, Arena *arena)
{
    double near = g->veil_parts.near;
    return words_within(far_veil(g), g->veil_range.low - near, g->veil_range.high - near,
                        arena);
}

static const char *worst_words(const GazeFinding *g, Arena *arena)
{
    const char *place = arena_format(arena, "%s, looking at %s, %s", of(g->eye), of(g->gaze),
                                     of(g->condition));
    if (isnan(g->contrast_left))
        return arena_format(arena, "%s: no light: nothing is seen, or lost.", place);
    const char *glass =
        g->mirrored_by ? arena_format(arena, "%s mirrors %s over it with %s cd/m²",
                                      g->mirrored_by, of(g->mirrored_from),
                                      review_gaze_mirrored(g, arena))
                       : "no glass mirrors anything over it";
    return arena_format(arena, "Worst: %s. %s of a distant object's contrast is left: what is "
                               "seen there has %s cd/m², %s, and the eye lays %s cd/m² "
                               "over it.", place, words_share(g->contrast_left, arena),
                        words_figure(g->through, arena), glass,
                        review_gaze_veil(g, arena));
}

/* ---- the table --------------------------------------------------------------------------- */

static void add_small_cell(Text *html, const char *kind, const char *text, const char *small)
{
    text_format(html, "<td class=\"%s\">", kind);
    page_element(html, "div", text);
    if (small[0]) page_element(html, "small", small);
    text_add(html, "</td>");
}

static const char *share_range(const MeanInterval *range, Arena *arena)
{
    if (isnan(range->low) || isnan(range->high)) return "";
    return arena_format(arena, "%s to %s", words_share(range->low, arena),
                        words_share(range->high, arena));
}

static void add_names(Text *html, const GazeFinding *g, Arena *arena)
{
    const char *sun = isnan(g->sun_deg)
                          ? "no sun above the horizon"
                          : arena_format(arena, "sun %.0f° from the gaze", g->sun_deg);
    add_small_cell(html, "", of(g->gaze), of(g->eye));
    add_small_cell(html, "", of(g->condition), sun);
}

static void add_veils(Text *html, const GazeFinding *g, Arena *arena)
{
    const char *from = first_part(&g->veil_parts);
    page_cell(html, "n", review_gaze_mirrored(g, arena));
    if (g->mirrored_by) add_small_cell(html, "", g->mirrored_by, of(g->mirrored_from));
    else page_cell(html, "", "–");
    add_small_cell(html, "n", review_gaze_veil(g, arena),
                   from[0] ? arena_format(arena, "mostly %s", from) : "");
}

/* A line of the cell: a figure with its interval. */
static void add_figure(Text *html, const char *name, double value, MeanInterval range,
                       Arena *arena)
{
    if (isnan(value)) return;
    text_format(html, "<div>%s %s ", name, words_within(value, range.low, range.high, arena));
    if (range.low < range.high)
        page_element(html, "small", words_interval(range.low, range.high, arena));
    text_add(html, "</div>");
}

static void add_glare(Text *html, const CaseGlare *g, Arena *arena)
{
    const char *settings = g->threshold_cd_m2 > 0 ? words_glare_settings(g, arena) : "";
    text_add(html, "<td class=\"glare\">");
    add_figure(html, "DGP", g->dgp, g->dgp_range, arena);
    add_figure(html, "UGR", g->ugr, g->ugr_range, arena);
    add_figure(html, "DGI", g->dgi, g->dgi_range, arena);
    page_element(html, "small",
                 g->none ? arena_format(arena, "%s; %s", g->none, settings) : settings);
    text_add(html, "</td>");
}

static void add_row(Text *html, const GazeFinding *g, Arena *arena)
{
    page_row_begin(html, "");
    add_names(html, g, arena);
    add_small_cell(html, g->contrast_left < GAZE_POOR ? "n bad" : "n",
                   words_share(g->contrast_left, arena),
                   share_range(&g->contrast_range, arena));
    page_cell(html, "n", words_figure(g->through, arena));
    add_veils(html, g, arena);
    page_cell(html, "n", words_figure(g->cornea_lux, arena));
    add_glare(html, &g->glare, arena);
    page_row_end(html);
}

void review_gaze_add(Text *html, const Review *review, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Looking at", false, NULL}, {"Condition", false, NULL},
        {"Contrast left", true, "of a distant object, behind both veils; 95 % interval"},
        {"Seen, cd/m²", true, "what lies there, as it arrives through the glass"},
        {"Mirrored, cd/m²", true, "what the glass mirrors over it"},
        {"The glass, and what it shows", false, "most of what is mirrored"},
        {"Eye's veil, cd/m²", true,
         "light from more than 1° away that the eye scatters over it, and glare from nearer"},
        {"At the eye, lx", true, "light on the plane of the pupil"},
        {"DGP, UGR, DGI", false, "discomfort, made for rooms: secondary; 95 % intervals"}};
    if (review->gaze_count == 0) return;
    const GazeFinding **list = ranked(review, arena);
    page_element(html, "h2", "Looking elsewhere");
    page_element(html, "p", worst_words(list[0], arena));
    page_more_begin(html, arena_format(arena, "All of them, the least left first: %d",
                                       review->gaze_count));
    page_element(html, "p class=\"sub\"",
                 "Two veils lie over what an eye looks at: what the glass before it mirrors, "
                 "such as the top of the dashboard in the windscreen, and what the eye itself "
                 "scatters. Both brighten an object and its background alike, and so take of "
                 "its contrast. No limit is held against them.");
    page_table_begin(html, "", "list gazes", COLUMNS, 9);
    for (int i = 0; i < review->gaze_count; i++) add_row(html, list[i], arena);
    page_table_end(html);
    page_more_end(html);
}

/* ---- the sun in mirrors ------------------------------------------------------------------ */

static void add_false_sun(Text *html, const ReviewFalseSun *f, Arena *arena)
{
    const char *place = arena_format(arena, "%.0f°, %.0f° up", f->sun_azimuth_deg,
                                     f->sun_elevation_deg);
    page_row_begin(html, "");
    page_cell(html, "", f->mirror ? f->mirror : "?");
    page_cell(html, "", f->eye ? f->eye : "?");
    page_cell(html, "", f->condition ? f->condition : "?");
    page_cell(html, "n", isnan(f->minutes) ? words_share(f->share, arena)
                                           : words_minutes(f->minutes, arena));
    page_cell(html, "n", words_minutes(f->longest_minutes, arena));
    page_cell(html, "", f->when ? f->when : "–");
    page_cell(html, "", place);
    page_cell(html, "n", words_figure(f->lux, arena));
    page_cell(html, "", arena_format(arena, "%s° from %s", words_figure(f->angle_deg, arena),
                                     f->gaze ? f->gaze : "?"));
    page_cell(html, "n", words_figure(f->veil_cd_m2, arena));
    page_row_end(html);
}

void review_gaze_add_false_suns(Text *html, const Review *review, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Mirror", false, "node and material"}, {"Eye", false, NULL}, {"Light", false, NULL},
        {"Lasts", true, "all headings together; of a map of suns: the share of them"},
        {"At a stretch", true, "the longest"}, {"Worst", false, NULL},
        {"Sun", false, "azimuth of the vehicle: 0 ahead, 90 right"},
        {"lx at the eye", true, "on a plane that faces the image"}, {"Image", false, NULL},
        {"Veil, cd/m²", true, "that it lays over what the eye looks at"}};
    if (!review->false_sun_count) return;
    if (!review->gaze_count) page_element(html, "h2", "The sun in mirrors");
    page_more_begin(html, arena_format(arena, "Where glass, chrome and the fronts of displays "
                                              "throw the sun itself into an eye: %d",
                                       review->false_sun_count));
    page_element(html, "p class=\"sub\"", "In a clear sky, evaluated minute by minute.");
    page_table_begin(html, "", "", COLUMNS, sizeof COLUMNS / sizeof *COLUMNS);
    for (int i = 0; i < review->false_sun_count; i++)
        add_false_sun(html, &review->false_suns[i], arena);
    page_table_end(html);
    page_more_end(html);
}
