/* SPDX-License-Identifier: Apache-2.0 */
/* text_conventions.h -- which units, angles and azimuths hold in a text file.
 *
 * Memory   none. Threads: one reader each.
 */
#pragma once
#include "import/text/text_scan.h"

/* One text file on its way from raw rows to tables of the set. */
typedef struct TextReader {
    const char *file;
    const TextOptions *options;
    const ImportOptions *import; /* of every format */
    ImportSet *set;
    Error *err;
    NamedRows *raw;
    TextMetadata metadata;
    int column[QUANTITY_COUNT]; /* of the raw rows, or -1 */
    bool is_reflection;
    Role role;
    bool is_section; /* theta alone, all at section_phi (the file's azimuth) */
    double section_phi;
    ValueUnit unit; /* this and the rest: the conventions */
    bool is_radians;
    AnglePair angles;
    double zero_deg; /* azimuth = zero + sense * the file's */
    int sense;
} TextReader;

/* Finds them from the file, the options and the defaults; a contradiction is an error. */
bool text_conventions_find(TextReader *in);

/* The file's angles in degrees of the set's frame, theta in [0, 180]. Two raw angles: theta and
 * phi, or horizontal and vertical. */
void text_conventions_direction(const TextReader *in, const double raw[2], double *theta_deg,
                                double *phi_deg);

/* An azimuth of the file in the set's frame, [0, 360). */
double text_conventions_azimuth(const TextReader *in, double raw);
