/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_json.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "review/output/case_json.h"
#include "review/output/json_rows.h"
#include "review/finding.h"
#include "review/output/review_facts.h"
#include "review/output/review_privacy.h"
#include "review/output/review_diff.h"
#include "review/pane_verdict.h"
#include "review/review_decide.h"
#include "review/road_verdict.h"
#include "text/json_text.h"

#define DIGITS 6
#define DOCUMENT_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */
#define PLACES_BYTES ((size_t)1 << 26)

/* ---- which keys hold which members ------------------------------------------------------- */

FOLLOWS(ReviewFalseSun, sun_elevation_deg, sun_azimuth_deg);

TABLE(sweep_json, ReviewSweep, OWN(TEXT, ReviewSweep, condition), OWN(TEXT, ReviewSweep, eye),
      OWN(TEXT, ReviewSweep, symbol),
      AS_VERDICT("verdict", RECORD_WRITTEN, ReviewSweep, worst.verdict),
      OWN(COUNT, ReviewSweep, cases), OWN(FIGURE, ReviewSweep, failed_share),
      OWN(FIGURE, ReviewSweep, longest_failure_minutes),
      LATER("failed_minutes", FIGURE, ReviewSweep, failed_minutes),
      LATER("headings", TEXT, ReviewSweep, headings),
      LATER("middle_eye_contrast_ratio", FIGURE, ReviewSweep, middle_contrast),
      PART("worst", MUST, ReviewSweep, worst, case_json), OWN(TEXT, ReviewSweep, table));

TABLE(veil_json, GazeVeil, OWN(FIGURE, GazeVeil, sun), OWN(FIGURE, GazeVeil, sky),
      OWN(FIGURE, GazeVeil, lamps), OWN(FIGURE, GazeVeil, glints), OWN(FIGURE, GazeVeil, surfaces),
      OWN(FIGURE, GazeVeil, near));

TABLE(road_display_json, RoadDisplay, OWN(TEXT, RoadDisplay, display),
      OWN(FIGURE, RoadDisplay, level), AS("veil_share", FIGURE, RoadDisplay, share),
      AS("threshold_increment_pct", FIGURE, RoadDisplay, increment_pct),
      AS("threshold_increment_interval", RANGE, RoadDisplay, increment_range),
      OWN(FIGURE, RoadDisplay, straight_share), OWN(FIGURE, RoadDisplay, mirrored_share),
      OWN(FIGURE, RoadDisplay, scattered_share), OWN(TEXT, RoadDisplay, mirrored_by),
      OWN(FIGURE, RoadDisplay, mirrored_by_share), OWN(FIGURE, RoadDisplay, level_most),
      AS("level_most_interval", RANGE, RoadDisplay, level_most_range));

TABLE(road_age_json, RoadAge, OWN(FIGURE, RoadAge, age_years),
      AS("veil_cd_m2", FIGURE, RoadAge, veil), AS("veil_interval", RANGE, RoadAge, veil_range),
      AS("threshold_increment_pct", FIGURE, RoadAge, increment_pct),
      AS("threshold_increment_interval", RANGE, RoadAge, increment_range),
      AS("threshold_increment_by_cie_135_pct", FIGURE, RoadAge, increment_by_spread_pct),
      PART("limit", MUST, RoadAge, limit, limit_json),
      LIST("displays", MUST, RoadAge, displays, display_count, road_display_json));

TABLE(road_dimming_json, RoadDimming, OWN(TEXT, RoadDimming, display),
      OWN(FIGURE, RoadDimming, age_years), OWN(FIGURE, RoadDimming, road_cd_m2),
      OWN(FIGURE, RoadDimming, level), OWN(FIGURE, RoadDimming, level_most),
      AS("level_most_interval", RANGE, RoadDimming, level_most_range),
      OWN(FIGURE, RoadDimming, level_least), OWN(FIGURE, RoadDimming, level_least_sure),
      OWN(TEXT, RoadDimming, symbol),
      AS_WORD("window", MUST | RECORD_NULL, RoadDimming, window, road_windows + 1));

