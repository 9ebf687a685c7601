/* SPDX-License-Identifier: Apache-2.0 */
/* render_answer.h -- what comes out of `parhelion render`: a frame with everything that is
 * needed to make it again, and what is printed.
 *
 * Memory   the arena's.
 */
#pragma once
#include "cli/render/render_request.h"

/* The film as it stands, with its metadata. */
FrameImage render_make_frame(const RenderRequest *request, const Scene *scene,
                             const SceneCamera *camera, const RenderResult *result,
                             Arena *arena);

/* The command's answer on stdout. live_s: seconds that showing the frame meanwhile took. */
bool render_print_answer(const RenderRequest *request, const RenderResult *result,
                         double live_s, const Problems *problems, Error *err);

/* The value of the one sample that was replayed, on stdout. */
bool render_print_replay(const RenderRequest *request, const Scene *scene,
                         const RenderResult *result, Arena *arena, Error *err);
