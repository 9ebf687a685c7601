/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/man_page.h"

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "cli/options/guides.h"

/* ---- words of a manual page -------------------------------------------------------------- */

/* What is printed is what was written: letters that troff reads as its own are escaped; UTF-8
 * stays itself. Lines begin with no point but that of a request. */

static const char *escape_of(char letter)
{
    switch (letter) {
    case '\\': return "\\e";
    case '-': return "\\-";
    case '\'': return "\\(aq";
    case '`': return "\\(ga";
    case '^': return "\\(ha";
    case '~': return "\\(ti";
    case '"': return "\\(dq";
    case '|': return "|\\:"; /* lists of values may go on in the next line */
    default: return NULL;
    }
}

/* A point that begins a word may come to begin a line; blanks behind an end of line, as rows of
 * lists have them, would end it in the page, too. */
static void roff_put(const char *text, size_t length)
{
    bool begins_line = false;
    for (size_t i = 0; i < length; i++) {
        const char *escape = escape_of(text[i]);
        bool        begins = i == 0 || !isalnum((unsigned char)text[i - 1]);
        begins_line = text[i] == '\n' || (begins_line && text[i] == ' ');
        if (begins_line && text[i] == ' ') continue;
        if (escape) fputs(escape, stdout);
        else if (text[i] == '.' && begins) fputs("\\&.", stdout);
        else putchar(text[i]);
    }
}

static void roff_string(const char *text)
{
    roff_put(text, strlen(text));
}

static void roff_line(const char *text)
{
    roff_string(text);
    putchar('\n');
}

/* font: "B" bold, "I" italic. */
static void roff_styled(const char *font, const char *text)
{
    printf("\\f%s", font);
    roff_string(text);
    printf("\\fR");
}

/* "[words](target)" at text: how long it is, 0: there is none; *words: how long they are. */
static size_t link_length(const char *text, size_t length, size_t *words)
{
    const char *close = memchr(text, ']', length);
    if (*text != '[' || !close || close + 1 >= text + length || close[1] != '(') return 0;
    const char *end = memchr(close, ')', length - (size_t)(close - text));
    *words = (size_t)(close - text) - 1;
    return end ? (size_t)(end - text) + 1 : 0;
}

static void put_link(const char *text, size_t length, size_t words)
{
    roff_put(text + 1, words);
    fputs(" (", stdout);
    roff_put(text + words + 3, length - words - 4);
    putchar(')');
}

/* Markup at text, outside of code: how many letters it takes. */
static size_t put_markup(const char *text, size_t left, bool *is_strong)
{
    size_t words, length, mark = *text == '!' && left > 1;
    if (left > 1 && !memcmp(text, "**", 2)) {
        *is_strong = !*is_strong;
        fputs(*is_strong ? "\\fB" : "\\fR", stdout);
        return 2;
    }
    length = link_length(text + mark, left - mark, &words);
    if (!length) return roff_put(text, 1), 1;
    put_link(text + mark, length, words);
    return mark + length;
}

/* Markdown within a line or a paragraph: `code`, **strong**, [words](target), ![words](target).
 */
static void roff_inline(const char *text, size_t length)
{
    bool is_strong = false;
    for (size_t i = 0; i < length;) {
        const char *code = text[i] == '`' ? memchr(text + i + 1, '`', length - i - 1) : NULL;
        if (code) {
            size_t size = (size_t)(code - text) - i - 1;
            fputs("\\fB", stdout);
            roff_put(text + i + 1, size);
            fputs("\\fR", stdout);
            i += size + 2;
        } else {
            size_t plain = strcspn(text + i + 1, "`*[!") + 1;
            if (plain > length - i) plain = length - i;
            if (strchr("`*[!", text[i])) i += put_markup(text + i, length - i, &is_strong);
            else roff_put(text + i, plain), i += plain;
        }
    }
}

/* The line that begins a page: name in lower case, section 1 or 7; then its section NAME. No
 * hyphens are added and no blanks: what is searched for is found, what is copied works. */
static void roff_title(const char *name, size_t length, int section)
{
    printf("'\\\" t\n.nr HY 0\n.TH \"");
    for (size_t i = 0; i < length; i++) {
        char letter = (char)toupper((unsigned char)name[i]);
        roff_put(&letter, 1);
    }
    printf("\" %d \"\" \"Parhelion " PARHELION_VERSION "\" \"Parhelion\"\n.ad l\n"
           ".SH NAME\n", section);
    roff_put(name, length);
    printf(" \\- ");
}

/* ---- commands ---------------------------------------------------------------------------- */

/* "panel fit" has the page parhelion-panel-fit. */
static void print_title(const char *command, const char *summary)
{
    char name[128];
    snprintf(name, sizeof name, "parhelion-%s", command);
    for (char *blank; (blank = strchr(name, ' '));) *blank = '-';
    roff_title(name, strlen(name), 1);
    roff_line(summary);
}

