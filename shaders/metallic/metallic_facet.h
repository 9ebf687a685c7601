/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_facet.h -- what one facet of metallic_roughness reflects and lets through.
 *
 * Asked by the cosine at which light meets the facet, [0, 1]: of the non-metal (solid or a thin
 * sheet), of the metal, each bare, under a thin film or coated. Spectra are shares of light,
 * [0, 1]; those of a part of the surface are times the part's share.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_view.h"
#include "shaders/layers/sheet_turns.h"
#include "spectrum/fresnel.h"

#pragma GCC diagnostic push /* inline: no vector goes from one file to another */
#pragma GCC diagnostic ignored "-Wpsabi"

/* A filmed boundary, whose bare reflectance is known. */
Spectrum facet_filmed(const MetallicRoughness *m, Spectrum bare, float cosine);

/* A coated sheet, from the side that is seen. */
Spectrum facet_sheet_at(const MetallicRoughness *m, float cosine);

/* The non-metal's share, where it is coated. */
Spectrum facet_coated(const MetallicRoughness *m, float cosine);

/* A metal, not times its share. */
Spectrum facet_metal_at(const MetallicRoughness *m, float cosine);

/* Light that the sheet's share lets through a facet met at `cosine`. */
Spectrum facet_through(const MetallicRoughness *m, const MetallicFace *b,
                       float cosine);

/* The sheet's share alone, a facet of it met at `cosine`. */
SheetFaces facet_sheet(const MetallicRoughness *m, const MetallicFace *b, float cosine);

static inline bool has_film(const MetallicRoughness *m)
{
    return m->film.share > 0;
}

static inline float clear_share(const MetallicRoughness *m)
{
    return (1 - m->metallic) * m->transmission;
}

static inline const CoatingTables *coated_metal(const MetallicRoughness *m)
{
    return m->coating ? m->coating->metal : NULL;
}

static inline const CoatingTables *coated_face(const MetallicRoughness *m)
{
    return m->coating ? m->coating->face : NULL;
}

static inline const CoatingTables *coated_sheet(const MetallicRoughness *m)
{
    return m->coating ? m->coating->sheet : NULL;
}

static inline MetallicFace boundary_of(const MetallicRoughness *m)
{
    float    f0 = m->energy->ior >= 1 ? fresnel_normal(m->energy->ior) : 1.0f;
    Spectrum tinted = m->specular_color * spectrum_all(f0);
    MetallicFace b;
    b.f0 = spectrum_min(tinted, spectrum_all(1)) * spectrum_all(m->specular);
    b.rise = spectrum_all(m->specular) - b.f0;
    return b;
}

/* Share of the base's light that a boundary lets pass, for an energy of the table. */
static inline Spectrum let_in(const MetallicFace *b, Energy e)
{
    return spectrum_all(1) - b->f0 * spectrum_all(e.all) - b->rise * spectrum_all(e.shape);
}

static inline Spectrum sheet_reflectance(Spectrum face)
{
    return (face + face) / (spectrum_all(1) + face);
}

static inline Spectrum bare_reflectance(const MetallicRoughness *m, const MetallicFace *b,
                                        float cosine)
{
    return b->f0 + b->rise * spectrum_all(fresnel_shape(m->energy->ior, cosine));
}

static inline Spectrum facet_reflectance(const MetallicRoughness *m, const MetallicFace *b,
                                         float cosine)
{
    Spectrum bare = bare_reflectance(m, b, cosine);
    return has_film(m) ? facet_filmed(m, bare, cosine) : bare;
}

static inline bool has_coated_nonmetal(const MetallicRoughness *m)
{
    return coated_face(m) || coated_sheet(m);
}

/* Reflectance of a facet met at `cosine`, of the non-metal's share, sheet or solid. */
static inline Spectrum facet_of_nonmetal(const MetallicRoughness *m, const MetallicFace *b,
                                         float cosine)
{
    if (!(m->metallic < 1)) return spectrum_all(0);
    if (has_coated_nonmetal(m)) return facet_coated(m, cosine);
    Spectrum face = facet_reflectance(m, b, cosine);
    if (m->transmission > 0)
        face += (sheet_reflectance(face) - face) * spectrum_all(m->transmission);
    return face * spectrum_all(1 - m->metallic);
}

static inline Spectrum facet_of_metal(const MetallicRoughness *m, float cosine)
{
    if (!(m->metallic > 0)) return spectrum_all(0);
    return facet_metal_at(m, cosine) * spectrum_all(m->metallic);
}

#pragma GCC diagnostic pop
