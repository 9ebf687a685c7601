/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_surface.h -- chooses in which coordinates an anisotropic haze is stored, and by
 * which law haze and mirror go on beyond the last measured incidence.
 *
 * Every choice is made by what the tables themselves show: each law predicts tables that were
 * measured, from their neighbours, and the one that misses them least is taken.
 * Threads  one at a time. Fails: never.
 */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

/* Fills in model->surface; the tables have been read (reflection_read.h). */
void reflection_surface_choose(ReflectionModel *model, FitNotes *notes);
