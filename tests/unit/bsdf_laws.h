/* SPDX-License-Identifier: Apache-2.0 */
/* bsdf_laws.h -- laws that every surface model obeys: a test that includes it fills `models`
 * before the first case, and its models inherit them all.
 */
#pragma once
#include "chart_fixture.h"
#include "shader_fixture.h"

#include "base/units.h"
#include "shaders/bsdf.h"

#define MAX_MODELS 120

typedef struct Model {
    const char *name;
    Bsdf bsdf;
    bool lossless;   /* sends back all it gets, within the tables' error */
    bool both_sides; /* the eye may be below */
    float width;     /* of its narrowest lobe, radians: where to look closely */
} Model;

static Model models[MAX_MODELS];
static int model_count;

/* Calls `law` for the model as a path's vertex has it: looked at from wo. */
static void look_and_call(void (*law)(const Model *, Vec3), Model model, Vec3 wo) {
    BsdfRoom room;
    bsdf_look(&model.bsdf, wo, &room);
    law(&model, wo);
}

/* For every model, on the far side too where there is one, and every sixth eye, all eyes where
 * all laws are checked: the next model is checked at another. */
static void for_all(void (*law)(const Model *, Vec3)) {
    for (int m = 0; m < model_count; m++)
        for (int i = 0; i < EYE_COUNT; i++) {
            Vec3 wo = eye(i);
            if (!all_laws() && (m + i) % EYE_COUNT) continue;
            look_and_call(law, models[m], wo);
            if (models[m].both_sides) look_and_call(law, models[m], vec3(wo.x, wo.y, -wo.z));
        }
}

/* The case `name` of all models, and what it requires of one that is looked at from wo. */
#define LAW(name, law) \
    static void law(const Model *model, Vec3 wo); \
    TEST(name) { \
        for_all(law); \
    } \
    static void law(const Model *model, Vec3 wo)

/* ---- sampling matches its density ---------------------------------------------------- */

#define SAMPLES 20000

static Chart chart_for(const Model *model, Vec3 wo, bool same_side) {
    Vec3 centre = vec3(-wo.x, -wo.y, same_side ? wo.z : -wo.z);
    if (model->bsdf.kind == BSDF_DIELECTRIC && !same_side) {
        float eta = wo.z > 0 ? model->bsdf.dielectric.ior : 1 / model->bsdf.dielectric.ior;
        float x = -wo.x / eta, y = -wo.y / eta, z = safe_sqrtf(1 - x * x - y * y);
        centre = vec3_normalize(vec3(x, y, wo.z > 0 ? -z : z));
    }
    return (Chart){frame_from_z(centre), model->width * fabsf(wo.z)}; /* lobes grow slender */
}

/* The pdf in a direction of the chart, on one side of the surface alone. */
static double pdf_at(const Model *model, Vec3 wo, const Chart *chart, bool same_side, double angle,
                     double turn) {
    Vec3 local =
        vec3((float)(sin(angle) * cos(turn)), (float)(sin(angle) * sin(turn)), (float)cos(angle));
    Vec3 wi = frame_to_world(&chart->frame, local);
    float pdf;
    if ((wi.z * wo.z > 0) != same_side) return 0;
    bsdf_eval(&model->bsdf, wo, wi, &pdf);
    return (double)pdf;
}

#define GAUSS_MOST 6

/* Integral of the pdf over one cell by Gauss' and Legendre's rule of 4 or 6 points a side. */
static double gauss_cell(const Model *model, Vec3 wo, const Chart *chart, int cell, int points) {
    static const double NODES[][GAUSS_MOST / 2] = {
        {0.339981043584856, 0.861136311594053},
        {0.238619186083197, 0.661209386466265, 0.932469514203152}};
    static const double WEIGHTS[][GAUSS_MOST / 2] = {
        {0.652145154862546, 0.347854845137454},
        {0.467913934572691, 0.360761573048139, 0.171324492379170}};
    const double *nodes = NODES[points == 6], *weights = WEIGHTS[points == 6];
    double x[GAUSS_MOST], w[GAUSS_MOST], sum = 0;
    bool same_side = cell < CELLS / 2;
    int ring = cell % (CELLS / 2) / SECTORS, sector = cell % SECTORS;
    double low = angle_of(chart, (double)ring / RINGS);
    double high = angle_of(chart, (ring + 1.0) / RINGS);
    for (int i = 0; i < points; i++) {
        int at = i / 2;
        x[i] = 0.5 + (i % 2 ? 0.5 : -0.5) * nodes[at];
        w[i] = 0.5 * weights[at];
    }
    for (int i = 0; i < points; i++) {
        double angle = low + (high - low) * x[i];
        for (int k = 0; k < points; k++) {
            double turn = ((sector + x[k]) / SECTORS - 0.5) * 2 * PI;
            sum += w[i] * w[k] * sin(angle) * pdf_at(model, wo, chart, same_side, angle, turn);
        }
    }
    return sum * (high - low) * 2 * PI / SECTORS;
}

