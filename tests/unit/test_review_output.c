/* SPDX-License-Identifier: Apache-2.0 */
/* What scripts get from a review: the same again when it is read back, well formed whatever the
 * names are; its answer, and how it differs from another. test_review_page.c has the page. */
#include <libxml/parser.h>
#include <libxml/xpath.h>

#include "base/count.h"
#include "review/output/review_json.h"
#include "review/output/review_words.h"
#include "review/export/review_junit.h"
#include "review_page_fixture.h"

static const char *json_of(const Review *review) {
    const char *path = fresh_name(".json");
    assert_done(review_json_write(review_json(review), path, &err));
    return taken(path);
}

static Review read_back(const char *json) {
    Review review = {0};
    const char *path = fresh_name(".json");
    write_text(path, json);
    assert_done(review_json_read(path, &arena, &review, &err));
    remove(path);
    return review;
}

/* ---- JSON ------------------------------------------------------------------------------- */

typedef enum MemberKind { TEXT, NUMBER, WHOLE } MemberKind;

/* Of a struct; a whole number has any width. */
typedef struct Member {
    const char *name;
    MemberKind kind;
    size_t offset, size;
} Member;

#define MEMBER(type, kind, member) \
    {#member, kind, offsetof(type, member), sizeof(((type *)0)->member)}

static long whole_at(const char *at, size_t size) {
    return size == 1 ? *at : size == sizeof(int) ? *(const int *)at : *(const long *)at;
}

static void assert_same_text(const char *name, const char *a, const char *b) {
    if (a ? !b || strcmp(a, b) != 0 : b != NULL)
        fail_msg("%s: \"%s\" became \"%s\"", name, a ? a : "none", b ? b : "none");
}

static void assert_members(const void *a, const void *b, const Member *members, int count) {
    for (const Member *m = members; m < members + count; m++) {
        const char *x = (const char *)a + m->offset, *y = (const char *)b + m->offset;
        if (m->kind == TEXT) assert_same_text(m->name, *(char *const *)x, *(char *const *)y);
        else if (m->kind == NUMBER && !is_same(*(const double *)x, *(const double *)y))
            fail_msg("%s: %.9g became %.9g", m->name, *(const double *)x, *(const double *)y);
        else if (m->kind == WHOLE && whole_at(x, m->size) != whole_at(y, m->size))
            fail_msg("%s: %ld became %ld", m->name, whole_at(x, m->size), whole_at(y, m->size));
    }
}

#define ASSERT_SAME(a, b, members) assert_members(a, b, members, COUNT_OF(members))

#define OF(kind, member) MEMBER(LimitVerdict, kind, member)
static const Member LIMIT[] = {OF(TEXT, name),      OF(TEXT, kind),
                               OF(TEXT, unit),      OF(TEXT, source),
                               OF(NUMBER, value),   OF(NUMBER, found),
                               OF(NUMBER, low),     OF(NUMBER, high),
                               OF(NUMBER, margin),  OF(WHOLE, read_in_the_standard),
                               OF(WHOLE, is_upper), OF(WHOLE, is_advice),
                               OF(WHOLE, verdict)};
#undef OF
#define OF(kind, member) MEMBER(CaseVisibility, kind, member)
static const Member LEVEL[] = {OF(NUMBER, age_years),     OF(NUMBER, size_arcmin),
                               OF(NUMBER, high),          OF(TEXT, doubts),
                               OF(NUMBER, glance_s),      OF(NUMBER, veil_times),
                               OF(NUMBER, veil_doubt),    OF(NUMBER, low),
                               OF(NUMBER, adapted_cd_m2), OF(NUMBER, threshold_cd_m2),
                               OF(NUMBER, level),         OF(WHOLE, is_observer)};
#undef OF
#define OF(kind, member) MEMBER(CaseCause, kind, member)
static const Member CAUSE[] = {OF(WHOLE, links), OF(NUMBER, share), OF(NUMBER, cd_m2),
                               OF(NUMBER, low), OF(NUMBER, high)};
#undef OF
static const Member HIDER[] = {MEMBER(CaseHider, TEXT, what), MEMBER(CaseHider, NUMBER, share)};
static const Member REMEDY[] = {MEMBER(CaseRemedy, TEXT, what),
                                MEMBER(CaseRemedy, NUMBER, contrast_ratio),
                                MEMBER(CaseRemedy, NUMBER, level)};
#define OF(kind, member) MEMBER(ReviewCase, kind, member)
static const Member CASE[] = {OF(TEXT, condition),
                              OF(TEXT, eye),
                              OF(TEXT, symbol),
                              OF(TEXT, display),
                              OF(TEXT, frame),
                              OF(TEXT, when),
                              OF(WHOLE, ambient),
                              OF(WHOLE, has_sun),
                              OF(NUMBER, contrast_ratio),
                              OF(NUMBER, contrast_low),
                              OF(NUMBER, contrast_high),
                              OF(WHOLE, paths),
                              OF(NUMBER, contrast_with_veil),
                              OF(NUMBER, height_arcmin),
                              OF(NUMBER, jnd),
                              OF(NUMBER, visibility),
                              OF(NUMBER, eye_failed_share),
                              OF(NUMBER, whole.reflected),
                              OF(NUMBER, whole.reflected_range.low),
                              OF(NUMBER, whole.reflected_range.high),
                              OF(NUMBER, whole.contrast_ratio),
                              OF(NUMBER, whole.lit_share),
                              OF(NUMBER, whole.part.left),
                              OF(NUMBER, whole.part.bottom),
                              OF(NUMBER, visible_share),
                              OF(NUMBER, level),
                              OF(NUMBER, display_lux),
                              OF(NUMBER, margin),
                              OF(WHOLE, visibility_count),
                              OF(WHOLE, limit_id),
                              OF(WHOLE, verdict),
                              OF(WHOLE, limit_count),
                              OF(WHOLE, cause_count),
                              OF(WHOLE, remedy_count),
                              OF(WHOLE, hider_count),
                              OF(NUMBER, without_data_share),
                              OF(NUMBER, guessed_share),
                              OF(NUMBER, extrapolated_share),
                              OF(TEXT, panel.assumed),
                              OF(TEXT, empty_seat),
                              OF(NUMBER, empty_seat_share)};
#undef OF
#define OF(kind, member) MEMBER(ReviewFalseSun, kind, member)
static const Member FALSE_SUN[] = {OF(TEXT, condition),
                                   OF(TEXT, eye),
                                   OF(TEXT, mirror),
                                   OF(TEXT, when),
                                   OF(TEXT, gaze),
                                   OF(NUMBER, share),
                                   OF(NUMBER, minutes),
                                   OF(NUMBER, longest_minutes),
                                   OF(NUMBER, sun_azimuth_deg),
                                   OF(NUMBER, sun_elevation_deg),
                                   OF(NUMBER, lux),
                                   OF(NUMBER, angle_deg),
                                   OF(NUMBER, veil_cd_m2)};
#undef OF
#define OF(kind, member) MEMBER(GazeFinding, kind, member)
static const Member GAZE[] = {OF(TEXT, condition),
                              OF(TEXT, eye),
                              OF(TEXT, gaze),
                              OF(TEXT, mirrored_by),
                              OF(TEXT, mirrored_from),
                              OF(NUMBER, sun_deg),
                              OF(NUMBER, veil),
                              OF(NUMBER, cornea_lux),
                              OF(NUMBER, through),
                              OF(NUMBER, mirrored),
                              OF(NUMBER, contrast_behind_glass),
                              OF(NUMBER, contrast_left),
                              OF(NUMBER, veil_range.low),
                              OF(NUMBER, veil_range.high),
                              OF(NUMBER, mirrored_range.low),
                              OF(NUMBER, mirrored_range.high),
                              OF(NUMBER, contrast_range.low),
                              OF(NUMBER, contrast_range.high)};
#undef OF
#define OF(kind, member) MEMBER(ReviewSweep, kind, member)
static const Member SWEEP[] = {OF(TEXT, condition),
                               OF(TEXT, eye),
                               OF(TEXT, symbol),
                               OF(TEXT, table),
                               OF(WHOLE, cases),
                               OF(NUMBER, failed_share),
                               OF(NUMBER, longest_failure_minutes)};
#undef OF
#define OF(kind, member) MEMBER(ReviewResponse, kind, member)
static const Member RESPONSE[] = {OF(TEXT, probe), OF(TEXT, file), OF(WHOLE, paths),
                                  OF(WHOLE, bytes), OF(NUMBER, relative_error)};
#undef OF
#define OF(kind, member) MEMBER(ReviewRest, kind, member)
static const Member REST[] = {OF(WHOLE, kind), OF(WHOLE, basis), OF(TEXT, name),
                              OF(TEXT, words), OF(WHOLE, count), OF(WHOLE, of)};
#undef OF
static const Member FILES[] = {MEMBER(ReviewFile, TEXT, path), MEMBER(ReviewFile, TEXT, sha256)};
#define OF(kind, member) MEMBER(Review, kind, member)
static const Member REVIEW[] = {
    OF(TEXT, title),           OF(TEXT, profile),         OF(WHOLE, pass),
    OF(WHOLE, is_strict),      OF(WHOLE, case_count),     OF(WHOLE, sweep_count),
    OF(WHOLE, response_count), OF(WHOLE, note_count),     OF(WHOLE, false_sun_count),
    OF(WHOLE, gaze_count),     OF(WHOLE, rests_on_count), OF(WHOLE, input_count)};
#undef OF

static void assert_same_case(const ReviewCase *a, const ReviewCase *b) {
    const double *l = &a->luminance_cd_m2.foreground, *m = &b->luminance_cd_m2.foreground;
    for (size_t i = 0; i < sizeof a->luminance_cd_m2 / sizeof *l; i++) assert_same(l[i], m[i]);
    ASSERT_SAME(a, b, CASE);
    assert_same(a->has_sun ? a->sun_azimuth_deg : NAN, b->sun_azimuth_deg);
    assert_same(a->has_sun ? a->sun_elevation_deg : NAN, b->sun_elevation_deg);
    for (int i = 0; i < a->limit_count; i++) {
        double age = a->limits[i].age_years;
        ASSERT_SAME(&a->limits[i], &b->limits[i], LIMIT);
        assert_same(age > 0 ? age : NAN, b->limits[i].age_years);
    }
    for (int i = 0; i < a->visibility_count; i++)
        ASSERT_SAME(&a->visibilities[i], &b->visibilities[i], LEVEL);
    for (int i = 0; i < a->cause_count; i++) {
        ASSERT_SAME(&a->causes[i], &b->causes[i], CAUSE);
        for (int k = 0; k < a->causes[i].links; k++)
            assert_same_text("chain", a->causes[i].chain[k], b->causes[i].chain[k]);
    }
    for (int i = 0; i < a->hider_count; i++) ASSERT_SAME(&a->hiders[i], &b->hiders[i], HIDER);
    for (int i = 0; i < a->remedy_count; i++) ASSERT_SAME(&a->remedies[i], &b->remedies[i], REMEDY);
}

static void assert_same_review(const Review *a, const Review *b) {
    ASSERT_SAME(a, b, REVIEW);
    for (int i = 0; i < a->case_count; i++) assert_same_case(&a->cases[i], &b->cases[i]);
    for (int i = 0; i < a->note_count; i++) assert_same_text("note", a->notes[i], b->notes[i]);
    for (int i = 0; i < a->sweep_count; i++) {
        ASSERT_SAME(&a->sweeps[i], &b->sweeps[i], SWEEP);
        assert_same_case(&a->sweeps[i].worst, &b->sweeps[i].worst);
    }
    for (int i = 0; i < a->false_sun_count; i++)
        ASSERT_SAME(&a->false_suns[i], &b->false_suns[i], FALSE_SUN);
    for (int i = 0; i < a->gaze_count; i++) {
        const GazeFinding *g = &a->gazes[i], *h = &b->gazes[i];
        const double *v = &g->veil_parts.sun, *w = &h->veil_parts.sun;
        ASSERT_SAME(g, h, GAZE);
        for (size_t k = 0; k < sizeof g->veil_parts / sizeof *v; k++) assert_same(v[k], w[k]);
    }
    for (int i = 0; i < a->response_count; i++)
        ASSERT_SAME(&a->responses[i], &b->responses[i], RESPONSE);
    for (int i = 0; i < a->rests_on_count; i++) ASSERT_SAME(&a->rests_on[i], &b->rests_on[i], REST);
    for (int i = 0; i < a->input_count; i++) ASSERT_SAME(&a->inputs[i], &b->inputs[i], FILES);
}

/* Read back it is the same to six digits, and written again the same to the byte. */
TEST(json_is_read_back) {
    Review reviews[] = {fixture_review(&arena),
                        fixture_odd_review(&arena),
                        {.title = "", .pass = true},
                        fixture_review(&arena)};
    fixture_add_levels(&arena, &reviews[3]);
    for (size_t i = 0; i < sizeof reviews / sizeof *reviews; i++) {
        const char *json = json_of(&reviews[i]);
        Review again = read_back(json);
        assert_same_review(&reviews[i], &again);
        assert_string_equal(json_of(&again), json);
    }
}

/* Reached or not: what paths did not do stands beside what was requested. */
TEST(a_precision_that_was_not_reached_is_named) {
    ReviewCase c = {.precision_asked = 0.01, .precision_reached = 0.0234};
    assert_string_equal(words_precision(&c, &arena), "; known within 2.3 %, 1.0 % required");
    c.precision_reached = 0.01;
    assert_string_equal(words_precision(&c, &arena), "");
    c.precision_asked = c.precision_reached = (double)NAN;
    assert_string_equal(words_precision(&c, &arena), "");
}

/* Scripts hold on to these keys. */
TEST(json_has_the_promised_keys) {
    static const char *const KEYS[] = {"condition",
                                       "eye",
                                       "symbol",
                                       "display",
                                       "ambient",
                                       "sun",
                                       "luminance_cd_m2",
                                       "contrast_ratio",
                                       "contrast_interval",
                                       "reflected_interval",
                                       "precision_asked",
                                       "precision_reached",
                                       "paths",
                                       "contrast_with_veil",
                                       "height_arcmin",
                                       "jnd",
                                       "visibility",
                                       "when",
                                       "visible_share",
                                       "hidden_by",
                                       "eye_failed_share",
                                       "level",
                                       "display_lux",
                                       "limit",
                                       "limits",
                                       "margin",
                                       "verdict",
                                       "causes",
                                       "guessed_share",
                                       "extrapolated_share",
                                       "without_data_share",
                                       "empty_seat",
                                       "empty_seat_share",
                                       "remedies",
                                       "frame",
                                       "symbol_mean",
                                       "lit_share",
                                       "judged_part_uv"};
    Review review = fixture_review(&arena);
    json_t *json = review_json(&review), *value;
    json_t *first = json_array_get(json_object_get(json, "cases"), 0);
    for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; i++)
        if (!json_object_get(first, KEYS[i])) fail_msg("no key %s", KEYS[i]);
    assert_true(json_is_null(json_object_get(first, "sun"))); /* night */
    value = json_array_get(json_object_get(json, "sweeps"), 1);
    assert_non_null(json_object_get(json_object_get(value, "worst"), "contrast_ratio"));
    assert_true(json_is_false(json_object_get(json, "pass")));
    json_decref(json);
}

