/* SPDX-License-Identifier: Apache-2.0 */
/* command.h -- sub-commands: each a constant in its own file, listed in a table; and a
 * command's options as a table: what is parsed and shown by --help, of which manual pages and
 * what shells complete are made.
 *
 * Adding one touches its file, the header of its folder that declares it, and the table that
 * lists it (cli/commands.c, cli/panel/cmd_panel.c).
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/error.h"
#include "table/table.h"

/* How a command ended, and its exit status. */
typedef enum Outcome {
    OUTCOME_FAILED, /* 0, so that `return error_set(...)`: *err says why, unless that is said
                       already; error_exit_status */
    OUTCOME_DONE,   /* 0 */
    OUTCOME_NO,     /* done, and the answer is no: 1 */
    OUTCOME_STOPPED /* by a signal, of which a line is printed: 128 and its number */
} Outcome;

static inline Outcome outcome_of(bool is_done) {
    return is_done ? OUTCOME_DONE : OUTCOME_FAILED;
}

typedef struct Command {
    const char *name;
    const char *summary; /* one line, lower case, no full stop */
    /* argv[0] is the command's name; everything it keeps lies in the arena, which its caller
     * releases. */
    Outcome (*run)(int argc, char **argv, Arena *arena, Error *err);
    const struct Command *const *sub; /* its own commands, or NULL */
    int sub_count;
} Command;

#define COMMANDS_MAX 32

/* The one of this name, or NULL and an ERROR_USAGE that lists them. within: "panel" for its own
 * commands, NULL for the program's. */
const Command *command_find(const Command *const *list, int count, const char *within,
                            const char *name, Error *err);

typedef enum OptionKind {
    OPTION_FLAG,    /* bool: no value */
    OPTION_TEXT,    /* const char * */
    OPTION_NUMBER,  /* double in [low, high] */
    OPTION_INTEGER, /* long in [low, high] */
    OPTION_NUMBERS, /* double[count]: exactly count numbers with commas, each in [low, high] */
    OPTION_SIZE,    /* int[2]: WxH, each in [1, 65536] */
    OPTION_CHOICE,  /* int: index of the value among the names in `value`, "a|b|c" */
    OPTION_TEXTS    /* CliTexts: the one kind that may be given many times */
} OptionKind;

/* Every value of an OPTION_TEXTS, in the order given. */
typedef struct CliTexts {
    const char **list;
    int count, capacity;
} CliTexts;

/* What a command does with the file that an option names. */
typedef enum OptionFile {
    OPTION_NO_OUTPUT,
    OPTION_OUTPUT, /* writes it: never one that is read (cli/options/outputs.h) */
    OPTION_KEPT    /* the same, and reads it where it is there */
} OptionFile;

typedef struct Option {
    const char *name; /* as typed: "--size", "-o" */
    OptionKind kind;
    const char *value; /* what stands for the value in the help: "WxH"; NULL for a flag */
    const char *help;  /* one line, with the unit and the default */
    void *out;         /* the type that belongs to the kind */
    double low, high;  /* limits of numbers; both 0: none */
    int count;         /* OPTION_NUMBERS: how many, at most 8 */
    bool *given;       /* set when the option was there; NULL: not requested */
    OptionFile file;   /* of OPTION_TEXT */
} Option;

/* A document that --json answers with, of which the build makes assets/schemas/json_answers.md. */
typedef struct Answer {
    const char *with;      /* what requests it: "--glare"; "": every other run */
    const TableKind *kind; /* its own, or of a list that of each; NULL ends a list of answers */
} Answer;

typedef void HelpRow(void *user, const char *name, const char *text);

typedef struct CliCommand {
    const char *name;    /* "render", "panel fit" */
    const char *summary; /* one line, lower case, no full stop */
    const char *usage;   /* arguments: "SCENE.gltf [LIGHTS.gltf ...] -o FRAME.exr" */
    const char *example; /* a whole command line that works on the shipped files */
    const Option *options;
    int option_count;
    int min_arguments, max_arguments; /* max -1: any number */
    const char *rows_title;           /* of what the help lists besides: "formats"; NULL: nothing */
    void (*each_row)(HelpRow *row, void *user);
    const Answer *answers; /* NULL: not as columns */
} CliCommand;
