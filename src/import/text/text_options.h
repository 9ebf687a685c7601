/* SPDX-License-Identifier: Apache-2.0 */
/* text_options.h -- the user's options for text tables: layout, units, azimuths, roles.
 *
 * Every member has a value for "not given"; the file's own statement is then taken. Where
 * there is none, either this project's own convention holds (azimuth 0 right, counter-
 * clockwise, degrees, cd/m2: with a note) or the file is refused with the option to give.
 *
 * Memory   texts stay the caller's. Threads: const while files are read.
 */
#pragma once
#include "import/set/role.h"
#include "import/text/text_lines.h"
#include "import/text/text_names.h"

#define TEXT_COLUMNS_MAX 2048
#define TEXT_ENTRIES_MAX 256 /* roles, masks, comments */

typedef enum TableLayout {
    LAYOUT_AUTO,
    LAYOUT_LIST,       /* a direction a row */
    LAYOUT_THETA_DOWN, /* a matrix: theta in the first column, phi in the first row */
    LAYOUT_PHI_DOWN,
    LAYOUT_HORIZONTAL_DOWN, /* a matrix of horizontal and vertical angles */
    LAYOUT_VERTICAL_DOWN
} TableLayout;

/* Which two angles the columns theta and phi, or horizontal and vertical, are. */
typedef enum AnglePair {
    ANGLES_AUTO,
    ANGLES_POLAR,       /* theta from the normal, phi around it */
    ANGLES_PROJECTED,   /* tan h = tan theta cos phi, tan v = tan theta sin phi */
    ANGLES_EQUIDISTANT, /* h = theta cos phi, v = theta sin phi */
    ANGLES_NORTH_POLAR, /* vertical axis of rotation first: x = cos v sin h, y = sin v */
    ANGLES_EAST_POLAR   /* horizontal axis first: x = sin h, y = cos h sin v */
} AnglePair;

typedef struct RoleRow {
    const char *pattern; /* of the file's name or path */
    const char *role;
} RoleRow;

typedef struct TextList {
    const char *text[TEXT_ENTRIES_MAX];
    int count;
} TextList;

typedef struct TextOptions {
    TableLayout layout;
    const char *columns;  /* "theta,phi,X,Y,Z"; "-" skips one; NULL: as in the header */
    const char *quantity; /* of a matrix: "X", "L", "brdf", ...; NULL: not given */
    TextDialect dialect;
    TextEncoding encoding;
    int skip_lines;
    TextList comment; /* beginnings of comment lines besides # ! % // */
    TextList mask;    /* values that mean "not measured" */
    TextList section; /* "PATTERN=DEG": the azimuth of files that have theta alone */
    AngleUnit angle_unit;
    AnglePair angles;
    ValueUnit unit;
    bool has_azimuth_zero, has_light_azimuth;
    double azimuth_zero_deg;  /* where the file's azimuth 0 points, 0 right, 90 up */
    int azimuth_sense;        /* 1 counter-clockwise, -1 clockwise, 0 not given */
    int seen_from;            /* 1 the viewer's side, -1 behind the panel, 0 not given */
    double light_azimuth_deg; /* of all reflection tables, in the file's azimuths */
    double white_reflectance; /* 0: not given */
    double level_max;         /* the panel's highest code; 0: 255 */
    RoleRow role[TEXT_ENTRIES_MAX];
    int role_count;
} TextOptions;

/* All keys, with their values and meaning: for the command line, help and the README. */
typedef struct TextKey {
    const char *key, *values, *help;
} TextKey;
extern const TextKey text_keys[];
extern const int text_key_count;

/* Sets one key ("azimuth_zero", "top") from text. A list's key adds. */
bool text_options_set(TextOptions *options, const char *key, const char *value, Error *err);

/* The panel's highest code. */
static inline double text_options_level_max(const TextOptions *options) {
    return options->level_max > 0 ? options->level_max : 255;
}

/* The azimuth that --section gives to a file with theta alone; false: none. */
bool text_options_section(const TextOptions *options, const char *file, double *phi);

/* The role that --role gives to a file; NULL: none. */
const char *text_options_role(const TextOptions *options, const char *file);
