/* SPDX-License-Identifier: Apache-2.0 */
/* our_extensions.h -- our extensions of glTF as rows (record/record.h): of them a document is
 * checked (schema.h) and their JSON Schemas are written.
 *
 * The rows keep nothing: what a document holds is read by scene/load.
 *
 * Memory   constant. Threads: any. Fails: never.
 */
#pragma once
#include "record/record.h"
#include "scene/check/rule.h"

extern const RecordFormat display_extension, environment_extension, spectrum_extension,
    coating_extension, glazing_extension;

enum { OUR_DISPLAY, OUR_ENVIRONMENT, OUR_SPECTRUM, OUR_COATING, OUR_GLAZING };

/* The same for the check of a document; and that of an object that rows describe. */
extern const Schema our_schemas[];
const Schema *our_schema(const RecordFormat *format);
