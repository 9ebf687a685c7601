/* SPDX-License-Identifier: Apache-2.0 */
/* IES LM-63 (.ies) luminaires, 1986 to 2019. Numbers stand in any number of lines behind TILT=,
 * with blanks or commas between them. */
#include "import/luminaire/ies.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "import/luminaire/luminaire_doubts.h"
#include "import/luminaire/luminaire_opening.h"
#include "import/luminaire/luminaire_scan.h"
#include "import/text/text_names.h"

#define METRES_A_FOOT 0.3048
#define SIZE_MOST 1000.0 /* feet or metres */
#define FACTOR_MOST 10.0 /* of the ballast: a share */

static bool is_gap(char c) {
    return c == ' ' || c == '\t' || c == ',' || c == '\r';
}

static void begin_line(LuminaireScan *in, int line) {
    in->line = line;
    if (line >= in->text.count) return;
    in->next = in->text.line[line].text;
    in->end = in->next + in->text.line[line].length;
}

/* The next word of this or a later line; false at the end. */
static bool find_word(LuminaireScan *in, TextCell *word) {
    for (; in->line < in->text.count; begin_line(in, in->line + 1)) {
        while (in->next < in->end && is_gap(*in->next)) in->next++;
        if (in->next == in->end) continue;
        const char *begin = in->next;
        while (in->next < in->end && !is_gap(*in->next)) in->next++;
        *word = (TextCell){begin, (int)(in->next - begin)};
        return true;
    }
    return false;
}

static bool next_number(LuminaireScan *in, const char *what, double low, double high, double *out) {
    TextCell word;
    if (!find_word(in, &word)) return luminaire_scan_fail(in, "the file ends before %s", what);
    if (text_number(word, '.', out) && *out >= low && *out <= high) return true;
    return luminaire_scan_fail(in, "%s is '%.*s', required: a number from %g to %g", what,
                               word.length < 40 ? word.length : 40, word.text, low, high);
}

/* Numbers behind the last one belong nowhere; words are left out, and reported (unless
 * NULL). */
static bool check_end(LuminaireScan *in, const char *table, Luminaire *out) {
    TextCell word;
    if (!find_word(in, &word)) return true;
    int shown = word.length < 40 ? word.length : 40;
    if (!isalpha((unsigned char)*word.text) && *word.text != '[')
        return luminaire_scan_fail(in, "'%.*s' is left over behind %s, required: nothing more",
                                   shown, word.text, table);
    if (out)
        luminaire_doubt(out, in->arena, "line %d: the text behind %s is left out ('%.*s')",
                        in->line + 1, table, shown, word.text);
    return true;
}

/* ---- decimal commas ---------------------------------------------------------------------- */

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/* A word of a line that has one comma, between digits, and no point: a list has more, or blanks
 * behind. */
static bool has_decimal_comma(TextLine line, TextCell *word) {
    const char *at = line.text, *end = at + line.length;
    while (at < end) {
        const char *begin = at, *comma = NULL;
        int commas = 0;
        for (; at < end && !is_blank(*at); at++)
            if (*at == ',' || *at == '.') commas++, comma = *at == ',' ? at : comma;
        *word = (TextCell){begin, (int)(at - begin)};
        if (commas == 1 && comma > begin && comma + 1 < at && isdigit((unsigned char)comma[-1]) &&
            isdigit((unsigned char)comma[1]))
            return true;
        at += at < end;
    }
    return false;
}

/* A comma parts numbers. Where they do not come out even, it may have been meant otherwise: the
 * error says so. Always false. */
static bool hint_at_comma(const LuminaireScan *in) {
    TextCell word;
    for (int i = in->first; i <= in->line && i < in->text.count; i++) {
        if (!has_decimal_comma(in->text.line[i], &word)) continue;
        size_t length = strlen(in->err->text);
        snprintf(in->err->text + length, sizeof in->err->text - length,
                 " — line %d has '%.*s': if that is a decimal comma, required: a point", i + 1,
                 word.length < 40 ? word.length : 40, word.text);
        return false;
    }
    return false;
}

/* ---- head -------------------------------------------------------------------------------- */

