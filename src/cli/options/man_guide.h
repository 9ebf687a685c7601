/* SPDX-License-Identifier: Apache-2.0 */
/* man_guide.h -- a guide as the source of a manual page of section 7.
 *
 * Of Markdown it knows what guides use: headings, paragraphs, lists, tables, blocks of code,
 * and what stands within lines (roff.h). Fails: never.
 */
#pragma once
#include "cli/options/guides.h"

void man_guide_print(const Guide *guide);
