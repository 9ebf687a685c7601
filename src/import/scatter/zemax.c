/* SPDX-License-Identifier: Apache-2.0 */
/* Radiant's BSDF Data Interchange text, as OpticStudio (Zemax) reads it (.bsdf): for every
 * sample rotation and angle of incidence a block of scatter azimuth x scatter radial.
 *
 * Both scatter angles are about the MIRROR direction: radial from it, azimuth from the tangent
 * towards the normal, counter-clockwise as one looks down on the surface. Rows stand at the
 * file's own directions; those under the horizon are left out. A sample turned by S
 * counter-clockwise is the same as light that comes from 180 - S. */
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "import/scatter/scan.h"
#include "import/scatter/scatter.h"

#define ANGLES_MAX 4096
#define BLOCKS_MAX 4096 /* sample rotations x incidences */

typedef struct Zemax {
    WordScan scan;
    int rotations, incidences, azimuths, radials;
    double *rotation, *incidence, *azimuth, *radial; /* degrees */
    bool is_half, has_symmetry, is_xyz, has_content;
    double *tis;   /* per block of the component that is kept */
    double *value; /* blocks x azimuths x radials */
    int blocks;    /* read so far, of the component that is kept */
    TotalsNote totals;
} Zemax;

/* ---- header ------------------------------------------------------------------------------ */

static bool read_symmetry(Zemax *in, Error *err) {
    static const char *const names[] = {"PlaneSymmetrical", "Asymmetrical", "Asymmetrical4D", NULL};
    int found = scan_choice(&in->scan, "Symmetry", names,
                            "PlaneSymmetrical, Asymmetrical or "
                            "ASymmetrical4D",
                            err);
    in->has_symmetry = true;
    in->is_half = found == 0;
    return found >= 0;
}

static bool read_content(Zemax *in, Error *err) {
    static const char *const names[] = {"Monochrome", "XYZ", NULL};
    int found = scan_choice(&in->scan, "SpectralContent", names, "Monochrome or XYZ", err);
    in->is_xyz = found == 1;
    return in->has_content = found >= 0;
}

static bool read_type(Zemax *in, Error *err) {
    const char *word = scan_word(&in->scan);
    if (word && !strcasecmp(word, "BRDF")) return true;
    if (word && !strcasecmp(word, "BTDF"))
        return scan_fail(&in->scan, err,
                         "ScatterType is BTDF: transmission, and a display "
                         "panel is opaque");
    return scan_fail(&in->scan, err, "ScatterType is '%s', required: BRDF", word ? word : "");
}

/* Reads one entry; *done at the first word of the data. */
static bool read_entry(Zemax *in, bool *done, Error *err) {
    const struct {
        const char *name;
        int *count;
        double **list;
    } lists[] = {{"SampleRotation", &in->rotations, &in->rotation},
                 {"AngleOfIncidence", &in->incidences, &in->incidence},
                 {"ScatterAzimuth", &in->azimuths, &in->azimuth},
                 {"ScatterRadial", &in->radials, &in->radial}};
    WordScan *scan = &in->scan;
    const char *word = scan_peek(scan);
    *done = word && (!strcasecmp(word, "Monochrome") || !strcasecmp(word, "DataBegin") ||
                     !strncasecmp(word, "Tristimulus", 11));
    if (*done) return true;
    if (scan_accept(scan, "Source"))
        return scan_word(scan) || scan_fail(scan, err, "the file ends after Source");
    if (scan_accept(scan, "Symmetry")) return read_symmetry(in, err);
    if (scan_accept(scan, "SpectralContent")) return read_content(in, err);
    if (scan_accept(scan, "ScatterType")) return read_type(in, err);
    for (int i = 0; i < COUNT_OF(lists); i++)
        if (scan_accept(scan, lists[i].name))
            return scan_counted_list(scan, lists[i].name, ANGLES_MAX, lists[i].count, lists[i].list,
                                     err);
    if (!word) return scan_fail(scan, err, "the file ends in its header, required: DataBegin");
    return scan_fail(scan, err, "'%.40s' is no entry of this format's header", word);
}