static const char *keyword_value(const LuminaireScan *in, TextLine line, const char *keyword) {
    int length = (int)strlen(keyword);
    if (line.length <= length || strncasecmp(line.text, keyword, (size_t)length) != 0) return NULL;
    const char *begin = line.text + length, *end = line.text + line.length;
    while (begin < end && is_gap(*begin)) begin++;
    return begin < end ? arena_string(in->arena, begin, (size_t)(end - begin)) : NULL;
}

/* LM-63 has no keyword for the colour temperature; these are what files have. */
static const char *const COLOUR_KEYWORDS[] = {"[CCT]",
                                              "[_CCT]",
                                              "[COLORTEMP]",
                                              "[_COLORTEMP]",
                                              "[COLOR_TEMP]",
                                              "[_COLOR_TEMP]",
                                              "[COLORTEMPERATURE]",
                                              "[_COLORTEMPERATURE]",
                                              "[COLOR_TEMPERATURE]",
                                              "[_COLOR_TEMPERATURE]"};

static const char *const LAMP_KEYWORDS[] = {"[LAMP]", "[LAMPCAT]"};

static void find_cct(const LuminaireScan *in, TextLine line, CctSource source, Luminaire *out) {
    const char *const *keyword = source == CCT_OF_LAMP ? LAMP_KEYWORDS : COLOUR_KEYWORDS;
    int count = source == CCT_OF_LAMP ? COUNT_OF(LAMP_KEYWORDS) : COUNT_OF(COLOUR_KEYWORDS);
    for (int i = 0; i < count; i++)
        luminaire_scan_cct(keyword_value(in, line, keyword[i]), source, out);
}

/* The edition in the first line, such as IESNA91 or IES:LM-63-2019; 1986 has none. */
static int find_year(const LuminaireScan *in) {
    TextLine line = in->text.count ? in->text.line[0] : (TextLine){0};
    int digits = 0, year = 0;
    if (line.length < 5 || strncasecmp(line.text, "IES", 3) != 0) return 1986;
    for (int i = line.length, unit = 1; i-- > 0 && digits < 4;) {
        if (line.text[i] < '0' || line.text[i] > '9') {
            if (digits) break;
            continue;
        }
        year += unit * (line.text[i] - '0');
        unit *= 10;
        digits++;
    }
    return year >= 100 ? year : year + (year < 80 ? 2000 : 1900);
}

/* Keywords up to the line TILT=; the luminaire's name is one of them. */
static bool read_keywords(LuminaireScan *in, Luminaire *out, const char **tilt) {
    out->cct_text = "";
    for (int i = 0; i < in->text.count; i++) {
        TextLine line = in->text.line[i];
        const char *value = keyword_value(in, line, "[LUMINAIRE]");
        if (value && !out->name) out->name = value;
        find_cct(in, line, CCT_OF_COLOUR, out);
        if (line.length < 5 || strncasecmp(line.text, "TILT=", 5) != 0) continue;
        for (int k = 0; k < i; k++) find_cct(in, in->text.line[k], CCT_OF_LAMP, out);
        *tilt = arena_string(in->arena, line.text + 5, (size_t)line.length - 5);
        begin_line(in, i + 1);
        in->first = i + 1;
        return true;
    }
    return error_at(in->err, ERROR_INPUT, in->text.file, "", "has no line TILT=");
}

/* How the lamps lie, the number of angles, the angles, a factor for each. */
static bool read_factors(LuminaireScan *in, LuminaireTilt *out) {
    static const double range[2] = {0, 180};
    LuminaireTilt tilt = {0};
    if (!luminaire_scan_count(in, "the lamp's geometry", 1, 3, &tilt.geometry) ||
        !luminaire_scan_count(in, "the number of tilts", 1, LUMINAIRE_ANGLES_MAX, &tilt.count))
        return false;
    tilt.angle_deg = ARENA_NEW(in->arena, double, tilt.count);
    tilt.factor = ARENA_NEW(in->arena, double, tilt.count);
    if (!luminaire_scan_angles(in, "the tilt angle", tilt.count, range, tilt.angle_deg))
        return false;
    for (int i = 0; i < tilt.count; i++)
        if (!next_number(in, "a tilt factor", 0, 1e3, &tilt.factor[i])) return false;
    double first = tilt.angle_deg[0], last = tilt.angle_deg[tilt.count - 1];
    if (first != 0 || (last != 90 && last != 180))
        return luminaire_scan_fail(in,
                                   "the tilt angles go from %g to %g, required: 0 to 90 or "
                                   "0 to 180 degrees",
                                   first, last);
    *out = tilt;
    return true;
}

