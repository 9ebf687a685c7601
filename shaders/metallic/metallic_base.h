/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_base.h -- light that is spread by metallic_roughness where no coat lies.
 *
 * The Lambert base under its boundary, back and across to the other side, and the rebound: what
 * a metal's or a sheet's facets send to one another before it comes out. Values are sr^-1;
 * means over the hemisphere are shares of light.
 *
 * Sources  Kelemen and Szirmay-Kalos 2001 (the coupling), Kulla and Conty 2017 (the rebound).
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_energy.h"
#include "shaders/metallic/metallic_facet.h"
#include "shaders/metallic/metallic_sheen.h"

#pragma GCC diagnostic push /* inline: no vector goes from one file to another */
#pragma GCC diagnostic ignored "-Wpsabi"

/* Albedo of what leaves on the other side. */
Spectrum base_lambert_across(const MetallicRoughness *m);

/* Albedo of both sides together. */
Spectrum base_lambert_albedo(const MetallicRoughness *m);

/* Share of the light along w that comes to the Lambert base below film, coating or sheen. */
Spectrum base_enters_layers(const MetallicView *view, Vec3 w, Energy e);

/* The factor of base_diffuse that depends on wo. */
Spectrum base_lambert_towards(const MetallicView *view);

/* The rebound's share along wi, for reflectance 1. */
float base_rebound_lobe(const MetallicView *view, Vec3 wi, Energy in);

/* The share of the rebound that a metal leaves. */
Spectrum base_metal_rebound(const MetallicRoughness *m);

/* A sheet's mean reflectance: its share of the rebound on the eye's side. */
Spectrum base_pane_mean(const MetallicView *view);

/* A sheet's mean transmittance, likewise. */
Spectrum base_pane_through(const MetallicView *view);

/* The rebound of metals and sheets on the eye's side. */
Spectrum base_rebound(const MetallicView *view, Vec3 wi, Energy in);

static inline Spectrum lambert_back(const MetallicRoughness *m)
{
    return m->across > 0 ? m->base_color * spectrum_all(1 - m->across) : m->base_color;
}

static inline bool has_lambert(const MetallicRoughness *m)
{
    return (1 - m->metallic) * (1 - m->transmission) > 0;
}

/* Only metals and sheets have one: the non-metal's is in the Lambert base. */
static inline bool has_rebound(const MetallicRoughness *m)
{
    return m->metallic > 0 || m->transmission > 0;
}

/* Is the boundary over the Lambert base more than a bare one? */
static inline bool has_layers(const MetallicRoughness *m)
{
    return m->coating || has_film(m) || has_sheen(m);
}

/* Share of the light from w that comes to the Lambert base where no coat lies; e: of facets. */
static inline Spectrum enters(const MetallicView *view, Vec3 w, Energy e)
{
    return has_layers(view->m) ? base_enters_layers(view, w, e) : let_in(&view->boundary, e);
}

/* Lambert under boundary and sheen: albedo / pi * in(wo) in(wi) / mean of in (Kelemen 2001). */
static inline Spectrum base_diffuse(const MetallicView *view, Spectrum albedo, Vec3 wi,
                                    Energy in)
{
    if (!has_lambert(view->m)) return spectrum_all(0);
    return albedo * view->lambert * enters(view, wi, in);
}

#pragma GCC diagnostic pop
