/* SPDX-License-Identifier: Apache-2.0 */
/* Polarised light against closed forms: Fresnel's waves, polarisers, and what must hold of
 * every chain of surfaces. */
#include "shader_fixture.h"

#include <complex.h>

#include "base/count.h"
#include "base/units.h"
#include "path/polarised.h"
#include "shaders/polarisation.h"

static const double indices[] = {1.33, 1.5, 2.4, 1 / 1.33, 1 / 1.5, 1 / 2.4};

enum { INDEX_COUNT = sizeof indices / sizeof *indices };

/* Complex amplitudes, in double precision (Born and Wolf, 1.5.2 and 1.5.4). */
static void amplitudes(double cosine, double n, double complex *s, double complex *p) {
    double sine2 = (1 - cosine * cosine) / (n * n);
    double real = sine2 < 1 ? sqrt(1 - sine2) : 0, imaginary = sine2 < 1 ? 0 : sqrt(sine2 - 1);
    double complex behind = real + imaginary * I;
    *s = (cosine - n * behind) / (cosine + n * behind);
    *p = (n * cosine - behind) / (n * cosine + behind);
}

TEST(the_waves_that_a_face_reflects_are_fresnels) {
    for (int i = 0; i < INDEX_COUNT; i++)
        for (int k = 1; k <= 200; k++) {
            double cosine = k / 200.0;
            double complex s, p;
            Waves found = waves_reflected((float)cosine, (float)indices[i]);
            amplitudes(cosine, indices[i], &s, &p);
            double complex both = s * conj(p);
            double s2 = creal(s * conj(s)), p2 = creal(p * conj(p));
            assert_true(fabs((double)found.s - s2) < 1e-5);
            assert_true(fabs((double)found.p - p2) < 1e-5);
            assert_true(fabs((double)found.along - creal(both)) < 1e-4);
            assert_true(fabs((double)found.turned - cimag(both)) < 1e-4);
        }
}

/* Born and Wolf, 1.5.4 (60): tan(d / 2) = cos i sqrt(sin^2 i - n^2) / sin^2 i. */
TEST(total_reflection_puts_the_waves_out_of_step) {
    const double n = 1 / 1.5;
    for (int degrees = 45; degrees < 90; degrees += 5) {
        double angle = degrees * PI / 180, sine2 = sin(angle) * sin(angle);
        double wanted = 2 * atan(cos(angle) * sqrt(sine2 - n * n) / sine2);
        Waves w = waves_reflected((float)cos(angle), (float)n);
        /* Where nothing is out of step the fields mirror: s and p have opposite signs. */
        double found = acos(-fmin(fmax((double)w.along, -1), 1));
        if (fabs(found - wanted) > 1e-3 && fabs(found - (PI - wanted)) > 1e-3)
            fail_msg("%d degrees: out of step by %.5f, required: %.5f", degrees, found, wanted);
        assert_true(fabs((double)(w.along * w.along + w.turned * w.turned) - 1) < 1e-5);
    }
}

/* What a bare pane of that face sends back or on; t: what its body lets through once. */
static BsdfPolarisation pane_matrix(Waves face, float t, bool passes) {
    PolarisedParts one = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    PolarisedPane pane = {face, spectrum_all(t), passes};
    polarised_add_pane(&one, &pane, spectrum_all(1));
    return polarised_of(&one, spectrum_all(1));
}

/* As grazing as floats go, at every index: shares, and numbers. */
TEST(waves_at_the_horizon_are_numbers) {
    const float all[] = {0, 0.5f, 0.999999f, 1, 1.000001f, 1.5f, 2.5f};
    for (int i = 0; i < COUNT_OF(all); i++)
        for (float cosine = 1; cosine > 1e-30f; cosine *= 0.7f) {
            Waves face = waves_reflected(cosine, all[i]);
            assert_true(face.s >= 0 && face.s <= 1 && face.p >= 0 && face.p <= 1 &&
                        fabsf(face.turned) <= 1 && fabsf(face.along) <= 1.00001f);
            for (int k = 0; k < 6; k++) {
                BsdfPolarisation m = pane_matrix(face, 0.5f * (float)(k / 2), k % 2);
                assert_true(fabsf(m.difference[2]) <= 1.00001f && m.kept[2] >= 0 &&
                            m.kept[2] <= 1.00001f && fabsf(m.along[2]) <= 1.00001f);
            }
        }
}

