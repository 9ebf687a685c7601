/* SPDX-License-Identifier: Apache-2.0 */
/* Stacks of thin layers, held to closed forms. */
#include "check.h"

#include <string.h>

#include "base/units.h"
#include "spectrum/fresnel.h"
#include "spectrum/thin_film.h"

static const double COSINES[] = {1, 0.9, 0.7, 0.5, 0.34202014332566873, 0.1, 0.01};
#define COSINE_COUNT ((int)(sizeof COSINES / sizeof *COSINES))

static ThinMedia media_of(double nm, int count, const ThinMedium *medium) {
    ThinMedia media = {.nm = nm, .count = count};
    memcpy(media.medium, medium, (size_t)count * sizeof *medium);
    return media;
}

TEST(a_quarter_wave_of_1_38_on_glass_reflects_1_26_percent) {
    ThinMedia media =
        media_of(550, 3, (ThinMedium[]){{1, 0, 0}, {1.38, 0, 550 / (4 * 1.38)}, {1.52, 0, 0}});
    double wanted = pow((1.52 - 1.38 * 1.38) / (1.52 + 1.38 * 1.38), 2);
    ThinShares at = thin_film_at(&media, 1);
    assert_near(wanted, 0.01260, 5e-6);
    assert_near(at.reflect_s, wanted, 1e-14);
    assert_near(at.reflect_p, wanted, 1e-14);
}

/* Born and Wolf, 1.5.2. */
TEST(no_layer_on_glass_is_fresnel) {
    static const double indices[] = {1.0001, 1.33, 1.52, 2.4, 0.6579, 0.4};
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < COSINE_COUNT; c++) {
            double n = indices[i], cosine = COSINES[c];
            ThinMedia media = media_of(500, 2, (ThinMedium[]){{1, 0, 0}, {n, 0, 0}});
            ThinShares at = thin_film_at(&media, cosine);
            double sine2 = (1 - cosine * cosine) / (n * n);
            if (sine2 >= 1) {
                assert_near(at.reflect_s, 1, 1e-12);
                assert_near(at.reflect_p, 1, 1e-12);
                assert_near(at.through_s + at.through_p, 0, 1e-12);
                continue;
            }
            double behind = sqrt(1 - sine2);
            double s = (cosine - n * behind) / (cosine + n * behind);
            double p = (n * cosine - behind) / (n * cosine + behind);
            assert_near(at.reflect_s, s * s, 1e-12);
            assert_near(at.reflect_p, p * p, 1e-12);
            assert_near((at.reflect_s + at.reflect_p) / 2, fresnel_unpolarised_d(cosine, n), 1e-12);
            assert_near(at.through_s, 1 - s * s, 1e-12);
            assert_near(at.through_p, 1 - p * p, 1e-12);
        }
}

/* Real form of Fresnel's equations of a conductor (Born and Wolf, 14.2): with
 * a^2 + b^2 = |q^2 - sin^2| and a^2 - b^2 = n^2 - k^2 - sin^2. */
TEST(no_layer_on_metal_is_fresnel) {
    static const double metals[][2] = {{0.06, 3.6}, {0.96, 6.7}, {3.1, 3.3}, {1.5, 0.01}};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < COSINE_COUNT; c++) {
            double n = metals[i][0], k = metals[i][1], x = COSINES[c], y2 = 1 - x * x;
            ThinMedia media = media_of(600, 2, (ThinMedium[]){{1, 0, 0}, {n, k, 0}});
            ThinShares at = thin_film_at(&media, x);
            double real = n * n - k * k - y2, all = hypot(real, 2 * n * k);
            double a = sqrt((all + real) / 2);
            double s = (all - 2 * a * x + x * x) / (all + 2 * a * x + x * x);
            double tangent = y2 / x;
            double p = s * (all - 2 * a * tangent + tangent * tangent) /
                       (all + 2 * a * tangent + tangent * tangent);
            assert_near(at.reflect_s, s, 1e-12);
            assert_near(at.reflect_p, p, 1e-12);
        }
}