TABLE(road_json, GazeRoad, OWN(FIGURE, GazeRoad, luminance_cd_m2), OWN(FIGURE, GazeRoad, s_p),
      OWN(FIGURE, GazeRoad, mesopic_cd_m2),
      AS_WORD("not_evaluated_because", MUST | RECORD_NULL, GazeRoad, left_out, road_left_outs + 1),
      AS("after_dark", FLAG, GazeRoad, is_after_dark), OWN(FIGURE, GazeRoad, without_data_share),
      LIST("ages", MUST, GazeRoad, ages, age_count, road_age_json),
      LIST("dimming", MUST, GazeRoad, dimming, dimming_count, road_dimming_json));

TABLE(gaze_json, GazeFinding, OWN(TEXT, GazeFinding, condition), OWN(TEXT, GazeFinding, eye),
      OWN(TEXT, GazeFinding, gaze), AS("sun_from_gaze_deg", FIGURE, GazeFinding, sun_deg),
      AS("veil_cd_m2", FIGURE, GazeFinding, veil),
      AS("veil_interval", RANGE, GazeFinding, veil_range),
      PART("veil_parts_cd_m2", MUST, GazeFinding, veil_parts, veil_json),
      AS("cornea_lx", FIGURE, GazeFinding, cornea_lux),
      AS("through_cd_m2", FIGURE, GazeFinding, through),
      AS("mirrored_cd_m2", FIGURE, GazeFinding, mirrored),
      AS("mirrored_interval", RANGE, GazeFinding, mirrored_range),
      OWN(TEXT, GazeFinding, mirrored_by), OWN(TEXT, GazeFinding, mirrored_from),
      OWN(FIGURE, GazeFinding, contrast_behind_glass), OWN(FIGURE, GazeFinding, contrast_left),
      AS("contrast_interval", RANGE, GazeFinding, contrast_range),
      {"road", RECORD_OBJECT, RECORD_APART | RECORD_BRIEF, RECORD_AT(GazeFinding, road),
       .of = &road_json},
      LIST("limits", RECORD_BRIEF, GazeFinding, limits, limit_count, limit_json),
      LATER("verdict", VERDICT, GazeFinding, verdict),
      LATER("reason", REASON, GazeFinding, unjudged));

TABLE(response_json, ReviewResponse, OWN(TEXT, ReviewResponse, probe),
      OWN(TEXT, ReviewResponse, file), OWN(COUNT, ReviewResponse, paths),
      OWN(COUNT, ReviewResponse, bytes), OWN(FIGURE, ReviewResponse, relative_error));

TABLE(false_sun_json, ReviewFalseSun, OWN(TEXT, ReviewFalseSun, condition),
      OWN(TEXT, ReviewFalseSun, eye), OWN(TEXT, ReviewFalseSun, mirror),
      OWN(FIGURE, ReviewFalseSun, share), OWN(FIGURE, ReviewFalseSun, minutes),
      OWN(FIGURE, ReviewFalseSun, longest_minutes), OWN(TEXT, ReviewFalseSun, when),
      PART("sun", MUST, ReviewFalseSun, sun_azimuth_deg, sun_json),
      OWN(FIGURE, ReviewFalseSun, lux), OWN(TEXT, ReviewFalseSun, gaze),
      OWN(FIGURE, ReviewFalseSun, angle_deg), OWN(FIGURE, ReviewFalseSun, veil_cd_m2),
      LIST("limits", RECORD_BRIEF, ReviewFalseSun, limits, limit_count, limit_json),
      LATER("verdict", VERDICT, ReviewFalseSun, verdict));