/* R = 2r / (1 + r) of each, at 1.52; fields of all orders added up, where the body absorbs. */
TEST(a_sheet_reflects_each_polarisation_by_itself) {
    static const double table[][3] = {{45, 0.1764, 0.0185},
                                      {56.66, 0.2709, 0},
                                      {62, 0.3366, 0.0086},
                                      {65, 0.3815, 0.0243},
                                      {70, 0.4708, 0.0798}};
    for (int i = 0; i < 5; i++) {
        double cosine = cos(table[i][0] * PI / 180);
        Waves face = waves_reflected((float)cosine, 1.52f);
        double s = table[i][1], p = table[i][2], lets = 2 - s - p;
        assert_near(pane_matrix(face, 1, false).difference[4], (s - p) / (s + p), 1e-3);
        assert_near(pane_matrix(face, 1, true).difference[4], (p - s) / lets, 1e-3);
        for (int passes = 0; passes < 2; passes++) {
            double t = 0.6, sum[3] = {0, 0, 0}; /* s, p, along */
            double a = -sqrt((double)face.s);
            double b = sqrt((double)face.p) * (cosine > 0.55 ? 1 : -1);
            for (int order = 0; order < 60; order++) { /* amplitudes of faces, from inside -a */
                double along = pow(t, passes ? 2 * order + 1 : 2 * order);
                int turns = passes ? 2 * order : order ? 2 * order - 1 : 1;
                double x = pow(-a, turns), y = pow(-b, turns);
                double lets_s = passes || order ? 1 - a * a : 1;
                double lets_p = passes || order ? 1 - b * b : 1;
                sum[0] += along * lets_s * lets_s * x * x;
                sum[1] += along * lets_p * lets_p * y * y;
                sum[2] += along * lets_s * lets_p * x * y;
            }
            BsdfPolarisation m = pane_matrix(face, 0.6f, passes);
            double mean = (sum[0] + sum[1]) / 2;
            assert_near(m.difference[4], (sum[0] - sum[1]) / 2 / mean, 1e-4);
            assert_near(fabs((double)m.along[4]), fabs(sum[2]) / mean, 1e-4);
        }
    }
}

/* ---- glasses ----------------------------------------------------------------------------- */

static PolarisedEye eye_with(float degrees, float blocks) {
    float angle = degrees * PI_F / 180;
    return (PolarisedEye){.right = {1, 0, 0},
                          .forward = {0, 0, -1},
                          .has_glasses = true,
                          .axis = {sinf(angle), cosf(angle)},
                          .lets = 1,
                          .blocks = blocks};
}

static float through_glasses(const PolarisedEye *eye, Vec3 direction, const PolarisedLight *from) {
    Polarised row;
    polarised_start(eye, direction, &row);
    return (polarised_take(&row) * polarised_seen(&row, 0, vec3_neg(direction), from))[0];
}

/* Straight ahead, 1 / 2 (1 + e) of unpolarised light and cos^2 + e sin^2 of polarised light. */
TEST(glasses_let_through_what_malus_says) {
    for (int axis = -90; axis <= 90; axis += 15)
        for (int light = 0; light <= 90; light += 15)
            for (float blocks = 0; blocks <= 0.1f; blocks += 0.05f) {
                PolarisedEye eye = eye_with((float)axis, blocks);
                float angle = (float)light * PI_F / 180, off = (float)(axis - light);
                PolarisedLight from = {{sinf(angle), cosf(angle), 0}, spectrum_all(1)};
                float c = cosf(off * PI_F / 180), wanted = c * c + blocks * (1 - c * c);
                Vec3 ahead = vec3(0, 0, -1);
                assert_true(fabsf(through_glasses(&eye, ahead, &from) - wanted) < 1e-5f);
                assert_true(fabsf(through_glasses(&eye, ahead, NULL) - (1 + blocks) / 2) < 1e-5f);
            }
}

