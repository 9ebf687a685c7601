/* SPDX-License-Identifier: Apache-2.0 */
/* panel_file.h -- the layout of X.panel (assets/guides/panel-format.md). Private to src/panel.
 *
 * Little-endian. A header, a table of contents, then the sections, each at a multiple of 8
 * bytes; no pointers, so that a file is queried as it was read. The checksum (XXH3, 64 bits)
 * covers everything behind itself. The version changes whenever a struct below does.
 */
#pragma once
#include <stddef.h>
#include <stdint.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are queried in place");

#define PANEL_MAGIC "PHPANEL\n"
#define PANEL_VERSION 7u
#define PANEL_ALIGN 8 /* of sections, bytes */
#define PANEL_SECTIONS_MAX 64
#define PANEL_LEVELS_MAX 64
#define PANEL_SLICES_MAX 40
#define PANEL_WAVELENGTHS_MAX 256
#define PANEL_COMPONENTS_MAX 64   /* of the emission tree */
#define PANEL_COEFFICIENTS_MAX 32 /* spectral, per slice */

typedef struct PanelHeader {
    char magic[8];                    /* PANEL_MAGIC, without its zero */
    uint32_t version, flags;          /* flags: 0 */
    uint64_t checksum;                /* of the bytes from size on */
    uint64_t size;                    /* of the file */
    uint32_t section_count, reserved; /* reserved: 0 */
} PanelHeader;

typedef enum PanelSectionKind {
    PANEL_META = 1,     /* panel_report.h: names, source, what was chosen, notes, errors */
    PANEL_EMISSION = 2, /* PanelEmissionHead and what follows it */
    PANEL_EMISSION_TREE = 3,
    PANEL_PRIMARIES = 4,  /* PanelPrimariesHead, spectra */
    PANEL_REFLECTION = 5, /* PanelReflectionStored and what follows it */
    PANEL_REFLECTION_TREE = 6,
    PANEL_SAMPLING = 7,   /* a sampling tree, PanelSampling's counts and thetas */
    PANEL_POLARISED = 10, /* PanelPolarisedStored: of the emission; absent: unpolarised */
    PANEL_SPOTS = 11,     /* PanelSpotsHead and what follows it; absent: one everywhere */
    PANEL_SPOT_FILE = 12, /* index 1 on: a panel file of its own, of one spot */
    PANEL_MAP = 13,       /* PanelMapHead and what follows it */
    PANEL_REACH = 15,     /* PanelReachStored[tables]; absent: the cone of all tables */
    PANEL_ZONES = 16      /* PanelZonesStored and what follows it; absent: one backlight,
                             always full */
} PanelSectionKind;

typedef struct PanelSection {
    uint16_t kind, index;
    uint32_t size;
    uint64_t offset;
} PanelSection;

/* Natural logarithms of tristimulus values in cd m^-2. A channel is one of X, Y, Z of one
 * table: red's levels rising, then green's, blue's, then (if any) the black pattern's. At a
 * direction, ln E[channel] = mean[channel] + cosine_power ln cos theta + sum over components of
 * loading[channel][component] * (spline + tree's component). E is what a level adds
 * to the black pattern, or the black pattern itself.
 *
 * Section   PanelEmissionHead | uint16 level[tables without black], 1/256 of a code | int16
 *           mean[channels], 2^-PANEL_MEAN_BITS | uint8 exponent[components], the step of
 *           loadings is 2^-exponent | uint8 width[components], 1 or 2 bytes | loadings,
 *           component by component, [channels] of that width, all 2-byte ones first | the
 *           spline as panel_spline.h has it. */
typedef struct PanelEmissionHead {
    uint8_t components, has_black, level_count[3], reserved[3];
    float cone_cos;    /* cos of the last measured theta */
    float level_power; /* exponent of the level curve where only one level is known */
    float cosine_power;
} PanelEmissionHead;
#define PANEL_MEAN_BITS 11
#define PANEL_LEVEL_UNIT 256.0f

/* The section of the primaries: this head, then uint16 value[3][count] of red, green, blue at
 * even wavelengths, multiples of scale; linear between them, 0 outside. */
typedef struct PanelPrimariesHead {
    float first_nm, step_nm;
    uint16_t count, kind; /* kind: PanelSpectraKind; count 0 when nothing is stored */
    float scale[3];
} PanelPrimariesHead;
#define PANEL_SPECTRUM_MAX 1024

/* A panel's reflection. A table is the haze measured with the light at one azimuth and one
 * incidence; table = azimuth * incidences + incidence. In the specular-following frame
 *     ln (f / F(theta_i)) at wavelength w = mean[table][w] + sum over k of basis[k][w] *
 *         sum over c of loading[table][k][c] * (the tree's component c),
 * F the unpolarised Fresnel reflectance.
 * 16-bit numbers are multiples of the scale that stands beside them. */
