/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_roughness -- glTF 2.0's surface with specular, ior, clear coat, thin transmission.
 *
 * On a dashboard it is nearly everything: moulded plastic, leather, soft paint, woven cloth,
 * satin and bright chrome, piano lacquer, tinted thin covers.
 *
 *   base_color        0..1 a wavelength, default 1   albedo; of a metal its mirror reflectance
 *   metallic          0..1, default 1                0 plastic, 1 metal
 *   alpha             0..1, default 1                glTF's roughness squared; a perfect mirror
 *                                                    below 0.001
 *   alpha_along       0..1, default none             brushed: alpha along the frame's x, then
 *                                                    `alpha` is across it (KHR_..._anisotropy)
 *   energy->ior       1..2.5, glTF's default 1.5     of the non-metal; 0: reflects everything
 *   specular          0..1, default 1                weakens the non-metal's reflection
 *   specular_color    0 and up, default 1            tints it at normal incidence
 *   transmission      0..1, default 0                share of the non-metal: a thin sheet
 *   across            0..1, default 0                share of the base's light that leaves on
 *                                                    the other side, of albedo across_color:
 *                                                    paper 0.4, a lampshade or leaf 0.5
 *   clearcoat, clearcoat_alpha, clearcoat_normal     a lacquer of index 1.5, of a sheet on both
 *                                                    sides alike; default none
 *   film              a clear film of some 100 nm on the share `share` of metal and non-metal
 *                     (KHR_materials_iridescence)
 *   sheen_color, sheen_alpha    fibres of cloth that stand up (KHR_materials_sheen), under the
 *                     coat; default none. Alcantara 0.1..0.3, alpha 0.1; velvet 0.8, alpha 0.3
 *   coating           a stack of thin layers (PARHELION_coating) or a metal of measured n, k
 *                     (PARHELION_spectrum): its own reflectance at every angle and wavelength
 *
 * Typical: matt dashboard plastic base 0.04, alpha 0.3; glossy black base 0.02, alpha 0.01;
 * leather base 0.1, alpha 0.25; satin aluminium metallic 1, base 0.9, alpha 0.1; piano
 * lacquer base 0.02 under a smooth clear coat.
 *
 * Model. Facets are GGX with height-correlated shadowing (Walter 2007, Heitz 2014), sampled by
 * visible normals. Non-metals reflect by the exact Fresnel curve, scaled so that its ends are
 * F0 = min(F0(ior) specular_color, 1) specular and F90 = specular. What the boundary does not
 * send back goes into a Lambert base, coupled symmetrically (Kelemen and Szirmay-Kalos 2001),
 * so a white plastic returns exactly what it gets. Metals use Schlick's curve a wavelength. The
 * transmissive share is a sheet with two faces, R = 2F/(1+F); smooth sheets pass light straight
 * on. Metals and sheets get back what facets send to other facets (Kulla and Conty 2017).
 * A coat covers its share of the surface. What it lets in and out again is one less its albedo
 * each way; what it holds back meets the base again: a metal's lobe and rebound are scaled for
 * it by coat.h, the Lambert base is coupled to both boundaries at once. A white metal or
 * plastic under any coat returns what it gets, to 85 degrees within 0.1 % (plastic) and 0.2 %
 * (metal); of a coloured base each further turn takes its albedo. All of it is reciprocal.
 * What coat.h's tables do not know, brushed, filmed and coated faces and sheen, sends out
 * through the coat what covered_lobe.h integrates on the spot; all else of the light that the
 * coat let in is the Lambert base's or the rebound's, coupled symmetrically. Facets of a metal
 * then have the turns of a mirror at the lower of both directions, fibres and facets of a
 * non-metal what the coat lets pass each way. White ones under any coat, also all together,
 * return what they get within 0.2 % to 85 degrees.
 * A sheet stands between the coats of its two sides, and all turns between the three are summed
 * up (sheet_turns.h): of smooth ones as a stack of boundaries whose light does not interfere. A
 * rough one's facets send what a metal's lobe of its own R + T sends under that coat, parted to
 * both sides as the turns do, and what they hide leaves on both sides as the rebound, likewise.
 * So a white sheet, clear or frosted, under any coat and mixed with all else on this page,
 * sends on what it gets, to 85 degrees within 0.2 %, as a metal does; below a full sheen or
 * with fine brushing within 0.4 %. As much goes through from either side.
 * Light that goes across is Lambert's on the other side, coupled to the boundaries of both as
 * the base is to one: f = across color / pi * in(wo) in(wi) / mean of in. Boundary and coat lie
 * on either side alike, so white paper, lacquered or not, returns what it gets; it passes
 * nothing straight.
 * A brushed base has two alphas (brushed.h); what its facets send back in all is told by
 * lobe_facets.h, so a white one, metal or plastic, returns what it gets within 0.2 % to 85
 * degrees too.
 * A coating's reflectance (coating.h) stands in for Fresnel's and Schlick's curves in all of
 * this; with it, metals follow the exact curve of their n, k. What it absorbs is lost.
 *
 * A film (clear_film.h) does so at each wavelength, on a body that absorbs nothing and has the
 * base's reflectance at normal incidence: of the non-metal exact, of a metal approximate unless
 * its n, k are given. Energies of rough filmed faces are told by lobe_facets.h, to 0.2 %.
 *
 * Sheen (sheen.h) lies on all but the coat, on both sides of a sheet alike. With E its albedo
 * and c the greatest of its colour, facets beneath are scaled by 1 - c max(E(wo), E(wi)), and
 * the Lambert base is coupled to sheen and boundary at once: each direction enters with what
 * neither the sheen nor the facets send, as does the light that facets hide. So white plastic,
 * metal or paper under white sheen returns what it gets, to 85 degrees within 0.2 % at every
 * roughness, and it is reciprocal. A coloured sheen takes from all beneath what its strongest
 * primary reflects (the extension's rule).
 *
 * Polarised light is followed by facets and coat as glass of their index has it, by a metal of
 * n, k and by a coated face as their waves add up; another metal is taken for a perfect mirror,
 * a coated sheet for a bare one; what the base and further facets send is unpolarised.
 *
 * Not modelled: subsurface spread, coloured absorption along a slanted path in the coat, turns
 * of light between a coat and the mirror of a non-metal (its few per cent go to the Lambert
 * base), and between a rough base and a coat whose normal is tilted; of a metal without n, k
 * the exact curve (Schlick is within some per cent of it).
 */
#include "shaders/metallic_roughness.h"

#include "base/units.h"
#include "spectrum/fresnel.h"
#include "shaders/facets/brushed.h"
#include "shaders/metallic_view.h"
#include "shaders/polarisation.h"
#include "shaders/sheet_turns.h"

#define WIDE_ALPHA 0.15f  /* lobes of more than about ten degrees */
#define COAT_UPRIGHT 0.9999f /* z of a coat's normal that is not tilted */

MetallicRoughness metallic_roughness_default(const EnergyTable *energy)
{
    return (MetallicRoughness){.base_color = spectrum_all(1),
                               .specular_color = spectrum_all(1),
                               .metallic = 1,
                               .alpha = 1,
                               .specular = 1,
                               .clearcoat_normal = {0, 0, 1},
                               .energy = energy};
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

static inline bool has_film(const MetallicRoughness *m)
{
    return m->film.share > 0;
}

/* The bare and the filmed reflectance by the film's share. */
static Spectrum mix_film(const MetallicRoughness *m, Spectrum bare, Spectrum filmed)
{
    return bare + (filmed - bare) * spectrum_all(m->film.share);
}

static Spectrum filmed_face(const MetallicRoughness *m, Spectrum bare, float cosine)
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

static inline Spectrum bare_reflectance(const MetallicRoughness *m, const MetallicFace *b,
                                        float cosine)
{
    return b->f0 + b->rise * spectrum_all(fresnel_shape(m->energy->ior, cosine));
}

static inline Spectrum boundary_reflectance(const MetallicRoughness *m, const MetallicFace *b,
                                            float cosine)
{
    Spectrum bare = bare_reflectance(m, b, cosine);
    return has_film(m) ? filmed_face(m, bare, cosine) : bare;
}

static inline Spectrum sheet_reflectance(Spectrum face)
{
    return (face + face) / (spectrum_all(1) + face);
}

/* Share of the base's light that a boundary lets pass, for an energy of the table. */
static inline Spectrum let_in(const MetallicFace *b, Energy e)
{
    return spectrum_all(1) - b->f0 * spectrum_all(e.all) - b->rise * spectrum_all(e.shape);
}

/* ---- the Lambert base: back, or across to the other side -------------------------------- */

static inline Spectrum lambert_back(const MetallicRoughness *m)
{
    return m->across > 0 ? m->base_color * spectrum_all(1 - m->across) : m->base_color;
}

static Spectrum lambert_across(const MetallicRoughness *m)
{
    return spectrum_from_rgb(m->wavelengths, m->across_color) * spectrum_all(m->across);
}

/* Of both. */
static inline Spectrum lambert_albedo(const MetallicRoughness *m)
{
    return m->across > 0 ? lambert_back(m) + lambert_across(m) : m->base_color;
}

/* ---- brushed: facets that lean further along x than along y ---------------------------- */

static inline bool is_brushed(const MetallicRoughness *m)
{
    return m->alpha_along > 0;
}

static inline Vec2 alphas(const MetallicRoughness *m)
{
    return (Vec2){m->alpha_along, m->alpha};
}

static Energy energy_of_facets(const MetallicRoughness *m, const LobeFacets *facets)
{
    Energy e = {0, 0};
    for (int i = 0; i < LOBE_FACETS; i++) {
        e.all += facets->weight[i];
        e.shape += facets->weight[i] * fresnel_shape(m->energy->ior, facet_cosine[i]);
    }
    return (Energy){clampf(e.all, 0, 1), clampf(e.shape, 0, 1)};
}

static Energy brushed_energy(const MetallicRoughness *m, Vec3 w)
{
    LobeFacets facets = lobe_facets(&common_facet_table, w, alphas(m));
    return energy_of_facets(m, &facets);
}

static Energy brushed_average(const MetallicRoughness *m)
{
    LobeFacets facets = mean_facets(&common_facet_table, alphas(m));
    return energy_of_facets(m, &facets);
}

/* What the base's facets send back along a direction above it, and on average. */
static inline Energy base_energy(const MetallicRoughness *m, Vec3 w)
{
    return is_brushed(m) ? brushed_energy(m, w) : energy_directional(m->energy, w.z, m->alpha);
}

static inline Energy base_average(const MetallicRoughness *m)
{
    return is_brushed(m) ? brushed_average(m) : energy_average(m->energy, m->alpha);
}

/* The roughness of an even surface whose facets send back as much on average. */
static float even_alpha(const MetallicRoughness *m)
{
    if (!is_brushed(m)) return m->alpha;
    float wanted = brushed_average(m).all, low = SMOOTH_ALPHA, high = 1;
    for (int step = 0; step < 12; step++) {
        float middle = 0.5f * (low + high);
        if (energy_average(m->energy, middle).all > wanted) low = middle;
        else high = middle;
    }
    return low;
}

/* The roughness along a direction's own azimuth. */
static float own_alpha(const MetallicRoughness *m, Vec3 w)
{
    if (!is_brushed(m)) return m->alpha;
    float x = m->alpha_along * w.x, y = m->alpha * w.y, side2 = w.x * w.x + w.y * w.y;
    return side2 > 1e-12f ? sqrtf((x * x + y * y) / side2) : m->alpha;
}

static inline float base_lobe(const MetallicRoughness *m, Vec3 wo, Vec3 wi, Vec3 half)
{
    return is_brushed(m) ? brushed_reflection(wo, wi, half, alphas(m)) :
                           ggx_reflection(wo, wi, half, m->alpha);
}

static inline float base_lobe_pdf(const MetallicRoughness *m, Vec3 wo, Vec3 half)
{
    return is_brushed(m) ? brushed_reflection_pdf(wo, half, alphas(m)) :
                           ggx_reflection_pdf(wo, half, m->alpha);
}

static inline Vec3 base_sample(const MetallicRoughness *m, Vec3 wo, float u0, float u1)
{
    return is_brushed(m) ? brushed_sample_reflection(wo, alphas(m), u0, u1) :
                           ggx_sample_reflection(wo, m->alpha, u0, u1);
}

/* ---- coatings: tables in place of the curves ------------------------------------------- */

static const CoatingTables *coated_metal(const MetallicRoughness *m)
{
    return m->coating ? m->coating->metal : NULL;
}

static const CoatingTables *coated_face(const MetallicRoughness *m)
{
    return m->coating ? m->coating->face : NULL;
}

static const CoatingTables *coated_sheet(const MetallicRoughness *m)
{
    return m->coating ? m->coating->sheet : NULL;
}

static Spectrum sheet_at(const MetallicRoughness *m, float cosine)
{
    const CoatingTables *sheet = m->coating->sheet;
    return coating_at(m->seen_from_back ? sheet->back : sheet->front, m->wavelengths, cosine);
}

static Spectrum coated_facets(const MetallicRoughness *m, LobeFacets facets)
{
    Spectrum all = spectrum_all(0);
    for (int i = 0; i < LOBE_FACETS; i++)
        all += coating_at(m->coating->face->front, m->wavelengths, facet_cosine[i]) *
               spectrum_all(facets.weight[i]);
    return spectrum_clamp(all, 0, 1);
}

/* What a coated face sends back in all. */
static Spectrum coated_energy(const MetallicRoughness *m, Vec3 w)
{
    const CoatingTables *face = m->coating->face;
    Spectrum all = is_brushed(m) ?
                       coated_facets(m, lobe_facets(&common_facet_table, w, alphas(m))) :
                   is_smooth(m->alpha) ?
                       coating_at(face->front, m->wavelengths, w.z) :
                       coating_energy_at(face->energy, m->wavelengths, w.z, m->alpha);
    return all * spectrum_all(m->specular);
}

static Spectrum coated_average(const MetallicRoughness *m)
{
    if (is_brushed(m))
        return coated_facets(m, mean_facets(&common_facet_table, alphas(m)));
    return coating_energy_average(m->coating->face->energy, m->wavelengths, m->alpha);
}

static Spectrum coated_facet(const MetallicRoughness *m, float cosine)
{
    Spectrum sum = spectrum_all(0);
    if (coated_face(m))
        sum = coating_at(m->coating->face->front, m->wavelengths, cosine) *
              spectrum_all(m->specular * (1 - m->transmission));
    if (m->transmission > 0) sum += sheet_at(m, cosine) * spectrum_all(m->transmission);
    return sum * spectrum_all(1 - m->metallic);
}

/* ---- films: each facet's curve is asked where lobe_facets.h says ------------------------ */

static Spectrum sum_of_facets(const Spectrum at[LOBE_FACETS], LobeFacets facets)
{
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < LOBE_FACETS; i++) sum += at[i] * spectrum_all(facets.weight[i]);
    return spectrum_clamp(sum, 0, 1);
}

static Vec2 facet_alphas(const MetallicRoughness *m)
{
    return is_brushed(m) ? alphas(m) : (Vec2){m->alpha, m->alpha};
}

/* What a filmed face sends back in all. */
static Spectrum filmed_energy(const MetallicView *view, Vec3 w)
{
    const MetallicRoughness *m = view->m;
    if (is_smooth(m->alpha)) return boundary_reflectance(m, &view->boundary, w.z);
    return sum_of_facets(view->film, lobe_facets(&common_facet_table, w, facet_alphas(m)));
}

/* Of light from everywhere; a smooth face's is that of its narrowest lobe. */
static Spectrum filmed_average(const MetallicView *view, float alpha)
{
    Vec2 both = facet_alphas(view->m);
    if (is_smooth(alpha)) both = (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA};
    return sum_of_facets(view->film, mean_facets(&common_facet_table, both));
}

/* ---- facets ----------------------------------------------------------------------------- */

static bool has_coated_nonmetal(const MetallicRoughness *m)
{
    return coated_face(m) || coated_sheet(m);
}

/* Reflectance of a facet met at `cosine`, of the non-metal's share, sheet or solid. */
static Spectrum facet_of_nonmetal(const MetallicRoughness *m, const MetallicFace *b,
                                  float cosine)
{
    if (!(m->metallic < 1)) return spectrum_all(0);
    if (has_coated_nonmetal(m)) return coated_facet(m, cosine);
    Spectrum face = boundary_reflectance(m, b, cosine);
    if (m->transmission > 0)
        face += (sheet_reflectance(face) - face) * spectrum_all(m->transmission);
    return face * spectrum_all(1 - m->metallic);
}

static Spectrum metal_at(const MetallicRoughness *m, float cosine)
{
    Spectrum bare = coated_metal(m) ?
                        coating_at(m->coating->metal->front, m->wavelengths, cosine) :
                        fresnel_schlick(m->base_color, cosine);
    return has_film(m) ? filmed_metal(m, bare, cosine) : bare;
}

static Spectrum facet_of_metal(const MetallicRoughness *m, float cosine)
{
    if (!(m->metallic > 0)) return spectrum_all(0);
    return metal_at(m, cosine) * spectrum_all(m->metallic);
}

/* What the sheet's share lets through a facet met at `cosine`. */
static Spectrum pane_transmittance(const MetallicRoughness *m, const MetallicFace *b,
                                   float cosine)
{
    if (coated_sheet(m))
        return coating_at(m->coating->sheet->through, m->wavelengths, cosine) * m->base_color *
               spectrum_all((1 - m->metallic) * m->transmission);
    Spectrum face = boundary_reflectance(m, b, cosine);
    return (spectrum_all(1) - sheet_reflectance(face)) * m->base_color *
           spectrum_all((1 - m->metallic) * m->transmission);
}

/* The sheet's share alone, a facet of it met at `cosine`. */
static SheetFaces sheet_faces(const MetallicRoughness *m, const MetallicFace *b, float cosine)
{
    const CoatingTables *sheet = coated_sheet(m);
    SheetFaces faces;
    if (sheet) {
        const CoatingTable *rear = m->seen_from_back ? sheet->front : sheet->back;
        faces.front = sheet_at(m, cosine);
        faces.rear = coating_at(rear, m->wavelengths, cosine);
        faces.through = coating_at(sheet->through, m->wavelengths, cosine) * m->base_color;
        return faces;
    }
    faces.front = faces.rear = sheet_reflectance(boundary_reflectance(m, b, cosine));
    faces.through = (spectrum_all(1) - faces.front) * m->base_color;
    return faces;
}

/* Light that one facet hides from the eye meets others and comes out in the end, spread like
 * the missing albedo on both sides (Kulla and Conty 2017): sr^-1, for reflectance 1. */
static float bare_rebound_lobe(const MetallicView *view, Energy in)
{
    float missing = 1 - base_average(view->m).all;
    if (!(missing > 1e-6f)) return 0;
    return (1 - view->energy.all) * (1 - in.all) / missing * INV_PI_F;
}

/* ---- sheen: fibres over all of this, under the coat ------------------------------------- */

static inline float sheen_most(const MetallicRoughness *m)
{
    return fmaxf(fmaxf(m->sheen_color[0], m->sheen_color[1]), m->sheen_color[2]);
}

/* No colour is below 0. */
static inline bool has_sheen(const MetallicRoughness *m)
{
    return m->sheen_color[0] + m->sheen_color[1] + m->sheen_color[2] > 0;
}

/* No lane takes more than what lies beneath is made to miss. */
static Spectrum sheen_tint(const MetallicRoughness *m)
{
    Spectrum tint = spectrum_from_rgb(m->wavelengths, m->sheen_color);
    return spectrum_clamp(tint, 0, sheen_most(m));
}

static SheenShare sheen_towards(const MetallicRoughness *m, Vec3 w)
{
    return sheen_share(&common_sheen_table, fabsf(w.z), m->sheen_alpha, own_alpha(m, w));
}

/* Share of light along these two that a facet beneath keeps. */
static float sheen_leaves(const MetallicView *view, Vec3 wi)
{
    const MetallicRoughness *m = view->m;
    float in = sheen_albedo(&common_sheen_table, fabsf(wi.z), m->sheen_alpha);
    return 1 - sheen_most(m) * fmaxf(view->sheen.albedo, in);
}

/* What facets send of light from a direction, or in the mean, through the sheen. */
static Energy through_sheen(const MetallicRoughness *m, Energy e, SheenShare share)
{
    float most = sheen_most(m);
    return (Energy){e.all * (1 - most * share.all), e.shape * (1 - most * share.shape)};
}

/* Neither in the sheen nor back from facets: what comes to the Lambert base. reflected: what a
 * coated or filmed face sends in all, without the sheen. */
static Spectrum enters_below_sheen(const MetallicView *view, Spectrum reflected, Energy e,
                                   SheenShare share)
{
    const MetallicRoughness *m = view->m;
    float    most = sheen_most(m);
    Spectrum in = let_in(&view->boundary, through_sheen(m, e, share));
    if (coated_face(m) || has_film(m))
        in = spectrum_all(1) - reflected * spectrum_all(1 - most * share.all);
    return spectrum_clamp(in - spectrum_all(most * share.albedo), 0, 1);
}

/* Is what lets light into the Lambert base more than a bare boundary? */
static inline bool has_layers(const MetallicRoughness *m)
{
    return m->coating || has_film(m) || has_sheen(m);
}

/* reflected: what a coated or filmed face sends back in all. */
static Spectrum enters_layers(const MetallicView *view, Spectrum reflected, Energy e,
                              const SheenShare *sheen)
{
    const MetallicRoughness *m = view->m;
    if (has_sheen(m)) return enters_below_sheen(view, reflected, e, *sheen);
    if (coated_face(m) || has_film(m)) return spectrum_all(1) - reflected;
    return let_in(&view->boundary, e);
}

static Spectrum enters_layers_along(const MetallicView *view, Vec3 w, Energy e)
{
    const MetallicRoughness *m = view->m;
    SheenShare sheen;
    Spectrum   reflected = coated_face(m) ? coated_energy(m, w) :
                           has_film(m)    ? filmed_energy(view, w) :
                                            spectrum_all(0);
    if (has_sheen(m)) sheen = sheen_towards(m, w);
    return enters_layers(view, reflected, e, &sheen);
}

static Spectrum enters_layers_on_average(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    Spectrum reflected = coated_face(m) ? coated_average(m) * spectrum_all(m->specular) :
                         has_film(m)    ? filmed_average(view, m->alpha) :
                                          spectrum_all(0);
    return enters_layers(view, reflected, base_average(m), &view->sheen_mean);
}

/* Share of the light from w that comes to the Lambert base where no coat lies; e: of facets. */
static inline Spectrum enters(const MetallicView *view, Vec3 w, Energy e)
{
    return has_layers(view->m) ? enters_layers_along(view, w, e) : let_in(&view->boundary, e);
}

static inline bool has_lambert(const MetallicRoughness *m)
{
    return (1 - m->metallic) * (1 - m->transmission) > 0;
}

/* The part of diffuse_eval that wo tells. */
static Spectrum lambert_towards(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    Spectrum share = spectrum_all((1 - m->metallic) * (1 - m->transmission) * INV_PI_F);
    Spectrum in, mean;
    if (has_layers(m)) {
        in = enters_layers(view, view->coated, view->energy, &view->sheen);
        mean = enters_layers_on_average(view);
    } else {
        in = let_in(&view->boundary, view->energy);
        mean = let_in(&view->boundary, base_average(m));
    }
    return in * share / spectrum_max(mean, spectrum_all(1e-3f));
}

/* Lambert under boundary and sheen: albedo / pi * in(wo) in(wi) / mean of in (Kelemen 2001). */
static inline Spectrum diffuse_eval(const MetallicView *view, Spectrum albedo, Vec3 wi,
                                    Energy in)
{
    if (!has_lambert(view->m)) return spectrum_all(0);
    return albedo * view->lambert * enters(view, wi, in);
}

/* Of the light that gets past the sheen, what facets hide. */
static float hidden_below_sheen(const MetallicRoughness *m, Energy e, SheenShare share)
{
    return fmaxf(1 - sheen_most(m) * share.albedo - through_sheen(m, e, share).all, 0);
}

static float rebound_below_sheen(const MetallicView *view, Vec3 wi, Energy in)
{
    const MetallicRoughness *m = view->m;
    float missing = hidden_below_sheen(m, base_average(m), view->sheen_mean);
    if (!(missing > 1e-6f)) return 0;
    return hidden_below_sheen(m, view->energy, view->sheen) *
           hidden_below_sheen(m, in, sheen_towards(m, wi)) / missing * INV_PI_F;
}

static float rebound_lobe(const MetallicView *view, Vec3 wi, Energy in)
{
    return has_sheen(view->m) ? rebound_below_sheen(view, wi, in) :
                                bare_rebound_lobe(view, in);
}

/* The light of both directions that a smooth mirror or a sheet keeps below the sheen. */
static inline Spectrum sheen_over(const MetallicView *view, Vec3 wi, Spectrum below)
{
    return has_sheen(view->m) ? below * spectrum_all(sheen_leaves(view, wi)) : below;
}

/* ---- what comes back from the base ------------------------------------------------------ */

static Spectrum filmed_metal_mean(const MetallicRoughness *m)
{
    Spectrum at[LOBE_FACETS];
    for (int i = 0; i < LOBE_FACETS; i++) at[i] = metal_at(m, facet_cosine[i]);
    return sum_of_facets(at, mean_facets(&common_facet_table,
                                         (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA}));
}

/* Of a metal every further bounce takes its mean reflectance; the mean of Schlick's curve over
 * the hemisphere is f0 + (1 - f0) / 21. */
static Spectrum metal_mean(const MetallicRoughness *m)
{
    if (has_film(m)) return filmed_metal_mean(m);
    if (coated_metal(m)) return curve_lookup(&m->coating->metal->front_mean, m->wavelengths);
    return m->base_color + (spectrum_all(1) - m->base_color) * spectrum_all(1.0f / 21);
}

static Spectrum metal_rebound(const MetallicRoughness *m)
{
    float    mean = base_average(m).all;
    Spectrum one = spectrum_all(1), f = metal_mean(m);
    return f * f * spectrum_all(mean * m->metallic) / (one - f * spectrum_all(1 - mean));
}

/* A sheet parts it by its mean reflectance over the hemisphere. */
static Spectrum pane_mean(const MetallicView *view)
{
    const MetallicFace *b = &view->boundary;
    if (coated_sheet(view->m)) /* of either side: they differ by what the coating absorbs */
        return curve_lookup(&view->m->coating->sheet->front_mean, view->m->wavelengths);
    if (has_film(view->m)) return sheet_reflectance(filmed_average(view, 0));
    float shape = energy_average(view->m->energy, 0).shape;
    return sheet_reflectance(b->f0 + b->rise * spectrum_all(shape));
}

static Spectrum pane_mean_through(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    if (coated_sheet(m)) return curve_lookup(&m->coating->sheet->through_mean, m->wavelengths);
    return spectrum_all(1) - pane_mean(view);
}

static float clear_share(const MetallicRoughness *m)
{
    return (1 - m->metallic) * m->transmission;
}

/* Of metals and sheets: the non-metal's is the Lambert base's. */
static inline bool has_rebound(const MetallicRoughness *m)
{
    return m->metallic > 0 || m->transmission > 0;
}

static Spectrum rebound_above(const MetallicView *view, Vec3 wi, Energy in)
{
    const MetallicRoughness *m = view->m;
    Spectrum sum = spectrum_all(0);
    float    clear = clear_share(m);
    float    lobe = rebound_lobe(view, wi, in);
    if (!(lobe > 0)) return sum;
    if (m->metallic > 0) sum = metal_rebound(m);
    if (clear > 0) sum += pane_mean(view) * spectrum_all(clear);
    return sum * spectrum_all(lobe);
}

static float coat_cosine(const MetallicRoughness *m, Vec3 w)
{
    return fabsf(vec3_dot(m->clearcoat_normal, w));
}

/* The coat's albedo for a direction, times its share. */
static float coat_albedo(const MetallicRoughness *m, Vec3 w)
{
    if (!(m->clearcoat > 0)) return 0;
    return m->clearcoat *
           coat_reflectance(m->clearcoat_energy, coat_cosine(m, w), m->clearcoat_alpha);
}

static float coat_open(const MetallicRoughness *m, Vec3 w)
{
    return 1 - coat_reflectance(m->clearcoat_energy, coat_cosine(m, w), m->clearcoat_alpha);
}

/* Is there a coat, over what coat.h's tables do not know? */
static inline bool is_covered(const MetallicRoughness *m)
{
    return m->clearcoat > 0 &&
           (is_brushed(m) || has_film(m) || has_sheen(m) || coated_face(m));
}

/* A tilted coat's turns are left out: the table knows no tilt. */
static ThroughCoat coat_through(const MetallicRoughness *m, Vec3 w)
{
    float       cosine = coat_cosine(m, w);
    ThroughCoat t;
    t.open = 1 - coat_reflectance(m->clearcoat_energy, cosine, m->clearcoat_alpha);
    t.share = coat_share(m->coat, cosine, m->alpha, m->clearcoat_alpha);
    if (m->clearcoat_normal.z < COAT_UPRIGHT) t.share.boost = t.open;
    return t;
}

/* Of the light that goes in and out along these, with p = (t / u)^2 the share that a lobe's
 * light gets out with each time and r the base's albedo: t t / sqrt of both 1 - r (1 - p). */
static Spectrum coat_on_metal(const MetallicRoughness *m, const ThroughCoat *out,
                              const ThroughCoat *in)
{
    Spectrum r = metal_mean(m), one = spectrum_all(1), product;
    float    stays[2], t[2] = {out->open, in->open}, u[2] = {out->share.boost, in->share.boost};
    for (int i = 0; i < 2; i++) {
        float p = u[i] > 0 ? t[i] / u[i] : 1;
        stays[i] = 1 - fminf(p * p, 1);
    }
    product = (one - r * spectrum_all(stays[0])) * (one - r * spectrum_all(stays[1]));
    for (int i = 0; i < SPECTRUM_LANES; i++)
        product[i] = t[0] * t[1] / sqrtf(fmaxf(product[i], 1e-12f));
    return product;
}

/* Is there a sheet that a coat lies on? On both of its sides alike. */
static inline bool has_sheet_under_coat(const MetallicRoughness *m)
{
    return m->clearcoat > 0 && clear_share(m) > 0;
}

/* What the coats of both sides do to a sheet's light along these two: share that gets in and
 * out, and share of what the sheet sends that they hold back each time. A clear sheet then
 * sends pass / (1 - held), as much as a white metal's lobe under that coat: the boosts' product
 * (coat.h), or, of smooth sheets and of what its tables do not know, the lesser share. */
typedef struct CoatOnSheet {
    float pass, held;
} CoatOnSheet;

static CoatOnSheet coat_on_sheet(const MetallicRoughness *m, const ThroughCoat *out,
                                 const ThroughCoat *in)
{
    float pass = out->open * in->open, boost = out->share.boost * in->share.boost;
    float least = fminf(out->open, in->open);
    if (is_covered(m) || is_smooth(m->alpha)) return (CoatOnSheet){least * least, 1 - least};
    return (CoatOnSheet){pass, boost > pass ? 1 - pass / boost : 0};
}

/* What a facet of the sheet's share sends through the coats of light along these two. */
static SheetLight sheet_below_coat(const MetallicView *view, float cosine,
                                   const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    CoatOnSheet coat = coat_on_sheet(m, &view->through, below);
    SheetFaces  faces = sheet_faces(m, &view->boundary, cosine);
    SheetLight  light = sheet_turns(&faces, coat.held);
    Spectrum    share = spectrum_all(clear_share(m) * coat.pass);
    return (SheetLight){light.back * share, light.through * share};
}

/* What becomes of the light that the sheet's facets hide, turns between the coats in it: share
 * of the rebound's lobe on either side. */
static SheetLight sheet_rebound(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    float      open = view->coat_mean.open;
    Spectrum   mean = pane_mean(view), share = spectrum_all(clear_share(m) * open);
    SheetFaces faces = {mean, mean, pane_mean_through(view) * m->base_color};
    SheetLight light = sheet_turns(&faces, 1 - open);
    return (SheetLight){light.back * share, light.through * share};
}

/* What both boundaries let into the Lambert base. */
static inline Spectrum let_in_coated(const MetallicFace *b, Energy e, const ThroughCoat *t)
{
    return let_in(b, (Energy){e.all - t->share.all, e.shape - t->share.shape}) *
           spectrum_all(t->open);
}

static Spectrum coated_diffuse(const MetallicView *view, Spectrum albedo, Energy in,
                               const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    const MetallicFace *b = &view->boundary;
    float    share = (1 - m->metallic) * (1 - m->transmission);
    if (!(share > 0)) return spectrum_all(0);
    Spectrum mean = spectrum_all(view->coat_mean.open) -
                    b->f0 * spectrum_all(view->coat_mean.all) -
                    b->rise * spectrum_all(view->coat_mean.shape);
    return albedo * coat_turns(view->coat_mean.open, lambert_albedo(m)) *
           let_in_coated(b, view->energy, &view->through) * let_in_coated(b, in, below) *
           spectrum_all(share * INV_PI_F) / spectrum_max(mean, spectrum_all(1e-3f));
}

/* sr^-1, of the light that the coat let in along both. */
static float coated_rebound_lobe(const MetallicView *view, Energy in)
{
    float missing = view->coat_mean.open - view->coat_mean.lobe;
    if (!(missing > 1e-6f)) return 0;
    return (1 - view->energy.all) * (1 - in.all) / missing * INV_PI_F;
}

static Spectrum coated_rebound(const MetallicView *view, Energy in, const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    float    both = view->through.open * below->open, clear = clear_share(m);
    float    missing = view->coat_mean.open - view->coat_mean.lobe;
    Spectrum sum = spectrum_all(0);
    if (m->metallic > 0 && missing > 1e-6f)
        sum = metal_rebound(m) * coat_turns(view->coat_mean.open, metal_mean(m)) *
              spectrum_all((1 - view->energy.all) * (1 - in.all) / missing * INV_PI_F);
    if (clear > 0)
        sum += sheet_rebound(view).back * spectrum_all(coated_rebound_lobe(view, in));
    return sum * spectrum_all(both);
}

/* ---- a coat over brushed, filmed, coated and woven bases --------------------------------- */

/* What fibres send out of the light that the coat let in along w. */
static float open_fibres(const MetallicRoughness *m, float cosine)
{
    if (!has_sheen(m)) return 0;
    return sheen_most(m) * sheen_albedo(&common_sheen_table, cosine, m->sheen_alpha) *
           sheen_open(&common_sheen_table, cosine, m->sheen_alpha, m->clearcoat_alpha);
}

static float kept_by_sheen(const MetallicRoughness *m, float cosine)
{
    if (!has_sheen(m)) return 1;
    return 1 - sheen_most(m) * sheen_albedo(&common_sheen_table, cosine, m->sheen_alpha);
}

static Spectrum face_at(const MetallicView *view, float cosine)
{
    const MetallicRoughness *m = view->m;
    if (coated_face(m))
        return coating_at(m->coating->face->front, m->wavelengths, cosine) *
               spectrum_all(m->specular);
    return boundary_reflectance(m, &view->boundary, cosine);
}

static Spectrum sent_by_face(const CoveredBase *covered, const LobeFacets *facets)
{
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < LOBE_FACETS; i++)
        sum += covered->face[i] * spectrum_all(facets->weight[i]);
    return sum;
}

