/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/answer.h"

#include <string.h>

#include "compare/headline.h"
#include "compare/report/comparison_json.h"
#include "page/page.h"
#include "text/json_text.h"

#define NAMED 8

void answer_start(CompareAnswer *answer) {
    *answer = (CompareAnswer){.pairs = json_array()};
}

void answer_release(CompareAnswer *answer) {
    json_decref(answer->pairs);
    *answer = (CompareAnswer){0};
}

static json_t *add(CompareAnswer *answer, json_t *pair) {
    answer->count++;
    json_array_append_new(answer->pairs, pair);
    return pair;
}

json_t *answer_add(CompareAnswer *answer, const char *name, const Comparison *c) {
    answer->different += !c->same;
    return add(answer, comparison_json(c, name));
}

/* A pair without a comparison. */
static json_t *no_pair(const char *name, const char *outcome, const char *verdict) {
    return json_pack("{s:o, s:b, s:s, s:o, s:[o], s:[], s:[], s:f}", "name", json_text(name),
                     "same", 0, "outcome", outcome, "verdict", json_text(verdict), "reasons",
                     json_text(verdict), "notes", "rows", "seconds", 0.0);
}

json_t *answer_add_missing(CompareAnswer *answer, const char *name, bool is_in_test) {
    Arena arena = arena_reserve((size_t)1 << 20);
    const char *verdict = arena_format(
        &arena, "%s: %s", headline_name(name, &arena),
        is_in_test ? "only in the test (--allow-extra lets that pass)" : "missing in the test");
    answer->different++;
    json_t *pair = add(answer, no_pair(name, "missing", verdict));
    arena_release(&arena);
    return pair;
}

json_t *answer_add_failed(CompareAnswer *answer, const char *name, const char *line,
                          const Error *error) {
    json_t *pair = no_pair(name, "failed", line);
    answer->failed++;
    json_object_set_new(pair, "error",
                        json_pack("{s:i, s:o, s:o}", "status", error_exit_status(error->code),
                                  "file", json_text(error->file), "message",
                                  json_text(error->text)));
    return add(answer, pair);
}

/* ---- all of them ------------------------------------------------------------------------- */

static const char *text_of(const json_t *pair, const char *key) {
    return json_string_value(json_object_get(pair, key));
}

/* The worst of all pairs' outcomes; of those that do not pass "different", unless all failed. */
static const char *outcome_of(const CompareAnswer *answer) {
    size_t i;
    json_t *pair;
    int worst = COMPARE_SAME;
    if (answer->different || answer->failed) return answer->different ? "different" : "failed";
    json_array_foreach(answer->pairs, i, pair) {
        while (strcmp(text_of(pair, "outcome"), compare_outcome_names[worst]) != 0 &&
               worst < COMPARE_WITHIN_LIMITS)
            worst++;
    }
    return compare_outcome_names[worst];
}

/* The pairs of one outcome; names: of those that do not pass. */
static const char *count_text(const CompareAnswer *answer, const char *outcome, bool names,
                              Arena *arena) {
    Lines list = {.arena = arena};
    size_t i;
    json_t *pair;
    json_array_foreach(answer->pairs, i, pair) {
        if (!strcmp(text_of(pair, "outcome"), outcome))
            lines_add(&list, "%s", text_of(pair, "name"));
    }
    if (!list.count) return "";
    return arena_format(arena, ", %d %s%s%s%s", list.count, outcome, names ? " (" : "",
                        names ? structure_joined(&list, NAMED) : "", names ? ")" : "");
}

/* The inputs that changed, of all pairs together. */
static const char *inputs_text(const CompareAnswer *answer, Arena *arena) {
    Lines list = {.arena = arena};
    size_t i, k;
    json_t *pair, *input;
    json_array_foreach(answer->pairs, i, pair) {
        json_array_foreach(json_object_get(pair, "inputs_changed"), k, input) {
            const char *name = json_string_value(input);
            int at = 0;
            while (at < list.count && strcmp(list.list[at], name) != 0) at++;
            if (at == list.count) lines_put(&list, name);
        }
    }
    return list.count ? arena_format(arena, ". Inputs changed: %s", structure_joined(&list, NAMED))
                      : "";
}

/* "2 of 4 pairs pass: 2 same, 1 different (noon.exr), 1 missing (night.exr)" */
static const char *headline_of(const CompareAnswer *answer, Arena *arena) {
    int passed = answer->count - answer->different - answer->failed;
    const char *text = "";
    for (int k = 0; k < COMPARE_DIFFERENT; k++)
        text = arena_format(arena, "%s%s", text,
                            count_text(answer, compare_outcome_names[k], false, arena));
    static const char *const OTHERS[] = {"different", "missing", "failed"};
    for (int k = 0; k < 3; k++)
        text = arena_format(arena, "%s%s", text, count_text(answer, OTHERS[k], true, arena));
    return arena_format(arena, "%d of %d pairs pass: %s%s", passed, answer->count, text + 2,
                        inputs_text(answer, arena));
}

json_t *answer_json(const CompareAnswer *answer, Arena scratch) {
    int passed = answer->count - answer->different - answer->failed;
    return json_pack("{s:b, s:s, s:o, s:i, s:i, s:i, s:i, s:O}", "same", passed == answer->count,
                     "outcome", outcome_of(answer), "verdict",
                     json_text(headline_of(answer, &scratch)), "total", answer->count, "equal",
                     passed, "different", answer->different, "failed", answer->failed, "pairs",
                     answer->pairs);
}

bool answer_write_junit(const CompareAnswer *answer, const char *path, Error *err) {
    double seconds = 0;
    size_t i;
    json_t *pair, *values = json_object();
    json_array_foreach(answer->pairs, i, pair) {
        seconds += json_number_value(json_object_get(pair, "seconds"));
    }
    json_object_set(values, "pairs", answer->pairs);
    json_object_set_new(values, "seconds", json_real(seconds));
    page_set(values, "version", PARHELION_VERSION);
    page_set_count(values, "failures", answer->different);
    page_set_count(values, "errors", answer->failed);
    page_set_count(values, "count", answer->count);
    return page_write_values("compare_junit.xml", values, NULL, path, err);
}
