/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_render.h -- `parhelion render`, also for another command, which knows what has to come
 * out.
 *
 * Memory   the command's arena.  Fails as the command does.
 */
#pragma once
#include "cli/options/command.h"
#include "cli/render/render_request.h"

/* A render that is a part of something planned. */
typedef struct RenderTask {
    const char *name;        /* of the part, for messages */
    const char *identity;    /* what the samples have to be of; the guide is not in it */
    const char *isa;         /* taken where the words name none */
    const char *resume_line; /* the command that goes on with it */
} RenderTask;

/* argv as the command's. task NULL: the command itself. Else the scene and the program have to
 * be what was planned (ERROR_INPUT), only a whole frame is written, no snapshot, and there is
 * no answer. */
Outcome cmd_render_run(int argc, char **argv, const RenderTask *task, Arena *arena, Error *err);

/* The same of a request that was not typed. */
Outcome cmd_render_request(const RenderRequest *request, const RenderTask *task, Arena *arena,
                           Error *err);

extern const Command command_render;
