/* SPDX-License-Identifier: Apache-2.0 */
/* What a comparison has to do and what it answers: options, JSON, JUnit, HTML. */
#include "compare_fixture.h"

#include <libxml/parser.h>

#include "base/file_write.h"
#include "cli/compare_request.h"
#include "compare/report/comparison_json.h"
#include "compare/report/html_report.h"
#include "compare/report/answer.h"
#include "text/base64.h"
#include "text/text.h"

/* ---- answers ----------------------------------------------------------------------------- */

static const char WILD[] = "a<b>&\"'\x01\xff]]>\xef\xbf\xbf.png";

ARENA_TEST(markup_escapes_and_encodes) {
    Text text = {.arena = &arena};
    escape_markup(&text, WILD);
    text_add(&text, " ");
    escape_markup(&text, "é…\xf0\x9f\x98\x80\xc0\x80");
    const char wanted[] = "a&lt;b&gt;&amp;&quot;&#39;\\u0001\\xFF]]&gt;\\uFFFF.png é…"
                          "\xf0\x9f\x98\x80\\xC0\\x80";
    assert_int_equal(text.size, sizeof wanted - 1);
    assert_memory_equal(text.data, wanted, sizeof wanted - 1);
    static const char *const PAIRS[][2] = {
        {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}};
    for (int i = 0; i < 5; i++) { /* RFC 4648, section 10 */
        text = (Text){.arena = &arena};
        base64_encode(&text, PAIRS[i][0], strlen(PAIRS[i][0]));
        assert_int_equal(text.size, strlen(PAIRS[i][1]));
        assert_memory_equal(text.data, PAIRS[i][1], strlen(PAIRS[i][1]));
    }
}

ARENA_TEST(junit_is_well_formed_whatever_the_names_are) {
    CompareInput a = picture_input(WILD, 8, &arena), b = picture_input("b", 8, &arena);
    ((float *)b.codes.rgb[0])[3] = 1;
    Comparison same = compared(&a, &a, LOOSE, &arena);
    Comparison other = compared(&a, &b, (CompareOptions){.groups = GROUP_MSE}, &arena);
    CompareAnswer answer;
    Error broken = {.code = ERROR_INPUT, .file = "", .text = ""};
    answer_start(&answer);
    const char *path = in_folder("j.xml");
    answer_add(&answer, WILD, &same);
    answer_add(&answer, WILD, &other);
    answer_add_failed(&answer, WILD, WILD, &broken);
    answer_add_missing(&answer, WILD, false);
    assert_done(answer_write_junit(&answer, path, &err));
    xmlDoc *document = xmlReadFile(path, NULL, XML_PARSE_NOERROR | XML_PARSE_NONET);
    assert_non_null(document);
    xmlNode *suite = xmlFirstElementChild(xmlDocGetRootElement(document));
    xmlChar *tests = xmlGetProp(suite, (const xmlChar *)"tests");
    xmlChar *failures = xmlGetProp(suite, (const xmlChar *)"failures");
    assert_string_equal((const char *)tests, "4");
    assert_string_equal((const char *)failures, "2");
    xmlFree(tests);
    xmlFree(failures);
    xmlFreeDoc(document);
    xmlCleanupParser();
    unlink(path);
    assert_fails_as(answer_write_junit(&answer, "/absent/j.xml", &err), ERROR_OUTPUT, "");
    answer_release(&answer);
}

ARENA_TEST(json_has_the_promised_keys) {
    CompareInput a = picture_input(WILD, 8, &arena), b = picture_input("b", 8, &arena);
    CompareOptions options = {.threads = 1};
    ((float *)b.codes.rgb[0])[3] = 1;
    Comparison c = compared(&a, &b, options, &arena);
    json_auto_t *json = comparison_json(&c, "b");
    json_t *metrics = json_object_get(json, "metrics");
    static const char *const KEYS[] = {"flip",        "flip_p95",   "flip_max",   "psnr", "ssim",
                                       "deltae_mean", "deltae_p95", "deltae_max", "mse",  "relmse",
                                       "mae",         "mean_shift", "differing"};
    for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; i++)
        if (!json_is_number(json_object_get(metrics, KEYS[i]))) fail_msg("no %s", KEYS[i]);
    assert_true(json_is_false(json_object_get(json, "same")));
    assert_int_equal(json_array_size(json_object_get(json, "reasons")), 1);
    assert_string_equal(json_string_value(json_object_get(json, "judged_by")), "equality");
}

