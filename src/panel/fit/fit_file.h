/* SPDX-License-Identifier: Apache-2.0 */
/* fit_file.h -- a panel file's bytes from what the fit made of a measurement.
 *
 * Memory   the arena's. Threads: one at a time. Fails: opening, as panel_open.h.
 */
#pragma once
#include <jansson.h>

#include "panel/fit/emission/emission_fit.h"
#include "panel/fit/fit_places.h"
#include "panel/fit/reflection/reflection_fit.h"
#include "panel/query/panel.h"

typedef struct FitParts {
    const Measurement      *set;
    const FitOptions       *options;
    const EmissionResult   *emission; /* NULL: none */
    const void             *primaries; /* the section */
    size_t                  primaries_size;
    const char             *spectra_assumed; /* in words; NULL: they were measured */
    const ReflectionResult *reflection; /* NULL: none */
    FitNotes               *notes;
    int                     notes_before_reflection;
    bool                    saves; /* the tables of the report are compressed */
    const FitPlaces        *places; /* NULL: one panel everywhere */
    const json_t           *spots;  /* its panels' entries in the report; NULL: none */
    const void             *tables; /* of the report, packed (panel_report.h); NULL: not yet */
    size_t                  tables_size;
    const void             *meta; /* the report, packed; NULL: not yet */
    size_t                  meta_size;
} FitParts;

/* The file's bytes; *size bytes in the arena, aligned to 64. */
void *fit_file_bytes(const FitParts *parts, Arena *arena, size_t *size);

/* The panel that these bytes will be; NULL: failed. path: what messages call it. */
Panel *fit_file_open(const FitParts *parts, const char *path, Arena *arena, size_t *size,
                     Error *err);