static CoveredRest rest_along(const MetallicView *view, Vec3 w)
{
    const MetallicRoughness *m = view->m;
    const CoveredBase *covered = &view->covered;
    float    open = coat_open(m, w), kept = kept_by_sheen(m, w.z);
    float    above = 1 - open_fibres(m, w.z);
    Spectrum face;
    if (is_smooth(m->alpha)) {
        face = face_at(view, w.z) * spectrum_all(open * kept);
        return (CoveredRest){(spectrum_all(above) - face) * spectrum_all(open),
                          open * (above - kept)};
    }
    CoveredLobe lobe = covered_lobe(&covered->cover, w);
    face = sent_by_face(covered, &lobe.facets);
    return (CoveredRest){spectrum_max(spectrum_all(above) - face, spectrum_all(0)) *
                      spectrum_all(open),
                  open * (above - kept) + lobe.lost};
}

static void set_cover(const MetallicRoughness *m, Cover *cover)
{
    cover->normal = m->clearcoat_normal;
    cover->has_sheen = has_sheen(m);
    cover->alpha = is_smooth(m->alpha) ? (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA} : facet_alphas(m);
    for (int i = 0; i < ENERGY_COSINES; i++) {
        float root = (float)i / (ENERGY_COSINES - 1), cosine = fmaxf(root * root, 1e-5f);
        cover->open[i] =
            1 - coat_reflectance(m->clearcoat_energy, cosine, m->clearcoat_alpha);
        if (cover->has_sheen) cover->kept[i] = kept_by_sheen(m, cosine);
    }
}