/* The first `from` of a good review.json becomes `to`. */
static void assert_refused(const char *from, const char *to, const char *path, const char *text) {
    Review review = fixture_review(&arena), out = {.title = "untouched"};
    const char *good = json_of(&review), *at = strstr(good, from);
    assert_non_null(at);
    const char *file = fresh_name(".json");
    Text bad = {.arena = &arena};
    text_add_bytes(&bad, good, (size_t)(at - good));
    text_add(&bad, to);
    text_add(&bad, at + strlen(from));
    assert_done(text_write(&bad, file, &err));
    assert_false(review_json_read(file, &arena, &out, why()));
    remove(file);
    assert_string_equal(why()->path, path);
    assert_string_equal(why()->file, file);
    assert_error_has(why(), text);
    assert_string_equal(out.title, "untouched");
}

TEST(a_foreign_json_is_refused_in_one_line) {
    assert_refused("\"pass\": false", "\"pass\": 1", "/pass", "required: true or false");
    assert_refused("\"strict\": false,", "", "", "key 'strict' is missing");
    assert_refused("\"ambient\": \"night\"", "\"ambient\": \"nigth\"", "/cases/0/ambient",
                   "did you mean night?");
    assert_refused("\"contrast_interval\": [", "\"contrast_interval\": [7, ",
                   "/cases/0/contrast_interval", "has 3 values, required: 2");
    assert_refused("\"limit\": {", "\"limit\": {\"x\": 1, ", "/cases/0/limit", "one of 'limits'");
    assert_refused("\"foreground\": ", "\"foreground\": \"\", \"x\": ",
                   "/cases/0/luminance_cd_m2/foreground", "is a text, required: a number");
    assert_refused("\"chain\": [", "\"chain\": [4, ", "/cases/0/causes/0/chain/0",
                   "is a number, required: a text");
    assert_refused("\"hidden_by\": []", "\"hidden_by\": [{\"what\": 3}]",
                   "/cases/0/hidden_by/0/what", "required: a text");
    assert_refused("\"basis\": \"given\"", "\"basis\": \"giver\"", "/rests_on/3/basis",
                   "did you mean given?");
    assert_refused("\"cases\": [", "\"cases\": [null, ", "/cases/0", "required: an object");
    assert_refused("\"pass\"", "pass", "line 2", "not valid JSON");
}