TABLE(pane_image_json, PaneFinding, OWN(TEXT, PaneFinding, condition), OWN(TEXT, PaneFinding, eye),
      OWN(TEXT, PaneFinding, display), OWN(TEXT, PaneFinding, pane),
      AS("no_image_because", TEXT, PaneFinding, none), OWN(FIGURE, PaneFinding, shown_share),
      AS("pane_ends_share", FIGURE, PaneFinding, ends_share),
      AS("turned_away_share", FIGURE, PaneFinding, away_share),
      OWN(FIGURE, PaneFinding, covered_share), OWN(TEXT, PaneFinding, covered_by),
      OWN(FIGURE, PaneFinding, right_deg), OWN(FIGURE, PaneFinding, up_deg),
      OWN(FIGURE, PaneFinding, width_deg), OWN(FIGURE, PaneFinding, height_deg),
      {"outline_deg", RECORD_FIGURES, MUST, RECORD_MANY(PaneFinding, outline_deg, outline_count),
       RECORD_RANGE(-HUGE_VAL, HUGE_VAL)},
      AS("image_cd_m2", FIGURE, PaneFinding, image),
      AS("image_interval", RANGE, PaneFinding, image_range),
      AS("behind_cd_m2", FIGURE, PaneFinding, behind),
      AS("behind_interval", RANGE, PaneFinding, behind_range),
      AS("against_cd_m2", FIGURE, PaneFinding, against),
      AS("against_interval", RANGE, PaneFinding, against_range), OWN(FIGURE, PaneFinding, contrast),
      AS("contrast_interval", RANGE, PaneFinding, contrast_range),
      OWN(FIGURE, PaneFinding, ghost_share), OWN(FIGURE, PaneFinding, ghost_arcmin),
      OWN(TEXT, PaneFinding, area), OWN(FIGURE, PaneFinding, off_deg),
      {"limit", RECORD_OBJECT, MUST | RECORD_NULL, RECORD_AT(PaneFinding, limit),
       .count = offsetof(PaneFinding, has_limit), .of = &limit_json},
      LIST("breaks", RECORD_BRIEF, PaneFinding, breaks, break_count, break_json),
      KEPT("corners", POINTS, PaneFinding, corners, corner_count));

TABLE(rest_json, ReviewRest,
      {"kind", RECORD_CHOICE, MUST, RECORD_AT(ReviewRest, kind), .words = rest_kinds},
      {"basis", RECORD_CHOICE, MUST, RECORD_AT(ReviewRest, basis), .words = rest_bases},
      OWN(TEXT, ReviewRest, name), OWN(TEXT, ReviewRest, words), OWN(COUNT, ReviewRest, count),
      OWN(COUNT, ReviewRest, of));

TABLE(files_json, ReviewFile, OWN(TEXT, ReviewFile, path),
      LATER("sha256", TEXT, ReviewFile, sha256), KEPT("xxh3", TEXT, ReviewFile, xxh3));

TABLE(document_json, ReviewDocument, OWN(TEXT, ReviewDocument, number),
      OWN(TEXT, ReviewDocument, revision), OWN(TEXT, ReviewDocument, date),
      OWN(TEXT, ReviewDocument, author));

/* ---- variants ---------------------------------------------------------------------------- */

static json_t *pair(double low, double high) {
    return json_pack("[o,o]", json_figure(low), json_figure(high));
}

static json_t *text(const char *string) {
    return string ? json_text(string) : json_null();
}

static void set(json_t *object, const char *key, json_t *value) {
    json_object_set_new(object, key, value);
}

static json_t *difference_json(const ReviewDifference *d) {
    static const char *const FIRST[] = {
        "condition",         "eye",    "symbol", "verdict", "contrast_ratio",
        "contrast_interval", "margin", NULL};
    static const char *const LAST[] = {"judged_part_uv", "level", "when", "sun", NULL};
    json_t *out = json_object();
    case_members_json(d->after, FIRST, out);
    set(out, "margin_before", json_figure(d->before ? d->before->margin : (double)NAN));
    set(out, "margin_difference", json_figure(d->margin));
    set(out, "margin_difference_interval", pair(d->margin_range.low, d->margin_range.high));
    set(out, "reflected_cd_m2", json_figure(d->after->luminance_cd_m2.reflected));
    set(out, "alike_within", json_figure(d->after->alike_within));
    set(out, "other_part", json_boolean(d->is_other_part));
    case_members_json(d->after, LAST, out);
    if (!d->sweep_after) return out;
    const ReviewSweep *before = d->sweep_before;
    set(out, "failed_share", json_figure(d->sweep_after->failed_share));
    set(out, "failed_share_before", json_figure(before ? before->failed_share : (double)NAN));
    set(out, "longest_failure_minutes", json_figure(d->sweep_after->longest_failure_minutes));
    return out;
}

