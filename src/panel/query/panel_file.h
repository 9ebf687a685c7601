/* panel_file.h -- the layout of X.panel and of an opened Panel. Private to src/panel.
 *
 * Little-endian. A header, a table of contents, then the sections, each at a multiple of 8
 * bytes; no pointers, so that a file is queried as it was read. The checksum (XXH3, 64 bits)
 * covers everything behind itself. The version changes whenever a struct below does.
 */
#pragma once
#include <stdint.h>

#include "base/mathf.h"
#include "hemisphere/sampling_tree.h"
#include "hemisphere/tree.h"
#include "panel/query/panel.h"
#include "panel/query/panel_beam.h"
#include "panel/query/panel_spline.h"
#include "spectrum/spectral_table.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are queried in place");

#define PANEL_MAGIC "PHPANEL\n"
#define PANEL_VERSION 3u
#define PANEL_ALIGN 8 /* of sections, bytes */
#define PANEL_SECTIONS_MAX 64
#define PANEL_LEVELS_MAX 64
#define PANEL_SLICES_MAX 40
#define PANEL_WAVELENGTHS_MAX 256
#define PANEL_COMPONENTS_MAX 64  /* of the emission tree */
#define PANEL_COEFFICIENTS_MAX 32 /* spectral, per slice */
#define PANEL_ANGLES 181 /* nodes of tables over theta: 0, 0.5, ... 90 degrees */
#define PANEL_BEND_SIDE 17

typedef struct PanelHeader {
    char     magic[8]; /* PANEL_MAGIC, without its zero */
    uint32_t version, flags; /* flags: 0 */
    uint64_t checksum;       /* of the bytes from size on */
    uint64_t size;           /* of the file */
    uint32_t section_count, reserved; /* reserved: 0 */
} PanelHeader;

typedef enum PanelSectionKind {
    PANEL_META = 1,            /* JSON text: names, source, what was chosen, notes */
    PANEL_EMISSION = 2,        /* PanelEmissionHead and what follows it */
    PANEL_EMISSION_TREE = 3,
    PANEL_PRIMARIES = 4,       /* PanelPrimariesHead, spectra */
    PANEL_REFLECTION = 5,      /* PanelReflectionStored and what follows it */
    PANEL_REFLECTION_TREE = 6,
    PANEL_SAMPLING = 7,          /* a sampling tree, PanelSampling's counts and thetas */
    PANEL_FIGURES = 8          /* panel_report.h: the tables of the report, then the total */
} PanelSectionKind;

typedef struct PanelSection {
    uint16_t kind, index;
    uint32_t size;
    uint64_t offset;
} PanelSection;

/* Natural logarithms of tristimulus values in cd m^-2. A channel is one of X, Y, Z of one
 * table: red's levels rising, then green's, blue's, then (if any) the black pattern's. At a
 * direction, ln E[channel] = mean[channel] + cosine_power ln cos theta + sum over components of
 * loading[channel][component] * (spline + tree's + beams' component). E is what a level adds
 * to the black pattern, or the black pattern itself.
 *
 * Section   PanelEmissionHead | uint16 level[tables without black], 1/256 of a code | int16
 *           mean[channels], 2^-PANEL_MEAN_BITS | uint8 exponent[components], the step of
 *           loadings is 2^-exponent | uint8 width[components], 1 or 2 bytes | loadings,
 *           component by component, [channels] of that width, all 2-byte ones first | the
 *           spline as panel_spline.h has it | the beams as panel_beam.h has them. Readers that
 *           know of no beams refuse a section that goes on behind its spline. */
typedef struct PanelEmissionHead {
    uint8_t components, has_black, level_count[3], beams, reserved[2];
    float   cone_cos;    /* cos of the last measured theta */
    float   level_power; /* exponent of the level curve where only one level is known */
    float   cosine_power;
} PanelEmissionHead;
#define PANEL_MEAN_BITS 11
#define PANEL_LEVEL_UNIT 256.0f

/* The emission as numbers: what the section says, and what queries read instead. */
typedef struct PanelEmission {
    int    components, stride; /* stride: components rounded up to four */
    int    channels, level_count[3];
    bool   has_black;
    float  cone_cos, level_power, cosine_power;
    float  level[3][PANEL_LEVELS_MAX];
    const float *mean, *loading; /* channels, channels x components */
    PanelSpline  spline;
    int          beams;
    PanelBeam    beam[PANEL_BEAMS_MAX];
    /* Rows of a source: for code 1 .. 255 the mean of ln X, ln Y, ln Z (and a padding number),
     * then so many for every component. Row 0 is the change with ln code below code 1. */
    const float *code_rows[3];
    const float *black_rows; /* one row */
    float        log_code[256];
    float        mean_y[3][256]; /* panel_mean_luminance at whole codes */
    float        black_mean_y;
} PanelEmission;

