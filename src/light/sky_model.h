/* SPDX-License-Identifier: Apache-2.0 */
/* sky_model.h -- a computed sky (sky/daylight.h) as a light: looked up, and sampled by
 * luminance.
 *
 * The sphere is cut at the horizon, which may lie below the horizontal, into cells of elevation
 * and azimuth with constant density: no cell holds both sky and ground.
 * Threads   const once built.
 */
#pragma once
#include "scene/scene.h"

#define SKY_MODEL_ROWS 64 /* of the sky; as many again below */
#define SKY_MODEL_COLUMNS 96

typedef struct SkyModel {
    const Daylight *daylight;
    float turn;                            /* compass azimuth of the scene's -Z */
    bool is_polarised;                     /* it is the clear atmosphere: */
    Vec3 sun;                              /* unit, scene: from where it is lit, up or down */
    float edge[2 * SKY_MODEL_ROWS + 1];    /* sines of elevations, rising */
    float row_cdf[2 * SKY_MODEL_ROWS + 1]; /* 0 to 1 */
    float cdf[2 * SKY_MODEL_ROWS][SKY_MODEL_COLUMNS + 1];
} SkyModel;

/* Unit; azimuth from the scene's -Z over +X, both in radians. */
Vec3 sky_model_direction(float scene_azimuth, float elevation);

bool sky_model_build(const Environment *environment, float turn, Arena *arena, const SkyModel **out,
                     Error *err);

/* HOT. Spectral radiance from a direction of the scene, and its density, sr^-1. */
float sky_model_pdf(const SkyModel *model, Vec3 direction);
Spectrum sky_model_seen(const SkyModel *model, Vec3 direction, const Wavelengths *wavelengths,
                        float *pdf);

/* HOT. Degree of linear polarisation of the light from a direction, across the plane of it and
 * the sun; [0, 1]. */
Spectrum sky_model_polarisation(const SkyModel *model, Vec3 direction,
                                const Wavelengths *wavelengths);

/* HOT. */
Vec3 sky_model_sample(const SkyModel *model, float u0, float u1);
