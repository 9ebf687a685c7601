/* SPDX-License-Identifier: Apache-2.0 */
/* view_transform.h -- turns scene-linear colour into display code values.
 * The only C view of OpenColorIO in this program.
 *
 * Units    in: linear Rec.709/D65, 0.18 is middle grey; out: code values, 0 .. 1.
 * Memory   a transform is a handle with a destroy; its texts live as long as it does.
 * Threads  a transform may be applied by several threads at once.
 * Fails    with the library's reason, and the names that would have been right.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct ViewTransform ViewTransform; /* owns a C++ object */

/* A request for a transform. With config_path NULL the text own_config serves, whose role
 * scene_linear is linear Rec.709. A user's configuration is entered through its role
 * aces_interchange, or cie_xyz_d65_interchange if that is a scene-referred space; one that has
 * neither is refused, since its scene_linear may be anything. */
typedef struct ViewRequest {
    const char *config_path;
    const char *own_config;
    const char *display; /* NULL: the configuration's default */
    const char *view;    /* NULL: the display's default */
    /* Asked of the configuration's file and of each that it names (FileTransform), before the
     * library opens one: whether it may. False: *err has the reason. */
    bool (*may_open)(const char *path, Error *err);
} ViewRequest;

bool view_transform_create(const ViewRequest *request, ViewTransform **out, Error *err);

/* The chosen configuration (name or path, with its fingerprint), display and view. */
const char *view_transform_config(const ViewTransform *transform);
const char *view_transform_display(const ViewTransform *transform);
const char *view_transform_view(const ViewTransform *transform);

/* rgb: pixel_count x 3 floats, interleaved, changed in place; they must be finite. */
bool view_transform_apply(const ViewTransform *transform, float *rgb, size_t pixel_count,
                          Error *err);

void view_transform_destroy(ViewTransform *transform); /* NULL is fine */

#ifdef __cplusplus
}
#endif