static void print_synopsis(const char *command, const char *usage)
{
    printf(".SH SYNOPSIS\n\\fBparhelion ");
    roff_string(command);
    printf("\\fR ");
    roff_line(usage);
}

static void print_options(const Option *options, int count)
{
    for (int i = 0; i < count; i++) {
        printf(".TP\n");
        roff_styled("B", options[i].name);
        if (options[i].value) {
            putchar(' ');
            roff_styled("I", options[i].value);
        }
        putchar('\n');
        roff_string(options[i].help);
        roff_line(option_repeats(&options[i]));
    }
}

static void print_row(const char *name, const char *text)
{
    printf(".TP\n");
    roff_styled("B", name);
    putchar('\n');
    roff_line(text);
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
        roff_line(command->rows_title);
        command->each_row(print_row);
    }
    printf(".SH EXAMPLE\n");
    roff_line(command->example);
    print_see_also(command->name);
}

/* prefix: of their pages' names, escaped: "panel\\-". */
static void print_commands(const char *prefix, const Command *const *commands, int count)
{
    printf(".SH COMMANDS\n");
    for (int i = 0; i < count; i++) {
        printf(".TP\n.BR parhelion\\-%s%s (1)\n", prefix, commands[i]->name);
        roff_line(commands[i]->summary);
    }
}

void man_page_print_group(const Command *group)
{
    char prefix[128];
    print_title(group->name, group->summary);
    print_synopsis(group->name, "COMMAND ...");
    snprintf(prefix, sizeof prefix, "%s\\-", group->name);
    print_commands(prefix, group->sub, group->sub_count);
    print_see_also(group->name);
}

static void print_pages(const Command *const *commands, int count)
{
    print_commands("", commands, count);
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
    print_row("5", "a part's machine lacks the job's instruction set");
    print_row("130, 143, 129", "interrupted (INT, TERM, HUP); what was done is saved where the "
              "line on stderr says so");
}

