/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_facet.h -- what one facet of metallic_roughness reflects and lets through.
 *
 * Evaluated by the cosine at which light meets the facet, [0, 1]: of the non-metal (solid or a
 * thin sheet), of the metal, each bare, under a thin film or coated. Spectra are shares of
 * light, [0, 1]; those of a part of the surface are times the part's share.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/layers/pane.h"
#include "shaders/metallic/metallic_view.h"

/* A sheet's reflectance on the side of the eye and on the other one, and what passes. */
typedef struct SheetFaces {
    Spectrum front, rear, through;
} SheetFaces;

/* A filmed boundary, whose bare reflectance is known. */
Spectrum facet_filmed(const MetallicRoughness *m, Spectrum bare, float cosine);

/* The sheet's share alone, a facet of it met at `cosine`: two faces and one body
 * (layers/pane.h). */
PaneLight facet_pane(const MetallicRoughness *m, const MetallicFace *b, float cosine);

/* The non-metal's share, where it is coated. */
Spectrum facet_coated(const MetallicRoughness *m, const MetallicFace *b, float cosine);

/* A metal, not times its share. */
Spectrum facet_metal_at(const MetallicRoughness *m, float cosine);

/* Light that the sheet's share lets through a facet met at `cosine`. */
Spectrum facet_through(const MetallicRoughness *m, const MetallicFace *b, float cosine);

/* The same from both of its sides. */
SheetFaces facet_sheet(const MetallicRoughness *m, const MetallicFace *b, float cosine);

static inline bool has_film(const MetallicRoughness *m) {
    return m->film.share > 0;
}

static inline float clear_share(const MetallicRoughness *m) {
    return (1 - m->metallic) * m->transmission;
}

static inline const CoatingTables *coated_metal(const MetallicRoughness *m) {
    return m->coating ? m->coating->metal : NULL;
}

static inline const CoatingTables *coated_face(const MetallicRoughness *m) {
    return m->coating ? m->coating->face : NULL;
}

static inline const PaneCoating *coated_sheet(const MetallicRoughness *m) {
    return m->coating ? m->coating->sheet : NULL;
}

static inline MetallicFace boundary_of(const MetallicRoughness *m) {
    float f0 = m->energy->ior >= 1 ? fresnel_normal(m->energy->ior) : 1.0f;
    Spectrum tinted = m->specular_color * spectrum_all(f0);
    MetallicFace b;
    b.f0 = spectrum_min(tinted, spectrum_all(1)) * spectrum_all(m->specular);
    b.rise = spectrum_all(m->specular) - b.f0;
    return b;
}

/* Share of the base's light that a boundary lets pass, for an energy of the table. */
static inline Spectrum let_in(const MetallicFace *b, Energy e) {
    return spectrum_all(1) - b->f0 * spectrum_all(e.all) - b->rise * spectrum_all(e.shape);
}

/* The index that slants a way through the sheet's body. */
static inline float body_ior(const MetallicRoughness *m) {
    if (coated_sheet(m)) return coated_sheet(m)->ior;
    return m->energy->ior >= 1 ? m->energy->ior : INFINITY;
}

static inline Spectrum facet_reflectance(const MetallicRoughness *m, const MetallicFace *b,
                                         float cosine) {
    Spectrum bare = b->f0 + b->rise * spectrum_all(fresnel_shape(m->energy->ior, cosine));
    return has_film(m) ? facet_filmed(m, bare, cosine) : bare;
}

/* Reflectance of a facet met at `cosine`, of the non-metal's share, sheet or solid. */
static inline Spectrum facet_of_nonmetal(const MetallicRoughness *m, const MetallicFace *b,
                                         float cosine) {
    if (!(m->metallic < 1)) return spectrum_all(0);
    if (coated_face(m) || coated_sheet(m)) return facet_coated(m, b, cosine);
    Spectrum face = facet_reflectance(m, b, cosine);
    if (m->transmission > 0)
        face += (facet_pane(m, b, cosine).reflected - face) * spectrum_all(m->transmission);
    return face * spectrum_all(1 - m->metallic);
}

static inline Spectrum facet_of_metal(const MetallicRoughness *m, float cosine) {
    if (!(m->metallic > 0)) return spectrum_all(0);
    return facet_metal_at(m, cosine) * spectrum_all(m->metallic);
}

/* ---- a thin sheet between two like layers that throw its light back at it -----------------
 *
 * Light that leaves the sheet on either side meets a layer, which holds back the share `held`
 * of it; so it meets the sheet again, and so on. With M = [front through; through rear] what
 * the sheet does to light from its two sides, all of these turns are M + held M M + held^2 M M
 * M + ... = M (1 - held M)^-1. Shares of light, per lane; those of one side are at most 1
 * together. No phases: the light of unlike turns does not interfere. */

/* Shares of the light that came on the eye's side: sent back there, and to the other side. */
typedef struct SheetLight {
    Spectrum back, through;
} SheetLight;

/* held in [0, 1). What leaves the sheet for good is (1 - held) of this. */
static inline SheetLight sheet_turns(const SheetFaces *sheet, float held) {
    Spectrum one = spectrum_all(1), h = spectrum_all(held), through = h * sheet->through;
    Spectrum rest = (one - h * sheet->front) * (one - h * sheet->rear) - through * through;
    Spectrum determinant = sheet->front * sheet->rear - sheet->through * sheet->through;
    rest = spectrum_max(rest, spectrum_all(1e-12f));
    return (SheetLight){(sheet->front - h * determinant) / rest, sheet->through / rest};
}
