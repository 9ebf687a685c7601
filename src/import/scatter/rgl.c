/* SPDX-License-Identifier: Apache-2.0 */
/* The RGL material database's .bsdf: Dupuy and Jakob, "An Adaptive Parameterization for
 * Efficient Material Acquisition and Rendering", 2018.
 *
 * For a light (theta_i, phi_i) a square s in [0, 1]^2 is warped by the density `vndf` onto the
 * square u of half vectors, u.x = sqrt(2 theta_m / pi), u.y = (phi_m + pi) / 2 pi (phi_m less
 * phi_i when the material is isotropic). The file holds on a grid of s
 *     f cos(theta_o) = spectra(s) * ndf(u_m) / (4 sigma(u_i))
 * (without the last factor where its flag `jacobian` is 0). Its own grid points of s, warped
 * forward, are the rows here: nothing is interpolated but ndf and sigma, and a peak keeps the
 * samples that the file gave it. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/units.h"
#include "import/scatter/byte_scan.h"
#include "import/scatter/half_angle.h"

/* ---- the container: named arrays of numbers ----------------------------------------------- */

#define TENSOR_RANK_MAX 8
#define TENSOR_FIELDS_MAX 64

typedef struct TensorField {
    const char *name;
    int type; /* its number in the file */
    int rank;
    size_t shape[TENSOR_RANK_MAX];
    size_t count; /* product of the shape */
    const unsigned char *data;
} TensorField;

typedef struct TensorFile {
    const char *file;
    TensorField field[TENSOR_FIELDS_MAX];
    int fields;
} TensorFile;

#define MAGIC "tensor_file" /* with its final zero */

typedef enum TensorType {
    TENSOR_U8 = 1,
    TENSOR_I8,
    TENSOR_U16,
    TENSOR_I16,
    TENSOR_U32,
    TENSOR_I32,
    TENSOR_U64,
    TENSOR_I64,
    TENSOR_F16,
    TENSOR_F32,
    TENSOR_F64
} TensorType;

