/* text_reader.h -- one text file on its way from raw rows to tables of the set.
 *
 * Memory   the set's arena. Threads: one set per thread.
 */
#pragma once
#include "import/text/text_scan.h"

typedef struct TextReader {
    const char            *file;
    const TextDeclaration *declared;
    const ImportOptions   *options;
    ImportSet *set;
    Error     *err;
    RawTable  *raw;
    TextSaid   said;
    int        column[QUANTITY_COUNT]; /* of the raw table, or -1 */
    bool       is_reflection;
    Role       role;
    ValueUnit  unit;      /* settled */
    bool       is_section;    /* theta alone, all at section_phi (the file's azimuth) */
    double     section_phi;
    bool       is_radians;
    AnglePair  angles;
    double     zero_deg;  /* settled: azimuth = zero + sense * the file's */
    int        sense;
} TextReader;

/* Settles units, angles and azimuths from what the file says, what the user declares, and the
 * defaults; a contradiction is an error. */
bool text_settle(TextReader *in);

/* What the file is: the declared role, the file's words, its name. */
bool text_find_role(TextReader *in);

/* The raw rows as tables of the set: one for each pattern or light. */
bool text_add_tables(TextReader *in);

/* The file's angles in degrees of the set's frame, theta in [0, 180]. Two raw angles: theta and
 * phi, or horizontal and vertical. */
void text_direction(const TextReader *in, const double raw[2], double *theta_deg,
                    double *phi_deg);

/* An azimuth of the file in the set's frame, [0, 360). */
double text_azimuth(const TextReader *in, double raw);
