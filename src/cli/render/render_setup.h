/* SPDX-License-Identifier: Apache-2.0 */
/* render_setup.h -- what of a scene is looked at, and with which light.
 *
 * Fails    with the cameras that there are.
 */
#pragma once
#include "base/problems.h"
#include "cli/options/camera_options.h"
#include "scene/scene.h"

/* From --eye to --look-at; else by a node's name, then a camera's, then an index; else the
 * first. A scene without a camera is framed (camera_frame_scene), with a warning. */
bool render_choose_camera(const Scene *scene, const CameraChoice *choice, Problems *problems,
                          SceneCamera *out, Error *err);

/* A warning when nothing of the scene can send light: the frame will be black. */
void render_warn_of_darkness(const Scene *scene, Problems *problems);
