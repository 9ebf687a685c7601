/* SPDX-License-Identifier: Apache-2.0 */
/* Rough boundaries of solids: light that facets pass to one another is not lost. */
#include "fixture.h"

#include "brushed_fixture.h"
#include "layer_fixture.h"
#include "shader_fixture.h"

#include "base/units.h"
#include "shaders/bsdf.h"
#include "shaders/layers/coating_tables.h"
#include "spectrum/dispersion.h"

static Arena arena;
static Wavelengths wavelengths;

static int reserve(void **state) {
    make_arena(state);
    arena = test_arena(state);
    wavelengths_sample(0.3f, &wavelengths);
    return 0;
}

static Bsdf boundary(float ior, float alpha, const SolidEnergy *energy) {
    return (Bsdf){.kind = BSDF_DIELECTRIC,
                  .dielectric = {.tint = spectrum_all(1),
                                 .ior = ior,
                                 .alpha = alpha,
                                 .wavelengths = &wavelengths,
                                 .energy = energy}};
}

#define LANE 7

/* How much more radiance the same light has inside: ior^2 of the lane. */
static double squeezed(const Dielectric *d) {
    float n = d->index ? curve_lookup(d->index, d->wavelengths)[LANE] : d->ior;
    return (double)n * (double)n;
}

/* What single facets show where light of radiance 1 outside and ior^2 inside, which is one
 * light, comes from everywhere. The points run evenly through the cube by Roberts' lattice. */
static double single_facets(const Bsdf *bsdf, Vec3 wo) {
    enum { COUNT = 1 << 18 };
    double inside = squeezed(&bsdf->dielectric), sum = 0;
    for (int i = 0; i < COUNT; i++) {
        const float u[3] = {(float)fmod(0.5 + i * 0.6710436067037893, 1),
                            (float)fmod(0.5 + i * 0.8191725133961645, 1),
                            (float)fmod(0.5 + i * 0.5497004779019703, 1)};
        BsdfSample s;
        if (bsdf_sample(bsdf, wo, u, &s)) sum += (double)s.weight[LANE] * (s.wi.z < 0 ? inside : 1);
    }
    return sum / COUNT / (wo.z < 0 ? inside : 1);
}

/* The same of what facets pass to one another, with cos = t^2; it has no azimuth where both
 * alphas are one, else one quarter stands for all. */
static double passed_about(const Bsdf *whole, const Bsdf *single, Vec3 wo) {
    enum { COUNT = 4096, TURNS = 16 };
    double inside = squeezed(&whole->dielectric), sum = 0;
    bool is_brushed = solid_is_brushed(&whole->dielectric);
    for (int i = 0; i < COUNT; i++) {
        double t = (i / 2 + 0.5) / (COUNT / 2), weight = 4 * PI * t * t * t / (COUNT / 2);
        double turn = is_brushed ? PI / 2 * (i / 2 % TURNS + 0.5) / TURNS : PI / 2;
        float cosine = (float)(t * t), sine = safe_sqrtf(1 - cosine * cosine), pdf;
        Vec3 wi = vec3(sine * (float)cos(turn), sine * (float)sin(turn), i % 2 ? -cosine : cosine);
        double f = (double)bsdf_eval(whole, wo, wi, &pdf)[LANE] -
                   (double)bsdf_eval(single, wo, wi, &pdf)[LANE];
        sum += weight * f * (wi.z < 0 ? inside : 1);
    }
    return sum / (wo.z < 0 ? inside : 1);
}

/* A furnace does not show the boundary from either side, within `limit`, to eyes at azimuth
 * phi. */
static void check_azimuth(const char *name, const Bsdf *whole, double phi_deg, double limit) {
    static const double degrees[] = {0, 60, 85};
    double phi = radians_from_degrees(phi_deg);
    Bsdf single = *whole;
    single.dielectric.energy = NULL;
    for (int i = 0; i < 6; i++) {
        double t = radians_from_degrees(degrees[i / 2]);
        Vec3 wo = vec3((float)(sin(t) * cos(phi)), (float)(sin(t) * sin(phi)), (float)cos(t));
        if (i % 2) wo.z = -wo.z;
        double found = single_facets(&single, wo) + passed_about(whole, &single, wo);
        if (fabs(found - 1) > limit)
            fail_msg("%s, ior %g, alpha %g (along x %g), %g degrees %s at %g: %.5f", name,
                     (double)whole->dielectric.ior, (double)whole->dielectric.alpha,
                     (double)whole->dielectric.alpha_along, degrees[i / 2],
                     i % 2 ? "inside" : "outside", phi_deg, found);
    }
}

static void check_both_sides(const char *name, const Bsdf *whole, double limit) {
    check_azimuth(name, whole, 0, limit);
}