/* Whatever a name holds, it stands in the page as text; both sides and three maps are there. */
ARENA_TEST(a_report_is_whole_and_escaped) {
    FileBytes page;
    CompareOptions options = {.threads = 1};
    CompareInput a = picture_input(WILD, 8, &arena), b = picture_input("b", 8, &arena);
    ((float *)b.codes.rgb[0])[3] = ((float *)b.light.rgb[0])[3] = 1;
    Comparison c = compared(&a, &b, options, &arena);
    const char *path = in_folder("r.html");
    HtmlReport report;
    html_report_start(&report, false);
    json_auto_t *pair = comparison_json(&c, "b");
    assert_done(html_report_add(&report, pair, &c, arena, &err));
    assert_done(html_report_write(&report, NULL, (const char *const[2]){WILD, WILD}, path, &err));
    assert_done(file_read(path, 1 << 24, &arena, &page, &err));
    const char *text = (const char *)page.data;
    assert_null(strstr(text, "a<b>"));
    assert_non_null(strstr(text, "a&lt;b&gt;&amp;"));
    int pictures = 0;
    for (const char *p = text; (p = strstr(p, "src=\"data:image/png;base64,")); p++) pictures++;
    assert_int_equal(pictures, 5);
    assert_non_null(strstr(text, "<b>different</b>: B: 1 of 96 pixels differs, pixel 3,0: "));
    html_report_release(&report);
    unlink(path);
    assert_done(html_report_check_name("a.HTML", &err));
    assert_fails(html_report_check_name("a.xml", &err), "");
}

/* ---- the command line -------------------------------------------------------------------- */

static void refused(const char *word, const char *value, const char *part) {
    Arena arena = arena_reserve(ARENA_BYTES);
    Error err = {0};
    CompareRequest request = {0};
    char *argv[] = {(char *)"compare", (char *)"a", (char *)"b", (char *)word, (char *)value};
    assert_false(compare_parse(5, argv, &arena, &request, &err));
    assert_int_equal(err.code, ERROR_USAGE);
    if (!strstr(err.text, part)) fail_msg("\"%s\" lacks \"%s\"", err.text, part);
    arena_release(&arena);
}

TEST(wrong_options_say_what_is_wanted) {
    refused("--max", "flop=1", "there is no figure flop — did you mean flip?");
    refused("--max", "qqqqqqqq=1", "there are flip, flip_median,");
    refused("--max", "flip", "required: NAME=VALUE");
    refused("--max", "flip=x", "x is no number");
    refused("--max", "flip=nan", "nan is no number");
    refused("--max", "psnr=30", "psnr is the better the greater it is — say --min psnr=30");
    refused("--min", "flip=0", "flip is the better the smaller it is — say --max flip=0");
    refused("--metric", "flips", "did you mean flip?");
    refused("--metric", "mse,flips", "did you mean flip?");
    refused("--region", "0,0,1.5,9", "1.5 is no whole number");
    refused("--region", "0,0,9", "required X0,Y0,X1,Y1");
    refused("--region", "0,0,99999,9", "99999 is no whole number of pixels from -65536");
    refused("--exposure-range", "9,3", "--exposure-range 9,3: required: A,B with A <= B");
    refused("--exposure", "bright", "--exposure bright");
    refused("--report", "x.txt", "required: a name that ends in .html");
    refused("--level", "0", "--level");
}

ARENA_TEST(a_line_is_cut_into_words_as_a_shell_does) {
    static const char *const LINES[][2] = {{"", ""},
                                           {" \t ", ""},
                                           {"a  b\tc ", "a|b|c"},
                                           {"a'b c'd", "ab cd"},
                                           {"\"a \\\" \\\\ \\x\" ''", "a \" \\ \\x|"},
                                           {"a\\ b\\'", "a b'"},
                                           {"$HOME * ~ #no", "$HOME|*|~|#no"},
                                           {"\"'\"'\"'\r", "'\""}};
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) {
        Lines words = {.arena = &arena};
        Text joined = {.arena = &arena};
        assert_true(shell_words(LINES[i][0], &words));
        text_add(&joined, "");
        for (int k = 0; k < words.count; k++) text_format(&joined, "|%s", words.list[k]);
        assert_string_equal(words.count ? joined.data + 1 : "", LINES[i][1]);
    }
    static const char *const OPEN[] = {"'", "a \"b", "\"\\\"", "a\\"};
    Lines words = {.arena = &arena};
    for (size_t i = 0; i < sizeof OPEN / sizeof *OPEN; i++)
        assert_false(shell_words(OPEN[i], &words));
}

