/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/junit.h"

#include <math.h>

#include "page/page.h"
#include "text/text.h"

#define MOST_BYTES ((size_t)16 << 30)  /* of address space, for the cases */
#define FRAME_BYTES ((size_t)1 << 20) /* and for what stands around them */

void junit_start(Junit *junit)
{
    *junit = (Junit){.own = arena_reserve(MOST_BYTES)};
    junit->cases.arena = &junit->own;
}

void junit_release(Junit *junit)
{
    arena_release(&junit->own);
    *junit = (Junit){0};
}

static void begin_case(Junit *junit, const char *name, double seconds)
{
    text_add(&junit->cases, "  <testcase classname=\"parhelion.compare\" name=\"");
    escape_markup(&junit->cases, name);
    text_format(&junit->cases, "\" time=\"%.3f\">\n", seconds);
    junit->count++;
    junit->seconds += seconds;
}

static void add_lines(Text *xml, const Lines *lines, const char *before)
{
    for (int i = 0; i < lines->count; i++) {
        text_add(xml, before);
        escape_markup(xml, lines->list[i]);
        text_add(xml, "\n");
    }
}

static void add_properties(Text *xml, const Comparison *c)
{
    text_add(xml, "    <properties>\n");
    for (int i = 0; i < METRIC_COUNT; i++)
        if (isfinite(c->value[i]))
            text_format(xml, "      <property name=\"%s\" value=\"%.9g\"/>\n",
                          metric_info((Metric)i)->name, c->value[i]);
    text_add(xml, "    </properties>\n");
}

void junit_add(Junit *junit, const char *name, const Comparison *c)
{
    Text *xml = &junit->cases;
    begin_case(junit, name, c->seconds);
    if (c->has_pixels) add_properties(xml, c);
    if (!c->same) {
        junit->failures++;
        text_add(xml, "    <failure type=\"different\" message=\"");
        escape_markup(xml, c->verdict);
        text_add(xml, "\">");
        add_lines(xml, &c->reasons, "");
        text_add(xml, "</failure>\n");
    }
    text_add(xml, "    <system-out>");
    escape_markup(xml, c->mean);
    text_add(xml, "\n");
    add_lines(xml, &c->notes, "note: ");
    text_add(xml, "</system-out>\n  </testcase>\n");
}

void junit_add_failure(Junit *junit, const char *name, const char *why, bool is_error)
{
    Text *xml = &junit->cases;
    begin_case(junit, name, 0);
    junit->errors += is_error;
    junit->failures += !is_error;
    text_format(xml, "    <%s type=\"%s\" message=\"", is_error ? "error" : "failure",
                  is_error ? "unreadable" : "missing");
    escape_markup(xml, why);
    text_add(xml, "\"/>\n  </testcase>\n");
}

bool junit_write(const Junit *junit, const char *suite, const char *path, Error *err)
{
    Arena arena = arena_reserve(FRAME_BYTES);
    Text  begin = {.arena = &arena}, end = {.arena = &arena};
    text_format(&begin, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"%d\" "
                "failures=\"%d\" errors=\"%d\" time=\"%.3f\">\n<testsuite name=\"",
                junit->count, junit->failures, junit->errors, junit->seconds);
    escape_markup(&begin, suite);
    text_format(&begin, "\" tests=\"%d\" failures=\"%d\" errors=\"%d\" skipped=\"0\" "
                "time=\"%.3f\">\n  <properties>\n    <property name=\"software\" "
                "value=\"parhelion %s\"/>\n  </properties>\n", junit->count, junit->failures,
                junit->errors, junit->seconds, PARHELION_VERSION);
    text_add(&end, "</testsuite>\n</testsuites>\n");
    bool ok = page_write((const Text *const[]){&begin, &junit->cases, &end}, 3, path, err);
    arena_release(&arena);
    return ok;
}
