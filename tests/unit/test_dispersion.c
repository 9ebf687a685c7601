/* SPDX-License-Identifier: Apache-2.0 */
/* Indices by wavelength: glTF's dispersion, Snell's angle and Fresnel's share of each lane. */
#include "check.h"
#include "gltf_maker.h"

#include "base/sampler.h"
#include "base/units.h"
#include "shader_fixture.h"
#include "shaders/bsdf.h"
#include "spectrum/dispersion.h"
#include "spectrum/fresnel.h"

#define PLACE "/materials/0/extensions/KHR_materials_dispersion"

/* Fraunhofer's F, d and C. */
static const double LINES[] = {486.1, 587.6, 656.3};

static const Material *glass_of(double ior, double dispersion, const char *volume) {
    char text[1024];
    snprintf(text, sizeof text,
             "'extensionsUsed':['KHR_materials_dispersion','KHR_materials_ior',"
             "'KHR_materials_volume','KHR_materials_transmission'],'materials':[{'extensions':{"
             "'KHR_materials_dispersion':{'dispersion':%.17g},'KHR_materials_ior':{'ior':%.17g}"
             ",'KHR_materials_volume':{%s},"
             "'KHR_materials_transmission':{'transmissionFactor':1}}}]",
             dispersion, ior, volume);
    return &maker_load(NULL, 0, text)->materials[0];
}

static double at(const Curve *curve, double nm) {
    int cell = (int)nm - CURVE_FIRST_NM;
    double t = nm - (int)nm;
    return (double)curve->value[cell] * (1 - t) + (double)curve->value[cell + 1] * t;
}

TEST_WITH(an_abbe_number_gives_the_index_of_every_wavelength, maker_reset, NULL) {
    for (int abbe = 20; abbe <= 80; abbe += 20)
        for (int i = 0; i < 2; i++) {
            double nd = i ? 1.9 : 1.5;
            const Material *m = glass_of(nd, 20.0 / abbe, "'thicknessFactor':1");
            double f = at(m->index, 486.1), d = at(m->index, 587.6), c = at(m->index, 656.3);
            assert_close(d, nd, 1e-6);
            assert_close((d - 1) / (f - c), abbe, 1e-4);
            /* The extension's own rounded numbers. */
            for (int nm = 400; nm <= 800; nm += 100)
                assert_close(m->index->value[nm - CURVE_FIRST_NM],
                             nd + (nd - 1) / abbe * (523655.0 / (nm * nm) - 1.5168), 2e-5);
        }
}

TEST_WITH(what_spreads_nothing_has_one_index, maker_reset, NULL) {
    assert_null(glass_of(1.5, 0, "'thicknessFactor':1")->index);
    assert_null(glass_of(1, 1, "'thicknessFactor':1")->index);
    assert_null(glass_of(0, 1, "'thicknessFactor':1")->index);
    assert_null(glass_of(1.5, 1, "")->index);
    const Curve *strange = glass_of(1.2, 300, "'thicknessFactor':1")->index;
    assert_near(strange->value[CURVE_COUNT - 1], 1, 0); /* never below that of air */
}

typedef struct DispersionFault {
    const char *value, *place, *text;
} DispersionFault;

TEST_WITH(a_wrong_dispersion_is_named, maker_reset, NULL) {
    static const DispersionFault FAULTS[] = {
        {"'dispersion':-0.1", PLACE "/dispersion", "is -0.1"},
        {"'dispersion':'0.1'", PLACE "/dispersion", "is \"0.1\""},
        {"'dispersion':20000", PLACE "/dispersion", "the index at 360 nm would be"},
        {"'abbe':20", PLACE "/abbe", "is no member of glTF's"},
    };
    for (size_t i = 0; i < sizeof FAULTS / sizeof *FAULTS; i++) {
        char text[1024];
        maker_reset(state);
        snprintf(text, sizeof text,
                 "'extensionsUsed':['KHR_materials_dispersion','KHR_materials_volume',"
                 "'KHR_materials_transmission'],'materials':[{'extensions':{"
                 "'KHR_materials_dispersion':{%s},'KHR_materials_volume':{'thicknessFactor':1},"
                 "'KHR_materials_transmission':{'transmissionFactor':1}}}]",
                 FAULTS[i].value);
        maker_expect_fault(&(FaultCase){text, FAULTS[i].place, FAULTS[i].text}, NULL, 0);
    }
}

/* ---- the boundary ----------------------------------------------------------------------- */

static Curve flint;
static Wavelengths three;

