/* SPDX-License-Identifier: Apache-2.0 */
/* request_start.h -- a REVIEW.json to start from: a scene's displays and eyes, a noon, a night
 * and a year.
 *
 * Every perspective camera is an eye, marked as proposed. Every display that shows something
 * has one symbol, "find": "text" over what it shows of its content; one whose material several
 * nodes wear has one a node. Wishes set more, and put an ordinary day and night and a sweep
 * over every sun beside them.
 *
 * Memory   the arena's. Threads: one at a time.
 * Fails    ERROR_INPUT when the scene has no such display or camera, or lies where the file may
 *          not name it (base/reference.h); ERROR_OUTPUT when there is a file already, or it
 *          cannot be written.
 */
#pragma once
#include "scene/scene.h"

typedef struct ReviewPlace {
    double where[3]; /* latitude and longitude, degrees; altitude, m */
    int year;
    const double *headings_deg;
    int heading_count; /* 1 or more */
} ReviewPlace;

/* What is read of a display: a rectangle of its content. */
typedef struct ReviewRead {
    const char *display, *name, *polarity; /* polarity NULL: "auto" */
    const double *uv;                      /* left, top, right, bottom */
} ReviewRead;

typedef struct ReviewWishes {
    const char *profile;          /* a name, or a path as the new file has it */
    double forward[3];            /* where the vehicle points, world */
    const char *const *eyes;      /* the cameras that are eyes, by their nodes' names */
    const char *const *eyes_from; /* what each was proposed from; NULL: it was given */
    int eye_count;                /* 1 or more */
    const char *const *displays;  /* those in which text is to be found, by name */
    int display_count;
    const ReviewRead *reads; /* and what is to be read of others */
    int read_count;
    const ReviewPlace *place; /* NULL: no year */
    const char *occupant;     /* who sits there in every condition; NULL: nobody */
    const char *occupant_uri; /* the file that he is, as the new file names it */
} ReviewWishes;

typedef struct ReviewStart {
    const char *const *scenes; /* the scene's files, as the user named them */
    int scene_count;
    const char *output;
    const char *root;           /* --root: a folder whose files may be named too; NULL: none */
    const ReviewWishes *wishes; /* NULL: as the scene has it, and a place and year to change */
    bool replaces;              /* a file that is there already */
} ReviewStart;

bool review_request_start(const ReviewStart *start, const Scene *scene, Arena *arena, Error *err);
