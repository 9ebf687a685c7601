/* luminaire_scan.h -- the numbers of a luminaire file one after the other, as its format writes
 * them.
 *
 * Memory   the set's arena. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was wanted.
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
    TextFile         text;
    int              line;       /* index of the line that is read; -1: none yet */
    const char      *next, *end; /* in it: for a format whose numbers share lines */
    Arena           *arena;
    Error           *err;
};

/* `bytes` are the file's where they are there already; NULL: it is read here. */
bool luminaire_scan_open(const char *file, const FileBytes *bytes, LuminaireNumber *number,
                         ImportSet *set, LuminaireScan *out, Error *err);

/* A whole number. */
bool luminaire_scan_count(LuminaireScan *scan, const char *what, int low, int high, int *out);

/* Rising angles from 0 to `most` degrees. */
bool luminaire_scan_angles(LuminaireScan *scan, const char *what, int count, double most,
                           double *angle);

/* planes x gammas intensities, times `scale`. */
bool luminaire_scan_intensities(LuminaireScan *scan, double scale, Luminaire *out);

/* Kelvins of a text that is a plain number of them, with or without K behind: "4000 K". 0 of
 * every other one, such as "840" or "2700-6500". */
double luminaire_scan_cct(const char *text, int length);

/* An error at the current line. Always false. */
bool luminaire_scan_fail(const LuminaireScan *scan, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
