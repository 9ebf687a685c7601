/* SPDX-License-Identifier: Apache-2.0 */
/* Thin films on plastic, metal and clear solids: Airy's closed form, the transfer matrix, total
 * reflection, energy. */
#include "furnace_fixture.h"

#include "shaders/facets/coat.h"

static Wavelengths wavelengths;

static int make_wavelengths(void **state) {
    (void)state;
    wavelengths_sample(0.4f, &wavelengths);
    return 0;
}

/* Straight on: R = (a^2 + b^2 + 2 a b cos d) / (1 + a^2 b^2 + 2 a b cos d) with
 * d = 4 pi n t / nm. */
TEST(straight_on_it_is_airys_formula) {
    ThinFilm film = {.share = 1, .ior = 1.38f, .thickness_nm = 410};
    Spectrum n = spectrum_all(1.52f), k = spectrum_all(0);
    Spectrum r = clear_film_at(&film, &wavelengths, 1, n, k);
    double a = (1 - 1.38) / (1 + 1.38), b = (1.38 - 1.52) / (1.38 + 1.52);
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        double c = 2 * a * b * cos(4 * PI * 1.38 * 410 / (double)wavelengths.nm[i]);
        assert_near(r[i], (a * a + b * b + c) / (1 + a * a * b * b + c), 1e-5);
    }
}

/* At every angle, on clear and absorbing bodies, it is one layer of spectrum/thin_film.h. */
TEST(at_any_angle_it_is_the_transfer_matrix) {
    static const double bodies[][2] = {{1.5, 0}, {2.4, 0}, {1.2, 0}, {0.06, 3.6}, {2.9, 3.1}};
    for (int i = 0; i < 5 * 20 * 3; i++) {
        int body = i % 5, lane = i / 5 % 3 * 7; /* three wavelengths */
        double cosine = (i / 15 + 0.5) / 20, ior = i % 2 ? 1.3 : 2.1;
        double thickness = 100 + 40 * (i % 17);
        ThinFilm film = {.share = 1, .ior = (float)ior, .thickness_nm = (float)thickness};
        ThinMedia media = {.nm = (double)wavelengths.nm[lane],
                           .count = 3,
                           .medium = {{1, 0, 0},
                                      {(double)film.ior, 0, thickness},
                                      {bodies[body][0], bodies[body][1], 0}}};
        ThinShares at = thin_film_at(&media, (double)(float)cosine);
        Spectrum r =
            clear_film_at(&film, &wavelengths, (float)cosine, spectrum_all((float)bodies[body][0]),
                          spectrum_all((float)bodies[body][1]));
        assert_near(r[lane], 0.5 * (at.reflect_s + at.reflect_p), 1e-4);
    }
}

/* A film of no thickness leaves the body's own reflectance. */
TEST(a_body_reflects_what_it_was_made_of) {
    ThinFilm film = {.share = 1, .ior = 1.3f, .thickness_nm = 0};
    for (float f0 = 0; f0 < 1; f0 += 0.125f) {
        Spectrum n = clear_film_body(spectrum_all(f0));
        assert_near(clear_film_at(&film, &wavelengths, 1, n, spectrum_all(0))[5], f0, 1e-5);
    }
    Spectrum white = clear_film_body(spectrum_all(1));
    film.thickness_nm = 300;
    assert_near(clear_film_at(&film, &wavelengths, 0.5f, white, spectrum_all(0))[9], 1, 2e-4);
}

static void check_white(const MetallicRoughness *m, double theta_deg, double allowed) {
    double sent = furnace_of(m, theta_deg, 0, furnace_side(m));
    if (!(fabs(sent - 1) <= allowed))
        fail_msg("metal %g, alpha %g by %g, film of %g nm, coat %g, sheet %g, %g deg: %g",
                 (double)m->metallic, (double)m->alpha, (double)m->alpha_along,
                 (double)m->film.thickness_nm, (double)m->clearcoat, (double)m->transmission,
                 theta_deg, sent);
}

