/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/answer.h"

#include <stdio.h>
#include <string.h>

#include "print/print.h"
#include "text/json_text.h"

#define DOCUMENT_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */

static bool write_document(Text *text, const json_t *document) {
    bool is_whole = json_dump_text(text, document, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    text_add(text, "\n");
    return is_whole;
}

bool cli_write_json(const json_t *document, const char *path, Error *err) {
    Arena arena = arena_reserve(DOCUMENT_BYTES);
    Text text = {.arena = &arena};
    bool done = write_document(&text, document)
                    ? text_write(&text, path, err)
                    : error_at(err, ERROR_OUTPUT, path, NULL, "holds no JSON");
    arena_release(&arena);
    return done;
}

bool cli_print_json(json_t *document, Error *err) {
    Arena arena = arena_reserve(DOCUMENT_BYTES);
    Text text = {.arena = &arena};
    bool is_whole = write_document(&text, document);
    if (is_whole) print_own(stdout, text.data);
    arena_release(&arena);
    json_decref(document);
    return is_whole || error_at(err, ERROR_OUTPUT, "stdout", NULL, "no document could be made");
}

bool cli_print_answer(const TableKind *kind, json_t *document, bool as_json, Error *err) {
    if (as_json) return cli_print_json(document, err);
    Arena arena = arena_reserve(DOCUMENT_BYTES);
    Text text = {.arena = &arena};
    table_add_document(kind, document, &text);
    if (text.size) print_own(stdout, text.data);
    arena_release(&arena);
    json_decref(document);
    return true;
}

void cli_error_line(const Error *error, char *buffer, int size) {
    const char *advice = strstr(error->text, " — ");
    int length = advice ? (int)(advice - error->text) : (int)strlen(error->text);
    bool has_path = error->path[0] != '\0';
    snprintf(buffer, (size_t)size, "parhelion: %s%s%.*s%s%s%s%s", error->file,
             error->file[0] ? ": " : "", length, error->text, has_path ? " (" : "", error->path,
             has_path ? ")" : "", advice ? advice : "");
}

void cli_report_error(const Error *error, bool json) {
    char line[2048];
    cli_error_line(error, line, (int)sizeof line);
    print_to(stderr, "%s\n", line);
    if (!json) return;
    json_t *document = json_pack("{s:{s:i, s:o, s:o, s:o}}", "error", "status",
                                 error_exit_status(error->code), "file", json_text(error->file),
                                 "path", json_text(error->path), "message", json_text(error->text));
    Error ignored;
    cli_print_json(document, &ignored);
}

static bool is_repeated(const Problems *problems, int index) {
    const Problem *one = &problems->list[index];
    for (int i = 0; i < index; i++) {
        const Problem *other = &problems->list[i];
        if (!strcmp(one->message, other->message) && !strcmp(one->path, other->path) &&
            !strcmp(one->file, other->file))
            return true;
    }
    return false;
}

void cli_print_warnings(const Problems *problems) {
    for (int i = 0; i < problems->count; i++) {
        const Problem *one = &problems->list[i];
        if (one->severity != SEVERITY_WARNING || is_repeated(problems, i)) continue;
        print_to(stderr, "parhelion: warning: %s%s%s%s%s%s\n", one->file, one->file[0] ? ": " : "",
                 one->message, one->path[0] ? " (" : "", one->path, one->path[0] ? ")" : "");
    }
}

json_t *cli_json_problems(const Problems *problems, Severity severity) {
    json_t *list = json_array();
    for (int i = 0; i < problems->count; i++) {
        const Problem *one = &problems->list[i];
        if (one->severity != severity || is_repeated(problems, i)) continue;
        const char *severity_name = severity == SEVERITY_ERROR ? "error" : "warning";
        json_array_append_new(list, json_pack("{s:o, s:o, s:s, s:o}", "file", json_text(one->file),
                                              "path", json_text(one->path), "severity",
                                              severity_name, "message", json_text(one->message)));
    }
    return list;
}
