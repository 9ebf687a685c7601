/* thin_window and dielectric -- clear glass and clear plastic.
 *
 * thin_window: windscreens, side windows, instrument covers: a smooth sheet modelled without
 * thickness. Light passes straight (shadow rays pass too), and a mirror image shows on it.
 *   ior    1 and up, glTF's default 1.5; window glass 1.52
 *   tint   0..1 a wavelength; green-tinted laminated glass about 0.85 at 550 nm
 *   coating  a stack of thin layers on one face or both (PARHELION_coating)
 * Per polarisation R = 2r/(1+r) and T = (1-r)/(1+r) with r one face's exact Fresnel
 * reflectance, both averaged over the polarisations: all reflections between the faces are in
 * it, interference is not. The tint multiplies T once and does not act on R.
 *
 * dielectric: lenses, light guides, thick covers, bottles: the boundary of a closed solid.
 *   ior    above 0, inside against outside; acrylic 1.49, polycarbonate 1.585, water 1.33
 *   tint   0..1 a wavelength, of transmitted light at each crossing; default 1
 *   alpha  0..1 GGX; below 0.001 smooth; frosted covers about 0.1 to 0.3
 *   alpha_along  0.001..1, default none: brushed; alpha along the frame's x, then `alpha` is
 *          across it (KHR_materials_anisotropy)
 *   coating  a stack of thin layers on the boundary (PARHELION_coating)
 *   film   a clear film of some 100 nm on the share `share` of it (KHR_materials_iridescence):
 *          soap 1.33, iridescent glass 1.8 to 2.4
 *   index    ior by wavelength (dispersion): crown glass 1.522 at 486 nm, 1.514 at 656 nm;
 *            flint and diamond spread white light two and three times as far
 * Exact unpolarised Fresnel reflectance; rough boundaries after Walter et al. 2007 with
 * height-correlated shadowing. Radiance grows by (n_eye side / n_light side)^2 on crossing
 * (light is squeezed into a narrower cone); a path in and out of a solid has 1 in all.
 *
 * A coating interferes with itself (spectrum/thin_film.h), the two faces of a sheet do not. Its
 * R and T at every angle and wavelength stand in for Fresnel's; what is neither, it absorbs.
 * Typical: MgF2 on glass reflects 1.3 % a face, four layers 0.1 %, silver between two oxides
 * 19 % and absorbs 4 %.
 *
 * A film (clear_film.h) takes nothing: what it does not reflect goes through, as much from
 * inside as from outside along one ray, and total reflection stays total. It is exact at every
 * wavelength and angle, also on facets and on glass that parts light. A soap bubble is a solid
 * of index 1 with a film of 1.33.
 *
 * Where the index differs by wavelength each lane is a boundary of its own. One lane is drawn,
 * by what the lanes still count, and is asked where it goes. A mirror sends all of them there.
 * Refraction sends each elsewhere: a smooth boundary goes on with the drawn one alone, divided
 * by its chance (straight through, with all); of a rough one all lanes go on that may have been
 * sent there, by the balance heuristic over them (Veach 1997, 9.2.2): eval over the mean
 * density.
 *
 * Polarised light is followed exactly where glass is bare; coated and filmed glass is taken as
 * bare for how it polarises, and glass that parts light as of one index.
 *
 * What rough facets pass to one another comes out of the boundary without a direction of its
 * own, on both sides (solid_energy.h): a clear solid of any roughness returns what it gets,
 * within 0.2 % (brushed: TODO). Without that it would lose up to a third at alpha 1.
 *
 * Not modelled: sheen. A boundary between equal indices, filmed or not, is smooth.
 */
#include "shaders/dielectric.h"

#include "base/units.h"
#include "spectrum/fresnel.h"
#include "shaders/brushed.h"
#include "shaders/polarisation.h"

static Fresnel window_face(const ThinWindow *window, float cosine)
{
    return fresnel_dielectric(clampf(cosine, 0, 1), window->ior, NULL);
}

Spectrum thin_window_reflectance(const ThinWindow *window, float cosine)
{
    if (window->reflectance)
        return coating_at(window->reflectance, window->wavelengths, clampf(cosine, 0, 1));
    return spectrum_all(fresnel_slab(window_face(window, cosine)));
}

