/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/scan.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"
#include "import/set/import.h"

#define BYTE_ORDER_MARK "\xEF\xBB\xBF"
#define WORD_SHOWN_MAX 40 /* of a word in a message */

bool scan_open(const char *file, Arena *arena, WordScan *out, Error *err) {
    FileBytes bytes;
    if (!file_read(file, IMPORT_FILE_BYTES_MAX, arena, &bytes, err)) return false;
    const char *text = (const char *)bytes.data;
    size_t mark = bytes.size >= 3 && !memcmp(text, BYTE_ORDER_MARK, 3) ? 3 : 0;
    *out = (WordScan){.file = file,
                      .next = text + mark,
                      .end = text + bytes.size,
                      .line = 1,
                      .comment = '#',
                      .arena = arena};
    return true;
}

static bool is_separator(const WordScan *scan, char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || (c == ',' && scan->commas);
}

/* To the next word; a comment mark counts at the beginning of a word. */
static void skip(WordScan *scan) {
    while (scan->next < scan->end) {
        char c = *scan->next;
        if (scan->comment && c == scan->comment) {
            while (scan->next < scan->end && *scan->next != '\n') scan->next++;
        } else if (is_separator(scan, c)) {
            scan->line += c == '\n';
            scan->next++;
        } else {
            return;
        }
    }
}

const char *scan_word(WordScan *scan) {
    skip(scan);
    const char *begin = scan->next;
    while (scan->next < scan->end && !is_separator(scan, *scan->next)) scan->next++;
    if (scan->next == begin) return NULL;
    return arena_string(scan->arena, begin, (size_t)(scan->next - begin));
}

const char *scan_peek(const WordScan *scan) {
    WordScan copy = *scan;
    return scan_word(&copy);
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

const char *scan_line(WordScan *scan) {
    if (scan->next >= scan->end) return NULL;
    const char *begin = scan->next;
    const char *feed = memchr(begin, '\n', (size_t)(scan->end - begin));
    const char *stop = feed ? feed : scan->end;
    scan->next = feed ? feed + 1 : scan->end;
    scan->line += feed != NULL;
    while (begin < stop && is_blank(*begin)) begin++;
    while (stop > begin && is_blank(stop[-1])) stop--;
    return arena_string(scan->arena, begin, (size_t)(stop - begin));
}

bool scan_accept(WordScan *scan, const char *word) {
    WordScan copy = *scan;
    const char *found = scan_word(&copy);
    if (!found || strcasecmp(found, word)) return false;
    *scan = copy;
    return true;
}

/* No word of a number is longer: what is longer is not copied. */
bool scan_number(WordScan *scan, const char *what, double *out, Error *err) {
    char text[64];
    skip(scan);
    const char *begin = scan->next;
    while (scan->next < scan->end && !is_separator(scan, *scan->next)) scan->next++;
    size_t length = (size_t)(scan->next - begin);
    if (!length) return scan_fail(scan, err, "the file ends, required: %s", what);
    size_t copied = length < sizeof text ? length : sizeof text - 1;
    memcpy(text, begin, copied);
    text[copied] = 0;
    if (length < sizeof text && number_is(text, out)) return true;
    return scan_fail(scan, err, "%s is '%.*s', required: a number", what, WORD_SHOWN_MAX, text);
}

bool scan_count(WordScan *scan, const char *what, int most, int *out, Error *err) {
    double value;
    if (!scan_number(scan, what, &value, err)) return false;
    if (!(value >= 1 && value <= most && value == floor(value)))
        return scan_fail(scan, err,
                         "%s is %g, required: a whole number from 1 to "
                         "%d",
                         what, value, most);
    double words = (double)(scan->end - scan->next) / 2 + 1;
    if (value > words)
        return scan_fail(scan, err, "%s is %g, more than the rest of the file can hold", what,
                         value);
    *out = (int)value;
    return true;
}

bool scan_list(WordScan *scan, const char *what, int count, double **out, Error *err) {
    double *list = ARENA_NEW(scan->arena, double, count);
    for (int i = 0; i < count; i++)
        if (!scan_number(scan, what, &list[i], err)) return false;
    *out = list;
    return true;
}

bool scan_counted_list(WordScan *scan, const char *what, int most, int *count, double **out,
                       Error *err) {
    return scan_count(scan, what, most, count, err) && scan_list(scan, what, *count, out, err);
}

int scan_choice(WordScan *scan, const char *what, const char *const *list, const char *wanted,
                Error *err) {
    const char *word = scan_word(scan);
    int found = word ? import_word_find(list, word) : -1;
    if (found < 0) scan_fail(scan, err, "%s is '%s', required: %s", what, word ? word : "", wanted);
    return found;
}

int scan_lines_left(const WordScan *scan) {
    int lines = 1;
    for (const char *c = scan->next; c < scan->end && lines < IMPORT_ROWS_MAX; c++)
        lines += *c == '\n';
    return lines;
}

bool scan_check_end(const WordScan *scan, Error *err) {
    return scan->end[-1] == '\n' ||
           scan_fail(scan, err, "the last line has no line end: the file may be cut");
}

bool scan_fail(const WordScan *scan, Error *err, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_count(err, scan->file, "line", scan->line, format, list);
    va_end(list);
    return false;
}

bool scan_head_has(const char *head, size_t size, const char *line_start) {
    size_t length = strlen(line_start);
    if (size >= 3 && !memcmp(head, BYTE_ORDER_MARK, 3))
        return scan_head_has(head + 3, size - 3, line_start);
    for (size_t i = 0; i + length <= size; i++)
        if ((!i || head[i - 1] == '\n') && !memcmp(head + i, line_start, length)) return true;
    return false;
}
