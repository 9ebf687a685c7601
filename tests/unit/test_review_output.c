/* SPDX-License-Identifier: Apache-2.0 */
/* What scripts get from a review: the same again when it is read back, well formed whatever the
 * names are; its answer, and how it differs from another. test_review_page.c has the page. */
#include "check.h"

#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_write.h"
#include "review/output/review_json.h"
#include "review/output/review_words.h"
#include "review/output/review_junit.h"
#include "verdict_fixture.h"

static Arena arena;

/* ---- files ------------------------------------------------------------------------------ */

static const char *fresh_name(void)
{
    char path[] = "test_review_output_XXXXXX";
    int  handle = mkstemp(path);
    assert_true(handle >= 0);
    close(handle);
    return arena_format(&arena, "%s", path);
}

/* The file's bytes; the file goes. */
static const char *take(const char *path)
{
    Error     err = {0};
    FileBytes bytes;
    if (!file_read(path, (size_t)1 << 28, &arena, &bytes, &err)) fail_msg("%s", err.text);
    remove(path);
    assert_int_equal(bytes.size, strlen((const char *)bytes.data));
    return (const char *)bytes.data;
}

static const char *json_of(const Review *review)
{
    Error       err = {0};
    const char *path = fresh_name();
    assert_true(review_json_write(review_json(review), path, &err));
    return take(path);
}

static const char *file_of(const char *text)
{
    Error       err = {0};
    const char *path = fresh_name();
    assert_true(file_write(path, text, strlen(text), &err));
    return path;
}

static Review read_back(const char *json)
{
    Error       err = {0};
    Review      review = {0};
    const char *path = file_of(json);
    if (!review_json_read(path, &arena, &review, &err)) fail_msg("%s %s", err.path, err.text);
    remove(path);
    return review;
}

/* ---- JSON ------------------------------------------------------------------------------- */

static void assert_same(double a, double b)
{
    if (isnan(a) || isinf(a)) assert_true(isnan(b));
    else assert_near(b, a, 1e-5 * fabs(a) + 1e-300);
}

static void assert_same_text(const char *a, const char *b)
{
    if (a) assert_string_equal(b, a);
    else assert_null(b);
}

static void assert_same_limit(const LimitVerdict *a, const LimitVerdict *b)
{
    assert_same_text(a->name, b->name);
    assert_same_text(a->kind, b->kind);
    assert_same_text(a->unit, b->unit);
    assert_same_text(a->source, b->source);
    assert_same(a->value, b->value);
    assert_same(a->found, b->found);
    assert_same(a->low, b->low);
    assert_same(a->high, b->high);
    assert_same(a->margin, b->margin);
    assert_int_equal(a->read_in_the_standard, b->read_in_the_standard);
    assert_int_equal(a->is_upper, b->is_upper);
    assert_int_equal(a->is_advice, b->is_advice);
    assert_int_equal(a->verdict, b->verdict);
}

static void assert_same_lists(const ReviewCase *a, const ReviewCase *b)
{
    assert_int_equal(a->limit_count, b->limit_count);
    assert_int_equal(a->cause_count, b->cause_count);
    assert_int_equal(a->remedy_count, b->remedy_count);
    for (int i = 0; i < a->limit_count; i++) assert_same_limit(&a->limits[i], &b->limits[i]);
    for (int i = 0; i < a->cause_count; i++) {
        assert_int_equal(a->causes[i].links, b->causes[i].links);
        for (int k = 0; k < a->causes[i].links; k++)
            assert_same_text(a->causes[i].chain[k], b->causes[i].chain[k]);
        assert_same(a->causes[i].share, b->causes[i].share);
        assert_same(a->causes[i].cd_m2, b->causes[i].cd_m2);
        assert_same(a->causes[i].low, b->causes[i].low);
        assert_same(a->causes[i].high, b->causes[i].high);
    }
    assert_int_equal(a->hider_count, b->hider_count);
    for (int i = 0; i < a->hider_count; i++) {
        assert_same_text(a->hiders[i].what, b->hiders[i].what);
        assert_same(a->hiders[i].share, b->hiders[i].share);
    }
    for (int i = 0; i < a->remedy_count; i++) {
        assert_same_text(a->remedies[i].what, b->remedies[i].what);
        assert_same(a->remedies[i].contrast_ratio, b->remedies[i].contrast_ratio);
        assert_same(a->remedies[i].level, b->remedies[i].level);
    }
}

