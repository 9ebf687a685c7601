/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_symbols.h"

#define SYMBOLS_MAX 1000
#define WITHS_MAX 100

bool request_polarity_read(const JsonView *view, const char *key, ReviewPolarity *out,
                           Error *err)
{
    static const char *const words[] = {
        [POLARITY_AUTO] = "auto",
        [POLARITY_LIGHT_ON_DARK] = "light-on-dark",
        [POLARITY_DARK_ON_LIGHT] = "dark-on-light",
    };
    int polarity = (int)*out;
    if (!field_choice(view, key, (FieldWords){words, COUNT_OF(words)}, &polarity, err))
        return false;
    *out = (ReviewPolarity)polarity;
    return true;
}

static bool read_rectangle(const JsonView *view, ReviewSymbol *symbol, Error *err)
{
    double uv[4] = {0, 0, 1, 1};
    if (!field_numbers(view, "uv", (JsonRange){0, 1, 4}, uv, &symbol->has_uv, err))
        return false;
    if (!(uv[0] < uv[2] && uv[1] < uv[3]))
        return field_fails(view, "uv", err,
                           "is [%g, %g, %g, %g], wanted [left, top, right, bottom] with left "
                           "below right and top below bottom",
                           uv[0], uv[1], uv[2], uv[3]);
    for (int i = 0; i < 4; i++) symbol->uv[i] = uv[i];
    return true;
}

static bool read_find(const JsonView *view, ReviewSymbol *symbol, Error *err)
{
    static const char *const words[] = {"text"};
    int word = NO_ID;
    if (!field_choice(view, "find", (FieldWords){words, 1}, &word, err)) return false;
    symbol->find_text = word == 0;
    if (symbol->find_text && symbol->mask)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has both 'find' and 'mask', wanted one of them");
    if (!symbol->find_text && !symbol->mask && !symbol->has_uv)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "says no place on its display, wanted 'uv', 'mask' or 'find'");
    return true;
}

static bool read_symbol(const FieldMembers *members, int i, ReviewSymbol *out, Error *err)
{
    static const char *const keys[] = {"display", "content", "uv", "mask", "polarity", "find"};
    JsonView     view;
    ReviewSymbol symbol = {.name = members->name[i]};
    if (!json_view_child(&members->view, symbol.name, true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_name(&view, "display", &symbol.display, err) ||
        !field_file(&view, "content", &symbol.content, err) ||
        !field_file(&view, "mask", &symbol.mask, err) ||
        !read_rectangle(&view, &symbol, err) ||
        !request_polarity_read(&view, "polarity", &symbol.polarity, err) ||
        !read_find(&view, &symbol, err))
        return false;
    *out = symbol;
    return true;
}

bool request_symbols_read(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_wanted(&reading->root, "symbols", err) ||
        !field_members(&reading->root, "symbols", SYMBOLS_MAX, &members, err))
        return false;
    request->symbols = ARENA_NEW(reading->root.arena, ReviewSymbol, members.count);
    request->symbol_count = members.count;
    for (int i = 0; i < members.count; i++)
        if (!read_symbol(&members, i, &request->symbols[i], err)) return false;
    return true;
}

bool request_withs_read(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_members(&reading->root, "with", WITHS_MAX, &members, err)) return false;
    request->withs = ARENA_NEW(reading->root.arena, ReviewWith, members.count);
    request->with_count = members.count;
    for (int i = 0; i < members.count; i++) {
        ReviewWith *with = &request->withs[i];
        with->name = members.name[i];
        if (!field_files(&members.view, with->name, &with->paths, &with->path_count, err))
            return false;
    }
    return true;
}
