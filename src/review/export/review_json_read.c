/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_json_read.h"

#include <math.h>
#include <string.h>

#include "review/output/review_members.h"
#include "text/json_view.h"
#include "text/nearest_word.h"

static bool wrong(const JsonView *view, const char *key, const char *wanted, Error *err)
{
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key), "required: %s",
                    wanted);
}

static bool read_pair(const JsonView *view, const char *key, double out[2], Error *err)
{
    json_t *list = json_object_get(view->object, key);
    if (!json_is_array(list) || json_array_size(list) != 2)
        return wrong(view, key, "[low, high]", err);
    for (size_t i = 0; i < 2; i++) {
        json_t *value = json_array_get(list, i);
        if (!json_is_number(value) && !json_is_null(value))
            return wrong(view, key, "two numbers or null", err);
        out[i] = json_is_null(value) ? NAN : json_number_value(value);
    }
    return true;
}

static bool read_count(const JsonView *view, const char *key, long *out, Error *err)
{
    json_t *value = json_object_get(view->object, key);
    if (!json_is_integer(value) || json_integer_value(value) < 0)
        return wrong(view, key, "a whole number, 0 or more", err);
    *out = (long)json_integer_value(value);
    return true;
}

/* Reviews before there were four outcomes. */
static const char *now_called(const char *word)
{
    return !strcmp(word, "not visible") ? verdict_names[VERDICT_UNJUDGED] : word;
}

/* *out is the word's place. */
static bool read_word(const JsonView *view, const char *key, const char *const *words,
                      int count, int *out, Error *err)
{
    const char *word = NULL;
    char        advice[256];
    if (!json_is_null(json_object_get(view->object, key)) &&
        !json_view_text(view, key, &word, err))
        return false;
    for (int i = 0; word && i < count; i++) {
        if (strcmp(now_called(word), words[i]) != 0) continue;
        *out = i;
        return true;
    }
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                    "is '%.60s'; %s", word ? word : "null",
                    nearest_word_advice(word ? word : "", words, count, advice, sizeof advice));
}

static bool read_object(const JsonView *view, const Member *table, void *item, Error *err);

/* An array of objects; each has its index in its path. */
static bool read_list(const JsonView *view, const Member *member, void **out, int *count,
                      Error *err)
{
    json_t *list = json_object_get(view->object, member->key);
    if (!json_is_array(list)) return wrong(view, member->key, "an array of objects", err);
    size_t size = json_array_size(list);
    char  *items = arena_alloc(view->arena, member->size, _Alignof(max_align_t), size);
    for (size_t i = 0; i < size; i++) {
        JsonView item = *view;
        item.object = json_array_get(list, i);
        item.path = arena_format(view->arena, "%s/%s/%zu", view->path, member->key, i);
        if (!json_is_object(item.object))
            return error_at(err, ERROR_INPUT, item.file, item.path, "required: an object");
        if (!read_object(&item, member->of, items + i * member->size, err)) return false;
    }
    *out = items;
    *count = (int)size;
    return true;
}

static bool read_texts(const JsonView *view, const char *key, void **out, int *count,
                       Error *err)
{
    json_t *list = json_object_get(view->object, key);
    if (!json_is_array(list)) return wrong(view, key, "an array of texts", err);
    size_t       size = json_array_size(list);
    const char **texts = ARENA_NEW(view->arena, const char *, size);
    for (size_t i = 0; i < size; i++) {
        json_t *text = json_array_get(list, i);
        if (!json_is_string(text)) return wrong(view, key, "only texts", err);
        texts[i] = arena_string(view->arena, json_string_value(text),
                                json_string_length(text));
    }
    *out = texts;
    *count = (int)size;
    return true;
}

/* "limit" repeats one of "limits": the first that is equal. */
static bool read_limit_id(const JsonView *view, ReviewCase *c, Error *err)
{
    json_t *limit = json_object_get(view->object, "limit");
    json_t *limits = json_object_get(view->object, "limits");
    c->limit_id = -1;
    if (json_is_null(limit) || !json_is_array(limits)) return true; /* limits are read, too */
    for (size_t i = 0; i < json_array_size(limits) && c->limit_id < 0; i++)
        if (json_equal(limit, json_array_get(limits, i))) c->limit_id = (int)i;
    return c->limit_id >= 0 || wrong(view, "limit", "one of 'limits', or null", err);
}

