/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/junit.h"

#include <math.h>

#include "page/page.h"
#include "text/json_text.h"

void junit_start(Junit *junit) {
    *junit = (Junit){.cases = json_array()};
}

void junit_release(Junit *junit) {
    json_decref(junit->cases);
    *junit = (Junit){0};
}

static json_t *add_case(Junit *junit, const char *name, double seconds) {
    json_t *to = page_add(junit->cases);
    page_set(to, "name", name);
    json_object_set_new(to, "time", json_real(seconds));
    junit->seconds += seconds;
    return to;
}

static json_t *metrics_values(const Comparison *c) {
    json_t *list = json_array();
    for (int i = 0; i < METRIC_COUNT; i++)
        if (isfinite(c->value[i]))
            json_array_append_new(list,
                                  json_pack("{s:s, s:f}", "metric", metric_info((Metric)i)->name,
                                            "value", c->value[i]));
    return list;
}

void junit_add(Junit *junit, const char *name, const Comparison *c) {
    json_t *to = add_case(junit, name, c->seconds);
    junit->failures += !c->same;
    page_set(to, "verdict", c->verdict);
    page_set(to, "mean", c->mean);
    page_set_flag(to, "is_compared", true);
    page_set_flag(to, "has_pixels", c->has_pixels);
    page_set_flag(to, "same", c->same);
    json_object_set_new(to, "metrics", metrics_values(c));
    json_object_set_new(to, "reasons", json_texts(c->reasons.list, c->reasons.count));
    json_object_set_new(to, "notes", json_texts(c->notes.list, c->notes.count));
}

void junit_add_failure(Junit *junit, const char *name, const char *why, bool is_error) {
    page_set(add_case(junit, name, 0), is_error ? "unreadable" : "missing", why);
    junit->errors += is_error;
    junit->failures += !is_error;
}

bool junit_write(const Junit *junit, const char *suite, const char *path, Error *err) {
    json_t *values = json_pack("{s:i, s:i, s:f, s:O?}", "failures", junit->failures, "errors",
                               junit->errors, "seconds", junit->seconds, "cases", junit->cases);
    page_set(values, "version", PARHELION_VERSION);
    page_set(values, "suite", suite);
    page_set_count(values, "count", (long)json_array_size(junit->cases));
    return page_write_values("compare_junit.xml", values, NULL, path, err);
}
