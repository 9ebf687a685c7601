/* fit_parts.h -- the steps of a fit and what they hand to each other. Private to src/panel. */
#pragma once
#include "hemisphere/tree.h"
#include "panel/fit/fit.h"
#include "panel/query/panel_file.h"

/* One measured table in the report. */
typedef struct FitTable {
    const char *name;
    size_t text_bytes, float32_bytes; /* of the source; float32: values without angles */
    double stored_values, bytes;
    double max_error, rms_error, integral_error, noise, extrapolated;
} FitTable;

typedef struct FitNotes {
    const char *text[32];
    int         count;
    Arena      *arena;
} FitNotes;

void fit_note(FitNotes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ---- noise, outliers ------------------------------------------------------------------- */

/* Relative noise of a table's channel inside 70 degrees: the median of high differences along
 * the rings or the meridians, whichever says less. 0: cannot tell. */
double fit_noise(const AngleTable *table, int channel, Arena scratch);

/* Noise in the channel's unit on the dimmest rings, where only what does not scale with light
 * is left. */
double fit_dim_noise(const AngleTable *table, int channel, Arena scratch);

/* Noise in the channel's unit over all rows. */
double fit_plain_noise(const AngleTable *table, int channel, Arena scratch);

/* Per row: the one before it on its ring, and the one at the same azimuth on the ring inside;
 * -1: none, or too far. */
typedef struct FitNeighbours {
    const int *ring, *inner;
} FitNeighbours;
void fit_neighbours(const AngleTable *table, Arena *arena, FitNeighbours *out);

/* A direction of a table that stands out, or is missing. */
typedef struct FitFlag {
    const char *table;
    double      theta, phi;      /* radians */
    double      value, expected; /* Y, cd m^-2 */
} FitFlag;

#define FIT_FLAGS_MAX 4096
typedef struct FitFlags {
    FitFlag *flag;  /* room for FIT_FLAGS_MAX */
    int      count; /* may be more than are listed */
} FitFlags;

/* Rows of an XYZ table that no neighbour explains: is_outlier[row]. Returns how many. */
int fit_find_outliers(const AngleTable *table, uint8_t *is_outlier, FitFlags *flags,
                      Arena scratch);

/* Directions that the table's grid lacks. */
int fit_find_holes(const AngleTable *table, FitFlags *flags, Arena scratch);

/* For qsort: doubles, rising. */
int fit_by_value(const void *a, const void *b);

/* ---- emission -------------------------------------------------------------------------- */

#define FIT_NO_LIGHT 1e-4 /* cd m^-2: what is less counts relative to this */
#define FIT_TABLES_MAX (3 * PANEL_LEVELS_MAX + 1)

typedef struct FitEmission {
    const void *section, *tree; /* as in the file */
    size_t      section_size;
    TreeReport  tree_report;
    int         components, level, table_count;
    bool        has_black;
    double      cone, tolerance; /* cone: radians */
    double      rank_worst;  /* relative error that the components leave at the worst sample */
    double      noise[FIT_TABLES_MAX]; /* relative, per table; last: black */
    double      dim[FIT_TABLES_MAX][3]; /* cd m^-2, per table and channel */
    uint8_t    *outlier[FIT_TABLES_MAX]; /* per row */
    bool        is_masked; /* outliers count nowhere */
    int         outlier_count, hole_count;
    FitFlags    outliers, holes;
} FitEmission;

bool fit_emission(const Measurement *set, const FitOptions *options, Arena *arena,
                  FitNotes *notes, FitEmission *out, Error *err);

/* ---- spectra --------------------------------------------------------------------------- */

/* The primaries' section; *size bytes in the arena. */
const void *fit_spectra(const Measurement *set, FitNotes *notes, Arena *arena, size_t *size);

/* ---- reflection ------------------------------------------------------------------------ */

/* Tables are azimuth * incidences + incidence; rows over wavelengths. */
typedef struct FitReflection {
    const void     *section; /* PanelReflectionStored and what follows it */
    size_t          section_size;
    const void     *tree;
    TreeReport      tree_report;
    const void     *sampling; /* the section's bytes; NULL: not yet built */
    size_t          sampling_size;
    int             tables;
    AngleTable     *kept;        /* what is left without the mirror */
    AngleTable     *haze;        /* and without the lobe */
    double         *noise;       /* relative, per table */
    double         *dim_noise;   /* sr^-1, per table */
    double         *reflectance; /* of the mirror, [table][wavelength] */
    double         *lobe;        /* the same of the lobe */
    double         *lobe_sigma;  /* radians, per table */
    double          mirror_y[MEASUREMENT_INCIDENCES_MAX]; /* luminous, of the first azimuth */
    double          lobe_y[MEASUREMENT_INCIDENCES_MAX], floor_y[MEASUREMENT_INCIDENCES_MAX];
    double          luminous[MEASUREMENT_WAVELENGTHS_MAX]; /* observer's weight, sum 1 */
    double          largest_albedo; /* before it was held at 1 */
    bool            has_mirror, has_lobe;
    int             masked;         /* values below the floor under which nothing counts */
    double          bound, worst;   /* error that was aimed at; largest error over it */
    int             level, components, coefficients;
    float           frame_exponent;
} FitReflection;

/* First step: noise, and mirror, lobe and haze told apart, for every table. */
void fit_separate(const Measurement *set, const FitOptions *options, Arena *arena,
                  FitNotes *notes, FitReflection *out);

/* Second step, on what the first one left in *out. */
bool fit_reflection(const Measurement *set, const FitOptions *options, Arena *arena,
                    FitNotes *notes, FitReflection *out, Error *err);

/* Takes the mirror's image out of one table: reflectance[wavelength], and the table without
 * it (values in the arena). */
void fit_mirror(const AngleTable *slice, double incidence, double fwhm, Arena *arena,
                double *reflectance, AngleTable *haze);

/* A Gaussian lobe on the mirror direction that stands on the haze. */
typedef struct FitLobe {
    double  fwhm;        /* radians */
    double *reflectance; /* per wavelength, room for them */
} FitLobe;

/* Takes a lobe out of one table, if a lobe on smooth haze explains the table. noise: relative.
 * False: the table shows none, *haze is *slice. */
bool fit_lobe(const AngleTable *slice, double incidence, double noise, Arena *arena,
              FitLobe *lobe, AngleTable *haze);

/* Unpolarised Fresnel reflectance that reflection tables are divided by. */
double fit_fresnel(double cos_theta);
#define FIT_REFRACTIVE_INDEX 1.5

/* ---- sampling --------------------------------------------------------------------------- */

/* Third step, once the panel's reflection can be queried: the PANEL_SAMPLING section into
 * *reflection, from what `panel`, which has none yet, says itself. */
bool fit_sampling(const Panel *panel, Arena *arena, FitReflection *reflection, Error *err);

/* ---- the file and the report ----------------------------------------------------------- */

typedef struct FitParts {
    const Measurement    *set;
    const FitOptions     *options;
    const FitEmission    *emission; /* NULL: none */
    const void           *primaries; /* the section */
    size_t                primaries_size;
    const FitReflection  *reflection; /* NULL: none */
    FitNotes             *notes;
    const void           *figures; /* panel_report.h; NULL: none yet */
    size_t                figures_size;
} FitParts;

/* Sections are written one after the other, each of pieces that follow each other. */
typedef struct FitPiece {
    const void *data;
    size_t      size;
} FitPiece;

typedef struct FitWriter FitWriter;
void fit_write_section(FitWriter *writer, PanelSectionKind kind, uint32_t index,
                       const FitPiece *piece, int pieces);
void fit_write_reflection(FitWriter *writer, const FitReflection *reflection);

/* The file's bytes with this meta text; *size bytes in the arena, aligned to 64. */
void *fit_file_bytes(const FitParts *parts, const char *meta, Arena *arena, size_t *size);

/* Deviations of a panel from a table, summed up. */
typedef struct FitErrors {
    double max, squares, count, integral, integral_source;
    double l2, l2_source; /* of the values themselves, cosine-weighted */
} FitErrors;

Vec3 fit_row_direction(const AngleTable *table, int row);

/* A row's share of the hemisphere, up to a factor: rings and azimuths are about even. */
double fit_row_weight(const AngleTable *table, int row);

/* scale: what the error is relative to. */
void fit_add_error(FitErrors *errors, double found, double wanted, double scale, double weight);
void fit_finish_errors(const FitErrors *errors, FitTable *out);

/* One more row of the report, and into its total. */
void fit_add_table(json_t *tables, FitTable *total, const FitTable *one);

/* The reflection's rows, and what was chosen for it as "reflection" in *out. */
void fit_report_reflection_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                  FitTable *total);
void fit_report_reflection(const FitParts *parts, const Panel *panel, json_t *out);

/* Puts the file's size into the report's total. */
void fit_report_size(json_t *total, size_t file_bytes);

/* Compares the panel with the tables; a new JSON document. */
json_t *fit_measure(const FitParts *parts, const Panel *panel, size_t file_bytes);