/* Off their axis two polarisers cross where their absorption axes do as the ray meets them. */
TEST(glasses_met_at_an_angle_count_their_absorption_axis) {
    for (int axis = 0; axis <= 90; axis += 15)
        for (int i = 0; i < 12; i++) {
            float polar = 0.1f * (float)i, azimuth = 0.7f * (float)i;
            Vec3 direction =
                vec3(sinf(polar) * cosf(azimuth), sinf(polar) * sinf(azimuth), -cosf(polar));
            float angle = (float)axis * PI_F / 180;
            Vec3 absorbs = vec3(-cosf(angle), sinf(angle), 0);
            Vec3 met =
                vec3_normalize(vec3_along(absorbs, direction, -vec3_dot(absorbs, direction)));
            Vec3 e = vec3_normalize(vec3_cross(direction, vec3(0.3f, 1, 0.1f)));
            PolarisedEye eye = eye_with((float)axis, 0);
            PolarisedLight from = {e, spectrum_all(1)};
            float lost = vec3_dot(met, e);
            assert_true(fabsf(through_glasses(&eye, direction, &from) - (1 - lost * lost)) < 1e-5f);
        }
}

/* ---- chains of surfaces ------------------------------------------------------------------ */

enum { CHAIN = 4 };

static Surface glass(Vec3 normal, float ior, float alpha) {
    Surface surface = {.frame = frame_from_z(normal), .alpha = 1, .ng = normal};
    surface.bsdf.kind = BSDF_DIELECTRIC;
    surface.bsdf.dielectric = (Dielectric){.tint = spectrum_all(1), .ior = ior, .alpha = alpha};
    return surface;
}

static Surface pane(Vec3 normal) {
    Surface surface = {.frame = frame_from_z(normal), .alpha = 1, .ng = normal};
    surface.bsdf.kind = BSDF_THIN_WINDOW;
    surface.bsdf.thin_window = (ThinWindow){.tint = spectrum_all(0.9f), .ior = 1.52f};
    return surface;
}

/* A world may be turned: `world` are the columns of the rotation. */
typedef struct Chain {
    Frame world;
    Sampler sampler;
    Polarised row;
    Vec3 direction; /* in which the path goes, not turned */
} Chain;

static Vec3 turned(const Chain *chain, Vec3 v) {
    return frame_to_world(&chain->world, v);
}

/* One more surface, met from outside or inside; the path goes on by any way it has. */
static bool meet_another(Chain *chain) {
    float u[3];
    Vec3 n = random_direction(&chain->sampler), wo = vec3_neg(chain->direction);
    draw(&chain->sampler, u);
    if (u[0] < 0.5f && vec3_dot(n, wo) < 0) n = vec3_neg(n);
    Frame upright = frame_from_z(n);
    Surface surface = u[1] < 0.4f ? pane(n) : glass(n, 1 + u[2], u[1] < 0.7f ? 0 : 0.3f);
    BsdfSample way;
    draw(&chain->sampler, u);
    if (!bsdf_sample(&surface.bsdf, frame_to_local(&upright, wo), u, &way)) return false;
    surface.frame =
        (Frame){turned(chain, upright.x), turned(chain, upright.y), turned(chain, upright.z)};
    surface.local_wo = frame_to_local(&surface.frame, turned(chain, wo));
    polarised_turn(&chain->row, &surface, turned(chain, wo), &way);
    chain->direction = vec3_normalize(frame_to_world(&upright, way.wi));
    return true;
}

