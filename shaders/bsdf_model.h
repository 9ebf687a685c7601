/* SPDX-License-Identifier: Apache-2.0 */
/* bsdf_model.h -- a surface model as the rest of the program calls it: its functions.
 *
 * Each model's file defines one const BsdfModel; the list in bsdf.h takes it in. `parameters`
 * points at the model's own struct. A function that is NULL is that of a surface which absorbs
 * everything. Frame, units and sense of directions are those of bsdf.h, as is what each
 * function promises.
 */
#pragma once
#include "base/vec.h"
#include "spectrum/spectrum.h"

/* One chosen direction of scattered light. */
typedef struct BsdfSample {
    Vec3     wi;
    Spectrum weight;   /* eval * |cos wi| / pdf */
    float    pdf;      /* sr^-1 of eval's part; probability of the choice when is_delta */
    bool     is_delta; /* light sampling can never produce this direction */
    float    along;    /* m: shift along the surface, towards wi, of the point that the light
                          comes from (images of a pane's far face); else 0 */
    bool     passes;   /* went straight through (wi = -wo): shadow rays pass here too, so it is
                          no scattering event for multiple importance sampling */
} BsdfSample;

/* Mueller matrix of scattering, over its first element, per lane: [1 d 0 0; d k 0 0; 0 0 c -t;
 * 0 0 t c] in the axes of polarisation.h. */
typedef struct BsdfPolarisation {
    Spectrum difference; /* d, of light across and along the plane; [-1, 1] */
    Spectrum kept;       /* k, share of what is scattered that the boundary sends; [0, 1] */
    Spectrum along, turned; /* c, t */
} BsdfPolarisation;

/* The lobes of a surface that are wider than some ten degrees, approximately: for choosing
 * where to look for light, not for transport. */
typedef struct BsdfLobes {
    float prob;    /* that bsdf_sample chooses one of them; 0: the rest is undefined */
    float diffuse; /* albedo of Lambert's */
    float f0, f90; /* reflectance of GGX facets met upright and grazing; 0: no such lobe */
    float alpha;
} BsdfLobes;

/* Traits that decide how a path goes on past a surface. */
typedef enum BsdfTrait {
    BSDF_IS_SHEET = 1, /* thin, and light goes straight through: shadow rays pass, and an eye's
                          ray follows what lies behind besides what the sheet shows */
    BSDF_REFRACTS = 2, /* the boundary of a solid, which light crosses bent */
} BsdfTrait;

typedef struct BsdfModel {
    unsigned traits; /* of BsdfTrait */
    /* room: the model's own member of BsdfRoom. NULL: nothing is kept. */
    void     (*look)(void *parameters, Vec3 wo, void *room);
    Spectrum (*eval)(const void *parameters, Vec3 wo, Vec3 wi, float *pdf);
    bool     (*reaches)(const void *parameters, Vec3 wo, Vec3 wi); /* NULL: may, everywhere */
    bool     (*sample)(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample);
    Spectrum (*pass)(const void *parameters, Vec3 wo);
    Spectrum (*mirror)(const void *parameters, Vec3 wo);
    Spectrum (*glint)(const void *parameters, Vec3 wo, Vec3 wi);
    bool     (*scatters)(const void *parameters);
    void     (*lobes)(const void *parameters, Vec3 wo, BsdfLobes *lobes);
    Spectrum (*albedo)(const void *parameters, Vec3 wo);
    /* way: wi, is_delta, passes and along are set. False or NULL: all becomes unpolarised. */
    bool     (*polarise)(const void *parameters, Vec3 wo, const BsdfSample *way,
                         BsdfPolarisation *out);
    /* Few models have these; NULL: not this one. */
    float    (*sharpest)(const void *parameters);
    float    (*index)(const void *parameters);
    float    (*shift)(const void *parameters, float cosine);
    void     (*show_itself)(void *parameters);
    void     (*carry)(void *parameters, const Spectrum *light);
    bool     (*sends_across)(const void *parameters);
    Spectrum (*lambertian)(const void *parameters, Spectrum f, Vec3 wi);
    bool     (*is_extrapolated)(const void *parameters, Vec3 wo, Vec3 wi);
} BsdfModel;
