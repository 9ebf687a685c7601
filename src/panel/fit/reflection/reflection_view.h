/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_view.h -- one table of a reflection in the coordinates and over the reference in
 * which its logarithm is stored.
 *
 * Frames   "local" is the table's: the mirror direction at azimuth 0. "stored" is the tree's.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include "hemisphere/specular_frame.h"
#include "panel/fit/reflection/reflection_model.h"

typedef struct ReflectionView {
    const ReflectionSurface *surface;
    SpecularFrame specular;
    Vec3          light;   /* in the display's frame */
    double        fresnel; /* F of its incidence */
} ReflectionView;

ReflectionView reflection_view(const ReflectionModel *model, int table);

Vec3 reflection_view_stored(const ReflectionView *view, Vec3 local);

/* The local direction of a stored one; where there is none above the horizon, one on it. */
Vec3 reflection_view_local(const ReflectionView *view, Vec3 stored);

/* Between a table's frame and the display's. */
Vec3 reflection_view_from_local(Vec3 light, Vec3 local);
Vec3 reflection_view_to_local(Vec3 light, Vec3 towards);

/* The divisor of f at a local direction. */
double reflection_view_reference(const ReflectionView *view, Vec3 local);
