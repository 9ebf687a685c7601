/* SPDX-License-Identifier: Apache-2.0 */
/* WINDOW's and Radiance's BSDF as XML: a tensor tree (tensor_tree.h), or a matrix over patches
 * of the hemisphere (Klems, "A New Method for Predicting the Solar Heat Gain of Complex
 * Fenestration Systems", 1994): every value is the mean of a pair of patches. Rows stand at the
 * centres of the leaving patches.
 *
 * A surface is isotropic when the matrix does not change under every turn that maps both the
 * incident and the leaving latitude onto itself. Otherwise light comes from every azimuth of
 * the finest latitude, and a coarser latitude answers with the patch that holds it. */
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "import/scatter/scatter.h"
#include "import/scatter/tensor_tree.h"

#define ISOTROPY_TOLERANCE 1e-3 /* of the largest value */

typedef struct Klems {
    const WindowXml *in;
    const double    *value; /* leaving x incident */
} Klems;

static double latitude_centre(const WindowBasis *basis, int latitude)
{
    double low = latitude ? basis->upper_deg[latitude - 1] : 0;
    if (!latitude && basis->pieces[0] == 1) return 0;
    return (low + basis->upper_deg[latitude]) / 2;
}

static int first_patch(const WindowBasis *basis, int latitude)
{
    int first = 0;
    for (int i = 0; i < latitude; i++) first += basis->pieces[i];
    return first;
}

/* The patch of a latitude that holds an azimuth in degrees. */
static int patch_at(const WindowBasis *basis, int latitude, double azimuth_deg)
{
    int pieces = basis->pieces[latitude];
    int piece = (int)floor(azimuth_deg / 360 * pieces + 0.5 + 1e-9) % pieces;
    return first_patch(basis, latitude) + (piece < 0 ? piece + pieces : piece);
}

static double value_at(const Klems *k, int incident, int leaving)
{
    return k->value[(size_t)leaving * (size_t)k->in->incident.patches + (size_t)incident];
}

static bool read_matrix(WindowXml *in, Klems *out, Error *err)
{
    size_t incident = (size_t)in->incident.patches, leaving = (size_t)in->leaving.patches;
    if (incident * leaving > (size_t)(in->data.end - in->data.next))
        return scan_fail(&in->data, err, "the matrix is %zu x %zu, more numbers than there are",
                         leaving, incident);
    double *value = ARENA_NEW(in->data.arena, double, incident * leaving);
    for (size_t i = 0; i < incident * leaving; i++) {
        /* Rows: a row an incident patch. Columns: a row a leaving patch. */
        size_t at = in->structure == WINDOW_COLUMNS
                        ? i
                        : i % leaving * incident + i / leaving;
        if (!scan_number(&in->data, "a number of the matrix", &value[at], err)) return false;
    }
    if (scan_peek(&in->data))
        return scan_fail(&in->data, err, "more numbers than %zu x %zu follow", leaving,
                         incident);
    *out = (Klems){in, value};
    return true;
}

/* ---- isotropy ---------------------------------------------------------------------------- */

