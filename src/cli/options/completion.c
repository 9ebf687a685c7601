/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/completion.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cli/options/guides.h"

extern const char COMPLETION_SCRIPT[]; /* completion.bash, embedded by the build */

/* ---- what an option's value may be ------------------------------------------------------- */

typedef enum Completes {
    COMPLETES_NOTHING,
    COMPLETES_LIST, /* names with bars between, some of them */
    COMPLETES_FILE,
    COMPLETES_NAMED /* NAME=FILE */
} Completes;

/* The next of "auto|off|AZ,EL[,LUX]"; what is in brackets may be left out. */
static size_t alternative(const char *text)
{
    return strcspn(text, "|[");
}

static const char *next_alternative(const char *text)
{
    text += strcspn(text, "|");
    return *text ? text + 1 : text;
}

/* Words to type: capitals stand for something else. */
static bool is_literal(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (!islower((unsigned char)text[i]) && !isdigit((unsigned char)text[i]) &&
            text[i] != '-')
            return false;
    return length > 0;
}

/* "FILE", "DIR", "IMAGE", or a name with an ending such as "X.panel". */
static bool means_file(const char *text)
{
    for (const char *point = text; (point = strchr(point, '.')); point++)
        if (islower((unsigned char)point[1])) return true;
    return strstr(text, "FILE") || strstr(text, "DIR") || strstr(text, "IMAGE");
}

static Completes completes(const Option *option)
{
    const char *value = option->value, *equals = strchr(value, '=');
    if (means_file(value)) return equals ? COMPLETES_NAMED : COMPLETES_FILE;
    for (; *value; value = next_alternative(value))
        if (is_literal(value, alternative(value))) return COMPLETES_LIST;
    return COMPLETES_NOTHING;
}

/* ---- a row ------------------------------------------------------------------------------- */

/* Every option of a command: its own ones, then the common ones. */
typedef struct Options {
    const Option *own, *common;
    int           own_count, count;
} Options;

static const Option *option_at(const Options *all, int i)
{
    return i < all->own_count ? &all->own[i] : &all->common[i - all->own_count];
}

static void print_names(const Options *all, bool take_value)
{
    for (int i = 0; i < all->count; i++)
        if (take_value == (option_at(all, i)->kind != OPTION_FLAG))
            printf(" %s", option_at(all, i)->name);
}

static void print_of_kind(const char *variable, const Options *all, Completes kind)
{
    printf("        %s='", variable);
    for (int i = 0; i < all->count; i++) {
        const Option *option = option_at(all, i);
        if (option->kind != OPTION_FLAG && completes(option) == kind)
            printf(" %s", option->name);
    }
    printf(" '\n");
}

static void print_list(const Option *option)
{
    printf("        values[%s]='", option->name);
    for (const char *at = option->value; *at; at = next_alternative(at))
        if (is_literal(at, alternative(at))) printf(" %.*s", (int)alternative(at), at);
    printf("'\n");
}

void completion_print_command(const CliCommand *command, const Option *common,
                              int common_count)
{
    const Options all = {command->options, common, command->option_count,
                         command->option_count + common_count};
    printf("    '%s')\n        takes='", command->name);
    print_names(&all, true);
    printf(" '\n        flags='-h -V");
    print_names(&all, false);
    printf("'\n");
    print_of_kind("files", &all, COMPLETES_FILE);
    print_of_kind("named", &all, COMPLETES_NAMED);
    for (int i = 0; i < all.count; i++)
        if (option_at(&all, i)->kind != OPTION_FLAG &&
            completes(option_at(&all, i)) == COMPLETES_LIST)
            print_list(option_at(&all, i));
    printf("        arguments=%s ;;\n",
           strstr(command->usage, "COMMAND") ? "names" : "files");
}

void completion_print_group(const char *name, const Command *const *commands, int count)
{
    printf("    '%s')\n        commands='", name);
    for (int i = 0; i < count; i++) printf(" %s", commands[i]->name);
    printf("'\n        flags='-h -V --help --version'\n");
    if (!*name) {
        printf("        guides='");
        for (int i = 0; i < guide_count; i++) printf(" %s", guide_table[i].name);
        printf("'\n");
    }
    printf("        ;;\n");
}

void completion_print_head(void)
{
    printf("# Completion of parhelion " PARHELION_VERSION " in bash, made by\n"
           "# `parhelion help --completion bash`.\n\n"
           "_parhelion_row()\n{\n    case $1 in\n");
}

void completion_print_tail(void)
{
    printf("    esac\n}\n\n%s", COMPLETION_SCRIPT);
}