Spectrum thin_window_transmittance(const ThinWindow *window, float cosine)
{
    if (window->transmittance)
        return window->tint *
               coating_at(window->transmittance, window->wavelengths, clampf(cosine, 0, 1));
    return window->tint * spectrum_all(1 - fresnel_slab(window_face(window, cosine)));
}

static bool straight_on(Vec3 wo, float prob, Spectrum weight, BsdfSample *sample)
{
    *sample = (BsdfSample){.wi = vec3_neg(wo), .pdf = prob, .is_delta = true, .passes = true,
                           .weight = weight};
    return true;
}

static bool mirrored(Vec3 wo, float prob, Spectrum weight, BsdfSample *sample)
{
    *sample = (BsdfSample){.wi = vec3(-wo.x, -wo.y, wo.z), .pdf = prob, .is_delta = true,
                           .weight = weight};
    return true;
}

static bool coated_window_sample(const ThinWindow *window, Vec3 wo, float u, BsdfSample *sample)
{
    Spectrum reflected = thin_window_reflectance(window, fabsf(wo.z));
    Spectrum through = thin_window_transmittance(window, fabsf(wo.z));
    float    share = spectrum_mean(reflected), all = share + spectrum_mean(through);
    if (!(all > 0)) return false;
    float prob = share / all;
    if (u < prob) return mirrored(wo, prob, reflected / spectrum_all(prob), sample);
    return prob < 1 && straight_on(wo, 1 - prob, through / spectrum_all(1 - prob), sample);
}

static bool window_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample)
{
    const ThinWindow *window = parameters;
    if (window->reflectance) return coated_window_sample(window, wo, u[2], sample);
    float cosine = fabsf(wo.z);
    float reflected = fresnel_slab(window_face(window, cosine));
    float through = (1 - reflected) * spectrum_mean(window->tint);
    if (!(reflected + through > 0)) return false;
    float prob = reflected / (reflected + through);
    if (u[2] < prob) return mirrored(wo, prob, spectrum_all(reflected / prob), sample);
    if (!(through > 0)) return false;
    return straight_on(wo, 1 - prob, window->tint * spectrum_all((1 - reflected) / (1 - prob)),
                       sample);
}

static Spectrum window_pass(const void *parameters, Vec3 wo)
{
    return thin_window_transmittance(parameters, fabsf(wo.z));
}

static Spectrum window_mirror(const void *parameters, Vec3 wo)
{
    return thin_window_reflectance(parameters, fabsf(wo.z));
}

static Spectrum window_albedo(const void *parameters, Vec3 wo)
{
    return thin_window_reflectance(parameters, fabsf(wo.z)) +
           thin_window_transmittance(parameters, fabsf(wo.z));
}

static bool window_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                            BsdfPolarisation *out)
{
    const ThinWindow *window = parameters;
    Waves face = waves_reflected(clampf(fabsf(wo.z), 0, 1), window->ior);
    *out = polarised_by(way->passes ? waves_sheet_through(face) : waves_sheet_reflected(face));
    return true;
}

const BsdfModel thin_window_model = {.sample = window_sample, .pass = window_pass,
                                     .mirror = window_mirror, .albedo = window_albedo,
                                     .polarise = window_polarise};

/* Directions as seen from wo's side: z > 0 is that side; eta is the other side's index over
 * this side's. */
typedef struct Side {
    Vec3  wo, wi;
    float eta;
    bool  turned;
} Side;

static Side side_of(const Dielectric *d, Vec3 wo, Vec3 wi)
{
    if (wo.z > 0) return (Side){wo, wi, d->ior, false};
    float eta = d->ior > 0 ? 1 / d->ior : 0; /* index 0 reflects everything (glTF) */
    return (Side){vec3(wo.x, wo.y, -wo.z), vec3(wi.x, wi.y, -wi.z), eta, true};
}

/* Facets between equal media bend nothing, and would have no half-way normal to be found by. */
static bool is_delta(const Dielectric *d)
{
    return is_smooth(d->alpha) || fabsf(d->ior - 1) < 1e-4f;
}

