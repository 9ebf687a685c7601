/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_facet.h"

/* The bare and the filmed reflectance by the film's share. */
static Spectrum mix_film(const MetallicRoughness *m, Spectrum bare, Spectrum filmed)
{
    return bare + (filmed - bare) * spectrum_all(m->film.share);
}

Spectrum facet_filmed(const MetallicRoughness *m, Spectrum bare, float cosine)
{
    float    f0 = m->energy->ior >= 1 ? fresnel_normal(m->energy->ior) : 1.0f;
    Spectrum tinted = spectrum_min(m->specular_color * spectrum_all(f0), spectrum_all(1));
    Spectrum n = clear_film_body(tinted);
    Spectrum film = clear_film_at(&m->film, m->wavelengths, cosine, n, spectrum_all(0));
    return mix_film(m, bare, film * spectrum_all(m->specular));
}

static Spectrum filmed_metal(const MetallicRoughness *m, Spectrum bare, float cosine)
{
    const OpticalConstants *metal = m->film_metal;
    Spectrum n, k = spectrum_all(0);
    if (metal) k = curve_lookup(&metal->k, m->wavelengths);
    n = metal ? curve_lookup(&metal->n, m->wavelengths) : clear_film_body(m->base_color);
    return mix_film(m, bare, clear_film_at(&m->film, m->wavelengths, cosine, n, k));
}

Spectrum facet_sheet_at(const MetallicRoughness *m, float cosine)
{
    const CoatingTables *sheet = m->coating->sheet;
    return coating_at(m->seen_from_back ? sheet->back : sheet->front, m->wavelengths, cosine);
}

Spectrum facet_coated(const MetallicRoughness *m, float cosine)
{
    Spectrum sum = spectrum_all(0);
    if (coated_face(m))
        sum = coating_at(m->coating->face->front, m->wavelengths, cosine) *
              spectrum_all(m->specular * (1 - m->transmission));
    if (m->transmission > 0) sum += facet_sheet_at(m, cosine) * spectrum_all(m->transmission);
    return sum * spectrum_all(1 - m->metallic);
}

Spectrum facet_metal_at(const MetallicRoughness *m, float cosine)
{
    Spectrum bare = coated_metal(m) ?
                        coating_at(m->coating->metal->front, m->wavelengths, cosine) :
                        fresnel_schlick(m->base_color, cosine);
    return has_film(m) ? filmed_metal(m, bare, cosine) : bare;
}

Spectrum facet_through(const MetallicRoughness *m, const MetallicFace *b, float cosine)
{
    if (coated_sheet(m))
        return coating_at(m->coating->sheet->through, m->wavelengths, cosine) * m->base_color *
               spectrum_all((1 - m->metallic) * m->transmission);
    Spectrum face = facet_reflectance(m, b, cosine);
    return (spectrum_all(1) - sheet_reflectance(face)) * m->base_color *
           spectrum_all((1 - m->metallic) * m->transmission);
}

SheetFaces facet_sheet(const MetallicRoughness *m, const MetallicFace *b, float cosine)
{
    const CoatingTables *sheet = coated_sheet(m);
    SheetFaces faces;
    if (sheet) {
        const CoatingTable *rear = m->seen_from_back ? sheet->front : sheet->back;
        faces.front = facet_sheet_at(m, cosine);
        faces.rear = coating_at(rear, m->wavelengths, cosine);
        faces.through = coating_at(sheet->through, m->wavelengths, cosine) * m->base_color;
        return faces;
    }
    faces.front = faces.rear = sheet_reflectance(facet_reflectance(m, b, cosine));
    faces.through = (spectrum_all(1) - faces.front) * m->base_color;
    return faces;
}
