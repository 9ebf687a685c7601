/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_facet.h"

/* The bare and the filmed reflectance by the film's share. */
static Spectrum mix_film(const MetallicRoughness *m, Spectrum bare, Spectrum filmed) {
    return bare + (filmed - bare) * spectrum_all(m->film.share);
}

/* A clear body that reflects as the base does upright. */
static ClearFilmBody body_of(const MetallicRoughness *m) {
    float f0 = m->energy->ior >= 1 ? fresnel_normal(m->energy->ior) : 1.0f;
    Spectrum tinted = spectrum_min(m->specular_color * spectrum_all(f0), spectrum_all(1));
    return (ClearFilmBody){clear_film_body(tinted), spectrum_all(0)};
}

Spectrum facet_filmed(const MetallicRoughness *m, Spectrum bare, float cosine) {
    ClearFilmBody body = body_of(m);
    Spectrum film = clear_film_at(&m->film, m->wavelengths, cosine, body.n, body.k);
    return mix_film(m, bare, film * spectrum_all(m->specular));
}

/* A face for light polarised s and p: the same curve and ends as their mean has. */
static void face_waves(const MetallicRoughness *m, const MetallicFace *b, float cosine,
                       Spectrum out[2]) {
    float ior = m->energy->ior, f0 = ior > 1 ? fresnel_normal(ior) : 0;
    Fresnel exact = ior > 1 ? fresnel_dielectric(cosine, ior, NULL) : (Fresnel){0, 0};
    float shape[2] = {(exact.s - f0) / (1 - f0), (exact.p - f0) / (1 - f0)};
    for (int i = 0; i < 2; i++)
        out[i] = spectrum_clamp(b->f0 + b->rise * spectrum_all(shape[i]), 0, 1);
    if (!has_film(m)) return;
    ClearFilmBody body = body_of(m);
    Spectrum film[2], specular = spectrum_all(m->specular);
    clear_film_waves(&m->film, m->wavelengths, cosine, &body, film);
    for (int i = 0; i < 2; i++)
        out[i] = mix_film(m, out[i], spectrum_clamp(film[i], 0, 1) * specular);
}

static Spectrum filmed_metal(const MetallicRoughness *m, Spectrum bare, float cosine) {
    const OpticalConstants *metal = m->film_metal;
    Spectrum n, k = spectrum_all(0);
    if (metal) k = curve_lookup(&metal->k, m->wavelengths);
    n = metal ? curve_lookup(&metal->n, m->wavelengths) : clear_film_body(m->base_color);
    return mix_film(m, bare, clear_film_at(&m->film, m->wavelengths, cosine, n, k));
}

static PaneLight pane_from(const MetallicRoughness *m, const MetallicFace *b, float cosine,
                           bool from_rear) {
    Spectrum face[2], t = pane_body(m->tint, cosine, body_ior(m));
    if (coated_sheet(m)) {
        PaneMeeting meeting = {coated_sheet(m), m->wavelengths, cosine,
                               m->seen_from_back == from_rear, t};
        return pane_coated(&meeting);
    }
    face_waves(m, b, cosine, face);
    return pane_between(face[0], face[1], t);
}

PaneLight facet_pane(const MetallicRoughness *m, const MetallicFace *b, float cosine) {
    return pane_from(m, b, cosine, false);
}

Spectrum facet_coated(const MetallicRoughness *m, const MetallicFace *b, float cosine) {
    Spectrum sum = spectrum_all(0);
    if (coated_face(m))
        sum = coating_at(m->coating->face->front, m->wavelengths, cosine) *
              spectrum_all(m->specular * (1 - m->transmission));
    if (m->transmission > 0)
        sum += facet_pane(m, b, cosine).reflected * spectrum_all(m->transmission);
    return sum * spectrum_all(1 - m->metallic);
}

Spectrum facet_metal_at(const MetallicRoughness *m, float cosine) {
    Spectrum bare = coated_metal(m) ? coating_at(m->coating->metal->front, m->wavelengths, cosine)
                                    : fresnel_schlick(m->base_color, cosine);
    return has_film(m) ? filmed_metal(m, bare, cosine) : bare;
}

Spectrum facet_through(const MetallicRoughness *m, const MetallicFace *b, float cosine) {
    return facet_pane(m, b, cosine).passed * spectrum_all(clear_share(m));
}

SheetFaces facet_sheet(const MetallicRoughness *m, const MetallicFace *b, float cosine) {
    PaneLight front = facet_pane(m, b, cosine);
    SheetFaces faces = {front.reflected, front.reflected, front.passed};
    if (coated_sheet(m)) faces.rear = pane_from(m, b, cosine, true).reflected;
    return faces;
}
