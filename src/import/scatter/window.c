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
#include "base/mathd.h"
#include "base/units.h"
#include "import/scatter/scatter.h"
#include "import/scatter/window_xml.h"

/* ---- a tensor tree ---------------------------------------------------------------------- */

/* Radiance's tensor tree as tables.
 * Radiance's tensor tree: the BSDF as steps of varying size over squares that Shirley and
 * Chiu's map ("A Low Distortion Map Between Disk and Square", 1997) makes of the disk of
 * projected directions. Rank 3: a coordinate for the incidence, (1 - sin theta) / 2, and two
 * for the leaving direction, counted from the mirror direction. Rank 4: two for the point that
 * the light is mirrored to, two for the leaving one.
 *
 * A node is "{" 2^rank nodes "}" (bit d of a child's number is its side along dimension d), or
 * "{" numbers "}", a grid of equal steps along each dimension, the last dimension fastest.
 * Rows stand at the centres of the tree's own squares (large ones cut to 1/32 of the side). */

#define DEPTH_MAX 14
#define RANK_MAX 4
#define CELL_MOST (1.0 / 32)

typedef struct TensorNode {
    struct TensorNode *child; /* 2^rank of them, or NULL: a grid */
    int                log2_side;
    double            *value;
} TensorNode;

typedef struct TensorTree {
    const char *file;
    int         rank;
    TensorNode  root;
} TensorTree;

/* ---- text -------------------------------------------------------------------------------- */

static char next_mark(WordScan *text)
{
    while (text->next < text->end && strchr(" \t\r\n,", *text->next)) {
        text->line += *text->next == '\n';
        text->next++;
    }
    return text->next < text->end ? *text->next : 0;
}

static bool take_mark(WordScan *text, char mark, Error *err)
{
    char found = next_mark(text);
    if (found != mark)
        return scan_fail(text, err, "'%c' stands where '%c' of the tensor tree is required",
                         found ? found : ' ', mark);
    text->next++;
    return true;
}

/* Numbers up to the closing brace; how many must be a power of 2^rank. */
static bool read_grid(WordScan *text, int rank, TensorNode *node, Error *err)
{
    const char *stop = strchr(text->next, '}');
    if (!stop) return scan_fail(text, err, "the text ends inside the tensor tree, required: "
                                           "'}'");
    WordScan inside = *text;
    size_t count = 0;
    double one;
    inside.end = stop;
    for (WordScan counted = inside; next_mark(&counted); count++)
        if (!scan_number(&counted, "a number of the tensor tree", &one, err)) return false;
    while (count > (size_t)1 << (rank * node->log2_side)) node->log2_side++;
    if (count != (size_t)1 << (rank * node->log2_side))
        return scan_fail(text, err, "a grid of the tensor tree has %zu numbers, required: a "
                                    "power of %d", count, 1 << rank);
    node->value = ARENA_NEW(text->arena, double, count);
    for (size_t i = 0; i < count; i++)
        if (!scan_number(&inside, "a number of the tensor tree", &node->value[i], err))
            return false;
    text->next = stop;
    text->line = inside.line;
    return true;
}

static bool read_node(WordScan *text, int rank, int depth, TensorNode *node, Error *err)
{
    if (depth > DEPTH_MAX)
        return scan_fail(text, err, "the tensor tree is deeper than %d", DEPTH_MAX);
    if (!take_mark(text, '{', err)) return false;
    if (next_mark(text) != '{') {
        if (!read_grid(text, rank, node, err)) return false;
    } else {
        node->child = ARENA_NEW(text->arena, TensorNode, 1 << rank);
        for (int i = 0; i < 1 << rank; i++)
            if (!read_node(text, rank, depth + 1, &node->child[i], err)) return false;
    }
    return take_mark(text, '}', err);
}

/* ---- square and disk --------------------------------------------------------------------- */

/* A point of [0, 1]^2 to the disk: rings of the square become circles. */
static Direction direction_from_square(double u, double v)
{
    double a = 2 * u - 1, b = 2 * v - 1, r, phi;
    if (fabs(a) > fabs(b)) {
        r = a;
        phi = PI / 4 * b / a;
    } else {
        r = b;
        phi = b != 0 ? PI / 2 - PI / 4 * a / b : 0;
    }
    return (Direction){r * cos_d(phi), r * sin_d(phi), sqrt(fmax(0, 1 - r * r))};
}

