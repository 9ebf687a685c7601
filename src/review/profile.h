/* SPDX-License-Identifier: Apache-2.0 */
/* profile.h -- limits as data: what a standard, or a house, requires of what is to be read.
 *
 * A profile is a JSON file (assets/schemas/profile.md). Those of assets/profiles are inside the
 * program; any other is named by its path.
 *
 * Units    those of each kind of limit; lx.
 * Memory   texts and lists live in the arena.
 * Threads  plain data.
 * Fails    loading does, with file, place, found and required.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "record/record.h"
#include "review/quantity.h"

enum { AMBIENT_COUNT = 4 };

/* A limit that rises as characters get smaller: for heights of from_arcmin to to_arcmin it is
 * value + per_arcmin (reference_arcmin - height), and there is none beyond them. */
typedef struct LimitSlope {
    bool has_slope;
    double per_arcmin, reference_arcmin, from_arcmin, to_arcmin;
} LimitSlope;

typedef struct ProfileLimit {
    const char *name;
    LimitKind kind;
    bool ambients[AMBIENT_COUNT]; /* under which it is required */
    bool is_upper;                /* the most, not the least */
    bool is_advice;               /* preferred, not required: shown and not counted */
    double value;                 /* above 0 */
    LimitSlope slope;
    const char *source;
    bool read_in_the_standard;
} ProfileLimit;

/* Further content of the standard, for readers: its measuring light, its terms. */
typedef struct ProfileFact {
    const char *name, *text, *unit; /* text: its meaning, or ""; unit: "" without a value */
    double value;                   /* NaN: none */
    const char *source;
    bool read_in_the_standard;
} ProfileFact;

typedef struct Profile {
    const char *id;     /* "iso-15008", or the file's path */
    uint64_t file_hash; /* of that file (text/json_view.h); 0: inside the program */
    const char *title, *edition;
    const char *superseded_by; /* what stands in its place, and whence that is known; NULL: it
                                  is in force, or nobody says */
    bool uses_veil;            /* contrast counts with the veil over it */
    double increment_most_pct; /* threshold increment of a gaze at a road by night, at
                                  most: its own key, or the least of `limits`; NaN: none */
    double night_below_lx, twilight_below_lx; /* of the display's face */
    const char *ambient_source;
    bool ambient_read_in_the_standard;
    const ProfileLimit *limits; /* each for what its quantity is of (quantity.h) */
    int limit_count;            /* 0: it sets none */
    ProfileLimit security;      /* of what must not be read, where `limits` have none for its
                                   light, or whatever they have: */
    bool is_security_own;       /* the review's own (profile_with_security) */
    const ProfileFact *facts;
    int fact_count;
} Profile;

extern const RecordFormat profile_format; /* of a Profile */

/* A name of assets/profiles, or a path, which holds a '/' or ends in ".json". */
bool profile_load(const char *name_or_path, Arena *arena, const Profile **out, Error *err);

/* The same profile with a review's own least visual security, above 0; it lies in the arena. */
const Profile *profile_with_security(const Profile *profile, double least, Arena *arena);

/* The names of those inside the program, with commas. */
const char *profile_names(Arena *arena);

/* Has it a limit of that kind, advice included? */
bool profile_has(const Profile *profile, LimitKind kind);

/* Direct sun on the display is AMBIENT_SUN; else its illuminance decides. */
Ambient profile_ambient(const Profile *profile, double display_lux, bool sun_on_display);
