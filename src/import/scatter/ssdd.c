/* SPDX-License-Identifier: Apache-2.0 */
/* Surface scattering distribution data (.ssdd, version 0.2): a text header, then blocks of
 * metadata and a table, as text or as little-endian floats.
 *
 * Directions are vectors away from the surface, so light at azimuth phi has its mirror
 * direction at phi + 180. In the specular system the two angles are about the mirror direction,
 * the azimuth from the tangent towards the normal. In the half-difference system the BRDF is
 * evaluated on half vectors (half_angle.h), linear between the nodes. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "import/scatter/byte_scan.h"
#include "import/scatter/half_angle.h"
#include "import/scatter/scan.h"
#include "panel/set/measurement.h"

#define PARAMS 4
#define LIST_MAX 4096

typedef enum SsddSystem {
    SYSTEM_NONE, SYSTEM_SPHERICAL, SYSTEM_SPECULAR, SYSTEM_HALF
} SsddSystem;

typedef enum SsddColour {
    COLOUR_NONE, COLOUR_MONO, COLOUR_RGB, COLOUR_XYZ, COLOUR_SPECTRUM
} SsddColour;

typedef struct Ssdd {
    WordScan   scan;
    bool       is_brdf, is_table; /* is_table: BRDF or BTDF, not specular data */
    SsddSystem system;
    SsddColour colour;
    bool       is_mirrored, is_reciprocal;
    int        count[PARAMS];
    double    *param[PARAMS]; /* degrees */
    int        nm_count;      /* of WAVELENGTH_LIST */
    int        channels;      /* of the file, as its COLOR_MODEL requires */
    float     *nm;            /* of a spectrum */
    double    *value;         /* [3][2][1][0][channel] */
    bool       is_half_turn;  /* param 3 stops at 180: of the half-difference system */
} Ssdd;

/* ---- metadata ---------------------------------------------------------------------------- */

typedef struct SsddList {
    int     count;
    double *number;
} SsddList;

/* The numbers of the rest of a line. */
static bool read_list(Ssdd *in, char *text, const char *what, SsddList *out, Error *err)
{
    *out = (SsddList){0, ARENA_NEW(in->scan.arena, double, strlen(text) / 2 + 1)};
    for (char *at = text, *word; (word = strtok_r(at, " \t", &at)); out->count++) {
        double *one = &out->number[out->count];
        if (*word == '#') break;
        if (out->count == LIST_MAX)
            return scan_fail(&in->scan, err, "%s has more than %d numbers", what, LIST_MAX);
        if (!scan_to_number(word, one))
            return scan_fail(&in->scan, err, "%s has '%.40s', required: numbers", what, word);
        if (out->count && !(*one > one[-1]))
            return scan_fail(&in->scan, err, "%s does not rise at %g", what, *one);
    }
    return out->count || scan_fail(&in->scan, err, "%s is empty", what);
}

static bool read_wavelengths(Ssdd *in, char *text, Error *err)
{
    SsddList list;
    if (!read_list(in, text, "WAVELENGTH_LIST", &list, err)) return false;
    if (list.count > MEASUREMENT_WAVELENGTHS_MAX)
        return scan_fail(&in->scan, err, "WAVELENGTH_LIST has %d numbers, required: at most %d",
                         list.count, MEASUREMENT_WAVELENGTHS_MAX);
    in->nm_count = list.count;
    in->nm = ARENA_NEW(in->scan.arena, float, list.count);
    for (int c = 0; c < list.count; c++) in->nm[c] = (float)list.number[c];
    return true;
}

static bool read_system(Ssdd *in, const char *text, Error *err)
{
    static const char *const names[] = {"spherical_coordinate_system",
                                        "specular_coordinate_system",
                                        "half_difference_coordinate_system", NULL};
    int at = import_word_find(names, text);
    in->system = (SsddSystem)(SYSTEM_SPHERICAL + at);
    return at >= 0 || scan_fail(&in->scan, err, "PARAM_TYPE '%.40s' is not known here", text);
}

static bool read_colour(Ssdd *in, const char *text, Error *err)
{
    static const char *const names[] = {"monochrome", "rgb", "xyz", "spectrum", NULL};
    int at = import_word_find(names, text);
    if (at < 0)
        return scan_fail(&in->scan, err, "COLOR_MODEL is '%.40s', required: monochrome, rgb, "
                                         "xyz or spectrum", text);
    in->colour = (SsddColour)(COLOUR_MONO + at);
    return true;
}

static bool read_reduction(Ssdd *in, char *text, Error *err)
{
    for (char *at = text, *word; (word = strtok_r(at, " \t", &at));) {
        if (*word == '#') break;
        if (!strcasecmp(word, "bilateral_symmetry"))
            in->is_mirrored = true;
        else if (!strcasecmp(word, "reciprocity"))
            in->is_reciprocal = true;
        else
            return scan_fail(&in->scan, err, "REDUCTION_TYPE '%.40s' is not known here", word);
    }
    return true;
}

