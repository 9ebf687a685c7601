/* SPDX-License-Identifier: Apache-2.0 */
/* xml_tags.h -- looks a foreign XML text over before a library parses it, whose time grows with
 * the square of one tag's attributes, and of the names that elements within each other declare.
 *
 * Threads  no shared state.
 * Fails    ERROR_INPUT with the file and the line.
 */
#pragma once
#include "base/error.h"

#define XML_ATTRIBUTES_MAX 1000 /* of one tag */
#define XML_DEPTH_MAX 256       /* elements within each other */

/* A text that is no XML may pass: the library refuses it. */
bool xml_tags_check(const char *text, const char *file, Error *err);
