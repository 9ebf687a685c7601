/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion schema: the JSON Schema of a format, from the rows that the program reads it by. */
#include <string.h>

#include "cli/commands.h"
#include "cli/format_table.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "record/record_schema.h"
#include "text/nearest_word.h"

static void each_format(HelpRow *row, void *user) {
    for (int i = 0; i < schema_count; i++) row(user, format_table[i].name, format_table[i].title);
}

static const NamedFormat *find(const char *name, Arena *arena, Error *err) {
    const char **known = ARENA_NEW(arena, const char *, schema_count);
    char advice[256];
    for (int i = 0; i < schema_count; i++) {
        known[i] = format_table[i].name;
        if (!strcmp(name, known[i])) return &format_table[i];
    }
    error_set(err, ERROR_USAGE, "there is no format '%.60s': %s", name,
              nearest_word_advice(name, known, schema_count, advice, sizeof advice));
    return NULL;
}

static Outcome run_schema(int argc, char **argv, Arena *arena, Error *err) {
    const CliCommand command = {"schema",  command_schema.summary,
                                "FORMAT",  "parhelion schema profile",
                                NULL,      0,
                                1,         1,
                                "formats", each_format};
    Cli cli;
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    const NamedFormat *of = find(cli.arguments[0], arena, err);
    return outcome_of(of && cli_print_json(record_schema(of->format, of->title), err));
}

const Command command_schema = {
    "schema", "the JSON Schema of a file format, for an editor or a script", run_schema};
