/* SPDX-License-Identifier: Apache-2.0 */
/* exr_cube.h -- where a direction lies in a cube map as OpenEXR has them: six square faces
 * below each other.
 *
 * Frame    +Y up; the middle of an equirectangular picture is +Z, with +X to its left.
 * Threads  a pure function.
 */
#pragma once
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif

/* The index of the pixel, of `side` a row and side * side a face. direction: any length but
 * 0. */
size_t exr_cube_pixel(const double direction[3], int side);

#ifdef __cplusplus
}
#endif
