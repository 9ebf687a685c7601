/* SPDX-License-Identifier: Apache-2.0 */
/* The KAIST polarimetric measurements as a tensor file (.pbsdf): Baek et al., "Image-Based
 * Acquisition and Modeling of Polarimetric Reflectance", 2020.
 *
 * M[phi_d][theta_d][theta_h][wavelength][4][4] is the Mueller matrix of the BRDF (without the
 * cosine) over half and difference angles in radians, the light being the direction that the
 * difference angles describe. Its first element, which unpolarised light sees, is taken,
 * linear between the nodes; NaN marks angles that were not measured. */
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "import/scatter/half_angle.h"
#include "import/scatter/tensor_file.h"
#include "panel/set/measurement.h"

#define MUELLER 16 /* numbers of a matrix */
#define ANGLES_MAX 4096

typedef struct Pbsdf {
    TensorFile         file;
    const TensorField *matrix;
    int                count[3];  /* phi_d, theta_d, theta_h */
    double            *angle[3];  /* degrees, rising */
    int                channels;
} Pbsdf;

static bool read_angles(Pbsdf *in, int which, const char *name, Arena *arena, Error *err)
{
    const TensorField *field = tensor_file_find(&in->file, name);
    if (field && field->rank == 2 && field->shape[0] == 0)
        return error_at(err, ERROR_INPUT, in->file.file, name, "is empty: the file does not "
                        "hold the angles of its values, which cannot be guessed");
    if (!tensor_file_field(&in->file, name, field && field->rank == 1 ? 1 : 2, &field, err))
        return false;
    if (field->count < 2 || field->count > ANGLES_MAX ||
        field->count != field->shape[field->rank - 1])
        return error_at(err, ERROR_INPUT, in->file.file, name, "has the wrong shape, "
                        "required: 1 x 2 to 4096 angles");
    in->count[which] = (int)field->count;
    in->angle[which] = ARENA_NEW(arena, double, field->count);
    for (size_t i = 0; i < field->count; i++)
        in->angle[which][i] = degrees_from_radians(tensor_value(field, i));
    const double turn[] = {-360, 360}, quarter[] = {-1e-3, 90 + 1e-3};
    return angles_check(in->file.file, name, in->angle[which], in->count[which],
                        which ? quarter : turn, err);
}

static bool read_bands(Pbsdf *in, Arena *arena, float **nm, Error *err)
{
    const TensorField *field;
    if (!tensor_file_field(&in->file, "wvls", 1, &field, err)) return false;
    if (field->count < 1 || field->count > MEASUREMENT_WAVELENGTHS_MAX)
        return error_at(err, ERROR_INPUT, in->file.file, "wvls", "has %zu wavelengths, "
                        "required: 1 to %d", field->count, MEASUREMENT_WAVELENGTHS_MAX);
    in->channels = (int)field->count;
    *nm = ARENA_NEW(arena, float, field->count);
    for (size_t i = 0; i < field->count; i++) (*nm)[i] = (float)tensor_value(field, i);
    return true;
}

/* Floats; NaN is allowed here. */
static bool find_matrix(Pbsdf *in, Error *err)
{
    const TensorField *m = tensor_file_find(&in->file, "M");
    if (!m) return error_at(err, ERROR_INPUT, in->file.file, "M", "this field is missing");
    bool fits = m->rank == 6 && m->shape[0] == (size_t)in->count[0] &&
                m->shape[1] == (size_t)in->count[1] && m->shape[2] == (size_t)in->count[2] &&
                m->shape[3] == (size_t)in->channels && m->shape[4] == 4 && m->shape[5] == 4;
    if (!fits)
        return error_at(err, ERROR_INPUT, in->file.file, "M", "has the wrong shape, required: "
                        "phi_d x theta_d x theta_h x wvls x 4 x 4");
    in->matrix = m;
    return true;
}

static bool evaluate(const void *data, Direction light, Direction leaving, double *value)
{
    const Pbsdf *in = data;
    HalfAngles   h = half_angles(light, leaving);
    double       phi = h.diff_phi < in->angle[0][0] ? h.diff_phi + 360 : h.diff_phi;
    AngleInterval at[3] = {angle_interval(in->angle[0], in->count[0], phi, 0),
                           angle_interval(in->angle[1], in->count[1], h.diff_theta, 0),
                           angle_interval(in->angle[2], in->count[2], h.half_theta, 0)};
    for (int c = 0; c < in->channels; c++) value[c] = 0;
    for (int corner = 0; corner < 8; corner++) {
        size_t index = 0;
        double weight = 1;
        for (int a = 0; a < 3; a++) {
            bool is_high = corner >> a & 1;
            index = index * (size_t)in->count[a] + (size_t)(is_high ? at[a].high : at[a].low);
            weight *= is_high ? at[a].weight : 1 - at[a].weight;
        }
        for (int c = 0; weight > 0 && c < in->channels; c++)
            value[c] += weight * tensor_value(in->matrix, (index * (size_t)in->channels +
                                                           (size_t)c) * MUELLER);
    }
    for (int c = 0; c < in->channels; c++)
        if (!isfinite(value[c])) return false;
    return true;
}

static bool read_pbsdf(const char *file, const ImportOptions *options, ImportSet *set,
                       Error *err)
{
    Pbsdf  in;
    float *nm = NULL;
    (void)options;
    memset(&in, 0, sizeof in);
    if (!tensor_file_open(file, set->arena, &in.file, err) ||
        !read_angles(&in, 0, "phi_d", set->arena, err) ||
        !read_angles(&in, 1, "theta_d", set->arena, err) ||
        !read_angles(&in, 2, "theta_h", set->arena, err) ||
        !read_bands(&in, set->arena, &nm, err) || !find_matrix(&in, err))
        return false;
    BrdfSource source = {file, evaluate, &in, in.channels, nm, in.angle[2], in.count[2], false};
    if (!brdf_source_add(&source, set, err)) return false;
    import_note(set, "%s: of the Mueller matrix the first element is taken, the BRDF of "
                "unpolarised light", path_name(file));
    return true;
}

static bool is_pbsdf(const char *file, const char *head, size_t head_size)
{
    (void)file;
    return tensor_file_head_has(head, head_size, "theta_d");
}

const Importer importer_pbsdf = {"pbsdf", "KAIST polarimetric BRDF, tensor file (.pbsdf)",
                                 is_pbsdf, read_pbsdf};
