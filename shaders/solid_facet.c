/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/solid_facet.h"

#include "base/mathf.h"
#include "base/units.h"
#include "shaders/facets/microfacet.h"
#include "spectrum/fresnel.h"

/* ---- one facet --------------------------------------------------------------------------- */

/* Tables run over the cosine in the medium of the smaller index. */
static void read_coating(const Dielectric *d, const SolidRay *s, float cosine, FacetShares *out) {
    const CoatingTables *tables = d->coating;
    bool is_denser_behind = s->eta >= 1;
    float beyond = (1 - cosine * cosine) / (s->eta * s->eta) - 1;
    if (beyond >= 0 && !is_denser_behind) {
        float falls = sqrtf(beyond);
        out->reflected =
            coating_at(tables->total, d->wavelengths, falls / (falls + cosine / s->eta));
        out->through = spectrum_all(0);
        return;
    }
    float rarer = is_denser_behind ? cosine : out->behind;
    const CoatingTable *mirror = s->turned ? tables->back : tables->front;
    out->reflected = coating_at(mirror, d->wavelengths, rarer);
    out->through = coating_at(tables->through, d->wavelengths, rarer);
}

/* cosine: to the facet on wo's side; behind: of the refracted direction. */
static FilmCrossing film_crossing(const SolidRay *s, float cosine, float behind) {
    return s->turned ? (FilmCrossing){behind, cosine, 1 / s->eta}
                     : (FilmCrossing){cosine, behind, s->eta};
}

/* bare: what the facet reflects without the film; out->behind is set. */
static void read_film(const Dielectric *d, const SolidRay *s, float cosine, float bare,
                      FacetShares *out) {
    FilmCrossing ray = film_crossing(s, cosine, out->behind);
    Spectrum one = spectrum_all(1), plain = spectrum_all(bare);
    Spectrum filmed = clear_film_between(&d->film, d->wavelengths, &ray);
    out->reflected = plain + (filmed - plain) * spectrum_all(d->film.share);
    out->through = one - out->reflected;
}

FacetShares solid_facet(const Dielectric *d, const SolidRay *s, float cosine) {
    FacetShares shares;
    float f = fresnel_mean(fresnel_dielectric(cosine, s->eta, &shares.behind));
    if (d->coating || solid_has_film(d)) {
        if (d->coating) read_coating(d, s, min_f(cosine, 1), &shares);
        else read_film(d, s, cosine, f, &shares);
        shares.prob =
            reflect_prob(spectrum_mean(shares.reflected), spectrum_mean(shares.through * d->tint));
        return shares;
    }
    shares.reflected = spectrum_all(f);
    shares.through = spectrum_all(1 - f);
    shares.prob = reflect_prob(f, (1 - f) * spectrum_mean(d->tint));
    return shares;
}

float solid_filmed_lane(const Dielectric *d, const SolidRay *s, int lane, float cosine) {
    float behind, bare = fresnel_mean(fresnel_dielectric(cosine, s->eta, &behind));
    FilmCrossing ray = film_crossing(s, cosine, behind);
    float filmed = clear_film_lane(&d->film, d->wavelengths->nm[lane], &ray);
    return bare + (filmed - bare) * d->film.share;
}

/* ---- what facets pass to one another ----------------------------------------------------- */

typedef struct Lost {
    Spectrum share; /* of light from a direction */
    Spectrum mean, across;
} Lost;

static Spectrum over(Spectrum a, Spectrum b) {
    Spectrum quotient;
    for (int i = 0; i < SPECTRUM_LANES; i++) quotient[i] = b[i] > 0 ? a[i] / b[i] : 0;
    return quotient;
}

static Spectrum indices(const Dielectric *d) {
    return d->index ? curve_lookup(d->index, d->wavelengths) : spectrum_all(d->ior);
}

static SolidLost lost_by(const Dielectric *d, const SolidEnergy *energy, bool is_inside, Vec3 w) {
    return solid_is_brushed(d) ? brushed_lost(energy->brushed, is_inside, w, solid_alphas(d))
                               : solid_lost(energy, is_inside, w.z, d->alpha);
}