static bool start_block(Ssdd *in, const char *text, Error *err)
{
    static const char *const names[] = {"brdf", "btdf", "specular_reflectance",
                                        "specular_transmittance", NULL};
    int kind = import_word_find(names, text);
    *in = (Ssdd){.scan = in->scan, .is_brdf = kind == 0, .is_table = kind == 0 || kind == 1};
    return kind >= 0 || scan_fail(&in->scan, err, "DATA_TYPE '%.40s' is not known here", text);
}

/* The rest of the line after the key, or NULL. */
static char *value_of(char *line, const char *key)
{
    size_t length = strlen(key);
    if (strncmp(line, key, length)) return NULL;
    if (line[length] != ' ' && line[length] != '\t') return NULL;
    for (line += length; *line == ' ' || *line == '\t';) line++;
    return line;
}

static bool read_param(Ssdd *in, char *line, Error *err)
{
    static const char *const names[] = {"PARAM0_LIST", "PARAM1_LIST", "PARAM2_LIST",
                                        "PARAM3_LIST"};
    for (int i = 0; i < PARAMS; i++) {
        char *text = value_of(line, names[i]);
        if (!text) continue;
        SsddList list;
        if (!read_list(in, text, names[i], &list, err)) return false;
        in->param[i] = list.number;
        in->count[i] = list.count;
    }
    return true;
}

/* One line of metadata; *mode is the table's form when it was the last one. */
static bool read_entry(Ssdd *in, char *line, const char **mode, Error *err)
{
    char *text;
    *mode = NULL;
    if ((text = value_of(line, "DATA_TYPE"))) return start_block(in, text, err);
    if ((text = value_of(line, "COLOR_MODEL"))) return read_colour(in, text, err);
    if ((text = value_of(line, "WAVELENGTH_LIST"))) return read_wavelengths(in, text, err);
    if ((text = value_of(line, "PARAM_TYPE"))) return read_system(in, text, err);
    if ((text = value_of(line, "REDUCTION_TYPE"))) return read_reduction(in, text, err);
    if ((text = value_of(line, "PARAM4_LIST")) && in->is_brdf)
        return scan_fail(&in->scan, err, "PARAM4_LIST (offsets of the mirror direction) is not "
                         "known here for a BRDF");
    if ((text = value_of(line, "DATA"))) *mode = text;
    return read_param(in, line, err);
}

/* ---- the table --------------------------------------------------------------------------- */

static bool check_metadata(Ssdd *in, Error *err)
{
    WordScan *scan = &in->scan;
    if (in->colour == COLOUR_NONE) return scan_fail(scan, err, "the block has no COLOR_MODEL");
    if (in->colour == COLOUR_SPECTRUM && !in->nm)
        return scan_fail(scan, err, "the block has no WAVELENGTH_LIST");
    in->channels = in->colour == COLOUR_SPECTRUM ? in->nm_count
                   : in->colour == COLOUR_MONO   ? 1
                                                 : 3;
    if (in->is_table && in->system == SYSTEM_NONE)
        return scan_fail(scan, err, "the block has no PARAM_TYPE");
    for (int i = 0; i < PARAMS; i++) {
        if (in->count[i]) continue;
        if (i == 0 || (i > 1 && in->is_table))
            return scan_fail(scan, err, "the block has no PARAM%d_LIST", i);
        in->param[i] = ARENA_NEW(scan->arena, double, 1);
        in->count[i] = 1;
    }
    return true;
}

/* How many numbers follow; false when the rest of the file cannot hold them. */
static bool count_values(const Ssdd *in, size_t bytes_each, size_t *count, Error *err)
{
    double total = in->channels;
    for (int i = 0; i < (in->is_table ? PARAMS : 2); i++) total *= in->count[i];
    if (total * (double)bytes_each > (double)(in->scan.end - in->scan.next) + 1)
        return scan_fail(&in->scan, err, "the block announces %g numbers, more than the rest "
                         "of the file can hold", total);
    *count = (size_t)total;
    return true;
}

static bool read_ascii(Ssdd *in, Error *err)
{
    size_t count = 0;
    if (!count_values(in, 2, &count, err)) return false;
    in->value = ARENA_NEW(in->scan.arena, double, count);
    for (size_t i = 0; i < count; i++)
        if (!scan_number(&in->scan, "a value of the table", &in->value[i], err)) return false;
    if (in->scan.next == in->scan.end)
        return scan_fail(&in->scan, err, "the last line has no line end: the file may be cut");
    return true;
}

