/* SPDX-License-Identifier: Apache-2.0 */
/* The interface for other programs, over src/panel/query. */
#include "library/parhelion_panel.h"

#include <stdbool.h>
#include <string.h>

#include "base/arena.h"
#include "base/error.h"
#include "library/emission_draw.h"
#include "library/open_panel.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_zones.h"
#include "spectrum/spectral_table.h"

struct ParhelionPanel { /* lies in its own arena */
    Arena arena;
    const Panel *panel;
    EmissionDraw draw;
};

/* Sizes in the first version: no caller has less. */
#define INFO_BYTES (offsetof(ParhelionPanelInfo, polarisation_azimuth) + sizeof(float))
#define QUESTION_BYTES (offsetof(ParhelionPanelQuestions, nm) + sizeof(const float *))

/* ---- opening ----------------------------------------------------------------------------- */

static int open_from(const PanelSource *from, ParhelionPanel **panel, char *error,
                     size_t error_size) {
    Error err = {0};
    OpenedPanel opened;
    *panel = NULL;
    if (open_panel(from, sizeof **panel, &opened, &err)) {
        *panel = opened.room;
        **panel = (ParhelionPanel){opened.arena, opened.panel, opened.draw};
        return PARHELION_PANEL_OK;
    }
    if (error && error_size)
        error_line(&err, error, error_size < INT32_MAX ? (int)error_size : INT32_MAX);
    return err.code == ERROR_MEMORY ? PARHELION_PANEL_NO_MEMORY : PARHELION_PANEL_REFUSED;
}

int parhelion_panel_open(const char *path, ParhelionPanel **panel, char *error, size_t error_size) {
    return open_from(&(PanelSource){.path = path ? path : ""}, panel, error, error_size);
}

int parhelion_panel_open_memory(const void *bytes, size_t size, ParhelionPanel **panel, char *error,
                                size_t error_size) {
    return open_from(&(PanelSource){.bytes = bytes, .size = size}, panel, error, error_size);
}

void parhelion_panel_close(ParhelionPanel *panel) {
    if (!panel) return;
    Arena arena = panel->arena; /* which the panel itself goes with */
    arena_release(&arena);
}

/* ---- what it holds ----------------------------------------------------------------------- */

static uint32_t flags_of(const Panel *panel) {
    double phi[PANEL_INFO_AZIMUTHS_MAX];
    bool reflects = panel_reflects(panel);
    return (panel_info_emits(panel) ? PARHELION_PANEL_EMITS : 0) |
           (reflects ? PARHELION_PANEL_REFLECTS : 0) |
           (panel_has_mirror(panel) ? PARHELION_PANEL_HAS_MIRROR : 0) |
           (panel_info_azimuths(panel, phi) > 1 ? PARHELION_PANEL_ANISOTROPIC : 0) |
           (panel_varies(panel) ? PARHELION_PANEL_VARIES : 0) |
           (panel_polarisation(panel).degree > 0 ? PARHELION_PANEL_POLARISED : 0) |
           (panel_zones(panel) ? PARHELION_PANEL_HAS_ZONES : 0);
}

static void add_emission(const Panel *panel, ParhelionPanelInfo *info) {
    PanelPolarisation polarisation = panel_polarisation(panel);
    if (!panel_info_emits(panel)) return;
    info->emission_cone = (float)panel_info_emission_cone(panel);
    info->emission_nm[0] = SPECTRAL_FIRST_NM;
    info->emission_nm[1] = SPECTRAL_LAST_NM;
    info->polarisation = polarisation.degree;
    info->polarisation_azimuth = polarisation.azimuth;
}

static void add_reflection(const Panel *panel, ParhelionPanelInfo *info) {
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    double theta[PANEL_INFO_INCIDENCES_MAX];
    int wavelengths = panel_info_wavelengths(panel, nm);
    if (!wavelengths) return;
    info->reflection_cone = (float)panel_info_reflection_cone(panel);
    info->last_incidence = (float)theta[panel_info_incidences(panel, theta) - 1];
    info->reflection_nm[0] = nm[0];
    info->reflection_nm[1] = nm[wavelengths - 1];
}

int parhelion_panel_info(const ParhelionPanel *panel, ParhelionPanelInfo *info) {
    ParhelionPanelInfo all = {.size = info->size};
    size_t room = info->size;
    if (room < INFO_BYTES) return PARHELION_PANEL_WRONG_SIZE;
    all.flags = flags_of(panel->panel);
    add_emission(panel->panel, &all);
    add_reflection(panel->panel, &all);
    memcpy(info, &all, room < sizeof all ? room : sizeof all);
    return PARHELION_PANEL_OK;
}

/* ---- questions --------------------------------------------------------------------------- */

/* Arrays that the questions must have. */
typedef enum Need {
    NEED_VIEWER = 1,
    NEED_LIGHT = 2,
    NEED_CODE = 4,
    NEED_RANDOM = 8,
    NEED_NM = 16
} Need;

