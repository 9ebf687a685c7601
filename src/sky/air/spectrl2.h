/* SPDX-License-Identifier: Apache-2.0 */
/* spectrl2.h -- the clear sky's direct and diffuse spectra on the ground (SPECTRL2).
 *
 * Source    Bird and Riordan, "Simple Solar Spectral Model for Direct and Diffuse Irradiance on
 *           Horizontal and Tilted Planes at the Earth's Surface for Cloudless Atmospheres",
 *           SERI/TR-215-2436 (1984), with the constants of NREL's program of that name
 *           (Rayleigh 1.3366, mixed gases 118.3); relative air mass of Kasten and Young (1989).
 * Units     irradiance in W m^-2 nm^-1 at 122 wavelengths, 300 to 4000 nm.
 * Threads   pure functions. Fails: never; the sun at or below the horizon gives zeros.
 */
#pragma once

#define SPECTRL2_COUNT 122

/* The air above a place, and the ground's albedo. */
typedef struct Air {
    double pressure_mbar;
    double water_cm; /* precipitable */
    double ozone_atm_cm;
    double aerosol_depth; /* optical depth at 500 nm */
    double aerosol_power; /* Angstrom's exponent, 1.14 rural */
    double ground_albedo;
} Air;

/* Relative optical air mass for an apparent zenith angle below 90 degrees. */
double air_mass(double apparent_zenith_deg);

/* Aerosol optical depth at 500 nm for Preetham's turbidity (1999, Linke's T of his fit). */
double aerosol_depth_from_turbidity(double turbidity);

typedef struct Spectrl2 {
    double direct[SPECTRL2_COUNT];  /* on a plane that faces the sun */
    double diffuse[SPECTRL2_COUNT]; /* horizontal */
    double outside[SPECTRL2_COUNT]; /* above the atmosphere */
} Spectrl2;

/* distance_factor: 1 / R^2, R in au. */
Spectrl2 spectrl2(const Air *air, double apparent_zenith_deg, double distance_factor);

/* Transmittance of water vapour and of the mixed gases (oxygen) alone. */
void spectrl2_gases(const Air *air, double apparent_zenith_deg, double passing[SPECTRL2_COUNT]);

/* W m^-2 of a row of spectral values, 300 to 4000 nm, trapezoids. */
double spectrl2_total(const double *value);

/* nm of row i. */
double spectrl2_nm(int i);

/* A row of numbers at the 122 wavelengths, read linearly between them. */
double spectrl2_read(const double *value, double nm);
