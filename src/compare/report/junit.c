#include "compare/report/junit.h"

#include <math.h>

void junit_release(Junit *junit)
{
    markup_release(&junit->cases);
}

static void begin_case(Junit *junit, const char *name, double seconds)
{
    markup_add(&junit->cases, "  <testcase classname=\"parhelion.compare\" name=\"");
    markup_escape(&junit->cases, name);
    markup_format(&junit->cases, "\" time=\"%.3f\">\n", seconds);
    junit->count++;
    junit->seconds += seconds;
}

static void add_lines(Markup *xml, const Lines *lines, const char *before)
{
    for (int i = 0; i < lines->count; i++) {
        markup_add(xml, before);
        markup_escape(xml, lines->list[i]);
        markup_add(xml, "\n");
    }
}

static void add_properties(Markup *xml, const Comparison *c)
{
    markup_add(xml, "    <properties>\n");
    for (int i = 0; i < METRIC_COUNT; i++)
        if (isfinite(c->value[i]))
            markup_format(xml, "      <property name=\"%s\" value=\"%.9g\"/>\n",
                          metric_info((Metric)i)->name, c->value[i]);
    markup_add(xml, "    </properties>\n");
}

void junit_add(Junit *junit, const char *name, const Comparison *c)
{
    Markup *xml = &junit->cases;
    begin_case(junit, name, c->seconds);
    if (c->has_pixels) add_properties(xml, c);
    if (!c->same) {
        junit->failures++;
        markup_add(xml, "    <failure type=\"different\" message=\"");
        markup_escape(xml, c->verdict);
        markup_add(xml, "\">");
        add_lines(xml, &c->reasons, "");
        markup_add(xml, "</failure>\n");
    }
    markup_add(xml, "    <system-out>");
    markup_escape(xml, c->mean);
    markup_add(xml, "\n");
    add_lines(xml, &c->notes, "note: ");
    markup_add(xml, "</system-out>\n  </testcase>\n");
}

void junit_add_failure(Junit *junit, const char *name, const char *why, bool is_error)
{
    Markup *xml = &junit->cases;
    begin_case(junit, name, 0);
    junit->errors += is_error;
    junit->failures += !is_error;
    markup_format(xml, "    <%s type=\"%s\" message=\"", is_error ? "error" : "failure",
                  is_error ? "unreadable" : "missing");
    markup_escape(xml, why);
    markup_add(xml, "\"/>\n  </testcase>\n");
}

bool junit_write(const Junit *junit, const char *suite, const char *path, Error *err)
{
    Markup xml = {0};
    markup_format(&xml, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"%d\" "
                  "failures=\"%d\" errors=\"%d\" time=\"%.3f\">\n<testsuite name=\"",
                  junit->count, junit->failures, junit->errors, junit->seconds);
    markup_escape(&xml, suite);
    markup_format(&xml, "\" tests=\"%d\" failures=\"%d\" errors=\"%d\" skipped=\"0\" "
                  "time=\"%.3f\">\n  <properties>\n    <property name=\"software\" "
                  "value=\"parhelion %s\"/>\n  </properties>\n", junit->count, junit->failures,
                  junit->errors, junit->seconds, PARHELION_VERSION);
    markup_append(&xml, &junit->cases);
    markup_add(&xml, "</testsuite>\n</testsuites>\n");
    bool ok = markup_write(&xml, path, err);
    markup_release(&xml);
    return ok;
}