static void square_from_disk(double x, double y, double square[2])
{
    double r = hypot_d(x, y), phi = atan2_d(y, x), a, b;
    if (phi < -PI / 4) phi += 2 * PI; /* [-pi/4, 7 pi/4) */
    if (phi < PI / 4) {
        a = r;
        b = phi * a / (PI / 4);
    } else if (phi < 3 * PI / 4) {
        b = r;
        a = -(phi - PI / 2) * b / (PI / 4);
    } else if (phi < 5 * PI / 4) {
        a = -r;
        b = (phi - PI) * a / (PI / 4);
    } else {
        b = -r;
        a = -(phi - 3 * PI / 2) * b / (PI / 4);
    }
    square[0] = (a + 1) / 2;
    square[1] = (b + 1) / 2;
}

/* ---- one direction of light -------------------------------------------------------------- */

typedef struct TreeWalk {
    const TensorTree *tree;
    int          fixed;           /* coordinates of the light: rank - 2 */
    double       light[RANK_MAX]; /* in [0, 1) */
    double       mirror_deg;      /* subtracted from the leaving azimuth */
    ImportRows *rows;            /* NULL: only count */
    int          count;
} TreeWalk;

static void put_square(TreeWalk *walk, double u, double v, double side, double value)
{
    int cuts = (int)fmax(1, ceil(side / CELL_MOST - 1e-9));
    walk->count += cuts * cuts;
    if (!walk->rows) return;
    for (int i = 0; i < cuts; i++)
        for (int j = 0; j < cuts; j++) {
            double    theta_deg, phi_deg;
            Direction d = direction_from_square(u + side * (i + 0.5) / cuts,
                                                v + side * (j + 0.5) / cuts);
            direction_to_degrees(d, &theta_deg, &phi_deg);
            phi_deg = fmod(phi_deg + 720 - walk->mirror_deg, 360);
            scatter_put(walk->rows, theta_deg, phi_deg, &value);
        }
}

/* The steps of a grid that hold the light. */
static void walk_grid(TreeWalk *walk, const TensorNode *node, const double corner[RANK_MAX],
                      double side)
{
    int    steps = 1 << node->log2_side;
    size_t at = 0;
    for (int d = 0; d < walk->fixed; d++) {
        int step = (int)((walk->light[d] - corner[d]) / side * steps);
        step = step < 0 ? 0 : step >= steps ? steps - 1 : step;
        at = at * (size_t)steps + (size_t)step;
    }
    const double *value = node->value + at * (size_t)steps * (size_t)steps;
    for (int i = 0; i < steps; i++)
        for (int j = 0; j < steps; j++, value++)
            put_square(walk, corner[walk->fixed] + side * i / steps,
                       corner[walk->fixed + 1] + side * j / steps, side / steps, *value);
}

static void walk_node(TreeWalk *walk, const TensorNode *node, const double corner[RANK_MAX],
                      double side)
{
    int rank = walk->tree->rank;
    if (!node->child) {
        walk_grid(walk, node, corner, side);
        return;
    }
    for (int i = 0; i < 1 << rank; i++) {
        double inner[RANK_MAX] = {0};
        bool   holds = true;
        for (int d = 0; d < rank; d++) {
            bool is_high = i >> d & 1;
            inner[d] = corner[d] + (is_high ? side / 2 : 0);
            if (d < walk->fixed) holds &= is_high == (walk->light[d] >= corner[d] + side / 2);
        }
        if (holds) walk_node(walk, &node->child[i], inner, side / 2);
    }
}

static void place_light(TreeWalk *walk, double incidence_deg, double mirror_deg)
{
    double s = sin_d(radians_from_degrees(incidence_deg));
    double turn = radians_from_degrees(mirror_deg);
    walk->fixed = walk->tree->rank - 2;
    walk->mirror_deg = walk->fixed == 2 ? mirror_deg : 0;
    if (walk->fixed == 1)
        walk->light[0] = fmax(0, 0.5 - 1e-9 - 0.5 * s);
    else
        square_from_disk(s * cos_d(turn), s * sin_d(turn), walk->light);
}

