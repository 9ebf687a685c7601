/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/solid_facet.h"

#include "spectrum/fresnel.h"

/* Tables run over the cosine in the medium of the smaller index. */
static void read_coating(const Dielectric *d, const SolidRay *s, float cosine, FacetShares *out)
{
    const CoatingTables *tables = d->coating;
    bool  is_denser_behind = s->eta >= 1;
    float beyond = (1 - cosine * cosine) / (s->eta * s->eta) - 1;
    if (beyond >= 0 && !is_denser_behind) {
        float falls = sqrtf(beyond);
        out->reflected = coating_at(tables->total, d->wavelengths,
                                    falls / (falls + cosine / s->eta));
        out->through = spectrum_all(0);
        return;
    }
    float rarer = is_denser_behind ? cosine : out->behind;
    const CoatingTable *mirror = s->turned ? tables->back : tables->front;
    out->reflected = coating_at(mirror, d->wavelengths, rarer);
    out->through = coating_at(tables->through, d->wavelengths, rarer);
}

/* cosine: to the facet on wo's side; behind: of the refracted direction. */
static FilmCrossing film_crossing(const SolidRay *s, float cosine, float behind)
{
    return s->turned ? (FilmCrossing){behind, cosine, 1 / s->eta} :
                       (FilmCrossing){cosine, behind, s->eta};
}

/* bare: what the facet reflects without the film; out->behind is set. */
static void read_film(const Dielectric *d, const SolidRay *s, float cosine, float bare,
                      FacetShares *out)
{
    FilmCrossing ray = film_crossing(s, cosine, out->behind);
    Spectrum     one = spectrum_all(1), plain = spectrum_all(bare);
    Spectrum     filmed = clear_film_between(&d->film, d->wavelengths, &ray);
    out->reflected = plain + (filmed - plain) * spectrum_all(d->film.share);
    out->through = one - out->reflected;
}

FacetShares solid_facet(const Dielectric *d, const SolidRay *s, float cosine)
{
    FacetShares shares;
    float f = fresnel_mean(fresnel_dielectric(cosine, s->eta, &shares.behind));
    if (d->coating || solid_has_film(d)) {
        if (d->coating) read_coating(d, s, fminf(cosine, 1), &shares);
        else read_film(d, s, cosine, f, &shares);
        shares.prob = reflect_prob(spectrum_mean(shares.reflected),
                                   spectrum_mean(shares.through * d->tint));
        return shares;
    }
    shares.reflected = spectrum_all(f);
    shares.through = spectrum_all(1 - f);
    shares.prob = reflect_prob(f, (1 - f) * spectrum_mean(d->tint));
    return shares;
}

float solid_filmed_lane(const Dielectric *d, const SolidRay *s, int lane, float cosine)
{
    float behind, bare = fresnel_mean(fresnel_dielectric(cosine, s->eta, &behind));
    FilmCrossing ray = film_crossing(s, cosine, behind);
    float filmed = clear_film_lane(&d->film, d->wavelengths->nm[lane], &ray);
    return bare + (filmed - bare) * d->film.share;
}
