/* IES LM-63 (.ies) luminaires: 1986 to 2002, type C photometry. Numbers stand in any number of
 * lines behind TILT=, with blanks or commas between them. */
#include "import/luminaire/ies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "base/units.h"
#include "import/luminaire/luminaire_scan.h"
#include "import/text/text_names.h"

#define METRES_A_FOOT 0.3048

static bool is_gap(char c)
{
    return c == ' ' || c == '\t' || c == ',' || c == '\r';
}

static void begin_line(LuminaireScan *in, int line)
{
    in->line = line;
    if (line >= in->text.count) return;
    in->next = in->text.line[line].text;
    in->end = in->next + in->text.line[line].length;
}

/* The next word of this or a later line. */
static bool next_word(LuminaireScan *in, const char *what, TextCell *word)
{
    for (; in->line < in->text.count; begin_line(in, in->line + 1)) {
        while (in->next < in->end && is_gap(*in->next)) in->next++;
        if (in->next == in->end) continue;
        const char *begin = in->next;
        while (in->next < in->end && !is_gap(*in->next)) in->next++;
        *word = (TextCell){begin, (int)(in->next - begin)};
        return true;
    }
    return luminaire_scan_fail(in, "the file ends before %s", what);
}

static bool next_number(LuminaireScan *in, const char *what, double low, double high,
                        double *out)
{
    TextCell word;
    if (!next_word(in, what, &word)) return false;
    if (text_number(word, '.', out) && *out >= low && *out <= high) return true;
    return luminaire_scan_fail(in, "%s is '%.*s', wanted a number from %g to %g", what,
                               word.length < 40 ? word.length : 40, word.text, low, high);
}

/* ---- head -------------------------------------------------------------------------------- */

static const char *keyword_value(const LuminaireScan *in, TextLine line, const char *keyword)
{
    int length = (int)strlen(keyword);
    if (line.length <= length || strncasecmp(line.text, keyword, (size_t)length) != 0)
        return NULL;
    const char *begin = line.text + length, *end = line.text + line.length;
    while (begin < end && is_gap(*begin)) begin++;
    return begin < end ? arena_string(in->arena, begin, (size_t)(end - begin)) : NULL;
}

/* LM-63 has no keyword for the colour temperature; these are what files have. */
static double cct_of(const LuminaireScan *in, TextLine line)
{
    static const char *const keywords[] = {
        "[CCT]", "[_CCT]", "[COLORTEMP]", "[_COLORTEMP]", "[COLOR_TEMP]", "[_COLOR_TEMP]",
        "[COLORTEMPERATURE]", "[_COLORTEMPERATURE]", "[COLOR_TEMPERATURE]",
        "[_COLOR_TEMPERATURE]"};
    for (int i = 0; i < COUNT_OF(keywords); i++) {
        const char *value = keyword_value(in, line, keywords[i]);
        if (value) return luminaire_scan_cct(value, (int)strlen(value));
    }
    return 0;
}

/* Keywords up to the line TILT=; the luminaire's name is one of them. */
static bool read_keywords(LuminaireScan *in, const char **name, double *cct_k,
                          const char **tilt)
{
    for (int i = 0; i < in->text.count; i++) {
        TextLine    line = in->text.line[i];
        const char *value = keyword_value(in, line, "[LUMINAIRE]");
        if (value && !*name) *name = value;
        if (!(*cct_k > 0)) *cct_k = cct_of(in, line);
        if (line.length < 5 || strncasecmp(line.text, "TILT=", 5) != 0) continue;
        *tilt = arena_string(in->arena, line.text + 5, (size_t)line.length - 5);
        begin_line(in, i + 1);
        return true;
    }
    return error_at(in->err, ERROR_INPUT, in->text.file, "", "has no line TILT=");
}

/* A lamp's loss when the luminaire is tilted; untilted, as here, its factor is 1. */
static bool skip_tilt(LuminaireScan *in, const char *tilt, ImportSet *set)
{
    int    geometry, pairs;
    double ignored;
    if (!strcasecmp(tilt, "NONE")) return true;
    import_note(set, "%s: tilt factors are not applied", path_name(in->text.file));
    if (strcasecmp(tilt, "INCLUDE") != 0) return true;
    if (!luminaire_scan_count(in, "the lamp's geometry", 1, 3, &geometry) ||
        !luminaire_scan_count(in, "the number of tilts", 1, LUMINAIRE_ANGLES_MAX, &pairs))
        return false;
    for (int i = 0; i < 2 * pairs; i++)
        if (!next_number(in, "a tilt factor", -1e6, 1e6, &ignored)) return false;
    return true;
}

typedef struct IesHead {
    int    lamps, gammas, planes, type, units;
    double lumens, multiplier, size[3], ballast, lamp_factor, watts;
} IesHead;