typedef struct PanelReflectionStored {
    uint16_t incidences, azimuths;     /* azimuths 1: isotropic, symmetric in y */
    uint16_t components, coefficients; /* of the tree; of spectra */
    uint16_t wavelengths;
    uint16_t nodes;                       /* incidences from the last measured one to 90 degrees */
    uint8_t one, has_mirror, reserved[2]; /* one: 1; reserved: 0 */
    float frame_exponent, refractive_index;
    float cone_cos;           /* of the leaving directions */
    float mean_scale, unused; /* unused: 0 */
    /* then, float: incidence[incidences], azimuth[azimuths], wavelength_nm[wavelengths],
     *   node_theta[nodes], basis_scale[coefficients], loading_scale[components];
     * then, 16 bits: mean[tables][wavelengths], lambertian[tables][wavelengths] (ln,
     *   mean_scale), basis[coefficients][wavelengths],
     *   loading[tables][coefficients][components],
     *   and of 1/65535: albedo[tables][wavelengths] of the haze,
     *   mirror[incidences][wavelengths] (with a mirror only), held[nodes][wavelengths], by
     *   what the haze beyond the measured incidences is multiplied, and
     *   node_albedo[nodes][wavelengths] */
} PanelReflectionStored;

/* PANEL_REACH: which directions a table's samples surround (panel_reach.h); it is there where
 * some table's do not surround the cone. */
#define PANEL_REACH_SIDES 36
typedef struct PanelReachStored {
    uint16_t theta, phi;             /* of the centre, 1/65535 of 90 and 1/65536 of 360 degrees */
    uint16_t most;                   /* the edge's largest angle, 1/65535 of 180 degrees */
    uint8_t side[PANEL_REACH_SIDES]; /* its angle, 1/255 of the largest */
} PanelReachStored;

/* PANEL_POLARISED: the linearly polarised share of the emitted light, above 0 to 1, and the
 * direction in which it swings, radians, [0, pi): 0 right, pi/2 up as someone facing the
 * display sees it. Readers that know nothing of it take the light as unpolarised. */
typedef struct PanelPolarisedStored {
    float degree, azimuth;
} PanelPolarisedStored;

/* PANEL_ZONES: local dimming (panel/zones/dimming_zones.h says what the numbers mean).
 *
 * Section   PanelZonesStored | float radius_mm, value [spread_rows] | float code, drive
 *           [drive_rows]; pairs. */
typedef struct PanelZonesStored {
    uint16_t version; /* PANEL_ZONES_VERSION */
    uint16_t columns, rows;
    uint8_t rule;                    /* 0 maximum, 1 mean */
    uint8_t compensates;             /* 0 or 1 */
    uint8_t spread_rows, drive_rows; /* 0, or 2 to 64 */
    uint8_t reserved[2];             /* 0 */
    float size_mm[2];
    float sigma_mm; /* 0: the table says the spread */
    float least;
} PanelZonesStored;
#define PANEL_ZONES_VERSION 1u

/* A display that is not the same everywhere. Panel 0 is what the file holds itself, panel k the
 * file in section PANEL_SPOT_FILE of index k; spots state which of them was measured there, and
 * between spots the panels have the weights of spot_ground.h. Places are of the active area,
 * as there.
 *
 * Section   PanelSpotsHead | PanelSpotStored[spots]. Without spots the file's own panel is
 *           everywhere, and PANEL_MAP is there. */
typedef struct PanelSpotsHead {
    uint16_t spots, panels; /* panels: besides the file's own */
    float own_at[2];        /* where the file's own was measured */
} PanelSpotsHead;

typedef struct PanelSpotStored {
    float at[2];
    uint16_t emission, reflection; /* panel */
} PanelSpotStored;

/* Relative XYZ of the white and of the black pattern over the active area.
 *
 * Section   PanelMapHead | for each channel of white, then of black, uint16
 *           value[height][width], times its scale; the first row at the top. One channel: X, Y
 *           and Z alike. No channel of black: as white. */
typedef struct PanelMapHead {
    uint16_t width, height;
    uint8_t white_channels, black_channels, reserved[2]; /* 1 or 3; 0, 1 or 3; 0 */
    float scale[6]; /* of white's channels, then black's; behind them 0 */
} PanelMapHead;
#define PANEL_MAP_SIDE_MAX 8192
#define PANEL_MAP_LEAST_SCALE 1e-20f

#define PANEL_TABLES_MAX 1152 /* incidences times azimuths */
#define PANEL_AZIMUTHS_MAX 72
#define PANEL_REFLECTION_COMPONENTS_MAX 32
#define PANEL_NODES_MAX 16
#define PANEL_INCIDENCES_MAX 32

/* PANEL_SAMPLING: a sampling tree, at the next multiple of four bytes uint16 incidences and
 * azimuths, then float theta[incidences]. */
static inline size_t panel_sampling_tree_bytes(size_t tree) {
    return (tree + 3) / 4 * 4;
}