/* Over the hemisphere, weighted by the cosine, by the trapezoid rule: what fibres take of the
 * light that the coat let in, and what they send out through it. */
static void mean_of_fibres(const MetallicRoughness *m, const Cover *cover, float *taken,
                           float *sent)
{
    *taken = *sent = 0;
    if (!has_sheen(m)) return;
    for (int i = 0; i < ENERGY_COSINES; i++) {
        float root = (float)i / (ENERGY_COSINES - 1), cosine = fmaxf(root * root, 1e-5f);
        float open = 4 * root * root * root * cover->open[i] / (ENERGY_COSINES - 1);
        if (i == ENERGY_COSINES - 1) open *= 0.5f;
        *taken += open * (1 - cover->kept[i]);
        *sent += open * open_fibres(m, cosine);
    }
}

static void set_covered(MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    CoveredBase *covered = &view->covered;
    float    taken, sent;
    set_cover(m, &covered->cover);
    mean_of_fibres(m, &covered->cover, &taken, &sent);
    for (int i = 0; i < LOBE_FACETS; i++)
        covered->face[i] =
            m->metallic < 1 ? face_at(view, facet_cosine[i]) : spectrum_all(0);
    CoveredLobe mean = covered_mean(&covered->cover);
    covered->mean.base = spectrum_max(spectrum_all(view->coat_mean.open - sent) -
                                          sent_by_face(covered, &mean.facets),
                                      spectrum_all(1e-3f));
    covered->mean.metal = taken - sent + (is_smooth(m->alpha) ? 0 : mean.lost);
    covered->rest = rest_along(view, view->wo);
}

