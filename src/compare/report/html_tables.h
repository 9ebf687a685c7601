/* html_tables.h -- figures, regions, displays and metadata of a pair as tables; private to the
 * report. */
#pragma once
#include "compare/comparison.h"
#include "page/markup.h"

/* The few figures that are looked at first. */
void html_add_keys(Markup *html, const Comparison *c, const CompareOptions *options);

/* All figures with their limits; regions; displays; channels. */
void html_add_tables(Markup *html, const Comparison *c, const CompareOptions *options);

/* Notes, and the metadata of both sides: what differs first. */
void html_add_notes(Markup *html, const Comparison *c);
