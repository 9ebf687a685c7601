/* SPDX-License-Identifier: Apache-2.0 */
/* bsdf.h -- how one surface point scatters light, by any model.
 *
 * Frame    local: +z is the shading normal on the side of wo's surface (wo.z > 0 always holds
 *          for surfaces that do not transmit). wo points to the eye, wi to the light; both
 *          leave the surface. Unit vectors.
 * Units    eval in sr^-1 WITHOUT the cosine; pdf in sr^-1; weight without unit.
 * Threads  plain values.
 *
 * Each model is one file in shaders/, its user page on top.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/solid_facet.h"
#include "shaders/solid_pane.h"
#include "shaders/thin_window.h"
#include "shaders/display.h"
#include "shaders/glazing.h"
#include "shaders/metallic_roughness.h"

/* Every model once: MODEL(KIND, name, Parameters) makes the kind BSDF_KIND, the member `name`
 * of Bsdf, and the row of bsdf.c's table for `name_model`, which the model's file defines. */
#define BSDF_MODELS(MODEL) \
    MODEL(METALLIC_ROUGHNESS, metallic_roughness, MetallicRoughness) \
    MODEL(THIN_WINDOW, thin_window, ThinWindow) \
    MODEL(GLAZED_WINDOW, glazed_window, GlazedWindow) \
    MODEL(DIELECTRIC, dielectric, Dielectric) \
    MODEL(SOLID_PANE, solid_pane, SolidPane) \
    MODEL(DISPLAY, display, DisplaySurface)

#define BSDF_KIND(KIND, name, Parameters) BSDF_##KIND,
#define BSDF_MEMBER(KIND, name, Parameters) Parameters name;

typedef enum BsdfKind {
    BSDF_BLACK, /* absorbs everything (unlit materials, backs of displays) */
    BSDF_MODELS(BSDF_KIND)
} BsdfKind;

typedef struct Bsdf {
    BsdfKind kind;
    union {
        BSDF_MODELS(BSDF_MEMBER)
    };
} Bsdf;

/* bsdf_be_NAME: becomes that model; its parameters are to be set. */
#define BSDF_BE(KIND, name, Parameters) \
    static inline Parameters *bsdf_be_##name(Bsdf *bsdf) { \
        bsdf->kind = BSDF_##KIND; \
        return &bsdf->name; \
    }
BSDF_MODELS(BSDF_BE)

static inline void bsdf_be_black(Bsdf *bsdf) {
    bsdf->kind = BSDF_BLACK;
}

/* Memory for what bsdf_look computes for one wo; undefined before. */
typedef union BsdfRoom {
    MetallicView metallic_roughness;
} BsdfRoom;

/* Prepares for several queries about one wo, which take less work from then on. All results,
 * also for other directions, stay what they were. The room must outlive the queries, and the
 * surface must not change before the next look. */
void bsdf_look(Bsdf *bsdf, Vec3 wo, BsdfRoom *room);

/* BSDF without its delta parts; *pdf: the density with which bsdf_sample would choose wi
 * through its non-delta parts (including the probability of choosing them). */
Spectrum bsdf_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi, float *pdf);

/* False: eval is 0 there. A cheap test. */
bool bsdf_reaches(const Bsdf *bsdf, Vec3 wo, Vec3 wi);

/* False: absorbed. u in [0,1)^3. */
bool bsdf_sample(const Bsdf *bsdf, Vec3 wo, const float u[3], BsdfSample *sample);

/* Share of the light that passes straight through from -wo to wo (thin windows); else 0. */
Spectrum bsdf_pass(const Bsdf *bsdf, Vec3 wo);

/* Share of the light that a smooth boundary about +z sends to wo from its mirror direction
 * (-wo.x, -wo.y, wo.z): the probability with which bsdf_sample would choose it, times that
 * choice's weight. */
Spectrum bsdf_mirror(const Bsdf *bsdf, Vec3 wo);

/* The part of eval that a nearly smooth boundary's facets send on (GGX about +z, GLINT_ALPHA
 * at most): too narrow to be found by chance. */
Spectrum bsdf_glint(const Bsdf *bsdf, Vec3 wo, Vec3 wi);

/* Has it any part that light sampling can hit? (false: only delta parts, or black) */
bool bsdf_scatters(const Bsdf *bsdf);

/* The wide lobes on wo's side. */
BsdfLobes bsdf_lobes(const Bsdf *bsdf, Vec3 wo);

/* The effect of scattering from way->wi to wo on polarised light; of `way` wi, is_delta,
 * passes and along are read. False: the light that leaves is unpolarised. */
bool bsdf_polarise(const Bsdf *bsdf, Vec3 wo, const BsdfSample *way, BsdfPolarisation *out);

bool bsdf_is(const Bsdf *bsdf, BsdfTrait trait);

/* GGX alpha of its lobe; INFINITY: it has none. */
float bsdf_sharpest(const Bsdf *bsdf);

/* Shift along a pane, m, of a ray that goes straight through it, in the direction in which the
 * ray runs along the pane (below 0: back). cosine: of its angle to the normal, (0, 1]. 0: the
 * surface has no thickness. */
float bsdf_shift(const Bsdf *bsdf, float cosine);

/* From now on bsdf_sample leaves out the light that passes a pane, which is followed
 * separately. False: the surface shows nothing but its mirror image. */
bool bsdf_show_itself(Bsdf *bsdf);

/* Sets the path's throughput, per lane, which must outlive it: a boundary of dispersive glass
 * draws a lane by it. */
void bsdf_carry(Bsdf *bsdf, const Spectrum *light);

/* Does it send light diffusely to its other side? */
bool bsdf_sends_across(const Bsdf *bsdf);

/* Has it a lambertian part that is known separately? And that part's share, per lane, of what
 * the surface scatters from wi: 0 to 1. */
bool bsdf_has_lambertian(const Bsdf *bsdf);
Spectrum bsdf_lambertian_share(const Bsdf *bsdf, Vec3 wo, Vec3 wi);

/* Is what it sends from wi to wo, in its mirror direction too, extrapolated from measurements
 * of other directions? False of all that is not measured at all. */
bool bsdf_is_extrapolated(const Bsdf *bsdf, Vec3 wo, Vec3 wi);

/* Directional-hemispherical reflectance plus transmittance, estimated: for the albedo layer
 * and for roulette, not for transport. */
Spectrum bsdf_albedo(const Bsdf *bsdf, Vec3 wo);
