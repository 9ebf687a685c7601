/* panel_file.h -- the layout of X.panel and of an opened Panel. Private to src/panel.
 *
 * Little-endian. A header, a table of contents, then the sections, each at a multiple of 8
 * bytes; no pointers, so that a mapped file is queried in place. The checksum (XXH3, 64 bits)
 * covers everything behind itself. The version changes whenever a struct below does.
 */
#pragma once
#include <stdint.h>

#include "base/mathf.h"
#include "hemisphere/sampling_tree.h"
#include "hemisphere/tree.h"
#include "panel/panel.h"
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
#define PANEL_HARMONICS_MAX 8

typedef struct PanelHeader {
    char     magic[8]; /* PANEL_MAGIC, without its zero */
    uint32_t version, flags; /* flags: 0 */
    uint64_t checksum;       /* of the bytes from size on */
    uint64_t size;           /* of the file */
    uint32_t section_count, reserved; /* reserved: 0 */
} PanelHeader;

typedef enum PanelSectionKind {
    PANEL_META = 1,            /* JSON text: names, source, reports */
    PANEL_EMISSION = 2,        /* PanelEmission, means, loadings, luminances */
    PANEL_EMISSION_TREE = 3,
    PANEL_PRIMARIES = 4,       /* PanelPrimaries */
    PANEL_REFLECTION = 5,      /* PanelReflection, basis, mirror */
    PANEL_REFLECTION_TREE = 6,
    PANEL_SAMPLING = 7         /* one a slice, in order */
} PanelSectionKind;

typedef struct PanelSection {
    uint16_t kind, index;
    uint32_t size;
    uint64_t offset;
} PanelSection;

/* Natural logarithms of tristimulus values in cd m^-2. A channel is one of X, Y, Z of one
 * table: red's levels rising, then green's, blue's, then (if any) the black pattern's. At a
 * direction, log value[channel] = mean[channel] + cosine_power log cos theta + sum over
 * components of loading[channel][component] * (profile + tree's component). */
typedef struct PanelEmission {
    uint32_t components, channels, level_count[3], has_black;
    float    cone_cos;   /* cos of the last measured theta */
    float    level_power; /* exponent of the level curve where only one level is known */
    float    cosine_power;
    float    level[3][PANEL_LEVELS_MAX];
    uint32_t harmonics; /* of the profile */
    /* then: float mean[channels], loading[channels][components], mean_y[channels / 3],
     * profile[PANEL_ANGLES][1 + 2 harmonics][components] */
} PanelEmission;

/* How a primary's spectrum is bent: coefficients over (u, v) = (ln X/Y, ln Z/Y), in axes along
 * which the measured colours spread: those of a narrow primary lie along a curve, and bending
 * reaches hardly anything beside it. First coordinate: along, second: across. */
typedef struct PanelBend {
    float origin[2], along[2]; /* in (u, v); a unit vector, across = (-along[1], along[0]) */
    float low[2], high[2];     /* of the two coordinates */
    float coefficient[PANEL_BEND_SIDE * PANEL_BEND_SIDE][3]; /* across * side + along */
} PanelBend;

/* Red, green, blue, black. Spectra every nm from SPECTRAL_FIRST_NM, of 1 cd m^-2. */
typedef struct PanelPrimaries {
    float     spectrum[4][SPECTRAL_COUNT];
    PanelBend bend[4];
} PanelPrimaries;

/* Slices in the specular-following frame: component slice * coefficients + k of profile plus
 * tree is coefficient k of log(f / F(theta_i)); basis[k] times it, summed, is the logarithm at
 * the wavelengths. Slices with a negative theta are the first ones mirrored at the normal. */