/* At its own angle a half wave is as if it were not there. */
TEST(a_half_wave_is_absent) {
    for (int c = 0; c < COSINE_COUNT; c++)
        for (int m = 1; m <= 3; m++) {
            double inside = sqrt(2.1 * 2.1 - 1 + COSINES[c] * COSINES[c]);
            ThinMedia bare = media_of(450, 2, (ThinMedium[]){{1, 0, 0}, {1.6, 0.2, 0}});
            ThinMedia film = media_of(
                450, 3, (ThinMedium[]){{1, 0, 0}, {2.1, 0, m * 450 / (2 * inside)}, {1.6, 0.2, 0}});
            ThinShares a = thin_film_at(&bare, COSINES[c]), b = thin_film_at(&film, COSINES[c]);
            assert_near(a.reflect_s, b.reflect_s, 1e-12);
            assert_near(a.reflect_p, b.reflect_p, 1e-12);
            assert_near(a.through_s, b.through_s, 1e-12);
            assert_near(a.through_p, b.through_p, 1e-12);
        }
}

/* Airy's sum for one film: r = (r1 + r2 e^(2i b)) / (1 + r1 r2 e^(2i b)), each r by Fresnel's
 * equations in their angles. */
static double airy(double nm, double cosine, double film, double thickness_nm, double body,
                   bool is_p) {
    double n[3] = {1, film, body}, x[3], r[2];
    for (int i = 0; i < 3; i++) x[i] = sqrt(1 - (1 - cosine * cosine) / (n[i] * n[i]));
    for (int i = 0; i < 2; i++)
        r[i] = is_p ? (n[i + 1] * x[i] - n[i] * x[i + 1]) / (n[i + 1] * x[i] + n[i] * x[i + 1])
                    : (n[i] * x[i] - n[i + 1] * x[i + 1]) / (n[i] * x[i] + n[i + 1] * x[i + 1]);
    double b = 2 * PI * film * thickness_nm * x[1] / nm, cos2 = cos(2 * b);
    double up = r[0] * r[0] + r[1] * r[1] + 2 * r[0] * r[1] * cos2;
    return up / (1 + r[0] * r[0] * r[1] * r[1] + 2 * r[0] * r[1] * cos2);
}

TEST(one_film_is_airys_sum_at_three_wavelengths) {
    static const double wavelengths_nm[] = {450, 550, 650};
    for (int w = 0; w < 3; w++)
        for (int c = 0; c < COSINE_COUNT; c++)
            for (int k = 1; k < 8; k++) {
                double d = 90.0 * k, nm = wavelengths_nm[w], film = k & 1 ? 1.38 : 2.3;
                ThinMedia media =
                    media_of(nm, 3, (ThinMedium[]){{1, 0, 0}, {film, 0, d}, {1.52, 0, 0}});
                ThinShares at = thin_film_at(&media, COSINES[c]);
                assert_near(at.reflect_s, airy(nm, COSINES[c], film, d, 1.52, false), 1e-12);
                assert_near(at.reflect_p, airy(nm, COSINES[c], film, d, 1.52, true), 1e-12);
            }
}

/* N pairs of quarter waves H L on a body: R = ((n0 - Y) / (n0 + Y))^2 with the admittance
 * Y = nB (H / L)^(2N) seen from L's front, here outermost H: Macleod, "Thin-Film Optical
 * Filters", quarter-wave stacks. */
TEST(a_quarter_wave_mirror_of_2n_layers_follows_its_formula) {
    for (int pairs = 0; pairs <= 10; pairs++) {
        ThinMedia media = {.nm = 600, .count = 2 * pairs + 2};
        media.medium[0] = (ThinMedium){1, 0, 0};
        for (int i = 1; i <= 2 * pairs; i++) {
            double n = i & 1 ? 2.35 : 1.46;
            media.medium[i] = (ThinMedium){n, 0, 600 / (4 * n)};
        }
        media.medium[2 * pairs + 1] = (ThinMedium){1.52, 0, 0};
        double y = 1.52 * pow(2.35 / 1.46, 2 * pairs);
        ThinShares at = thin_film_at(&media, 1);
        assert_near(at.reflect_s, pow((1 - y) / (1 + y), 2), 1e-12);
        assert_near(at.through_s, 4 * y / ((1 + y) * (1 + y)), 1e-12);
    }
}

