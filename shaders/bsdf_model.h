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
    Vec3 wi;
    Spectrum weight; /* eval * |cos wi| / pdf */
    float pdf;       /* sr^-1 of eval's part; probability of the choice when is_delta */
    bool is_delta;   /* light sampling can never produce this direction */
    float along;     /* m: shift along the surface, towards wi, of the point that the light
                        comes from (images of a pane's far face); else 0 */
    bool passes;     /* went straight through (wi = -wo): shadow rays pass here too, so it is
                        no scattering event for multiple importance sampling */
} BsdfSample;

/* Mueller matrix of scattering, over its first element, per lane: [1 d 0 0; d k 0 0; 0 0 c -t;
 * 0 0 t c] in the axes of polarisation.h. */
typedef struct BsdfPolarisation {
    Spectrum difference;    /* d, of light across and along the plane; [-1, 1] */
    Spectrum kept;          /* k, share of what is scattered that the boundary sends; [0, 1] */
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

/* Traits that decide how a path goes on past a surface, and what is known of it. */
typedef enum BsdfTrait {
    BSDF_IS_SHEET = 1, /* thin, and light goes straight through: shadow rays pass, and an eye's
                          ray follows what lies behind besides what the sheet shows */
    BSDF_REFRACTS = 2, /* the boundary of a solid, which light crosses bent */
    BSDF_HAS_LAMBERTIAN = 4, /* a lambertian part that is known separately */
    BSDF_SHOWS_ITSELF = 8,   /* it can leave out what passes it (BsdfSetting) */
} BsdfTrait;

/* What one surface point is, whatever the directions. All 0: it has none of these. */
typedef struct BsdfFacts {
    bool scatters;     /* has a part that light samples can hit */
    bool sends_across; /* sends light diffusely to its other side */
    float alpha;       /* GGX alpha of its lobe; INFINITY: it has none */
} BsdfFacts;

/* Known of the queries to come; a model takes what it has a use for. */
typedef struct BsdfSetting {
    const Vec3 *wo;        /* of all queries from now on; NULL: any */
    void *room;            /* with wo: the model's own member of BsdfRoom */
    const Spectrum *light; /* the path's throughput, per lane; NULL: not known */
    bool shows_itself;     /* sampling leaves out what passes straight through */
} BsdfSetting;

/* Parts of what goes from wi to wo that are known separately. */
typedef enum BsdfPart {
    BSDF_GLINT,       /* of eval, sr^-1: by the facets of a nearly smooth boundary */
    BSDF_LAMBERTIAN,  /* share of eval, 0 to 1 */
    BSDF_EXTRAPOLATED /* 1: all of it is read from measurements of other directions */
} BsdfPart;

/* Scattering, of which light samples and BSDF samples are two estimators. */
typedef struct BsdfScatter {
    Spectrum (*eval)(const void *parameters, Vec3 wo, Vec3 wi, float *pdf);
    bool (*sample)(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample);
    bool (*reaches)(const void *parameters, Vec3 wo, Vec3 wi); /* NULL: may, everywhere */
    Spectrum (*albedo)(const void *parameters, Vec3 wo);
    void (*lobes)(const void *parameters, Vec3 wo, BsdfLobes *lobes);
} BsdfScatter;

/* The smooth boundary: light that goes on in one direction. */
typedef struct BsdfBoundary {
    Spectrum (*mirror)(const void *parameters, Vec3 wo);
    Spectrum (*pass)(const void *parameters, Vec3 wo);
    float (*shift)(const void *parameters, float cosine);
} BsdfBoundary;

typedef struct BsdfModel {
    unsigned traits; /* of BsdfTrait */
    BsdfScatter scatter;
    BsdfBoundary boundary;
    void (*facts)(const void *parameters, BsdfFacts *facts);
    void (*set)(void *parameters, const BsdfSetting *setting);
    Spectrum (*part)(const void *parameters, BsdfPart part, Vec3 wo, Vec3 wi);
    /* way: wi, is_delta, passes and along are set. False or NULL: all becomes unpolarised. */
    bool (*polarise)(const void *parameters, Vec3 wo, const BsdfSample *way, BsdfPolarisation *out);
} BsdfModel;
