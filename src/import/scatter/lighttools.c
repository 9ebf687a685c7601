/* SPDX-License-Identifier: Apache-2.0 */
/* LightTools' scatter text (.bsdf): a header with the scatter angles, then blocks that each
 * name their light (AOI, POI), side, kind and wavelength.
 *
 * The scatter angles are about the NORMAL: ScatterRadial from it, ScatterAzimuth around it,
 * with the light of POI 0 at azimuth 90. That zero, and that POI turns the light
 * counter-clockwise, is known from another program's reader alone, as a note states. */
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "import/scatter/scan.h"
#include "import/scatter/scatter.h"

#define ANGLES_MAX 4096
#define LIGHT_AZIMUTH_DEG 90.0

typedef struct LightToolsBlock {
    double aoi, poi, nm, tis; /* degrees, nm */
    bool   is_front, is_reflection, is_y;
} LightToolsBlock;

typedef struct LightTools {
    WordScan scan;
    int     azimuths, radials;
    double *azimuth, *radial; /* degrees */
    bool    is_xyz, has_content;
    int     back, transmitted; /* blocks left out */
    bool    several_planes;
    double  first_plane;
    int     kept;
    double *value; /* of one block: azimuths x radials */
} LightTools;

/* ---- header ------------------------------------------------------------------------------ */

static bool read_symmetry(LightTools *in, Error *err)
{
    const char *word = scan_word(&in->scan);
    if (word && !strncasecmp(word, "Asymmetric", 10)) return true;
    return scan_fail(&in->scan, err, "Symmetry is '%s', required: Asymmetric",
                     word ? word : "");
}

/* Entries that do not concern the values (Source, ...) are skipped with their line. */
static bool read_header(LightTools *in, Error *err)
{
    WordScan *scan = &in->scan;
    while (!scan_accept(scan, "DataBegin")) {
        bool ok = true;
        if (scan_accept(scan, "Symmetry"))
            ok = read_symmetry(in, err);
        else if (scan_accept(scan, "SpectralContent"))
            ok = in->has_content = scan_spectral_content(scan, &in->is_xyz, err);
        else if (scan_accept(scan, "ScatterAzimuth"))
            ok = scan_counted_list(scan, "ScatterAzimuth", ANGLES_MAX, &in->azimuths,
                                   &in->azimuth, err);
        else if (scan_accept(scan, "ScatterRadial"))
            ok = scan_counted_list(scan, "ScatterRadial", ANGLES_MAX, &in->radials,
                                   &in->radial, err);
        else if (!scan_peek(scan))
            return scan_fail(scan, err, "the file ends in its header, required: DataBegin");
        else
            scan_line(scan);
        if (!ok) return false;
    }
    const char *missing = !in->has_content ? "SpectralContent"
                          : !in->azimuths  ? "ScatterAzimuth"
                          : !in->radials   ? "ScatterRadial"
                                           : NULL;
    if (missing) return scan_fail(scan, err, "the header has no %s", missing);
    const double full[] = {-360, 360}, half[] = {0, 180};
    return angles_check(scan->file, "ScatterAzimuth", in->azimuth, in->azimuths, full, err) &&
           angles_check(scan->file, "ScatterRadial", in->radial, in->radials, half, err);
}

/* ---- blocks ------------------------------------------------------------------------------ */

/* One of several words, of which the first matters. */
typedef struct BlockChoice {
    const char *name, *words[4], *wanted;
    bool       *is_first;
} BlockChoice;

/* Up to and with the TIS, whose values follow; *found is false at the end of the data. */
static bool read_block_head(LightTools *in, LightToolsBlock *block, bool *found, Error *err)
{
    const struct { const char *name; double *out; } numbers[] = {
        {"AOI", &block->aoi}, {"POI", &block->poi}, {"Wavelength", &block->nm}};
    const BlockChoice choices[] = {
        {"Side", {"Front", "Back"}, "Front or Back", &block->is_front},
        {"ScatterType", {"BRDF", "BTDF"}, "BRDF or BTDF", &block->is_reflection},
        {"TristimulusValue", {"TrisY", "TrisX", "TrisZ"}, "TrisX, TrisY or TrisZ",
         &block->is_y}};
    WordScan *scan = &in->scan;
    *block = (LightToolsBlock){.is_front = true, .is_reflection = true, .is_y = true};
    *found = false;
    for (bool begun = false;; begun = true) {
        bool is_entry = false;
        for (int i = 0; i < COUNT_OF(numbers) && !is_entry; i++)
            if ((is_entry = scan_accept(scan, numbers[i].name)) &&
                !scan_number(scan, numbers[i].name, numbers[i].out, err))
                return false;
        for (int i = 0; i < COUNT_OF(choices) && !is_entry; i++) {
            const BlockChoice *choice = &choices[i];
            if (!(is_entry = scan_accept(scan, choice->name))) continue;
            int word = scan_choice(scan, choice->name, choice->words, choice->wanted, err);
            if (word < 0) return false;
            *choice->is_first = word == 0;
        }
        if (is_entry) continue;
        *found = scan_accept(scan, "TIS");
        if (*found) return scan_number(scan, "TIS", &block->tis, err);
        if (!begun && scan_accept(scan, "DataEnd")) return true;
        const char *word = scan_peek(scan);
        return scan_fail(scan, err, "%.40s stands where an entry of a block (AOI, POI, Side, "
                         "Wavelength, ScatterType, TIS) or DataEnd is required",
                         word ? word : "the end of the file");
    }
}

