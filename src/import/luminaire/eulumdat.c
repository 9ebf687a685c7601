/* SPDX-License-Identifier: Apache-2.0 */
/* EULUMDAT (.ldt): one value a line, in the order that A. Stockmar laid down in 1990. */
#include "import/luminaire/eulumdat.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"
#include "import/luminaire/luminaire_doubts.h"
#include "import/luminaire/luminaire_opening.h"
#include "import/luminaire/luminaire_scan.h"

#define OUTPUT_RATIO_MOST 120.0 /* per cent: fluorescent lamps may give more in a luminaire */

static bool next_line(LuminaireScan *in, const char *what, TextLine *out) {
    bool is_there = ++in->line < in->text.count;
    *out = is_there ? in->text.line[in->line] : (TextLine){0};
    return is_there || luminaire_scan_fail(in, "the file ends before %s", what);
}

static TextCell trimmed(const char *begin, const char *end) {
    while (begin < end && (*begin == ' ' || *begin == '\t')) begin++;
    while (end > begin && (end[-1] == ' ' || end[-1] == '\t')) end--;
    return (TextCell){begin, (int)(end - begin)};
}

/* The number of a line; some writers put a decimal comma, or a unit behind, which are reported.
 * False: it is none, or another number stands behind. */
static bool number_of(LuminaireScan *in, TextLine line, double *out) {
    const char *end = line.text + line.length;
    TextCell word = trimmed(line.text, end);
    int digits = 0;
    while (digits < word.length && strchr("0123456789+-.,eE", word.text[digits])) digits++;
    TextCell behind = trimmed(word.text + digits, end);
    word = (TextCell){word.text, digits};
    bool is_unit = behind.length && !strchr("0123456789+-.,", *behind.text);
    if (behind.length && !is_unit) return false;
    if (is_unit && in->unit < 0) in->unit = in->line;
    if (text_number(word, '.', out)) return true;
    if (!text_number(word, ',', out)) return false;
    if (in->comma < 0) in->comma = in->line;
    return true;
}

static bool next_number(LuminaireScan *in, const char *what, double low, double high, double *out) {
    TextLine line;
    if (!next_line(in, what, &line)) return false;
    if (!number_of(in, line, out) || !(*out >= low && *out <= high))
        return luminaire_scan_fail(in, "%s is '%.*s', required: a number from %g to %g", what,
                                   line.length < 40 ? line.length : 40, line.text, low, high);
    return true;
}

static bool skip_lines(LuminaireScan *in, const char *what, int count) {
    TextLine line;
    for (int i = 0; i < count; i++)
        if (!next_line(in, what, &line)) return false;
    return true;
}

/* The largest at C0, C90, C180, C270; an empty line is 0. */
static bool read_heights(LuminaireScan *in, double *largest) {
    static const char what[] = "the height of the luminous area";
    for (int i = 0; i < 4; i++) {
        double height = 0;
        TextLine line = {.text = ""};
        if (in->line + 1 < in->text.count) line = in->text.line[in->line + 1];
        bool is_empty = !trimmed(line.text, line.text + line.length).length;
        if (is_empty ? !skip_lines(in, what, 1) : !next_number(in, what, 0, 1e6, &height))
            return false;
        if (height > *largest) *largest = height;
    }
    return true;
}

typedef struct EulumdatHead {
    int symmetry, planes, gammas, lamp_sets;
    double length_mm, width_mm; /* luminous area; width 0: a circle */
    double height_mm;           /* the largest of the four planes' */
    double output_ratio, factor, flux_lm;
    bool is_absolute;
} EulumdatHead;

static bool read_head(LuminaireScan *in, EulumdatHead *head, const char **name) {
    TextLine line;
    double ignored;
    int type;
    bool ok =
        skip_lines(in, "the maker's name", 1) &&
        luminaire_scan_count(in, "the type of luminaire", 0, 4, &type) &&
        luminaire_scan_count(in, "the symmetry", 0, 4, &head->symmetry) &&
        luminaire_scan_count(in, "the number of C-planes", 1, LUMINAIRE_ANGLES_MAX,
                             &head->planes) &&
        next_number(in, "the step of the C-planes", 0, 360, &ignored) &&
        luminaire_scan_count(in, "the number of angles a plane", 2, LUMINAIRE_ANGLES_MAX,
                             &head->gammas) &&
        next_number(in, "the step of the angles", 0, 180, &ignored) &&
        skip_lines(in, "the report's number", 1) && next_line(in, "the luminaire's name", &line) &&
        skip_lines(in, "the luminaire's sizes", 6) &&
        next_number(in, "the length of the luminous area", 0, 1e6, &head->length_mm) &&
        next_number(in, "the width of the luminous area", 0, 1e6, &head->width_mm) &&
        read_heights(in, &head->height_mm) &&
        next_number(in, "the downward flux fraction", -1, 101, &ignored) &&
        next_number(in, "the light output ratio", 0, OUTPUT_RATIO_MOST, &head->output_ratio) &&
        next_number(in, "the conversion factor", 0, 1e6, &head->factor) &&
        next_number(in, "the tilt", -360, 360, &ignored) &&
        luminaire_scan_count(in, "the number of lamp sets", 0, 20, &head->lamp_sets);
    if (ok && line.length) *name = arena_string(in->arena, line.text, (size_t)line.length);
    return ok;
}

