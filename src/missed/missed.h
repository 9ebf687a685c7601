/* SPDX-License-Identifier: Apache-2.0 */
/* missed.h -- light that no connection of a path finds: what a frame may miss.
 *
 * Before the first sample, rays of the lights go to the smooth surfaces (mirrors, panes, lacquer,
 * displays, solids), each for a piece of their area, and are followed by them, through solids
 * and on by further ones, up to MISSED_EVENTS of them, to the surfaces that scatter. Chains that
 * paths connect (path/connected.h) count nothing. What the others bring to a camera's picture,
 * at once or by one more surface that scatters, or to the front of a display, is put beside what
 * a few paths find there. No luck is needed: it is asked from the light's side.
 *
 * A light counts where chance hardly finds it from the surface that it lands on: lamps without
 * a surface, the sun, and emitters whose area over the squared length of the way is below
 * MISSED_COMPACT_SR: less than one path in 3,000 meets them.
 *
 * Not looked at: nearly smooth and rough mirrors, skies, and what an eye sees of it by mirrors.
 *
 * Units    an eye's light is the mean luminance of a camera's picture, cd m^-2, or the
 *          illuminance of a display's front, lx.
 * Memory   from the arena; texts likewise.  Threads: any number, the same bits.
 */
#pragma once
#include "base/progress.h"
#include "missed/missed_rays.h"

#define MISSED_SHARE 0.01 /* of an eye's light: less is not worth a word */

typedef struct MissedPair {
    MissedWay way;
    int eye;      /* of those asked, the one of which it is the largest share */
    double light; /* there, about */
    double share; /* of all light that is there with what is missed: of a camera the mean over
                     parts of its picture */
} MissedPair;

typedef struct MissedLight {
    const MissedPair *pairs; /* of MISSED_SHARE at least, the largest first */
    int count;
    const MissedEye *eyes;
    MissedPair all; /* together; of no way */
} MissedLight;

/* The eyes must outlive the answer. Ways have as many bounces as the context allows. */
MissedLight missed_light_find(const PathContext *context, const MissedEye *eyes, int eye_count,
                              Arena *arena);

/* ---- a scene as it is loaded ------------------------------------------------------------- */

typedef struct MissedRun {
    int threads;
    ProgressMode progress; /* of the ray tracer's structure */
} MissedRun;

/* By whoever may look: its cameras (without one, that which frames it) and its displays. Nothing
 * is missed where neither sun nor lamps shine. */
bool missed_in_scene(const Scene *scene, const MissedRun *run, Arena *arena, MissedLight *out,
                     Error *err);

/* ---- in words ---------------------------------------------------------------------------- */

/* One line after the other; NULL: there are no more.
 * `lamp "left" shines through solid "lens", then "visor": this light is not followed (0.4 lx on
 * display "cluster" are missing, 12 % of what is there)`; of the sun and emitters, that chance
 * alone finds it; at last how many more there are. */
const char *missed_line(const Scene *scene, const MissedLight *missed, int line, Arena *arena);

/* What is missed in all, and of which pairs the most; NULL: less than MISSED_SHARE. */
const char *missed_words(const Scene *scene, const MissedLight *missed, Arena *arena);

/* "sun", "lamp", "emitter"; and what the light is called, "" of the sun. */
const char *missed_kind(ChainLight from);
const char *missed_name(const Scene *scene, const MissedWay *way);