static void assert_same_case(const ReviewCase *a, const ReviewCase *b)
{
    const double *l = &a->luminance_cd_m2.foreground, *m = &b->luminance_cd_m2.foreground;
    for (size_t i = 0; i < sizeof a->luminance_cd_m2 / sizeof *l; i++) assert_same(l[i], m[i]);
    assert_same_text(a->condition, b->condition);
    assert_same_text(a->eye, b->eye);
    assert_same_text(a->symbol, b->symbol);
    assert_same_text(a->display, b->display);
    assert_same_text(a->frame, b->frame);
    assert_same_text(a->when, b->when);
    assert_int_equal(a->ambient, b->ambient);
    assert_int_equal(a->has_sun, b->has_sun);
    assert_same(a->has_sun ? a->sun_azimuth_deg : NAN, b->sun_azimuth_deg);
    assert_same(a->has_sun ? a->sun_elevation_deg : NAN, b->sun_elevation_deg);
    assert_same(a->contrast_ratio, b->contrast_ratio);
    assert_same(a->contrast_low, b->contrast_low);
    assert_same(a->contrast_high, b->contrast_high);
    assert_int_equal(a->paths, b->paths);
    assert_same(a->contrast_with_veil, b->contrast_with_veil);
    assert_same(a->height_arcmin, b->height_arcmin);
    assert_same(a->jnd, b->jnd);
    assert_same(a->visibility, b->visibility);
    assert_same(a->dgp, b->dgp);
    assert_same(a->ugr, b->ugr);
    assert_same(a->eye_failed_share, b->eye_failed_share);
    assert_same(a->visible_share, b->visible_share);
    assert_same(a->level, b->level);
    assert_same(a->display_lux, b->display_lux);
    assert_same(a->margin, b->margin);
    assert_int_equal(a->limit_id, b->limit_id);
    assert_int_equal(a->verdict, b->verdict);
    assert_same_lists(a, b);
}

static void assert_same_false_sun(const ReviewFalseSun *a, const ReviewFalseSun *b)
{
    assert_same_text(a->condition, b->condition);
    assert_same_text(a->eye, b->eye);
    assert_same_text(a->mirror, b->mirror);
    assert_same_text(a->when, b->when);
    assert_same_text(a->gaze, b->gaze);
    assert_same(a->share, b->share);
    assert_same(a->minutes, b->minutes);
    assert_same(a->longest_minutes, b->longest_minutes);
    assert_same(a->sun_azimuth_deg, b->sun_azimuth_deg);
    assert_same(a->sun_elevation_deg, b->sun_elevation_deg);
    assert_same(a->lux, b->lux);
    assert_same(a->angle_deg, b->angle_deg);
    assert_same(a->veil_cd_m2, b->veil_cd_m2);
}

static void assert_same_range(MeanInterval a, MeanInterval b)
{
    assert_same(a.low, b.low);
    assert_same(a.high, b.high);
}