/* Lanes of the three lines, over and over. */
static Bsdf boundary(float alpha) {
    for (int i = 0; i < CURVE_COUNT; i++)
        flint.value[i] = (float)dispersion_index(1.6, 1, CURVE_FIRST_NM + i);
    for (int k = 0; k < SPECTRUM_LANES; k++) three.nm[k] = (float)LINES[k % 3];
    return (Bsdf){.kind = BSDF_DIELECTRIC,
                  .dielectric = {.tint = spectrum_all(1),
                                 .ior = 1.6f,
                                 .alpha = alpha,
                                 .wavelengths = &three,
                                 .index = &flint}};
}

static int only_lane(Spectrum weight) {
    int lane = -1;
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        if (weight[k] == 0) continue;
        assert_int_equal(lane, -1);
        lane = k;
    }
    return lane;
}

/* By the lane that goes on: Snell's angle to 1e-4, both ways through the boundary. */
TEST(each_wavelength_is_refracted_as_snell_says) {
    Bsdf bsdf = boundary(0);
    int seen[3] = {0};
    for (int degrees = 10; degrees <= 80; degrees += 10)
        for (int i = 0; i < 400; i++) {
            double angle = degrees * PI / 180;
            bool inside = i % 2 && degrees <= 30;
            Vec3 wo = vec3((float)sin(angle), 0, (float)cos(angle));
            float u[3] = {0, 0, ((float)i + 0.5f) / 400};
            BsdfSample s;
            if (inside) wo.z = -wo.z;
            assert_true(bsdf_sample(&bsdf, wo, u, &s) && s.is_delta);
            if (s.wi.z * wo.z > 0) continue;
            int line = only_lane(s.weight) % 3;
            double n = dispersion_index(1.6, 1, LINES[line]);
            double behind = asin(inside ? sin(angle) * n : sin(angle) / n);
            assert_near(asin(-(double)s.wi.x), behind, 1e-4 * behind);
            seen[line]++;
        }
    assert_true(seen[0] > 400 && seen[1] > 400 && seen[2] > 400);
}

/* Mean over the choice: Fresnel's shares, a mirror with all lanes in one sample. */
TEST(lanes_get_fresnels_shares_in_the_mean) {
    Bsdf bsdf = boundary(0);
    const int count = 4096;
    for (int degrees = 0; degrees <= 80; degrees += 20) {
        double angle = degrees * PI / 180;
        Vec3 wo = vec3((float)sin(angle), 0, (float)cos(angle));
        Spectrum back = spectrum_all(0), on = spectrum_all(0);
        for (int i = 0; i < count; i++) {
            BsdfSample s;
            float u[3] = {0, 0, ((float)i + 0.5f) / (float)count};
            assert_true(bsdf_sample(&bsdf, wo, u, &s));
            if (s.wi.z > 0) back += s.weight;
            else on += s.weight;
            if (s.wi.z > 0 || degrees == 0) assert_true(s.weight[0] > 0 && s.weight[1] > 0);
        }
        Spectrum mirror = bsdf_mirror(&bsdf, wo);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            double n = dispersion_index(1.6, 1, LINES[k % 3]);
            double f = fresnel_unpolarised_d(cos(angle), n);
            assert_close(mirror[k], f, 1e-4);
            assert_near(back[k] / (float)count, f, 2e-3);
            assert_near(on[k] / (float)count, (1 - f) / (n * n), 6e-3);
        }
    }
}

/* A path that has but one lane keeps it, and loses nothing to the others. */
TEST(a_split_path_keeps_its_lane) {
    Spectrum light = spectrum_all(0);
    light[4] = 7; /* 4 % 3: the d line */
    for (int rough = 0; rough < 2; rough++) {
        Bsdf bsdf = boundary(rough ? 0.1f : 0);
        bsdf.dielectric.light = &light;
        for (int i = 0; i < 200; i++) {
            Sampler sampler = sampler_start(1, 2, 3, (uint32_t)i);
            float u[3], pdf;
            BsdfSample s;
            draw(&sampler, u);
            if (!bsdf_sample(&bsdf, vec3(0.6f, 0, 0.8f), u, &s)) continue;
            assert_true(s.weight[4] > 0);
            if (s.is_delta) continue;
            Bsdf single = bsdf;
            single.dielectric.index = NULL;
            Spectrum f = bsdf_eval(&single, vec3(0.6f, 0, 0.8f), s.wi, &pdf);
            assert_close(s.pdf, pdf, 1e-3);
            assert_close(s.weight[4], f[4] * fabsf(s.wi.z) / pdf, 1e-3);
        }
    }
}

TEST_PROGRAM(maker_start, maker_end)