/* At roughnesses on the table's rows and between. */
TEST(a_furnace_does_not_show_rough_solids) {
    static const float iors[] = {1.05f, 1.5f, 2.42f, 0.75f};
    static const float alphas[] = {0.02f, 0.11f, 0.4f, 0.71f, 0.9f, 1};
    for (int i = 0; i < 24; i++) {
        float ior = iors[i / 6], alpha = alphas[i % 6];
        Bsdf bare = boundary(ior, alpha, solid_energy_build(ior, alpha, alpha, false, &arena));
        check_both_sides("bare", &bare, 0.001);
    }
}

TEST(nor_coated_and_filmed_ones) {
    static const float alphas[] = {0.1f, 0.4f, 1};
    const CoatingTables *four = coating_of_solid(stack_four(&arena), 1.52, &arena);
    for (int i = 0; i < 3; i++) {
        float alpha = alphas[i];
        Bsdf bsdf = boundary(1.52f, alpha, solid_energy_build(1.52f, alpha, alpha, true, &arena));
        bsdf.dielectric.coating = four;
        check_both_sides("four layers", &bsdf, 0.002);
        bsdf.dielectric.coating = NULL;
        bsdf.dielectric.film = (ThinFilm){.share = 1, .ior = 2, .thickness_nm = 420};
        check_both_sides("a film", &bsdf, 0.002);
    }
}

/* Of glTF's strongest dispersion. */
TEST(hardly_those_that_part_light) {
    for (int i = 0; i < 4; i++) {
        Curve *index = ARENA_NEW(&arena, Curve, 1);
        float alpha = i % 2 ? 0.8f : 0.3f;
        for (int nm = 0; nm < CURVE_COUNT; nm++)
            index->value[nm] = (float)dispersion_index(1.6, 1, CURVE_FIRST_NM + nm);
        float least = index->value[CURVE_COUNT - 1], most = index->value[0];
        Bsdf bsdf = boundary(1.6f, alpha, NULL);
        Dielectric *d = &bsdf.dielectric;
        d->index = index;
        d->energy = solid_energy_build(least, alpha, alpha, true, &arena);
        d->energy_most = solid_energy_build(most, alpha, alpha, false, &arena);
        if (i / 2) d->film = (ThinFilm){.share = 1, .ior = 1.8f, .thickness_nm = 350};
        check_both_sides(i / 2 ? "a film on flint" : "flint", &bsdf, 0.006);
        d->alpha_along = 0.7f * alpha;
        d->energy = brushed_energy(least, d->alpha_along, alpha, true, &arena);
        d->energy_most = brushed_energy(most, d->alpha_along, alpha, false, &arena);
        check_azimuth(i / 2 ? "a film on brushed flint" : "brushed flint", &bsdf, 50, 0.006);
    }
}

/* Alphas along x and y, as glTF makes them and turned. */
static const float pairs[][2] = {{0.3f, 0.02f}, {0.05f, 0.5f}, {1, 0.1f},
                                 {0.4f, 0.7f},  {1, 1},        {0.65f, 0.36f}};

TEST(nor_brushed_ones) {
    static const float iors[] = {1.05f, 1.5f, 2.42f, 0.75f};
    static const double phis_deg[] = {0, 25, 60, 80, 90};
    for (int i = 0; i < 12; i++) {
        float ior = iors[i % 4], along = pairs[i % 6][0], across = pairs[i % 6][1];
        Bsdf bsdf = boundary(ior, across, brushed_energy(ior, along, across, false, &arena));
        bsdf.dielectric.alpha_along = along;
        check_azimuth("brushed", &bsdf, phis_deg[i % 5], 0.002);
    }
}

/* One table for all that a texture of roughness or strength makes. */
TEST(hardly_brushed_ones_of_many_alphas) {
    const BrushedRange all = {.least = 0.04f, .most = 1, .least_ratio = 0.04f, .most_ratio = 1};
    const SolidEnergy *even = solid_energy_build(1.5f, 0.04f, 1, false, &arena);
    const SolidEnergy *energy = solid_energy_brushed(even, all, &arena);
    for (int i = 0; i < 6; i++) {
        Bsdf bsdf = boundary(1.5f, pairs[i][1], energy);
        bsdf.dielectric.alpha_along = pairs[i][0];
        check_azimuth("brushed anyhow", &bsdf, 15.0 * i, 0.01);
    }
}

TEST(nor_brushed_ones_under_coatings_and_films) {
    const CoatingTables *four = coating_of_solid(stack_four(&arena), 1.52, &arena);
    for (int i = 0; i < 3; i++) {
        float along = pairs[i][0], across = pairs[i][1];
        Bsdf bsdf = boundary(1.52f, across, brushed_energy(1.52f, along, across, true, &arena));
        bsdf.dielectric.alpha_along = along;
        bsdf.dielectric.coating = four;
        check_azimuth("four layers", &bsdf, 35, 0.002);
        bsdf.dielectric.coating = NULL;
        bsdf.dielectric.film = (ThinFilm){.share = 1, .ior = 2, .thickness_nm = 420};
        check_azimuth("a film", &bsdf, 35, 0.002);
    }
}

TEST_PROGRAM(reserve, drop_arena)
