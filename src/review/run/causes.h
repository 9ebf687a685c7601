/* SPDX-License-Identifier: Apache-2.0 */
/* causes.h -- by which chains of objects light comes to a symbol, what hides it, and what would
 * mend it.
 *
 * The chains are those of review/chain. Light that the display itself emits straight to the eye
 * is none of it.
 *
 * Units    cd m^-2.
 * Memory   texts and lists live in the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/chain/chains.h"
#include "review/profile.h"
#include "review/symbol/symbol_sight.h"
#include "review/verdict.h"

#define CAUSES_MOST 10
#define CAUSE_PATHS 8192
#define CAUSE_RAYS 4

typedef struct CauseAsk {
    const ReadingTools *tools;
    const ProbeAim     *aim;
    long                paths;
    int                 rays;        /* of each cause, at most CHAIN_RAYS */
    bool                with_direct; /* what the eye sees by itself counts, too */
    bool                sets_luminances; /* the case has no reading: these paths give what is
                                            reflected */
} CauseAsk;

/* A surface or pane that could be made black. */
typedef struct CausePart {
    const char *what;  /* to do with it */
    double      cd_m2; /* all reflected light that comes by it */
} CausePart;

/* Input of the remedies besides the case. */
typedef struct CauseFacts {
    double      own_cd_m2;  /* reflected light that began at the display itself */
    ChainFigure all, mirror; /* of these paths; and by the display's mirror */
    CausePart   parts[2];    /* the surface and the pane by which most of it comes */
    int         part_count;
} CauseFacts;

/* Sets the case's causes: the greatest CAUSES_MOST, and "all other ways", which add up to the
 * reflected light by these paths, and the groups; that light itself where asked. */
CauseFacts case_causes(const CauseAsk *ask, ReviewCase *c, Arena *arena);

/* Sets its remedies, from its figures and causes: nothing is traced. They are for the contrast
 * limit that is missed by most; where none is missed, or the case cannot be judged, there are
 * none, nor is anything listed that leaves the figure within the interval it has. A brightness
 * is that with which the case is judged to keep the limit: with as much more light than was
 * found as its interval is wide, so that fresh paths find it kept as well. */
void case_remedies(const CauseFacts *facts, const Profile *profile, ReviewCase *c,
                   Arena *arena);

/* Sets the case's hiders, by the names of nodes and materials; what has the same name counts as
 * one. */
void case_hiders(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                 ReviewCase *c, Arena *arena);
