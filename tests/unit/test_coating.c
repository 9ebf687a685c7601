/* SPDX-License-Identifier: Apache-2.0 */
/* Coated surfaces: tables against their stacks, closed forms, and the white furnace. */
#include "fixture.h"
#include "layer_fixture.h"

#include "base/sampler.h"
#include "base/units.h"
#include "shaders/bsdf.h"
#include "shaders/layers/coating_tables.h"
#include "shaders/layers/pane.h"
#include "shaders/facets/coat.h"
#include "spectrum/fresnel.h"

static Wavelengths wavelengths;

static int make_wavelengths(void **state) {
    wavelengths_sample(0.3f, &wavelengths);
    return make_arena(state);
}

/* The lane nearest to a wavelength. */
static int lane_near(double nm) {
    int best = 0;
    for (int i = 1; i < SPECTRUM_LANES; i++)
        if (fabs((double)wavelengths.nm[i] - nm) < fabs((double)wavelengths.nm[best] - nm))
            best = i;
    return best;
}

/* What a stack itself does at a wavelength between whole numbers, s and p alike. */
static void mean_shares(const LayerStack *stack, ThinMedium body, double nm, double cosine,
                        bool from_inside, double *reflect, double *through) {
    ThinMedia media;
    thin_film_media(stack, body, (int)nm, &media);
    media.nm = nm; /* the stacks evaluated do not change with the wavelength */
    if (from_inside) thin_film_reverse(&media);
    ThinShares at = thin_film_at(&media, cosine);
    *reflect = (at.reflect_s + at.reflect_p) / 2;
    *through = (at.through_s + at.through_p) / 2;
}

/* ---- tables ----------------------------------------------------------------------------- */

/* Largest error over angles between the nodes and all lanes. */
static double worst_error(const LayerStack *stack, bool is_inside) {
    const CoatingTables *tables = coating_of_solid(stack, 1.52, test_memory());
    double worst = 0;
    for (int i = 0; i < 400; i++) {
        double cosine = (i + 0.37) / 400;
        double inside = sqrt(1 - (1 - cosine * cosine) / (1.52 * 1.52)), r, t;
        Spectrum reflect =
            coating_at(is_inside ? tables->back : tables->front, &wavelengths, (float)cosine);
        Spectrum through = coating_at(tables->through, &wavelengths, (float)cosine);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            mean_shares(stack, (ThinMedium){1.52, 0, 0}, (double)wavelengths.nm[k],
                        is_inside ? inside : cosine, is_inside, &r, &t);
            worst = fmax(worst, fabs((double)reflect[k] - r));
            worst = fmax(worst, fabs((double)through[k] - t));
        }
    }
    return worst;
}

static LayerStack *mirror_of_twenty(void) {
    ThinMedium media[20];
    for (int i = 0; i < 20; i++) {
        double n = i & 1 ? 1.46 : 2.35;
        media[i] = (ThinMedium){n, 0, 550 / (4 * n)};
    }
    return stack_of(20, media, test_memory());
}

TEST(tables_are_within_their_stated_error) {
    for (int side = 0; side < 2; side++) {
        assert_true(worst_error(stack_of(0, NULL, test_memory()), side) < 3e-4);
        LayerStack *one = stack_of(1, (ThinMedium[]){{1.38, 0, 99.6}}, test_memory());
        assert_true(worst_error(one, side) < 3e-4);
        assert_true(worst_error(stack_four(test_memory()), side) < 3e-4);
        assert_true(worst_error(stack_silver(test_memory()), side) < 3e-4);
        assert_true(worst_error(mirror_of_twenty(), side) < 2e-2);
    }
}

TEST(bare_tables_are_fresnels_curve) {
    PaneMeeting pane = {coating_of_sheet(NULL, 1.52, test_memory()), &wavelengths, 1, true,
                        spectrum_all(0.6f)};
    for (int i = 1; i <= 90; i++) {
        pane.cosine = (float)i / 90;
        Fresnel face = fresnel_dielectric(pane.cosine, 1.52f, NULL);
        PaneLight bare = pane_between(spectrum_all(face.s), spectrum_all(face.p), pane.through);
        PaneLight light = pane_coated(&pane);
        assert_near(light.reflected[3], bare.reflected[3], 3e-4);
        assert_near(light.passed[3], bare.passed[3], 3e-4);
    }
}