static void assert_same_gaze(const GazeFinding *a, const GazeFinding *b)
{
    const double *v = &a->veil_parts.sun, *w = &b->veil_parts.sun;
    for (size_t i = 0; i < sizeof a->veil_parts / sizeof *v; i++) assert_same(v[i], w[i]);
    assert_same_text(a->condition, b->condition);
    assert_same_text(a->eye, b->eye);
    assert_same_text(a->gaze, b->gaze);
    assert_same_text(a->mirrored_by, b->mirrored_by);
    assert_same_text(a->mirrored_from, b->mirrored_from);
    assert_same(a->sun_deg, b->sun_deg);
    assert_same(a->veil, b->veil);
    assert_same(a->cornea_lux, b->cornea_lux);
    assert_same(a->through, b->through);
    assert_same(a->mirrored, b->mirrored);
    assert_same(a->contrast_behind_glass, b->contrast_behind_glass);
    assert_same(a->contrast_left, b->contrast_left);
    assert_same(a->dgp, b->dgp);
    assert_same(a->ugr, b->ugr);
    assert_same_range(a->veil_range, b->veil_range);
    assert_same_range(a->mirrored_range, b->mirrored_range);
    assert_same_range(a->contrast_range, b->contrast_range);
}

static void assert_same_review(const Review *a, const Review *b)
{
    assert_same_text(a->title, b->title);
    assert_same_text(a->profile, b->profile);
    assert_int_equal(a->pass, b->pass);
    assert_int_equal(a->is_strict, b->is_strict);
    assert_int_equal(a->case_count, b->case_count);
    assert_int_equal(a->sweep_count, b->sweep_count);
    assert_int_equal(a->response_count, b->response_count);
    assert_int_equal(a->note_count, b->note_count);
    for (int i = 0; i < a->case_count; i++) assert_same_case(&a->cases[i], &b->cases[i]);
    for (int i = 0; i < a->note_count; i++) assert_same_text(a->notes[i], b->notes[i]);
    for (int i = 0; i < a->sweep_count; i++) {
        assert_same_text(a->sweeps[i].condition, b->sweeps[i].condition);
        assert_same_text(a->sweeps[i].eye, b->sweeps[i].eye);
        assert_same_text(a->sweeps[i].symbol, b->sweeps[i].symbol);
        assert_same_text(a->sweeps[i].table, b->sweeps[i].table);
        assert_int_equal(a->sweeps[i].cases, b->sweeps[i].cases);
        assert_same(a->sweeps[i].failed_share, b->sweeps[i].failed_share);
        assert_same(a->sweeps[i].longest_failure_minutes, b->sweeps[i].longest_failure_minutes);
        assert_same_case(&a->sweeps[i].worst, &b->sweeps[i].worst);
    }
    assert_int_equal(a->false_sun_count, b->false_sun_count);
    for (int i = 0; i < a->false_sun_count; i++)
        assert_same_false_sun(&a->false_suns[i], &b->false_suns[i]);
    assert_int_equal(a->gaze_count, b->gaze_count);
    for (int i = 0; i < a->gaze_count; i++) assert_same_gaze(&a->gazes[i], &b->gazes[i]);
    for (int i = 0; i < a->response_count; i++) {
        assert_same_text(a->responses[i].probe, b->responses[i].probe);
        assert_same_text(a->responses[i].file, b->responses[i].file);
        assert_int_equal(a->responses[i].paths, b->responses[i].paths);
        assert_int_equal(a->responses[i].bytes, b->responses[i].bytes);
        assert_same(a->responses[i].relative_error, b->responses[i].relative_error);
    }
}

/* Read back it is the same to six digits, and written again the same to the byte. */
TEST(json_is_read_back)
{
    Review reviews[] = {fixture_review(&arena), fixture_odd_review(&arena),
                        {.title = "", .pass = true}};
    for (size_t i = 0; i < sizeof reviews / sizeof *reviews; i++) {
        const char *json = json_of(&reviews[i]);
        Review      again = read_back(json);
        assert_same_review(&reviews[i], &again);
        assert_string_equal(json_of(&again), json);
    }
}

