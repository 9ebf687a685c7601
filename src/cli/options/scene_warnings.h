/* SPDX-License-Identifier: Apache-2.0 */
/* scene_warnings.h -- warns of a scene that seems to lack a scale or data. */
#pragma once
#include "base/problems.h"
#include "scene/scene.h"

/* Where a picture of surroundings seems to have no absolute scale (light/sky_picture_doubt.h).
 * Silent when the user scaled it: --hdri-lux, "horizontal_illuminance_lx", or a "scale" other
 * than 1. */
void hdri_warn(const Environment *environment, Problems *problems);

/* Of materials without optical data (scene/load/material_data.h): one line; an error where that
 * is to be. */
void data_warn(const Scene *scene, Severity severity, Problems *problems);

/* Of panels that say of themselves that they are not usable (panel/query/panel_stated.h): one
 * line each; an error where that is to be. */
void panels_warn(const Scene *scene, Severity severity, Problems *problems);