/* ---- glass ------------------------------------------------------------------------------ */

static Bsdf coated_solid(const LayerStack *stack, float alpha) {
    return (Bsdf){.kind = BSDF_DIELECTRIC,
                  .dielectric = {.tint = spectrum_all(1),
                                 .ior = 1.52f,
                                 .alpha = alpha,
                                 .coating = coating_of_solid(stack, 1.52, test_memory()),
                                 .wavelengths = &wavelengths}};
}

static Vec3 at_cosine(float z) {
    return vec3(safe_sqrtf(1 - z * z), 0, z);
}

/* 1.26 % comes back from magnesium fluoride on glass; a lane stands close to 550 nm. */
TEST(a_quarter_wave_on_glass_reflects_what_it_should) {
    LayerStack *stack = stack_of(1, (ThinMedium[]){{1.38, 0, 550 / (4 * 1.38)}}, test_memory());
    Bsdf bsdf = coated_solid(stack, 0);
    int lane = lane_near(550);
    double r, t;
    mean_shares(stack, (ThinMedium){1.52, 0, 0}, (double)wavelengths.nm[lane], 1, false, &r, &t);
    Spectrum mirror = bsdf_mirror(&bsdf, vec3(0, 0, 1));
    assert_near(mirror[lane], r, 1e-5);
    assert_near(mirror[lane], 0.01260, 1e-4);
    assert_true(mirror[0] > 0.014f); /* violet comes back more */
}

/* At every angle, from both sides, and beyond the critical angle. */
TEST(a_clear_coating_loses_no_light) {
    Bsdf bsdf = coated_solid(stack_four(test_memory()), 0);
    for (int i = 1; i <= 200; i++)
        for (int side = -1; side <= 1; side += 2) {
            Vec3 wo = at_cosine((float)i / 200);
            Spectrum all = bsdf_albedo(&bsdf, vec3(wo.x, wo.y, wo.z * (float)side));
            for (int k = 0; k < SPECTRUM_LANES; k++) assert_near(all[k], 1, 5e-4);
        }
}

TEST(silver_absorbs_and_total_reflection_is_then_not_total) {
    Bsdf bsdf = coated_solid(stack_silver(test_memory()), 0);
    for (int i = 1; i <= 100; i++) {
        Vec3 wo = at_cosine((float)i / 100);
        Spectrum out = bsdf_albedo(&bsdf, wo), in = bsdf_albedo(&bsdf, vec3(wo.x, 0, -wo.z));
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            double r, t;
            mean_shares(stack_silver(test_memory()), (ThinMedium){1.52, 0, 0},
                        (double)wavelengths.nm[k], (double)wo.z, true, &r, &t);
            assert_true(out[k] < 1.0002f && in[k] < 0.999f && in[k] > 0.1f);
            assert_near(in[k], r + t, 1e-3);
        }
    }
}

