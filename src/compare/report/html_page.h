/* html_page.h -- style and script of a report, from report.css and report.js beside it; private
 * to the report. */
#pragma once

extern const char REPORT_TEXT_css[];
extern const char REPORT_TEXT_js[];