static bool read_head(LuminaireScan *in, IesHead *head)
{
    static const char *const types[] = {"", "C", "B", "A"};
    bool ok = luminaire_scan_count(in, "the number of lamps", 0, 1000000, &head->lamps) &&
              next_number(in, "the lumens a lamp", -1, 1e9, &head->lumens) &&
              next_number(in, "the candela multiplier", 1e-12, 1e9, &head->multiplier) &&
              luminaire_scan_count(in, "the number of vertical angles", 2, LUMINAIRE_ANGLES_MAX,
                                   &head->gammas) &&
              luminaire_scan_count(in, "the number of horizontal angles", 1,
                                   LUMINAIRE_ANGLES_MAX, &head->planes) &&
              luminaire_scan_count(in, "the photometric type", 1, 3, &head->type) &&
              luminaire_scan_count(in, "the units of length", 1, 2, &head->units) &&
              next_number(in, "the width", -1e5, 1e5, &head->size[0]) &&
              next_number(in, "the length", -1e5, 1e5, &head->size[1]) &&
              next_number(in, "the height", -1e5, 1e5, &head->size[2]) &&
              next_number(in, "the ballast factor", 1e-6, 1e6, &head->ballast) &&
              next_number(in, "the ballast-lamp factor", 1e-6, 1e6, &head->lamp_factor) &&
              next_number(in, "the watts", -1e9, 1e9, &head->watts);
    if (ok && head->type != 1)
        return luminaire_scan_fail(in, "is photometry of type %s (%d), wanted type C (1)",
                                   types[head->type], head->type);
    return ok;
}

/* The opening as LM-63 codes it: negative sizes are diameters. The sides are not looked at. */
static double opening_m2(const IesHead *head)
{
    double unit = head->units == 1 ? METRES_A_FOOT : 1;
    double w = head->size[0] * unit, l = head->size[1] * unit;
    if (w < 0 && l == 0) return PI / 4 * w * w; /* 1995: a circle by its width alone */
    if (w < 0 && l < 0) return PI / 4 * w * l;
    return fabs(w * l);
}

/* ---- angles and intensities -------------------------------------------------------------- */

/* The range of horizontal angles tells the symmetry. */
static bool find_symmetry(LuminaireScan *in, Luminaire *out)
{
    double first = out->c_deg[0], last = out->c_deg[out->planes - 1];
    out->mirror_deg[0] = out->mirror_deg[1] = -1;
    out->is_round = out->planes == 1;
    if (out->is_round) return true;
    if (first == 0 && (last == 90 || last == 180)) out->mirror_deg[0] = 0;
    if (first == 0 && last == 90) out->mirror_deg[1] = 90;
    if (first == 90 && last == 270) out->mirror_deg[0] = 90;
    bool is_whole = first == 0 && last > 180; /* 345 or 360 */
    return out->mirror_deg[0] >= 0 || is_whole ||
           luminaire_scan_fail(in, "horizontal angles go from %g to %g, wanted 0, 0 to 90, 0 "
                               "to 180, 90 to 270 or 0 to 360 degrees", first, last);
}

bool ies_read_luminaire(const char *file, const FileBytes *bytes, ImportSet *set,
                        Luminaire *result, Error *err)
{
    LuminaireScan in;
    IesHead       head = {0};
    Luminaire     out = {.file = file};
    const char   *tilt = "";
    if (!luminaire_scan_open(file, bytes, next_number, set, &in, err) ||
        !read_keywords(&in, &out.name, &out.cct_k, &tilt) || !skip_tilt(&in, tilt, set) ||
        !read_head(&in, &head))
        return false;
    out.has_tilt = strcasecmp(tilt, "NONE") != 0;
    out.planes = head.planes;
    out.gammas = head.gammas;
    out.c_deg = ARENA_NEW(set->arena, double, head.planes);
    out.gamma_deg = ARENA_NEW(set->arena, double, head.gammas);
    if (!luminaire_scan_angles(&in, "the vertical angle", head.gammas, 180, out.gamma_deg) ||
        !luminaire_scan_angles(&in, "the horizontal angle", head.planes, 360, out.c_deg) ||
        !find_symmetry(&in, &out) ||
        !luminaire_scan_intensities(&in, head.multiplier * head.ballast * head.lamp_factor,
                                    &out))
        return false;
    out.area_m2 = opening_m2(&head);
    out.stated_lm = head.lumens > 0 ? head.lamps * head.lumens * head.ballast * head.lamp_factor
                                    : 0;
    out.stated_as = "of its lamps; the ratio is the luminaire's efficiency";
    if (head.size[2] != 0)
        import_note(set, "%s: luminous sides (height %g) are taken into the flat opening",
                    path_name(file), head.size[2]);
    *result = out;
    return true;
}

static bool read_ies(const char *file, const ImportOptions *options, ImportSet *set, Error *err)
{
    Luminaire luminaire;
    return ies_read_luminaire(file, NULL, set, &luminaire, err) &&
           luminaire_add(&luminaire, options, set, err);
}

static bool is_ies(const char *file, const char *head, size_t size)
{
    TextLine text = {head, (int)size};
    return !strncasecmp(head, "IESNA", 5) || !strcasecmp(path_ending(file), ".ies") ||
           line_has(text, "\nTILT=");
}

const Importer importer_ies = {"ies", "IES LM-63 luminaires (.ies), as a white panel", is_ies,
                               read_ies};
