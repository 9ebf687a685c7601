/* SPDX-License-Identifier: Apache-2.0 */
/* units.h -- the canon of units, and the conversions at its borders.
 *
 * Inside the program: metre, radian, nanometre (names end in _nm), spectral radiance in
 * W m^-2 sr^-1 nm^-1, luminance in cd m^-2 (_cd_m2), illuminance in lx (_lx), pdf of a
 * direction in sr^-1, pdf of a point in m^-2 (pdf_area), roughness as GGX alpha.
 * Degrees stand only in files, on the command line and in reports (_deg).
 */
#pragma once

#define PI 3.14159265358979323846
#define PI_F 3.14159265358979323846f
#define INV_PI_F 0.31830988618379067154f

static inline double radians_from_degrees(double degrees) {
    return degrees * (PI / 180.0);
}

static inline double degrees_from_radians(double radians) {
    return radians * (180.0 / PI);
}