/* ---- facets: even, or brushed -------------------------------------------------------- */

static inline bool is_brushed(const Dielectric *d)
{
    return d->alpha_along > 0;
}

static inline Vec2 alphas(const Dielectric *d)
{
    return (Vec2){d->alpha_along, d->alpha};
}

static inline float facets_send(const Dielectric *d, const Side *s, Vec3 half)
{
    return is_brushed(d) ? brushed_reflection(s->wo, s->wi, half, alphas(d)) :
                           ggx_reflection(s->wo, s->wi, half, d->alpha);
}

static inline float facet_pdf(const Dielectric *d, Vec3 wo, Vec3 half)
{
    return is_brushed(d) ? brushed_visible_pdf(wo, half, alphas(d)) :
                           ggx_visible_pdf(wo, half, d->alpha);
}

static inline Vec3 sample_facet(const Dielectric *d, Vec3 wo, const float u[3])
{
    return is_brushed(d) ? brushed_sample_visible(wo, alphas(d), u[0], u[1]) :
                           ggx_sample_visible(wo, d->alpha, u[0], u[1]);
}

/* ---- what one facet reflects ----------------------------------------------------------- */

/* A facet as light from wo finds it. */
typedef struct FacetShares {
    Spectrum reflected, through; /* the tint left out */
    float    prob;               /* of choosing to reflect: its share of the mean light */
    float    behind;             /* cosine of the refracted direction, 0: there is none */
} FacetShares;

static float reflect_prob(float reflected, float through)
{
    return reflected + through > 0 ? reflected / (reflected + through) : 0;
}

/* Tables run over the cosine in the medium of the smaller index. */
static void read_coating(const Dielectric *d, const Side *s, float cosine, FacetShares *out)
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

static inline bool has_film(const Dielectric *d)
{
    return d->film.share > 0;
}

/* cosine: to the facet on wo's side; behind: of the refracted direction. */
static FilmCrossing film_crossing(const Side *s, float cosine, float behind)
{
    return s->turned ? (FilmCrossing){behind, cosine, 1 / s->eta} :
                       (FilmCrossing){cosine, behind, s->eta};
}

/* bare: what the facet reflects without the film; out->behind is set. */
static void read_film(const Dielectric *d, const Side *s, float cosine, float bare,
                      FacetShares *out)
{
    FilmCrossing ray = film_crossing(s, cosine, out->behind);
    Spectrum     one = spectrum_all(1), plain = spectrum_all(bare);
    Spectrum     filmed = clear_film_between(&d->film, d->wavelengths, &ray);
    out->reflected = plain + (filmed - plain) * spectrum_all(d->film.share);
    out->through = one - out->reflected;
}

