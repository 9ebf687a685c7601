/* SPDX-License-Identifier: Apache-2.0 */
/* photometry.h -- from spectral radiance to what a person sees, and between colour spaces.
 *
 * Units    spectral radiance in W m^-2 sr^-1 nm^-1; XYZ in cd m^-2 (or any one unit).
 *          CIE 1931 2 degree observer, 360..830 nm, K_m = 683.002 lm/W; linear Rec.709 has
 *          the primaries of ITU-R BT.709 and this observer's D65 as white, so RGB (1,1,1) of
 *          spectrum_from_rgb_emission is exactly D65 with Y = 1.
 * Threads  pure functions.
 */
#pragma once
#include "spectrum/spectral_table.h"

/* Stefan-Boltzmann constant, W m^-2 K^-4 (exact in the SI of 2019). */
#define STEFAN_BOLTZMANN 5.670374419e-8

/* Observer, D65 and illuminant A (each of 1 cd m^-2), RGB reflectances at any wavelength:
 * linear between whole nanometres. Outside 360..830 nm everything is zero. */
SpectralRow spectral_row(double nm);

/* XYZ in cd m^-2 of a spectrum given as `count` values at first_nm, first_nm + step_nm, ...,
 * linear between them and nothing outside them. Exact where first_nm is a whole number and
 * step_nm a whole number or the inverse of one; else within 1e-5 for smooth spectra. */
void xyz_from_radiance(const float *radiance, int count, double first_nm, double step_nm,
                       double xyz_cd_m2[3]);

/* The Y of xyz_from_radiance. */
double luminance_cd_m2(const float *radiance, int count, double first_nm, double step_nm);

/* Planck's law, W m^-2 sr^-1 nm^-1; nm > 0, kelvin > 0. Not for the hot path. */
double black_body_radiance(double nm, double kelvin);

/* Colours outside Rec.709's triangle get negative components. */
void rgb_from_xyz(const float xyz[3], float rgb[3]);
void xyz_from_rgb(const float rgb[3], float xyz[3]);

/* Luminance of linear Rec.709 (0.2127, 0.7152, 0.0722: Y of the primaries under our D65). */
float luminance_from_rgb(const float rgb[3]);

/* Chromaticity (x, y). Black has the chromaticity of D65. */
void xy_from_xyz(const float xyz[3], float xy[2]);

/* Chromaticity (u', v') of CIE 1976; NaN of no light. */
void uv_from_xyz(const double xyz[3], double uv[2]);