/* What was reported later than reviews that may be held against this one. */
static bool is_optional(const char *key, const json_t *object) {
    static const char *const ADDED[] = {"reflected_interval",
                                        "precision_asked",
                                        "precision_reached",
                                        "cause_groups",
                                        "without_data_share",
                                        "without_data",
                                        "hidden_by",
                                        "without_data_share_most",
                                        "eye_places",
                                        "then",
                                        "judged",
                                        "reason",
                                        "optional",
                                        "panel",
                                        "panels",
                                        "stroke_ratio",
                                        "rests_on",
                                        "rests_on_line",
                                        "inputs",
                                        "guessed_share",
                                        "extrapolated_share",
                                        "spectra_assumed",
                                        "empty_seat",
                                        "empty_seat_share",
                                        "symbol_mean",
                                        "lit_share",
                                        "findings",
                                        "judged_part_uv",
                                        "open_by",
                                        "glasses_transmittance",
                                        "middle_eye_contrast_ratio",
                                        "glasses",
                                        "glasses_display_loss",
                                        "visibility_levels",
                                        "age_years",
                                        "must_not_be_read",
                                        "headline",
                                        "document",
                                        "superseded_by",
                                        "failed_minutes",
                                        "headings",
                                        "sha256"};
    for (size_t i = 0; i < sizeof ADDED / sizeof *ADDED; i++)
        if (!strcmp(key, ADDED[i])) return true;
    bool is_gaze = json_object_get(object, "gaze") || json_object_get(object, "mirror");
    if (is_gaze && (!strcmp(key, "verdict") || !strcmp(key, "reason"))) return true;
    return !strcmp(key, "verdict") &&
           (json_object_get(object, "cases") || json_object_get(object, "worst") ||
            json_object_get(object, "then"));
}