static FacetShares facet_shares(const Dielectric *d, const Side *s, float cosine)
{
    FacetShares shares;
    float f = fresnel_mean(fresnel_dielectric(cosine, s->eta, &shares.behind));
    if (d->coating || has_film(d)) {
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

static Spectrum eval_reflected(const Dielectric *d, const Side *s, float *pdf)
{
    Vec3  half = vec3_normalize(vec3_add(s->wo, s->wi));
    float cosine = vec3_dot(s->wo, half);
    FacetShares f = facet_shares(d, s, cosine);
    *pdf = f.prob * facet_pdf(d, s->wo, half) / (4 * cosine);
    return f.reflected * spectrum_all(facets_send(d, s, half));
}

/* Walter 2007, equations 16, 17 and 21 for wo + eta wi along the facet's normal, with the
 * factor 1/eta^2 of radiance: f = |wi.h| |wo.h| T G D / (|wo.z| |wi.z| (wo.h + eta wi.h)^2). */
static Spectrum eval_transmitted(const Dielectric *d, const Side *s, float *pdf)
{
    Vec3 half = vec3_normalize(vec3_along(s->wo, s->wi, s->eta));
    if (half.z < 0) half = vec3_neg(half);
    float out = vec3_dot(s->wo, half), in = vec3_dot(s->wi, half);
    *pdf = 0;
    if (!(out > 0 && in < 0)) return spectrum_all(0);
    float root = out + s->eta * in;
    float spread = -in / (root * root);
    if (!(spread <= 3e38f)) return spectrum_all(0);
    FacetShares f = facet_shares(d, s, out);
    *pdf = (1 - f.prob) * facet_pdf(d, s->wo, half) * s->eta * s->eta * spread;
    /* facets_send is D G2 / (4 zo zi). */
    Spectrum lobe = spectrum_all(4 * facets_send(d, s, half));
    return d->tint * (f.through * lobe * spectrum_all(out) * spectrum_all(spread));
}

static Vec3 turn_back(const Side *s, Vec3 wi)
{
    return s->turned ? vec3(wi.x, wi.y, -wi.z) : wi;
}

static void smooth_part(const Dielectric *d, const Side *s, bool reflects,
                        const FacetShares *f, BsdfSample *sample)
{
    float    prob = reflects ? f->prob : 1 - f->prob;
    Spectrum share = reflects ? f->reflected / spectrum_all(prob) :
                                f->through / spectrum_all(prob * s->eta * s->eta);
    *sample = (BsdfSample){.wi = turn_back(s, s->wi), .pdf = prob, .is_delta = true,
                           .weight = share};
    if (!reflects) sample->weight *= d->tint;
}

/* ---- dispersion ------------------------------------------------------------------------- */

/* A smooth boundary or a facet for every lane, or the like. */
typedef struct LaneFacets {
    Spectrum chance;   /* of each lane to be drawn */
    Spectrum eta;      /* the other side's index over this side's */
    Spectrum mirror;   /* Fresnel's share */
    Spectrum reflects; /* how probably it is reflected, where the lane is drawn */
    float    behind[SPECTRUM_LANES]; /* cosines of the refracted directions */
} LaneFacets;

static float lane_reflects(float mirror, float tint)
{
    return reflect_prob(mirror, (1 - mirror) * tint);
}

/* What a filmed facet reflects of one lane, at that lane's s->eta. */
static float filmed_lane(const Dielectric *d, const Side *s, int lane, float cosine)
{
    float behind, bare = fresnel_mean(fresnel_dielectric(cosine, s->eta, &behind));
    FilmCrossing ray = film_crossing(s, cosine, behind);
    float filmed = clear_film_lane(&d->film, d->wavelengths->nm[lane], &ray);
    return bare + (filmed - bare) * d->film.share;
}

/* The film's shares in place of the bare ones. */
static void film_lanes(const Dielectric *d, Side s, float cosine, LaneFacets *lanes)
{
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        s.eta = lanes->eta[i];
        lanes->mirror[i] = filmed_lane(d, &s, i, cosine);
        lanes->reflects[i] = lane_reflects(lanes->mirror[i], d->tint[i]);
    }
}

/* cosine: to the facet. */
static void meet_lanes(const Dielectric *d, const Side *s, float cosine, LaneFacets *out)
{
    Spectrum n = curve_lookup(d->index, d->wavelengths);
    out->chance = d->light ? *d->light / spectrum_all(spectrum_sum(*d->light)) :
                             spectrum_all(1.0f / SPECTRUM_LANES);
    out->eta = s->turned ? spectrum_all(1) / n : n;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float f = fresnel_mean(fresnel_dielectric(cosine, out->eta[i], &out->behind[i]));
        out->mirror[i] = f;
        out->reflects[i] = lane_reflects(f, d->tint[i]);
    }
    if (has_film(d)) film_lanes(d, *s, cosine, out);
}

/* Which lane's strip of [0, the sum) the place lies on; it becomes the place in the strip. */
static int lane_at(Spectrum strips, float *place)
{
    int last = 0;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        if (!(strips[i] > 0)) continue;
        last = i;
        if (*place < strips[i]) break;
        *place -= strips[i];
    }
    *place = clampf(*place / strips[last], 0, 0x1.fffffep-1f);
    return last;
}

