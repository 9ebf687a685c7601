/* SPDX-License-Identifier: Apache-2.0 */
/* curve_header.h -- what the header line of a spectrum says of its columns.
 *
 * Names and units stand in cells, parted as its rows are; units in brackets of any kind, behind a
 * slash or an underscore. Columns are taken by their names, wavelengths and percent to nm and
 * shares; what is of another quantity is refused. A word that is not known is a sample's name.
 * Memory   none. Threads: pure functions.
 */
#pragma once
#include <stdbool.h>

#define CURVE_COLUMNS_MAX 3 /* with that of the wavelength */

typedef struct CurveHeader {
    int place[CURVE_COLUMNS_MAX]; /* where wavelength, value or n, k stand in a row */
    double nm, value;             /* what 1 in the file is */
    bool names_wavelength;        /* and as many columns as there are */
    char unknown[40];             /* a unit in brackets that is not known; "" */
} CurveHeader;

/* Of a file without one: nm,value or nm,n,k. */
CurveHeader curve_header_none(void);

/* columns: 2, or 3 for n and k. is_amount: its unit does not matter. NULL: read; else what it
 * says that is not read, and what to do. */
const char *curve_header_read(const char *line, int columns, bool is_amount, CurveHeader *out);