/* A mirror of reflectance r under a coat that lets pass t: t t (1 + r (1 - t) + ...). A rough
 * lobe has the lesser t of its two directions: so it never sends out more than came in along
 * either. */
static Spectrum coat_on_mirror(Spectrum r, float t)
{
    return spectrum_all(t * t) / (spectrum_all(1) - r * spectrum_all(1 - t));
}

static Spectrum covered_lambert(const MetallicView *view, Spectrum albedo,
                                const CoveredRest *in)
{
    const MetallicRoughness *m = view->m;
    float share = (1 - m->metallic) * (1 - m->transmission);
    return albedo * coat_turns(view->coat_mean.open, lambert_albedo(m)) *
           view->covered.rest.base * in->base * spectrum_all(share * INV_PI_F) /
           view->covered.mean.base;
}

/* sr^-1. */
static float covered_rebound_lobe(const MetallicView *view, const CoveredRest *in)
{
    const CoveredBase *c = &view->covered;
    if (!(c->mean.metal > 1e-6f)) return 0;
    return c->rest.metal * in->metal / c->mean.metal * INV_PI_F;
}

static Spectrum covered_rebound(const MetallicView *view, const CoveredRest *in)
{
    const MetallicRoughness *m = view->m;
    const CoveredBase *c = &view->covered;
    Spectrum sum = spectrum_all(0);
    if (m->metallic > 0 && c->mean.metal > 1e-6f)
        sum = metal_rebound(m) * coat_turns(view->coat_mean.open, metal_mean(m)) *
              spectrum_all(c->rest.metal * in->metal / c->mean.metal * INV_PI_F);
    if (clear_share(m) > 0)
        sum += sheet_rebound(view).back * spectrum_all(covered_rebound_lobe(view, in));
    return sum;
}

