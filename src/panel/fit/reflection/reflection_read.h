/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_read.h -- reflection tables as logarithms at any direction of the
 * specular-following frame. */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

/* The grids of all tables and the logarithms on their cells: once. */
void reflection_read_tables(ReflectionModel *model);

/* ln f of a table at a direction of its frame. Outside of what the table's samples surround
 * the value on their edge is held; returns how far a direction lies beyond the last ring of a
 * grid, radians. */
float reflection_read_logs(const ReflectionModel *model, int table, Vec3 outer, float *logs);

/* Places of a level, and all tables' values there. */
void reflection_read_places(ReflectionModel *model, int level);

/* Below this a table's values have no logarithm that counts: zeros, and noise that went below
 * them. sr^-1 */
double reflection_read_least(const AngleTable *table);

/* ln of a guide, in a table's frame. */
double reflection_guide_log(const ReflectionGuide *guide, double theta, double phi);
