/* SPDX-License-Identifier: Apache-2.0 */
/* pab advanced technologies' "Mountain" text, one file a direction of the light: header lines
 * that begin with #, then lines of theta, phi and the value (or X, Y and Z).
 *
 * #intheta and #inphi (or #incident_angle) are where the light COMES from, in the frame of the
 * rows: the mirror direction is at inphi + 180. A DSF holds the cosine of the leaving angle and
 * is divided by it. Layout as in the manual of Radiance's pabopto2bsdf. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "import/scatter/scan.h"
#include "import/scatter/scatter.h"

/* Nearer to the horizon a DSF cannot be divided by its cosine. */
#define GRAZING_DEG 89.9

typedef struct Mountain {
    WordScan scan;
    double theta, phi; /* of the light, degrees */
    bool   has_theta, has_phi, has_format, has_cosine, is_xyz;
    int    transmitted, grazing; /* rows left out */
} Mountain;

static bool header_number(Mountain *in, const char *text, const char *what, double *out,
                          Error *err)
{
    if (sscanf(text, "%lf", out) == 1 && isfinite(*out)) return true;
    return scan_fail(&in->scan, err, "%s is '%.40s', required: degrees", what, text);
}

static bool read_format(Mountain *in, const char *text, Error *err)
{
    char kind[16];
    if (sscanf(text, " theta phi %15s", kind) == 1) {
        in->has_format = true;
        in->has_cosine = !strcasecmp(kind, "DSF");
        if (in->has_cosine || !strcasecmp(kind, "BSDF") || !strcasecmp(kind, "BRDF"))
            return true;
        if (!strcasecmp(kind, "BTDF"))
            return scan_fail(&in->scan, err, "the format is BTDF: transmission, and a display "
                             "panel is opaque");
    }
    return scan_fail(&in->scan, err, "the format is '%.60s', required: theta phi BSDF or DSF",
                     text);
}

static bool read_colorimetry(Mountain *in, const char *text, Error *err)
{
    char kind[16] = "";
    sscanf(text, "%15s", kind);
    in->is_xyz = !strcasecmp(kind, "CIE-XYZ");
    if (in->is_xyz || !strcasecmp(kind, "CIE-Y")) return true;
    return scan_fail(&in->scan, err, "the colorimetry is '%s', required: CIE-Y or "
                                     "CIE-XYZ", kind);
}

/* The rest of the line after its key, or NULL. */
static const char *value_of(const char *line, const char *key)
{
    size_t length = strlen(key);
    if (strncasecmp(line, key, length)) return NULL;
    return line[length] == ' ' || line[length] == '\t' || !line[length] ? line + length : NULL;
}

static bool read_entry(Mountain *in, const char *line, ImportSet *set, Error *err)
{
    const char *text;
    char        name[128];
    if ((text = value_of(line, "#format:"))) return read_format(in, text, err);
    if ((text = value_of(line, "#colorimetry:"))) return read_colorimetry(in, text, err);
    if (sscanf(line, "#sample_name \"%127[^\"]\"", name) == 1 && !set->panel)
        set->panel = arena_string(set->arena, name, strlen(name));
    if ((text = value_of(line, "#intheta"))) {
        in->has_theta = true;
        return header_number(in, text, "intheta", &in->theta, err);
    }
    if ((text = value_of(line, "#inphi"))) {
        in->has_phi = true;
        return header_number(in, text, "inphi", &in->phi, err);
    }
    if ((text = value_of(line, "#incident_angle"))) {
        in->has_theta = in->has_phi = true;
        if (sscanf(text, "%lf %lf", &in->theta, &in->phi) != 2)
            return scan_fail(&in->scan, err, "incident_angle is '%.40s', required: theta and "
                             "phi",
                             text);
    }
    return true;
}

static bool read_header(Mountain *in, ImportSet *set, Error *err)
{
    WordScan after = in->scan;
    for (const char *line; (line = scan_line(&after)) && (*line == '#' || !*line);) {
        if (*line && !read_entry(in, line, set, err)) return false;
        in->scan = after;
    }
    if (!in->has_format) return scan_fail(&in->scan, err, "the header has no #format: line");
    if (!in->has_theta || !in->has_phi)
        return scan_fail(&in->scan, err, "the header has no %s",
                         in->has_theta ? "#inphi" : "#intheta");
    if (in->theta >= 90 && in->theta <= 180)
        return scan_fail(&in->scan, err, "the light comes from behind (intheta %g), required: "
                                         "the front: below 90 degrees", in->theta);
    if (!(in->theta >= 0 && in->theta < 90) || !(fabs(in->phi) <= 360))
        return scan_fail(&in->scan, err, "the light comes from (%g, %g), required: theta 0 to "
                                         "90 and phi -360 to 360 degrees", in->theta, in->phi);
    return true;
}

