/* SPDX-License-Identifier: Apache-2.0 */
/* FRED's tabulated scatter (`type bsdf_data`), and the same layout with !! comments as RPC
 * Photonics writes it: a line of two angles, the MIRROR direction (theta, phi) of the light
 * that follows, then lines of theta, phi and value for the directions of scatter.
 *
 * Both angles of phi count from one axis, so the light comes from phi + 180. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "import/scatter/scan.h"
#include "import/scatter/scatter.h"

typedef struct Fred {
    WordScan     scan;
    double       scale;
    ScatterLight light; /* of the rows that are being read */
    double       mirror_phi;
    ImportRows   rows;
    bool         has_light;
    const float *nm;
} Fred;

static bool read_format(Fred *in, char *line, Error *err)
{
    for (char *at = line, *word; (word = strtok_r(at, " \t", &at));) {
        if (!strcasecmp(word, "format") || !strcasecmp(word, "angles=deg") ||
            !strcasecmp(word, "bsdf=value"))
            continue;
        if (!strncasecmp(word, "scale=", 6)) {
            if (!scan_to_number(word + 6, &in->scale) || !(in->scale > 0))
                return scan_fail(&in->scan, err, "scale is '%s', required: a number above 0",
                                 word + 6);
        } else {
            return scan_fail(&in->scan, err, "'%.40s' is no format that is known here, "
                             "required: angles=deg, bsdf=value, scale=NUMBER", word);
        }
    }
    return true;
}

static bool flush(Fred *in, ImportSet *set, Error *err)
{
    if (!in->has_light) return true;
    if (!in->rows.rows)
        return scan_fail(&in->scan, err, "incidence %g has no row of theta, phi and value",
                         in->light.incidence_deg);
    return scatter_add(set, in->scan.file, &in->rows, in->light, in->nm, err);
}

/* Lines up to the next line of two numbers: room for the rows of one light. */
static int count_lines(const Fred *in)
{
    int lines = 0, words = 0;
    bool inside = false;
    for (const char *c = in->scan.next; c < in->scan.end; c++) {
        bool is_gap = *c == ' ' || *c == '\t' || *c == ',' || *c == '\r' || *c == '\n';
        words += !is_gap && !inside;
        inside = !is_gap;
        if (*c != '\n') continue;
        if (words == 2 || lines == IMPORT_ROWS_MAX) break;
        lines++;
        words = 0;
    }
    return lines;
}

static bool start_light(Fred *in, const double *cell, ImportSet *set, Error *err)
{
    double lean = cell[0], phi = cell[1];
    if (!flush(in, set, err)) return false;
    if (!(lean >= 0 && lean < 90))
        return scan_fail(&in->scan, err, "the angle of incidence is %g, required: 0 to below "
                                         "90 degrees", lean);
    if (!(fabs(phi) <= 360))
        return scan_fail(&in->scan, err, "phi is %g, required: -360 to 360 degrees", phi);
    in->light = (ScatterLight){lean, phi + 180};
    in->mirror_phi = phi;
    in->rows = scatter_rows(set->arena, count_lines(in), 1);
    in->has_light = true;
    return true;
}

static bool put_row(Fred *in, const double *cell, Error *err)
{
    double theta = cell[0], phi = cell[1], value = cell[2] * in->scale;
    if (!in->has_light)
        return scan_fail(&in->scan, err, "a row of three numbers stands before the two angles "
                         "of the light");
    if (in->rows.rows + in->rows.masked == in->rows.capacity)
        return scan_fail(&in->scan, err, "there are more rows than can be taken");
    if (!(theta >= -90 && theta <= 180))
        return scan_fail(&in->scan, err, "theta is %g, required: -90 to 90 degrees", theta);
    if (!(fabs(phi) <= 360))
        return scan_fail(&in->scan, err, "phi is %g, required: -360 to 360 degrees", phi);
    if (theta < 0) phi += 180;
    scatter_put_measured(&in->rows, fabs(theta), phi - in->mirror_phi, &value);
    return true;
}

/* At most four numbers of a line; false when a word is none. */
static bool read_cells(char *line, double *cell, int *count)
{
    *count = 0;
    for (char *at = line, *word; (word = strtok_r(at, " \t,", &at)); (*count)++)
        if (*count == 4 || !scan_to_number(word, &cell[*count])) return false;
    return true;
}

static bool read_row(Fred *in, const char *line, ImportSet *set, Error *err)
{
    double cell[4];
    int    count;
    char  *copy = arena_string(set->arena, line, strlen(line));
    if (read_cells(copy, cell, &count)) {
        if (count == 2) return start_light(in, cell, set, err);
        if (count == 3) return put_row(in, cell, err);
    }
    return scan_fail(&in->scan, err, "'%.40s' is no row, required: theta, phi and value, or "
                                     "the two angles of the light", line);
}

static bool read_lines(Fred *in, ImportSet *set, Error *err)
{
    for (;;) {
        Arena       before = *set->arena;
        const char *line = scan_line(&in->scan);
        if (!line) return true;
        in->scan.line--; /* messages name the line that was read */
        bool ok = true;
        if (!strncasecmp(line, "type", 4)) {
            if (!strstr(line, "bsdf_data"))
                ok = scan_fail(&in->scan, err, "'%.40s' stands where 'type bsdf_data' is "
                               "required", line);
        } else if (!strncasecmp(line, "format", 6)) {
            ok = read_format(in, arena_string(set->arena, line, strlen(line)), err);
        } else if (*line && *line != '#' && strncmp(line, "!!", 2)) {
            bool had_light = in->has_light;
            int  tables = set->count;
            const double *rows = in->rows.value;
            ok = read_row(in, line, set, err);
            if (had_light == in->has_light && tables == set->count && rows == in->rows.value)
                *set->arena = before; /* nothing was kept but the row's numbers */
        }
        if (!ok) return false;
        in->scan.line++;
    }
}

static bool read_fred(const char *file, const ImportOptions *options, ImportSet *set,
                      Error *err)
{
    Fred in = {.scale = 1};
    if (!scan_open(file, set->arena, &in.scan, err) || !scan_check_end(&in.scan, err) ||
        !(in.nm = scatter_wavelength(0, options, file, set, err)) || !read_lines(&in, set, err))
        return false;
    if (!in.has_light)
        return scan_fail(&in.scan, err, "the file ends before the two angles of the light");
    import_note(set, "%s: does not say whether it is reflection or transmission; it is taken "
                "as reflection", path_name(file));
    return flush(&in, set, err);
}

static bool is_fred(const char *file, const char *head, size_t head_size)
{
    (void)file;
    return scan_head_has(head, head_size, "type bsdf_data") ||
           scan_head_has(head, head_size, "!!BSDF Data");
}

const Importer importer_fred = {"fred", "FRED tabulated scatter, text (type bsdf_data)",
                                is_fred, read_fred};