/* With a tilted normal the coat's own cosines differ from the surface's: dividing by the larger
 * of each pair keeps it reciprocal and below its untilted albedo. */
static float coat_tilt(const MetallicRoughness *m, Vec3 wo, Vec3 wi)
{
    float out = vec3_dot(m->clearcoat_normal, wo), in = vec3_dot(m->clearcoat_normal, wi);
    if (!(out > 0 && in > 0 && wo.z > 0 && wi.z > 0)) return 0;
    return (out > wo.z ? 1 : out / wo.z) * (in > wi.z ? 1 : in / wi.z);
}

static float coat_facet(float cosine)
{
    return fresnel_unpolarised(cosine, CLEARCOAT_IOR);
}

/* Into and out of the coat's own frame. */
static Frame coat_frame(const MetallicRoughness *m)
{
    return frame_from_z(m->clearcoat_normal);
}

/* Rough coat: *pdf of choosing wi by it. */
static float coat_eval(const MetallicRoughness *m, Vec3 wo, Vec3 wi, float *pdf)
{
    *pdf = 0;
    float tilt = coat_tilt(m, wo, wi);
    if (!(tilt > 0)) return 0;
    Frame frame = coat_frame(m);
    Vec3  out = frame_to_local(&frame, wo), in = frame_to_local(&frame, wi);
    Vec3  half = vec3_normalize(vec3_add(out, in));
    *pdf = ggx_reflection_pdf(out, half, m->clearcoat_alpha);
    return m->clearcoat * tilt * coat_facet(vec3_dot(out, half)) *
           ggx_reflection(out, in, half, m->clearcoat_alpha);
}

static MetallicChoices scaled_to_one(MetallicChoices c)
{
    float sum = c.coat + c.mirror + c.diffuse + c.through + c.across + c.sheen;
    float scale = sum > 0 ? 1 / sum : 0;
    return (MetallicChoices){c.coat * scale,    c.mirror * scale, c.diffuse * scale,
                             c.through * scale, c.across * scale, c.sheen * scale};
}

static MetallicChoices beside_sheen(const MetallicView *view, MetallicChoices c)
{
    const MetallicRoughness *m = view->m;
    float left = 1 - sheen_most(m) * view->sheen.albedo;
    return (MetallicChoices){.coat = c.coat,
                     .mirror = c.mirror * left,
                     .diffuse = c.diffuse * left,
                     .through = c.through * left,
                     .across = c.across * left,
                     .sheen = (1 - c.coat) * view->sheen.albedo *
                              spectrum_mean(sheen_tint(m))};
}

/* Mean shares of light for choosing, where a part is coated. */
static MetallicChoices choose_coated(const MetallicView *view, float coat)
{
    const MetallicRoughness *m = view->m;
    float z = view->wo.z, lost = 1 - view->energy.all, under = 1 - coat;
    float clear = (1 - m->metallic) * m->transmission, solid = 1 - m->metallic - clear;
    float base = spectrum_mean(lambert_back(m));
    float facets = spectrum_mean(facet_of_nonmetal(m, &view->boundary, z));
    float metal = m->metallic > 0 ? spectrum_mean(facet_of_metal(m, z)) : 0;
    float through = clear > 0 ? spectrum_mean(pane_transmittance(m, &view->boundary, z)) : 0;
    float face = coated_face(m) || has_film(m) ? spectrum_mean(view->coated) :
                 spectrum_mean(spectrum_all(1) - let_in(&view->boundary, view->energy));
    return (MetallicChoices){
        .coat = coat,
        .mirror = under * (facets + metal),
        .diffuse = under * (base * solid * (1 - face) +
                            lost * (metal * metal + facets * clear)),
        .through = under * through,
        .across = m->across > 0 ?
                      under * solid * (1 - face) * spectrum_mean(lambert_across(m)) : 0};
}

/* Probabilities follow the lanes' mean albedo of each part, so that none is ever starved. */
static inline MetallicChoices choose(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    Energy e = view->energy;
    if (m->coating || has_film(m)) {
        float above = vec3_dot(m->clearcoat_normal, view->wo);
        return choose_coated(view, above > 0 ? view->coat : 0);
    }
    float  base = spectrum_mean(m->base_color);
    float  f0 = spectrum_mean(view->boundary.f0);
    float face = f0 * e.all + (m->specular - f0) * e.shape;
    float sheet = 2 * face / (1 + face);
    float metal = base * e.all + (1 - base) * e.shape;
    float clear = (1 - m->metallic) * m->transmission, solid = 1 - m->metallic - clear;
    float coat = vec3_dot(m->clearcoat_normal, view->wo) > 0 ? view->coat : 0;
    float under = 1 - coat;
    MetallicChoices c = {
        .coat = coat,
        .mirror = under * (solid * face + clear * sheet + m->metallic * metal),
        .diffuse = under * (base * (solid * (1 - m->across) * (1 - face) +
                                    m->metallic * base * (1 - e.all)) +
                            clear * sheet * (1 - e.all)),
        .through = under * base * clear * (1 - sheet),
        .across = 0,
    };
    if (m->across > 0)
        c.across = under * solid * (1 - face) * spectrum_mean(lambert_across(m));
    return c;
}

/* A coat holds light back that passes a sheet: part of it is sent back by its turns. What its
 * facets hide, and fibres send from below, leaves on both sides. */
static MetallicChoices choose_turns(const MetallicView *view, MetallicChoices c)
{
    const MetallicRoughness *m = view->m;
    CoatOnSheet coat = coat_on_sheet(m, &view->through, &view->through);
    SheetFaces  faces = sheet_faces(m, &view->boundary, view->wo.z);
    SheetLight  turned = sheet_turns(&faces, coat.held), spread = sheet_rebound(view);
    float front = spectrum_mean(faces.front), through = spectrum_mean(faces.through);
    float back = spectrum_mean(turned.back), on = spectrum_mean(turned.through);
    float hidden = is_covered(m) ? view->covered.rest.metal
                                 : view->through.open * (1 - view->energy.all);
    if (through > 0) { /* the sum of both stays as it was */
        float left = (front + through) * on / ((back + on) * through);
        float moved = c.through * m->clearcoat * fmaxf(1 - left, 0);
        c.mirror += moved;
        c.through -= moved;
    }
    c.diffuse += m->clearcoat * hidden * spectrum_mean(spread.back);
    if (is_covered(m)) c.across += m->clearcoat * hidden * spectrum_mean(spread.through);
    return c;
}

static void set_film(MetallicView *view)
{
    view->coated = spectrum_all(0);
    if (!(view->m->metallic < 1)) return;
    for (int i = 0; i < LOBE_FACETS; i++)
        view->film[i] = boundary_reflectance(view->m, &view->boundary, facet_cosine[i]);
    view->coated = filmed_energy(view, view->wo);
}

/* Layers that a surface does not have leave their members as they were. */
static void set_layers(MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    if (m->clearcoat > 0) {
        view->through = coat_through(m, view->wo);
        view->coat_mean = coat_mean(m->coat, m->alpha, m->clearcoat_alpha);
    }
    if (coated_face(m)) view->coated = coated_energy(m, view->wo);
    if (has_film(m)) set_film(view);
}