/* Reached or not: what paths did not do stands beside what was asked. */
TEST(a_precision_that_was_not_reached_is_named)
{
    ReviewCase c = {.precision_asked = 0.01, .precision_reached = 0.0234};
    assert_string_equal(words_precision(&c, &arena), "; known within 2.3 %, 1.0 % was asked");
    c.precision_reached = 0.01;
    assert_string_equal(words_precision(&c, &arena), "");
    c.precision_asked = c.precision_reached = (double)NAN;
    assert_string_equal(words_precision(&c, &arena), "");
}

/* Scripts hold on to these keys. */
TEST(json_has_the_promised_keys)
{
    static const char *const KEYS[] = {
        "condition", "eye", "symbol", "display", "ambient", "sun", "luminance_cd_m2",
        "contrast_ratio", "contrast_interval", "reflected_interval", "paths_to_decide",
        "precision_asked", "precision_reached",
        "paths", "contrast_with_veil", "height_arcmin",
        "jnd", "visibility", "dgp", "ugr", "when", "visible_share", "hidden_by",
        "eye_failed_share", "level", "display_lux", "limit", "limits", "margin", "verdict",
        "causes", "remedies", "frame"};
    Review  review = fixture_review(&arena);
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
static void assert_refused(const char *from, const char *to, const char *path, const char *text)
{
    Review      review = fixture_review(&arena), out = {.title = "untouched"};
    Error       err = {0};
    const char *good = json_of(&review), *at = strstr(good, from);
    assert_non_null(at);
    const char *file = fresh_name();
    Text bad = {.arena = &arena};
    text_add_bytes(&bad, good, (size_t)(at - good));
    text_add(&bad, to);
    text_add(&bad, at + strlen(from));
    assert_true(text_write(&bad, file, &err));
    assert_false(review_json_read(file, &arena, &out, &err));
    remove(file);
    if (strcmp(err.path, path) != 0 || !strstr(err.text, text) || strcmp(err.file, file) != 0)
        fail_msg("%s: %s: %s", err.file, err.path, err.text);
    assert_string_equal(out.title, "untouched");
    assert_null(strchr(err.text, '\n'));
}

TEST(a_foreign_json_is_refused_in_one_line)
{
    assert_refused("\"pass\": false", "\"pass\": 1", "/pass", "wanted true or false");
    assert_refused("\"strict\": false,", "", "", "key 'strict' is missing");
    assert_refused("\"ambient\": \"night\"", "\"ambient\": \"nigth\"", "/cases/0/ambient",
                   "did you mean night?");
    assert_refused("\"contrast_interval\": [", "\"contrast_interval\": [7, ",
                   "/cases/0/contrast_interval", "wanted [low, high]");
    assert_refused("\"limit\": {", "\"limit\": {\"x\": 1, ", "/cases/0/limit",
                   "one of 'limits'");
    assert_refused("\"foreground\": ", "\"foreground\": \"\", \"x\": ",
                   "/cases/0/luminance_cd_m2/foreground", "is a text, wanted a number");
    assert_refused("\"chain\": [", "\"chain\": [4, ", "/cases/0/causes/0/chain", "only texts");
    assert_refused("\"hidden_by\": []", "\"hidden_by\": [{\"what\": 3}]",
                   "/cases/0/hidden_by/0/what", "wanted a text");
    assert_refused("\"cases\": [", "\"cases\": [null, ", "/cases/0", "wanted an object");
    assert_refused("\"pass\"", "pass", "line 2", "not valid JSON");
}

/* What was told later than reviews that may be held against this one. */
static bool is_optional(const char *key, const json_t *object)
{
    static const char *const ADDED[] = {"reflected_interval", "precision_asked",
                                        "precision_reached", "paths_to_decide", "cause_groups",
                                        "without_data_share", "without_data", "hidden_by",
                                        "eye_places"};
    for (size_t i = 0; i < sizeof ADDED / sizeof *ADDED; i++)
        if (!strcmp(key, ADDED[i])) return true;
    return !strcmp(key, "verdict") &&
           (json_object_get(object, "cases") || json_object_get(object, "worst"));
}

/* Takes each key of the object away, one at a time: the error names it. */
static int assert_keys_are_wanted(json_t *root, json_t *object)
{
    Error       err = {0};
    int         count = 0;
    Review      out;
    const char *path = fresh_name();
    json_t     *copy = json_copy(object), *value;
    const char *key;
    assert_true(json_is_object(object));
    json_object_foreach(copy, key, value) {
        if (is_optional(key, copy)) continue;
        json_object_del(object, key);
        assert_true(review_json_write(json_incref(root), path, &err));
        assert_false(review_json_read(path, &arena, &out, &err));
        if (!strstr(err.text, arena_format(&arena, "key '%s' is missing", key)))
            fail_msg("without %s: %s %s", key, err.path, err.text);
        json_object_set(object, key, value);
        count++;
    }
    json_decref(copy);
    remove(path);
    return count;
}

TEST(every_key_is_wanted)
{
    Review  review = fixture_review(&arena);
    json_t *root = review_json(&review);
    json_t *c = json_array_get(json_object_get(root, "cases"), 2);
    int     count = assert_keys_are_wanted(root, root) + assert_keys_are_wanted(root, c);
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
    json_t *all[] = {sweep, response, image, json_object_get(image, "sun"), gaze,
                     json_object_get(gaze, "veil_parts_cd_m2")};
    for (int i = 0; i < 6; i++) count += assert_keys_are_wanted(root, all[i]);
    assert_int_equal(count, 10 + 29 + 2 + 6 + 12 + 5 + 3 + 8 + 5 + 12 + 2 + 18 + 6);
    json_decref(root);
}

/* ---- JUnit ------------------------------------------------------------------------------ */

static int nodes_at(xmlXPathContextPtr context, const char *path)
{
    xmlXPathObjectPtr found = xmlXPathEvalExpression((const xmlChar *)path, context);
    assert_non_null(found);
    int count = found->nodesetval ? found->nodesetval->nodeNr : 0;
    xmlXPathFreeObject(found);
    return count;
}

static void assert_junit(const Review *review, int failures, int skipped)
{
    Error       err = {0};
    const char *path = fresh_name();
    assert_true(review_junit_write(review, path, &err));
    const char *xml = take(path);
    xmlDocPtr   document = xmlReadMemory(xml, (int)strlen(xml), "junit.xml", NULL,
                                         XML_PARSE_NONET);
    assert_non_null(document);
    xmlXPathContextPtr context = xmlXPathNewContext(document);
    assert_int_equal(nodes_at(context, "/testsuites/testsuite/testcase[@name and @classname]"),
                     review->case_count + review->sweep_count);
    assert_int_equal(nodes_at(context, "//testcase/failure[@message]"), failures);
    assert_int_equal(nodes_at(context, "//testcase/skipped[@message]"), skipped);
    assert_int_equal(nodes_at(context, arena_format(&arena, "//testsuite[@tests=%d and "
                                                    "@failures=%d and @skipped=%d]",
                                                    review->case_count + review->sweep_count,
                                                    failures, skipped)), 1);
    xmlXPathFreeContext(context);
    xmlFreeDoc(document);
}

TEST(junit_has_a_case_for_each)
{
    Review       odd = fixture_odd_review(&arena), plain = fixture_review(&arena), none = {0};
    ReviewCounts counts = review_count(&plain);
    int doubtful = counts.of[VERDICT_TOO_CLOSE] + counts.of[VERDICT_NOT_VISIBLE];
    assert_true(doubtful > 0);
    assert_junit(&plain, counts.of[VERDICT_FAIL], doubtful);
    plain.is_strict = true;
    assert_junit(&plain, counts.of[VERDICT_FAIL] + doubtful, 0);
    assert_junit(&odd, 2, 0); /* strict: the doubtful case and the sweep */
    assert_junit(&none, 0, 0);
}

/* ---- the answer ------------------------------------------------------------------------- */

static ReviewCase case_with(Verdict verdict, double margin)
{
    return (ReviewCase){.verdict = verdict, .margin = margin, .limit_id = -1};
}

TEST(a_review_passes_when_nothing_fails)
{
    static const bool PASSES[2][4] = {{true, false, true, true}, {true, false, false, false}};
    for (int strict = 0; strict < 2; strict++)
        for (int verdict = 0; verdict < 4; verdict++) {
            ReviewCase  list[2] = {case_with(VERDICT_PASS, 1),
                                   case_with((Verdict)verdict, NAN)};
            ReviewSweep sweep = {.worst = list[1], .failed_share = 0};
            Review      cases = {.cases = list, .case_count = 2, .is_strict = strict == 1};
            Review      sweeps = {.sweeps = &sweep, .sweep_count = 1, .is_strict = strict == 1};
            assert_int_equal(review_decide(&cases), PASSES[strict][verdict]);
            assert_int_equal(cases.pass, PASSES[strict][verdict]);
            assert_int_equal(review_decide(&sweeps), PASSES[strict][verdict]);
            sweep.failed_share = 1e-9; /* of its steps: the worst was read again */
            assert_int_equal(review_decide(&sweeps), PASSES[strict][verdict]);
        }
    Review none = {0};
    assert_true(review_decide(&none));
    assert_null(review_worst(&none, arena));
}

TEST(the_worst_comes_first)
{
    ReviewCase list[] = {
        case_with(VERDICT_PASS, NAN),  case_with(VERDICT_PASS, 0.1),
        case_with(VERDICT_TOO_CLOSE, 0.0), case_with(VERDICT_NOT_VISIBLE, NAN),
        case_with(VERDICT_FAIL, -0.2), case_with(VERDICT_FAIL, -0.7),
        case_with(VERDICT_FAIL, -0.2)};
    static const int  ORDER[] = {5, 4, 6, 3, 2, 1, 0};
    Review            review = {.cases = list, .case_count = 7};
    const ReviewCase **ranked = review_rank(&review, &arena);
    for (int i = 0; i < 7; i++) assert_ptr_equal(ranked[i], &list[ORDER[i]]);
    assert_ptr_equal(review_worst(&review, arena), &list[5]);
    /* A sweep stands where its worst does, whatever its steps say. */
    ReviewSweep sweep = {.worst = case_with(VERDICT_TOO_CLOSE, -0.1), .failed_share = 0.1};
    review.sweeps = &sweep;
    review.sweep_count = 1;
    assert_ptr_equal(review_rank(&review, &arena)[4], &sweep.worst);
}

/* Advice and what is not measured may say worse than the case, and are not its reason. */
TEST(the_reason_is_a_limit_that_counts)
{
    LimitVerdict limits[] = {
        {.name = "a", .verdict = VERDICT_PASS, .margin = 0.1},
        {.name = "b", .verdict = VERDICT_FAIL, .margin = -0.5, .is_advice = true},
        {.name = "c", .verdict = VERDICT_TOO_CLOSE, .margin = NAN},
        {.name = "d", .verdict = VERDICT_PASS, .margin = 0.05}};
    ReviewCase c = {.limits = limits, .limit_count = 4, .limit_id = 0, .verdict = VERDICT_PASS};
    assert_string_equal(case_worst_limit(&c)->name, "d");
    c.verdict = VERDICT_TOO_CLOSE;
    assert_string_equal(case_worst_limit(&c)->name, "c");
    c.verdict = VERDICT_FAIL;
    assert_string_equal(case_worst_limit(&c)->name, "a");
    c.limit_id = -1;
    assert_null(case_worst_limit(&c));
}

/* ---- differences ------------------------------------------------------------------------ */

TEST(a_review_differs_from_itself_in_nothing)
{
    Review     review = fixture_review(&arena);
    ReviewDiff diff = review_diff(&review, &review, "a", "b", &arena);
    assert_int_equal(diff.case_count, review.case_count);
    assert_int_equal(diff.count[DIFF_SAME],
                     review.case_count + review.sweep_count + review.gaze_count);
}

TEST(gazes_differ_by_the_contrast_that_is_left)
{
    static const DiffKind KINDS[] = {DIFF_WORSE, DIFF_SAME, DIFF_NEW, DIFF_GONE};
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    after.gazes[0].contrast_range.high = before.gazes[0].contrast_range.low * 0.999;
    after.gazes[1].contrast_range.high = before.gazes[1].contrast_range.low; /* they touch */
    after.gazes[2].gaze = "mirror";
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    json_t    *json = review_diff_json(&diff), *gazes = json_object_get(json, "gazes");
    assert_int_equal(diff.gaze_count, 4);
    for (int i = 0; i < 4; i++) assert_int_equal(diff.gazes[i].kind, KINDS[i]);
    json_t *gone = json_object_get(json_array_get(gazes, 3), "veil_cd_m2");
    assert_close(json_real_value(json_array_get(gone, 0)), before.gazes[2].veil, 1e-12);
    assert_true(json_is_null(json_array_get(gone, 1)));
    json_decref(json);
}

TEST(differences_are_named_and_come_first)
{
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    static const DiffKind KINDS[] = {DIFF_BROKEN, DIFF_MENDED, DIFF_WORSE, DIFF_BETTER,
                                     DIFF_GONE, DIFF_NEW};
    before.cases[4].verdict = VERDICT_PASS; /* to what it is, or was */
    after.cases[4].verdict = VERDICT_NOT_VISIBLE;
    before.cases[3].verdict = VERDICT_FAIL;
    after.cases[3].verdict = VERDICT_TOO_CLOSE;
    after.cases[2].contrast_high = before.cases[2].contrast_low * 0.999;
    after.cases[1].contrast_low = before.cases[1].contrast_high * 1.001;
    after.cases[0].contrast_low = before.cases[0].contrast_high * 0.999; /* they touch */
    after.cases[23].symbol = "renamed";
    after.sweeps[0].failed_share += 0.01;
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(diff.case_count, 25);
    for (int i = 0; i < 25; i++)
        assert_int_equal(diff.cases[i].kind, i < 6 ? KINDS[i] : DIFF_SAME);
    assert_ptr_equal(diff.cases[0].after, &after.cases[4]);
    assert_ptr_equal(diff.cases[1].before, &before.cases[3]);
    assert_null(diff.cases[4].after);
    assert_string_equal(diff.cases[5].after->symbol, "renamed");
    assert_int_equal(diff.sweeps[0].kind, DIFF_WORSE);
    assert_int_equal(diff.sweeps[1].kind, DIFF_SAME);
}

TEST(differences_as_json)
{
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    after.cases[3].contrast_ratio *= 2;
    after.cases[3].contrast_low *= 2;
    after.cases[3].contrast_high *= 2;
    after.case_count = 23;
    ReviewDiff diff = review_diff(&before, &after, "a<", "b", &arena);
    json_t *json = review_diff_json(&diff), *cases = json_object_get(json, "cases");
    json_t    *ratio = json_object_get(json_array_get(cases, 0), "contrast_ratio");
    assert_int_equal(json_array_size(cases), 24);
    assert_string_equal(json_string_value(json_object_get(json_array_get(cases, 0), "change")),
                        "better");
    assert_close(json_real_value(json_array_get(ratio, 1)),
                 2 * json_real_value(json_array_get(ratio, 0)), 1e-12);
    json_t *gone = json_array_get(cases, 1), *count = json_object_get(json, "count");
    assert_true(json_is_null(json_array_get(json_object_get(gone, "verdict"), 1)));
    assert_int_equal(json_integer_value(json_object_get(count, "gone")), 1);
    json_decref(json);
}

int main(void)
{
    arena = arena_reserve((size_t)2 << 30);
    return run_cases(NULL, NULL);
}
