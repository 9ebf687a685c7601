/* SPDX-License-Identifier: Apache-2.0 */
/* text_metadata.h -- the metadata in the lines around a file's numbers.
 *
 * Memory   the arena's. Threads: no shared state.
 */
#pragma once
#include "import/text/text_names.h"

/* A line index is -1 where the file states nothing. */
typedef struct TextMetadata {
    AzimuthWords azimuth;
    int          zero_line, sense_line, side_line;
    ValueUnit    unit;
    int          unit_line;
    AngleUnit    angle;
    int          angle_line;
    double       wavelength_nm;  /* 0: not there */
    bool         has_incidence;
    double       incidence_deg;
    char         words[256];     /* of pattern, colour and level */
    int          words_line;
    const char  *panel, *instrument, *date, *operator_name; /* NULL: not there */
    int          unused_columns;
} TextMetadata;

/* Nothing is known yet. */
TextMetadata text_metadata(void);

/* Reads a line that is no row of numbers; its index is for messages. */
void text_metadata_read_line(TextMetadata *metadata, TextLine line, int index, Arena *arena);