/* Filled where it stands: it is large, and a plain surface needs little of it. */
static inline void set_view(MetallicView *view, const MetallicRoughness *m, Vec3 wo)
{
    view->m = m;
    view->wo = wo;
    view->boundary = boundary_of(m);
    view->energy = base_energy(m, wo);
    view->coat = coat_albedo(m, wo);
    set_layers(view);
    if (is_covered(m)) set_covered(view);
    MetallicChoices choices = choose(view);
    if (has_sheen(m)) {
        view->sheen = sheen_towards(m, wo);
        view->sheen_mean = sheen_mean(&common_sheen_table, m->sheen_alpha, even_alpha(m));
        choices = beside_sheen(view, choices);
    }
    if (has_sheet_under_coat(m)) choices = choose_turns(view, choices);
    view->choices = scaled_to_one(choices);
    if (has_lambert(m)) view->lambert = lambert_towards(view);
}

static void model_look(void *parameters, Vec3 wo, void *room)
{
    MetallicRoughness *m = parameters;
    MetallicView *view = room;
    m->seen = NULL;
    if (!(wo.z > 0)) return;
    set_view(view, m, wo);
    m->seen = view;
}

/* What was kept, if it is of this eye; else what is made now. A copy of the material may still
 * point at what was kept for the first. */
static inline const MetallicView *view_towards(const MetallicRoughness *m, Vec3 wo,
                                               MetallicView *own)
{
    const MetallicView *seen = m->seen;
    if (seen && seen->m == m && seen->wo.x == wo.x && seen->wo.y == wo.y && seen->wo.z == wo.z)
        return seen;
    set_view(own, m, wo);
    return own;
}

/* A facet of the base met at `cosine`, as the light of both directions finds it: below NULL: no
 * coat lies on it. */
static Spectrum facet_below(const MetallicView *view, float cosine, const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    Spectrum nonmetal = facet_of_nonmetal(m, &view->boundary, cosine);
    Spectrum metal = facet_of_metal(m, cosine);
    if (!below) return nonmetal + metal;
    if (m->metallic > 0)
        metal *= is_covered(m) ?
                     coat_on_mirror(metal_mean(m), fminf(view->through.open, below->open)) :
                     coat_on_metal(m, &view->through, below);
    if (has_sheet_under_coat(m)) {
        SheetFaces faces = sheet_faces(m, &view->boundary, cosine);
        nonmetal -= faces.front * spectrum_all(clear_share(m));
        nonmetal = spectrum_max(nonmetal, spectrum_all(0));
        metal += sheet_below_coat(view, cosine, below).back;
    }
    return nonmetal * spectrum_all(view->through.open * below->open) + metal;
}

/* Bare and coated, by the coat's share. */
static Spectrum covered(const MetallicRoughness *m, Spectrum bare, Spectrum coated)
{
    return bare + (coated - bare) * spectrum_all(m->clearcoat);
}

/* The base's facets, below the coat where it is (below: of wi). */
static Spectrum facet_lobe(const MetallicView *view, Vec3 wi, const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    Vec3     half = vec3_normalize(vec3_add(view->wo, wi));
    Spectrum facet = facet_below(view, vec3_dot(view->wo, half), NULL);
    if (m->clearcoat > 0)
        facet = covered(m, facet, facet_below(view, vec3_dot(view->wo, half), below));
    return sheen_over(view, wi, facet) * spectrum_all(base_lobe(m, view->wo, wi, half));
}

static Spectrum fibres_towards(const MetallicView *view, Vec3 wi)
{
    const MetallicRoughness *m = view->m;
    float lobe = sheen_lobe(&common_sheen_table, view->wo, wi, m->sheen_alpha);
    return sheen_tint(m) * spectrum_all(lobe);
}

/* Lambert, rebound and fibres under a coat. */
static Spectrum covered_above(const MetallicView *view, Vec3 wi)
{
    const MetallicRoughness *m = view->m;
    CoveredRest     in = rest_along(view, wi);
    Spectrum sum = covered_lambert(view, lambert_back(m), &in) +
                   covered_rebound(view, &in);
    if (has_sheen(m))
        sum += fibres_towards(view, wi) * spectrum_all(view->through.open * coat_open(m, wi));
    return sum;
}

/* All but facets. below: of wi; undefined without a coat. */
static Spectrum spread_by_base(const MetallicView *view, Vec3 wi, Energy in,
                               const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    Spectrum lambert = lambert_back(m);
    Spectrum sum = diffuse_eval(view, lambert, wi, in);
    if (has_rebound(m)) sum += rebound_above(view, wi, in);
    if (has_sheen(m)) sum += fibres_towards(view, wi);
    if (!(m->clearcoat > 0)) return sum;
    if (is_covered(m)) return covered(m, sum, covered_above(view, wi));
    return covered(m, sum, coated_diffuse(view, lambert, in, below) +
                               coated_rebound(view, in, below));
}

/* The base seen from above: rough mirror, Lambert, rebound; and its part of the pdf. */
static Spectrum base_above(const MetallicView *view, Vec3 wi, float *pdf)
{
    const MetallicRoughness *m = view->m;
    ThroughCoat  below;
    Energy   in = base_energy(m, wi);
    *pdf = view->choices.diffuse * wi.z * INV_PI_F;
    if (m->clearcoat > 0) below = coat_through(m, wi);
    if (has_sheen(m)) *pdf += view->choices.sheen * (0.5f * INV_PI_F);
    Spectrum sum = spread_by_base(view, wi, in, &below);
    if (!is_smooth(m->alpha)) {
        Vec3 half = vec3_normalize(vec3_add(view->wo, wi));
        sum += facet_lobe(view, wi, &below);
        *pdf += view->choices.mirror * base_lobe_pdf(m, view->wo, half);
    }
    return sum;
}

/* Of a sheet's facets: their lobe turned over to the other side, and the cosine to them. */
typedef struct SheetLobe {
    float value, cosine;
} SheetLobe;

/* What a sheet's rebound sends across below the coats of both sides, from below. */
static Spectrum rebound_below_coat(const MetallicView *view, Vec3 wi, Energy in,
                                   const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    float lobe;
    if (is_covered(m)) {
        bool is_tilted = m->clearcoat_normal.z < COAT_UPRIGHT; /* as seen from that side */
        Vec3 up = is_tilted ? vec3_neg(wi) : vec3(wi.x, wi.y, -wi.z);
        CoveredRest rest = rest_along(view, up);
        lobe = covered_rebound_lobe(view, &rest);
    } else {
        lobe = coated_rebound_lobe(view, in) * view->through.open * below->open;
    }
    return lobe > 0 ? sheet_rebound(view).through * spectrum_all(lobe) : spectrum_all(0);
}

/* What goes through a coated sheet, but for what a smooth one passes straight on. bare: what
 * would where no coat lies. lobe: of its facets; cosine: at which they are met. */
static Spectrum below_coat(const MetallicView *view, Vec3 wi, Energy in, Spectrum bare,
                           const SheetLobe *lobe)
{
    const MetallicRoughness *m = view->m;
    ThroughCoat below = coat_through(m, wi);
    Spectrum    sum = rebound_below_coat(view, wi, in, &below);
    if (lobe->value > 0)
        sum += sheen_over(view, wi, sheet_below_coat(view, lobe->cosine, &below).through) *
               spectrum_all(lobe->value);
    return covered(m, bare, sum);
}

/* Does a sheet send light to the other side, elsewhere than straight on? A smooth one does with
 * what its coats hold back of the light that fibres spread. */
static inline bool sends_below(const MetallicRoughness *m)
{
    return m->transmission > 0 &&
           (!is_smooth(m->alpha) || (m->clearcoat > 0 && has_sheen(m)));
}

/* A rough sheet sends on what a mirror would send back, turned over to the other side, and its
 * part of the rebound. */
static Spectrum base_below(const MetallicView *view, Vec3 wi, float *pdf)
{
    const MetallicRoughness *m = view->m;
    *pdf = 0;
    if (!sends_below(m)) return spectrum_all(0);
    Vec3      up = vec3(wi.x, wi.y, -wi.z);
    Energy    in = base_energy(m, up);
    SheetLobe none = {0, 0};
    if (is_smooth(m->alpha)) return below_coat(view, wi, in, spectrum_all(0), &none);
    Vec3   half = vec3_normalize(vec3_add(view->wo, up));
    float  all = view->energy.all, pdf_lobe = base_lobe_pdf(m, view->wo, half);
    *pdf = view->choices.through * (all * pdf_lobe + (1 - all) * up.z * INV_PI_F);
    SheetLobe lobe = {base_lobe(m, view->wo, up, half), vec3_dot(view->wo, half)};
    Spectrum straight = pane_transmittance(m, &view->boundary, lobe.cosine);
    Spectrum spread = pane_mean_through(view) * m->base_color *
                      spectrum_all((1 - m->metallic) * m->transmission);
    Spectrum bare = sheen_over(view, up, straight) * spectrum_all(lobe.value) +
                    spread * spectrum_all(rebound_lobe(view, up, in));
    return m->clearcoat > 0 ? below_coat(view, wi, in, bare, &lobe) : bare;
}

/* Lambert's light from the other side. */
static Spectrum base_across(const MetallicView *view, Vec3 wi)
{
    const MetallicRoughness *m = view->m;
    Vec3     up = vec3(wi.x, wi.y, -wi.z);
    Energy   in = base_energy(m, up);
    Spectrum lambert = lambert_across(m);
    Spectrum sum = diffuse_eval(view, lambert, up, in);
    if (!(m->clearcoat > 0)) return sum;
    if (is_covered(m)) {
        CoveredRest rest = rest_along(view, up);
        return covered(m, sum, covered_lambert(view, lambert, &rest));
    }
    ThroughCoat below = coat_through(m, up);
    return covered(m, sum, coated_diffuse(view, lambert, in, &below));
}

