/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_values.h"

#include "page/page.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"

json_t *values_list(json_t *to, const char *name)
{
    json_t *list = json_array();
    json_object_set_new(to, name, list);
    return list;
}

json_t *values_object(json_t *to, const char *name)
{
    json_t *object = json_object();
    json_object_set_new(to, name, object);
    return object;
}

json_t *values_of_sweep(const PageValues *v, const ReviewSweep *s)
{
    return json_array_get(json_object_get(v->doc, "sweeps"), (size_t)(s - v->review->sweeps));
}

json_t *values_of_case(const PageValues *v, const ReviewCase *c)
{
    const ReviewSweep *sweep = review_sweep_of(v->review, c);
    if (sweep) return json_object_get(values_of_sweep(v, sweep), "worst");
    return json_array_get(json_object_get(v->doc, "cases"), (size_t)(c - v->review->cases));
}

void values_add_case(const PageValues *v, json_t *list, const ReviewCase *c)
{
    if (c) json_array_append(list, values_of_case(v, c));
    else page_set(page_add(list), "link", NULL);
}

void values_set_verdict(json_t *to, Verdict verdict)
{
    page_set(to, "class", words_class(verdict));
    page_set(to, "mark", words_mark(verdict));
    page_set(to, "outcome", words_verdict(verdict));
    page_set_flag(to, "passes", verdict == VERDICT_PASS);
}

void values_set_names(json_t *to, const char *const *keys)
{
    for (; *keys; keys++) {
        const char *name = json_string_value(json_object_get(to, *keys));
        if (!name || !*name) page_set(to, *keys, "?");
    }
}