/* One lane's facet, refracting: f, and the density if that lane is drawn (eval_transmitted). */
static float lane_transmitted(const Dielectric *d, const Side *s, int lane, float *pdf)
{
    Vec3 half = vec3_normalize(vec3_along(s->wo, s->wi, s->eta));
    if (half.z < 0) half = vec3_neg(half);
    float out = vec3_dot(s->wo, half), in = vec3_dot(s->wi, half);
    *pdf = 0;
    if (!(out > 0 && in < 0)) return 0;
    float root = out + s->eta * in;
    float spread = -in / (root * root);
    if (!(spread <= 3e38f)) return 0;
    float tint = d->tint[lane];
    float f = has_film(d) ? filmed_lane(d, s, lane, out) : fresnel_unpolarised(out, s->eta);
    *pdf = (1 - lane_reflects(f, tint)) * facet_pdf(d, s->wo, half) * s->eta * s->eta * spread;
    return tint * (1 - f) * 4 * facets_send(d, s, half) * out * spread;
}

static Spectrum split_eval(const Dielectric *d, Side s, float *pdf)
{
    LaneFacets lanes;
    if (s.wi.z > 0) {
        Vec3  half = vec3_normalize(vec3_add(s.wo, s.wi));
        float cosine = vec3_dot(s.wo, half);
        meet_lanes(d, &s, cosine, &lanes);
        *pdf = spectrum_sum(lanes.chance * lanes.reflects) * facet_pdf(d, s.wo, half) /
               (4 * cosine);
        return lanes.mirror * spectrum_all(facets_send(d, &s, half));
    }
    Spectrum value;
    meet_lanes(d, &s, s.wo.z, &lanes);
    *pdf = 0;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float own;
        s.eta = lanes.eta[i];
        value[i] = lane_transmitted(d, &s, i, &own);
        *pdf += lanes.chance[i] * own;
    }
    return value;
}

/* Met straight on, no lane is bent away from the others. */
static bool is_straight(Vec3 wo)
{
    return wo.x * wo.x + wo.y * wo.y < 1e-12f;
}

static bool split_smooth(const Dielectric *d, Side *s, float u, BsdfSample *sample)
{
    LaneFacets lanes;
    meet_lanes(d, s, s->wo.z, &lanes);
    Spectrum one = spectrum_all(1), refracts = lanes.chance * (one - lanes.reflects);
    Spectrum through = (one - lanes.mirror) * d->tint / (lanes.eta * lanes.eta);
    float    turned_back = spectrum_sum(lanes.chance * lanes.reflects);
    float    goes_on = spectrum_sum(refracts), place = u * (turned_back + goes_on);
    *sample = (BsdfSample){.is_delta = true};
    if (place < turned_back) {
        sample->wi = turn_back(s, vec3(-s->wo.x, -s->wo.y, s->wo.z));
        sample->pdf = turned_back;
        sample->weight = lanes.mirror / spectrum_all(turned_back);
        return true;
    }
    if (!(goes_on > 0)) return false;
    place -= turned_back;
    int   lane = lane_at(refracts, &place);
    Vec3  up = vec3(0, 0, 1);
    float eta = lanes.eta[lane];
    sample->wi = turn_back(s, vec3_normalize(refracted(s->wo, up, eta, s->wo.z,
                                                     lanes.behind[lane])));
    sample->pdf = is_straight(s->wo) ? goes_on : refracts[lane];
    sample->weight = spectrum_all(0);
    if (is_straight(s->wo)) sample->weight = through / spectrum_all(goes_on);
    else sample->weight[lane] = through[lane] / refracts[lane];
    return true;
}

/* Draws a lane, and whether it is reflected by a facet met at that cosine. */
static bool lane_choice(const Dielectric *d, const Side *s, float cosine, float u, float *eta,
                        float *behind)
{
    LaneFacets lanes;
    meet_lanes(d, s, cosine, &lanes);
    int lane = lane_at(lanes.chance, &u);
    *eta = lanes.eta[lane];
    *behind = lanes.behind[lane];
    return u < lanes.reflects[lane];
}

/* ---- what facets pass to one another ----------------------------------------------------- */

typedef struct Lost {
    Spectrum share; /* of light from a direction */
    Spectrum mean, across;
} Lost;