static Spectrum eval_view(const MetallicView *view, Vec3 wi, float *pdf)
{
    const MetallicRoughness *m = view->m;
    Spectrum f = wi.z > 0 ? base_above(view, wi, pdf) : base_below(view, wi, pdf);
    if (view->choices.across > 0 && wi.z < 0)
        *pdf += view->choices.across * -wi.z * INV_PI_F;
    if (m->across > 0 && wi.z < 0) f += base_across(view, wi);
    if (m->clearcoat > 0 && !is_smooth(m->clearcoat_alpha)) {
        float coat_pdf;
        f += spectrum_all(coat_eval(m, view->wo, wi, &coat_pdf));
        *pdf += view->choices.coat * coat_pdf;
    }
    return f;
}

static bool model_reaches(const void *parameters, Vec3 wo, Vec3 wi)
{
    const MetallicRoughness *m = parameters;
    bool lets_through = sends_below(m) || m->across > 0;
    return wo.z > 0 && (wi.z > 0 || (wi.z < 0 && lets_through));
}

static Spectrum model_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf)
{
    const MetallicRoughness *m = parameters;
    *pdf = 0;
    if (!model_reaches(parameters, wo, wi)) return spectrum_all(0);
    MetallicView own;
    const MetallicView *view = view_towards(m, wo, &own);
    return eval_view(view, wi, pdf);
}

static bool sample_smooth(BsdfSample *sample, Vec3 wi, Spectrum value, float prob)
{
    *sample = (BsdfSample){.wi = wi, .weight = value / spectrum_all(prob), .pdf = prob,
                           .is_delta = true};
    return true;
}

/* The smooth coat's mirror image, about the coat's own normal. */
static bool sample_smooth_coat(const MetallicView *view, BsdfSample *sample)
{
    const MetallicRoughness *m = view->m;
    Vec3  wo = view->wo;
    float cosine = vec3_dot(m->clearcoat_normal, wo);
    Vec3  wi = vec3_sub(vec3_scale(m->clearcoat_normal, 2 * cosine), wo);
    float value = m->clearcoat * coat_facet(cosine) * coat_tilt(m, wo, wi);
    if (!(value > 0)) return false;
    /* Tilted cosines: the lobe is per cosine to the coat, the surface's cosine carries it. */
    return sample_smooth(sample, wi, spectrum_all(value * wi.z / cosine), view->choices.coat);
}

static Spectrum smooth_base(const MetallicView *view, Vec3 wi)
{
    Spectrum bare = facet_below(view, wi.z, NULL);
    if (!(view->m->clearcoat > 0)) return sheen_over(view, wi, bare);
    ThroughCoat below = coat_through(view->m, wi);
    return sheen_over(view, wi, covered(view->m, bare, facet_below(view, wi.z, &below)));
}

static bool sample_smooth_base(const MetallicView *view, BsdfSample *sample)
{
    Vec3 wi = vec3(-view->wo.x, -view->wo.y, view->wo.z);
    return sample_smooth(sample, wi, smooth_base(view, wi), view->choices.mirror);
}

static Spectrum model_mirror(const void *parameters, Vec3 wo)
{
    const MetallicRoughness *m = parameters;
    bool     is_upright = m->clearcoat_normal.z >= COAT_UPRIGHT;
    float    coat = is_upright && is_smooth(m->clearcoat_alpha) ? m->clearcoat : 0;
    if (!(wo.z > 0)) return spectrum_all(0);
    Spectrum by_coat = spectrum_all(coat > 0 ? coat * coat_facet(wo.z) : 0);
    if (!is_smooth(m->alpha)) return by_coat;
    MetallicView own;
    const MetallicView *view = view_towards(m, wo, &own);
    return by_coat + smooth_base(view, vec3(-wo.x, -wo.y, wo.z));
}

static Spectrum model_glint(const void *parameters, Vec3 wo, Vec3 wi)
{
    const MetallicRoughness *m = parameters;
    ThroughCoat below;
    bool    is_glint = !is_smooth(m->alpha) && m->alpha <= GLINT_ALPHA && !is_brushed(m);
    if (!(wo.z > 0 && wi.z > 0 && is_glint)) return spectrum_all(0);
    MetallicView own;
    const MetallicView *view = view_towards(m, wo, &own);
    if (m->clearcoat > 0) below = coat_through(m, wi);
    return facet_lobe(view, wi, &below);
}

static Spectrum model_pass(const void *parameters, Vec3 wo)
{
    const MetallicRoughness *m = parameters;
    if (!is_smooth(m->alpha) || !(m->transmission > 0) || !(wo.z > 0)) return spectrum_all(0);
    MetallicFace b = boundary_of(m);
    float    kept = has_sheen(m) ? sqrtf(kept_by_sheen(m, wo.z)) : 1;
    Spectrum through = pane_transmittance(m, &b, wo.z);
    if (m->clearcoat > 0) {
        float      open = coat_open(m, wo);
        SheetFaces faces = sheet_faces(m, &b, wo.z);
        Spectrum   turned = sheet_turns(&faces, 1 - open).through;
        through = covered(m, through, turned * spectrum_all(clear_share(m) * open * open));
    }
    return through * spectrum_all(kept * kept);
}

typedef enum Part {
    PART_COAT,
    PART_MIRROR,
    PART_DIFFUSE,
    PART_THROUGH,
    PART_ACROSS,
    PART_SHEEN,
    PART_NONE
} Part;

/* Which part u falls on; it becomes the place inside that part: directions of every part then
 * are spread as well as their share of u is. */
static Part choose_part(const MetallicChoices *choices, float *u)
{
    const float prob[] = {choices->coat, choices->mirror, choices->diffuse, choices->through,
                          choices->across, choices->sheen};
    for (int part = 0; part < PART_NONE; part++) {
        if (*u < prob[part]) {
            *u = fminf(*u / prob[part], 0x1.fffffep-1f);
            return (Part)part;
        }
        *u -= prob[part];
    }
    return PART_NONE;
}

static Vec3 anywhere_above(float u0, float u1)
{
    float sine, cosine, side = safe_sqrtf(1 - u1 * u1);
    sincos_turns(u0, &sine, &cosine);
    return vec3(side * cosine, side * sine, u1);
}

static Vec3 turned_over(Vec3 w)
{
    return vec3(w.x, w.y, -w.z);
}

/* A direction by the rough coat, the rough mirror, the Lambert base, fibres or rough sheet. */
static Vec3 sample_rough(const MetallicView *view, Part part, const float u[3])
{
    const MetallicRoughness *m = view->m;
    if (part == PART_COAT) {
        Frame frame = coat_frame(m);
        Vec3  out = frame_to_local(&frame, view->wo);
        return frame_to_world(&frame,
                              ggx_sample_reflection(out, m->clearcoat_alpha, u[0], u[1]));
    }
    if (part == PART_MIRROR) return base_sample(m, view->wo, u[0], u[1]);
    if (part == PART_DIFFUSE) return microfacet_cosine(u[0], u[1]);
    if (part == PART_SHEEN) return anywhere_above(u[0], u[1]);
    if (part == PART_ACROSS) return turned_over(microfacet_cosine(u[0], u[1]));
    bool by_facet = u[2] < view->energy.all;
    Vec3 up = by_facet ? base_sample(m, view->wo, u[0], u[1])
                       : microfacet_cosine(u[0], u[1]);
    return turned_over(up);
}

static bool model_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample)
{
    const MetallicRoughness *m = parameters;
    if (!(wo.z > 0)) return false;
    MetallicView own;
    const MetallicView *view = view_towards(m, wo, &own);
    float v[3] = {u[0], u[1], u[2]};
    Part  part = choose_part(&view->choices, &v[0]);
    if (part == PART_NONE) return false;
    if (part == PART_COAT && is_smooth(m->clearcoat_alpha))
        return sample_smooth_coat(view, sample);
    if (part == PART_MIRROR && is_smooth(m->alpha)) return sample_smooth_base(view, sample);
    if (part == PART_THROUGH && is_smooth(m->alpha)) {
        sample_smooth(sample, vec3_neg(wo), model_pass(m, wo), view->choices.through);
        return sample->passes = true;
    }
    Vec3 wi = sample_rough(view, part, v);
    if (!(part == PART_THROUGH || part == PART_ACROSS ? wi.z < 0 : wi.z > 0)) return false;
    float    pdf;
    Spectrum f = eval_view(view, wi, &pdf);
    if (!(pdf > 0)) return false;
    *sample = (BsdfSample){.wi = wi, .weight = f * spectrum_all(fabsf(wi.z) / pdf), .pdf = pdf};
    return true;
}

static bool model_scatters(const void *parameters)
{
    const MetallicRoughness *m = parameters;
    bool has_base = (1 - m->metallic) * (1 - m->transmission) > 0;
    bool has_coat = m->clearcoat > 0 && !is_smooth(m->clearcoat_alpha);
    return has_base || has_coat || !is_smooth(m->alpha) || has_sheen(m);
}