static Chain start_chain(Frame world, uint32_t index, bool with_stokes) {
    Chain chain = {.world = world, .sampler = sampler_start(5, 3, 1, index)};
    PolarisedEye eye = {.with_stokes = with_stokes,
                        .has_glasses = !with_stokes,
                        .axis = {0.6f, 0.8f},
                        .lets = 1,
                        .blocks = 0.02f};
    chain.direction = vec3(0.1f, -0.2f, -0.97f);
    chain.direction = vec3_normalize(chain.direction);
    eye.right = turned(&chain, vec3(1, 0, 0));
    eye.forward = turned(&chain, vec3(0, 0, -1));
    polarised_start(&eye, turned(&chain, chain.direction), &chain.row);
    return chain;
}

static PolarisedLight some_light(Chain *chain) {
    Vec3 e = vec3_cross(chain->direction, random_direction(&chain->sampler));
    float degree = sampler_1d(&chain->sampler);
    if (!(vec3_dot(e, e) > 1e-4f)) e = frame_from_z(chain->direction).x;
    return (PolarisedLight){turned(chain, vec3_normalize(e)), spectrum_all(degree)};
}

/* What of some light at the end of a chain counts. */
static float counted_by(Frame world, uint32_t index) {
    Chain chain = start_chain(world, index, false);
    for (int i = 0; i < CHAIN; i++)
        if (!meet_another(&chain)) break;
    PolarisedLight from = some_light(&chain);
    Vec3 way = turned(&chain, vec3_neg(chain.direction));
    return (polarised_take(&chain.row) * polarised_seen(&chain.row, 0, way, &from))[0];
}

/* Next to the critical angle a reflectance's slope has no bound: there rounding shows. */
TEST(turning_the_world_and_the_eye_together_changes_nothing) {
    Frame upright = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Vec3 z = vec3_normalize(vec3(0.3f, -0.5f, 0.8f));
    Vec3 x = vec3_normalize(vec3_cross(vec3(0.2f, 0.9f, 0.1f), z));
    Frame lying = {x, vec3_cross(z, x), z};
    double worst = 0, squares = 0;
    int off = 0;
    const uint32_t count = 20000;
    for (uint32_t i = 0; i < count; i++) {
        double a = (double)counted_by(upright, i), b = (double)counted_by(lying, i);
        worst = fmax(worst, fabs(a - b));
        squares += (a - b) * (a - b);
        off += fabs(a - b) > 1e-5;
    }
    if (!(sqrt(squares / count) < 1e-6 && off < (int)count / 1000 && worst < 1e-3))
        fail_msg("differs by %.3g, %d by more than 1e-5", worst, off);
}

/* S1^2 + S2^2 + S3^2 <= S0^2 of any light after any chain. */
TEST(no_chain_makes_light_more_than_wholly_polarised) {
    Frame upright = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double worst = 0, mean = 0;
    const uint32_t count = all_laws() ? 400000 : 100000; /* each with 25 lights */
    for (uint32_t i = 0; i < count; i++) {
        Chain chain = start_chain(upright, i, true);
        for (int k = 0; k < CHAIN; k++)
            if (!meet_another(&chain)) break;
        PolarisedLight from = some_light(&chain);
        for (int light = 0; light < 25; light++) {
            float s[4];
            Vec3 way = vec3_neg(chain.direction);
            from.degree = spectrum_all((float)light / 24);
            for (int row = 0; row < 4; row++)
                s[row] = polarised_seen(&chain.row, row, way, &from)[0];
            for (int k = 1; k < 4; k++) s[k] -= s[0];
            double size = sqrt((double)(s[1] * s[1] + s[2] * s[2] + s[3] * s[3]));
            worst = fmax(worst, size - (double)s[0]);
            mean += s[0] > 0 ? size / (double)s[0] : 0;
        }
    }
    if (!(worst < 1e-5)) fail_msg("more by %.3g", worst);
    assert_true(mean / (25.0 * count) > 0.3); /* chains do polarise */
}

TEST_PROGRAM(NULL, NULL)