/* Figures that are not there are NaN. */
static void clear_figures(const Member *table, void *item)
{
    for (const Member *member = table; member->key; member++) {
        double *at = (void *)((char *)item + member->offset);
        bool    is_range = member->kind == MEMBER_RANGE;
        if (member->use == WRITTEN) continue;
        if (is_range || member->kind == MEMBER_FIGURE) at[0] = at[is_range] = (double)NAN;
    }
}

/* NULL stands for what can be judged, and is not read. */
static bool read_reason(const JsonView *view, const char *key, Unjudged *out, Error *err)
{
    const char *word = NULL;
    if (!json_view_text(view, key, &word, err)) return false;
    for (int i = UNJUDGED_NOT + 1; word && i < UNJUDGED_COUNT; i++) {
        if (strcmp(word, unjudged_names[i]) != 0) continue;
        *out = (Unjudged)i;
        return true;
    }
    return wrong(view, key, "a reason why it cannot be judged", err);
}

/* A member that is there, but not null. */
static bool read_value(const JsonView *view, const Member *member, void *item, Error *err)
{
    void       *at = (char *)item + member->offset, *list = NULL;
    void       *count = (char *)item + member->count;
    const char *key = member->key;
    int         word = 0;
    JsonView    inside;
    switch (member->kind) {
    case MEMBER_FIGURE: return json_view_number(view, key, -HUGE_VAL, HUGE_VAL, at, err);
    case MEMBER_TEXT: return json_view_text(view, key, at, err);
    case MEMBER_RANGE: return read_pair(view, key, at, err);
    case MEMBER_FLAG:
        *(bool *)at = json_is_true(json_object_get(view->object, key));
        return json_is_boolean(json_object_get(view->object, key)) ||
               wrong(view, key, "true or false", err);
    case MEMBER_COUNT: return read_count(view, key, at, err);
    case MEMBER_VERDICT:
        if (!read_word(view, key, verdict_names, 4, &word, err)) return false;
        *(Verdict *)at = (Verdict)word;
        return true;
    case MEMBER_REASON: return read_reason(view, key, at, err);
    case MEMBER_OPEN:
        if (!read_word(view, key, open_names + 1, OPEN_COUNT - 1, &word, err)) return false;
        *(OpenBy *)at = (OpenBy)(word + 1);
        return true;
    case MEMBER_AMBIENT:
        if (!read_word(view, key, ambient_names, 4, &word, err)) return false;
        *(Ambient *)at = (Ambient)word;
        return true;
    case MEMBER_WORD: return read_word(view, key, member->words, (int)member->size, at, err);
    case MEMBER_IF: *(bool *)count = true; /* fall through */
    case MEMBER_OBJECT:
        return json_view_child(view, key, true, &inside, err) &&
               read_object(&inside, member->of, at, err);
    case MEMBER_TEXTS:
    case MEMBER_LIST:
        if (!(member->of ? read_list(view, member, &list, count, err)
                         : read_texts(view, key, &list, count, err)))
            return false;
        memcpy(at, &list, sizeof list);
        return true;
    default: return read_limit_id(view, item, err);
    }
}

static bool may_be_null(MemberKind kind)
{
    return kind == MEMBER_FIGURE || kind == MEMBER_TEXT || kind == MEMBER_IF ||
           kind == MEMBER_REASON || kind == MEMBER_OPEN;
}

/* The item is all zeros. Keys of a later version are passed over. */
static bool read_object(const JsonView *view, const Member *table, void *item, Error *err)
{
    clear_figures(table, item);
    for (const Member *member = table; member->key; member++) {
        const json_t *value = json_object_get(view->object, member->key);
        if (member->use == WRITTEN || (!value && member->use == SINCE)) continue;
        if (!value)
            return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing",
                            member->key);
        if (json_is_null(value) && may_be_null(member->kind)) {
            if (member->kind == MEMBER_IF)
                clear_figures(member->of, (char *)item + member->offset);
            continue;
        }
        if (!read_value(view, member, item, err)) return false;
    }
    return true;
}

bool review_json_read(const char *file, Arena *arena, Review *out, Error *err)
{
    JsonView root;
    Review   review = {0};
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = read_object(&root, review_members, &review, err);
    review.is_partial = json_is_true(json_object_get(root.object, "provisional"));
    json_view_close(&root);
    if (ok) *out = review;
    return ok;
}
