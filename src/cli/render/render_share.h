/* SPDX-License-Identifier: Apache-2.0 */
/* render_share.h -- `render --slurm`: a frame becomes a job's folder (cli/job/job_share.h).
 *
 * Memory   the command's arena.  Fails  as job_share; ERROR_USAGE: more parts than samples.
 */
#pragma once
#include "cli/render/render_request.h"

/* identity: of the frame, without what is learnt; isa: the one that its parts take. The answer
 * goes to stdout. */
bool render_share(const RenderRequest *request, const char *identity, const char *isa,
                  Arena *arena, Error *err);
