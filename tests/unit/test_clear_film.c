/* Thin films on plastic and metal: Airy's closed form, the transfer matrix, energy. */
#include "furnace_fixture.h"

#include "shaders/common_tables.h"

static Wavelengths wavelengths;

static int make_wavelengths(void **state)
{
    (void)state;
    wavelengths_sample(0.4f, &wavelengths);
    return 0;
}

/* Straight on: R = (a^2 + b^2 + 2 a b cos d) / (1 + a^2 b^2 + 2 a b cos d) with
 * d = 4 pi n t / nm. */
TEST(straight_on_it_is_airys_formula)
{
    (void)state;
    ThinFilm film = {.share = 1, .ior = 1.38f, .thickness_nm = 410};
    Spectrum n = spectrum_all(1.52f), k = spectrum_all(0);
    Spectrum r = clear_film_at(&film, &wavelengths, 1, n, k);
    double   a = (1 - 1.38) / (1 + 1.38), b = (1.38 - 1.52) / (1.38 + 1.52);
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        double c = 2 * a * b * cos(4 * PI * 1.38 * 410 / (double)wavelengths.nm[i]);
        assert_near(r[i], (a * a + b * b + c) / (1 + a * a * b * b + c), 1e-5);
    }
}

/* At every angle, on clear and absorbing bodies, it is one layer of spectrum/thin_film.h. */
TEST(at_any_angle_it_is_the_transfer_matrix)
{
    (void)state;
    static const double bodies[][2] = {{1.5, 0}, {2.4, 0}, {1.2, 0}, {0.06, 3.6}, {2.9, 3.1}};
    for (int i = 0; i < 5 * 20 * 3; i++) {
        int    body = i % 5, lane = i / 5 % 3 * 7; /* three wavelengths */
        double cosine = (i / 15 + 0.5) / 20, ior = i % 2 ? 1.3 : 2.1;
        double thickness = 100 + 40 * (i % 17);
        ThinFilm  film = {.share = 1, .ior = (float)ior, .thickness_nm = (float)thickness};
        ThinMedia media = {.nm = (double)wavelengths.nm[lane], .count = 3,
                           .medium = {{1, 0, 0}, {(double)film.ior, 0, thickness},
                                      {bodies[body][0], bodies[body][1], 0}}};
        ThinShares at = thin_film_at(&media, (double)(float)cosine);
        Spectrum   r = clear_film_at(&film, &wavelengths, (float)cosine,
                                        spectrum_all((float)bodies[body][0]),
                                        spectrum_all((float)bodies[body][1]));
        assert_near(r[lane], 0.5 * (at.reflect_s + at.reflect_p), 1e-4);
    }
}

/* A film of no thickness leaves the body's own reflectance. */
TEST(a_body_reflects_what_it_was_made_of)
{
    (void)state;
    ThinFilm film = {.share = 1, .ior = 1.3f, .thickness_nm = 0};
    for (float f0 = 0; f0 < 1; f0 += 0.125f) {
        Spectrum n = clear_film_body(spectrum_all(f0));
        assert_near(clear_film_at(&film, &wavelengths, 1, n, spectrum_all(0))[5], f0, 1e-5);
    }
    Spectrum white = clear_film_body(spectrum_all(1));
    film.thickness_nm = 300;
    assert_near(clear_film_at(&film, &wavelengths, 0.5f, white, spectrum_all(0))[9], 1, 2e-4);
}

static void check_white(const MetallicRoughness *m, double theta_deg, double allowed)
{
    double sent = furnace_of(m, theta_deg, 0, 48);
    if (!(fabs(sent - 1) <= allowed))
        fail_msg("metal %g, alpha %g by %g, film of %g nm, coat %g, sheet %g, %g deg: %g",
                 (double)m->metallic, (double)m->alpha, (double)m->alpha_along,
                 (double)m->film.thickness_nm, (double)m->clearcoat, (double)m->transmission,
                 theta_deg, sent);
}

static void check_films(float metallic, float clearcoat, double allowed)
{
    static const float  alphas[] = {0, 0.01f, 0.1f, 0.35f, 1}, nm[] = {150, 400, 550};
    static const double thetas_deg[] = {0, 30, 60, 75, 85};
    for (int i = 0; i < 75; i++) {
        MetallicRoughness m = metallic_roughness_default(&common_energy_table);
        m.metallic = metallic;
        m.alpha = alphas[i % 5];
        m.wavelengths = &wavelengths;
        m.clearcoat = clearcoat;
        m.clearcoat_energy = &common_energy_table;
        m.coat = &common_coat_table;
        m.film = (ThinFilm){.share = i % 2 ? 1 : 0.6f, .ior = 1.8f,
                            .thickness_nm = nm[i / 5 % 3]};
        if (m.alpha > 0 && i % 4 == 3 && !(clearcoat > 0))
            m.alpha_along = 0.5f * (m.alpha + 1);
        check_white(&m, thetas_deg[i / 15], allowed);
    }
}

TEST(a_white_furnace_stays_white)
{
    (void)state;
    check_films(0, 0, 2.2e-3);
    check_films(1, 0, 2e-3);
    check_films(0.5f, 0, 2e-3);
}

/* The film's curve is taken for even over what the coat holds back. */
TEST(under_a_lacquer_it_stays_nearly_white)
{
    (void)state;
    check_films(0, 1, 1.5e-2);
    check_films(1, 1, 3e-3);
}

int main(void)
{
    return run_cases(make_wavelengths, NULL);
}