typedef struct PanelReflection {
    uint32_t slices, coefficients, wavelengths, padded_wavelengths;
    float    frame_exponent, refractive_index;
    float    cone_cos;               /* of the leaving directions */
    float    first_theta, last_theta; /* measured incidences, radians */
    uint32_t is_cubic;               /* over four slices; else linear over two */
    uint32_t harmonics;              /* of the profile, cosines only */
    float    slice_theta[PANEL_SLICES_MAX];
    float    wavelength_nm[PANEL_WAVELENGTHS_MAX];
    float    haze_albedo[PANEL_ANGLES];
    /* then: float basis[coefficients][padded], mirror[PANEL_ANGLES][padded],
     * profile[PANEL_ANGLES][1 + harmonics][slices * coefficients] */
} PanelReflection;

#define PANEL_CHANNELS_AT_ONCE 12 /* X, Y, Z of four levels */

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

/* The smooth part of a tree's components, a Fourier series over the azimuth whose terms are
 * tables over theta: values[angle][term][component], terms 1, cos phi, (sin phi,) cos 2 phi ...
 * It leaves to the tree what is fine or irregular; interpolation between leaves is of first
 * order, and the smooth part, steep towards the horizon, would suffer most of it. */
typedef struct PanelProfile {
    const float *values;
    int          width;     /* components */
    int          harmonics;
    bool         has_sines; /* false: symmetric in y */
} PanelProfile;

static inline int panel_profile_terms(int harmonics, bool has_sines)
{
    return 1 + (has_sines ? 2 : 1) * harmonics;
}

typedef float PanelFloat4 __attribute__((vector_size(16), aligned(4), may_alias));

static inline void panel_add_row(const float *row, int stride, float t, float factor, int count,
                                 float *out)
{
    float near = factor * (1 - t), far = factor * t;
    int   i = 0;
    for (; i + 4 <= count; i += 4)
        *(PanelFloat4 *)(out + i) += *(const PanelFloat4 *)(row + i) * near +
                                     *(const PanelFloat4 *)(row + i + stride) * far;
    for (; i < count; i++) out[i] += near * row[i] + far * row[i + stride];
}

/* Adds components first .. first + count - 1 at a direction to out. */
static inline void panel_add_profile(const PanelProfile *profile, Vec3 d, int first, int count,
                                     float *out)
{
    float t, s = safe_sqrtf(d.x * d.x + d.y * d.y);
    float cos_1 = s > 0 ? d.x / s : 1, sin_1 = s > 0 ? d.y / s : 0, c = 1, sine = 0;
    int   terms = panel_profile_terms(profile->harmonics, profile->has_sines);
    int   stride = terms * profile->width;
    const float *row = profile->values + panel_angle_node(atan2_f(s, d.z), &t) * stride + first;
    panel_add_row(row, stride, t, 1, count, out);
    for (int m = 1; m <= profile->harmonics; m++) {
        float next = c * cos_1 - sine * sin_1;
        sine = sine * cos_1 + c * sin_1;
        c = next;
        panel_add_row(row += profile->width, stride, t, c, count, out);
        if (profile->has_sines)
            panel_add_row(row += profile->width, stride, t, sine, count, out);
    }
}

struct Panel {
    void   *map; /* NULL: the bytes belong to somebody else */
    size_t  size;
    const char *meta;
    size_t      meta_size;
    const PanelEmission *emission;
    const float *channel_mean, *loading, *mean_y;
    /* mean, then the loadings of component 0, 1, ...: rows of channel_stride floats, so that
     * neighbouring channels are read at once, also four beyond the last one */
    const float *channel_rows;
    int          channel_stride;
    PanelProfile emission_profile;
    Tree         emission_tree;
    float        log_level[3][PANEL_LEVELS_MAX];
    const PanelPrimaries *primaries;
    const PanelReflection *reflection; /* NULL: reflects nothing */
    const float *basis, *mirror;
    PanelProfile reflection_profile;
    Tree         reflection_tree;
    SamplingTree sampling[PANEL_SLICES_MAX];
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
    for (int i = 0; i < p; i++) channel += 3 * emission->level_count[i];
    return channel;
}
