/* SPDX-License-Identifier: Apache-2.0 */
/* render_identity.h -- everything that decides the value of a sample, as text.
 *
 * Two renders whose identities are equal give the same value for the same sample of the same
 * pixel, so that their sums may be joined: a checkpoint is resumed, and parts are merged, only
 * when they are.
 *
 *     version<TAB>0.1.0
 *     sources<TAB>0123456789ab
 *     ray tracer<TAB>Embree 3.13.5
 *     input 0<TAB>dashboard.gltf 0123456789abcdef
 *     ...
 *
 * One line for each thing, "name<TAB>value\n", always in the same order, no name twice. Files
 * stand with their name but without their folder, so that a folder may move. Numbers are exact
 * (all digits of a float or a double). What decides which samples are taken, and how they are
 * shown, is not in it: crop, samples, noise, threads, look, names.
 *
 * Memory   the arena's.  Threads  no shared state.  Fails  never.
 */
#pragma once
#include "cli/render/render_request.h"

/* camera: the one that looks; kernel: the one that will be used. The scene carries what the
 * command line changed already. */
const char *render_identity(const RenderRequest *request, const Scene *scene,
                            const SceneCamera *camera, const Kernel *kernel, Arena *arena);