/* Takes each key of the object away, one at a time: the error names it. */
static int assert_keys_are_wanted(json_t *root, json_t *object) {
    int count = 0;
    Review out;
    const char *path = fresh_name(".json");
    json_t *copy = json_copy(object), *value;
    const char *key;
    assert_true(json_is_object(object));
    json_object_foreach(copy, key, value) {
        if (is_optional(key, copy)) continue;
        json_object_del(object, key);
        assert_done(review_json_write(json_incref(root), path, &err));
        assert_false(review_json_read(path, &arena, &out, why()));
        if (!strstr(why()->text, arena_format(&arena, "key '%s' is missing", key)))
            fail_msg("without %s: %s %s", key, why()->path, why()->text);
        json_object_set(object, key, value);
        count++;
    }
    json_decref(copy);
    remove(path);
    return count;
}

TEST(every_key_is_wanted) {
    Review review = fixture_review(&arena);
    json_auto_t *root = review_json(&review);
    json_t *c = json_array_get(json_object_get(root, "cases"), 2);
    int count = assert_keys_are_wanted(root, root) + assert_keys_are_wanted(root, c);
    static const char *const OBJECTS[] = {"sun", "luminance_cd_m2"};
    static const char *const LISTS[] = {"limits", "causes", "remedies"};
    for (int i = 0; i < 2; i++)
        count += assert_keys_are_wanted(root, json_object_get(c, OBJECTS[i]));
    for (int i = 0; i < 3; i++)
        count += assert_keys_are_wanted(root, json_array_get(json_object_get(c, LISTS[i]), 1));
    json_t *sweep = json_array_get(json_object_get(root, "sweeps"), 1);
    json_t *response = json_array_get(json_object_get(root, "responses"), 0);
    json_t *image = json_array_get(json_object_get(root, "false_suns"), 0);
    json_t *gaze = json_array_get(json_object_get(root, "gazes"), 1);
    json_t *all[] = {sweep, response,
                     image, json_object_get(image, "sun"),
                     gaze,  json_object_get(gaze, "veil_parts_cd_m2")};
    for (int i = 0; i < 6; i++) count += assert_keys_are_wanted(root, all[i]);
    assert_int_equal(count, 10 + 26 + 2 + 6 + 12 + 5 + 3 + 8 + 5 + 12 + 2 + 16 + 6);
}

