/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_csv.h"

#include <math.h>
#include <string.h>

#include "review/review_decide.h"
#include "text/text.h"

/* ---- cells ------------------------------------------------------------------------------- */

/* RFC 4180: a cell with a comma or a quote stands in quotes, quotes doubled. No text has a
 * line's end as it may be shown. */
static void add_text(Text *csv, const char *text)
{
    bool quoted = text && strpbrk(text, ",\"");
    if (quoted) text_add(csv, "\"");
    for (size_t plain; text && *text; text += plain) {
        plain = strcspn(text, "\"");
        text_add_printable(csv, text, plain);
        if (text[plain]) text_add(csv, "\"\"");
        plain += text[plain] != '\0';
    }
    if (quoted) text_add(csv, "\"");
    text_add(csv, ",");
}

static void add_texts(Text *csv, const char *const *texts, int count)
{
    for (int i = 0; i < count; i++) add_text(csv, texts[i]);
}

static void add_number(Text *csv, double value)
{
    if (isfinite(value)) text_format(csv, "%.6g", value);
    text_add(csv, ",");
}

static void add_numbers(Text *csv, const double *values, int count)
{
    for (int i = 0; i < count; i++) add_number(csv, values[i]);
}

/* ---- cases ------------------------------------------------------------------------------- */

/* Of both tables. */
#define GLARE_COLUMNS                                                                          \
    "dgp_low,dgp_high,ugr_low,ugr_high,dgi,dgi_low,dgi_high,glare_threshold_cd_m2,"           \
    "glare_background_cd_m2,glare_sources,glare_sources_lx,no_ugr_because,smallest_source_sr"

static void add_glare(Text *csv, const CaseGlare *g)
{
    add_numbers(csv, (double[]){g->dgp_range.low, g->dgp_range.high, g->ugr_range.low,
                                g->ugr_range.high, g->dgi, g->dgi_range.low, g->dgi_range.high,
                                g->threshold_cd_m2, g->background_cd_m2,
                                (double)g->source_count, g->source_lx}, 11);
    add_text(csv, g->none);
    if (isfinite(g->smallest_sr)) text_format(csv, "%.6g", g->smallest_sr);
}

static const char HEADER[] =
    "condition,eye,symbol,display,ambient,sun_azimuth_deg,sun_elevation_deg,foreground_cd_m2,"
    "background_cd_m2,reflected_cd_m2,mirror_cd_m2,scattered_cd_m2,veil_cd_m2,contrast_ratio,"
    "contrast_low,contrast_high,contrast_with_veil,height_arcmin,jnd,visible_share,level,"
    "display_lx,visibility,dgp,ugr,eye_failed_share,limit_name,limit_kind,limit_unit,"
    "limit_source,limit_value,margin,first_cause,first_cause_share,verdict,"
    "reflected_low_cd_m2,reflected_high_cd_m2,hidden_by,hidden_by_share," GLARE_COLUMNS
    ",limit_found,limit_low,limit_high,limit_bound,stroke_ratio,reason,mean_reflected_cd_m2,"
    "mean_contrast_ratio,lit_share\r\n";

static void add_limit(Text *csv, const ReviewCase *c)
{
    static const LimitVerdict NONE = {.value = NAN, .margin = NAN};
    const LimitVerdict *worst = case_worst_limit(c), *limit = worst ? worst : &NONE;
    add_texts(csv, (const char *const[]){limit->name, limit->kind, limit->unit, limit->source},
              4);
    add_number(csv, limit->value);
    add_number(csv, limit->margin);
}

/* What was found for that limit, and why there is no verdict. */
static void add_found(Text *csv, const ReviewCase *c)
{
    static const LimitVerdict NONE = {.found = NAN, .low = NAN, .high = NAN};
    const LimitVerdict *worst = case_worst_limit(c), *limit = worst ? worst : &NONE;
    add_numbers(csv, (double[]){limit->found, limit->low, limit->high}, 3);
    add_text(csv, !worst ? NULL : worst->is_upper ? "most" : "least");
    add_number(csv, c->stroke_ratio);
    add_text(csv, c->unjudged ? unjudged_names[c->unjudged] : NULL);
}

/* The chain's links, joined by " > ". */
static void add_cause(Text *csv, const ReviewCase *c, Arena scratch)
{
    Text chain = {.arena = &scratch};
    for (int i = 0; c->cause_count > 0 && i < c->causes[0].links; i++) {
        if (i > 0) text_add(&chain, " > ");
        text_add(&chain, c->causes[0].chain[i]);
    }
    add_text(csv, chain.data);
    add_number(csv, c->cause_count > 0 ? c->causes[0].share : NAN);
}

