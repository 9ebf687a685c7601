/* SPDX-License-Identifier: Apache-2.0 */
/* eye_reading.h -- what stray light does to an eye that looks somewhere, from all that it sees,
 * also outside any frame.
 *
 * The veil that it lays over that place: the integral of f(theta) L cos theta over the
 * hemisphere in front, from 0.1 degrees on, f the spread of vision/eye_spread.h.
 * The sun, when the eye sees it straight or through windows, counts by its illuminance at its
 * own angle.
 *
 * Lamps, displays and the sun that the eye sees by themselves are read by light samples, lamps
 * without a body too; all else by paths that are drawn as the veil weighs them. Images of the
 * sun in mirrors are small and bright, so that these paths find them by luck alone: who has
 * looked for them (false_suns.h) names them, and paths then count only those beyond that field.
 *
 * Units        cd m^-2, lx.
 * Memory       scratch only. Threads: starts its own; the same figures for any count.
 */
#pragma once
#include "estimate/estimate.h"
#include "review/eye/false_suns.h"
#include "review/eye/road_veils.h"

#define EYE_NEAR_DEG 1.0 /* from the gaze; about the fovea, where the eye sees sharply */
#define EYE_CLOSE_DEG 5.0

/* Where an eye looks from, and how surely it is to be known: rounds of 4096 paths, which differ
 * in nothing but chance. */
typedef struct EyeLook {
    Vec3 eye;                /* m, scene */
    Vec3 towards;            /* any length but 0 */
    int rounds;              /* 1 .. ESTIMATE_BATCHES */
    const FalseSuns *images; /* from there; NULL: nobody looked */
    bool is_close;   /* within EYE_CLOSE_DEG of the gaze glowing surfaces and displays are read by
                        the paths, which lie ever closer there, not by light samples, of which few
                        meet what lies about a symbol and weighs most */
    RoadVeils *road; /* gets the same light; NULL: not requested */
} EyeLook;

/* Where light begins that the eye scatters. */
typedef enum EyeSource {
    EYE_SUN, /* seen straight or through glass; so are the next two */
    EYE_SKY,
    EYE_LAMPS,    /* and displays */
    EYE_GLINTS,   /* sun, lamps and displays via mirrors and panes alone */
    EYE_SURFACES, /* all else: what is lit, and the sky in mirrors */
    EYE_NEAR,     /* sky and surfaces within EYE_NEAR_DEG: what the eye looks at */
    EYE_SOURCES
} EyeSource;

typedef struct EyeReading {
    double veil;               /* cd m^-2 */
    double beside[2];          /* its X and Z, of a look without `images` */
    double veil_sigma;         /* its standard error, */
    MeanInterval veil_range;   /* and 95 % interval; NaN of one round */
    double parts[EYE_SOURCES]; /* the veil's; they add up to it */
    double vertical_lx;        /* on the pupil's plane, all light */
} EyeReading;

/* The request's observer. */
EyeReading eye_read(const Setup *setup, const EyeLook *look, Arena scratch);