static bool check_header(const Zemax *in, Error *err) {
    const WordScan *scan = &in->scan;
    const char *missing = !in->has_symmetry  ? "Symmetry"
                          : !in->has_content ? "SpectralContent"
                          : !in->rotations   ? "SampleRotation"
                          : !in->incidences  ? "AngleOfIncidence"
                          : !in->azimuths    ? "ScatterAzimuth"
                          : !in->radials     ? "ScatterRadial"
                                             : NULL;
    if (missing) return scan_fail(scan, err, "the header has no %s", missing);
    if (in->rotations > BLOCKS_MAX / in->incidences)
        return scan_fail(scan, err,
                         "there are %d sample rotations at %d incidences, "
                         "required: at most %d "
                         "blocks",
                         in->rotations, in->incidences, BLOCKS_MAX);
    const double turn[] = {-360, 360}, lean[] = {0, 89.999};
    const double full[] = {0, 360}, half[] = {0, 180};
    return angles_check(scan->file, "SampleRotation", in->rotation, in->rotations, turn, err) &&
           angles_check(scan->file, "AngleOfIncidence", in->incidence, in->incidences, lean, err) &&
           angles_check(scan->file, "ScatterAzimuth", in->azimuth, in->azimuths,
                        in->is_half ? half : full, err) &&
           angles_check(scan->file, "ScatterRadial", in->radial, in->radials, half, err);
}

/* ---- data -------------------------------------------------------------------------------- */

static size_t block_size(const Zemax *in) {
    return (size_t)in->azimuths * (size_t)in->radials;
}

/* A block of a component that is not kept is read, and forgotten. */
static bool read_block(Zemax *in, bool is_kept, Error *err) {
    double ignored, *value = NULL;
    if (is_kept && in->blocks == in->rotations * in->incidences)
        return scan_fail(&in->scan, err, "this TIS is one block too many, required: %d",
                         in->rotations * in->incidences);
    if (is_kept) value = in->value + block_size(in) * (size_t)in->blocks;
    if (!scan_number(&in->scan, "TIS", is_kept ? &in->tis[in->blocks] : &ignored, err))
        return false;
    for (size_t i = 0; i < block_size(in); i++)
        if (!scan_number(&in->scan, "a value of the block", value ? &value[i] : &ignored, err))
            return false;
    in->blocks += is_kept;
    return true;
}

static bool allocate(Zemax *in, Error *err) {
    size_t blocks = (size_t)in->rotations * (size_t)in->incidences;
    size_t values = blocks * block_size(in);
    if (values / 2 > (size_t)(in->scan.end - in->scan.next))
        return scan_fail(&in->scan, err,
                         "the header announces %zu values, more than the file "
                         "can hold",
                         values);
    in->tis = ARENA_NEW(in->scan.arena, double, blocks);
    in->value = ARENA_NEW(in->scan.arena, double, values);
    return true;
}

static bool read_data(Zemax *in, Error *err) {
    static const char *const components[] = {"Monochrome", "TristimulusX", "TristimulusY",
                                             "TristimulusZ", NULL};
    int component = 0, found, kept = in->is_xyz ? 2 : 0; /* Y of X, Y and Z */
    bool is_ended = false;
    if (!allocate(in, err)) return false;
    for (const char *word; (word = scan_word(&in->scan));) {
        if ((found = import_word_find(components, word)) >= 0) {
            component = found;
            is_ended = false;
        } else if (!strcasecmp(word, "DataBegin")) {
            is_ended = false;
        } else if (!strcasecmp(word, "DataEnd")) {
            is_ended = true;
        } else if (!strcasecmp(word, "TIS")) {
            if (!read_block(in, component == kept, err)) return false;
        } else {
            return scan_fail(&in->scan, err, "'%.40s' stands where TIS or DataEnd is required",
                             word);
        }
    }
    if (in->blocks != in->rotations * in->incidences)
        return scan_fail(&in->scan, err,
                         "the file ends after %d blocks, required: "
                         "%d",
                         in->blocks, in->rotations * in->incidences);
    return is_ended || scan_fail(&in->scan, err, "the file ends without DataEnd");
}

