/* SPDX-License-Identifier: Apache-2.0 */
/* spectral_table.h -- what is known of every whole nanometre from 360 to 830.
 *
 * Everything here is linear between whole nanometres. Made from the published CIE tables by
 * assets/spectra/make_spectral_table.py, which also solves for the RGB reflectances.
 * Threads  constant data.
 */
#pragma once

#define SPECTRAL_FIRST_NM 360
#define SPECTRAL_LAST_NM 830
#define SPECTRAL_COUNT (SPECTRAL_LAST_NM - SPECTRAL_FIRST_NM + 1)

/* Peak photopic luminous efficacy, lm W^-1, at about 555 nm (CIE). */
#define LUMINOUS_EFFICACY_MAX 683.002

typedef struct SpectralRow {
    float x, y, z;           /* CIE 1931 2 degree observer */
    float red, green, blue;  /* reflectances of the linear Rec.709 primaries; sum 1 */
    float d65, illuminant_a; /* W m^-2 sr^-1 nm^-1 of a source of 1 cd m^-2 */
} SpectralRow;

extern const SpectralRow spectral_table[SPECTRAL_COUNT];

/* Share of sampled wavelengths below 360 nm + i, in units of 2^-24: from 0 to 2^24, whole. */
extern const float wavelength_steps[SPECTRAL_COUNT];

/* The nanometre (from 360) in which the share reaches i / WAVELENGTH_GUIDES. */
#define WAVELENGTH_GUIDES 512
extern const short wavelength_guide[WAVELENGTH_GUIDES];

/* Tristimulus values of D65 with Y = 1, as this table's observer sees it. */
extern const float d65_white_xyz[3];

/* Linear Rec.709 (ITU-R BT.709 primaries, the white above), row by row. */
extern const float rgb_from_xyz_matrix[9];
extern const float xyz_from_rgb_matrix[9];
