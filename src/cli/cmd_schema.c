/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion schema: the JSON Schema of a format, from the rows that the program reads it by. */
#include <string.h>

#include "base/count.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "record/record_schema.h"
#include "review/profile_format.h"
#include "text/nearest_word.h"

typedef struct NamedFormat {
    const char         *name, *title;
    const RecordFormat *format;
} NamedFormat;

static const NamedFormat formats[] = {
    {"profile", "Limits that a glare review holds its figures against", &profile_format},
};

static void each_format(void (*row)(const char *name, const char *text))
{
    for (int i = 0; i < COUNT_OF(formats); i++) row(formats[i].name, formats[i].title);
}

static bool find(const char *name, const NamedFormat **out, Error *err)
{
    const char *known[COUNT_OF(formats)];
    char        advice[256];
    for (int i = 0; i < COUNT_OF(formats); i++) {
        known[i] = formats[i].name;
        if (strcmp(name, known[i]) != 0) continue;
        *out = &formats[i];
        return true;
    }
    return error_set(err, ERROR_USAGE, "there is no format '%.60s': %s", name,
                     nearest_word_advice(name, known, COUNT_OF(formats), advice,
                                         sizeof advice));
}

static bool run_schema(int argc, char **argv, Arena *arena, Error *err)
{
    const CliCommand command = {
        "schema", "the JSON Schema of a file format, for an editor or a script", "FORMAT",
        "parhelion schema profile", NULL, 0, 1, 1, "formats", each_format};
    const NamedFormat *format;
    Cli                cli;
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return false;
    if (cli.help_shown) return true;
    return find(cli.arguments[0], &format, err) &&
           cli_print_json(record_schema(format->format, format->title), err);
}

const Command command_schema = {
    "schema", "the JSON Schema of a file format, for an editor or a script", run_schema};
