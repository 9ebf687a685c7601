/* Rough boundaries of solids: light that facets pass to one another is not lost. */
#include "shader_fixture.h"

#include "base/units.h"
#include "shaders/bsdf.h"

static Arena arena;

static int reserve(void **state)
{
    (void)state;
    arena = arena_reserve((size_t)1 << 28);
    return 0;
}

static int release(void **state)
{
    (void)state;
    arena_release(&arena);
    return 0;
}

static Bsdf boundary(float ior, float alpha, const SolidEnergy *energy)
{
    return (Bsdf){.kind = BSDF_DIELECTRIC,
                  .dielectric = {.tint = spectrum_all(1), .ior = ior, .alpha = alpha,
                                 .energy = energy}};
}

/* What single facets show where light of radiance 1 outside and ior^2 inside, which is one
 * light, comes from everywhere. The points run evenly through the cube by Roberts' lattice. */
static double single_facets(const Bsdf *bsdf, Vec3 wo)
{
    enum { COUNT = 1 << 18 };
    double ior2 = (double)(bsdf->dielectric.ior * bsdf->dielectric.ior), sum = 0;
    for (int i = 0; i < COUNT; i++) {
        const float u[3] = {(float)fmod(0.5 + i * 0.6710436067037893, 1),
                            (float)fmod(0.5 + i * 0.8191725133961645, 1),
                            (float)fmod(0.5 + i * 0.5497004779019703, 1)};
        BsdfSample s;
        if (bsdf_sample(bsdf, wo, u, &s))
            sum += (double)s.weight[7] * (s.wi.z < 0 ? ior2 : 1);
    }
    return sum / COUNT / (wo.z < 0 ? ior2 : 1);
}

/* The same of what facets pass to one another, which has no azimuth: with cos = t^2. */
static double passed_about(const Bsdf *whole, const Bsdf *single, Vec3 wo)
{
    enum { COUNT = 4096 };
    double ior2 = (double)(whole->dielectric.ior * whole->dielectric.ior), sum = 0;
    for (int i = 0; i < COUNT; i++) {
        double t = (i / 2 + 0.5) / (COUNT / 2), weight = 4 * PI * t * t * t / (COUNT / 2);
        float  cosine = (float)(t * t), sine = safe_sqrtf(1 - cosine * cosine), pdf;
        Vec3   wi = vec3(0, sine, i % 2 ? -cosine : cosine);
        double f = (double)bsdf_eval(whole, wo, wi, &pdf)[7] -
                   (double)bsdf_eval(single, wo, wi, &pdf)[7];
        sum += weight * f * (wi.z < 0 ? ior2 : 1);
    }
    return sum / (wo.z < 0 ? ior2 : 1);
}

static void check_both_sides(float ior, float alpha)
{
    static const double degrees[] = {0, 60, 85};
    Bsdf single = boundary(ior, alpha, NULL);
    Bsdf whole = boundary(ior, alpha, solid_energy_build(ior, alpha, alpha, false, &arena));
    for (int i = 0; i < 6; i++) {
        double t = radians_from_degrees(degrees[i / 2]);
        Vec3   wo = vec3((float)sin(t), 0, (float)cos(t));
        if (i % 2) wo.z = -wo.z;
        double found = single_facets(&single, wo) + passed_about(&whole, &single, wo);
        if (fabs(found - 1) > 0.001)
            fail_msg("ior %g alpha %g, %g degrees %s: %.5f", (double)ior, (double)alpha,
                     degrees[i / 2], i % 2 ? "inside" : "outside", found);
    }
}

/* At roughnesses on the table's rows and between. */
TEST(a_furnace_does_not_show_rough_solids)
{
    static const float iors[] = {1.05f, 1.5f, 2.42f, 0.75f};
    static const float alphas[] = {0.02f, 0.11f, 0.4f, 0.71f, 0.9f, 1};
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int a = 0; a < 6; a++) check_both_sides(iors[i], alphas[a]);
}

int main(void)
{
    return run_cases(reserve, release);
}
