/* SPDX-License-Identifier: Apache-2.0 */
/* fit_file.h -- a panel file's bytes from what the fit made of a measurement.
 *
 * Memory   the arena's. Threads: one at a time. Fails: opening, as panel_open.h.
 */
#pragma once
#include <jansson.h>

#include "panel/fit/emission/emission_fit.h"
#include "panel/fit/reflection/reflection_fit.h"
#include "panel/query/panel.h"
#include "panel/query/panel_file.h"
#include "panel/set/measurement.h"

/* ---- places ----------------------------------------------------------------------------- */

/* The spots and the map of a set as sections of a panel file (panel_file.h:
 * PANEL_SPOTS, PANEL_SPOT_FILE, PANEL_MAP).
 *
 * The file's own panel is the set's own tables. Where the set has none, it is those of the spot
 * nearest to the middle that has them; that spot then needs no panel of its own. One spot alone
 * is everywhere: its file is that of a set without spots.
 *
 * Memory   the arena's. Threads: one at a time. */

/* Which panels there are to fit, and what of them goes into the file. */
typedef struct FitPlaces {
    Measurement own;
    int panels;            /* besides the own */
    Measurement *of_panel; /* what each is fitted from */
    int *spot_of_panel;    /* index of the set's spot */
    const void **bytes;    /* the file of each, once it is fitted */
    size_t *sizes;
    int spots;
    PanelSpotStored *spot;
    float own_at[2];
    const void *map; /* the section; NULL: none, or not yet */
    size_t map_size;
} FitPlaces;

void fit_places_plan(const Measurement *set, Arena *arena, FitPlaces *out);

/* Anything to write? Else the file is that of one panel everywhere. */
static inline bool fit_places_are_there(const FitPlaces *places) {
    return places->spots || places->map;
}

/* Makes the map's section. panel: of the file as it is without the map; it takes out what a
 * camera that stands at one point saw under an angle. Fails, naming the map's file, where it is
 * dark at a place that was measured. */
bool fit_places_add_map(const Measurement *set, const Panel *panel, Arena *arena, FitPlaces *places,
                        Error *err);

typedef struct FitParts {
    const Measurement *set;
    const FitOptions *options;
    const EmissionResult *emission; /* NULL: none */
    const void *primaries;          /* the section */
    size_t primaries_size;
    const char *spectra_assumed;        /* in words; NULL: they were measured */
    const ReflectionResult *reflection; /* NULL: none */
    FitNotes *notes;
    const FitPlaces *places; /* NULL: one panel everywhere */
    const json_t *spots;     /* its panels' entries in the report; NULL: none */
} FitParts;

/* The file's bytes with a report, into which its sizes go; lists of single samples stay out of
 * the file. *size bytes in the arena, aligned to 64; NULL: memory is out. */
void *fit_file_bytes(const FitParts *parts, json_t *report, Arena *arena, size_t *size);

/* The panel that these bytes will be, without a report; NULL: failed. path: what messages call
 * it. */
Panel *fit_file_open(const FitParts *parts, const char *path, Arena *arena, Error *err);