/* ---- JUnit ------------------------------------------------------------------------------ */

static int nodes_at(xmlXPathContextPtr context, const char *path) {
    xmlXPathObjectPtr found = xmlXPathEvalExpression((const xmlChar *)path, context);
    assert_non_null(found);
    int count = found->nodesetval ? found->nodesetval->nodeNr : 0;
    xmlXPathFreeObject(found);
    return count;
}

static void assert_junit(const Review *review, int failures, int errors, int skipped) {
    const char *path = fresh_name(".json");
    assert_done(review_junit_write(review, path, &err));
    const char *xml = taken(path);
    xmlDocPtr document = xmlReadMemory(xml, (int)strlen(xml), "junit.xml", NULL, XML_PARSE_NONET);
    assert_non_null(document);
    xmlXPathContextPtr context = xmlXPathNewContext(document);
    assert_int_equal(nodes_at(context, "/testsuites/testsuite/testcase[@name and @classname]"),
                     review->case_count + review->sweep_count);
    assert_int_equal(nodes_at(context, "//testcase/failure[@message]"), failures);
    assert_int_equal(nodes_at(context, "//testcase/error[@message]"), errors);
    assert_int_equal(nodes_at(context, "//testcase/skipped[@message]"), skipped);
    assert_int_equal(nodes_at(context, arena_format(&arena,
                                                    "//testsuite[@tests=%d and "
                                                    "@failures=%d and @errors=%d and "
                                                    "@skipped=%d]",
                                                    review->case_count + review->sweep_count,
                                                    failures, errors, skipped)),
                     1);
    xmlXPathFreeContext(context);
    xmlFreeDoc(document);
}

