/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/man_page.h"

#include <stdio.h>
#include <string.h>

#include "cli/options/guides.h"
#include "cli/options/roff.h"

/* "panel fit" has the page parhelion-panel-fit. */
static void print_title(const char *command, const char *summary)
{
    char name[128];
    snprintf(name, sizeof name, "parhelion-%s", command);
    for (char *blank; (blank = strchr(name, ' '));) *blank = '-';
    roff_title(name, strlen(name), 1);
    roff_string(summary);
    putchar('\n');
}

static void print_synopsis(const char *command, const char *usage)
{
    printf(".SH SYNOPSIS\n\\fBparhelion ");
    roff_string(command);
    printf("\\fR ");
    roff_string(usage);
    putchar('\n');
}

static void print_options(const Option *options, int count)
{
    for (int i = 0; i < count; i++) {
        printf(".TP\n\\fB");
        roff_string(options[i].name);
        printf("\\fR");
        if (options[i].value) {
            printf(" \\fI");
            roff_string(options[i].value);
            printf("\\fR");
        }
        putchar('\n');
        roff_string(options[i].help);
        putchar('\n');
    }
}

static void print_row(const char *name, const char *text)
{
    printf(".TP\n\\fB");
    roff_string(name);
    printf("\\fR\n");
    roff_string(text);
    putchar('\n');
}

static void print_example(const char *example)
{
    printf(".SH EXAMPLE\n");
    roff_string(example);
    putchar('\n');
}

static void print_see_also(const char *command)
{
    const Guide *guide = guide_of_command(command);
    printf(".SH SEE ALSO\n.BR parhelion (1)");
    if (guide) printf(",\n.BR parhelion\\-%s (7)", guide->name);
    putchar('\n');
}

void man_page_print_command(const CliCommand *command, const Option *common, int common_count)
{
    print_title(command->name, command->summary);
    print_synopsis(command->name, command->usage);
    printf(".SH OPTIONS\n");
    print_options(command->options, command->option_count);
    print_options(common, common_count);
    if (command->each_row) {
        printf(".SH ");
        roff_string(command->rows_title);
        putchar('\n');
        command->each_row(print_row);
    }
    print_example(command->example);
    print_see_also(command->name);
}

void man_page_print_group(const Command *group)
{
    print_title(group->name, group->summary);
    print_synopsis(group->name, "COMMAND ...");
    printf(".SH COMMANDS\n");
    for (int i = 0; i < group->sub_count; i++) {
        printf(".TP\n.BR parhelion\\-%s\\-%s (1)\n", group->name, group->sub[i]->name);
        roff_string(group->sub[i]->summary);
        putchar('\n');
    }
    print_see_also(group->name);
}

static void print_pages(const Command *const *commands, int count)
{
    printf(".SH COMMANDS\n");
    for (int i = 0; i < count; i++) {
        printf(".TP\n.BR parhelion\\-%s (1)\n", commands[i]->name);
        roff_string(commands[i]->summary);
        putchar('\n');
    }
    printf(".SH GUIDES\n");
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int         length = guide_title(&guide_table[i], &title);
        printf(".TP\n.BR parhelion\\-%s (7)\n", guide_table[i].name);
        roff_inline(title, (size_t)length);
        putchar('\n');
    }
}

static void print_statuses(void)
{
    printf(".SH EXIT STATUS\n");
    print_row("0", "done");
    print_row("1", "done, and the answer is no: images differ, a limit is missed");
    print_row("2", "the command line is wrong");
    print_row("3", "an input is missing, malformed or not supported");
    print_row("4", "an output cannot be written");
    print_row("130, 143, 129", "interrupted (INT, TERM, HUP); what was done is saved where the "
              "line on stderr says so");
}

static void print_environment(void)
{
    printf(".SH ENVIRONMENT\n");
    print_row("OCIO", "an OpenColorIO configuration for pictures, where --config names none");
    print_row("NO_COLOR", "if it is set, the progress has no colours");
    print_row("SOURCE_DATE_EPOCH", "the time that frames are marked with");
}

static void print_files(void)
{
    printf(".SH FILES\n");
    print_row("share/parhelion", "beside the folder of the program: scenes/, assets/. The "
              "guides' commands run where these two lie, or links to them");
}

void man_page_print_program(const char *summary, const Command *const *commands, int count)
{
    roff_title("parhelion", strlen("parhelion"), 1);
    roff_string(summary);
    printf("\n.SH SYNOPSIS\n\\fBparhelion\\fR COMMAND ... | \\fBhelp\\fR [NAME] | "
           "\\fB\\-h\\fR | \\fB\\-V\\fR\n");
    print_pages(commands, count);
    print_statuses();
    print_environment();
    print_files();
}
