/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_false_suns.h"

#include <math.h>

#include "page/page.h"
#include "review/output/review_words.h"

static void add_row(Text *html, const ReviewFalseSun *f, Arena *arena)
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

void review_false_suns_add(Text *html, const Review *review, Arena *arena)
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
    page_element(html, "p class=\"sub\"", "In a clear sky, asked minute by minute.");
    page_table_begin(html, "", "", COLUMNS, sizeof COLUMNS / sizeof *COLUMNS);
    for (int i = 0; i < review->false_sun_count; i++)
        add_row(html, &review->false_suns[i], arena);
    page_table_end(html);
    page_more_end(html);
}
