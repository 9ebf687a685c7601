/* SPDX-License-Identifier: Apache-2.0 */
/* bsdf_model.h -- what a surface model is to the rest of the program: its functions.
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
    float    along;    /* m: the light comes from so far along the surface, where wi leans to
                          (images of a pane's far face); else 0 */
    bool     passes;   /* went straight through (wi = -wo): shadow rays pass here too, so it is
                          no scattering event for multiple importance sampling */
} BsdfSample;

/* What scattering does to polarised light, over what it does to unpolarised light, per lane:
 * [1 d 0 0; d k 0 0; 0 0 c -t; 0 0 t c] in the axes of polarisation.h. */
typedef struct BsdfPolarisation {
    Spectrum difference; /* d, of light across and along the plane; [-1, 1] */
    Spectrum kept;       /* k, share of what is scattered that the boundary sends; [0, 1] */
    Spectrum along, turned; /* c, t */
} BsdfPolarisation;

/* What a surface scatters over more than some ten degrees, about: for choosing where to look
 * for light, not for transport. */
typedef struct BsdfLobes {
    float prob;    /* that bsdf_sample chooses one of them; 0: the rest says nothing */
    float diffuse; /* albedo of Lambert's */
    float f0, f90; /* reflectance of GGX facets met upright and grazing; 0: no such lobe */
    float alpha;
} BsdfLobes;

/* What kind of thing it is, for whoever follows light past it. */
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
    /* way: wi, is_delta, passes and along are told. False or NULL: all becomes unpolarised. */
    bool     (*polarise)(const void *parameters, Vec3 wo, const BsdfSample *way,
                         BsdfPolarisation *out);
    /* What few models have; NULL: it has not. */
    float    (*sharpest)(const void *parameters);
    float    (*index)(const void *parameters);
    float    (*shift)(const void *parameters, float cosine);
    void     (*show_itself)(void *parameters);
    void     (*carry)(void *parameters, const Spectrum *light);
    bool     (*sends_across)(const void *parameters);
    Spectrum (*lambertian)(const void *parameters, Spectrum f, Vec3 wi);
} BsdfModel;