static Spectrum over(Spectrum a, Spectrum b)
{
    Spectrum quotient;
    for (int i = 0; i < SPECTRUM_LANES; i++) quotient[i] = b[i] > 0 ? a[i] / b[i] : 0;
    return quotient;
}

static Spectrum indices(const Dielectric *d)
{
    return d->index ? curve_lookup(d->index, d->wavelengths) : spectrum_all(d->ior);
}

/* Brushed facets are taken for even ones of their mean roughness. */
static float lost_alpha(const Dielectric *d)
{
    return is_brushed(d) ? sqrtf(d->alpha * d->alpha_along) : d->alpha;
}

/* Of bare facets. */
static void lost_lanes(const Dielectric *d, bool is_inside, float cosine, Lost *lost,
                       Spectrum *flux)
{
    SolidLoss loss = solid_loss(d->energy, is_inside, cosine, lost_alpha(d));
    SolidLoss most = d->index ? solid_loss(d->energy_most, is_inside, cosine, lost_alpha(d)) : loss;
    Spectrum  t = spectrum_all(0);
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

/* Where a facet is met that the light in the rarer medium meets at x. */
static float met_from(float x, float eta)
{
    return eta >= 1 ? x : sqrtf(1 - (1 - x * x) * eta * eta);
}

/* Of glass that parts light, by its film. */
static void change_lanes(const Dielectric *d, const Side *s, float x, FacetShares *out,
                         Spectrum *bare)
{
    Spectrum n = indices(d);
    Side     own = *s;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        own.eta = s->turned ? 1 / n[i] : n[i];
        float cosine = met_from(x, own.eta);
        out->reflected[i] = filmed_lane(d, &own, i, cosine);
        (*bare)[i] = fresnel_unpolarised(cosine, own.eta);
    }
    out->through = spectrum_all(1) - out->reflected;
}

static FacetChange change_of(const Dielectric *d, bool is_inside)
{
    Side        s = side_of(d, vec3(0, 0, is_inside ? -1 : 1), vec3(0, 0, 1));
    FacetChange change;
    Spectrum    passes = spectrum_all(0), plain = passes, one = spectrum_all(1);
    for (int k = 0; k < LOBE_FACETS; k++) {
        float       cosine = met_from(facet_cosine[k], s.eta);
        Spectrum    bare = spectrum_all(fresnel_unpolarised(cosine, s.eta));
        FacetShares shares = facet_shares(d, &s, cosine);
        if (d->index) change_lanes(d, &s, facet_cosine[k], &shares, &bare);
        change.reflected[k] = shares.reflected - bare;
        change.through[k] = shares.through - (one - bare);
        passes += shares.through * spectrum_all(facet_cosine[k]);
        plain += (one - bare) * spectrum_all(facet_cosine[k]);
    }
    change.passes = passes / plain;
    return change;
}

static Spectrum changed(const FacetChange *by, LostFacets facets)
{
    Spectrum sum = spectrum_all(0);
    for (int k = 0; k < LOBE_FACETS; k++)
        sum += by->reflected[k] * spectrum_all(facets.reflected[k]) +
               by->through[k] * spectrum_all(facets.through[k]);
    return sum;
}

static Spectrum changed_mean(const Dielectric *d, bool is_inside, const FacetChange *by)
{
    SolidLoss bare = solid_loss(d->energy, is_inside, 1, lost_alpha(d));
    Spectrum  mean = spectrum_all(bare.mean) +
                     changed(by, solid_mean_facets(d->energy, is_inside, lost_alpha(d)));
    return spectrum_max(mean, spectrum_all(0));
}

/* Of a boundary that is not bare. Neither side can let more across than it loses. */
static void change_lost(const Dielectric *d, bool is_inside, float cosine, Lost *lost,
                        Spectrum *flux)
{
    FacetChange here = change_of(d, is_inside), beyond = change_of(d, !is_inside);
    Spectrum    other = changed_mean(d, !is_inside, &beyond);
    LostFacets  facets = solid_lost_facets(d->energy, is_inside, cosine, lost_alpha(d));
    lost->share = spectrum_clamp(lost->share + changed(&here, facets), 0, 1);
    lost->mean = changed_mean(d, is_inside, &here);
    Spectrum n = indices(d), outside = is_inside ? other : lost->mean;
    Spectrum inside = is_inside ? lost->mean : other;
    *flux = spectrum_min(*flux * here.passes, spectrum_min(outside, inside * n * n));
}

