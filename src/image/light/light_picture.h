/* SPDX-License-Identifier: Apache-2.0 */
/* light_picture.h -- a picture of surroundings as light: an equirectangular picture in cd m^-2.
 *
 * Read as every file of light is (light_file.h), over its display window, black where the data
 * window does not reach; colours of an OpenEXR file are multiplied by its alpha already. A cube
 * map, as the attribute `envmap` of an OpenEXR file says (openexr/exr_cube.h), becomes an
 * equirectangular picture of as many pixels along the equator. Light is not negative: such
 * values, and those that are not finite, count as 0, with a warning. There are warnings, too,
 * for what does not look like a picture of surroundings: one that is not twice as wide as high,
 * or that states a view.
 *
 * Units    linear Rec.709, cd m^-2. Memory: the arena's. Threads: no shared state.
 * Fails    as light_file_read_memory; for pictures of codes; for cube maps that are none.
 */
#pragma once
#include "base/file.h"
#include "base/problems.h"
#include "image/image.h"

typedef struct LightPicture {
    Image image;       /* IMAGE_RGBA32F, finite, not negative */
    double unit_cd_m2; /* luminance of a white whose stored values are 1 */
} LightPicture;

bool light_picture_read(FileBytes bytes, const char *name, Arena *arena, Problems *problems,
                        LightPicture *out, Error *err);
