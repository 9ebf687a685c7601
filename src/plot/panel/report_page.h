/* report_page.h -- the fixed parts of the report: its style sheet and its read-out script.
 *
 * Threads  constant data.
 */
#pragma once

extern const char REPORT_STYLE[];  /* CSS, for screen and print, light and dark */
extern const char REPORT_SCRIPT[]; /* writes the value under the pointer below a figure */