/* f0 of the non-metal and of the metal, and what the face sends back in all. */
static void lobe_shares(const MetallicView *view, float *nonmetal, float *metal, float *face)
{
    const MetallicRoughness *m = view->m;
    Energy e = view->energy;
    *metal = spectrum_mean(m->base_color);
    *nonmetal = spectrum_mean(view->boundary.f0);
    *face = *nonmetal * e.all + (m->specular - *nonmetal) * e.shape;
    if (coated_metal(m))
        *metal = spectrum_mean(coating_at(m->coating->metal->front, m->wavelengths, 1));
    if (!coated_face(m)) return;
    *nonmetal = m->specular *
                spectrum_mean(coating_at(m->coating->face->front, m->wavelengths, 1));
    *face = spectrum_mean(view->coated);
}

/* A rough coat is left out: it is rare. Where light crosses nothing is said: lobes are on wo's
 * side, and light from behind would be left to few samples. */
static void model_lobes(const void *parameters, Vec3 wo, BsdfLobes *lobes)
{
    const MetallicRoughness *m = parameters;
    if (!(wo.z > 0) || m->across > 0) return;
    MetallicView own;
    const MetallicView *view = view_towards(m, wo, &own);
    float base = spectrum_mean(m->base_color), solid = 1 - m->metallic, under = 1 - view->coat;
    float f0, metal, face;
    lobe_shares(view, &f0, &metal, &face);
    lobes->prob = view->choices.diffuse;
    lobes->diffuse = under * solid * (1 - m->transmission) * (1 - face) * base;
    if (has_sheen(m)) { /* fibres spread it as widely */
        float left = 1 - sheen_most(m) * view->sheen.albedo;
        lobes->prob += view->choices.sheen;
        lobes->diffuse = lobes->diffuse * left +
                         under * view->sheen.albedo * spectrum_mean(sheen_tint(m));
    }
    float alpha = is_brushed(m) ? sqrtf(m->alpha_along * m->alpha) : m->alpha;
    if (alpha < WIDE_ALPHA) return;
    lobes->prob += view->choices.mirror;
    lobes->f0 = under * (solid * f0 + m->metallic * metal);
    lobes->f90 = under * (solid * m->specular + m->metallic);
    lobes->alpha = alpha;
}

/* The base's albedo by its shares: opaque, sheet, metal. */
static void albedo_parts(const MetallicRoughness *m, Vec3 wo, Spectrum *solid, Spectrum *clear,
                         Spectrum *metal)
{
    Energy   e = base_energy(m, wo);
    MetallicFace b = boundary_of(m);
    Spectrum one = spectrum_all(1), in = let_in(&b, e), base = m->base_color;
    Spectrum sheet = sheet_reflectance(one - in);
    *clear = sheet + (one - sheet) * base;
    if (coated_sheet(m))
        *clear = sheet_at(m, wo.z) +
                 coating_at(m->coating->sheet->through, m->wavelengths, wo.z) * base;
    if (coated_face(m)) in = one - coated_energy(m, wo);
    if (has_film(m)) {
        MetallicView own;
        const MetallicView *view = view_towards(m, wo, &own);
        in = one - view->coated;
        sheet = sheet_reflectance(view->coated);
        *clear = sheet + (one - sheet) * base;
    }
    *solid = (one - in) + in * lambert_albedo(m);
    *metal = base + (one - base) * spectrum_all(e.shape);
    if (coated_metal(m) || has_film(m)) *metal = metal_at(m, wo.z);
}

static Spectrum model_albedo(const void *parameters, Vec3 wo)
{
    const MetallicRoughness *m = parameters;
    if (!(wo.z > 0)) return spectrum_all(0);
    Spectrum solid, clear, metal;
    albedo_parts(m, wo, &solid, &clear, &metal);
    Spectrum dielectric = solid + (clear - solid) * spectrum_all(m->transmission);
    Spectrum mixed = dielectric + (metal - dielectric) * spectrum_all(m->metallic);
    if (has_sheen(m)) {
        float own = sheen_albedo(&common_sheen_table, wo.z, m->sheen_alpha);
        mixed = sheen_tint(m) * spectrum_all(own) +
                mixed * spectrum_all(1 - sheen_most(m) * own);
    }
    if (!(m->clearcoat > 0)) return mixed;
    float    own = coat_albedo(m, wo) / m->clearcoat;
    float    open = coat_mean(m->coat, m->alpha, m->clearcoat_alpha).open;
    Spectrum coated = spectrum_all(own) + mixed * coat_turns(open, mixed) *
                      spectrum_all(1 - own);
    return covered(m, mixed, coated);
}

/* ---- polarisation ------------------------------------------------------------------------ */

/* The base's facets, met at `cosine`, send so much. A metal without
 * n, k is taken for a perfect mirror. */
static void add_facets(const MetallicView *view, float cosine, Spectrum all,
                       PolarisedParts *parts)
{
    static const Waves mirror = {1, 1, -1, 0};
    const MetallicRoughness *m = view->m;
    Spectrum nonmetal = facet_of_nonmetal(m, &view->boundary, cosine);
    Spectrum metal = facet_of_metal(m, cosine);
    Spectrum share = all / spectrum_max(nonmetal + metal, spectrum_all(1e-30f));
    const SurfaceCoating *coating = m->coating;
    if (m->metallic > 0 && coating && coating->metal_waves)
        polarised_add_coated(parts, coating->metal_waves, m->wavelengths, fminf(cosine, 1),
                             share * metal);
    else if (m->metallic > 0)
        polarised_add(parts, mirror, share * metal);
    if (!(m->metallic < 1)) return;
    if (coating && coating->glass_waves && !(m->transmission > 0)) {
        polarised_add_coated(parts, coating->glass_waves, m->wavelengths, fminf(cosine, 1),
                             share * nonmetal);
        return;
    }
    float ior = m->energy->ior;
    Waves face = ior >= 1 ? waves_reflected(fminf(cosine, 1), ior) : mirror;
    Waves sheet = waves_sheet_reflected(face);
    float opaque = (1 - m->transmission) * (face.s + face.p);
    float clear = m->transmission * (sheet.s + sheet.p), both = opaque + clear;
    if (!(both > 0)) return;
    polarised_add(parts, face, share * nonmetal * spectrum_all(opaque / both));
    if (clear > 0) polarised_add(parts, sheet, share * nonmetal * spectrum_all(clear / both));
}

static bool is_near(Vec3 a, Vec3 b)
{
    Vec3 apart = vec3_sub(a, b);
    return vec3_dot(apart, apart) < 1e-6f;
}

/* The images that a smooth coat and a smooth base send along this way. */
static void polarise_smooth(const MetallicView *view, Vec3 wi, PolarisedParts *parts)
{
    const MetallicRoughness *m = view->m;
    float cosine = vec3_dot(m->clearcoat_normal, view->wo);
    Vec3  by_coat = vec3_sub(vec3_scale(m->clearcoat_normal, 2 * cosine), view->wo);
    Vec3  by_base = vec3(-view->wo.x, -view->wo.y, view->wo.z);
    if (m->clearcoat > 0 && is_smooth(m->clearcoat_alpha) && is_near(by_coat, wi))
        polarised_add(parts, waves_reflected(clampf(cosine, 0, 1), CLEARCOAT_IOR),
                      spectrum_all(m->clearcoat * coat_facet(cosine)));
    if (is_smooth(m->alpha) && is_near(by_base, wi))
        add_facets(view, view->wo.z, smooth_base(view, wi), parts);
}

static void polarise_rough(const MetallicView *view, Vec3 wi, PolarisedParts *parts)
{
    const MetallicRoughness *m = view->m;
    Vec3    half = vec3_normalize(vec3_add(view->wo, wi));
    float   pdf, cosine = fminf(fabsf(vec3_dot(view->wo, half)), 1);
    ThroughCoat below;
    if (!is_smooth(m->alpha)) {
        if (m->clearcoat > 0) below = coat_through(m, wi);
        add_facets(view, cosine, facet_lobe(view, wi, &below), parts);
    }
    if (m->clearcoat > 0 && !is_smooth(m->clearcoat_alpha))
        polarised_add(parts, waves_reflected(cosine, CLEARCOAT_IOR),
                      spectrum_all(coat_eval(m, view->wo, wi, &pdf)));
}

/* A rough sheet's straight light is taken for all that it lets through. */
static bool polarise_through(const MetallicRoughness *m, Vec3 wo, BsdfPolarisation *out)
{
    if (!(m->energy->ior >= 1)) return false;
    *out = polarised_by(waves_sheet_through(waves_reflected(fminf(wo.z, 1), m->energy->ior)));
    return true;
}

static bool model_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                           BsdfPolarisation *out)
{
    const MetallicRoughness *m = parameters;
    PolarisedParts parts = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    if (!(wo.z > 0)) return false;
    if (way->passes || way->wi.z < 0) return polarise_through(m, wo, out);
    MetallicView own;
    const MetallicView *view = view_towards(m, wo, &own);
    if (way->is_delta) {
        polarise_smooth(view, way->wi, &parts);
        *out = polarised_of(&parts, parts.share);
    } else {
        float pdf;
        polarise_rough(view, way->wi, &parts);
        *out = polarised_of(&parts, eval_view(view, way->wi, &pdf));
    }
    return true;
}

static float model_sharpest(const void *parameters)
{
    return ((const MetallicRoughness *)parameters)->alpha;
}

static bool model_sends_across(const void *parameters)
{
    return ((const MetallicRoughness *)parameters)->across > 0;
}

const BsdfModel metallic_roughness_model = {.eval = model_eval,
                                            .reaches = model_reaches, .sample = model_sample,
                                            .pass = model_pass, .mirror = model_mirror,
                                            .glint = model_glint,
                                            .scatters = model_scatters, .lobes = model_lobes,
                                            .albedo = model_albedo, .look = model_look,
                                            .polarise = model_polarise,
                                            .sharpest = model_sharpest,
                                            .sends_across = model_sends_across};
