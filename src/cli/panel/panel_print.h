/* panel_print.h -- the report of a panel file or of a fit as a table on stdout. */
#pragma once
#include <jansson.h>

void panel_print_report(const json_t *report);
