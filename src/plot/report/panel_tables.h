/* SPDX-License-Identifier: Apache-2.0 */
/* panel_tables.h -- the tables of a panel's report: at which angle a display falls below a
 * limit, its white, colour shift, primaries and gamut, gamma and grey inversion, reflectance,
 * contrast in ambient light, evenness, and how far the file is from what was measured.
 *
 * Units    degrees, cd m^-2, K, lx, percent. Memory: the arena's. Threads: one at a time.
 * Fails    never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "table/table.h"

/* Light on the panel: an even surround, and a directed source at an angle to the normal. */
typedef struct AmbientLight {
    double lux;            /* of the surround; 0: none */
    double directed_lux;   /* on the panel's plane; 0: none */
    double directed_theta; /* radians; its azimuth is the data's incidence_phi */
} AmbientLight;

#define AMBIENT_MAX 8

typedef struct Ambient {
    int count;
    AmbientLight light[AMBIENT_MAX];
} Ambient;

#define REPORT_TABLES_MAX 24

typedef struct Report {
    Arena *arena;
    int count;
    Table *table[REPORT_TABLES_MAX];
} Report;

/* Was azimuth 45 index degrees measured? By emission.azimuths_deg of a panel file's report: those
 * measured, where they stand 45 degrees apart or more; without it every one has a measured one
 * near. */
bool report_has_azimuth(const json_t *report, int index);

/* ambient: light in which contrast is stated besides that of the standards. */
Report *panel_tables(const PlotData *data, const Ambient *ambient, Arena *arena);