static int check(const ParhelionPanelQuestions *q, int needs, const void *out) {
    if (q->size < QUESTION_BYTES) return PARHELION_PANEL_WRONG_SIZE;
    if (q->count == 0 || (needs & NEED_NM && q->wavelengths == 0)) return PARHELION_PANEL_OK;
    bool lacks = (needs & NEED_VIEWER && !q->viewer) || (needs & NEED_LIGHT && !q->light) ||
                 (needs & NEED_CODE && !q->code) || (needs & NEED_RANDOM && !q->random) ||
                 (needs & NEED_NM && !q->nm) || !out;
    return lacks ? PARHELION_PANEL_MISSING : PARHELION_PANEL_OK;
}

/* A vector of nearly length 1 stays as it is, so that the bits are those of the program. */
#define LENGTH_BEARS 1e-5f

static Vec3 direction_at(const float *from, size_t i) {
    Vec3 d = vec3(from[3 * i], from[3 * i + 1], from[3 * i + 2]);
    float square = vec3_dot(d, d);
    if (fabsf(square - 1) <= LENGTH_BEARS) return d;
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0 && length < (double)INFINITY)) return vec3(0, 0, 0);
    return vec3((float)(x / length), (float)(y / length), (float)(z / length));
}

static void place_at(const ParhelionPanelQuestions *q, size_t i, float place[2]) {
    for (int k = 0; k < 2; k++) place[k] = q->place ? q->place[2 * i + (size_t)k] : 0.5f;
}

static PanelMix mix_at(const ParhelionPanel *panel, const ParhelionPanelQuestions *q, size_t i) {
    float place[2];
    place_at(q, i, place);
    return panel_place_reflection(panel->panel, place);
}

/* Held in [0, most]; no number is 0. */
static void held_at(const float *from, size_t i, float most, float out[3]) {
    for (size_t k = 0; k < 3; k++) {
        float value = from[3 * i + k];
        out[k] = value > 0 ? fminf(value, most) : 0;
    }
}

/* Up to 16 wavelengths from a first one on; lanes behind the last repeat it. */
typedef struct WaveBlock {
    Wavelengths wavelengths; /* nm alone */
    size_t first, count;
} WaveBlock;

static void fill_block(const ParhelionPanelQuestions *q, size_t first, WaveBlock *out) {
    size_t left = q->wavelengths - first;
    memset(out, 0, sizeof *out);
    out->first = first;
    out->count = left < SPECTRUM_LANES ? left : SPECTRUM_LANES;
    for (size_t k = 0; k < SPECTRUM_LANES; k++) {
        float nm = q->nm[first + (k < out->count ? k : out->count - 1)];
        out->wavelengths.nm[k] =
            nm > SPECTRAL_FIRST_NM ? fminf(nm, SPECTRAL_LAST_NM) : SPECTRAL_FIRST_NM;
    }
}

static void put(const ParhelionPanelQuestions *q, const WaveBlock *block, size_t i,
                const Spectrum *value, float *out) {
    float *to = out + i * q->wavelengths + block->first;
    for (size_t k = 0; k < block->count; k++) to[k] = (*value)[k];
}

int parhelion_panel_emission_xyz(const ParhelionPanel *panel,
                                 const ParhelionPanelQuestions *questions, float *xyz,
                                 unsigned char *is_measured) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_CODE, xyz);
    for (size_t i = 0; !status && i < q->count; i++) {
        float place[2], code[3];
        place_at(q, i, place);
        held_at(q->code, i, 255, code);
        bool measured = panel_place_emission_xyz(panel->panel, place, direction_at(q->viewer, i),
                                                 code, xyz + 3 * i);
        if (is_measured) is_measured[i] = measured;
    }
    return status;
}

int parhelion_panel_emission_spectrum(const ParhelionPanel *panel,
                                      const ParhelionPanelQuestions *questions, float *radiance) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_CODE | NEED_NM, radiance);
    for (size_t w = 0; !status && w < q->wavelengths; w += SPECTRUM_LANES) {
        WaveBlock block;
        fill_block(q, w, &block);
        for (size_t i = 0; i < q->count; i++) {
            float place[2], code[3];
            place_at(q, i, place);
            held_at(q->code, i, 255, code);
            Spectrum light = panel_place_emission_spectrum(
                panel->panel, place, direction_at(q->viewer, i), code, &block.wavelengths);
            put(q, &block, i, &light, radiance);
        }
    }
    return status;
}

/* A panel's lanes are worth a query and a half: kept while the same panel is queried. */
typedef struct KeptLanes {
    const Panel *panel;
    PanelLanes lanes;
} KeptLanes;

static const PanelLanes *lanes_of(const Panel *panel, const Wavelengths *wavelengths,
                                  KeptLanes *kept) {
    if (kept->panel != panel) panel_lanes(panel, wavelengths, &kept->lanes);
    kept->panel = panel;
    return &kept->lanes;
}

/* Panels at a place, the two directions and where they are evaluated. */
typedef struct BrdfQuestion {
    PanelMix mix;
    Vec3 wo, wi;
    const Wavelengths *wavelengths;
} BrdfQuestion;

static Spectrum brdf_of(const BrdfQuestion *of, KeptLanes *kept) {
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < of->mix.count; i++) {
        const Panel *one = of->mix.panel[i];
        sum += panel_brdf_at(one, of->wo, of->wi, lanes_of(one, of->wavelengths, kept)) *
               spectrum_all(of->mix.weight[i]);
    }
    return sum;
}

