/* SPDX-License-Identifier: Apache-2.0 */
/* scene_load.h -- glTF files become a scene.
 *
 * Memory   all of the scene lies in the caller's arena; scene_close closes what else it holds.
 */
#pragma once
#include "base/progress.h"
#include "scene/scene.h"

/* Loads and checks everything; every fault and every warning goes to *problems, with file and
 * JSON path. False (and *err = the first error) when there is an error. */
bool scene_load(const SceneOptions *options, Arena *arena, Problems *problems, Scene **out,
                Error *err);

/* As scene_load, for a report: *problems holds everything that is wrong, and the Scene (never
 * NULL) is as much as could be read. Only one without errors may be rendered. */
Scene *scene_survey(const SceneOptions *options, ProgressMode progress, Arena *arena,
                    Problems *problems);

/* As scene_load, and shows the steps of a large scene that take a while. */
bool scene_load_shown(const SceneOptions *options, ProgressMode progress, Arena *arena,
                      Problems *problems, Scene **out, Error *err);

/* Closes the panels. NULL is fine. */
void scene_close(Scene *scene);
