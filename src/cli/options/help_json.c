/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/help_json.h"

#include <string.h>

#include "cli/options/guides.h"
#include "print/print.h"
#include "text/json_text.h"

static void add_options(json_t *list, const Option *options, int count) {
    for (int i = 0; i < count; i++)
        json_array_append_new(list, json_pack("{s:s, s:s?, s:s, s:b}", "name", options[i].name,
                                              "value", options[i].value, "help", options[i].help,
                                              "is_repeatable", options[i].kind == OPTION_TEXTS));
}

static void add_row(void *user, const char *name, const char *text) {
    json_array_append_new(user, json_pack("{s:s, s:s}", "name", name, "text", text));
}

static json_t *answers_json(const Answer *answers) {
    json_t *list = json_array();
    for (; answers && answers->kind; answers++)
        json_array_append_new(list, json_pack("{s:s, s:o}", "with", answers->with, "columns",
                                              table_kind_json(answers->kind)));
    return list;
}

bool help_json_command(const CliCommand *command, const Option *common, int common_count,
                       Error *err) {
    const char *blank = strrchr(command->name, ' ');
    const Guide *guide = guide_of_command(command->name);
    json_t *options = json_array(), *rows = json_array();
    add_options(options, command->options, command->option_count);
    add_options(options, common, common_count);
    if (command->each_row) command->each_row(add_row, rows);
    return cli_print_json(json_pack("{s:s, s:s, s:s, s:o, s:s?, s:o, s:s, s:s?, s:o}", "name",
                                    blank ? blank + 1 : command->name, "summary", command->summary,
                                    "arguments", command->usage, "options", options, "rows_title",
                                    command->rows_title, "rows", rows, "example", command->example,
                                    "guide", guide ? guide->name : NULL, "answers",
                                    answers_json(command->answers)),
                          err);
}

bool help_json_group(json_t *head, const Command *const *commands, int count, Arena *arena,
                     Error *err) {
    char *line[] = {NULL, (char *)"--help", (char *)"--json", NULL};
    Text text = {.arena = arena};
    json_dump_text(&text, head, JSON_INDENT(2));
    json_decref(head);
    text.data[text.size - strlen("\n}")] = '\0';
    print_own(stdout, text.data);
    print(",\n  \"commands\": [\n");
    for (int i = 0; i < count; i++) {
        if (i) print(",\n");
        line[0] = (char *)commands[i]->name;
        if (commands[i]->run(3, line, arena, err) != OUTCOME_DONE) return false;
    }
    print("]}\n");
    return true;
}
