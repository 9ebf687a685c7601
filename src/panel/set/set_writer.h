/* SPDX-License-Identifier: Apache-2.0 */
/* set_writer.h -- a measurement set becomes files: all of them or none.
 *
 * Every file is written without a name (base/file_write.h). Only when all are there do they get
 * their names, in the order in which they were added: the manifest comes last, so that whoever
 * finds one finds its tables; signals wait meanwhile. A process that is stopped before leaves
 * nothing, folders neither. On any failure what was made here goes again; a file that stood
 * there before is then as it was, unless its successor has its name already.
 *
 * Memory   its own arena, from open to close. Threads: one at a time.
 * Fails    with the file or folder that cannot be made or written, and the system's reason.
 */
#pragma once
#include <math.h>
#include <jansson.h>

#include "base/error.h"
#include "base/lines.h"
#include "text/text.h"

typedef struct SetWriter {
    const char *manifest;
    const Lines *inputs;
    struct SetFile *first, *last;
    struct SetFolder *made; /* the latest first */
    const char *place;      /* beside it the files lie until they have their names */
    int count;              /* that were opened */
    Arena arena;
    Error *err;
} SetWriter;

/* Refuses when a manifest stands there that may not be replaced. inputs: files that the set is
 * made from, of which none is ever replaced. All must outlive the writer. After a failure there
 * is nothing to close. */
bool set_writer_open(const char *manifest, const Lines *inputs, SetWriter *out, Error *err);

/* name: as the manifest names it, "emission/black.csv". Its folders and the manifest's are made
 * when absent; a name that was added already is written again. */
bool set_writer_add(SetWriter *writer, const char *name, const Text *text);

/* The manifest, indented, numbers with so many digits. */
bool set_writer_add_manifest(SetWriter *writer, const json_t *root, int digits);

/* is_whole: all that was required has been added. False, and nothing left, when it is not, or
 * when a file cannot get its name. */
bool set_writer_close(SetWriter *writer, bool is_whole);

/* The directions in which an instrument's table stands: rings of equal theta, degrees. */
typedef struct PolarGrid {
    double theta_step, phi_step;
    int rings, azimuths; /* without the normal, which stands once */
} PolarGrid;

/* phi_step becomes the nearest one that divides the circle. */
static inline PolarGrid polar_grid(double theta_step, double phi_step, int rings) {
    int azimuths = (int)round(360 / phi_step);
    return (PolarGrid){theta_step, 360.0 / azimuths, rings, azimuths};
}

static inline int polar_grid_count(const PolarGrid *grid) {
    return 1 + grid->rings * grid->azimuths;
}

/* Direction i, theta and phi; 0 is the normal. */
static inline void polar_grid_direction(const PolarGrid *grid, int i, double degrees[2]) {
    degrees[0] = i ? ((i - 1) / grid->azimuths + 1) * grid->theta_step : 0;
    degrees[1] = i ? (i - 1) % grid->azimuths * grid->phi_step : 0;
}
