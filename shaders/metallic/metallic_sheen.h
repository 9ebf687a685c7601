/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_sheen.h -- fibres over all of metallic_roughness, under its coat.
 *
 * What sheen.h knows of a white sheen, for this surface's colour and facets. Shares of light,
 * [0, 1]; fibres send sr^-1.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_view.h"

#pragma GCC diagnostic push /* inline: no vector goes from one file to another */
#pragma GCC diagnostic ignored "-Wpsabi"

/* The sheen's colour per lane, at most sheen_most: what lies beneath is scaled by that. */
Spectrum sheen_tint(const MetallicRoughness *m);

/* Share that fibres send along a direction, and that they take from facets beneath. */
SheenShare sheen_towards(const MetallicRoughness *m, Vec3 w);

/* Share of light along these two that a facet beneath keeps. */
float sheen_leaves(const MetallicView *view, Vec3 wi);

/* Energies that facets send through the sheen, from a direction or in the mean. */
Energy sheen_lets_through(const MetallicRoughness *m, Energy e, SheenShare share);

/* Share of light at a cosine that gets past the fibres. */
float sheen_kept(const MetallicRoughness *m, float cosine);

/* The fibres' lobe from wi towards the eye. */
Spectrum sheen_fibres(const MetallicView *view, Vec3 wi);

static inline float sheen_most(const MetallicRoughness *m)
{
    return fmaxf(fmaxf(m->sheen_color[0], m->sheen_color[1]), m->sheen_color[2]);
}

/* No colour is below 0. */
static inline bool has_sheen(const MetallicRoughness *m)
{
    return m->sheen_color[0] + m->sheen_color[1] + m->sheen_color[2] > 0;
}

/* The light of both directions that a smooth mirror or a sheet keeps below the sheen. */
static inline Spectrum sheen_over(const MetallicView *view, Vec3 wi, Spectrum below)
{
    return has_sheen(view->m) ? below * spectrum_all(sheen_leaves(view, wi)) : below;
}

#pragma GCC diagnostic pop