TEST(junit_has_a_case_for_each) {
    Review odd = fixture_odd_review(&arena), plain = fixture_review(&arena), none = {0};
    ReviewCounts counts = review_count(&plain);
    int close = counts.of[VERDICT_TOO_CLOSE], unjudged = counts.of[VERDICT_UNJUDGED];
    assert_true(unjudged > 0);
    assert_junit(&plain, counts.of[VERDICT_FAIL], unjudged, close);
    plain.is_strict = true;
    assert_junit(&plain, counts.of[VERDICT_FAIL] + close, unjudged, 0);
    plain.cases[20].is_optional = true; /* the hidden one */
    assert_junit(&plain, counts.of[VERDICT_FAIL] + close, unjudged - 1, 1);
    assert_junit(&odd, 2, 0, 0); /* strict: the doubtful case and the sweep */
    assert_junit(&none, 0, 0, 0);
}

/* ---- the answer ------------------------------------------------------------------------- */

static ReviewCase case_with(Verdict verdict, double margin) {
    return (ReviewCase){.verdict = verdict, .margin = margin, .limit_id = -1};
}

TEST(a_review_passes_when_nothing_fails) {
    static const bool PASSES[2][4] = {{true, false, true, false}, {true, false, false, false}};
    for (int strict = 0; strict < 2; strict++)
        for (int verdict = 0; verdict < 4; verdict++) {
            ReviewCase list[2] = {case_with(VERDICT_PASS, 1), case_with((Verdict)verdict, NAN)};
            ReviewSweep sweep = {.worst = list[1], .failed_share = 0};
            Review cases = {.cases = list, .case_count = 2, .is_strict = strict == 1};
            Review sweeps = {.sweeps = &sweep, .sweep_count = 1, .is_strict = strict == 1};
            assert_int_equal(review_decide(&cases), PASSES[strict][verdict]);
            assert_int_equal(cases.pass, PASSES[strict][verdict]);
            assert_int_equal(review_decide(&sweeps), PASSES[strict][verdict]);
            sweep.failed_share = 1e-9; /* of its steps: the worst was read again */
            assert_int_equal(review_decide(&sweeps), PASSES[strict][verdict]);
        }
    Review none = {0};
    assert_int_equal(review_verdict(&none), VERDICT_FAIL);
    assert_true(review_decide(&none));
    assert_int_equal(review_verdict(&none), VERDICT_PASS);
    assert_null(review_worst(&none, arena));
}

