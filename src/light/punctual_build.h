/* SPDX-License-Identifier: Apache-2.0 */
/* punctual_build.h -- before the first path: the tree of lamps. */
#pragma once
#include "light/punctual.h"

/* Memory: from the arena; the scene must outlive it. */
PunctualLights punctual_build(const Scene *scene, Arena *arena);