/* Both faces' turns summed up one by one, for each polarisation. */
TEST(a_coated_sheet_sums_up_its_turns) {
    LayerStack *stack = stack_silver(test_memory());
    for (int faces = COATED_BOTH; faces <= COATED_BACK; faces++) {
        stack->faces = (CoatedFaces)faces;
        const PaneCoating *sheet = coating_of_sheet(stack, 1.52, test_memory());
        LayerStack none = {.outside = 1};
        for (int i = 1; i <= 20; i++) {
            double cosine = i / 20.0;
            double inside = sqrt(1 - (1 - cosine * cosine) / (1.52 * 1.52));
            int nm = 500 + 7 * i;
            double r[2] = {0, 0}, t[2] = {0, 0};
            ThinMedia first, second;
            thin_film_media(faces == COATED_BACK ? &none : stack, (ThinMedium){1.52, 0, 0}, nm,
                            &first);
            thin_film_media(faces == COATED_FRONT ? &none : stack, (ThinMedium){1.52, 0, 0}, nm,
                            &second);
            ThinShares a = thin_film_at(&first, cosine), b = thin_film_at(&second, cosine);
            thin_film_reverse(&first);
            thin_film_reverse(&second);
            ThinShares back_a = thin_film_at(&first, inside);
            ThinShares back_b = thin_film_at(&second, inside);
            const double ra[2] = {a.reflect_s, a.reflect_p}, ta[2] = {a.through_s, a.through_p};
            const double tb[2] = {b.through_s, b.through_p};
            const double ia[2] = {back_a.reflect_s, back_a.reflect_p};
            const double ib[2] = {back_b.reflect_s, back_b.reflect_p};
            double once = pow(0.7, 1 / inside); /* the body */
            for (int p = 0; p < 2; p++) {
                double light = ta[p] * once;
                r[p] = ra[p];
                for (int turn = 0; turn < 200; turn++) {
                    t[p] += light * tb[p];
                    r[p] += light * ib[p] * once * ta[p];
                    light *= ib[p] * ia[p] * once * once;
                }
            }
            float x = (float)cosine;
            Wavelengths one = wavelengths;
            one.nm = spectrum_all((float)nm);
            PaneMeeting pane = {sheet, &one, x, true, pane_body(spectrum_all(0.7f), x, 1.52f)};
            PaneLight light = pane_coated(&pane);
            assert_near(light.reflected[0], (r[0] + r[1]) / 2, 3e-4);
            assert_near(light.passed[0], (t[0] + t[1]) / 2, 3e-4);
        }
    }
}

/* ---- metals ----------------------------------------------------------------------------- */

static Bsdf bsdf_with(const SurfaceCoating *coating, float metallic, float alpha) {
    Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS};
    MetallicRoughness *m = &bsdf.metallic_roughness;
    *m = metallic_roughness_default(&common_energy_table);
    m->metallic = metallic;
    m->alpha = alpha;
    m->coating = coating;
    m->wavelengths = &wavelengths;
    return bsdf;
}

/* F0 = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), a lane at a time. */
TEST(a_measured_metal_mirrors_by_its_n_and_k) {
    OpticalConstants *metal = constants_of(0, 0, test_memory());
    for (int i = 0; i < CURVE_COUNT; i++) {
        metal->n.value[i] = 0.2f + 0.004f * (float)i;
        metal->k.value[i] = 2 + 0.01f * (float)i;
    }
    SurfaceCoating coating = {.metal = coating_of_metal(NULL, metal, test_memory())};
    Bsdf bsdf = bsdf_with(&coating, 1, 0);
    Spectrum mirror = bsdf_mirror(&bsdf, vec3(0, 0, 1));
    static const double asked_nm[] = {450, 550, 650};
    for (int i = 0; i < 3; i++) {
        int lane = lane_near(asked_nm[i]);
        double at = (double)wavelengths.nm[lane] - CURVE_FIRST_NM;
        double n = 0.2 + 0.004 * at, k = 2 + 0.01 * at;
        assert_near(mirror[lane], ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-5);
    }
}

/* ---- the white furnace ------------------------------------------------------------------ */

/* As in test_coat.c: a lattice over u0 and sqrt(1 - u1). */
static void furnace_of(const Bsdf *bsdf, double theta_deg, int side, double sent[2]) {
    enum { TURNS = 8 };
    double t = radians_from_degrees(theta_deg);
    Vec3 wo = vec3((float)sin(t), 0, (float)cos(t));
    sent[0] = sent[1] = 0;
    for (int i = 0; i < side * side * TURNS; i++) {
        int turn = i % (side * TURNS), height = i / (side * TURNS);
        double rest = (height + 0.5) / side, shift = fmod(height * 0.5698402910, 1);
        const float u[3] = {(float)((turn + shift) / (side * TURNS)), (float)(1 - rest * rest),
                            (float)fmod(i * 0.7548776662, 1)};
        BsdfSample s;
        if (!bsdf_sample(bsdf, wo, u, &s)) continue;
        sent[0] += 2 * rest * (double)s.weight[2] / (side * side * TURNS);
        sent[1] += 2 * rest * (double)s.weight[9] / (side * side * TURNS);
    }
}