/* The same of fine * turns points, evenly spread. */
static double sum_cell(const Model *model, Vec3 wo, const Chart *chart, int cell, int fine,
                       int turns) {
    double sum = 0;
    bool same_side = cell < CELLS / 2;
    int ring = cell % (CELLS / 2) / SECTORS, sector = cell % SECTORS;
    double before = angle_of(chart, (double)ring / RINGS);
    for (int i = 0; i < fine; i++) {
        double after = angle_of(chart, (ring + (i + 1.0) / fine) / RINGS);
        double angle = 0.5 * (before + after);
        double area = (cos(before) - cos(after)) * 2 * PI / SECTORS / turns;
        before = after;
        for (int k = 0; k < turns; k++) {
            double turn = ((sector + (k + 0.5) / turns) / SECTORS - 0.5) * 2 * PI;
            sum += area * pdf_at(model, wo, chart, same_side, angle, turn);
        }
    }
    return sum;
}

static bool agree(double one, double other) {
    return fabs(one - other) <= 1e-3 * one + 1e-7;
}

/* By a few points of Gauss' (but narrow lobes, which all of them may miss), or by ever more
 * until they agree: the horizon cuts lobes, and there narrow ones take them all. */
static double integrate_cell(const Model *model, Vec3 wo, const Chart *chart, int cell) {
    static const int fine[] = {4, 8, 16, 40}, turns[] = {9, 18, 36, 72};
    bool is_narrow = fabsf(wo.z) < 0.1f || model->width < 0.03f;
    int last = is_narrow ? 3 : 2;
    double sum = is_narrow ? 0 : gauss_cell(model, wo, chart, cell, 6);
    if (!is_narrow && agree(sum, gauss_cell(model, wo, chart, cell, 4))) return sum;
    sum = 0;
    for (int level = 0; level <= last; level++) {
        double before = sum;
        sum = sum_cell(model, wo, chart, cell, fine[level], turns[level]);
        if (level > 0 && agree(sum, before)) break;
    }
    return sum;
}

LAW(samples_are_distributed_as_their_pdf_says, samples_follow_pdf) {
    if (fabsf(wo.z) < 0.1f && model->width < 0.03f) return; /* a needle no chart resolves */
    static double expected[CELLS], found[CELLS + 1];
    memset(found, 0, sizeof found);
    Chart charts[2] = {chart_for(model, wo, true), chart_for(model, wo, false)};
    double total = 0;
    for (int i = 0; i < CELLS; i++) {
        bool same = i < CELLS / 2;
        double part = integrate_cell(model, wo, &charts[!same], i);
        total += part;
        expected[i] = part * SAMPLES;
    }
    if (!(total <= 1.01))
        fail_msg("%s, cos %g: pdf integrates to %g", model->name, (double)wo.z, total);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        Sampler sampler = sampler_start(11, (int)(i * 7919u), (int)(wo.z * 1000), i);
        BsdfSample sample;
        float u[3];
        draw(&sampler, u);
        bool whole = !bsdf_sample(&model->bsdf, wo, u, &sample) || sample.is_delta;
        bool same = !whole && sample.wi.z * wo.z > 0;
        int cell = whole ? CELLS : (same ? 0 : CELLS / 2) + cell_of(&charts[!same], sample.wi);
        found[cell]++;
    }
    int degrees; /* what is left over are the delta parts and lost light */
    double chi2 = chi_square(expected, found, CELLS, &degrees);
    if (!(fabs(found[CELLS] / SAMPLES - (1 - total)) < 0.01))
        fail_msg("%s, cos %g: %g of the samples are lost, the pdf leaves %g", model->name,
                 (double)wo.z, found[CELLS] / SAMPLES, 1 - total);
    if (degrees > 0 && !(deviate(chi2, degrees) < 4.5))
        fail_msg("%s, cos %g: chi-square %g with %d degrees (pdf integrates to %g)", model->name,
                 (double)wo.z, chi2, degrees, total);
}