/* Every so many of all. */
static void check_films(float metallic, float clearcoat, int step, double allowed) {
    static const float alphas[] = {0, 0.01f, 0.1f, 0.35f, 1}, nm[] = {150, 400, 550};
    static const double thetas_deg[] = {0, 30, 60, 75, 85};
    for (int i = 0; i < 75; i += step) {
        MetallicRoughness m = metallic_roughness_default(&common_energy_table);
        m.metallic = metallic;
        m.alpha = alphas[i % 5];
        m.wavelengths = &wavelengths;
        m.clearcoat = clearcoat;
        m.clearcoat_energy = &common_energy_table;
        m.coat = &common_coat_table;
        m.film = (ThinFilm){.share = i % 2 ? 1 : 0.6f, .ior = 1.8f, .thickness_nm = nm[i / 5 % 3]};
        if (m.alpha > 0 && i % 4 == 3) m.alpha_along = 0.5f * (m.alpha + 1);
        check_white(&m, thetas_deg[i / 15], allowed);
    }
}

TEST(a_white_furnace_stays_white) {
    check_films(0, 0, 1, 2.2e-3);
    check_films(1, 0, 1, 2e-3);
    check_films(0.5f, 0, 1, 2e-3);
}

TEST(under_a_lacquer_it_stays_white) {
    check_films(0, 1, 2, 2e-3);
    check_films(1, 1, 7, 2e-3);
}

/* ---- on clear solids -------------------------------------------------------------------- */

static Bsdf filmed_solid(float n, ThinFilm film) {
    return (Bsdf){
        .kind = BSDF_DIELECTRIC,
        .dielectric = {
            .tint = spectrum_all(1), .ior = n, .film = film, .wavelengths = &wavelengths}};
}

static Vec3 at_cosine(double cosine) {
    return vec3((float)sqrt(1 - cosine * cosine), 0, (float)cosine);
}

/* From both sides, also beyond the critical angle, where all of it comes back. */
TEST(a_clear_solid_reflects_by_the_transfer_matrix) {
    static const double bodies[] = {1, 1.2, 1.33, 1.5, 2.4};
    int total = 0;
    for (int i = 0; i < 5 * 40 * 3; i++) {
        double body = bodies[i % 5], cosine = (i / 15 + 0.5) / 40;
        int lane = i / 5 % 3 * 7;
        double ior = i % 2 ? 1.3 : 2.1, thickness = 100 + 40 * (i % 17);
        ThinFilm film = {.share = 1, .ior = (float)ior, .thickness_nm = (float)thickness};
        ThinMedia media = {
            .nm = (double)wavelengths.nm[lane],
            .count = 3,
            .medium = {{1, 0, 0}, {(double)film.ior, 0, thickness}, {(double)(float)body, 0, 0}}};
        Bsdf bsdf = filmed_solid((float)body, film);
        for (int side = 1; side >= -1; side -= 2) {
            Vec3 wo = at_cosine(cosine);
            if (side < 0) thin_film_reverse(&media);
            ThinShares at = thin_film_at(&media, (double)wo.z);
            double wanted = 0.5 * (at.reflect_s + at.reflect_p);
            wo.z *= (float)side;
            Spectrum r = bsdf_mirror(&bsdf, wo);
            total += r[lane] == 1;
            if (!(fabs((double)r[lane] - wanted) < 1e-4))
                fail_msg("body %g, film %g of %g nm, cos %g: %g, required: %g", body, ior,
                         thickness, cosine * side, (double)r[lane], wanted);
        }
    }
    assert_true(total > 60);
}

/* Whichever way it goes, along conjugate angles: to the last digits. */
TEST(a_film_reflects_as_much_from_within) {
    Bsdf bsdf = filmed_solid(1.5f, (ThinFilm){.share = 0.7f, .ior = 1.9f, .thickness_nm = 520});
    for (int i = 1; i <= 90; i++) {
        double outside = i / 90.0, inside = sqrt(1 - (1 - outside * outside) / (1.5 * 1.5));
        Vec3 within = at_cosine(inside);
        Spectrum front = bsdf_mirror(&bsdf, at_cosine(outside));
        Spectrum back = bsdf_mirror(&bsdf, vec3(within.x, 0, -within.z));
        for (int k = 0; k < SPECTRUM_LANES; k++)
            assert_near(front[k], back[k], 2e-4 * (double)front[k] + 1e-6);
    }
}