static void add_case(Text *csv, const ReviewCase *c, Arena scratch)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    add_texts(csv, (const char *const[]){c->condition, c->eye, c->symbol, c->display,
                                         ambient_names[c->ambient]}, 5);
    add_number(csv, c->has_sun ? c->sun_azimuth_deg : NAN);
    add_number(csv, c->has_sun ? c->sun_elevation_deg : NAN);
    add_numbers(csv, (double[]){l->foreground, l->background, l->reflected, l->mirror,
                                l->scattered, l->veil}, 6);
    add_numbers(csv, (double[]){c->contrast_ratio, c->contrast_low, c->contrast_high,
                                c->contrast_with_veil, c->height_arcmin, c->jnd,
                                c->visible_share, c->level, c->display_lux, c->visibility,
                                c->glare.dgp, c->glare.ugr, c->eye_failed_share}, 13);
    add_limit(csv, c);
    add_cause(csv, c, scratch);
    add_text(csv, verdict_names[c->verdict]);
    add_number(csv, c->reflected_range.low);
    add_number(csv, c->reflected_range.high);
    add_text(csv, c->hider_count ? c->hiders[0].what : NULL);
    add_number(csv, c->hider_count ? c->hiders[0].share : NAN);
    add_glare(csv, &c->glare);
    text_add(csv, ",");
    add_found(csv, c);
    add_number(csv, c->whole.reflected);
    add_number(csv, c->whole.contrast_ratio);
    if (isfinite(c->whole.lit_share)) text_format(csv, "%.6g", c->whole.lit_share);
    text_add(csv, "\r\n");
}

typedef void AddRows(Text *csv, const Review *review, Arena scratch);

static bool write_table(const Review *review, const char *header, AddRows *add,
                        const char *path, Error *err)
{
    Arena arena = arena_reserve((size_t)1 << 30), scratch = arena_reserve((size_t)1 << 24);
    Text  csv = {.arena = &arena};
    text_add(&csv, header);
    add(&csv, review, scratch);
    bool ok = text_write(&csv, path, err);
    arena_release(&scratch);
    arena_release(&arena);
    return ok;
}

static void add_cases(Text *csv, const Review *review, Arena scratch)
{
    for (int i = 0; i < review->case_count; i++) add_case(csv, &review->cases[i], scratch);
}

bool review_csv_write(const Review *review, const char *path, Error *err)
{
    return write_table(review, HEADER, add_cases, path, err);
}

/* ---- false suns -------------------------------------------------------------------------- */

static const char FALSE_SUNS_HEADER[] =
    "condition,eye,mirror,share,minutes,longest_minutes,when,vehicle_azimuth_deg,"
    "sun_elevation_deg,eye_lx,gaze,angle_deg,veil_cd_m2\r\n";

static void add_false_sun(Text *csv, const ReviewFalseSun *f)
{
    add_texts(csv, (const char *const[]){f->condition, f->eye, f->mirror}, 3);
    add_numbers(csv, (double[]){f->share, f->minutes, f->longest_minutes}, 3);
    add_text(csv, f->when);
    add_numbers(csv, (double[]){f->sun_azimuth_deg, f->sun_elevation_deg, f->lux}, 3);
    add_text(csv, f->gaze);
    add_number(csv, f->angle_deg);
    text_format(csv, "%.6g\r\n", f->veil_cd_m2);
}

static void add_false_suns(Text *csv, const Review *review, Arena scratch)
{
    (void)scratch;
    for (int i = 0; i < review->false_sun_count; i++)
        add_false_sun(csv, &review->false_suns[i]);
}

bool review_csv_write_false_suns(const Review *review, const char *path, Error *err)
{
    return write_table(review, FALSE_SUNS_HEADER, add_false_suns, path, err);
}

/* ---- gazes ------------------------------------------------------------------------------- */

static const char GAZE_HEADER[] =
    "condition,eye,gaze,sun_from_gaze_deg,veil_cd_m2,veil_low,veil_high,veil_sun_cd_m2,"
    "veil_sky_cd_m2,veil_lamps_cd_m2,veil_glints_cd_m2,veil_surfaces_cd_m2,veil_near_cd_m2,"
    "cornea_lx,through_cd_m2,mirrored_cd_m2,mirrored_low,mirrored_high,mirrored_by,"
    "mirrored_from,contrast_behind_glass,contrast_low,contrast_high,dgp,ugr,contrast_left,"
    GLARE_COLUMNS "\r\n";

static void add_gaze(Text *csv, const GazeFinding *g)
{
    const GazeVeil *v = &g->veil_parts;
    add_texts(csv, (const char *const[]){g->condition, g->eye, g->gaze}, 3);
    add_numbers(csv, (double[]){g->sun_deg, g->veil, g->veil_range.low, g->veil_range.high,
                                v->sun, v->sky, v->lamps, v->glints, v->surfaces, v->near,
                                g->cornea_lux, g->through, g->mirrored, g->mirrored_range.low,
                                g->mirrored_range.high}, 15);
    add_texts(csv, (const char *const[]){g->mirrored_by, g->mirrored_from}, 2);
    add_numbers(csv, (double[]){g->contrast_behind_glass, g->contrast_range.low,
                                g->contrast_range.high, g->glare.dgp, g->glare.ugr,
                                g->contrast_left}, 6);
    add_glare(csv, &g->glare);
    text_add(csv, "\r\n");
}

static void add_gazes(Text *csv, const Review *review, Arena scratch)
{
    (void)scratch;
    for (int i = 0; i < review->gaze_count; i++) add_gaze(csv, &review->gazes[i]);
}

bool review_csv_write_gazes(const Review *review, const char *path, Error *err)
{
    return write_table(review, GAZE_HEADER, add_gazes, path, err);
}