static const ComparePair *pair_of(const char *line, const char *const *more, Arena *arena) {
    CompareRequest *r = ARENA_NEW(arena, CompareRequest, 1);
    const char *path = in_folder("pairs");
    const char *argv[16] = {"compare", "a", "b", "--pairs", path};
    int argc = 5;
    for (; *more; more++) argv[argc++] = *more;
    assert_done(file_write(path, line, strlen(line), &err));
    assert_done(compare_parse(argc, (char **)argv, arena, r, &err));
    assert_int_equal(r->pair_count, 1);
    unlink(path);
    return &r->pairs[0];
}

/* What a pair does not say is as for all; its limits replace theirs of the same figures. */
ARENA_TEST(a_pair_takes_what_it_does_not_say_from_all) {
    static const char *const ALL[] = {"--max",    "flip=0.5", "--max",    "mae=2",
                                      "--level",  "0.02",     "--ignore", "seed",
                                      "--region", "1,2,3,4",  NULL};
    const CompareOptions *o = &pair_of("# none\n\nnoon", ALL, &arena)->options;
    assert_true(o->wants_stat && o->level == 0.02 && o->threshold_count == 2);
    assert_int_equal(o->selection.region_count, 1);
    o = &pair_of("noon --max flip=0.1 --min ssim=0.9 --region 0,0,1,1 --region 2,2,3,3 "
                 "--ignore isa --mask 'a b.png'",
                 ALL, &arena)
             ->options;
    assert_true(!o->wants_stat && o->level == 0.02);
    assert_int_equal(o->threshold_count, 3);
    assert_true(o->thresholds[0].metric == METRIC_FLIP && o->thresholds[0].limit == 0.1);
    assert_true(o->thresholds[2].metric == METRIC_MAE && o->thresholds[2].limit == 2);
    assert_int_equal(o->selection.region_count, 2);
    assert_int_equal(o->selection.regions[1].x0, 2);
    assert_string_equal(o->selection.mask, "a b.png");
    assert_int_equal(o->rules.ignored_count, 2);
    o = &pair_of("noon --max flip=0.1 --level 0.3 --metric mse", ALL, &arena)->options;
    assert_true(o->wants_stat && o->level == 0.3 && o->groups == GROUP_MSE);
}

ARENA_TEST(limits_and_lists_are_read) {
    CompareRequest r = {0};
    const char *argv[] = {"compare",  "a",        "b",        "--max",
                          "flip=0.5", "--min",    "ssim=0.9", "--max",
                          "mae=2",    "--metric", "mse,psnr", "--ignore",
                          "seed",     "--region", "1,2,3,4",  "--exposure-range",
                          "3,9"};
    assert_done(compare_parse(sizeof argv / sizeof *argv, (char **)argv, &arena, &r, &err));
    assert_int_equal(r.options.threshold_count, 3);
    assert_int_equal(r.options.thresholds[1].metric, METRIC_MAE);
    assert_int_equal(r.options.thresholds[2].metric, METRIC_SSIM);
    assert_int_equal(r.options.groups, GROUP_MSE | GROUP_PSNR);
    assert_false(r.options.wants_stat);
    assert_int_equal(r.options.selection.regions[0].y1, 4);
    assert_true(r.options.has_range && r.options.range_ev[1] == 9);
    assert_string_equal(r.options.rules.ignored[0], "seed");
    const char *stat[] = {"compare", "a", "b", "--metric", "stat"};
    r = (CompareRequest){0};
    assert_done(compare_parse(5, (char **)stat, &arena, &r, &err));
    assert_true(r.options.wants_stat);
}

TEST_PROGRAM(make_folder, remove_folder)
