/* SPDX-License-Identifier: Apache-2.0 */
/* role.h -- what a file is in a measurement set: which primary at which level, which light.
 *
 * Stated by an option ("red:255", "brdf:20:90:550") or by the file's name ("R_031.csv",
 * "i10_w550.txt").
 *
 * Memory   none. Threads: no shared state.
 */
#pragma once
#include "import/set/import.h"

typedef struct Role {
    bool is_known;
    bool is_skipped;
    ImportSource source;
    double level;
    bool has_level; /* the number itself was there */
    char component; /* 0, 'X', 'Y' or 'Z' */
    bool has_incidence, has_azimuth;
    double incidence_deg;
    double azimuth_deg;   /* of the light, in the file's own azimuths */
    double wavelength_nm; /* 0: not stated */
} Role;

/* "red[:LEVEL[:X|Y|Z]]", "black", "white", "brdf:INCIDENCE[:AZIMUTH[:WAVELENGTH]]", "skip".
 * Levels go up to level_max. */
bool role_parse(const char *text, double level_max, Role *out, Error *err);

/* Words and letters with numbers, in any case. Not known when nothing is found; *is_ambiguous
 * when more than one thing is. */
Role role_from_words(const char *words, double level_max, bool *is_ambiguous);
