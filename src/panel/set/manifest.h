/* SPDX-License-Identifier: Apache-2.0 */
/* manifest.h -- MANIFEST.json of a measurement set as it stands: which tables there are. What
 * they hold is read by measurement.h.
 *
 * Units    the file's: degrees, mm, nm. Paths are as seen from the manifest's folder.
 * Memory   the view's arena. Threads: const once read.
 * Fails    with file, JSON path, found and required.
 */
#pragma once
#include "panel/set/measured.h"
#include "record/record.h"

typedef struct ManifestLevel {
    const char *name; /* "255" */
    const char *table;
    double level;
} ManifestLevel;

typedef struct ManifestEmission {
    bool is_there;
    const char *black, *white; /* tables; NULL: there is none */
    ManifestLevel *primary[3]; /* red, green, blue: levels, rising */
    int level_count[3];
    const char *levels; /* of white: a gamma table; NULL: none */
} ManifestEmission;

typedef struct ManifestReflection {
    bool is_there;
    const char *path;
    const double *wavelength_nm, *incidence_deg, *azimuth_deg; /* each rising */
    int wavelength_count, incidence_count, azimuth_count;      /* 0: isotropic */
    const char *files; /* a pattern with {incidence}, {azimuth} */
    SpecularFile specular;
    const GlossReading *gloss;
    int gloss_count;
} ManifestReflection;

typedef struct ManifestSpot {
    const char *path;
    double position[2]; /* shares, right and down from the upper left corner */
    ManifestEmission emission;
    ManifestReflection reflection;
} ManifestSpot;

typedef struct Manifest {
    Measurement set; /* all but what tables hold */
    ManifestEmission emission;
    ManifestReflection reflection;
    const ManifestSpot *spot;
    int spot_count;
    UniformityFiles uniformity;
    const char *primaries; /* their spectra; NULL: not measured */
} Manifest;

extern const RecordFormat manifest_format;
