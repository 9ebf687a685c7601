/* SPDX-License-Identifier: Apache-2.0 */
/* data_warning.h -- reports which materials of a scene carry no optical data
 * (scene/load/material_data.h).
 */
#pragma once
#include "base/problems.h"
#include "scene/scene.h"

/* One line; an error where that is to be. */
void data_warn(const Scene *scene, Severity severity, Problems *problems);
