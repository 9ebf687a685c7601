/* SPDX-License-Identifier: Apache-2.0 */
/* solid_pane -- a plane-parallel plate of clear solid glass: covers, windows modelled with their
 * thickness. It is no material of its own: where a ray enters a smooth solid (dielectric.c) by
 * a flat face and leaves it by a parallel one, the two are this.
 *
 * Light passes straight, shifted by what the path makes of it, and mirror images show: of the
 * near face, and of all turns inside, which start where the first of them does. All turns are
 * added up as a thin pane's are (layers/pane.h): bare glass for each polarisation by itself,
 * dispersive glass for each lane by itself, coated and filmed faces by their unpolarised
 * shares. Tint is taken at each crossing of a face.
 *
 * Polarised light is followed exactly where glass is bare; coated and filmed glass is taken as
 * bare for how it polarises, and dispersive glass as of one index.
 */
#include "shaders/solid_pane.h"

#include "base/mathf.h"
#include "shaders/polarisation.h"

#define LEAST_ALONG 1e-9f /* m: ghosts are told from the first image by it */

float solid_pane_index(const Dielectric *face) {
    return face->index ? spectrum_mean(curve_lookup(face->index, face->wavelengths)) : face->ior;
}

/* What the body lets through once, on the refracted way. */
static Spectrum body_at(const SolidPlate *plate, float inside) {
    float way = plate->depths / max_f(inside, PANE_LEAST_COSINE);
    return way > 0 ? spectrum_pow(plate->left, way) : spectrum_all(1);
}

/* What two like faces do to one polarisation, or to both alike. */
typedef struct PlateFaces {
    Spectrum near, far; /* reflected outside, inside */
    Spectrum in;        /* what goes through both */
    float share;        /* of the light */
} PlateFaces;

static void add_turns(const PlateFaces *faces, SolidPane *out) {
    Spectrum next = faces->far * faces->far * out->body * out->body;
    Spectrum share = spectrum_all(faces->share);
    Spectrum passed = share * faces->in * out->body * pane_turns(next);
    out->passed += passed;
    out->first += share * faces->near;
    out->ghosts += passed * out->body * faces->far;
    out->turn += faces->share * spectrum_mean(next);
}

static void set_bare(const SolidPlate *plate, SolidPane *out) {
    const Dielectric *d = plate->face;
    Spectrum s, p, one = spectrum_all(1), tint2 = d->tint * d->tint;
    Spectrum n = d->index ? curve_lookup(d->index, d->wavelengths) : spectrum_all(d->ior);
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float behind;
        Fresnel face = fresnel_dielectric(plate->cosine, n[i], &behind);
        s[i] = face.s;
        p[i] = face.p;
        if (d->index) out->body[i] = body_at(plate, behind)[i];
    }
    add_turns(&(PlateFaces){s, s, (one - s) * (one - s) * tint2, 0.5f}, out);
    add_turns(&(PlateFaces){p, p, (one - p) * (one - p) * tint2, 0.5f}, out);
}

void solid_pane_set(const SolidPlate *plate, SolidPane *out) {
    const Dielectric *d = plate->face;
    float ior = solid_pane_index(d);
    Spectrum none = spectrum_all(0);
    *out = (SolidPane){.passed = none,
                       .first = none,
                       .ghosts = none,
                       .along = max_f(2 * plate->sideways, LEAST_ALONG),
                       .ior = ior,
                       .body = body_at(plate, pane_cosine_inside(plate->cosine, ior))};
    if (!d->coating && !solid_has_film(d)) {
        set_bare(plate, out);
        return;
    }
    SolidRay outside = {.eta = d->ior}, inside = {.eta = 1 / d->ior, .turned = true};
    FacetShares near = solid_facet(d, &outside, plate->cosine);
    FacetShares far = solid_facet(d, &inside, near.behind);
    add_turns(&(PlateFaces){near.reflected, far.reflected,
                            near.through * far.through * d->tint * d->tint, 1},
              out);
}

/* Straight on, or one of its images. */
static bool pane_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    const SolidPane *pane = parameters;
    Spectrum part[3] = {pane->first, pane->ghosts,
                        pane->shows_itself ? spectrum_all(0) : pane->passed};
    float share[3], all = 0, place;
    int chosen = 0;
    for (int i = 0; i < 3; i++) all += share[i] = spectrum_mean(part[i]);
    if (!(all > 0)) return false;
    place = u[2] * all;
    while (chosen < 2 && !(place < share[chosen])) place -= share[chosen++];
    if (!(share[chosen] > 0)) return false;
    float prob = share[chosen] / all;
    bool passes = chosen == 2;
    *sample = (BsdfSample){.wi = vec3(-wo.x, -wo.y, passes ? -wo.z : wo.z),
                           .pdf = prob,
                           .is_delta = true,
                           .passes = passes,
                           .along = chosen == 1 ? pane->along : 0,
                           .weight = part[chosen] / spectrum_all(prob)};
    return true;
}

static Spectrum pane_pass(const void *parameters, Vec3 wo) {
    (void)wo;
    return ((const SolidPane *)parameters)->passed;
}

static Spectrum pane_mirror(const void *parameters, Vec3 wo) {
    (void)wo;
    const SolidPane *pane = parameters;
    return pane->first + pane->ghosts;
}

static Spectrum pane_albedo(const void *parameters, Vec3 wo) {
    return pane_mirror(parameters, wo) + pane_pass(parameters, wo);
}

/* Both kinds of image by what they are together. */
static bool pane_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                          BsdfPolarisation *out) {
    const SolidPane *pane = parameters;
    PolarisedParts parts = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    PolarisedPane all = {waves_reflected(clampf(fabsf(wo.z), 0, 1), pane->ior), pane->body,
                         way->passes};
    polarised_add_pane(&parts, &all, spectrum_all(1));
    *out = polarised_of(&parts, spectrum_all(1));
    return true;
}

static void pane_set(void *parameters, const BsdfSetting *setting) {
    if (setting->shows_itself) ((SolidPane *)parameters)->shows_itself = true;
}

const BsdfModel solid_pane_model = {
    .traits = BSDF_IS_SHEET | BSDF_SHOWS_ITSELF,
    .scatter = {.sample = pane_sample, .albedo = pane_albedo},
    .boundary = {.mirror = pane_mirror, .pass = pane_pass},
    .set = pane_set,
    .polarise = pane_polarise,
};
