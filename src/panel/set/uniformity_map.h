/* SPDX-License-Identifier: Apache-2.0 */
/* uniformity_map.h -- relative XYZ of a display's white and black over its surface, from an
 * imaging colorimeter.
 *
 * The key "uniformity" of a manifest: "file" holds white and may hold black, "black" names a
 * file of its own for black. A picture's first row is the top of the active area as someone
 * facing the display sees it, its pixels cover the area evenly.
 *   .exr         channels X, Y, Z, or Y alone; black.X, black.Y, black.Z or black.Y
 *   .csv         columns column, row (whole numbers from 0), X, Y, Z or Y; black_X ... or
 *                black_Y; every pixel once
 *   .png, .tif   16 bits, linear: grey is Y, red, green and blue are X, Y and Z
 * Only ratios count, so that cd m^-2 will do as well as shares of one.
 *
 * Memory   the arena's. Threads: const once read.
 * Fails    with file, place, found and required.
 */
#pragma once
#include "record/record.h"

#define UNIFORMITY_SIDE_MAX 8192
#define UNIFORMITY_PIXELS_MAX (1 << 23)

typedef struct UniformityMap {
    const char *file;
    int width, height;
    int white_channels, black_channels; /* 1: X, Y and Z alike; black 0: as white */
    const float *value[6];              /* planes of white, then of black; from 0 up */
    /* The camera saw all places from one point, and not each along its own normal: */
    bool is_seen;
    double camera_mm; /* the camera's distance from the middle, along the normal; 0: infinite */
    double bend;      /* radians: angle between the normals at the left and right edge, of a
                         display bent around its vertical axis; above 0: towards the viewer
                         (concave) */
} UniformityMap;

/* The key as it stands. */
typedef struct UniformityFiles {
    const char *file, *black; /* NULL: none */
    double camera_mm;         /* 0: it saw each place along its own normal */
    double bend;              /* radians */
} UniformityFiles;

extern const RecordFormat uniformity_format;

/* Without a file *out stays NULL. manifest: for messages. */
bool uniformity_map_read(const UniformityFiles *files, const char *manifest, Arena *arena,
                         const UniformityMap **out, Error *err);