static bool read_values(LightTools *in, Error *err)
{
    size_t count = (size_t)in->azimuths * (size_t)in->radials;
    for (size_t i = 0; i < count; i++)
        if (!scan_number(&in->scan, "a value of the block", &in->value[i], err)) return false;
    return true;
}

static bool add_block(LightTools *in, const LightToolsBlock *block, const float *nm,
                      ImportSet *set, TotalsNote *totals, Error *err)
{
    int         radials = in->radials;
    ImportRows rows = scatter_rows(set->arena, in->azimuths * radials, 1);
    double      light = LIGHT_AZIMUTH_DEG + block->poi;
    if (!(block->aoi >= 0 && block->aoi < 90))
        return scan_fail(&in->scan, err, "AOI is %g, required: 0 to below 90 "
                                         "degrees", block->aoi);
    for (int j = 0; j < in->azimuths; j++)
        for (int i = 0; i < radials; i++)
            scatter_put_measured(&rows, in->radial[i], in->azimuth[j] + 180 - light,
                                 &in->value[j * radials + i]);
    ScatterGrid grid = {radials, in->azimuths, in->radial, in->azimuth, in->value, 0, false};
    totals_add(totals, block->aoi, block->tis, scatter_grid_integral(&grid, *set->arena));
    in->several_planes |= in->kept && block->poi != in->first_plane;
    in->first_plane = block->poi;
    in->kept++;
    return scatter_add(set, in->scan.file, &rows, (ScatterLight){block->aoi, light}, nm, err);
}

/* False with no error at the end of the data. */
static bool read_block(LightTools *in, const ImportOptions *options, ImportSet *set,
                       TotalsNote *totals, Error *err)
{
    LightToolsBlock block;
    bool            found;
    if (!read_block_head(in, &block, &found, err) || !found || !read_values(in, err))
        return false;
    in->back += !block.is_front;
    in->transmitted += block.is_front && !block.is_reflection;
    if (!block.is_front || !block.is_reflection || !block.is_y) return true;
    const char  *file = in->scan.file;
    const float *nm = in->is_xyz ? scatter_photopic(options, file, set)
                                 : scatter_wavelength(block.nm, options, file, set, err);
    return nm && add_block(in, &block, nm, set, totals, err);
}

static bool report(const LightTools *in, ImportSet *set, Error *err)
{
    const char *name = path_name(in->scan.file);
    if (!in->kept)
        return scan_fail(&in->scan, err, "there is no block of reflection at the front: a "
                         "display panel is opaque, and only its front is seen");
    import_note(set, "%s: the light of POI 0 is taken to come from azimuth %g%s", name,
                LIGHT_AZIMUTH_DEG, in->several_planes ? ", and POI to turn it counter-clockwise"
                                                      : "");
    if (in->is_xyz) import_note(set, "%s: of X, Y and Z only Y is taken", name);
    if (in->back || in->transmitted)
        import_note(set, "%s: left out are %d blocks of the back and %d of transmission", name,
                    in->back, in->transmitted);
    return true;
}

static bool read_lighttools(const char *file, const ImportOptions *options, ImportSet *set,
                            Error *err)
{
    LightTools in = {.kept = 0};
    TotalsNote totals = {{0}, 0};
    Error      none = {.code = ERROR_NONE};
    if (!scan_open(file, set->arena, &in.scan, err) || !read_header(&in, err)) return false;
    size_t count = (size_t)in.azimuths * (size_t)in.radials;
    if (count / 2 > (size_t)(in.scan.end - in.scan.next))
        return scan_fail(&in.scan, err, "the header announces %zu values a block, more than "
                         "the file can hold", count);
    in.value = ARENA_NEW(set->arena, double, count);
    while (read_block(&in, options, set, &totals, &none)) continue;
    if (none.code != ERROR_NONE) {
        *err = none;
        return false;
    }
    totals_report(&totals, file, set);
    return report(&in, set, err);
}

static bool is_lighttools(const char *file, const char *head, size_t head_size)
{
    (void)file;
    return scan_head_has(head, head_size, "ScatterAzimuth") &&
           !scan_head_has(head, head_size, "AngleOfIncidence");
}

const Importer importer_lighttools = {"lighttools", "LightTools text BSDF (.bsdf)",
                                      is_lighttools, read_lighttools};
