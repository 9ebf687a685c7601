/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_render.h -- `parhelion render`, also for another command that makes the request itself.
 *
 * Memory   the command's arena.  Fails as the command does.
 */
#pragma once
#include "cli/options/command.h"
#include "cli/render/render_request.h"

/* Of a request that was not typed. */
Outcome cmd_render_request(const RenderRequest *request, Arena *arena, Error *err);

extern const Command command_render;
