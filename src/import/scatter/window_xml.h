/* SPDX-License-Identifier: Apache-2.0 */
/* window_xml.h -- the parts of a WINDOW / Radiance BSDF file (XML) that a reflection needs.
 *
 * Memory   the arena's. Threads: const once read.
 * Fails    with file and line. No network, no document type, no entities.
 */
#pragma once
#include "import/set/import.h"
#include "import/scatter/scan.h"

#define WINDOW_LATITUDES_MAX 64

/* Patches of the hemisphere: latitudes, each cut into equal pieces, the first one of which has
 * its centre at azimuth 0. */
typedef struct WindowBasis {
    const char *name;
    int         latitudes;
    double      upper_deg[WINDOW_LATITUDES_MAX]; /* of each; the first one begins at 0 */
    int         pieces[WINDOW_LATITUDES_MAX];
    int         patches;
} WindowBasis;

typedef enum WindowStructure {
    WINDOW_COLUMNS, /* a column an incident patch */
    WINDOW_ROWS,
    WINDOW_TREE3,   /* isotropic tensor tree */
    WINDOW_TREE4
} WindowStructure;

typedef struct WindowXml {
    const char     *file;
    WindowStructure structure;
    WindowBasis     incident, leaving; /* of a matrix */
    WordScan        data;              /* the text of the scattering data */
    const char     *panel;             /* its name; NULL: none */
} WindowXml;

/* Photopic reflection at the front, or at the back (with a note) when that is all there is. */
bool window_xml_read(const char *file, ImportSet *set, WindowXml *out, Error *err);
