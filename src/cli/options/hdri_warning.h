/* SPDX-License-Identifier: Apache-2.0 */
/* hdri_warning.h -- warns when a picture of surroundings seems to have no absolute scale.
 *
 * Silent when the user scaled it: --hdri-lux, "horizontal_illuminance_lx", or a "scale" other
 * than 1. The criterion: light/sky_picture_doubt.h.
 */
#pragma once
#include "base/problems.h"
#include "scene/scene.h"

void hdri_warn(const Environment *environment, Problems *problems);
