/* SPDX-License-Identifier: Apache-2.0 */
/* render_resume.h -- the checkpoints of `parhelion render`.
 *
 * Memory   the arena's.
 * Fails    with the checkpoint's file and what is wrong or different.
 */
#pragma once
#include "cli/render/render_request.h"

/* Before anything is done: can it be written, and is what stands there a checkpoint? */
bool render_check_checkpoint(const RenderRequest *request, Error *err);

/* The checkpoint that --resume goes on from; NULL, with a line printed, where none is there
 * yet. One of another render, or of other pixels or samples, is refused by what differs; one of
 * another program or instruction set with ERROR_MACHINE. */
bool render_find_checkpoint(const RenderRequest *request, const char *identity, Arena *arena,
                            const Checkpoint **out, Error *err);

/* Keeps what is done so far, in place of what was kept before. */
bool render_keep_checkpoint(const RenderRequest *request, const char *identity,
                            const RenderResult *so_far, Arena scratch, Error *err);

/* When the finished frame is written. */
void render_remove_checkpoint(const RenderRequest *request);
