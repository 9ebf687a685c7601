/* SPDX-License-Identifier: Apache-2.0 */
/* missed_light.h -- light that no connection of a path finds: what a frame may miss.
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
 * Memory   from the arena.  Threads: any number, the same bits.
 */
#pragma once
#include "missed/missed_eye.h"
#include "path/connected.h"

#define MISSED_SHARE 0.01 /* of an eye's light: less is not worth a word */

/* Light of one lamp that goes first by one mirror, or into one solid. */
typedef struct MissedPair {
    ChainLight from;
    int light_id; /* lamp: of Scene.lights; emitter: of Scene.parts; sun: 0 */
    int part_id;  /* the mirror or solid */
    bool is_solid;
    int then_id;  /* the part that most of it comes to next, smooth as well; NO_ID: none */
    int eye;      /* of those asked, the one of which it is the largest share */
    double light; /* there, about */
    double share; /* of all light that is there with what is missed */
} MissedPair;

typedef struct MissedLight {
    const MissedPair *pairs; /* of MISSED_SHARE at least, the largest first */
    int count;
    const MissedEye *eyes;
    double share; /* that all together are of an eye's light, the largest of any eye: of a
                     camera the mean over parts of its picture */
    double light; /* there, about */
    int eye;      /* the one */
} MissedLight;

/* The eyes must outlive the answer. Ways have as many bounces as the context allows. */
MissedLight missed_light_find(const PathContext *context, const MissedEye *eyes, int eye_count,
                              Arena *arena);