/* ---- tables ------------------------------------------------------------------------------ */

static void put_about_mirror(ImportRows *rows, double incidence_deg, double radial_deg,
                             double azimuth_deg, const double *value) {
    double theta_deg, phi_deg;
    direction_to_degrees(direction_about_mirror(incidence_deg, radial_deg, azimuth_deg), &theta_deg,
                         &phi_deg);
    scatter_put_measured(rows, theta_deg, phi_deg, value);
}

/* Every azimuth repeats the mirror direction's value: their mean is taken. */
static void put_radial(const Zemax *in, ImportRows *rows, const double *value, double incidence_deg,
                       int i) {
    double at_mirror = 0, radial = in->radial[i];
    for (int j = 0; j < in->azimuths; j++) {
        const double *one = &value[(size_t)j * (size_t)in->radials + (size_t)i];
        double turn = in->azimuth[j];
        at_mirror += *one / in->azimuths;
        if (radial == 0 || (turn == 360 && in->azimuth[0] == 0)) continue;
        put_about_mirror(rows, incidence_deg, radial, turn, one);
        if (in->is_half && turn > 0 && turn < 180)
            put_about_mirror(rows, incidence_deg, radial, -turn, one);
    }
    if (radial == 0) put_about_mirror(rows, incidence_deg, 0, 0, &at_mirror);
}

static bool add_block(Zemax *in, int rotation, int incidence, const float *nm, ImportSet *set,
                      Error *err) {
    int block = rotation * in->incidences + incidence;
    const double *value = in->value + block_size(in) * (size_t)block;
    double lean = in->incidence[incidence];
    ImportRows rows = scatter_rows(set->arena, 2 * in->azimuths * in->radials + 1, 1);
    for (int i = 0; i < in->radials; i++) put_radial(in, &rows, value, lean, i);
    ScatterGrid grid = {in->radials, in->azimuths, in->radial, in->azimuth,
                        value,       lean,         in->is_half};
    totals_add(&in->totals, lean, in->tis[block], scatter_grid_integral(&grid, *set->arena));
    ScatterLight light = {lean, in->rotations > 1 ? 180 - in->rotation[rotation] : 180};
    return scatter_add(set, in->scan.file, &rows, light, nm, err);
}

static bool add_tables(Zemax *in, const float *nm, ImportSet *set, Error *err) {
    int last = in->rotations - 1; /* a whole turn may end with its beginning */
    bool closes = last > 0 && in->rotation[last] - in->rotation[0] == 360;
    for (int r = 0; r <= last - closes; r++)
        for (int i = 0; i < in->incidences; i++)
            if (!add_block(in, r, i, nm, set, err)) return false;
    totals_report(&in->totals, in->scan.file, set);
    if (in->rotations > 1)
        import_note(set,
                    "%s: a sample turned by S counter-clockwise is taken as light from "
                    "azimuth 180 - S",
                    path_name(in->scan.file));
    return true;
}

static bool read_zemax(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    Zemax in = {.rotations = 0};
    const float *nm;
    if (!scan_open(file, set->arena, &in.scan, err)) return false;
    for (bool done = false; !done;)
        if (!read_entry(&in, &done, err)) return false;
    if (!check_header(&in, err) || !read_data(&in, err)) return false;
    nm = in.is_xyz ? scatter_xyz(options, file, set) : scatter_wavelength(options, file, set, err);
    return nm && add_tables(&in, nm, set, err);
}

static bool is_zemax(const char *file, const char *head, size_t head_size) {
    (void)file;
    return scan_head_has(head, head_size, "AngleOfIncidence") ||
           (scan_head_has(head, head_size, "SampleRotation") &&
            scan_head_has(head, head_size, "ScatterType"));
}

const Importer importer_zemax = {"zemax", "Radiant / OpticStudio text BSDF (.bsdf)", is_zemax,
                                 read_zemax};