static bool read_tilt(LuminaireScan *in, const char *text, LuminaireTilt *out) {
    const char *begin = text, *end = text + strlen(text);
    while (begin < end && is_gap(*begin)) begin++;
    while (end > begin && is_gap(end[-1])) end--;
    const char *tilt = arena_string(in->arena, begin, (size_t)(end - begin));
    if (!strcasecmp(tilt, "NONE")) return true;
    if (!strcasecmp(tilt, "INCLUDE")) return read_factors(in, out);
    out->file = tilt;
    return true;
}

bool ies_read_tilt(const char *file, const FileBytes *bytes, ImportSet *set, LuminaireTilt *out,
                   Error *err) {
    LuminaireScan in;
    if (!luminaire_scan_open(file, bytes, next_number, set, &in, err)) return false;
    begin_line(&in, 0);
    return (read_factors(&in, out) && check_end(&in, "the tilt factors", NULL)) ||
           hint_at_comma(&in);
}

typedef struct IesHead {
    int lamps, gammas, planes, type, units;
    double lumens, multiplier, size[3], ballast, lamp_factor, watts;
} IesHead;

static bool check_lumens(LuminaireScan *in, const IesHead *head) {
    return head->lumens >= 0 || head->lumens == -1 ||
           luminaire_scan_fail(in,
                               "the lumens a lamp are %g, required: 0 or more, or -1 "
                               "(absolute)",
                               head->lumens);
}

static bool read_head(LuminaireScan *in, IesHead *head) {
    return luminaire_scan_count(in, "the number of lamps", 0, 1000000, &head->lamps) &&
           next_number(in, "the lumens a lamp", -1, 1e9, &head->lumens) && check_lumens(in, head) &&
           next_number(in, "the candela multiplier", 1e-12, 1e9, &head->multiplier) &&
           luminaire_scan_count(in, "the number of vertical angles", 2, LUMINAIRE_ANGLES_MAX,
                                &head->gammas) &&
           luminaire_scan_count(in, "the number of horizontal angles", 1, LUMINAIRE_ANGLES_MAX,
                                &head->planes) &&
           luminaire_scan_count(in, "the photometric type", 1, 3, &head->type) &&
           luminaire_scan_count(in, "the units of length", 1, 2, &head->units) &&
           next_number(in, "the width", -SIZE_MOST, SIZE_MOST, &head->size[0]) &&
           next_number(in, "the length", -SIZE_MOST, SIZE_MOST, &head->size[1]) &&
           next_number(in, "the height", -SIZE_MOST, SIZE_MOST, &head->size[2]) &&
           next_number(in, "the ballast factor", 1e-6, FACTOR_MOST, &head->ballast) &&
           next_number(in, "the ballast-lamp factor", 1e-6, FACTOR_MOST, &head->lamp_factor) &&
           next_number(in, "the watts", -1, 1e9, &head->watts);
}

/* ---- angles and intensities -------------------------------------------------------------- */

/* The range of horizontal angles determines the symmetry. */
static bool find_symmetry(LuminaireScan *in, Luminaire *out) {
    double first = out->c_deg[0], last = out->c_deg[out->planes - 1];
    out->mirror_deg[0] = out->mirror_deg[1] = -1;
    out->is_round = out->planes == 1;
    if (out->is_round) return true;
    if (first == 0 && (last == 90 || last == 180)) out->mirror_deg[0] = 0;
    if (first == 0 && last == 90) out->mirror_deg[1] = 90;
    if (first == 90 && last == 270) out->mirror_deg[0] = 90;
    bool is_whole = first == 0 && last > 180; /* 345 or 360 */
    return out->mirror_deg[0] >= 0 || is_whole ||
           luminaire_scan_fail(in,
                               "horizontal angles go from %g to %g, required: 0, 0 to 90, "
                               "0 to 180, 90 to 270 or 0 to 360 degrees",
                               first, last);
}

