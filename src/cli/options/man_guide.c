/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/man_guide.h"

#include <stdio.h>
#include <string.h>

#include "cli/options/roff.h"

#define COLUMNS_MAX 16
#define PAGE_COLUMNS 70 /* letters of a terminal's line that are left to a page's text */
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

static const char *print_row(const char *text)
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
    printf(".PP\n.TS\n");
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
    if (mark_length(text)) return print_row(text);
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