/* How the levels of a channel make a code's logarithm: fixed weights over at most four levels,
 * of cubic Hermite pieces over ln code whose slopes are those of Fritsch and Butland (1984) at
 * the channel's mean curve, as first-order changes of it. Exact on the mean curve, linear in
 * the levels' logarithms. */
typedef struct PanelLevelWeights {
    int   first;     /* level of weight[0] */
    float weight[4]; /* of logarithms; those beyond the last level are 0 */
    float offset;    /* to be added: power laws of a single level */
} PanelLevelWeights;

/* curve: the levels' mean logarithms; log_level: ln of their codes. code > 0. */
PanelLevelWeights panel_level_weights(const float *log_level, const float *curve, int count,
                                      float level_power, float log_code);

/* How a primary's spectrum is bent: coefficients over (u, v) = (ln X/Y, ln Z/Y), in axes along
 * which the measured colours spread: those of a narrow primary lie along a curve, and bending
 * reaches hardly anything beside it. First coordinate: along, second: across. */
typedef struct PanelBendRange {
    float origin[2], along[2]; /* in (u, v); a unit vector, across = (-along[1], along[0]) */
    float low[2], high[2];     /* of the two coordinates */
} PanelBendRange;

typedef struct PanelBend {
    PanelBendRange range;
    float coefficient[PANEL_BEND_SIDE * PANEL_BEND_SIDE][3]; /* across * side + along */
} PanelBend;

/* The section of the primaries: this head, then uint16 value[3][count] of red, green, blue at
 * even wavelengths, multiples of scale; linear between them, 0 outside. */
typedef struct PanelPrimariesHead {
    float    first_nm, step_nm;
    uint16_t count, kind; /* kind: PanelSpectraKind; count 0 when nothing is stored */
    float    scale[3];
} PanelPrimariesHead;
#define PANEL_SPECTRUM_MAX 1024

/* Red, green, blue, black. Spectra every nm from SPECTRAL_FIRST_NM, of 1 cd m^-2. */
typedef struct PanelPrimaries {
    float     spectrum[4][SPECTRAL_COUNT];
    PanelBend bend[4];
} PanelPrimaries;

/* What a panel reflects. A table is the haze measured with the light at one azimuth and one
 * incidence; table = azimuth * incidences + incidence. In the specular-following frame
 *     ln (f / F(theta_i)) at wavelength w = mean[table][w] + sum over k of basis[k][w] *
 *         sum over c of loading[table][k][c] * (the tree's component c),
 * F the unpolarised Fresnel reflectance. A narrow lobe stands on the haze where one was found:
 * reflectance R / F = exp(lobe), a Gaussian of lobe_sigma over the angle to the mirror
 * direction. 16-bit numbers are multiples of the scale that stands beside them. */
typedef struct PanelReflectionStored {
    uint16_t incidences, azimuths;    /* azimuths 1: isotropic, symmetric in y */
    uint16_t components, coefficients; /* of the tree; of spectra */
    uint16_t wavelengths;
    uint16_t nodes;                   /* incidences from the last measured one to 90 degrees */
    uint8_t  is_cubic, has_mirror, has_lobe, reserved;
    float    frame_exponent, refractive_index;
    float    cone_cos;                /* of the leaving directions */
    float    mean_scale, lobe_scale;
    /* then, float: incidence[incidences], azimuth[azimuths], wavelength_nm[wavelengths],
     *   node_theta[nodes], basis_scale[coefficients], loading_scale[components],
     *   lobe_sigma[tables] (with a lobe only);
     * then, 16 bits: mean[tables][wavelengths], floor[tables][wavelengths] (ln, mean_scale),
     *   basis[coefficients][wavelengths], loading[tables][coefficients][components],
     *   lobe[tables][wavelengths] (with a lobe only), and of 1/65535: albedo[tables]
     *   [wavelengths] of haze and lobe, mirror[incidences][wavelengths] (with a mirror only),
     *   held[nodes][wavelengths], by what the haze beyond the measured incidences is
     *   multiplied, and node_albedo[nodes][wavelengths] */
} PanelReflectionStored;

#define PANEL_TABLES_MAX 1152 /* incidences times azimuths */
#define PANEL_AZIMUTHS_MAX 72
#define PANEL_REFLECTION_COMPONENTS_MAX 32
#define PANEL_NODES_MAX 16
#define PANEL_INCIDENCES_MAX 32

