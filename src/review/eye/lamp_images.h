/* SPDX-License-Identifier: Apache-2.0 */
/* lamp_images.h -- images of bright lamps in mirrors, panes and the fronts of displays, as an
 * eye sees them: how bright, how large, where. Glare weighs luminance by its square, so that a
 * mean over a field of view that is wider than the image does not show it.
 *
 * A picture of the half space in front of the eye, a ray a cell. Cells behind whose mirrors a
 * lamp may lie are cut, again and again, until enough of them show the image: so that one of a
 * thousandth of a degree is found. Rays go by sure mirrors (PATH_BY_SURE_MIRRORS); where a
 * laminated pane shows one of two images by chance, each is the mean of many.
 *
 * Reported     lamps via opaque mirrors; the first may be a thin pane. What comes by
 *              solids of glass, or by a pane that stands behind a mirror, is not.
 * Approximate  a mirror narrower than a cell of the first picture may be missed.
 * Units        cd m^-2, sr, metres, scene.
 * Memory       lists live in the arena. Threads: a search starts its own; the same figures for
 *              any count.
 */
#pragma once
#include "review/eye/glare_table.h"
#include "review/light/setup.h"

/* How bright a lamp may be that no path met: chance alone finds what an eye
 * sees straight or in mirrors, and a small lamp may be missed.
 *
 * Lamps are emitting parts, displays among them (by their white over the hemisphere). The sun
 * is none: false_suns.h looks for its images. Whether something stands before a lamp is not
 * requested.
 *
 * Units    cd m^-2; metres, scene; radians.
 * Memory   lists live in the arena.
 * Threads  pure functions. */

/* A triangle of one, or all of it: the ball that holds it. */
typedef struct Lamp {
    Vec3   middle;
    double radius, cd_m2;
} Lamp;

/* Brightest first. */
typedef struct UnmetLamps {
    Lamp *list;
    int   count;
} UnmetLamps;

/* Those of parts that are not met ([part]). */
UnmetLamps lamps_unmet(const Setup *setup, const bool *met, Arena *arena);

/* The brightest that may be seen along the ray or within half an angle of it; 0: none. */
double lamps_brightest(const UnmetLamps *lamps, Ray ray, double half);

/* Emitting parts whose images may be brighter than a threshold. */
typedef struct BrightLamps {
    const Scene *scene;
    Lamp        *list;     /* balls that hold a part each, */
    Lamp       **pieces;   /* and one of its triangles each */
    int         *part_ids; /* likewise */
    bool        *is_one;   /* [part] */
    double      *cd_m2;    /* likewise */
    int          count;
} BrightLamps;

BrightLamps bright_lamps(const Scene *scene, double least_cd_m2, Arena *arena);

/* Is this light of a bright lamp that lamp_images_find reports? */
bool bright_lamps_tell(const BrightLamps *lamps, const PathHistory *history);

/* A piece of the image of a lamp in the mirror that the eye sees. */
typedef struct LampImage {
    int    pair;    /* lamp and mirror */
    Vec3   towards; /* unit, world */
    double cd_m2, sr;
    int    x, y;    /* in a raster over the picture */
} LampImage;

typedef struct LampImages {
    LampImage *list;
    int        count, pairs;
} LampImages;

typedef struct LampImagesArgs {
    const Setup       *setup;
    const GlareHead   *head;
    const BrightLamps *lamps;
    int      pixels; /* cells over 180 degrees at first */
    uint32_t seed;
} LampImagesArgs;

LampImages lamp_images_find(const LampImagesArgs *args, Arena *arena);