static Spectrum lambertian_of(const BrdfQuestion *of, Spectrum brdf, KeptLanes *kept) {
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < of->mix.count; i++) {
        const Panel *one = of->mix.panel[i];
        sum += panel_lambertian_at(one, brdf, of->wi, lanes_of(one, of->wavelengths, kept)) *
               spectrum_all(of->mix.weight[i]);
    }
    return sum;
}

int parhelion_panel_brdf(const ParhelionPanel *panel, const ParhelionPanelQuestions *questions,
                         float *brdf, float *lambertian) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_LIGHT | NEED_NM, brdf);
    for (size_t w = 0; !status && w < q->wavelengths; w += SPECTRUM_LANES) {
        WaveBlock block;
        KeptLanes kept = {.panel = NULL};
        fill_block(q, w, &block);
        for (size_t i = 0; i < q->count; i++) {
            BrdfQuestion of = {mix_at(panel, q, i), direction_at(q->viewer, i),
                               direction_at(q->light, i), &block.wavelengths};
            Spectrum all = brdf_of(&of, &kept), part;
            put(q, &block, i, &all, brdf);
            if (!lambertian) continue;
            part = lambertian_of(&of, all, &kept);
            put(q, &block, i, &part, lambertian);
        }
    }
    return status;
}

int parhelion_panel_mirror(const ParhelionPanel *panel, const ParhelionPanelQuestions *questions,
                           float *reflectance) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_NM, reflectance);
    for (size_t w = 0; !status && w < q->wavelengths; w += SPECTRUM_LANES) {
        WaveBlock block;
        fill_block(q, w, &block);
        for (size_t i = 0; i < q->count; i++) {
            PanelMix mix = mix_at(panel, q, i);
            Spectrum share =
                panel_mix_mirror(&mix, direction_at(q->viewer, i).z, &block.wavelengths);
            put(q, &block, i, &share, reflectance);
        }
    }
    return status;
}

int parhelion_panel_albedo(const ParhelionPanel *panel, const ParhelionPanelQuestions *questions,
                           float *albedo) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER, albedo);
    for (size_t i = 0; !status && i < q->count; i++) {
        PanelMix mix = mix_at(panel, q, i);
        albedo[i] = panel_mix_haze_albedo(&mix, direction_at(q->viewer, i).z);
    }
    return status;
}

#define BELOW_ONE 0x1.fffffep-1f

int parhelion_panel_sample(const ParhelionPanel *panel, const ParhelionPanelQuestions *questions,
                           float *light, float *density) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_RANDOM, light && density ? light : NULL);
    for (size_t i = 0; !status && i < q->count; i++) {
        float u[3], pdf;
        Vec3 wi;
        held_at(q->random, i, BELOW_ONE, u);
        PanelMix mix = mix_at(panel, q, i);
        bool drawn = panel_mix_sample(&mix, direction_at(q->viewer, i), u, &wi, &pdf);
        if (!drawn) wi = vec3(0, 0, 0);
        memcpy(light + 3 * i, (float[3]){wi.x, wi.y, wi.z}, 3 * sizeof *light);
        density[i] = drawn ? pdf : 0;
    }
    return status;
}

int parhelion_panel_pdf(const ParhelionPanel *panel, const ParhelionPanelQuestions *questions,
                        float *density) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_LIGHT, density);
    for (size_t i = 0; !status && i < q->count; i++) {
        PanelMix mix = mix_at(panel, q, i);
        density[i] = panel_mix_pdf(&mix, direction_at(q->viewer, i), direction_at(q->light, i));
    }
    return status;
}

/* ---- the display as a light -------------------------------------------------------------- */

int parhelion_panel_sample_emission(const ParhelionPanel *panel,
                                    const ParhelionPanelQuestions *questions, float *viewer,
                                    float *density) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_CODE | NEED_RANDOM, viewer && density ? viewer : NULL);
    for (size_t i = 0; !status && i < q->count; i++) {
        float u[3], code[3], pdf;
        Vec3 d;
        held_at(q->random, i, BELOW_ONE, u);
        held_at(q->code, i, 255, code);
        bool drawn = emission_draw_sample(&panel->draw, panel->panel, code, u, &d, &pdf);
        if (!drawn) d = vec3(0, 0, 0);
        memcpy(viewer + 3 * i, (float[3]){d.x, d.y, d.z}, 3 * sizeof *viewer);
        density[i] = drawn ? pdf : 0;
    }
    return status;
}

int parhelion_panel_pdf_emission(const ParhelionPanel *panel,
                                 const ParhelionPanelQuestions *questions, float *density) {
    const ParhelionPanelQuestions *q = questions;
    int status = check(q, NEED_VIEWER | NEED_CODE, density);
    for (size_t i = 0; !status && i < q->count; i++) {
        float code[3];
        held_at(q->code, i, 255, code);
        density[i] =
            emission_draw_pdf(&panel->draw, panel->panel, code, direction_at(q->viewer, i));
    }
    return status;
}