/* An incidence that interpolation counts on. Those below 0 are measured ones seen from the
 * other side of the normal: the light's azimuth and the stored direction turned by 180 deg. */
typedef struct PanelIncidence {
    float theta;
    int   incidence;
    bool  is_turned;
} PanelIncidence;

/* The stored form, expanded for queries. Rows over wavelengths have padded_wavelengths floats,
 * rows over coefficients padded_coefficients; what is padded is 0. */
typedef struct PanelReflection {
    uint32_t incidences, azimuths, tables, components, coefficients, padded_coefficients;
    uint32_t wavelengths, padded_wavelengths, nodes, steps;
    bool     is_cubic, has_mirror, has_lobe;
    float    frame_exponent, refractive_index, cone_cos;
    float    first_theta, last_theta; /* measured incidences, radians */
    PanelIncidence step[PANEL_INCIDENCES_MAX + 2]; /* rising in theta */
    float    azimuth[PANEL_AZIMUTHS_MAX];
    float    wavelength_nm[PANEL_WAVELENGTHS_MAX];
    float    node_theta[PANEL_NODES_MAX];
    float    haze_albedo[PANEL_ANGLES]; /* luminous, lobe included */
    const float *mean;    /* [tables][wavelengths] */
    const float *basis;   /* [coefficients][wavelengths] */
    const float *loading; /* [tables][components][coefficients] */
    const float *floor;   /* [tables][wavelengths], sr^-1 */
    const float *lobe;    /* [tables][wavelengths], ln (R / F) */
    const float *lobe_sigma; /* [tables], radians */
    const float *held;    /* [nodes][wavelengths] */
    const float *mirror;  /* [PANEL_ANGLES][wavelengths] */
} PanelReflection;

/* Position in a table over theta: *t in [0, 1] from node to node + 1. */
static inline int panel_angle_node(float theta, float *t)
{
    float at = clampf(theta * 114.59155902616465f, 0, PANEL_ANGLES - 1); /* half degrees */
    int   node = (int)at;
    if (node > PANEL_ANGLES - 2) node = PANEL_ANGLES - 2;
    *t = at - (float)node;
    return node;
}

/* Polar angle of a direction, accurate near the pole too. */
static inline float panel_polar_angle(Vec3 d)
{
    return atan2_f(safe_sqrtf(d.x * d.x + d.y * d.y), d.z);
}

typedef float PanelFloat4 __attribute__((vector_size(16), aligned(4), may_alias));

/* How wi is chosen for a wo: function azimuth * incidences + incidence of one sampling tree in
 * the specular-following frame of wo's polar angle theta, with an exponent of its own. In the
 * file: the tree, at the next multiple of four bytes uint16 incidences and azimuths, then float
 * theta[incidences]; nothing where a single table is reflected, from which opening the file
 * makes the same bytes (sampling_make.h). */
#define PANEL_SAMPLING_EXPONENT 2.0f
typedef struct PanelSampling {
    SamplingTree tree;
    int          incidences; /* 0: nothing is reflected */
    int          azimuths;   /* of wo, evenly over the turn from 0; 1: isotropic */
    const float *theta;      /* radians, rising */
} PanelSampling;

static inline bool panel_makes_sampling(const PanelReflection *reflection)
{
    return reflection->tables == 1;
}

static inline size_t panel_sampling_tree_bytes(size_t tree)
{
    return (tree + 3) / 4 * 4;
}

struct Panel {
    Arena   copy; /* of the file; empty where the bytes belong to somebody else */
    size_t  size;
    const char *meta;
    size_t      meta_size;
    const void *figures; /* NULL: none */
    size_t      figures_size;
    const PanelEmission *emission; /* NULL: emits nothing */
    Tree         emission_tree;
    const PanelPrimaries *primaries; /* with emission */
    const PanelReflection *reflection; /* NULL: reflects nothing */
    Tree         reflection_tree;
    PanelSampling sampling;
    int16_t      wavelength_index[SPECTRAL_COUNT]; /* interval that begins at or below a nm */
    float        wavelength_scale[PANEL_WAVELENGTHS_MAX]; /* 1 / interval's width */
};

/* Checks bytes (aligned to 8, alive as long as the panel) and makes the view. */
bool panel_from_bytes(const void *bytes, size_t size, const char *name, Arena *arena,
                      Panel **out, Error *err);

/* Number of levels' channels before primary p; p = 3: the black pattern's first channel. */
static inline uint32_t panel_first_channel(const PanelEmission *emission, int p)
{
    uint32_t channel = 0;
    for (int i = 0; i < p; i++) channel += 3 * (uint32_t)emission->level_count[i];
    return channel;
}