TEST(the_worst_comes_first) {
    ReviewCase list[] = {case_with(VERDICT_PASS, NAN),      case_with(VERDICT_PASS, 0.1),
                         case_with(VERDICT_TOO_CLOSE, 0.0), case_with(VERDICT_UNJUDGED, NAN),
                         case_with(VERDICT_FAIL, -0.2),     case_with(VERDICT_FAIL, -0.7),
                         case_with(VERDICT_FAIL, -0.2)};
    static const int ORDER[] = {5, 4, 6, 3, 2, 1, 0};
    Review review = {.cases = list, .case_count = 7};
    const ReviewCase **ranked = review_rank(&review, &arena);
    for (int i = 0; i < 7; i++) assert_ptr_equal(ranked[i], &list[ORDER[i]]);
    assert_ptr_equal(review_worst(&review, arena), &list[5]);
    /* A sweep stands where its worst does, whatever its steps say. */
    ReviewSweep sweep = {.worst = case_with(VERDICT_TOO_CLOSE, -0.1), .failed_share = 0.1};
    review.sweeps = &sweep;
    review.sweep_count = 1;
    assert_ptr_equal(review_rank(&review, &arena)[4], &sweep.worst);
}

/* What does not count changes nothing; of nothing else it is no verdict, but for symbols that
 * need not be seen. */
TEST(what_does_not_count_leaves_the_verdict) {
    ReviewCase list[] = {case_with(VERDICT_PASS, 1), case_with(VERDICT_UNJUDGED, NAN)};
    Review review = {.cases = list, .case_count = 2}, alone = {.cases = &list[1], .case_count = 1};
    static const struct {
        Unjudged why;
        bool is_optional;
        Verdict beside, alone;
    } ROWS[] = {{UNJUDGED_HIDDEN, false, VERDICT_UNJUDGED, VERDICT_UNJUDGED},
                {UNJUDGED_HIDDEN, true, VERDICT_PASS, VERDICT_PASS},
                {UNJUDGED_LIMIT, false, VERDICT_PASS, VERDICT_UNJUDGED},
                {UNJUDGED_PANEL, true, VERDICT_UNJUDGED, VERDICT_UNJUDGED},
                {UNJUDGED_DATA, false, VERDICT_UNJUDGED, VERDICT_UNJUDGED}};
    for (int i = 0; i < COUNT_OF(ROWS); i++)
        for (int strict = 0; strict < 2; strict++) {
            list[1].unjudged = ROWS[i].why;
            list[1].is_optional = ROWS[i].is_optional;
            review.is_strict = alone.is_strict = strict;
            assert_int_equal(review_decide(&review), ROWS[i].beside == VERDICT_PASS);
            assert_int_equal(review_verdict(&review), ROWS[i].beside);
            assert_int_equal(review_decide(&alone), ROWS[i].alone == VERDICT_PASS);
            assert_int_equal(review_verdict(&alone), ROWS[i].alone);
            bool counts = ROWS[i].beside != VERDICT_PASS;
            assert_ptr_equal(review_worst(&review, arena), &list[counts]);
        }
}

/* Advice and what is not measured may say worse than the case, and are not its reason. */
TEST(the_reason_is_a_limit_that_counts) {
    LimitVerdict limits[] = {
        {.name = "a", .verdict = VERDICT_PASS, .margin = 0.1},
        {.name = "b", .verdict = VERDICT_FAIL, .margin = -0.5, .is_advice = true},
        {.name = "c", .verdict = VERDICT_TOO_CLOSE, .margin = NAN},
        {.name = "d", .verdict = VERDICT_PASS, .margin = 0.05}};
    ReviewCase c = {.limits = limits, .limit_count = 4, .limit_id = 0, .verdict = VERDICT_PASS};
    assert_string_equal(case_worst_limit(&c)->name, "a");
    c.limit_id = -1;
    assert_string_equal(case_worst_limit(&c)->name, "d");
    c.limit_id = 0;
    c.verdict = VERDICT_TOO_CLOSE;
    assert_string_equal(case_worst_limit(&c)->name, "c");
    c.verdict = VERDICT_FAIL;
    assert_string_equal(case_worst_limit(&c)->name, "a");
    c.limit_id = -1;
    assert_null(case_worst_limit(&c));
}