static int common_divisor(int a, int b)
{
    while (b) {
        int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* The largest change of one pair of latitudes under the smallest turn that both have. */
static double largest_change(const Klems *k, int lat_in, int lat_out)
{
    const WindowBasis *in = &k->in->incident, *out = &k->in->leaving;
    int    ni = in->pieces[lat_in], no = out->pieces[lat_out], turns = common_divisor(ni, no);
    int    first_in = first_patch(in, lat_in), first_out = first_patch(out, lat_out);
    double most = 0;
    for (int i = 0; i < ni; i++)
        for (int o = 0; o < no; o++) {
            int turned_in = (i + ni / turns) % ni, turned_out = (o + no / turns) % no;
            double change = value_at(k, first_in + i, first_out + o) -
                            value_at(k, first_in + turned_in, first_out + turned_out);
            most = fmax(most, fabs(change));
        }
    return most;
}

static bool is_isotropic(const Klems *k)
{
    double largest = 0, most = 0;
    size_t count = (size_t)k->in->incident.patches * (size_t)k->in->leaving.patches;
    for (size_t i = 0; i < count; i++) largest = fmax(largest, fabs(k->value[i]));
    for (int i = 0; i < k->in->incident.latitudes; i++)
        for (int o = 0; o < k->in->leaving.latitudes; o++)
            most = fmax(most, largest_change(k, i, o));
    return most <= ISOTROPY_TOLERANCE * largest;
}

/* ---- tables ------------------------------------------------------------------------------ */

/* mirror_deg: the azimuth that the light would be mirrored to. */
static bool add_light(const Klems *k, int latitude, double mirror_deg, const float *nm,
                      ImportSet *set, Error *err)
{
    const WindowBasis *out = &k->in->leaving;
    int         incident = patch_at(&k->in->incident, latitude, mirror_deg);
    ImportRows rows = scatter_rows(set->arena, out->patches, 1);
    for (int o = 0, leaving = 0; o < out->latitudes; o++)
        for (int piece = 0; piece < out->pieces[o]; piece++, leaving++) {
            double one = value_at(k, incident, leaving);
            double phi = 360.0 * piece / out->pieces[o] - mirror_deg;
            scatter_put(&rows, latitude_centre(out, o), phi < 0 ? phi + 360 : phi, &one);
        }
    ScatterLight light = {latitude_centre(&k->in->incident, latitude), mirror_deg + 180};
    return scatter_add(set, k->in->file, &rows, light, nm, err);
}

/* nm: the one wavelength of the values; it stays. */
static bool klems_add(const WindowXml *xml, const float *nm, ImportSet *set, Error *err)
{
    WindowXml in = *xml;
    Klems     k = {NULL, NULL};
    if (!read_matrix(&in, &k, err)) return false;
    int turns = 1;
    if (!is_isotropic(&k))
        for (int i = 0; i < in.incident.latitudes; i++)
            if (in.incident.pieces[i] > turns) turns = in.incident.pieces[i];
    for (int i = 0; i < in.incident.latitudes; i++) {
        bool is_normal = latitude_centre(&in.incident, i) == 0;
        for (int t = 0; t < (is_normal ? 1 : turns); t++)
            if (!add_light(&k, i, 360.0 * t / turns, nm, set, err)) return false;
    }
    import_note(set, "%s: values are means over patches of the hemisphere (%d incident, %d "
                "leaving) and stand at the patches' centres: a peak narrower than a patch is "
                "not resolved", path_name(in.file), in.incident.patches, in.leaving.patches);
    if (turns > 1)
        import_note(set, "%s: anisotropic; light from %d azimuths, each answered by the "
                    "incident patch that holds it", path_name(in.file), turns);
    return true;
}

/* ---- the importer ------------------------------------------------------------------------ */

static bool read_window(const char *file, const ImportOptions *options, ImportSet *set,
                        Error *err)
{
    WindowXml in;
    if (!window_xml_read(file, set, &in, err)) return false;
    const float *nm = scatter_photopic(options, file, set);
    if (!set->panel) set->panel = in.panel;
    bool is_matrix = in.structure == WINDOW_COLUMNS || in.structure == WINDOW_ROWS;
    return is_matrix ? klems_add(&in, nm, set, err) : tensor_tree_add(&in, nm, set, err);
}

static bool is_window(const char *file, const char *head, size_t head_size)
{
    char   text[IMPORT_HEAD_BYTES + 1]; /* without the zeros of UTF-16 */
    size_t count = 0;
    (void)file;
    for (size_t i = 0; i < head_size && i < IMPORT_HEAD_BYTES; i++)
        if (head[i]) text[count++] = head[i];
    text[count] = 0;
    return strstr(text, "<WindowElement") != NULL;
}

const Importer importer_window = {
    "window", "WINDOW / Radiance BSDF as XML: Klems or tensor tree", is_window, read_window};
