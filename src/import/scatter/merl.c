/* SPDX-License-Identifier: Apache-2.0 */
/* MERL's BRDF database (.binary): Matusik et al., "A Data-Driven Reflectance Model", 2003.
 *
 * Three int32 (90, 90, 180), then red, green and blue as doubles over half and difference
 * angles, theta_h slowest, phi_d fastest: cell i of theta_h begins at 90 (i / 90)^2 degrees, of
 * theta_d at i, of phi_d at i (phi_d and phi_d + 180 are the same by reciprocity). Values are
 * divided by 1500 for red, 1500 / 1.15 for green, 1500 / 1.66 for blue; a negative one was not
 * measured. A direction has the value of the cell that holds it, as in the database's own
 * reader. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "import/scatter/byte_scan.h"
#include "import/scatter/half_angle.h"

#define SIDE_MAX 4096

typedef struct Merl {
    int half_thetas, diff_thetas, diff_phis;
    size_t cells;
    const unsigned char *value; /* 3 x cells doubles */
} Merl;

static bool read_side(ByteScan *scan, int *out, Error *err) {
    uint64_t side;
    if (!byte_scan_uint(scan, 4, &side))
        return byte_scan_fail(scan, err, "the file ends inside its header");
    if (side < 1 || side > SIDE_MAX)
        return byte_scan_fail(scan, err,
                              "a side is %u cells, required: 1 to %d (MERL: 90, 90, "
                              "180)",
                              (unsigned)side, SIDE_MAX);
    *out = (int)side;
    return true;
}

static bool open_merl(const char *file, Arena *arena, Merl *out, Error *err) {
    ByteScan scan;
    if (!byte_scan_open(file, arena, &scan, err) || !read_side(&scan, &out->half_thetas, err) ||
        !read_side(&scan, &out->diff_thetas, err) || !read_side(&scan, &out->diff_phis, err))
        return false;
    out->cells = (size_t)out->half_thetas * (size_t)out->diff_thetas * (size_t)out->diff_phis;
    size_t wanted = RGB_BANDS * out->cells * sizeof(double), left = scan.size - scan.at;
    if (wanted != left)
        return byte_scan_fail(&scan, err,
                              "%zu bytes follow, required: %zu for %d x %d x %d "
                              "cells of three colours",
                              left, wanted, out->half_thetas, out->diff_thetas, out->diff_phis);
    out->value = byte_scan_take(&scan, left);
    for (size_t i = 0; i < RGB_BANDS * out->cells; i++)
        if (!isfinite(double_from_bytes(out->value + i * sizeof(double))))
            return byte_scan_fail(&scan, err, "number %zu is not finite", i + 1);
    return true;
}

static size_t cell_of(double part, int cells) {
    int cell = (int)(part * cells);
    return (size_t)(cell < 0 ? 0 : cell >= cells ? cells - 1 : cell);
}

static bool evaluate(const void *data, Direction light, Direction leaving, double *value) {
    static const double scale[RGB_BANDS] = {1.66 / 1500, 1.15 / 1500, 1.0 / 1500};
    const Merl *in = data;
    HalfAngles h = half_angles(light, leaving);
    double turn = h.diff_phi < 0 ? h.diff_phi + 180 : h.diff_phi;
    size_t at = cell_of(sqrt(h.half_theta / 90), in->half_thetas);
    at = at * (size_t)in->diff_thetas + cell_of(h.diff_theta / 90, in->diff_thetas);
    at = at * (size_t)in->diff_phis + cell_of(turn / 180, in->diff_phis);
    for (size_t c = 0; c < RGB_BANDS; c++) { /* blue first */
        size_t plane = RGB_BANDS - 1 - c;
        value[c] = double_from_bytes(in->value + (plane * in->cells + at) * sizeof(double));
        if (value[c] < 0) return false;
        value[c] *= scale[c];
    }
    return true;
}

static bool read_merl(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    Merl in;
    (void)options;
    if (!open_merl(file, set->arena, &in, err)) return false;
    double *ring = ARENA_NEW(set->arena, double, in.half_thetas); /* the middles of the cells */
    for (int i = 0; i < in.half_thetas; i++) {
        double part = (i + 0.5) / in.half_thetas;
        ring[i] = 90 * part * part;
    }
    BrdfSource source = {file, evaluate,      &in, RGB_BANDS, scatter_rgb_bands(file, set),
                         ring, in.half_thetas};
    return brdf_source_add(&source, set, err);
}

static bool is_merl(const char *file, const char *head, size_t head_size) {
    static const unsigned char sides[12] = {90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0};
    return !strcasecmp(path_ending(file), ".binary") ||
           (head_size >= sizeof sides && !memcmp(head, sides, sizeof sides));
}

const Importer importer_merl = {"merl", "MERL BRDF database (.binary)", is_merl, read_merl};