/* cosine: to the normal, on the side inside the solid or outside. */
static Lost lost_on(const Dielectric *d, bool is_inside, float cosine)
{
    Lost     lost;
    Spectrum flux, n = indices(d);
    lost_lanes(d, is_inside, cosine, &lost, &flux);
    if (d->coating || has_film(d)) change_lost(d, is_inside, cosine, &lost, &flux);
    lost.across = over(is_inside ? over(flux, n * n) : flux, lost.mean);
    return lost;
}

/* What of it is chosen, and of that what goes across. */
typedef struct LostChance {
    float any, across;
} LostChance;

static LostChance lost_chance(const Dielectric *d, const Lost *lost)
{
    float across = spectrum_mean(lost->across * d->tint);
    float back = spectrum_mean(spectrum_all(1) - lost->across);
    if (!(across + back > 0)) return (LostChance){0, 0};
    return (LostChance){spectrum_mean(lost->share), across / (across + back)};
}

/* Adds to what single facets do. */
static void add_lost(const Dielectric *d, const Side *s, Spectrum *value, float *pdf)
{
    bool goes_across = s->wi.z < 0;
    Lost from = lost_on(d, s->turned, s->wo.z);
    Lost to = lost_on(d, s->turned != goes_across, fabsf(s->wi.z));
    LostChance chance = lost_chance(d, &from);
    Spectrum way = goes_across ? from.across * d->tint : spectrum_all(1) - from.across;
    Spectrum spread = over(from.share * way * to.share, to.mean) * spectrum_all(INV_PI_F);
    Spectrum n = indices(d), n2 = n * n;
    if (goes_across) spread = s->turned ? spread * n2 : over(spread, n2);
    *value += spread;
    *pdf = lerpf(*pdf, (goes_across ? chance.across : 1 - chance.across) * fabsf(s->wi.z) *
                           INV_PI_F, chance.any);
}

/* A direction of what is lost, if u[2] falls on its share; else u[2] becomes what is left. */
static bool lost_sample(const Dielectric *d, Side *s, float u[3])
{
    Lost       lost = lost_on(d, s->turned, s->wo.z);
    LostChance chance = lost_chance(d, &lost);
    if (u[2] >= chance.any) {
        u[2] = fminf((u[2] - chance.any) / (1 - chance.any), 0x1.fffffep-1f);
        return false;
    }
    s->wi = microfacet_cosine(u[0], u[1]);
    if (u[2] < chance.any * chance.across) s->wi.z = -s->wi.z;
    return true;
}

/* ---- the model -------------------------------------------------------------------------- */

/* Of a rough boundary. */
static Spectrum rough_eval(const Dielectric *d, const Side *s, float *pdf)
{
    Spectrum value = d->index      ? split_eval(d, *s, pdf) :
                     s->wi.z > 0   ? eval_reflected(d, s, pdf) :
                                     eval_transmitted(d, s, pdf);
    if (d->energy) add_lost(d, s, &value, pdf);
    return value;
}

static Spectrum solid_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf)
{
    const Dielectric *d = parameters;
    *pdf = 0;
    if (is_delta(d) || wo.z == 0 || wi.z == 0) return spectrum_all(0);
    Side s = side_of(d, wo, wi);
    return rough_eval(d, &s, pdf);
}

/* Of one index. */
static bool smooth_sample(const Dielectric *d, Side *s, float u, BsdfSample *sample)
{
    FacetShares f = facet_shares(d, s, s->wo.z);
    bool reflects = u < f.prob;
    if (!reflects && !(f.behind > 0 && f.prob < 1)) return false;
    Vec3 up = vec3(0, 0, 1);
    s->wi = reflects ? vec3(-s->wo.x, -s->wo.y, s->wo.z) :
                       vec3_normalize(refracted(s->wo, up, s->eta, s->wo.z, f.behind));
    if (!(reflects ? s->wi.z > 0 : s->wi.z < 0)) return false;
    smooth_part(d, s, reflects, &f, sample);
    return true;
}

