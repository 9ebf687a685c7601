/* SPDX-License-Identifier: Apache-2.0 */
/* emitters_build.h -- finds what emits in a scene, and cuts it into cells by its content. */
#pragma once
#include "light/emitters.h"

/* Memory: from the arena. */
Emitters emitters_build(const Scene *scene, Arena *arena);