/* Any stack of some seed; is_lossless: without k. */
static ThinMedia some_stack(int seed, bool is_lossless) {
    ThinMedia media = {.nm = 400 + 37 * seed % 400, .count = 3 + seed % 7};
    for (int i = 0; i < media.count; i++) {
        double n = 0.2 + fmod(1.7 * i + 0.61 * seed, 2.5);
        double k = is_lossless ? 0 : fmod(0.37 * i * seed, 1.3);
        media.medium[i] = (ThinMedium){n, k, fmod(71.0 * i + 13.0 * seed, 400)};
    }
    media.medium[0] = (ThinMedium){1 + 0.1 * (seed % 6), 0, 0};
    media.medium[media.count - 1].k = seed & 1 && !is_lossless ? 2 : 0;
    return media;
}

TEST(no_light_is_made_and_without_absorption_none_is_lost) {
    for (int seed = 0; seed < 200; seed++)
        for (int c = 0; c < COSINE_COUNT; c++) {
            ThinMedia clear = some_stack(seed, true), dark = some_stack(seed, false);
            ThinShares a = thin_film_at(&clear, COSINES[c]);
            ThinShares b = thin_film_at(&dark, COSINES[c]);
            assert_near(a.reflect_s + a.through_s, 1, 1e-12);
            assert_near(a.reflect_p + a.through_p, 1, 1e-12);
            assert_true(b.reflect_s + b.through_s <= 1 + 1e-12);
            assert_true(b.reflect_p + b.through_p <= 1 + 1e-12);
            assert_true(b.reflect_s >= 0 && b.reflect_p >= 0);
            assert_true(b.through_s >= 0 && b.through_p >= 0);
        }
}

TEST(turned_round_a_stack_lets_the_same_through) {
    int asked = 0, lossy = 0;
    for (int seed = 0; seed < 200; seed += 2)
        for (int c = 0; c < COSINE_COUNT; c++) {
            ThinMedia media = some_stack(seed, false);
            double ratio = media.medium[0].n / media.medium[media.count - 1].n;
            double behind2 = 1 - (1 - COSINES[c] * COSINES[c]) * ratio * ratio;
            if (!(behind2 > 0)) continue;
            ThinShares a = thin_film_at(&media, COSINES[c]);
            thin_film_reverse(&media);
            ThinShares b = thin_film_at(&media, sqrt(behind2));
            assert_near(a.through_s, b.through_s, 1e-12);
            assert_near(a.through_p, b.through_p, 1e-12);
            lossy += fabs(a.reflect_s - b.reflect_s) > 1e-3;
            asked++;
        }
    assert_true(asked > 300 && lossy > 100);
}

/* However thick a layer is. */
TEST(a_thick_metal_layer_is_the_metal) {
    for (int c = 0; c < COSINE_COUNT; c++) {
        ThinMedia bare = media_of(550, 2, (ThinMedium[]){{1, 0, 0}, {0.06, 3.6, 0}});
        ThinMedia film =
            media_of(550, 3, (ThinMedium[]){{1, 0, 0}, {0.06, 3.6, 1e7}, {1.52, 0, 0}});
        ThinShares a = thin_film_at(&bare, COSINES[c]), b = thin_film_at(&film, COSINES[c]);
        assert_near(a.reflect_s, b.reflect_s, 1e-13);
        assert_near(a.reflect_p, b.reflect_p, 1e-13);
        assert_true(b.through_s == 0 && b.through_p == 0);
    }
}

TEST_PROGRAM(NULL, NULL)