static bool read_binary(Ssdd *in, Error *err)
{
    size_t count = 0;
    if (!count_values(in, sizeof(float), &count, err)) return false;
    if (count * sizeof(float) > (size_t)(in->scan.end - in->scan.next))
        return scan_fail(&in->scan, err, "the file ends inside its table");
    in->value = ARENA_NEW(in->scan.arena, double, count);
    for (size_t i = 0; i < count; i++, in->scan.next += sizeof(float)) {
        in->value[i] = (double)float_from_bytes((const unsigned char *)in->scan.next);
        if (!isfinite(in->value[i]))
            return scan_fail(&in->scan, err, "number %zu of the table is not finite", i + 1);
    }
    return true;
}

/* ---- channels ---------------------------------------------------------------------------- */

/* Channels of the set's table, and where each stands in the file. */
static int kept_channels(const Ssdd *in)
{
    return in->colour == COLOUR_XYZ ? 1 : in->channels;
}

static int file_channel(const Ssdd *in, int c)
{
    return in->colour == COLOUR_XYZ ? 1 : in->colour == COLOUR_RGB ? 2 - c : c;
}

static const float *name_bands(const Ssdd *in, const ImportOptions *options, ImportSet *set,
                               Error *err)
{
    const char *file = in->scan.file;
    switch (in->colour) {
    case COLOUR_RGB:  return scatter_rgb_bands(file, set);
    case COLOUR_XYZ:  return scatter_xyz(options, file, set);
    case COLOUR_MONO: return scatter_wavelength(0, options, file, set, err);
    default:          return in->nm;
    }
}

static size_t node(const Ssdd *in, const int at[PARAMS])
{
    size_t index = 0;
    for (int i = PARAMS; i-- > 0;) index = index * (size_t)in->count[i] + (size_t)at[i];
    return index * (size_t)in->channels;
}

/* ---- angles of grid systems -------------------------------------------------------------- */

static void put_node(const Ssdd *in, ImportRows *rows, const int at[PARAMS], bool is_image)
{
    double value[MEASUREMENT_WAVELENGTHS_MAX];
    double lean = in->param[0][at[0]], turn = in->param[1][at[1]];
    double theta = in->param[2][at[2]], phi = in->param[3][at[3]];
    for (int c = 0; c < rows->channels; c++)
        value[c] = in->value[node(in, at) + (size_t)file_channel(in, c)];
    if (in->system == SYSTEM_SPECULAR) {
        Direction d = direction_about_mirror(lean, theta, is_image ? -phi : phi);
        direction_to_degrees(d, &theta, &phi);
    } else {
        /* A reduced table counts phi from the plane of incidence. */
        phi = is_image ? 180 - phi : in->is_mirrored ? phi + 180 : phi + 180 - turn;
    }
    scatter_put_measured(rows, theta, phi, value);
}

static bool add_light(const Ssdd *in, int i0, int i1, const float *nm, ImportSet *set,
                      Error *err)
{
    int         last = in->count[3] - 1;
    ImportRows rows = scatter_rows(set->arena, 2 * in->count[2] * in->count[3],
                                    kept_channels(in));
    bool        closes = last > 0 && in->param[3][0] == 0 && in->param[3][last] == 360;
    for (int i3 = 0; i3 <= last - closes; i3++)
        for (int i2 = 0; i2 < in->count[2]; i2++) {
            int    at[PARAMS] = {i0, i1, i2, i3};
            double phi = in->param[3][i3];
            put_node(in, &rows, at, false);
            if (in->is_mirrored && phi > 0 && phi < 180 && in->param[2][i2] > 0)
                put_node(in, &rows, at, true);
        }
    ScatterLight light = {in->param[0][i0], in->param[1][i1]};
    if (in->count[1] == 1) light.azimuth_deg = 180;
    return scatter_add(set, in->scan.file, &rows, light, nm, err);
}

static bool add_grid(const Ssdd *in, const float *nm, ImportSet *set, Error *err)
{
    int  last = in->count[1] - 1;
    bool closes = last > 0 && in->param[1][0] == 0 && in->param[1][last] == 360;
    for (int i0 = 0; i0 < in->count[0]; i0++) {
        if (in->param[0][i0] >= 90) {
            import_note(set, "%s: incidence 90 degrees is left out", path_name(in->scan.file));
            continue;
        }
        for (int i1 = 0; i1 <= last - closes; i1++)
            if (!add_light(in, i0, i1, nm, set, err)) return false;
    }
    return true;
}

/* ---- half and difference angles ---------------------------------------------------------- */

static double reduced_diff_phi(const Ssdd *in, double phi)
{
    double turn = fmod(phi + 720, in->is_reciprocal ? 180 : 360);
    if (!in->is_mirrored) return turn;
    return in->is_reciprocal ? fmin(turn, 180 - turn) : fmin(turn, 360 - turn);
}

