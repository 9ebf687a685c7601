/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_axes.h -- how wide the haze's lobe is, and along which axes.
 *
 * Around the mirror direction a lobe is taken for (1 + x^T M x)^-2 over slopes or direction
 * cosines x, GGX's shape: fitted where a table is above a quarter of its peak, mean over the
 * tables. Other shapes get the axes of what is about as wide.
 * Units    x has none; M is 1 / alpha^2 for facets. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

/* The root of M: makes the lobe round, and 1 wide at a quarter of its height. */
SurfaceAxes reflection_axes_of_lobe(const ReflectionModel *model, PanelFrameKind frame);

/* The longest x of any row in these axes. */
float reflection_axes_reach(const ReflectionModel *model, PanelFrameKind frame,
                            SurfaceAxes axes);

/* The inverse of M over slopes: squared GGX alphas. */
SurfaceAxes reflection_axes_roughness(const ReflectionModel *model);