/* ---- a sample agrees with eval ------------------------------------------------------- */

LAW(weight_is_eval_times_cosine_over_pdf, sample_agrees) {
    for (uint32_t i = 0; i < 400; i++) {
        Sampler sampler = sampler_start(3, 1, 2, i);
        BsdfSample s;
        float u[3], pdf;
        BsdfPolarisation matrix;
        draw(&sampler, u);
        if (!bsdf_sample(&model->bsdf, wo, u, &s)) continue;
        assert_close(vec3_length(s.wi), 1, 1e-5);
        assert_true(s.pdf > 0 && spectrum_is_finite(s.weight));
        for (int k = 0; k < SPECTRUM_LANES; k++) assert_true(s.weight[k] >= 0);
        if (bsdf_polarise(&model->bsdf, wo, &s, &matrix))
            stokes_law(model->name, &matrix, random_direction(&sampler));
        if (s.is_delta) {
            assert_true(s.pdf <= 1);
            if (s.passes) assert_near(vec3_length(vec3_add(s.wi, wo)), 0, 1e-6);
            continue;
        }
        assert_true(bsdf_scatters(&model->bsdf) && !s.passes);
        Spectrum f = bsdf_eval(&model->bsdf, wo, s.wi, &pdf);
        assert_close(pdf, s.pdf, 2e-3);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            double cosine = fabs((double)s.wi.z);
            assert_near(s.weight[k], (double)f[k] * cosine / (double)pdf,
                        4e-3 * (double)s.weight[k] + 1e-6);
        }
    }
}

TEST(what_does_not_scatter_or_reach_evaluates_to_nothing) {
    for (int m = 0; m < model_count; m++)
        for (int i = 0; i < EYE_COUNT; i++)
            for (int k = 0; k < EYE_COUNT; k++) {
                const Bsdf *bsdf = &models[m].bsdf;
                float pdf = -1;
                Vec3 wi = eye(k);
                for (int side = 0; side < 2; side++, wi.z = -wi.z) {
                    if (bsdf_scatters(bsdf) && bsdf_reaches(bsdf, eye(i), wi)) continue;
                    assert_true(spectrum_is_zero(bsdf_eval(bsdf, eye(i), wi, &pdf)));
                    assert_true(pdf == 0);
                }
            }
}

/* ---- energy -------------------------------------------------------------------------- */

/* By how much radiance grows on the way to wo through the boundary: as the index squared. */
static Spectrum squeeze(const Model *model, Vec3 wo) {
    const Dielectric *d = &model->bsdf.dielectric;
    if (model->bsdf.kind != BSDF_DIELECTRIC) return spectrum_all(1);
    Spectrum n = d->index ? curve_lookup(d->index, d->wavelengths) : spectrum_all(d->ior);
    return wo.z > 0 ? n * n : spectrum_all(1) / (n * n);
}

/* Light sent to wo under a uniform surround of 1. Refracted radiance is counted as flux. */
static Spectrum furnace(const Model *model, Vec3 wo, uint32_t count) {
    Spectrum sum = spectrum_all(0);
    for (uint32_t i = 0; i < count; i++) {
        Sampler sampler = sampler_start(5, 8, 13, i);
        BsdfSample s;
        float u[3];
        draw(&sampler, u);
        if (!bsdf_sample(&model->bsdf, wo, u, &s)) continue;
        if (s.wi.z * wo.z < 0) s.weight *= squeeze(model, wo);
        sum += s.weight;
    }
    return sum / spectrum_all((float)count);
}

LAW(no_surface_sends_back_more_than_it_gets, energy_holds) {
    Spectrum sent = furnace(model, wo, 16384);
    for (int k = 0; k < SPECTRUM_LANES; k += 5) {
        if (!(sent[k] <= 1.004f))
            fail_msg("%s, cos %g: sends back %g", model->name, (double)wo.z, (double)sent[k]);
        if (model->lossless && !(sent[k] >= (model->both_sides ? 0.9f : 0.98f)))
            fail_msg("%s, cos %g: loses light, %g", model->name, (double)wo.z, (double)sent[k]);
    }
}

