/* SPDX-License-Identifier: Apache-2.0 */
/* air.h -- the cloudless air: how its scatterers lie over altitude, and what they do to light.
 *
 * Three constituents: air molecules (Rayleigh scattering; SPECTRL2's optical depth), aerosol
 * (Angstrom's law, SPECTRL2's single-scattering albedo, Henyey and Greenstein's phase function
 * with SPECTRL2's asymmetry 0.65) and ozone (absorption only).
 *
 * Shapes    lanes of a Spectrum are AIR_NM[0..15]; columns are shares of the vertical column
 *           from sea level to space, so that optical depth = depth * column.
 * Units     metres, radians, nm; density in m^-1 (its integral from sea level is 1).
 * Sources   density: ISO 2533 standard atmosphere, isothermal above 84.9 km (the U.S. Standard
 *           Atmosphere 1976 has 1.4 times that at 100 km); ozone: a tent from 10 to 40 km;
 *           aerosol: an exponential of 1.5 km scale height and a thin stratospheric layer at
 *           20 km.
 * Threads   pure functions of constants.
 */
#pragma once
#include "sky/air/spectrl2.h"
#include "spectrum/spectrum.h"

#define AIR_TOP_M 70000.0          /* where a daylit sky may end */
#define AIR_HIGHEST_TOP_M 120000.0 /* seen while the sun is far below the horizon */
#define AIR_EARTH_M 6371000.0
#define AIR_ASYMMETRY 0.65f

extern const float AIR_NM[SPECTRUM_LANES];

typedef enum AirPart { AIR_MOLECULES, AIR_AEROSOL, AIR_OZONE, AIR_PARTS } AirPart;

typedef struct AirOptics {
    Spectrum depth[AIR_PARTS];      /* vertical optical depth from sea level */
    Spectrum scattering[AIR_PARTS]; /* of that, by scattering */
    double aerosol_low;             /* share of the aerosol that lies in the boundary layer */
    double top_m;                   /* there is no air above */
} AirOptics;

/* air->pressure_mbar: at sea level. The top is AIR_TOP_M; a caller may set another, at most
 * AIR_HIGHEST_TOP_M. */
AirOptics air_optics(const Air *air);

/* Density of a part at an altitude, m^-1. */
double air_density(const AirOptics *optics, AirPart part, double altitude_m);

/* Columns of all parts between two altitudes, straight up. */
void air_vertical(const AirOptics *optics, double from_m, double to_m, double column[AIR_PARTS]);

/* Columns from an altitude to space along a ray whose angle to the zenith has this cosine; no
 * refraction. False: the ray meets the sphere of altitude floor_m. */
bool air_column(const AirOptics *optics, double altitude_m, double cosine, double floor_m,
                double column[AIR_PARTS]);

/* The air over an altitude in spherical shells, fine at the low end, and the vertical column of
 * each: what rays from one place share. Over the top there are none. */
#define AIR_SHELLS_MAX 48

typedef struct AirShell {
    double low_m, high_m, column[AIR_PARTS];
} AirShell;

typedef struct AirShells {
    double from_m;
    int count;
    AirShell shell[AIR_SHELLS_MAX];
} AirShells;

AirShells air_shells(const AirOptics *optics, double from_m);

/* air_column for rays from where `over` begins. */
bool air_column_over(const AirOptics *optics, const AirShells *over, double cosine, double floor_m,
                     double column[AIR_PARTS]);

/* Phase functions, sr^-1, of the angle's cosine. */
float air_phase_molecules(float cosine);
float air_phase_aerosol(float cosine);