static void check_furnace(const Bsdf *bsdf, const char *name, float alpha, int side) {
    static const double thetas_deg[] = {0, 30, 60, 75, 80, 85};
    for (int t = 0; t < 6; t++) {
        double sent[2];
        furnace_of(bsdf, thetas_deg[t], side, sent);
        for (int k = 0; k < 2; k++)
            if (!(fabs(sent[k] - 1) <= 2e-3))
                fail_msg("%s, alpha %g, %g deg: %g", name, (double)alpha, thetas_deg[t], sent[k]);
    }
}

TEST(coated_white_keeps_the_furnace_white) {
    static const float alphas[] = {0, 0.01f, 0.05f, 0.022f, 0.1f, 0.35f, 0.6f, 1};
    const LayerStack *stacks[] = {stack_four(test_memory()),
                                  stack_of(1, (ThinMedium[]){{1.38, 0, 700}}, test_memory()),
                                  mirror_of_twenty()};
    const OpticalConstants *ideal = constants_of(0, 4, test_memory());
    for (int i = 0; i < 3; i++) {
        SurfaceCoating coating = {.metal = coating_of_metal(stacks[i], ideal, test_memory())};
        if (i < 2) coating.face = coating_of_face(stacks[i], 1.5, ALPHA_ALL, test_memory());
        for (int a = 0; a < 8; a++)
            for (int metallic = i == 2; metallic < 2; metallic++) {
                bool is_narrow = alphas[a] > 0 && alphas[a] < 0.03f;
                Bsdf bsdf = bsdf_with(&coating, (float)metallic, alphas[a]);
                check_furnace(&bsdf, metallic ? "metal" : "plastic", alphas[a],
                              is_narrow ? 144 : 48);
            }
    }
}

TEST(energies_of_few_alphas_are_those_of_all) {
    static const AlphaSpan spans[] = {{0, 0}, {0.055f, 0.055f}, {0.1f, 0.4f}, {1, 1}};
    const LayerStack *four = stack_four(test_memory());
    const CoatingEnergy *all = coating_of_face(four, 1.5, ALPHA_ALL, test_memory())->energy;
    for (int i = 0; i < 4; i++) {
        const CoatingEnergy *few = coating_of_face(four, 1.5, spans[i], test_memory())->energy;
        for (int k = 0; k < 21; k++) {
            float alpha = lerpf(spans[i].least, spans[i].most, (float)k / 20);
            float cosine = (float)k / 20;
            Spectrum a = coating_energy_at(all, &wavelengths, cosine, alpha);
            Spectrum b = coating_energy_at(few, &wavelengths, cosine, alpha);
            assert_memory_equal(&a, &b, sizeof a);
            a = coating_energy_average(all, &wavelengths, alpha);
            b = coating_energy_average(few, &wavelengths, alpha);
            assert_memory_equal(&a, &b, sizeof a);
        }
    }
}

TEST(a_coated_frosted_sheet_loses_no_light) {
    static const float alphas[] = {0.05f, 0.1f, 0.35f, 1};
    SurfaceCoating coating = {.sheet =
                                  coating_of_sheet(stack_four(test_memory()), 1.5, test_memory())};
    for (int a = 0; a < 4; a++) {
        Bsdf bsdf = bsdf_with(&coating, 0, alphas[a]);
        bsdf.metallic_roughness.transmission = 1;
        check_furnace(&bsdf, "sheet", alphas[a], 192);
    }
}

/* ---- displays --------------------------------------------------------------------------- */

TEST(a_covers_factor_is_coated_over_bare) {
    LayerStack *stack = stack_four(test_memory());
    const CoatingTables *cover = coating_of_cover(stack, 1.5, test_memory());
    for (int i = 1; i <= 40; i++) {
        float cosine = (float)i / 40;
        Spectrum factor = coating_at(cover->front, &wavelengths, cosine);
        double bare = fresnel_unpolarised_d((double)cosine, 1.5);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            double r, t;
            mean_shares(stack, (ThinMedium){1.5, 0, 0}, (double)wavelengths.nm[k], (double)cosine,
                        false, &r, &t);
            assert_near((double)factor[k] * bare, r, 3e-4);
        }
    }
}

TEST_PROGRAM(make_wavelengths, drop_arena)