static json_t *variant_json(const Review *review, const ReviewVariantFound *v) {
    json_t *out = json_pack("{s:o, s:o, s:b, s:s}", "name", text(v->name), "changes",
                            json_texts(v->words, v->word_count), "pass", v->review->pass, "verdict",
                            verdict_names[review_verdict(v->review)]);
    json_t *cases = json_array(), *sweeps = json_array();
    set(out, "worst", v->worst.after ? difference_json(&v->worst) : json_null());
    for (int i = 0; i < v->difference_count; i++)
        json_array_append_new(v->differences[i].sweep_after ? sweeps : cases,
                              difference_json(&v->differences[i]));
    set(out, "cases", cases);
    set(out, "sweeps", sweeps);
    Arena scratch = arena_reserve(DOCUMENT_BYTES);
    int count;
    const FindingDiff *beside = review_diff_beside(review, v->review, &count, &scratch);
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, finding_diff_json(&beside[i]));
    set(out, "findings", list);
    arena_release(&scratch);
    if (v->frame)
        set(out, "frames",
            json_pack("{s:o, s:o}", "before", text(v->frame_before), "after", text(v->frame)));
    return out;
}

/* ---- what is stated of the whole --------------------------------------------------------- */

static json_t *write_variants(const void *item) {
    const Review *review = item;
    json_t *variants = json_array();
    for (int i = 0; i < review->variant_count; i++)
        json_array_append_new(variants, variant_json(review, &review->variants[i]));
    return variants;
}

/* What the displays' panels say of themselves. */
static json_t *write_panels(const void *review) {
    Arena scratch = arena_reserve(PLACES_BYTES);
    int count;
    json_t *list = json_array();
    const ReviewCase **displays = review_displays(review, &count, &scratch);
    for (int i = 0; i < count; i++) {
        json_t *panel = record_write(&panel_json, &displays[i]->panel);
        set(panel, "display", text(displays[i]->display));
        json_array_append_new(list, panel);
    }
    arena_release(&scratch);
    return list;
}

static json_t *write_places(const void *review) {
    Arena scratch = arena_reserve(PLACES_BYTES);
    int count;
    ReviewPlaces *places = review_places(review, &count, &scratch);
    json_t *list = json_array();
    for (int i = 0; i < count; i++) {
        const ReviewCase *at = places[i].at;
        double passing = places[i].passing_share;
        double read = at->must_not_be_read ? 1 - passing : passing;
        json_t *place =
            json_pack("{s:o, s:o, s:f, s:o}", "eye", text(at->eye), "symbol", text(at->symbol),
                      "read_share", read, "condition", text(at->condition));
        if (at->must_not_be_read) set(place, "must_not_be_read", json_true());
        json_array_append_new(list, place);
    }
    arena_release(&scratch);
    return list;
}

/* ---- findings ---------------------------------------------------------------------------- */

static void set_line(json_t *to, const Finding *f, const LimitVerdict *line) {
    static const char *const BOUNDS[] = {"least", "most"};
    set(to, "quantity", text(line ? line->kind : NULL));
    set(to, "limit_name", text(line ? line->name : NULL));
    set(to, "unit", text(line ? line->unit : NULL));
    set(to, "found", json_figure(line ? line->found : (double)NAN));
    set(to, "interval", line ? pair(line->low, line->high) : pair(NAN, NAN));
    set(to, "bound", text(line ? BOUNDS[line->is_upper] : NULL));
    set(to, "limit", json_figure(line ? line->value : (double)NAN));
    set(to, "margin", json_figure(line ? line->margin : (double)NAN));
    set(to, "verdict", text(verdict_names[line ? line->verdict : f->verdict]));
    set(to, "advice", json_boolean(line && line->is_advice));
    set(to, "with_veil", json_boolean(line && line->has_veil));
    if (line && line->age_years > 0) set(to, "age_years", json_figure(line->age_years));
    if (line && line->by_pane) set(to, "in_pane", text(line->by_pane));
    set(to, "decides", json_boolean(line == f->worst));
}

static json_t *row_json(const Finding *f, const LimitVerdict *line) {
    const char *when = f->c ? f->c->when : f->sun ? f->sun->when : NULL;
    json_t *to =
        json_pack("{s:o, s:o, s:o, s:s, s:o, s:s, s:o, s:b}", "condition", text(f->condition),
                  "eye", text(f->viewer), "subject", text(f->subject), "kind", finding_kind(f),
                  "when", text(when), "finding_verdict", verdict_names[f->verdict], "reason",
                  text(unjudged_names[f->why]), "counts", (int)f->counts);
    set_line(to, f, line);
    return to;
}

