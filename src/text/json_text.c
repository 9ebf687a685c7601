/* SPDX-License-Identifier: Apache-2.0 */
#include "text/json_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "print/printable.h"

json_t *json_text(const char *text) {
    json_t *string = json_string(text);
    if (string) return string;
    size_t size = printable_size(text);
    char *shown = malloc(size);
    if (shown) printable_copy(shown, size, text);
    string = json_string(shown ? shown : "");
    free(shown);
    return string;
}

json_t *json_text_or_null(const char *text) {
    return text ? json_text(text) : json_null();
}

json_t *json_texts(const char *const *texts, int count) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, json_text(texts[i]));
    return list;
}

json_t *json_figure(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_vector(Vec3 v) {
    return json_world_point((const double[3]){(double)v.x, (double)v.y, (double)v.z});
}

json_t *json_world_point(const double world_m[3]) {
    return json_pack("[f,f,f]", world_m[0], world_m[1], world_m[2]);
}

/* Outside of strings JSON has no character to escape but the ends of its lines. */
bool json_dump_text(Text *text, const json_t *value, size_t flags) {
    char *document = json_dumps(value, flags);
    if (!document) return false;
    for (const char *line = document; *line;) {
        size_t length = strcspn(line, "\n");
        text_add_printable(text, line, length);
        line += length;
        if (*line) text_add_bytes(text, line++, 1);
    }
    free(document);
    return true;
}

#define LINE_CHARS 92
#define INDENT 2
#define MOST_DIGITS 17 /* distinguish any two doubles */

/* Where a value stands: of its own lines, and how many letters stand before it in the first. */
typedef struct PrintPlace {
    int indent, column;
} PrintPlace;

typedef struct Printer {
    Text *text;
    JsonDigits digits;
} Printer;

static void print(const Printer *out, const json_t *value, PrintPlace place);
static void print_line(const Printer *out, const json_t *value);

/* A whole one keeps its point: it was none of JSON's integers. */
static void print_real(const Printer *out, double value) {
    char number[40];
    for (int digits = out->digits.digits; digits <= MOST_DIGITS; digits++) {
        snprintf(number, sizeof number, "%.*g", digits, value);
        double again = 0;
        number_read(number, &again);
        if (out->digits.is_cut || again == value) break;
    }
    text_add(out->text, number);
    if (!strpbrk(number, ".e")) text_add(out->text, ".0");
}

/* Texts, integers and words as jansson has them. */
static void print_scalar(const Printer *out, const json_t *value) {
    if (json_is_real(value)) print_real(out, json_real_value(value));
    else json_dump_text(out->text, value, JSON_ENCODE_ANY);
}

/* Returns its letters. */
static int print_key(const Printer *out, const char *key) {
    json_t *string = json_string(key);
    size_t before = out->text->size;
    print_scalar(out, string);
    text_add(out->text, ": ");
    json_decref(string);
    return (int)(out->text->size - before);
}

static void print_line_members(const Printer *out, const json_t *value) {
    const char *key, *between = "";
    json_t *item;
    size_t i;
    json_object_foreach((json_t *)value, key, item) {
        text_add(out->text, between);
        print_key(out, key);
        print_line(out, item);
        between = ", ";
    }
    json_array_foreach(value, i, item) {
        text_add(out->text, between);
        print_line(out, item);
        between = ", ";
    }
}

static void print_line(const Printer *out, const json_t *value) {
    if (!json_is_array(value) && !json_is_object(value)) {
        print_scalar(out, value);
        return;
    }
    text_add(out->text, json_is_object(value) ? "{" : "[");
    print_line_members(out, value);
    text_add(out->text, json_is_object(value) ? "}" : "]");
}

static void print_members(const Printer *out, const json_t *value, int indent) {
    const char *key, *between = "";
    json_t *item;
    size_t i;
    json_object_foreach((json_t *)value, key, item) {
        text_format(out->text, "%s\n%*s", between, indent, "");
        int letters = print_key(out, key);
        print(out, item, (PrintPlace){indent, indent + letters});
        between = ",";
    }
    json_array_foreach(value, i, item) {
        text_format(out->text, "%s\n%*s", between, indent, "");
        print(out, item, (PrintPlace){indent, indent});
        between = ",";
    }
}

/* A value too long for one line is taken back. The document itself always has several. */
static void print(const Printer *out, const json_t *value, PrintPlace place) {
    size_t before = out->text->size;
    bool is_scalar = !json_is_array(value) && !json_is_object(value);
    if (place.indent) {
        print_line(out, value);
        if (is_scalar || out->text->size - before + (size_t)place.column <= LINE_CHARS) return;
        out->text->size = before;
    }
    text_add(out->text, json_is_object(value) ? "{" : "[");
    print_members(out, value, place.indent + INDENT);
    text_format(out->text, "\n%*s%s", place.indent, "", json_is_object(value) ? "}" : "]");
}

void json_print(Text *text, const json_t *document, JsonDigits digits) {
    const Printer out = {text, digits};
    print(&out, document, (PrintPlace){0, 0});
    text_add(text, "\n");
}
