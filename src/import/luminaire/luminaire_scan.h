/* SPDX-License-Identifier: Apache-2.0 */
/* luminaire_scan.h -- the numbers of a luminaire file one after the other, as its format writes
 * them.
 *
 * Memory   the set's arena. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/luminaire/luminaire.h"
#include "import/text/text_lines.h"

typedef struct LuminaireScan LuminaireScan;

/* The next number; `what` names it in a message. */
typedef bool LuminaireNumber(LuminaireScan *scan, const char *what, double low, double high,
                             double *out);

struct LuminaireScan {
    LuminaireNumber *number;
    TextFile text;
    int line;               /* index of the line that is read; -1: none yet */
    const char *next, *end; /* in it: for a format whose numbers share lines */
    int first;              /* index of the line where its numbers begin */
    int comma, unit;        /* first line that has a decimal comma, words behind its
                              number, which are read on over; -1: none */
    Arena *arena;
    Error *err;
};

/* `bytes` are the file's where they are there already; NULL: it is read here. */
bool luminaire_scan_open(const char *file, const FileBytes *bytes, LuminaireNumber *number,
                         ImportSet *set, LuminaireScan *out, Error *err);

/* Whether a file begins as one of the XML that is to follow LM-63, which is not read. */
bool luminaire_scan_is_tm33(const char *head, size_t size);

/* A whole number. */
bool luminaire_scan_count(LuminaireScan *scan, const char *what, int low, int high, int *out);

/* Rising angles, degrees, within range[0] to range[1]. */
bool luminaire_scan_angles(LuminaireScan *scan, const char *what, int count, const double range[2],
                           double *angle);

/* planes x gammas intensities, times `scale`. */
bool luminaire_scan_intensities(LuminaireScan *scan, double scale, Luminaire *out);

typedef enum CctSource {
    CCT_OF_COLOUR, /* a field for the colour */
    CCT_OF_LAMP    /* a lamp's name, in which other numbers stand as well */
} CctSource;

/* Finds the colour temperature in a text (NULL: none), while none is known: into out->cct_k,
 * and the text into out->cct_text; without one, the first text about colour. Understood are
 * kelvins ("4000", "4000 K"; in a lamp's name with their K) and colour codes, a digit for the
 * colour rendering and two for hundreds of kelvins ("840"; in a lamp's name behind a slash:
 * "LED/930"), as long as the text names one temperature only. */
void luminaire_scan_cct(const char *text, CctSource source, Luminaire *out);

/* An error at the current line. Always false. */
bool luminaire_scan_fail(const LuminaireScan *scan, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
