/* SPDX-License-Identifier: Apache-2.0 */
/* panel_opened.h -- a panel as queries read it: the file's numbers, expanded. Private to
 * src/panel.
 *
 * Memory   the arena's of panel_open; constant from then on.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "hemisphere/tree/sampling_tree.h"
#include "hemisphere/tree.h"
#include "panel/query/panel.h"
#include "panel/query/panel_file.h"
#include "panel/shape/panel_spline.h"
#include "panel/shape/spot_ground.h"
#include "panel/shape/spectral_warp.h"
#include "panel/zones/dimming_zones.h"
#include "spectrum/spectral_table.h"

#define PANEL_ANGLES 181 /* nodes of tables over theta: 0, 0.5, ... 90 degrees */

/* The emission as numbers: those of the section, and those that queries read instead. */
typedef struct PanelEmission {
    int components, stride; /* stride: components rounded up to four */
    int channels, level_count[3];
    bool has_black;
    float cone_cos, level_power, cosine_power;
    float level[3][PANEL_LEVELS_MAX];
    const float *mean, *loading; /* channels, channels x components */
    PanelSpline spline;
    /* Rows of a source: for code 1 .. 255 the mean of ln X, ln Y, ln Z (and a padding number),
     * then so many for every component. Row 0 is the change with ln code below code 1. */
    const float *code_rows[3];
    const float *black_rows; /* one row */
    float log_code[256];
    float mean_y[3][256]; /* panel_mean_luminance at whole codes */
    float black_mean_y;
} PanelEmission;

/* Red, green, blue, black. Spectra every nm from SPECTRAL_FIRST_NM, of 1 cd m^-2. */
typedef struct PanelPrimaries {
    float spectrum[4][SPECTRAL_COUNT];
    SpectralWarp warp[4];
} PanelPrimaries;

/* Numbers behind the loadings that queries may load and do not use. */
#define PANEL_COEFFICIENTS_BEHIND 12

/* An incidence that interpolation counts on. Those below 0 are measured ones seen from the
 * other side of the normal: the light's azimuth and the stored direction turned by 180 deg. */
typedef struct PanelIncidence {
    float theta;
    int incidence;
    bool is_turned;
} PanelIncidence;

/* Of an interval between incidences: which ones count, and which of the cubic's weights is
 * theirs. Those that are not turned come first; one that is
 * missing has a weight of 0. */
#define PANEL_NEIGHBOURS 4
typedef struct PanelNeighbours {
    int straight; /* so many of them are read at the stored direction */
    int incidence[PANEL_NEIGHBOURS], of[PANEL_NEIGHBOURS];
    bool is_turned[PANEL_NEIGHBOURS];
} PanelNeighbours;

/* The stored form, expanded for queries. Rows over wavelengths have padded_wavelengths floats,
 * rows over coefficients padded_coefficients; what is padded is 0. */
typedef struct PanelReflection {
    uint32_t incidences, azimuths, tables, components, coefficients, padded_coefficients;
    uint32_t wavelengths, padded_wavelengths, nodes, steps;
    bool has_mirror;
    bool is_grey; /* all wavelengths have the same numbers */
    float frame_exponent, refractive_index, cone_cos, cone_theta;
    float last_theta;                                     /* the last measured incidence, radians */
    float last_sine, last_cosine, last_fresnel;           /* of last_theta */
    PanelIncidence step[PANEL_INCIDENCES_MAX + 2];        /* rising in theta */
    float step_cubic[PANEL_INCIDENCES_MAX + 2][4][4];     /* [step][power of u][neighbour] */
    PanelNeighbours neighbours[PANEL_INCIDENCES_MAX + 2]; /* of each step */
    float azimuth[PANEL_AZIMUTHS_MAX];
    float wavelength_nm[PANEL_WAVELENGTHS_MAX];
    float node_theta[PANEL_NODES_MAX];
    float haze_albedo[PANEL_ANGLES]; /* luminous */
    const float *mean;               /* [tables][wavelengths] */
    const float *basis;              /* [coefficients][wavelengths] */
    const float *loading;        /* [tables][components][coefficients], more behind the last one */
    const float *lambertian;     /* [tables][wavelengths], sr^-1; */
    const float *lambertian_log; /* and its logarithm, for what lies between tables */
    const float *held;           /* [nodes][wavelengths] */
    const float *mirror;         /* [PANEL_ANGLES][wavelengths] */
    const PanelReachStored *reach; /* [tables]; NULL: cone_theta is every table's */
} PanelReflection;

/* How wi is chosen for a wo: function azimuth * incidences + incidence of one sampling tree in
 * the specular-following frame of wo's polar angle theta, with an exponent of its own. */
#define PANEL_SAMPLING_EXPONENT 2.0f
typedef struct PanelSampling {
    SamplingTree tree;
    int incidences;     /* 0: nothing is reflected */
    int azimuths;       /* of wo, evenly over the turn from 0; 1: isotropic */
    const float *theta; /* radians, rising */
} PanelSampling;

/* The uniformity map as it stands in the file. */
typedef struct PanelMap {
    int width, height;
    const uint16_t *value[2][3]; /* white, black; X, Y, Z: may be the same */
    float scale[2][3];
    bool has_black;
} PanelMap;

/* A panel that varies by place (PANEL_SPOTS, PANEL_MAP). */
typedef struct PanelPlaces {
    int panels; /* [0] is the file's own */
    const Panel **panel;
    const float (*measured_at)[2]; /* of each panel */
    int spots;                     /* 0: panel 0 is everywhere */
    SpotGround ground;
    const uint16_t *emission, *reflection; /* panel of each spot */
    const PanelMap *map;                   /* NULL: none */
    /* For each panel, the map's values where it was measured, and its black over its white
     * along the normal; X, Y, Z. */
    const float (*white)[3], (*black)[3], (*dark)[3];
} PanelPlaces;

struct Panel {
    Arena copy;            /* of the file; empty where the bytes belong to somebody else */
    size_t size, own_size; /* of the file; without its spots and map */
    const void *meta;
    size_t meta_size;
    const PanelEmission *emission; /* NULL: emits nothing */
    Tree emission_tree;
    const PanelPrimaries *primaries;   /* with emission */
    PanelPolarisation polarisation;    /* of the emission */
    const DimmingZones *zones;         /* NULL: the backlight is one, always full */
    const PanelReflection *reflection; /* NULL: reflects nothing */
    Tree reflection_tree;
    PanelSampling sampling;
    const PanelPlaces *places;                     /* NULL: the same everywhere */
    int16_t wavelength_index[SPECTRAL_COUNT];      /* interval that begins at or below a nm */
    float wavelength_scale[PANEL_WAVELENGTHS_MAX]; /* 1 / interval's width */
};

/* Number of levels' channels before primary p; p = 3: the black pattern's first channel. */
static inline uint32_t panel_first_channel(const PanelEmission *emission, int p) {
    uint32_t channel = 0;
    for (int i = 0; i < p; i++) channel += 3 * (uint32_t)emission->level_count[i];
    return channel;
}
