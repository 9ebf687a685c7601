/* SPDX-License-Identifier: Apache-2.0 */
/* cli.h -- a sub-command's options from one table: parsing, help and error texts agree.
 *
 * A command fills a table of Option on its stack, every row pointing at the variable that takes
 * the value; what the user leaves out keeps the value it had. Values follow their option as
 * the next argument or after '='; names are never abbreviated. An option stands once: a second
 * one is refused, unless it is a list (OPTION_TEXTS). After `--` everything is an argument.
 * Every command also has --json, --quiet, --progress, --threads, --help (-h) and --version
 * (-V); the word help alone is --help too, unless a file has that name.
 *
 *     double level = 1;
 *     const Option options[] = {
 *         {"--level", OPTION_NUMBER, "PERCENT", "how bright", &level, .low = 0, .high = 100},
 *     };
 *     const CliCommand command = {"panel info", "what a panel file holds", "X.panel",
 *         "parhelion panel info assets/panels/ips_cluster.panel", options, 1, 1, 1};
 *     if (!cli_parse(&command, argc, argv, &arena, &cli, err)) return false;
 *     if (cli.help_shown) return true;
 *
 * Fails    ERROR_USAGE with a text that holds the option, the value found and what is required;
 *          ERROR_OUTPUT where an output is a file that another word names (outputs.h).
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/progress.h"
#include "cli/options/command.h"
#include "cli/options/outputs.h"

/* Results of cli_parse besides the values. */
typedef struct Cli {
    bool help_shown; /* help, or the version, was requested and is printed: done */
    bool json, quiet;
    ProgressMode progress;  /* PROGRESS_NONE when quiet */
    int threads;            /* at least 1 */
    const char **arguments; /* words that are no options */
    int argument_count;
    Outputs outputs;
} Cli;

/* argv[0] is the command's own name and skipped. Lists come from the arena; texts stay argv's.
 */
bool cli_parse(const CliCommand *command, int argc, char **argv, Arena *arena, Cli *out,
               Error *err);

/* --help or -h; with --json beside it the help is a document (help_json.h). */
bool cli_is_help(const char *word);

/* --version or -V. */
bool cli_is_version(const char *word);

/* Is the word this option, by itself or with its value behind '='? */
bool cli_is_option(const char *word, const char *name);

/* How many words it takes, this one first: 1 or 2. */
int cli_option_words(const char *word, bool has_value);

/* --root's line of help, the same wherever files name others (base/reference.h). */
#define ROOT_HELP "a folder whose files may be named too (default: parent of a file's folder)"

/* ---- values inside texts --------------------------------------------------------------- */

/* `count` finite numbers with commas and nothing else; false when it is something else. */
bool cli_numbers(const char *text, int count, double *out);

/* "NAME=VALUE" cut at the first '=' behind which a file stands, else at the last if a number
 * follows it, else at the first: *name comes from the arena, *value points into text. */
bool cli_name_value(const char *option, const char *text, Arena *arena, const char **name,
                    const char **value, Error *err);

/* The last line of a command's help: the guide (cli/options/guides.h) that names it, if any. */
void cli_print_guide(const char *command);

/* The program's version, its sources, the instruction set in use and the libraries. */
void version_print(void);