static bool add_tree_light(const TensorTree *tree, double incidence_deg, double mirror_deg,
                      const float *nm, ImportSet *set, Error *err)
{
    const double origin[RANK_MAX] = {0};
    TreeWalk walk = {.tree = tree};
    place_light(&walk, incidence_deg, mirror_deg);
    walk_node(&walk, &tree->root, origin, 1);
    if (walk.count > IMPORT_ROWS_MAX)
        return error_at(err, ERROR_INPUT, tree->file, "", "has more than %d leaving directions",
                        IMPORT_ROWS_MAX);
    ImportRows rows = scatter_rows(set->arena, walk.count, 1);
    walk.rows = &rows;
    walk_node(&walk, &tree->root, origin, 1);
    return scatter_add(set, tree->file, &rows,
                       (ScatterLight){incidence_deg, mirror_deg + 180}, nm, err);
}

/* ---- isotropy ---------------------------------------------------------------------------- */

static double lookup(const TensorTree *tree, const double at[RANK_MAX])
{
    const TensorNode *node = &tree->root;
    double place[RANK_MAX] = {0};
    memcpy(place, at, sizeof *place * (size_t)tree->rank);
    while (node->child) {
        int child = 0;
        for (int d = 0; d < tree->rank; d++) {
            bool is_high = place[d] >= 0.5;
            child |= is_high << d;
            place[d] = 2 * place[d] - is_high;
        }
        node = &node->child[child];
    }
    size_t index = 0;
    int    steps = 1 << node->log2_side;
    for (int d = 0; d < tree->rank; d++) {
        int step = (int)(place[d] * steps);
        index = index * (size_t)steps + (size_t)(step < steps ? step : steps - 1);
    }
    return node->value[index];
}

/* Does the value stay when light and leaving direction turn together? */
static bool is_isotropic_tree(const TensorTree *tree)
{
    if (tree->rank == 3) return true;
    for (int lean = 10; lean <= 80; lean += 10)
        for (int theta = 5; theta < 90; theta += 10)
            for (int phi = 0; phi < 360; phi += 15) {
                double first = 0;
                for (int turn = 0; turn < 360; turn += AZIMUTH_STEP_DEG) {
                    Direction m = direction_from_degrees(lean, turn);
                    Direction o = direction_from_degrees(theta, phi + turn);
                    double    at[RANK_MAX];
                    square_from_disk(m.x, m.y, at);
                    square_from_disk(o.x, o.y, at + 2);
                    double value = lookup(tree, at);
                    if (!turn) first = value;
                    if (fabs(value - first) > 1e-6 * fabs(first)) return false;
                }
            }
    return true;
}

/* nm: the one wavelength of the values; it stays. */
static bool tensor_tree_add(const WindowXml *in, const float *nm, ImportSet *set, Error *err)
{
    WordScan   text = in->data;
    TensorTree tree = {.file = in->file, .rank = in->structure == WINDOW_TREE3 ? 3 : 4};
    if (!read_node(&text, tree.rank, 0, &tree.root, err)) return false;
    if (next_mark(&text)) return scan_fail(&text, err, "more text follows the tensor tree");
    int turns = is_isotropic_tree(&tree) ? 1 : 360 / AZIMUTH_STEP_DEG;
    for (int lean = 0; lean <= INCIDENCE_LAST_DEG; lean += INCIDENCE_STEP_DEG)
        for (int t = 0; t < (lean ? turns : 1); t++)
            if (!add_tree_light(&tree, lean, t * AZIMUTH_STEP_DEG, nm, set, err)) return false;
    import_note(set, "%s: a tensor tree has steps, no slopes; it is read at incidences 0, %d, "
                "... %d degrees%s, at the centres of its own squares (cut to 1/32 of the side)",
                path_name(in->file), INCIDENCE_STEP_DEG, INCIDENCE_LAST_DEG,
                turns > 1 ? " and azimuths of the light every 30 degrees" : "");
    return true;
}

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