static LostFacets facets_by(const Dielectric *d, bool is_inside, Vec3 w) {
    return solid_is_brushed(d)
               ? brushed_lost_facets(d->energy->brushed, is_inside, w, solid_alphas(d))
               : solid_lost_facets(d->energy, is_inside, w.z, d->alpha);
}

static LostFacets mean_facets_by(const Dielectric *d, bool is_inside) {
    return solid_is_brushed(d) ? brushed_mean_facets(d->energy->brushed, is_inside, solid_alphas(d))
                               : solid_mean_facets(d->energy, is_inside, d->alpha);
}

/* Losses of bare facets. */
static void lost_lanes(const Dielectric *d, bool is_inside, Vec3 w, Lost *lost, Spectrum *flux) {
    SolidLost loss = lost_by(d, d->energy, is_inside, w), most = loss;
    if (d->index) most = lost_by(d, d->energy_most, is_inside, w);
    Spectrum t = spectrum_all(0);
    if (d->index)
        t = (indices(d) - spectrum_all(d->energy->ior)) /
            spectrum_all(d->energy_most->ior - d->energy->ior);
    lost->share = spectrum_all(loss.lost) + t * spectrum_all(most.lost - loss.lost);
    lost->mean = spectrum_all(loss.mean) + t * spectrum_all(most.mean - loss.mean);
    *flux = spectrum_all(loss.flux) + t * spectrum_all(most.flux - loss.flux);
}

/* By how much facets at facet_cosine differ from bare ones, seen from one side. */
typedef struct FacetChange {
    Spectrum reflected[LOBE_FACETS], through[LOBE_FACETS];
    Spectrum passes; /* what all let through, over what bare ones do */
} FacetChange;

/* The cosine at which light meets a facet that it meets at x in the rarer medium. */
static float met_from(float x, float eta) {
    return eta >= 1 ? x : sqrtf(1 - (1 - x * x) * eta * eta);
}

/* Shares of dispersive glass under its film, and without it. */
static void change_lanes(const Dielectric *d, const SolidRay *s, float x, FacetShares *out,
                         Spectrum *bare) {
    Spectrum n = indices(d);
    SolidRay own = *s;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        own.eta = s->turned ? 1 / n[i] : n[i];
        float cosine = met_from(x, own.eta);
        out->reflected[i] = solid_filmed_lane(d, &own, i, cosine);
        (*bare)[i] = fresnel_unpolarised(cosine, own.eta);
    }
    out->through = spectrum_all(1) - out->reflected;
}

static void change_of(const Dielectric *d, bool is_inside, FacetChange *out) {
    SolidRay s = solid_ray(d, vec3(0, 0, is_inside ? -1 : 1), vec3(0, 0, 1));
    Spectrum passes = spectrum_all(0), plain = passes, one = spectrum_all(1);
    for (int k = 0; k < LOBE_FACETS; k++) {
        float cosine = met_from(facet_cosine[k], s.eta);
        Spectrum bare = spectrum_all(fresnel_unpolarised(cosine, s.eta));
        FacetShares shares = solid_facet(d, &s, cosine);
        if (d->index) change_lanes(d, &s, facet_cosine[k], &shares, &bare);
        out->reflected[k] = shares.reflected - bare;
        out->through[k] = shares.through - (one - bare);
        passes += shares.through * spectrum_all(facet_cosine[k]);
        plain += (one - bare) * spectrum_all(facet_cosine[k]);
    }
    out->passes = passes / plain;
}

static Spectrum changed(const FacetChange *by, LostFacets facets) {
    Spectrum sum = spectrum_all(0);
    for (int k = 0; k < LOBE_FACETS; k++)
        sum += by->reflected[k] * spectrum_all(facets.reflected[k]) +
               by->through[k] * spectrum_all(facets.through[k]);
    return sum;
}

