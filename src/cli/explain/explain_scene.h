/* SPDX-License-Identifier: Apache-2.0 */
/* explain_scene.h -- what of a scene is to be explained: a display, or pixels of a camera's
 * picture.
 *
 * Fails    with the option, as scene_options_load and render_choose_camera do, and where a
 *          display cannot be seen.
 */
#pragma once
#include "cli/options/camera_options.h"
#include "cli/options/scene_options.h"
#include "review/run/explain.h"

typedef struct SceneQuestion {
    CameraChoice      camera;
    SceneOptions      scene;
    EnvironmentChange environment;
    const char       *display; /* "cluster", "node:NAME"; NULL: pixels */
    double            uv[4];   /* of the content: left, top, right, bottom */
    double            region[4]; /* pixels: X0, Y0, X1, Y1 */
    int               size[2];
    const char       *isa;
    long              paths;
    int               threads;
    ProgressMode      progress; /* of loading */
    bool              with_outlook;
    Problems         *problems;
} SceneQuestion;

bool explain_scene(const SceneQuestion *question, Arena *arena, Explained *out, Error *err);