static bool read_type_c(LuminaireScan *in, const IesHead *head, double scale, Luminaire *out) {
    static const double to_180[2] = {0, 180}, to_360[2] = {0, 360};
    out->planes = head->planes;
    out->gammas = head->gammas;
    out->c_deg = ARENA_NEW(in->arena, double, head->planes);
    out->gamma_deg = ARENA_NEW(in->arena, double, head->gammas);
    return luminaire_scan_angles(in, "the vertical angle", head->gammas, to_180, out->gamma_deg) &&
           luminaire_scan_angles(in, "the horizontal angle", head->planes, to_360, out->c_deg) &&
           find_symmetry(in, out) && luminaire_scan_intensities(in, scale, out);
}

/* Types A and B as they are stored: for every H the intensities at every V. */
typedef struct TippedTable {
    int h_count, v_count;
    double *h, *v;    /* degrees */
    bool is_mirrored; /* H from 0: the other side is the same */
} TippedTable;

/* LM-63 has H from 0 (the sides are alike) or -90, V from -90. For V from 0 it leaves open
 * whether the lower half is dark or as the upper one. */
static bool read_tipped_angles(LuminaireScan *in, TippedTable *table) {
    static const double range[2] = {-90, 90};
    table->h = ARENA_NEW(in->arena, double, table->h_count);
    table->v = ARENA_NEW(in->arena, double, table->v_count);
    if (!luminaire_scan_angles(in, "the vertical angle", table->v_count, range, table->v) ||
        !luminaire_scan_angles(in, "the horizontal angle", table->h_count, range, table->h))
        return false;
    double v0 = table->v[0], h0 = table->h[0];
    table->is_mirrored = h0 == 0;
    if (table->h_count < 2)
        return luminaire_scan_fail(in, "photometry of types A and B has one horizontal angle, "
                                       "required: 0 to 90 or -90 to 90 degrees");
    if (h0 > 0)
        return luminaire_scan_fail(in,
                                   "horizontal angles of types A and B go from %g to %g, "
                                   "required: 0 to 90 or -90 to 90 degrees",
                                   h0, table->h[table->h_count - 1]);
    return v0 < 0 ||
           luminaire_scan_fail(in,
                               "vertical angles of types A and B go from %g to %g: nothing "
                               "says whether the half below is dark or the same, required: "
                               "-90 to 90 degrees",
                               v0, table->v[table->v_count - 1]);
}

/* Row of the stored table that has H number i of all, and that H. */
static int stored_row(const TippedTable *table, int i, double *h) {
    int row = table->is_mirrored ? abs(i - (table->h_count - 1)) : i;
    *h = table->is_mirrored && i < table->h_count - 1 ? -table->h[row] : table->h[row];
    return row;
}

/* In type A the planes are H and gamma is V + 90, in type B the planes are V and gamma is
 * H + 90 (intensity_web.h). */
static bool read_tipped(LuminaireScan *in, const IesHead *head, double scale, Luminaire *out) {
    TippedTable table = {.h_count = head->planes, .v_count = head->gammas};
    Luminaire stored = {.planes = head->planes, .gammas = head->gammas};
    if (!read_tipped_angles(in, &table) || !luminaire_scan_intensities(in, scale, &stored))
        return false;
    int v_count = table.v_count;
    int all = table.is_mirrored ? 2 * table.h_count - 1 : table.h_count;
    bool is_a = out->type == WEB_A;
    double h;
    out->planes = is_a ? all : v_count;
    out->gammas = is_a ? v_count : all;
    out->mirror_deg[0] = out->mirror_deg[1] = -1;
    out->c_deg = ARENA_NEW(in->arena, double, out->planes);
    out->gamma_deg = ARENA_NEW(in->arena, double, out->gammas);
    out->intensity_cd = ARENA_NEW(in->arena, double, (size_t)all *(size_t)v_count);
    for (int k = 0; k < v_count; k++)
        *(is_a ? &out->gamma_deg[k] : &out->c_deg[k]) = table.v[k] + (is_a ? 90 : 0);
    for (int i = 0; i < all; i++) {
        const double *row = stored.intensity_cd + stored_row(&table, i, &h) * v_count;
        *(is_a ? &out->c_deg[i] : &out->gamma_deg[i]) = h + (is_a ? 0 : 90);
        for (int k = 0; k < v_count; k++)
            out->intensity_cd[is_a ? i * v_count + k : k * all + i] = row[k];
    }
    return true;
}