static json_t *write_findings(const void *user) {
    const Review *review = user;
    Arena scratch = arena_reserve(DOCUMENT_BYTES);
    Findings all = review_findings(review, &scratch);
    json_t *list = json_array();
    for (int i = 0; i < all.count; i++) {
        const Finding *f = &all.list[i];
        if (!f->limit_count) json_array_append_new(list, row_json(f, NULL));
        for (int k = 0; k < f->limit_count; k++)
            json_array_append_new(list, row_json(f, &f->limits[k]));
    }
    arena_release(&scratch);
    return list;
}

static json_t *write_rests(const void *review) {
    Arena scratch = arena_reserve(PLACES_BYTES);
    json_t *line = text(review_rests_words(review, false, &scratch));
    arena_release(&scratch);
    return line;
}

static json_t *write_headline(const void *review) {
    Arena scratch = arena_reserve(PLACES_BYTES);
    json_t *words = text(review_outcome_words(review, &scratch));
    arena_release(&scratch);
    return words;
}

static json_t *write_data_share(const void *review) {
    (void)review;
    return json_real(UNJUDGED_DATA_SHARE);
}

static json_t *write_verdict(const void *review) {
    return json_string(verdict_names[review_verdict(review)]);
}

PUBLIC_TABLE(review_rows, Review, OWN(FLAG, Review, pass), TOLD("verdict", 0, write_verdict),
             TOLD("headline", 0, write_headline), AS("strict", FLAG, Review, is_strict),
             OWN(TEXT, Review, title), PART("document", 0, Review, document, document_json),
             OWN(TEXT, Review, profile), LATER("superseded_by", TEXT, Review, superseded_by),
             TOLD("findings", 0, write_findings),
             LIST("cases", MUST, Review, cases, case_count, case_json),
             LIST("sweeps", MUST, Review, sweeps, sweep_count, sweep_json),
             LIST("gazes", MUST, Review, gazes, gaze_count, gaze_json),
             LIST("false_suns", MUST, Review, false_suns, false_sun_count, false_sun_json),
             LIST("pane_images", RECORD_BRIEF, Review, pane_images, pane_image_count,
                  pane_image_json),
             TOLD("variants", RECORD_BRIEF, write_variants), TOLD("eye_places", 0, write_places),
             TOLD("panels", 0, write_panels),
             LIST("responses", MUST, Review, responses, response_count, response_json),
             AS_TEXT("without_data", RECORD_WRITTEN | RECORD_KEPT, Review, without_data),
             KEPT("without_data_count", INT, Review, without_data_count),
             TOLD("without_data_share_most", 0, write_data_share),
             LIST("rests_on", 0, Review, rests_on, rests_on_count, rest_json),
             TOLD("rests_on_line", 0, write_rests),
             LIST("inputs", 0, Review, inputs, input_count, files_json),
             {"notes", RECORD_TEXTS, MUST, RECORD_MANY(Review, notes, note_count)});

json_t *review_case_json(const ReviewCase *c) {
    return record_write(&case_json, c);
}

json_t *review_json(const Review *review) {
    return record_write(&review_rows, review);
}

bool review_json_write(json_t *document, const char *path, Error *err) {
    Arena arena = arena_reserve(DOCUMENT_BYTES);
    Text text = {.arena = &arena};
    bool ok = json_dump_text(&text, document, JSON_INDENT(2) | JSON_REAL_PRECISION(DIGITS)) ||
              error_set(err, ERROR_MEMORY, "out of memory for %s", path);
    json_decref(document);
    text_add(&text, "\n");
    ok = ok && text_write(&text, path, err);
    arena_release(&arena);
    return ok;
}

bool review_json_read(const char *file, Arena *arena, Review *out, Error *err) {
    JsonView root;
    Review review = {0};
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = record_read(&root, &review_rows, &review, err);
    json_view_close(&root);
    if (ok) *out = review;
    return ok;
}
