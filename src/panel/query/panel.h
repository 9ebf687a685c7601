/* panel.h -- a measured display: what it emits and reflects at any angle.
 *
 * Frame    the display's own: +z its normal, +x the viewer's right (phi 0), +y up (phi 90).
 *          Directions are unit vectors that leave the display.
 * Units    emission in CIE XYZ, Y in cd m^-2, or spectral radiance in W m^-2 sr^-1 nm^-1;
 *          reflection in sr^-1, the cosine not included.
 * Memory   the file is read once and queried as it stands; panel_close gives the copy back. A
 *          file that changes, shrinks or goes away afterwards makes no difference.
 * Threads  a Panel is const after panel_open: any number of threads may query it.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/vec.h"
#include "spectrum/wavelengths.h"

typedef struct Panel Panel; /* opaque: the file's layout is private to src/panel */

/* Opens and checks a .panel file (version, checksum, every offset). */
bool panel_open(const char *path, Arena *arena, Panel **out, Error *err);

#define PANEL_FILE_BYTES_MAX ((size_t)256 << 20)

/* The same for a file in memory, aligned to 8 bytes, which stays the caller's and must outlive
 * the panel. name: of the file, for messages. */
bool panel_open_memory(const void *data, size_t size, const char *name, Arena *arena,
                       Panel **out, Error *err);
void panel_close(Panel *panel); /* NULL is fine */

/* ---- emission ------------------------------------------------------------------------ */

/* XYZ in cd m^-2 that the panel sends along `direction` when a pixel's codes are rgb, each in
 * 0..255 (fractions are 16-bit codes scaled). M_black + E_R(r) + E_G(g) + E_B(b); never
 * negative. Below the surface (direction.z <= 0): zero.
 * Returns true where the value is measured, false where it is extrapolated beyond the cone. */
bool panel_emission_xyz(const Panel *panel, Vec3 direction, const float rgb[3], float xyz[3]);

/* The same as a spectral radiance, W m^-2 sr^-1 nm^-1: the primaries' measured spectra bent so
 * that their tristimulus values are the measured ones (design: panel, section 7). */
Spectrum panel_emission_spectrum(const Panel *panel, Vec3 direction, const float rgb[3],
                                 const Wavelengths *wavelengths);

/* Luminance in cd m^-2 averaged over the hemisphere with the cosine (luminous exitance / pi),
 * for codes rgb: what light sampling needs to weigh displays against other lights. */
float panel_mean_luminance(const Panel *panel, const float rgb[3]);

/* ---- reflection ---------------------------------------------------------------------- */

/* Has reflection data? Without them a panel reflects nothing. */
bool panel_reflects(const Panel *panel);

/* BRDF without the mirror part, sr^-1 per lane. wo: to the eye, wi: to the light. 0 when
 * either is below the surface. */
Spectrum panel_brdf(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths);

/* Whether panel_brdf rests on measured values there: the incidence no steeper than the last one
 * measured, the leaving direction inside the instrument's cone. Else it is extrapolated. */
bool panel_brdf_is_measured(const Panel *panel, Vec3 wo, Vec3 wi);

/* Mirror reflectance (delta part), per lane, for a direction at cos_theta to the normal. */
Spectrum panel_mirror(const Panel *panel, float cos_theta, const Wavelengths *wavelengths);

/* Density, sr^-1, with which panel_sample chooses wi for this wo (the haze and floor parts;
 * the discrete mirror lobe is the caller's). Integrates to one over the hemisphere. */
float panel_pdf(const Panel *panel, Vec3 wo, Vec3 wi);

/* Chooses wi for wo; u in [0,1)^3. *pdf is what panel_pdf says of wi, to rounding. False: no
 * direction (wo below the surface, no data). */
bool panel_sample(const Panel *panel, Vec3 wo, const float u[3], Vec3 *wi, float *pdf);

/* Directional-hemispherical reflectance without the mirror part, mean over the lanes'
 * luminous weight: the probability of haze against mirror. */
float panel_haze_albedo(const Panel *panel, float cos_theta);
