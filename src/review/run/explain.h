/* SPDX-License-Identifier: Apache-2.0 */
/* explain.h -- why one thing looks as it does: a symbol of a review under one condition, a
 * display, or a part of a camera's picture.
 *
 * The answer is a ReviewCase with its causes, by more paths than a review takes, and with more
 * of their rays.
 *
 * Units    verdict.h's.
 * Memory   the answer lives in the arena.
 * Threads  starts its own; the same figures for any count.
 * Fails    where a name is missing or not known: the text lists those that there are.
 */
#pragma once
#include "review/chain/causes.h"
#include "review/profile.h"
#include "review/run/cases.h"

typedef struct ExplainOptions {
    const char *condition, *eye, *symbol; /* NULL: there is only one */
    bool has_sun;                         /* of a sweep: which of its suns, */
    double sun_deg[2];                    /* azimuth of the vehicle, elevation */
    SetupMeans means;
    long paths;
    const Profile *profile;                                   /* limits */
    Problems *problems;                                       /* warnings of the scene */
    bool (*read)(void *user, const Scene *scene, Error *err); /* before it is traced */
    void *user;
} ExplainOptions;

typedef struct Explained {
    ReviewCase of; /* `symbol` NULL: no symbol; contrasts NaN: no display */
    double shown;  /* cd m^-2: of a display without a symbol what it emits, mean */
    Chains chains; /* of a place: as its causes, first to last */
    bool has_pixel;
    PixelLight light; /* of a pixel */
    long paths;
} Explained;

bool explain_review(const ReviewRequest *request, const ExplainOptions *options, Arena *arena,
                    Explained *out, Error *err);

/* A scene that is lit, and what is looked at in it. */
typedef struct ExplainPlace {
    const ProbeTools *tools;
    ProbeAim aim; /* along its targets the eye looks; a path each, and again. With a
                     pixel its samples are traced, and the targets, which lie in
                     it, tell whether it shows a display */
    long paths;
    int most; /* chains that are listed by themselves */
} ExplainPlace;

/* Where at least half of the targets show a display, contrasts are those of white and black as
 * they come to the eye, on what the display reflects. Of a display without a pixel those targets
 * alone count, and the light is what it reflects; else it is all that comes to the eye. */
void explain_place(const ExplainPlace *place, Arena *arena, Explained *out);