static void print_environment(void)
{
    printf(".SH ENVIRONMENT\n");
    print_row("OCIO", "an OpenColorIO configuration for pictures, where --config names none");
    print_row("PARHELION_STYLE", "a file of CSS that comes behind the style of every page that "
                                 "is written: a firm's own look");
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

/* ---- a guide ----------------------------------------------------------------------------- */

#define COLUMNS_MAX 16
#define PAGE_COLUMNS 70 /* letters of a terminal's line that are left to a page's text */
#define TABLE_TOGETHER 16 /* lines: a table near the end of a page begins the next */
#define COLUMN_GAP 3

static size_t line_length(const char *text)
{
    return strcspn(text, "\n");
}

static const char *next_line(const char *text)
{
    text += line_length(text);
    return *text ? text + 1 : text;
}

/* ---- lists and paragraphs ---------------------------------------------------------------- */

/* How long the mark of a list's row is, "- " or "12. ", at the start of a line; 0: none. */
static size_t mark_length(const char *line)
{
    size_t digits = strspn(line, "0123456789");
    if (!strncmp(line, "- ", 2)) return 2;
    return digits && !strncmp(line + digits, ". ", 2) ? digits + 2 : 0;
}

static bool begins_block(const char *line)
{
    return !*line || strchr("\n#|", *line) || !strncmp(line, "```", 3) || mark_length(line);
}

/* The lines from `text` on up to the next block. */
static const char *print_paragraph(const char *text)
{
    const char *end = text;
    do end = next_line(end);
    while (!begins_block(end + strspn(end, " ")));
    roff_inline(text, (size_t)(end - text));
    return end;
}

static const char *print_item(const char *text)
{
    size_t mark = mark_length(text);
    if (*text == '-') printf(".IP \\(bu 2\n");
    else printf(".IP %.*s 4\n", (int)mark - 1, text);
    return print_paragraph(text + mark);
}

/* ---- code -------------------------------------------------------------------------------- */

static const char *print_code(const char *text)
{
    printf(".PP\n.RS 4\n.EX\n");
    for (text = next_line(text); *text && strncmp(text, "```", 3); text = next_line(text)) {
        roff_put(text, line_length(text));
        putchar('\n');
    }
    printf(".EE\n.RE\n");
    return next_line(text);
}

/* ---- tables ------------------------------------------------------------------------------ */

typedef struct Cells {
    const char *text[COLUMNS_MAX];
    size_t      length[COLUMNS_MAX];
    int         count;
} Cells;

/* "| a | b |": what stands between the bars, blanks around it left out. */
static Cells cells_of(const char *line)
{
    Cells       cells = {.count = 0};
    const char *end = line + line_length(line);
    for (line++; line < end && cells.count < COLUMNS_MAX; cells.count++) {
        const char *bar = line;
        while (bar < end && (*bar != '|' || bar[-1] == '\\')) bar++;
        while (line < bar && *line == ' ') line++;
        size_t length = (size_t)(bar - line);
        while (length && line[length - 1] == ' ') length--;
        cells.text[cells.count] = line;
        cells.length[cells.count] = length;
        line = bar + 1;
    }
    return cells;
}

static bool is_rule(const char *line)
{
    return strspn(line, "|-: ") == line_length(line);
}

static size_t longest_word(const char *text, size_t length)
{
    size_t longest = 0, word = 0;
    for (size_t i = 0; i < length; i++) {
        word = text[i] == ' ' ? 0 : word + 1;
        if (word > longest) longest = word;
    }
    return longest;
}

/* Letters that each column gets, 0: as many as its cells have. Where those are too many for a
 * page, what is left beside every column's longest word is shared by what each would like. */
static void find_widths(const char *text, int count, size_t widths[COLUMNS_MAX])
{
    size_t wanted[COLUMNS_MAX] = {0}, words[COLUMNS_MAX] = {0}, all = 0, least = 0;
    for (; *text == '|'; text = next_line(text)) {
        Cells cells = is_rule(text) ? (Cells){.count = 0} : cells_of(text);
        for (int i = 0; i < cells.count; i++) {
            size_t word = longest_word(cells.text[i], cells.length[i]);
            if (cells.length[i] > wanted[i]) wanted[i] = cells.length[i];
            if (word > words[i]) words[i] = word;
        }
    }
    for (int i = 0; i < count; i++) {
        all += wanted[i] + COLUMN_GAP;
        least += words[i] + COLUMN_GAP;
    }
    size_t room = least < PAGE_COLUMNS ? PAGE_COLUMNS - least : 0;
    for (int i = 0; i < count; i++) {
        bool fits = all <= PAGE_COLUMNS || wanted[i] == words[i];
        widths[i] = fits ? 0 : words[i] + room * (wanted[i] - words[i]) / (all - least);
    }
}

static void print_cell(const char *text, size_t length, bool is_block)
{
    printf(is_block ? "T{\n.na\n\\&" : "\\&"); /* groff 1.23 adjusts them after all */
    roff_inline(text, length);
    if (is_block) printf("\nT}");
}

/* The format line of tbl, with the columns' widths; bold for the first row. */
static void print_columns(const size_t widths[COLUMNS_MAX], int count, bool is_bold)
{
    for (int i = 0; i < count; i++) {
        printf(is_bold ? "lb" : "l");
        if (widths[i]) printf("w(%zun)", widths[i]);
        putchar(i + 1 < count ? ' ' : is_bold ? '\n' : '.');
    }
}

static const char *print_table(const char *text)
{
    size_t widths[COLUMNS_MAX];
    int    count = cells_of(text).count;
    find_widths(text, count, widths);
    printf(".PP\n.ne %d\n.TS\n", TABLE_TOGETHER);
    print_columns(widths, count, true);
    print_columns(widths, count, false);
    putchar('\n');
    for (; *text == '|'; text = next_line(text)) {
        Cells cells = cells_of(text);
        if (is_rule(text)) continue;
        for (int i = 0; i < count; i++) {
            if (i) putchar('\t');
            print_cell(cells.text[i], i < cells.count ? cells.length[i] : 0,
                       widths[i] && i < cells.count && cells.length[i]);
        }
        putchar('\n');
    }
    printf(".TE\n");
    return text;
}

/* ---- the page ---------------------------------------------------------------------------- */

static const char *print_heading(const char *text)
{
    size_t depth = strspn(text, "#"), mark = depth + strspn(text + depth, " ");
    printf(depth > 2 ? ".SS " : ".SH ");
    roff_inline(text + mark, line_length(text) - mark);
    putchar('\n');
    return next_line(text);
}

static const char *print_block(const char *text)
{
    if (*text == '\n') return text + 1;
    if (*text == '#') return print_heading(text);
    if (*text == '|') return print_table(text);
    if (!strncmp(text, "```", 3)) return print_code(text);
    if (mark_length(text)) return print_item(text);
    printf(".PP\n");
    return print_paragraph(text);
}

void man_guide_print(const Guide *guide)
{
    char        name[128];
    const char *title;
    int         length = guide_title(guide, &title);
    snprintf(name, sizeof name, "parhelion-%s", guide->name);
    roff_title(name, strlen(name), 7);
    roff_inline(title, (size_t)length);
    printf("\n.SH DESCRIPTION\n");
    for (const char *text = next_line(title); *text;) text = print_block(text);
    printf(".SH SEE ALSO\n.BR parhelion (1)\n");
}
