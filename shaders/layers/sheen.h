/* SPDX-License-Identifier: Apache-2.0 */
/* sheen.h -- the lobe of fibres that stand up from cloth (KHR_materials_sheen), and what it
 * leaves of the light to what lies beneath.
 *
 * Local frame, +z the normal. alpha: sheenRoughnessFactor squared, in [SHEEN_LEAST_ALPHA, 1];
 * below that the lobe is a needle along the horizon that no eye meets.
 *
 * Of colour 1 the lobe is D / (4 zo zi (1 + L(zo) + L(zi))) with the Charlie distribution
 * D = (2 + 1/alpha) sin^(1/alpha) / (2 pi) and the fitted shadowing L, both as the extension
 * writes them. Of roughness below 0.25, and seen within some degrees of the horizon, that
 * would send back more than it gets (2.9 times at 0.07): there it is divided by the greater of
 * what it would send along either direction.
 *
 * Its OverlayShare (overlay.h) is of facets of index 1.5, near enough for any.
 *
 * Source   Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"; the
 *          extension's text.
 * Errors   albedo 1e-3 of the integral.
 * Memory   150 KiB, made with the program (tables/make_tables.c).
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "base/vec.h"
#include "shaders/facets/energy.h"

#define SHEEN_ROUGHNESSES 32 /* spaced evenly in the fourth root of alpha, up to 1 */
#define SHEEN_COSINES 48     /* spaced evenly in sqrt(cosine) */
#define SHEEN_BROAD 16       /* the same axes, for facets */
#define SHEEN_WIDE 32
#define SHEEN_BASES 21          /* energy.h's octaves of the facets' alpha, two rows each */
#define SHEEN_LEAST 0.26457513f /* the fourth root of the least alpha: roughness 0.07 */
#define SHEEN_LEAST_ALPHA 0.0049f

typedef struct SheenTable {
    float full[SHEEN_ROUGHNESSES][SHEEN_COSINES]; /* the albedo, were it not bounded */
    float albedo[SHEEN_ROUGHNESSES][SHEEN_COSINES];
    float mean_albedo[SHEEN_BROAD];
    Energy mean[SHEEN_BROAD][SHEEN_BASES];
    Energy excess[SHEEN_BROAD][SHEEN_BASES][SHEEN_WIDE]; /* less the albedo, of facets */
    float open[SHEEN_BROAD][SHEEN_BASES][SHEEN_WIDE];    /* by the coat's alpha */
} SheenTable;

extern const SheenTable common_sheen_table;

/* sr^-1; 0 unless both are above the surface. Full: not bounded. */
float sheen_lobe_full(Vec3 wo, Vec3 wi, float alpha);
float sheen_lobe(const SheenTable *table, Vec3 wo, Vec3 wi, float alpha);

/* Cosine in [0, 1]. */
float sheen_albedo(const SheenTable *table, float cosine, float alpha);

/* Over facets of GGX alpha `base`, [0, 1]; of a smooth face all and shape are the albedo. */
OverlayShare sheen_share(const SheenTable *table, float cosine, float alpha, float base);

/* Over the hemisphere, weighted by the cosine: of the albedo, and of all and shape by the light
 * that the facets send. */
OverlayShare sheen_mean(const SheenTable *table, float alpha, float base);

/* Share of the light which fibres send, of that from one direction, that a lacquer (coat.h)
 * over them lets out. */
float sheen_open(const SheenTable *table, float cosine, float alpha, float coat_alpha);
