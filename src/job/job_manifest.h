/* SPDX-License-Identifier: Apache-2.0 */
/* job_manifest.h -- manifest.json of a job's folder (assets/schemas/job.md).
 *
 * Memory   the arena's.
 * Fails    ERROR_INPUT with the file, the place in it, what is there and what was required.
 */
#pragma once
#include <jansson.h>

#include "job/job.h"
#include "record/record.h"

#define JOB_MANIFEST "manifest.json"

extern const RecordFormat job_format;

/* The document, with a newline; the same for the same job. */
const char *job_manifest_text(const SharedJob *job, Arena *arena);

/* Sets "samples" and "crop" of a part of a frame. */
void job_manifest_add_part(json_t *item, const JobPart *part);

/* Whether the folder holds one, valid or not. */
bool job_manifest_is_there(const char *dir, Arena scratch);

/* dir: as the user named it. */
bool job_manifest_read(const char *dir, Arena *arena, SharedJob *out, Error *err);
