/* SPDX-License-Identifier: Apache-2.0 */
/* check_animation.h -- animations, which are skipped but reported on. */
#pragma once
#include "scene/check/check.h"

void check_animation(const DocumentCheck *check, const GltfValue *animation);
