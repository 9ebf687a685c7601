/* SPDX-License-Identifier: Apache-2.0 */
/* glare_reading.h -- what disturbs an eye: the sources that it sees, and how bright all else is
 * (vision/discomfort.h).
 *
 * What one source is, and whence it is known:
 *   the sun's disc, or the moon's, and an emitting part (a display too), as far as each is
 *       brighter than the threshold: by the light samples of the pupil's plane, which find
 *       small ones too, each with the solid angle that it stands for;
 *   a lamp without a surface: by its illuminance and the area of its opening; of a point of
 *       0.005 m^2, as CIE 147 counts small sources, and a directional light of the sun's disc;
 *   sky above the settings' peak, as a sun in a picture: by light samples; all of it is one;
 *   images of bright lamps in mirrors: lamp_images.h looks for them; one a lamp and mirror;
 *   images of the sun in mirrors: who looked for them (false_suns.h) names them; one a mirror;
 *   all else, such as sky in windows, sunlit walls, mirrored light: by glare_field.h, one where
 *       pixels touch.
 *
 * Units    cd m^-2, sr, lx.
 * Memory   scratch only. Threads: starts its own; the same figures for any count.
 */
#pragma once
#include "review/eye/glare_table.h"
#include "review/eye/lamp_images.h"
#include "review/light/setup.h"

/* A light sample of the pupil's plane. */
typedef struct GlareSample {
    Vec3     towards;  /* unit, world */
    float    lx;       /* that arrives; 0: none does */
    float    sr;       /* it stands for; 0: of a lamp without extent, */
    float    distance; /* which is so far away, m; INFINITY */
    int      source_id;
} GlareSample;

/* Notes a sample that came straight; else leaves *out. */
void glare_sample_note(const PathHistory *history, float lx, Vec3 eye, GlareSample *out);

/* A piece of an image of the sun. */
typedef struct GlareImage {
    int   part_id; /* the mirror's */
    Vec3  seen;    /* unit, world */
    float facing_lx; /* on a plane that faces it */
} GlareImage;

typedef struct GlareArgs {
    const Setup       *setup;
    GlareHead          head;
    GlarePaths         told; /* what glare_field_tells of paths, */
    GlarePaths         rest; /* and of the same ones what neither samples nor
                                rays show, */
    const BrightLamps *lamps; /* nor images of these */
    const GlareSample *samples[LIGHT_SETS]; /* [rest.count] */
    int                rounds;   /* of as many of both: they differ in nothing but chance */
    GlareImage        *images;   /* are put in order */
    int                image_count;
    double             task_cd_m2; /* the task's mean luminance */
} GlareArgs;

GlareReading glare_read(const GlareArgs *args, Arena scratch);