/* What a facet of a rough boundary does, u[2] its choice: of one index, or of a lane. */
static bool facet_sample(const Dielectric *d, Side *s, const float u[3])
{
    Vec3  half = sample_facet(d, s->wo, u);
    float cosine = vec3_dot(s->wo, half), behind, eta = s->eta;
    bool  reflects;
    if (!(cosine > 0)) return false;
    if (d->index) {
        reflects = lane_choice(d, s, cosine, u[2], &eta, &behind);
    } else {
        FacetShares f = facet_shares(d, s, cosine);
        reflects = u[2] < f.prob;
        behind = f.behind;
    }
    if (!reflects && !(behind > 0)) return false;
    s->wi = reflects ? vec3_sub(vec3_scale(half, 2 * cosine), s->wo) :
                       vec3_normalize(refracted(s->wo, half, eta, cosine, behind));
    return reflects ? s->wi.z > 0 : s->wi.z < 0;
}

static bool rough_sample(const Dielectric *d, Side *s, const float u[3], BsdfSample *sample)
{
    float v[3] = {u[0], u[1], u[2]}, pdf;
    bool  is_lost = d->energy && lost_sample(d, s, v);
    if (!is_lost && !facet_sample(d, s, v)) return false;
    Spectrum value = rough_eval(d, s, &pdf);
    if (!(pdf > 0)) return false;
    *sample = (BsdfSample){.wi = turn_back(s, s->wi), .pdf = pdf,
                           .weight = value * spectrum_all(fabsf(s->wi.z) / pdf)};
    return true;
}

static bool solid_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample)
{
    const Dielectric *d = parameters;
    if (wo.z == 0) return false;
    Side s = side_of(d, wo, wo);
    if (!is_delta(d)) return rough_sample(d, &s, u, sample);
    return d->index ? split_smooth(d, &s, u[2], sample) :
                      smooth_sample(d, &s, u[2], sample);
}

static bool solid_scatters(const void *parameters)
{
    return !is_delta(parameters);
}

static Spectrum solid_mirror(const void *parameters, Vec3 wo)
{
    const Dielectric *d = parameters;
    if (!is_delta(d) || wo.z == 0) return spectrum_all(0);
    Side s = side_of(d, wo, wo);
    if (d->index) {
        LaneFacets lanes;
        meet_lanes(d, &s, s.wo.z, &lanes);
        return lanes.mirror;
    }
    return facet_shares(d, &s, s.wo.z).reflected;
}

static Spectrum solid_albedo(const void *parameters, Vec3 wo)
{
    const Dielectric *d = parameters;
    if (!d->coating || wo.z == 0) return spectrum_all(1);
    Side        s = side_of(d, wo, wo);
    FacetShares f = facet_shares(d, &s, s.wo.z);
    return f.reflected + f.through;
}

/* The cosine to the facet that light met on its way from s->wi to s->wo. */
static float met_at(const Dielectric *d, const Side *s)
{
    if (is_delta(d)) return s->wo.z;
    Vec3  half = vec3_normalize(vec3_along(s->wo, s->wi, s->wi.z > 0 ? 1 : s->eta));
    return fminf(fabsf(vec3_dot(s->wo, half)), 1);
}

static bool solid_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                           BsdfPolarisation *out)
{
    const Dielectric *d = parameters;
    if (wo.z == 0) return false;
    Side  s = side_of(d, wo, way->wi);
    float cosine = met_at(d, &s);
    *out = polarised_by(s.wi.z > 0 ? waves_reflected(cosine, s.eta)
                                   : waves_through(cosine, s.eta));
    return true;
}

const BsdfModel dielectric_model = {.eval = solid_eval, .sample = solid_sample,
                                    .mirror = solid_mirror,
                                    .scatters = solid_scatters, .albedo = solid_albedo,
                                    .polarise = solid_polarise};
