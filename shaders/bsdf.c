/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/bsdf.h"

#include <math.h>

#define TABLE_ROW(KIND, name, Parameters) [BSDF_##KIND] = &name##_model,

static const BsdfModel black_model;

static const BsdfModel *const models[] = {[BSDF_BLACK] = &black_model, BSDF_MODELS(TABLE_ROW)};

/* All members of the union begin where this one does. */
static inline const void *parameters_of(const Bsdf *bsdf) {
    return &bsdf->metallic_roughness;
}

static void set(Bsdf *bsdf, const BsdfSetting *setting) {
    const BsdfModel *model = models[bsdf->kind];
    if (model->set) model->set(&bsdf->metallic_roughness, setting);
}

static BsdfFacts facts_of(const Bsdf *bsdf) {
    const BsdfModel *model = models[bsdf->kind];
    BsdfFacts facts = {.alpha = INFINITY};
    if (model->facts) model->facts(parameters_of(bsdf), &facts);
    return facts;
}

static Spectrum part_of(const Bsdf *bsdf, BsdfPart part, Vec3 wo, Vec3 wi) {
    const BsdfModel *model = models[bsdf->kind];
    return model->part ? model->part(parameters_of(bsdf), part, wo, wi) : spectrum_all(0);
}

void bsdf_look(Bsdf *bsdf, Vec3 wo, BsdfRoom *room) {
    set(bsdf, &(BsdfSetting){.wo = &wo, .room = room});
}

void bsdf_carry(Bsdf *bsdf, const Spectrum *light) {
    set(bsdf, &(BsdfSetting){.light = light});
}

bool bsdf_show_itself(Bsdf *bsdf) {
    set(bsdf, &(BsdfSetting){.shows_itself = true});
    return bsdf_is(bsdf, BSDF_SHOWS_ITSELF);
}

Spectrum bsdf_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi, float *pdf) {
    const BsdfScatter *of = &models[bsdf->kind]->scatter;
    if (of->eval) return of->eval(parameters_of(bsdf), wo, wi, pdf);
    *pdf = 0;
    return spectrum_all(0);
}

bool bsdf_reaches(const Bsdf *bsdf, Vec3 wo, Vec3 wi) {
    const BsdfScatter *of = &models[bsdf->kind]->scatter;
    return of->eval && (!of->reaches || of->reaches(parameters_of(bsdf), wo, wi));
}

bool bsdf_sample(const Bsdf *bsdf, Vec3 wo, const float u[3], BsdfSample *sample) {
    const BsdfScatter *of = &models[bsdf->kind]->scatter;
    return of->sample && of->sample(parameters_of(bsdf), wo, u, sample);
}

Spectrum bsdf_pass(const Bsdf *bsdf, Vec3 wo) {
    const BsdfBoundary *of = &models[bsdf->kind]->boundary;
    return of->pass ? of->pass(parameters_of(bsdf), wo) : spectrum_all(0);
}

Spectrum bsdf_mirror(const Bsdf *bsdf, Vec3 wo) {
    const BsdfBoundary *of = &models[bsdf->kind]->boundary;
    return of->mirror ? of->mirror(parameters_of(bsdf), wo) : spectrum_all(0);
}

Spectrum bsdf_glint(const Bsdf *bsdf, Vec3 wo, Vec3 wi) {
    return part_of(bsdf, BSDF_GLINT, wo, wi);
}

bool bsdf_scatters(const Bsdf *bsdf) {
    return facts_of(bsdf).scatters;
}

BsdfLobes bsdf_lobes(const Bsdf *bsdf, Vec3 wo) {
    const BsdfScatter *of = &models[bsdf->kind]->scatter;
    BsdfLobes lobes = {0};
    if (of->lobes) of->lobes(parameters_of(bsdf), wo, &lobes);
    return lobes;
}

Spectrum bsdf_albedo(const Bsdf *bsdf, Vec3 wo) {
    const BsdfScatter *of = &models[bsdf->kind]->scatter;
    return of->albedo ? of->albedo(parameters_of(bsdf), wo) : spectrum_all(0);
}

bool bsdf_polarise(const Bsdf *bsdf, Vec3 wo, const BsdfSample *way, BsdfPolarisation *out) {
    const BsdfModel *model = models[bsdf->kind];
    return model->polarise && model->polarise(parameters_of(bsdf), wo, way, out);
}

bool bsdf_is(const Bsdf *bsdf, BsdfTrait trait) {
    return (models[bsdf->kind]->traits & (unsigned)trait) != 0;
}

float bsdf_sharpest(const Bsdf *bsdf) {
    return facts_of(bsdf).alpha;
}

float bsdf_shift(const Bsdf *bsdf, float cosine) {
    const BsdfBoundary *of = &models[bsdf->kind]->boundary;
    return of->shift ? of->shift(parameters_of(bsdf), cosine) : 0;
}

bool bsdf_sends_across(const Bsdf *bsdf) {
    return facts_of(bsdf).sends_across;
}

bool bsdf_has_lambertian(const Bsdf *bsdf) {
    return bsdf_is(bsdf, BSDF_HAS_LAMBERTIAN);
}

Spectrum bsdf_lambertian_share(const Bsdf *bsdf, Vec3 wo, Vec3 wi) {
    return part_of(bsdf, BSDF_LAMBERTIAN, wo, wi);
}

bool bsdf_is_extrapolated(const Bsdf *bsdf, Vec3 wo, Vec3 wi) {
    return part_of(bsdf, BSDF_EXTRAPOLATED, wo, wi)[0] > 0;
}