/* Sampled over the choice: what comes back is the mirror's, the rest goes on, in every lane. */
static void check_shares(const Bsdf *bsdf, Vec3 wo, const Spectrum *index) {
    enum { COUNT = 4096 };
    Spectrum back = spectrum_all(0), on = spectrum_all(0), mirror = bsdf_mirror(bsdf, wo);
    Spectrum squeezed = *index * *index;
    if (wo.z < 0) squeezed = spectrum_all(1) / squeezed;
    for (int i = 0; i < COUNT; i++) {
        BsdfSample s;
        float u[3] = {0, 0, ((float)i + 0.5f) / COUNT};
        if (!bsdf_sample(bsdf, wo, u, &s)) continue;
        if (s.wi.z * wo.z > 0) back += s.weight;
        else on += s.weight * squeezed;
    }
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        double sent = (double)back[k] / COUNT, passed = (double)on[k] / COUNT;
        assert_near(sent, mirror[k], 4e-3);
        assert_near(sent + passed, 1, 1e-2);
    }
}

TEST(what_a_film_does_not_reflect_goes_through) {
    Curve index;
    ThinFilm film = {.share = 1, .ior = 2, .thickness_nm = 300};
    for (int i = 0; i < CURVE_COUNT; i++) index.value[i] = 1.5f + 1e-3f * (float)(i % 200);
    for (int i = 0; i < 40; i++) {
        Bsdf bsdf = filmed_solid(1.5f, film);
        Spectrum n = spectrum_all(1.5f);
        Vec3 wo = at_cosine((i % 20 + 0.5) / 20);
        if (i >= 20) wo.z = -wo.z;
        check_shares(&bsdf, wo, &n);
        bsdf.dielectric.index = &index;
        n = curve_lookup(&index, &wavelengths);
        check_shares(&bsdf, wo, &n);
    }
}

/* Of a glass that parts light each lane has the film on its own index. */
TEST(each_lane_of_a_prism_has_its_own_film) {
    Curve index;
    for (int i = 0; i < CURVE_COUNT; i++) index.value[i] = 1.8f - 6e-4f * (float)i;
    for (int i = 0; i < 80; i++) {
        Bsdf bsdf = filmed_solid(1.5f, (ThinFilm){.share = 0.8f, .ior = 1.4f, .thickness_nm = 260});
        Bsdf prism = bsdf;
        Vec3 wo = at_cosine((i % 40 + 0.5) / 40);
        if (i >= 40) wo.z = -wo.z;
        prism.dielectric.index = &index;
        Spectrum n = curve_lookup(&index, &wavelengths), r = bsdf_mirror(&prism, wo);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            bsdf.dielectric.ior = n[k];
            assert_near(r[k], bsdf_mirror(&bsdf, wo)[k], 1e-5);
        }
    }
}

TEST(a_share_of_the_film_leaves_the_rest_bare) {
    ThinFilm film = {.share = 1, .ior = 1.7f, .thickness_nm = 280};
    Bsdf all = filmed_solid(1.5f, film), bare = all, some = all;
    bare.dielectric.film.share = 0;
    some.dielectric.film.share = 0.3f;
    for (int i = 1; i < 20; i++) {
        Vec3 wo = at_cosine(i / 20.0);
        Spectrum a = bsdf_mirror(&all, wo), b = bsdf_mirror(&bare, wo);
        Spectrum mixed = bsdf_mirror(&some, wo);
        for (int k = 0; k < SPECTRUM_LANES; k++)
            assert_near(mixed[k], 0.3 * (double)a[k] + 0.7 * (double)b[k], 1e-6);
    }
}

TEST_PROGRAM(make_wavelengths, NULL)