/* From 1995 on the ballast-lamp factor is 1; in 2019 its place holds the generation type. */
static double intensity_scale(const IesHead *head, int year) {
    return head->multiplier * head->ballast * (year >= 2019 ? 1 : head->lamp_factor);
}

static void find_opening(const IesHead *head, int year, Luminaire *out, ImportSet *set) {
    double unit = head->units == 1 ? METRES_A_FOOT : 1;
    const double size[3] = {head->size[0] * unit, head->size[1] * unit, head->size[2] * unit};
    const char *fault = opening_of_ies(year, out->type, size, &out->opening);
    out->area_m2 = (double)opening_area(&out->opening, vec3(0, 0, -1));
    if (!fault) return;
    luminaire_doubt(out, set->arena,
                    "its opening of width %g, length %g, height %g is taken "
                    "for a point: %s",
                    head->size[0], head->size[1], head->size[2], fault);
}

static bool read_table(LuminaireScan *in, const IesHead *head, double scale, Luminaire *out) {
    const char *table =
        arena_format(in->arena, "the table of %d x %d intensities", head->planes, head->gammas);
    return (out->type == WEB_C ? read_type_c : read_tipped)(in, head, scale, out) &&
           check_end(in, table, out);
}

bool ies_read_luminaire(const char *file, const FileBytes *bytes, ImportSet *set, Luminaire *result,
                        Error *err) {
    static const WebType types[] = {WEB_C, WEB_C, WEB_B, WEB_A};
    LuminaireScan in;
    IesHead head = {0};
    Luminaire out = {.file = file};
    const char *tilt = "";
    if (!luminaire_scan_open(file, bytes, next_number, set, &in, err) ||
        !read_keywords(&in, &out, &tilt))
        return false;
    if (!read_tilt(&in, tilt, &out.tilt) || !read_head(&in, &head)) return hint_at_comma(&in);
    int year = find_year(&in);
    double scale = intensity_scale(&head, year);
    out.type = types[head.type];
    if (!read_table(&in, &head, scale, &out)) return hint_at_comma(&in);
    find_opening(&head, year, &out, set);
    out.stated_lm = head.lumens > 0 ? head.lamps * head.lumens * scale / head.multiplier : 0;
    out.stated_as = "of its lamps; the ratio is the luminaire's efficiency";
    luminaire_doubts_find(&out, set->arena);
    if (head.size[2] != 0 && out.opening.shape != OPENING_POINT)
        import_note(set, "%s: luminous sides (height %g) are taken into the flat opening",
                    path_name(file), head.size[2]);
    *result = out;
    return true;
}

/* A panel is not tilted: what counts is the factor at 0. */
static bool apply_tilt(Luminaire *luminaire, ImportSet *set, Error *err) {
    LuminaireTilt *tilt = &luminaire->tilt;
    const char *name = path_name(luminaire->file);
    if (tilt->file) {
        const char *path = path_beside(luminaire->file, tilt->file, set->arena);
        if (!file_exists(path)) {
            import_note(set, "%s: its tilt factors are not there: no file %s", name, path);
            return true;
        }
        if (!ies_read_tilt(path, NULL, set, tilt, err)) return false;
    }
    if (!tilt->geometry) return true;
    double factor = tilt->factor[0];
    import_note(set, "%s: is not tilted: of its tilt factors %g is applied", name, factor);
    size_t total = (size_t)luminaire->planes * (size_t)luminaire->gammas;
    for (size_t i = 0; i < total; i++) luminaire->intensity_cd[i] *= factor;
    return true;
}

static bool read_ies(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    Luminaire luminaire;
    return ies_read_luminaire(file, NULL, set, &luminaire, err) &&
           apply_tilt(&luminaire, set, err) && luminaire_add(&luminaire, options, set, err);
}

static bool is_ies(const char *file, const char *head, size_t size) {
    TextLine text = {head, (int)size};
    return !strncasecmp(head, "IESNA", 5) || !strcasecmp(path_ending(file), ".ies") ||
           line_has(text, "\nTILT=") || luminaire_scan_is_tm33(head, size);
}

const Importer importer_ies = {"ies", "IES LM-63 luminaires (.ies), as a white panel", is_ies,
                               read_ies};
