/* SPDX-License-Identifier: Apache-2.0 */
/* text_reader.h -- one text file on its way from raw rows to tables of the set.
 *
 * Memory   the set's arena. Threads: one set per thread.
 */
#pragma once
#include "import/text/text_scan.h"

typedef struct TextReader {
    const char          *file;
    const TextOptions   *options;
    const ImportOptions *import; /* of every format */
    ImportSet   *set;
    Error       *err;
    NamedRows   *raw;
    TextMetadata metadata;
    int          column[QUANTITY_COUNT]; /* of the raw rows, or -1 */
    bool         is_reflection;
    Role         role;
    bool         is_section;  /* theta alone, all at section_phi (the file's azimuth) */
    double       section_phi;
    ValueUnit    unit;        /* this and the rest: the conventions */
    bool         is_radians;
    AnglePair    angles;
    double       zero_deg;    /* azimuth = zero + sense * the file's */
    int          sense;
} TextReader;