/* ---- differences ------------------------------------------------------------------------ */

TEST(a_review_differs_from_itself_in_nothing) {
    Review review = fixture_review(&arena);
    ReviewDiff diff = review_diff(&review, &review, "a", "b", &arena);
    assert_int_equal(diff.list_count, review.case_count + review.sweep_count + review.gaze_count);
    assert_int_equal(diff.count[DIFF_SAME], diff.list_count);
}

TEST(gazes_differ_by_the_contrast_that_is_left) {
    static const DiffKind KINDS[] = {DIFF_WORSE, DIFF_GONE, DIFF_NEW};
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    after.gazes[0].contrast_range.high = before.gazes[0].contrast_range.low * 0.999;
    after.gazes[1].contrast_range.high = before.gazes[1].contrast_range.low; /* they touch */
    after.gazes[2].gaze = "mirror";
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    json_t *json = review_diff_json(&diff), *list = json_object_get(json, "findings");
    for (int i = 0; i < 3; i++) assert_int_equal(diff.list[i].kind, KINDS[i]);
    json_t *lines = json_object_get(json_array_get(list, 1), "lines");
    json_t *gone = json_object_get(json_array_get(lines, 0), "found");
    assert_close(json_real_value(json_array_get(gone, 0)), before.gazes[2].contrast_left, 1e-12);
    assert_true(json_is_null(json_array_get(gone, 1)));
    json_decref(json);
}

TEST(differences_are_named_and_come_first) {
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    static const DiffKind KINDS[] = {DIFF_BROKEN, DIFF_MENDED, DIFF_WORSE, DIFF_WORSE,
                                     DIFF_BETTER, DIFF_GONE,   DIFF_NEW};
    before.cases[4].verdict = VERDICT_PASS; /* to what it is, or was */
    after.cases[4].verdict = VERDICT_UNJUDGED;
    before.cases[3].verdict = VERDICT_FAIL;
    after.cases[3].verdict = VERDICT_TOO_CLOSE;
    after.cases[2].contrast_high = before.cases[2].contrast_low * 0.999;
    after.cases[1].contrast_low = before.cases[1].contrast_high * 1.001;
    after.cases[0].contrast_low = before.cases[0].contrast_high * 0.999; /* they touch */
    after.cases[23].symbol = "renamed";
    after.sweeps[0].failed_share += 0.01;
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(diff.list_count, 25 + after.sweep_count + after.gaze_count);
    for (int i = 0; i < diff.list_count; i++)
        assert_int_equal(diff.list[i].kind, i < 7 ? KINDS[i] : DIFF_SAME);
    assert_ptr_equal(diff.list[0].after->c, &after.cases[4]);
    assert_ptr_equal(diff.list[1].before->c, &before.cases[3]);
    assert_ptr_equal(diff.list[3].after->sweep, &after.sweeps[0]);
    assert_null(diff.list[5].after);
    assert_string_equal(diff.list[6].after->subject, "renamed");
}

TEST(differences_as_json) {
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    after.cases[3].contrast_ratio *= 2;
    after.cases[3].contrast_low *= 2;
    after.cases[3].contrast_high *= 2;
    after.case_count = 23;
    ReviewDiff diff = review_diff(&before, &after, "a<", "b", &arena);
    json_t *json = review_diff_json(&diff), *cases = json_object_get(json, "findings");
    json_t *lines = json_object_get(json_array_get(cases, 0), "lines");
    json_t *ratio = json_object_get(json_array_get(lines, 0), "found");
    assert_int_equal(json_array_size(cases), 24 + after.sweep_count + after.gaze_count);
    assert_string_equal(json_string_value(json_object_get(json_array_get(cases, 0), "change")),
                        "better");
    assert_close(json_real_value(json_array_get(ratio, 1)),
                 2 * json_real_value(json_array_get(ratio, 0)), 1e-12);
    json_t *gone = json_array_get(cases, 1), *count = json_object_get(json, "count");
    assert_true(json_is_null(json_array_get(json_object_get(gone, "verdict"), 1)));
    assert_int_equal(json_integer_value(json_object_get(count, "gone")), 1);
    json_decref(json);
}

TEST_PROGRAM(page_begin, clear_folder)
