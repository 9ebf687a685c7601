/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/photometry.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"

SpectralRow spectral_row(double nm) {
    SpectralRow row = {0};
    if (!(nm >= SPECTRAL_FIRST_NM && nm <= SPECTRAL_LAST_NM)) return row;
    int cell = (int)nm - SPECTRAL_FIRST_NM;
    if (cell == SPECTRAL_COUNT - 1) cell--;
    float t = (float)(nm - SPECTRAL_FIRST_NM - cell);
    float low[8], high[8], mixed[8];
    memcpy(low, &spectral_table[cell], sizeof low);
    memcpy(high, &spectral_table[cell + 1], sizeof high);
    for (int i = 0; i < 8; i++) mixed[i] = low[i] + (high[i] - low[i]) * t;
    memcpy(&row, mixed, sizeof row);
    return row;
}

/* Adds weight * radiance * observer(nm). */
static void add_point(double xyz[3], double nm, double radiance, double weight) {
    SpectralRow row = spectral_row(nm);
    xyz[0] += weight * radiance * (double)row.x;
    xyz[1] += weight * radiance * (double)row.y;
    xyz[2] += weight * radiance * (double)row.z;
}

/* Simpson's rule over cells of at most 1 nm: exact for a product of two linear functions, which
 * radiance times observer is within a cell that no whole nanometre and no sample divides. */
void xyz_from_radiance(const float *radiance, int count, double first_nm, double step_nm,
                       double xyz_cd_m2[3]) {
    double xyz[3] = {0, 0, 0};
    int cells = (int)ceil(step_nm - 1e-9);
    double width = step_nm / cells;
    for (int i = 0; i + 1 < count; i++)
        for (int k = 0; k < cells; k++) {
            double nm = first_nm + i * step_nm + k * width;
            double slope = ((double)radiance[i + 1] - (double)radiance[i]) / cells;
            double value = (double)radiance[i] + k * slope;
            add_point(xyz, nm, value, width / 6);
            add_point(xyz, nm + width / 2, value + slope / 2, width * 4 / 6);
            add_point(xyz, nm + width, value + slope, width / 6);
        }
    for (int c = 0; c < 3; c++) xyz_cd_m2[c] = LUMINOUS_EFFICACY_MAX * xyz[c];
}

double luminance_cd_m2(const float *radiance, int count, double first_nm, double step_nm) {
    double xyz[3];
    xyz_from_radiance(radiance, count, first_nm, step_nm, xyz);
    return xyz[1];
}

/* L = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1) per metre of wavelength; the constants
 * are the SI's exact ones. */
double black_body_radiance(double nm, double kelvin) {
    const double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    double metres = nm * 1e-9;
    double per_metre = 2 * h * c * c / pow_d(metres, 5) / expm1_d(h * c / (metres * k * kelvin));
    return per_metre * 1e-9;
}

static void multiply(const float matrix[9], const float in[3], float out[3]) {
    float a = in[0], b = in[1], c = in[2];
    for (int i = 0; i < 3; i++)
        out[i] = matrix[3 * i] * a + matrix[3 * i + 1] * b + matrix[3 * i + 2] * c;
}

void rgb_from_xyz(const float xyz[3], float rgb[3]) {
    multiply(rgb_from_xyz_matrix, xyz, rgb);
}

void xyz_from_rgb(const float rgb[3], float xyz[3]) {
    multiply(xyz_from_rgb_matrix, rgb, xyz);
}

float luminance_from_rgb(const float rgb[3]) {
    const float *y = xyz_from_rgb_matrix + 3;
    return y[0] * rgb[0] + y[1] * rgb[1] + y[2] * rgb[2];
}

void xy_from_xyz(const float xyz[3], float xy[2]) {
    const float *from = xyz[0] + xyz[1] + xyz[2] > 0 ? xyz : d65_white_xyz;
    float sum = from[0] + from[1] + from[2];
    xy[0] = from[0] / sum;
    xy[1] = from[1] / sum;
}

void uv_from_xyz(const double xyz[3], double uv[2]) {
    double d = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    uv[0] = d > 0 ? 4 * xyz[0] / d : NAN;
    uv[1] = d > 0 ? 9 * xyz[1] / d : NAN;
}