static void find_cct(const LuminaireScan *in, TextLine line, CctSource source, Luminaire *out) {
    luminaire_scan_cct(arena_string(in->arena, line.text, (size_t)line.length), source, out);
}

/* Six lines a set: number of lamps (negative: absolute photometry), type, flux, colour,
 * rendering, watts. Sets are alternatives; intensities are per 1000 lm of the first. */
static bool read_lamps(LuminaireScan *in, EulumdatHead *head, Luminaire *out) {
    out->cct_text = "";
    for (int i = 0; i < head->lamp_sets; i++) {
        int lamps;
        double flux;
        TextLine type, color;
        if (!luminaire_scan_count(in, "the number of lamps", -1000000, 1000000, &lamps) ||
            !next_line(in, "the lamp's type", &type) ||
            !next_number(in, "the lamps' flux", 0, 1e9, &flux) ||
            !next_line(in, "the lamp's colour", &color) || !skip_lines(in, "the lamp's data", 2))
            return false;
        if (!i) find_cct(in, color, CCT_OF_COLOUR, out);
        if (!i) find_cct(in, type, CCT_OF_LAMP, out);
        if (!i) head->flux_lm = flux;
        if (!i) head->is_absolute = lamps < 0;
    }
    return head->flux_lm > 0 ||
           luminaire_scan_fail(in, "the lamps' flux is 0 lm, required: the flux that the "
                                   "intensities belong to");
}

/* Which planes are stored: all; one; C0 to C180; C270 over C0 to C90; C0 to C90. */
static bool stored_planes(LuminaireScan *in, const EulumdatHead *head, int *first, int *count,
                          Luminaire *out) {
    static const int quarters[5] = {4, 0, 2, 2, 1};
    out->mirror_deg[0] = out->mirror_deg[1] = -1;
    out->is_round = head->symmetry == 1;
    if (head->symmetry == 2 || head->symmetry == 4) out->mirror_deg[0] = 0;
    if (head->symmetry == 3) out->mirror_deg[0] = 90;
    if (head->symmetry == 4) out->mirror_deg[1] = 90;
    *first = head->symmetry == 3 ? 3 * (head->planes / 4) : 0;
    *count = head->symmetry == 0   ? head->planes
             : head->symmetry == 1 ? 1
                                   : head->planes / 4 * quarters[head->symmetry] + 1;
    bool fits = head->symmetry < 2 || head->planes % 4 == 0 ||
                (head->symmetry == 2 && head->planes % 2 == 0);
    if (head->symmetry == 2) *count = head->planes / 2 + 1;
    return fits || error_at(in->err, ERROR_INPUT, in->text.file, "line 4",
                            "has %d C-planes, required: a multiple of %d for symmetry %d",
                            head->planes, head->symmetry == 2 ? 2 : 4, head->symmetry);
}

/* Planes about which the rest is mirrored begin and end the stored ones. */
static bool check_symmetry(LuminaireScan *in, const EulumdatHead *head, const Luminaire *out) {
    static const double ends[5][2] = {{0, 0}, {0, 0}, {0, 180}, {270, 90}, {0, 90}};
    const double *wanted = ends[head->symmetry];
    double first = out->c_deg[0], last = out->c_deg[out->planes - 1];
    return head->symmetry < 2 || (first == wanted[0] && last == wanted[1]) ||
           luminaire_scan_fail(in,
                               "C-planes of symmetry %d go from %g to %g, required: %g to "
                               "%g degrees",
                               head->symmetry, first, last, wanted[0], wanted[1]);
}

