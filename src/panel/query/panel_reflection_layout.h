/* SPDX-License-Identifier: Apache-2.0 */
/* panel_reflection_layout.h -- where the numbers of a panel file's reflection stand behind its
 * PanelReflectionStored. Private to src/panel.
 *
 * Memory   views into the section's bytes. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/query/panel_file.h"
#include "spectrum/spectral_table.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

typedef struct ReflectionLayout {
    const float *incidence, *azimuth, *wavelength_nm, *node_theta;
    const float *basis_scale, *loading_scale;
    const int16_t *mean, *lambertian, *basis, *loading;
    const uint16_t *albedo, *mirror, *held, *node_albedo;
} ReflectionLayout;

/* Fills in where everything stands (mirror NULL where there is none); the bytes of
 * the whole section. */
static inline size_t reflection_layout(const PanelReflectionStored *s, ReflectionLayout *out) {
    size_t tables = (size_t)s->incidences * s->azimuths, row = s->wavelengths;
    const float *f = (const float *)(s + 1);
    *out = (ReflectionLayout){0};
    out->incidence = f, f += s->incidences;
    out->azimuth = f, f += s->azimuths;
    out->wavelength_nm = f, f += s->wavelengths;
    out->node_theta = f, f += s->nodes;
    out->basis_scale = f, f += s->coefficients;
    out->loading_scale = f, f += s->components;
    const int16_t *i = (const int16_t *)f;
    out->mean = i, i += tables * row;
    out->lambertian = i, i += tables * row;
    out->basis = i, i += s->coefficients * row;
    out->loading = i, i += tables * s->coefficients * s->components;
    const uint16_t *u = (const uint16_t *)i;
    out->albedo = u, u += tables * row;
    if (s->has_mirror) out->mirror = u, u += s->incidences * row;
    out->held = u, u += s->nodes * row;
    out->node_albedo = u, u += s->nodes * row;
    return (size_t)((const char *)u - (const char *)s);
}

/* Weight of a wavelength in luminous means, up to a factor: the observer's y, and a little so
 * that none has weight 0. */
static inline double panel_luminous_weight(float nm) {
    int i = (int)((double)nm + 0.5) - SPECTRAL_FIRST_NM;
    i = i < 0 ? 0 : i >= SPECTRAL_COUNT ? SPECTRAL_COUNT - 1 : i;
    return (double)spectral_table[i].y + 0.002;
}
