/* SPDX-License-Identifier: Apache-2.0 */
/* text_conventions.h -- which units, angles and azimuths hold in a text file.
 *
 * Memory   none. Threads: one reader each.
 */
#pragma once
#include "import/text/text_reader.h"

/* Finds them from the file, the options and the defaults; a contradiction is an error. */
bool text_conventions_find(TextReader *in);

/* The file's angles in degrees of the set's frame, theta in [0, 180]. Two raw angles: theta and
 * phi, or horizontal and vertical. */
void text_conventions_direction(const TextReader *in, const double raw[2], double *theta_deg,
                                double *phi_deg);

/* An azimuth of the file in the set's frame, [0, 360). */
double text_conventions_azimuth(const TextReader *in, double raw);