static Spectrum changed_mean(const Dielectric *d, bool is_inside, const FacetChange *by) {
    SolidLost bare = lost_by(d, d->energy, is_inside, vec3(0, 0, 1));
    Spectrum mean = spectrum_all(bare.mean) + changed(by, mean_facets_by(d, is_inside));
    return spectrum_max(mean, spectrum_all(0));
}

/* Changes on both sides of a boundary, outside, inside. A film changes both alike: along one
 * ray it reflects as much from either side. NULL: the boundary is bare. */
static const FacetChange *changes_of(const Dielectric *d, FacetChange space[2]) {
    if (!d->coating && !solid_has_film(d)) return NULL;
    change_of(d, false, &space[0]);
    if (d->coating) change_of(d, true, &space[1]);
    else space[1] = space[0];
    return space;
}

/* Neither side can let more across than it loses. */
static void change_lost(const Dielectric *d, bool is_inside, Vec3 w, const FacetChange *changes,
                        Lost *lost, Spectrum *flux) {
    const FacetChange *here = &changes[is_inside];
    Spectrum other = changed_mean(d, !is_inside, &changes[!is_inside]), n = indices(d);
    LostFacets facets = facets_by(d, is_inside, w);
    lost->share = spectrum_clamp(lost->share + changed(here, facets), 0, 1);
    lost->mean = changed_mean(d, is_inside, here);
    Spectrum outside = is_inside ? other : lost->mean, inside = is_inside ? lost->mean : other;
    *flux = spectrum_min(*flux * here->passes, spectrum_min(outside, inside * n * n));
}

/* w: seen from the side that it is on, inside the solid or outside. */
static Lost lost_on(const Dielectric *d, bool is_inside, Vec3 w, const FacetChange *changes) {
    Lost lost;
    Spectrum flux, n = indices(d);
    lost_lanes(d, is_inside, w, &lost, &flux);
    if (changes) change_lost(d, is_inside, w, changes, &lost, &flux);
    lost.across = over(is_inside ? over(flux, n * n) : flux, lost.mean);
    return lost;
}

/* Probability of choosing this light, and of sending it across then. */
typedef struct LostChance {
    float any, across;
} LostChance;

static LostChance lost_chance(const Dielectric *d, const Lost *lost) {
    float across = spectrum_mean(lost->across * d->tint);
    float back = spectrum_mean(spectrum_all(1) - lost->across);
    if (!(across + back > 0)) return (LostChance){0, 0};
    return (LostChance){spectrum_mean(lost->share), across / (across + back)};
}

void solid_loss_add(const Dielectric *d, const SolidRay *s, Spectrum *value, float *pdf) {
    bool goes_across = s->wi.z < 0;
    Vec3 above = vec3(s->wi.x, s->wi.y, fabsf(s->wi.z));
    FacetChange space[2];
    const FacetChange *changes = changes_of(d, space);
    Lost from = lost_on(d, s->turned, s->wo, changes);
    Lost to = lost_on(d, s->turned != goes_across, above, changes);
    LostChance chance = lost_chance(d, &from);
    Spectrum way = goes_across ? from.across * d->tint : spectrum_all(1) - from.across;
    Spectrum spread = over(from.share * way * to.share, to.mean) * spectrum_all(INV_PI_F);
    Spectrum n = indices(d), n2 = n * n;
    if (goes_across) spread = s->turned ? spread * n2 : over(spread, n2);
    *value += spread;
    *pdf =
        lerpf(*pdf, (goes_across ? chance.across : 1 - chance.across) * fabsf(s->wi.z) * INV_PI_F,
              chance.any);
}

bool solid_loss_sample(const Dielectric *d, SolidRay *s, float u[3]) {
    FacetChange space[2];
    Lost lost = lost_on(d, s->turned, s->wo, changes_of(d, space));
    LostChance chance = lost_chance(d, &lost);
    if (u[2] >= chance.any) {
        u[2] = min_f((u[2] - chance.any) / (1 - chance.any), 0x1.fffffep-1f);
        return false;
    }
    s->wi = microfacet_cosine(u[0], u[1]);
    if (u[2] < chance.any * chance.across) s->wi.z = -s->wi.z;
    return true;
}
