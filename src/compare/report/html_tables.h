/* SPDX-License-Identifier: Apache-2.0 */
/* html_tables.h -- metrics, regions, displays and metadata of a pair as tables; private to the
 * report. */
#pragma once
#include "compare/comparison.h"
#include "text/text.h"

/* The few metrics that are looked at first. */
void html_add_keys(Text *html, const Comparison *c, const CompareOptions *options);

/* All metrics with their limits; regions; displays; channels. */
void html_add_tables(Text *html, const Comparison *c, const CompareOptions *options);

/* Notes, and the metadata of both sides: what differs first. */
void html_add_notes(Text *html, const Comparison *c);