static bool evaluate(const void *data, Direction light, Direction leaving, double *value)
{
    const Ssdd *in = data;
    HalfAngles  h = half_angles(light, leaving);
    double period = in->is_mirrored ? 0 : in->is_reciprocal ? 180 : 360;
    AngleInterval side[PARAMS] = {
        angle_interval(in->param[0], in->count[0], h.half_theta, 0),
        angle_interval(in->param[1], in->count[1], fmod(h.half_phi + 360, 360), 360),
        angle_interval(in->param[2], in->count[2], h.diff_theta, 0),
        angle_interval(in->param[3], in->count[3], reduced_diff_phi(in, h.diff_phi), period)};
    int channels = kept_channels(in);
    for (int c = 0; c < channels; c++) value[c] = 0;
    for (int corner = 0; corner < 1 << PARAMS; corner++) {
        int    at[PARAMS];
        double weight = 1;
        for (int i = 0; i < PARAMS; i++) {
            bool is_high = corner >> i & 1;
            at[i] = is_high ? side[i].high : side[i].low;
            weight *= is_high ? side[i].weight : 1 - side[i].weight;
        }
        for (int c = 0; weight > 0 && c < channels; c++)
            value[c] += weight * in->value[node(in, at) + (size_t)file_channel(in, c)];
    }
    return true;
}

static bool add_half(const Ssdd *in, const float *nm, ImportSet *set, Error *err)
{
    BrdfSource source = {in->scan.file, evaluate, in, kept_channels(in), nm, in->param[0],
                         in->count[0], in->count[1] > 1};
    return brdf_source_add(&source, set, err);
}

/* ---- the file ---------------------------------------------------------------------------- */

static bool check_ranges(const Ssdd *in, Error *err)
{
    const double quarter[] = {0, 90}, half[] = {0, 180}, turn[] = {0, 360};
    bool is_specular = in->system == SYSTEM_SPECULAR;
    const char *file = in->scan.file;
    return angles_check(file, "PARAM0_LIST", in->param[0], in->count[0], quarter, err) &&
           angles_check(file, "PARAM1_LIST", in->param[1], in->count[1], turn, err) &&
           angles_check(file, "PARAM2_LIST", in->param[2], in->count[2],
                        is_specular ? half : quarter, err) &&
           angles_check(file, "PARAM3_LIST", in->param[3], in->count[3],
                        in->is_mirrored ? half : turn, err);
}

static bool add_block(Ssdd *in, const ImportOptions *options, ImportSet *set, Error *err)
{
    if (!in->is_brdf) {
        import_note(set, "%s: a block of transmission or of mirror reflectance is left out",
                    path_name(in->scan.file));
        return true;
    }
    const float *nm = check_ranges(in, err) ? name_bands(in, options, set, err) : NULL;
    if (!nm) return false;
    return in->system == SYSTEM_HALF ? add_half(in, nm, set, err) : add_grid(in, nm, set, err);
}

static bool read_block(Ssdd *in, const char *mode, const ImportOptions *options, ImportSet *set,
                       Error *err)
{
    bool is_binary = !strcasecmp(mode, "binary");
    if (!is_binary && strcasecmp(mode, "ascii"))
        return scan_fail(&in->scan, err, "DATA is '%.40s', required: ascii or binary", mode);
    if (!check_metadata(in, err)) return false;
    bool ok = is_binary ? read_binary(in, err) : read_ascii(in, err);
    return ok && add_block(in, options, set, err);
}

static bool read_ssdd(const char *file, const ImportOptions *options, ImportSet *set,
                      Error *err)
{
    Ssdd in = {.system = SYSTEM_NONE};
    if (!scan_open(file, set->arena, &in.scan, err)) return false;
    const char *first = scan_peek(&in.scan), *line;
    if (!first || strcmp(first, "VERSION"))
        return scan_fail(&in.scan, err, "the file begins with '%.40s', required: VERSION",
                         first ? first : "");
    bool has_block = false;
    while ((line = scan_line(&in.scan))) {
        const char *mode;
        if (!*line || *line == '#') continue;
        if (!read_entry(&in, arena_string(set->arena, line, strlen(line)), &mode, err) ||
            (mode && !read_block(&in, mode, options, set, err)))
            return false;
        has_block |= mode && in.is_brdf;
        if (mode) in = (Ssdd){.scan = in.scan};
    }
    if (in.is_brdf || !has_block)
        return scan_fail(&in.scan, err, "the file ends without a table of reflection");
    return true;
}

static bool is_ssdd(const char *file, const char *head, size_t head_size)
{
    return !strcasecmp(path_ending(file), ".ssdd") ||
           (scan_head_has(head, head_size, "VERSION") &&
            scan_head_has(head, head_size, "DATA_TYPE"));
}

const Importer importer_ssdd = {"ssdd", "surface scattering distribution data (.ssdd)", is_ssdd,
                                read_ssdd};