LAW(albedo_is_a_fair_estimate, albedo_is_near) {
    bool tilted = strstr(model->name, "tilted") != NULL; /* loses light, by how much is not known */
    if (model->bsdf.kind == BSDF_DIELECTRIC || tilted) return;
    Spectrum sent = furnace(model, wo, 4096), told = bsdf_albedo(&model->bsdf, wo);
    for (int k = 0; k < SPECTRUM_LANES; k += 5)
        if (!(fabsf(sent[k] - told[k]) < 0.12f))
            fail_msg("%s, cos %g: albedo %g, furnace %g", model->name, (double)wo.z,
                     (double)told[k], (double)sent[k]);
}

/* ---- reciprocity --------------------------------------------------------------------- */

static Vec3 turned_over(Vec3 w) {
    return vec3(w.x, w.y, -w.z);
}

/* f(wo, wi) against f(wi, wo). Frames of one-sided models are always turned to the eye; a
 * solid's transmitted radiance scales with the square of the index on the light's side. */
static void check_reciprocity(const Model *model, Vec3 wo, Vec3 wi) {
    bool is_solid = model->bsdf.kind == BSDF_DIELECTRIC;
    bool crosses = wo.z * wi.z < 0, turn = crosses && !is_solid;
    float pdf;
    Spectrum scale = crosses && is_solid ? squeeze(model, wo) : spectrum_all(1);
    double tolerance = is_solid || model->width < 0.05f ? 1e-3 : 1e-4; /* rounding */
    Spectrum a = bsdf_eval(&model->bsdf, wo, wi, &pdf);
    Spectrum b =
        bsdf_eval(&model->bsdf, turn ? turned_over(wi) : wi, turn ? turned_over(wo) : wo, &pdf);
    for (int k = 0; k < SPECTRUM_LANES; k += 3) {
        double forth = (double)(a[k] * scale[k]), back = (double)b[k];
        if (!(fabs(forth - back) <= tolerance * (forth + back) + (is_solid ? 1e-5 : 1e-6)))
            fail_msg("%s: f(%g,%g,%g / %g,%g,%g) is %g and %g back", model->name, (double)wo.x,
                     (double)wo.y, (double)wo.z, (double)wi.x, (double)wi.y, (double)wi.z, forth,
                     back);
    }
}

TEST(light_goes_back_the_way_it_came) {
    uint32_t count = all_laws() ? 2000 : 400;
    for (int m = 0; m < model_count; m++)
        for (uint32_t i = 0; i < count; i++) {
            Sampler sampler = sampler_start(17, m, 0, i);
            Vec3 wo = random_direction(&sampler), wi = random_direction(&sampler);
            if (!models[m].both_sides) wo.z = fabsf(wo.z);
            if (fabsf(wo.z) < 1e-3f || fabsf(wi.z) < 1e-3f) continue;
            check_reciprocity(&models[m], wo, wi);
        }
}

/* ---- smooth parts --------------------------------------------------------------------- */

/* Of whatever number chooses, even steps. Where shadow rays see nothing, nothing with a chance
 * worth the name may pass: there fewer steps will do. */
TEST(what_passes_a_pane_is_what_shadow_rays_see) {
    int panes = 0;
    for (int m = 0; m < model_count; m++)
        for (int i = 0; i < EYE_COUNT; i++) {
            Vec3 wo = eye(i);
            Spectrum pass = bsdf_pass(&models[m].bsdf, wo);
            Spectrum sampled = spectrum_all(0);
            int steps = spectrum_is_zero(pass) && !all_laws() ? 250 : 4000;
            for (int k = 0; k < steps; k++) {
                float pick = ((float)k + 0.5f) / (float)steps;
                float u[3] = {pick, 0.5f, pick};
                BsdfSample s;
                if (bsdf_sample(&models[m].bsdf, wo, u, &s) && s.passes) {
                    sampled = s.weight * spectrum_all(s.pdf);
                    break;
                }
            }
            panes += !spectrum_is_zero(pass);
            for (int k = 0; k < SPECTRUM_LANES; k++)
                assert_near(sampled[k], pass[k], 1e-5 * (double)pass[k] + 2e-4);
        }
    assert_true(panes >= 3 * EYE_COUNT);
}