static size_t type_size(int type) {
    static const unsigned char size[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return type >= TENSOR_U8 && type <= TENSOR_F64 ? size[type] : 0;
}

/* Number i of the field. Halves and signed integers stand in no such file. */
static double tensor_value(const TensorField *field, size_t i) {
    const unsigned char *at = field->data + i * type_size(field->type);
    switch (field->type) {
    case TENSOR_F32: return (double)float_from_bytes(at);
    case TENSOR_F64: return double_from_bytes(at);
    default: return (double)uint_from_bytes(at, type_size(field->type));
    }
}

static bool is_readable(int type) {
    return type == TENSOR_U8 || type == TENSOR_U16 || type == TENSOR_U32 || type == TENSOR_U64 ||
           type == TENSOR_F32 || type == TENSOR_F64;
}

/* The product of the shape, which the rest of the file must be able to hold. */
static bool place_data(const ByteScan *scan, TensorField *field, uint64_t offset, Error *err) {
    size_t each = type_size(field->type);
    if (!each)
        return byte_scan_fail(scan, err,
                              "field '%s' has a type of number %d, required: 1 to "
                              "11",
                              field->name, field->type);
    if (offset > scan->size)
        return byte_scan_fail(scan, err, "field '%s' begins behind the file's end", field->name);
    size_t room = (scan->size - (size_t)offset) / each;
    field->count = 1;
    for (int d = 0; d < field->rank; d++) {
        if (field->shape[d] && field->count > room / field->shape[d])
            return byte_scan_fail(scan, err, "field '%s' is larger than the file", field->name);
        field->count *= field->shape[d];
    }
    field->data = scan->data + offset;
    return true;
}

static bool read_field(ByteScan *scan, Arena *arena, TensorField *field, Error *err) {
    uint64_t length, rank, type, offset, side;
    const unsigned char *name;
    if (!byte_scan_uint(scan, 2, &length) || !(name = byte_scan_take(scan, (size_t)length)) ||
        !byte_scan_uint(scan, 2, &rank) || !byte_scan_uint(scan, 1, &type) ||
        !byte_scan_uint(scan, 8, &offset))
        return byte_scan_fail(scan, err, "the file ends inside its list of fields");
    *field = (TensorField){.name = arena_string(arena, (const char *)name, (size_t)length),
                           .type = (int)type,
                           .rank = (int)rank};
    if (field->rank > TENSOR_RANK_MAX)
        return byte_scan_fail(scan, err,
                              "field '%.40s' has %d dimensions, required: at most "
                              "%d",
                              field->name, field->rank, TENSOR_RANK_MAX);
    for (int d = 0; d < field->rank; d++) {
        if (!byte_scan_uint(scan, 8, &side))
            return byte_scan_fail(scan, err, "the file ends inside its list of fields");
        field->shape[d] = (size_t)side;
    }
    return place_data(scan, field, offset, err);
}

static bool tensor_file_open(const char *file, Arena *arena, TensorFile *out, Error *err) {
    ByteScan scan;
    uint64_t version, count;
    *out = (TensorFile){.file = file};
    if (!byte_scan_open(file, arena, &scan, err)) return false;
    const unsigned char *magic = byte_scan_take(&scan, sizeof MAGIC);
    if (!magic || memcmp(magic, MAGIC, sizeof MAGIC))
        return error_at(err, ERROR_INPUT, file, "",
                        "is no tensor file: it does not begin with "
                        "'tensor_file'");
    if (!byte_scan_uint(&scan, 2, &version) || !byte_scan_uint(&scan, 4, &count))
        return byte_scan_fail(&scan, err, "the file ends inside its header");
    if (version != 1)
        return byte_scan_fail(&scan, err, "the version is %d.%d, required: 1.0", (int)version & 255,
                              (int)version >> 8);
    if (count > TENSOR_FIELDS_MAX)
        return byte_scan_fail(&scan, err, "there are %u fields, required: at most %d",
                              (unsigned)count, TENSOR_FIELDS_MAX);
    for (; out->fields < (int)count; out->fields++)
        if (!read_field(&scan, arena, &out->field[out->fields], err)) return false;
    return true;
}

static const TensorField *tensor_file_find(const TensorFile *in, const char *name) {
    for (int i = 0; i < in->fields; i++)
        if (!strcmp(in->field[i].name, name)) return &in->field[i];
    return NULL;
}

static bool tensor_file_field(const TensorFile *in, const char *name, int rank,
                              const TensorField **out, Error *err) {
    const TensorField *field = tensor_file_find(in, name);
    if (!field) return error_at(err, ERROR_INPUT, in->file, name, "this field is missing");
    if (field->rank != rank)
        return error_at(err, ERROR_INPUT, in->file, name, "has %d dimensions, required: %d",
                        field->rank, rank);
    if (!is_readable(field->type))
        return error_at(err, ERROR_INPUT, in->file, name,
                        "has numbers of type %d, required: "
                        "floats or unsigned integers",
                        field->type);
    for (size_t i = 0; i < field->count; i++)
        if (!isfinite(tensor_value(field, i)))
            return error_at(err, ERROR_INPUT, in->file, name, "number %zu is not finite", i + 1);
    *out = field;
    return true;
}

/* ---- the material ------------------------------------------------------------------------- */

#define LIST_MAX 4096
/* Nearer to the horizon the cosine cannot be divided out. */
#define GRAZING_DEG 89.0

typedef struct Rgl {
    TensorFile file;
    const TensorField *theta_i, *phi_i, *ndf, *sigma, *vndf, *values, *wavelengths;
    int thetas, phis, channels;
    bool is_isotropic, is_rgb, has_jacobian;
    bool closes; /* the last azimuth is the first one again */
} Rgl;

/* ---- the file ---------------------------------------------------------------------------- */

static bool wrong_shape(const Rgl *in, const TensorField *field, Error *err, const char *wanted) {
    return error_at(err, ERROR_INPUT, in->file.file, field->name,
                    "has the wrong shape, "
                    "required: %s",
                    wanted);
}

static bool read_fields(Rgl *in, Error *err) {
    const TensorField *jacobian;
    in->is_rgb = !tensor_file_find(&in->file, "spectra") && tensor_file_find(&in->file, "rgb");
    const char *values = in->is_rgb ? "rgb" : "spectra";
    bool ok = tensor_file_field(&in->file, "theta_i", 1, &in->theta_i, err) &&
              tensor_file_field(&in->file, "phi_i", 1, &in->phi_i, err) &&
              tensor_file_field(&in->file, "ndf", 2, &in->ndf, err) &&
              tensor_file_field(&in->file, "sigma", 2, &in->sigma, err) &&
              tensor_file_field(&in->file, "vndf", 4, &in->vndf, err) &&
              tensor_file_field(&in->file, values, 5, &in->values, err) &&
              tensor_file_field(&in->file, "jacobian", 1, &jacobian, err) &&
              (in->is_rgb || tensor_file_field(&in->file, "wavelengths", 1, &in->wavelengths, err));
    if (!ok) return false;
    if (jacobian->count != 1) return wrong_shape(in, jacobian, err, "one number");
    in->has_jacobian = tensor_value(jacobian, 0) != 0;
    return true;
}

static bool is_grid(const TensorField *field, int first) {
    for (int d = first; d < field->rank; d++)
        if (field->shape[d] < 2 || field->shape[d] > 65536) return false;
    return true;
}

static bool check_shapes(Rgl *in, Error *err) {
    size_t channels = in->is_rgb ? RGB_BANDS : in->wavelengths->count;
    size_t thetas = in->theta_i->count, phis = in->phi_i->count;
    const struct {
        const TensorField *field;
        bool fits;
        const char *wanted;
    } shapes[] = {
        {in->theta_i, thetas >= 1 && thetas <= LIST_MAX, "1 to 4096 angles"},
        {in->phi_i, phis >= 1 && phis <= LIST_MAX, "1 to 4096 angles"},
        {in->wavelengths, channels >= 1 && channels <= LIST_MAX, "1 to 4096 wavelengths"},
        {in->ndf, is_grid(in->ndf, 0), "at least 2 x 2"},
        {in->sigma, is_grid(in->sigma, 0), "at least 2 x 2"},
        {in->vndf,
         is_grid(in->vndf, 2) && in->vndf->shape[0] == phis && in->vndf->shape[1] == thetas,
         "phi_i x theta_i x a grid of at least 2 x 2"},
        {in->values,
         is_grid(in->values, 3) && in->values->shape[0] == phis && in->values->shape[1] == thetas &&
             in->values->shape[2] == channels,
         "phi_i x theta_i x channels x a grid of at least 2 x 2"}};
    for (int i = 0; i < COUNT_OF(shapes); i++)
        if (!shapes[i].fits) return wrong_shape(in, shapes[i].field, err, shapes[i].wanted);
    in->thetas = (int)thetas;
    in->phis = (int)phis;
    in->channels = (int)channels;
    in->is_isotropic = phis <= 2;
    return true;
}

static bool check_angles(Rgl *in, Error *err) {
    const char *file = in->file.file;
    for (int i = 0; i < in->thetas; i++) {
        double theta = tensor_value(in->theta_i, (size_t)i);
        if (!(theta >= 0 && theta <= PI / 2 + 1e-6))
            return error_at(err, ERROR_INPUT, file, "theta_i", "has %g, required: 0 to pi / 2",
                            theta);
    }
    if (in->is_isotropic) return true;
    double first = tensor_value(in->phi_i, 0);
    double last = tensor_value(in->phi_i, in->phi_i->count - 1);
    in->closes = fabs(last - first - 2 * PI) < 1e-3;
    double step = (last - first) / (in->phis - 1);
    if (!(last - first > 2 * PI - 1.5 * step)) /* the last step may be left out */
        return error_at(err, ERROR_INPUT, file, "phi_i",
                        "goes from %g to %g: only part of a "
                        "turn (a material stored by its symmetry), which is not read here",
                        first, last);
    return true;
}

/* ---- grids ------------------------------------------------------------------------------- */

/* Bilinear at (x, y) of the unit square; x runs along the last dimension. */
static double bilinear(const TensorField *grid, double x, double y) {
    size_t width = grid->shape[1], height = grid->shape[0];
    double u = fmin(fmax(x, 0), 1) * (double)(width - 1);
    double v = fmin(fmax(y, 0), 1) * (double)(height - 1);
    size_t i = (size_t)u < width - 2 ? (size_t)u : width - 2;
    size_t j = (size_t)v < height - 2 ? (size_t)v : height - 2;
    u -= (double)i;
    v -= (double)j;
    size_t at = j * width + i;
    double low = (1 - u) * tensor_value(grid, at) + u * tensor_value(grid, at + 1);
    at += width;
    double high = (1 - u) * tensor_value(grid, at) + u * tensor_value(grid, at + 1);
    return (1 - v) * low + v * high;
}

/* One slice of vndf as a warp: rows are chosen by the running integral of the rows, then the
 * place in the row by the running integral along it (both of the bilinear density). */
typedef struct Warp {
    size_t width, height;
    double *density;     /* height x width */
    double *conditional; /* running integral along each row */
    double *marginal;    /* running integral of the rows' totals */
} Warp;

static bool make_warp(const Rgl *in, int phi, int theta, Warp *out, Arena *arena, Error *err) {
    size_t width = in->vndf->shape[3], height = in->vndf->shape[2], size = width * height;
    size_t first = ((size_t)phi * (size_t)in->thetas + (size_t)theta) * size;
    *out = (Warp){width, height, ARENA_NEW(arena, double, size), ARENA_NEW(arena, double, size),
                  ARENA_NEW(arena, double, height)};
    for (size_t i = 0; i < size; i++) {
        out->density[i] = tensor_value(in->vndf, first + i);
        if (out->density[i] < 0)
            return error_at(err, ERROR_INPUT, in->file.file, "vndf", "has a density below 0");
        if (i % width)
            out->conditional[i] =
                out->conditional[i - 1] + (out->density[i - 1] + out->density[i]) / 2;
    }
    for (size_t j = 1; j < height; j++)
        out->marginal[j] =
            out->marginal[j - 1] +
            (out->conditional[j * width - 1] + out->conditional[(j + 1) * width - 1]) / 2;
    return out->marginal[height - 1] > 0 ||
           error_at(err, ERROR_INPUT, in->file.file, "vndf", "has a density of 0 everywhere");
}

/* t in [0, 1] with a t + (b - a) t^2 / 2 = area. */
static double invert_trapezoid(double a, double b, double area) {
    double slope = b - a;
    if (a + b <= 0) return 0;
    if (fabs(slope) < 1e-9 * (a + b)) return fmin(fmax(2 * area / (a + b), 0), 1);
    double root = sqrt(fmax(0, a * a + 2 * slope * area));
    return fmin(fmax((root - a) / slope, 0), 1);
}

/* Where s comes to lie in the square of half vectors. */
static void warp(const Warp *in, double sx, double sy, double u[2]) {
    size_t width = in->width, row = 0, column = 0;
    double want = fmin(fmax(sy, 0), 1) * in->marginal[in->height - 1];
    while (row + 2 < in->height && in->marginal[row + 1] < want) row++;
    const double *low = in->conditional + row * width, *high = low + width;
    double v = invert_trapezoid(low[width - 1], high[width - 1], want - in->marginal[row]);
    want = fmin(fmax(sx, 0), 1) * ((1 - v) * low[width - 1] + v * high[width - 1]);
    while (column + 2 < width && (1 - v) * low[column + 1] + v * high[column + 1] < want) column++;
    const double *d = in->density + row * width + column;
    double before = (1 - v) * low[column] + v * high[column];
    double a = (1 - v) * d[0] + v * d[width], b = (1 - v) * d[1] + v * d[width + 1];
    u[0] = ((double)column + invert_trapezoid(a, b, want - before)) / (double)(width - 1);
    u[1] = ((double)row + v) / (double)(in->height - 1);
}

/* ---- tables ------------------------------------------------------------------------------ */

typedef struct RglLight {
    int phi, theta; /* numbers in the file */
    double azimuth; /* radians; 0 when isotropic */
    Direction direction;
    double sigma;
    Warp warp;
} RglLight;

static void put_node(const Rgl *in, const RglLight *light, size_t j, size_t i, double *value,
                     ImportRows *rows) {
    size_t height = in->values->shape[3], width = in->values->shape[4];
    size_t plane = height * width;
    double u[2], theta_deg, phi_deg, scale = 1;
    warp(&light->warp, (double)i / (double)(width - 1), (double)j / (double)(height - 1), u);
    double theta_m = u[0] * u[0] * PI / 2, phi_m = (2 * u[1] - 1) * PI;
    Direction half = direction_from_degrees(
        degrees_from_radians(theta_m),
        degrees_from_radians(phi_m + (in->is_isotropic ? light->azimuth : 0)));
    Direction leaving = half_angle_mirror(light->direction, half);
    direction_to_degrees(leaving, &theta_deg, &phi_deg);
    if (theta_deg > GRAZING_DEG) return;
    if (in->has_jacobian) scale = bilinear(in->ndf, u[0], u[1]) / (4 * light->sigma);
    size_t at = ((size_t)light->phi * (size_t)in->thetas + (size_t)light->theta) *
                    (size_t)in->channels * plane +
                j * width + i;
    for (int c = 0; c < in->channels; c++) {
        size_t channel = (size_t)(in->is_rgb ? RGB_BANDS - 1 - c : c);
        value[c] = tensor_value(in->values, at + channel * plane) * scale / leaving.z;
    }
    phi_deg = fmod(phi_deg + 540 - degrees_from_radians(light->azimuth), 360);
    scatter_put(rows, theta_deg, phi_deg, value);
}

/* Degrees that the file's single precision knows: to 0.0001. */
static double whole_ticks(double radians) {
    return round(degrees_from_radians(radians) * 1e4) / 1e4;
}

static bool add_light(const Rgl *in, int phi, int theta, const float *nm, ImportSet *set,
                      Error *err) {
    double lean = tensor_value(in->theta_i, (size_t)theta);
    double turn = in->is_isotropic ? 0 : tensor_value(in->phi_i, (size_t)phi);
    RglLight light = {.phi = phi, .theta = theta, .azimuth = turn};
    light.direction =
        direction_from_degrees(degrees_from_radians(lean), degrees_from_radians(turn));
    light.sigma = bilinear(in->sigma, sqrt(lean * 2 / PI), (turn + PI) / (2 * PI));
    if (in->has_jacobian && !(light.sigma > 0))
        return error_at(err, ERROR_INPUT, in->file.file, "sigma",
                        "is %g at theta_i %g, "
                        "required: above 0",
                        light.sigma, lean);
    Arena before = *set->arena;
    size_t height = in->values->shape[3], width = in->values->shape[4];
    ImportRows rows = scatter_rows(set->arena, (int)(height * width), in->channels);
    Arena scratch = *set->arena;
    double *value = ARENA_NEW(&scratch, double, in->channels);
    if (!make_warp(in, phi, theta, &light.warp, &scratch, err)) return false;
    for (size_t j = 0; j < height; j++)
        for (size_t i = 0; i < width; i++) put_node(in, &light, j, i, value, &rows);
    if (!rows.rows) {
        *set->arena = before;
        return true;
    }
    ScatterLight at = {whole_ticks(lean), in->is_isotropic ? 180 : whole_ticks(turn)};
    return at.incidence_deg >= 90 || scatter_add(set, in->file.file, &rows, at, nm, err);
}

static bool name_bands(const Rgl *in, ImportSet *set, const float **nm, Error *err) {
    if (in->is_rgb) {
        *nm = scatter_rgb_bands(in->file.file, set);
        return true;
    }
    float *list = ARENA_NEW(set->arena, float, in->channels);
    for (int c = 0; c < in->channels; c++) {
        list[c] = (float)tensor_value(in->wavelengths, (size_t)c);
        if (!(list[c] > 0) || (c && !(list[c] > list[c - 1])))
            return error_at(err, ERROR_INPUT, in->file.file, "wavelengths",
                            "has %g nm, "
                            "required: rising wavelengths",
                            (double)list[c]);
    }
    *nm = list;
    return true;
}

static bool read_rgl(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    Rgl in;
    const float *nm = NULL;
    (void)options;
    memset(&in, 0, sizeof in);
    if (!tensor_file_open(file, set->arena, &in.file, err) || !read_fields(&in, err) ||
        !check_shapes(&in, err) || !check_angles(&in, err) || !name_bands(&in, set, &nm, err))
        return false;
    int phis = in.is_isotropic ? 1 : in.phis - in.closes;
    for (int phi = 0; phi < phis; phi++)
        for (int theta = 0; theta < in.thetas; theta++)
            if (!add_light(&in, phi, theta, nm, set, err)) return false;
    import_note(set,
                "%s: stands at the file's own incidences and samples; directions beyond "
                "%g degrees are left out, where the cosine that the values hold cannot be "
                "divided out",
                path_name(file), GRAZING_DEG);
    return true;
}

static bool is_rgl(const char *file, const char *head, size_t head_size) {
    (void)file;
    return head_size > sizeof MAGIC && !memcmp(head, MAGIC, sizeof MAGIC) &&
           memmem(head, head_size, "vndf", 4);
}

const Importer importer_rgl = {"rgl", "RGL material database, tensor file (.bsdf)", is_rgl,
                               read_rgl};