static bool put_row(Mountain *in, ImportRows *rows, Error *err)
{
    double theta, phi, value[3];
    int    numbers = in->is_xyz ? 3 : 1;
    if (!scan_number(&in->scan, "theta", &theta, err) ||
        !scan_number(&in->scan, "phi", &phi, err))
        return false;
    for (int c = 0; c < numbers; c++)
        if (!scan_number(&in->scan, "the value", &value[c], err)) return false;
    if (!(theta >= 0 && theta <= 180) || !(fabs(phi) <= 360))
        return scan_fail(&in->scan, err, "the direction is (%g, %g), required: theta 0 to 180 "
                                         "and phi -360 to 360 degrees", theta, phi);
    double one = value[numbers == 3];
    if (theta > 90) {
        in->transmitted++;
        return true;
    }
    if (in->has_cosine && theta > GRAZING_DEG) {
        in->grazing++;
        return true;
    }
    if (in->has_cosine) one /= cos_d(radians_from_degrees(theta));
    scatter_put_measured(rows, theta, phi + 180 - in->phi, &one);
    return true;
}

static bool read_rows(Mountain *in, ImportRows *rows, Error *err)
{
    while (scan_peek(&in->scan)) {
        if (rows->rows + rows->masked == rows->capacity)
            return scan_fail(&in->scan, err, "there is more than one row a line");
        if (!put_row(in, rows, err)) return false;
    }
    if (!rows->rows && in->transmitted)
        return scan_fail(&in->scan, err, "every direction is behind the sample: transmission, "
                         "and a display panel is opaque");
    return true;
}

static bool is_light(const ImportTable *table, ScatterLight light, float nm)
{
    double turn = table->incidence_phi_deg - light.azimuth_deg;
    return table->source == IMPORT_REFLECTION && table->channels == 1 &&
           fabs(table->incidence_deg - light.incidence_deg) < 1e-4 &&
           fabs(remainder(turn, 360)) < 1e-4 && fabsf(table->wavelength_nm[0] - nm) < 1e-3f;
}

/* Files with light from one direction and other sampling patterns are one table. */
static ImportRows join_pattern(ImportSet *set, const ImportRows *rows, ScatterLight light,
                                float nm)
{
    int i = 0;
    while (i < set->count && !is_light(&set->table[i], light, nm)) i++;
    if (i == set->count) return *rows;
    const ImportTable *table = &set->table[i];
    ImportTable        more = {.channels = 1};
    ImportRows all = scatter_rows(set->arena, table->rows + table->masked + rows->capacity, 1);
    import_rows_append(&all, table);
    import_rows_give(rows, &more);
    import_rows_append(&all, &more);
    set->table[i] = set->table[--set->count];
    return all;
}

static void report(const Mountain *in, ImportSet *set)
{
    const char *name = path_name(in->scan.file);
    if (in->has_cosine)
        import_note(set, "%s: the values hold the cosine of the leaving angle and are divided "
                    "by it", name);
    if (in->transmitted)
        import_note(set, "%s: %d directions behind the sample are left out", name,
                    in->transmitted);
    if (in->grazing)
        import_note(set, "%s: %d directions beyond %g degrees are left out: their cosine is "
                    "too small to divide by", name, in->grazing, GRAZING_DEG);
}

static bool read_mountain(const char *file, const ImportOptions *options, ImportSet *set,
                          Error *err)
{
    Mountain in = {.is_xyz = false};
    if (!scan_open(file, set->arena, &in.scan, err)) return false;
    if (in.scan.next < in.scan.end && !scan_check_end(&in.scan, err)) return false;
    if (!read_header(&in, set, err)) return false;
    ImportRows rows = scatter_rows(set->arena, scan_lines_left(&in.scan), 1);
    if (!read_rows(&in, &rows, err)) return false;
    const float *nm = in.is_xyz ? scatter_xyz(options, file, set)
                                : scatter_photopic(options, file, set);
    report(&in, set);
    ScatterLight light = {in.theta, in.phi};
    rows = join_pattern(set, &rows, light, *nm);
    return scatter_add(set, file, &rows, light, nm, err);
}

static bool is_mountain(const char *file, const char *head, size_t head_size)
{
    (void)file;
    return scan_head_has(head, head_size, "#format: theta phi") ||
           scan_head_has(head, head_size, "#incident_angle") ||
           scan_head_has(head, head_size, "#intheta");
}

const Importer importer_mountain = {
    "mountain", "pab-opto Mountain text, one file a direction of the light", is_mountain,
    read_mountain};
