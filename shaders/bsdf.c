/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/bsdf.h"

#include <math.h>

#define TABLE_ROW(KIND, name, Parameters) [BSDF_##KIND] = &name##_model,

static const BsdfModel black_model;

static const BsdfModel *const models[] = {[BSDF_BLACK] = &black_model, BSDF_MODELS(TABLE_ROW)};

/* All members of the union begin where this one does. */
static inline const void *parameters_of(const Bsdf *bsdf)
{
    return &bsdf->metallic_roughness;
}

void bsdf_look(Bsdf *bsdf, Vec3 wo, BsdfRoom *room)
{
    const BsdfModel *model = models[bsdf->kind];
    if (model->look) model->look(&bsdf->metallic_roughness, wo, room);
}

Spectrum bsdf_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi, float *pdf)
{
    const BsdfModel *model = models[bsdf->kind];
    if (model->eval) return model->eval(parameters_of(bsdf), wo, wi, pdf);
    *pdf = 0;
    return spectrum_all(0);
}

bool bsdf_reaches(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->eval && (!model->reaches || model->reaches(parameters_of(bsdf), wo, wi));
}

bool bsdf_sample(const Bsdf *bsdf, Vec3 wo, const float u[3], BsdfSample *sample)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->sample && model->sample(parameters_of(bsdf), wo, u, sample);
}

Spectrum bsdf_pass(const Bsdf *bsdf, Vec3 wo)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->pass ? model->pass(parameters_of(bsdf), wo) : spectrum_all(0);
}

Spectrum bsdf_mirror(const Bsdf *bsdf, Vec3 wo)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->mirror ? model->mirror(parameters_of(bsdf), wo) : spectrum_all(0);
}

Spectrum bsdf_glint(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->glint ? model->glint(parameters_of(bsdf), wo, wi) : spectrum_all(0);
}

bool bsdf_scatters(const Bsdf *bsdf)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->scatters && model->scatters(parameters_of(bsdf));
}

BsdfLobes bsdf_lobes(const Bsdf *bsdf, Vec3 wo)
{
    const BsdfModel *model = models[bsdf->kind];
    BsdfLobes lobes = {0};
    if (model->lobes) model->lobes(parameters_of(bsdf), wo, &lobes);
    return lobes;
}

Spectrum bsdf_albedo(const Bsdf *bsdf, Vec3 wo)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->albedo ? model->albedo(parameters_of(bsdf), wo) : spectrum_all(0);
}

bool bsdf_polarise(const Bsdf *bsdf, Vec3 wo, const BsdfSample *way, BsdfPolarisation *out)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->polarise && model->polarise(parameters_of(bsdf), wo, way, out);
}

bool bsdf_is(const Bsdf *bsdf, BsdfTrait trait)
{
    return (models[bsdf->kind]->traits & (unsigned)trait) != 0;
}

float bsdf_sharpest(const Bsdf *bsdf)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->sharpest ? model->sharpest(parameters_of(bsdf)) : INFINITY;
}

float bsdf_index(const Bsdf *bsdf)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->index ? model->index(parameters_of(bsdf)) : 0;
}

float bsdf_shift(const Bsdf *bsdf, float cosine)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->shift ? model->shift(parameters_of(bsdf), cosine) : 0;
}

bool bsdf_show_itself(Bsdf *bsdf)
{
    const BsdfModel *model = models[bsdf->kind];
    if (model->show_itself) model->show_itself(&bsdf->metallic_roughness);
    return model->show_itself != NULL;
}

void bsdf_carry(Bsdf *bsdf, const Spectrum *light)
{
    const BsdfModel *model = models[bsdf->kind];
    if (model->carry) model->carry(&bsdf->metallic_roughness, light);
}

bool bsdf_sends_across(const Bsdf *bsdf)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->sends_across && model->sends_across(parameters_of(bsdf));
}

bool bsdf_has_lambertian(const Bsdf *bsdf)
{
    return models[bsdf->kind]->lambertian != NULL;
}

Spectrum bsdf_lambertian_share(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    const BsdfModel *model = models[bsdf->kind];
    float            pdf;
    if (!model->lambertian) return spectrum_all(0);
    return model->lambertian(parameters_of(bsdf), bsdf_eval(bsdf, wo, wi, &pdf), wi);
}

bool bsdf_is_extrapolated(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    const BsdfModel *model = models[bsdf->kind];
    return model->is_extrapolated && model->is_extrapolated(parameters_of(bsdf), wo, wi);
}