static bool read_planes(LuminaireScan *in, const EulumdatHead *head, Luminaire *out) {
    static const double to_180[2] = {0, 180}, to_360[2] = {0, 360};
    double *c = ARENA_NEW(in->arena, double, head->planes + 1);
    int first;
    out->gammas = head->gammas;
    out->gamma_deg = ARENA_NEW(in->arena, double, head->gammas);
    if (!stored_planes(in, head, &first, &out->planes, out) ||
        !luminaire_scan_angles(in, "the C-plane", head->planes, to_360, c) ||
        !luminaire_scan_angles(in, "the angle", head->gammas, to_180, out->gamma_deg))
        return false;
    out->c_deg = ARENA_NEW(in->arena, double, out->planes);
    for (int i = 0; i < out->planes; i++) out->c_deg[i] = c[(first + i) % head->planes];
    if (!check_symmetry(in, head, out)) return false;
    double scale = head->flux_lm / 1000 * (head->factor > 0 ? head->factor : 1);
    return luminaire_scan_intensities(in, scale, out);
}

/* Numbers behind the last one belong nowhere; words are left out, and reported. */
static bool check_end(LuminaireScan *in, Luminaire *out) {
    TextLine line;
    while (in->line + 1 < in->text.count && next_line(in, "", &line)) {
        TextCell rest = trimmed(line.text, line.text + line.length);
        int shown = rest.length < 40 ? rest.length : 40;
        if (!rest.length) continue;
        if (strchr("0123456789+-.,", *rest.text))
            return luminaire_scan_fail(in,
                                       "'%.*s' is left over behind the table of %d x %d "
                                       "intensities, required: nothing more",
                                       shown, rest.text, out->planes, out->gammas);
        luminaire_doubt(out, in->arena,
                        "line %d: the text behind its table is left out "
                        "('%.*s')",
                        in->line + 1, shown, rest.text);
        break;
    }
    return true;
}

static void tell_reading(const LuminaireScan *in, Luminaire *out) {
    if (in->comma >= 0)
        luminaire_doubt(out, in->arena,
                        "line %d: the decimal comma of '%.*s' is read as a "
                        "point, and so of all its numbers",
                        in->comma + 1, in->text.line[in->comma].length,
                        in->text.line[in->comma].text);
    if (in->unit >= 0)
        luminaire_doubt(out, in->arena,
                        "line %d: of '%.*s' the number is read, required "
                        "nothing behind it",
                        in->unit + 1, in->text.line[in->unit].length, in->text.line[in->unit].text);
}

bool eulumdat_read_luminaire(const char *file, const FileBytes *bytes, ImportSet *set,
                             Luminaire *out, Error *err) {
    LuminaireScan in;
    EulumdatHead head = {0};
    Luminaire luminaire = {.file = file};
    if (!luminaire_scan_open(file, bytes, next_number, set, &in, err) ||
        !read_head(&in, &head, &luminaire.name) || !read_lamps(&in, &head, &luminaire) ||
        !skip_lines(&in, "the direct ratios", 10) || !read_planes(&in, &head, &luminaire) ||
        !check_end(&in, &luminaire))
        return false;
    luminaire.opening =
        opening_of_eulumdat(head.length_mm * 1e-3, head.width_mm * 1e-3, head.height_mm * 1e-3);
    luminaire.area_m2 = (double)opening_area(&luminaire.opening, vec3(0, 0, -1));
    bool has_ratio = !head.is_absolute && head.output_ratio > 0;
    luminaire.stated_lm = head.flux_lm * (has_ratio ? head.output_ratio / 100 : 1);
    luminaire.stated_as = head.is_absolute ? "absolute"
                          : has_ratio      ? "lamps' flux times light output ratio"
                                           : "lamps' flux";
    tell_reading(&in, &luminaire);
    luminaire_doubts_find(&luminaire, set->arena);
    if (head.lamp_sets > 1)
        import_note(set, "%s: the first of %d lamp sets is taken", path_name(file), head.lamp_sets);
    *out = luminaire;
    return true;
}

static bool read_eulumdat(const char *file, const ImportOptions *options, ImportSet *set,
                          Error *err) {
    Luminaire luminaire;
    return eulumdat_read_luminaire(file, NULL, set, &luminaire, err) &&
           luminaire_add(&luminaire, options, set, err);
}

/* No mark in the file: its name, or whole numbers where the second to fourth line require
 * them. */
static bool is_eulumdat(const char *file, const char *head, size_t size) {
    if (!strcasecmp(path_ending(file), ".ldt")) return true;
    const char *line = memchr(head, '\n', size);
    for (int i = 0; i < 6 && line; i++) {
        double value = 0;
        const char *after = number_read(line + 1, &value);
        const char *next = memchr(line + 1, '\n', size - (size_t)(line + 1 - head));
        while (after && (*after == ' ' || *after == '\r')) after++;
        if (!after || after != next || value < 0 || value > LUMINAIRE_ANGLES_MAX) return false;
        line = next;
    }
    return line != NULL;
}

const Importer importer_eulumdat = {"eulumdat", "EULUMDAT luminaires (.ldt), as a white panel",
                                    is_eulumdat, read_eulumdat};
