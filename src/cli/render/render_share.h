/* SPDX-License-Identifier: Apache-2.0 */
/* render_share.h -- `render --slurm`: a frame becomes a job's folder (cli/job/job.h).
 *
 * Memory   the command's arena.
 * Fails    ERROR_OUTPUT where the folder cannot be made, or is another job's; ERROR_INPUT where
 *          sbatch is asked for and fails: the folder stays, and the line says how to go on.
 */
#pragma once
#include "cli/render/render_request.h"

/* identity: of the frame, without what is learnt; isa: the one that its parts take. The answer
 * goes to stdout. */
bool render_share(const RenderRequest *request, const char *identity, const char *isa,
                  Arena *arena, Error *err);
