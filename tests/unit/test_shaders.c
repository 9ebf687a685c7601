/* Laws that every surface model obeys; a model added to make_models inherits them all. */
#include "chart_fixture.h"
#include "layer_fixture.h"
#include "shader_fixture.h"

#include <string.h>

#include "base/arena.h"
#include "base/units.h"
#include "panel/query/panel_open.h"
#include "shaders/bsdf.h"
#include "shaders/coating_tables.h"
#include "shaders/microfacet.h"

#define MAX_MODELS 80

typedef struct Model {
    const char *name;
    Bsdf        bsdf;
    bool        lossless;  /* sends back all it gets, within the tables' error */
    bool        both_sides; /* the eye may be below */
    float       width;     /* of its narrowest lobe, radians: where to look closely */
} Model;

static Model models[MAX_MODELS];
static int   model_count;
static Arena arena;
static const EnergyTable *glass, *diamond, *perfect, *nothing;
static const CoatTable   *lacquer;

static MetallicRoughness *add_model(const char *name, float metallic, float alpha,
                                    bool lossless)
{
    Model *model = &models[model_count++];
    *model = (Model){.name = name, .bsdf.kind = BSDF_METALLIC_ROUGHNESS, .lossless = lossless,
                     .width = alpha < SMOOTH_ALPHA ? 1 : alpha};
    MetallicRoughness *m = &model->bsdf.metallic_roughness;
    *m = metallic_roughness_default(glass);
    m->metallic = metallic;
    m->alpha = alpha;
    m->clearcoat_energy = glass;
    m->coat = lacquer;
    return m;
}

static void add_plastics(void)
{
    add_model("white plastic, alpha 1", 0, 1, true);
    add_model("white plastic, alpha 0.3", 0, 0.3f, true);
    add_model("white plastic, alpha 0.05", 0, 0.05f, true);
    add_model("white plastic, alpha 0.01", 0, 0.01f, true);
    add_model("white smooth plastic", 0, 0, true);
    add_model("dark plastic", 0, 0.1f, false)->base_color = ramp(0.01f, 0.3f);
    add_model("white, no mirror", 0, 0.2f, true)->specular = 0;
    add_model("white, index 1", 0, 0.2f, true)->energy = nothing;
    add_model("white, index 2.4", 0, 0.2f, true)->energy = diamond;
    add_model("white, index 0", 0, 0.4f, false)->energy = perfect;
    MetallicRoughness *m = add_model("coloured mirror on plastic", 0, 0.15f, false);
    m->specular_color = ramp(0.1f, 40);
    m->specular = 0.7f;
    m->base_color = ramp(0.9f, 0.1f);
}

static void add_metals(void)
{
    add_model("white metal, alpha 1", 1, 1, true);
    add_model("white metal, alpha 0.5", 1, 0.5f, true);
    add_model("white metal, alpha 0.1", 1, 0.1f, true);
    add_model("white metal, alpha 0.02", 1, 0.02f, true);
    add_model("white metal, alpha 0.002", 1, 0.002f, true);
    add_model("smooth gold", 1, 0, false)->base_color = ramp(0.3f, 0.97f);
    add_model("rough gold", 1, 0.4f, false)->base_color = ramp(0.3f, 0.97f);
    add_model("black metal", 1, 0.2f, false)->base_color = spectrum_all(0);
    add_model("half metal", 0.5f, 0.2f, true);
}

static void add_panes(void)
{
    add_model("smooth clear sheet", 0, 0, true)->transmission = 1;
    add_model("smooth half clear sheet", 0, 0, true)->transmission = 0.5f;
    add_model("frosted sheet", 0, 0.3f, true)->transmission = 1;
    MetallicRoughness *m = add_model("coloured frosted sheet", 0.2f, 0.1f, false);
    m->transmission = 0.6f;
    m->base_color = ramp(0.2f, 0.9f);
    m->clearcoat = 0.5f;
    m->clearcoat_alpha = 0.05f;
}

static void add_lacquers(void)
{
    MetallicRoughness *m = add_model("piano lacquer", 0, 0.5f, false);
    m->base_color = ramp(0.01f, 0.03f);
    m->clearcoat = 1;
    m = add_model("white under smooth lacquer", 0, 0.3f, true);
    m->clearcoat = 1;
    m = add_model("white smooth chrome under lacquer", 1, 0, true);
    m->clearcoat = 1;
    m = add_model("half metal under rough lacquer", 0.5f, 0.5f, true);
    m->clearcoat = 1;
    m->clearcoat_alpha = 0.5f;
    models[model_count - 1].width = 0.5f;
    m = add_model("gold under lacquer", 1, 0.3f, false);
    m->base_color = ramp(0.3f, 0.97f);
    m->clearcoat = 1;
    m = add_model("white under rough lacquer", 0, 0.3f, true);
    m->clearcoat = 0.8f;
    m->clearcoat_alpha = 0.1f;
    models[model_count - 1].width = 0.1f;
    m = add_model("chrome under tilted lacquer", 1, 0.2f, false);
    m->clearcoat = 1;
    m->clearcoat_alpha = 0.2f;
    m->clearcoat_normal = vec3_normalize(vec3(0.3f, -0.2f, 1));
    m = add_model("plastic under tilted smooth lacquer", 0, 0.2f, false);
    m->clearcoat = 1;
    m->clearcoat_normal = vec3_normalize(vec3(-0.4f, 0.1f, 1));
}

static void add_dielectric(const char *name, float ior, float alpha)
{
    float width = alpha < SMOOTH_ALPHA ? 1 : 0.5f * alpha * fabsf(ior - 1) + 1e-4f;
    models[model_count++] = (Model){.name = name, .bsdf.kind = BSDF_DIELECTRIC,
                                    .bsdf.dielectric = {.tint = spectrum_all(1), .ior = ior,
                                                        .alpha = alpha},
                                    .lossless = alpha < 0.06f, .both_sides = true,
                                    .width = width};
}

static GlazedWindow *add_glazing(const char *name, float through, float haze, float width)
{
    Glazing *pane = ARENA_NEW(&arena, Glazing, 1);
    *pane = (Glazing){.layers = {{0.0021f, 1.52f}, {0.00076f, 1.485f}, {0.0021f, 1.6f}},
                      .layer_count = 3, .absorbing_ior = 1.52f, .wedge_ior = 1.485f,
                      .haze_share = haze, .haze_width = width};
    Model *model = &models[model_count++];
    *model = (Model){.name = name, .bsdf.kind = BSDF_GLAZED_WINDOW, .both_sides = true,
                     .lossless = through >= 1 && haze <= 0, .width = haze > 0 ? width : 1};
    model->bsdf.glazed_window =
        (GlazedWindow){.pane = pane, .absorbance = spectrum_all(-logf(through))};
    return &model->bsdf.glazed_window;
}

static void add_glass(void)
{
    models[model_count++] = (Model){.name = "windscreen", .bsdf.kind = BSDF_THIN_WINDOW,
        .bsdf.thin_window = {.tint = ramp(0.6f, 0.9f), .ior = 1.52f}, .both_sides = true,
        .width = 1};
    models[model_count++] = (Model){.name = "clear window", .bsdf.kind = BSDF_THIN_WINDOW,
        .bsdf.thin_window = {.tint = spectrum_all(1), .ior = 1.52f}, .both_sides = true,
        .lossless = true, .width = 1};
    add_glazing("laminated", 0.8f, 0, 0)->front_is_up = true;
    add_glazing("clear laminated", 1, 0, 0);
    add_glazing("dirty", 0.9f, 0.3f, 0.4f);
    add_glazing("dusty with a wedge", 0.9f, 0.02f, 0.05f)->slope[1] = 3e-4f;
    add_dielectric("smooth glass", 1.5f, 0);
    add_dielectric("nearly smooth glass", 1.5f, 0.02f);
    add_dielectric("frosted glass", 1.5f, 0.3f);
    add_dielectric("very rough water", 1.33f, 0.8f);
    add_dielectric("bubble", 0.75f, 0.1f);
    add_dielectric("no boundary", 1, 0.05f);
    models[model_count++] = (Model){.name = "black", .bsdf.kind = BSDF_BLACK, .width = 1};
}

/* ---- coated ---------------------------------------------------------------------------- */

static Wavelengths wavelengths;
static SurfaceCoating mirror_metal, silver_metal, plastic, frosted;

static MetallicRoughness *add_coated(const char *name, float metallic, float alpha,
                                     bool lossless, const SurfaceCoating *coating)
{
    MetallicRoughness *m = add_model(name, metallic, alpha, lossless);
    m->coating = coating;
    m->wavelengths = &wavelengths;
    return m;
}

static void add_coated_solid(const char *name, float alpha, bool lossless,
                             const CoatingTables *tables)
{
    add_dielectric(name, 1.52f, alpha);
    Model *model = &models[model_count - 1];
    model->lossless = lossless;
    model->bsdf.dielectric.coating = tables;
    model->bsdf.dielectric.wavelengths = &wavelengths;
}

static void add_coated_window(const char *name, bool lossless, const CoatingTables *sheet)
{
    models[model_count++] = (Model){.name = name, .bsdf.kind = BSDF_THIN_WINDOW,
        .bsdf.thin_window = {spectrum_all(1), 1.52f, sheet->front, sheet->through,
                             &wavelengths},
        .both_sides = true, .lossless = lossless, .width = 1};
}

static void add_coated_pane(const char *name, const LayerStack *outside,
                            const LayerStack *inside, float haze)
{
    GlazedWindow *window = add_glazing(name, 1, haze, 0.4f);
    Glazing       pane = *window->pane;
    pane.coating[0] = outside;
    pane.coating[1] = inside;
    models[model_count - 1].lossless = !inside && haze <= 0;
    window->coating = coating_of_pane(&pane, &arena);
    window->wavelengths = &wavelengths;
}

static void add_coated_surfaces(void)
{
    const LayerStack *four = stack_four(&arena), *silver = stack_silver(&arena);
    const OpticalConstants *ideal = constants_of(0, 4, &arena);
    const OpticalConstants *real = constants_of(0.06, 3.6, &arena);
    wavelengths_sample(0.3f, &wavelengths);
    mirror_metal.metal = coating_of_metal(four, ideal, &arena);
    silver_metal.metal = coating_of_metal(NULL, real, &arena);
    plastic.metal = mirror_metal.metal;
    plastic.face = coating_of_face(four, 1.5, &arena);
    frosted.sheet = coating_of_sheet(four, 1.52, &arena);
    add_coated("ideal metal, coated, alpha 0.5", 1, 0.5f, true, &mirror_metal);
    add_coated("ideal metal, coated, alpha 0.05", 1, 0.05f, true, &mirror_metal);
    add_coated("smooth silver", 1, 0, false, &silver_metal);
    add_coated("silver under lacquer", 1, 0.2f, false, &silver_metal)->clearcoat = 1;
    add_coated("coated plastic, alpha 0.3", 0, 0.3f, true, &plastic);
    add_coated("coated plastic, alpha 0.02", 0, 0.02f, true, &plastic);
    add_coated("coated half metal", 0.5f, 0.2f, true, &plastic);
    add_coated("coated frosted sheet", 0, 0.3f, true, &frosted)->transmission = 1;
    add_coated("coated smooth sheet, mixed", 0.3f, 0, false, &frosted)->transmission = 1;
    add_coated_solid("coated glass", 0, true, coating_of_solid(four, 1.52, &arena));
    add_coated_solid("coated frosted glass", 0.3f, false, coating_of_solid(four, 1.52, &arena));
    add_coated_solid("silvered glass", 0.1f, false, coating_of_solid(silver, 1.52, &arena));
    add_coated_window("coated window", true, coating_of_sheet(four, 1.52, &arena));
    add_coated_window("silvered window", false, coating_of_sheet(silver, 1.52, &arena));
    add_coated_pane("laminated, coated outside", four, NULL, 0);
    add_coated_pane("dirty, silver inside", NULL, silver, 0.3f);
}

static int make_models(void **state)
{
    (void)state;
    arena = arena_reserve((size_t)1 << 30);
    glass = energy_table_build(1.5f, &arena);
    diamond = energy_table_build(2.4f, &arena);
    perfect = energy_table_build(0, &arena);
    nothing = energy_table_build(1, &arena);
    lacquer = coat_table_build(glass, glass, &arena);
    add_plastics();
    add_metals();
    add_panes();
    add_lacquers();
    add_glass();
    add_coated_surfaces();
    return 0;
}

static int drop_models(void **state)
{
    (void)state;
    arena_release(&arena);
    return 0;
}

/* Calls `law` for every model and eye, on the far side too where there is one. */
static void for_all(void (*law)(const Model *, Vec3))
{
    for (int m = 0; m < model_count; m++)
        for (int i = 0; i < EYE_COUNT; i++) {
            Vec3 wo = eye(i);
            law(&models[m], wo);
            if (models[m].both_sides) law(&models[m], vec3(wo.x, wo.y, -wo.z));
        }
}

/* ---- sampling matches its density ---------------------------------------------------- */

#define SAMPLES 20000

static Chart chart_for(const Model *model, Vec3 wo, bool same_side)
{
    Vec3 centre = vec3(-wo.x, -wo.y, same_side ? wo.z : -wo.z);
    if (model->bsdf.kind == BSDF_DIELECTRIC && !same_side) {
        float eta = wo.z > 0 ? model->bsdf.dielectric.ior : 1 / model->bsdf.dielectric.ior;
        float x = -wo.x / eta, y = -wo.y / eta, z = safe_sqrtf(1 - x * x - y * y);
        centre = vec3_normalize(vec3(x, y, wo.z > 0 ? -z : z));
    }
    return (Chart){frame_from_z(centre), model->width * fabsf(wo.z)}; /* lobes grow slender */
}

/* Integral of the pdf over one cell of the chart, on one side of the surface. */
static double integrate_cell(const Model *model, Vec3 wo, const Chart *chart, int cell,
                             bool same_side)
{
    double sum = 0;
    int    ring = cell / SECTORS, sector = cell % SECTORS;
    int    turns = model->width < 0.03f ? 72 : 36;
    int fine = fabsf(wo.z) < 0.1f || model->width < 0.03f
                   ? 40
                   : 16; /* the horizon cuts narrow lobes */
    double before = angle_of(chart, (double)ring / RINGS);
    for (int i = 0; i < fine; i++) {
        double after = angle_of(chart, (ring + (i + 1.0) / fine) / RINGS);
        double angle = 0.5 * (before + after);
        double area = (cos(before) - cos(after)) * 2 * PI / SECTORS / turns;
        before = after;
        for (int k = 0; k < turns; k++) {
            double turn = ((sector + (k + 0.5) / turns) / SECTORS - 0.5) * 2 * PI;
            Vec3 local = vec3((float)(sin(angle) * cos(turn)), (float)(sin(angle) * sin(turn)),
                              (float)cos(angle));
            Vec3   wi = frame_to_world(&chart->frame, local);
            if ((wi.z * wo.z > 0) != same_side) continue;
            float pdf;
            bsdf_eval(&model->bsdf, wo, wi, &pdf);
            sum += (double)pdf * area;
        }
    }
    return sum;
}

static void samples_follow_pdf(const Model *model, Vec3 wo)
{
    if (fabsf(wo.z) < 0.1f && model->width < 0.03f) return; /* a needle no chart resolves */
    static double expected[CELLS], found[CELLS + 1];
    memset(found, 0, sizeof found);
    Chart  charts[2] = {chart_for(model, wo, true), chart_for(model, wo, false)};
    double total = 0;
    for (int i = 0; i < CELLS; i++) {
        bool same = i < CELLS / 2;
        double part = integrate_cell(model, wo, &charts[!same], i % (CELLS / 2), same);
        total += part;
        expected[i] = part * SAMPLES;
    }
    if (!(total <= 1.01))
        fail_msg("%s, cos %g: pdf integrates to %g", model->name, (double)wo.z, total);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        Sampler    sampler = sampler_start(11, (int)(i * 7919u), (int)(wo.z * 1000), i);
        BsdfSample sample;
        float      u[3];
        draw(&sampler, u);
        bool whole = !bsdf_sample(&model->bsdf, wo, u, &sample) || sample.is_delta;
        bool same = !whole && sample.wi.z * wo.z > 0;
        int  cell = whole ? CELLS : (same ? 0 : CELLS / 2) + cell_of(&charts[!same], sample.wi);
        found[cell]++;
    }
    int    degrees; /* what is left over are the delta parts and lost light */
    double chi2 = chi_square(expected, found, CELLS, &degrees);
    if (!(fabs(found[CELLS] / SAMPLES - (1 - total)) < 0.01))
        fail_msg("%s, cos %g: %g of the samples are lost, the pdf leaves %g", model->name,
                 (double)wo.z, found[CELLS] / SAMPLES, 1 - total);
    if (degrees > 0 && !(deviate(chi2, degrees) < 4.5))
        fail_msg("%s, cos %g: chi-square %g with %d degrees (pdf integrates to %g)",
                 model->name, (double)wo.z, chi2, degrees, total);
}

TEST(samples_are_distributed_as_their_pdf_says)
{
    (void)state;
    for_all(samples_follow_pdf);
}

/* ---- a sample agrees with eval ------------------------------------------------------- */

static void sample_agrees(const Model *model, Vec3 wo)
{
    for (uint32_t i = 0; i < 400; i++) {
        Sampler    sampler = sampler_start(3, 1, 2, i);
        BsdfSample s;
        float      u[3], pdf;
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

TEST(weight_is_eval_times_cosine_over_pdf)
{
    (void)state;
    for_all(sample_agrees);
}

TEST(what_does_not_scatter_or_reach_evaluates_to_nothing)
{
    (void)state;
    for (int m = 0; m < model_count; m++)
        for (int i = 0; i < EYE_COUNT; i++)
            for (int k = 0; k < EYE_COUNT; k++) {
                const Bsdf *bsdf = &models[m].bsdf;
                float pdf = -1;
                Vec3  wi = eye(k);
                for (int side = 0; side < 2; side++, wi.z = -wi.z) {
                    if (bsdf_scatters(bsdf) && bsdf_reaches(bsdf, eye(i), wi)) continue;
                    assert_true(spectrum_is_zero(bsdf_eval(bsdf, eye(i), wi, &pdf)));
                    assert_true(pdf == 0);
                }
            }
}

/* ---- energy -------------------------------------------------------------------------- */

/* Light sent to wo under a uniform surround of 1. Refracted radiance is counted as flux. */
static Spectrum furnace(const Model *model, Vec3 wo, uint32_t count)
{
    Spectrum sum = spectrum_all(0);
    for (uint32_t i = 0; i < count; i++) {
        Sampler    sampler = sampler_start(5, 8, 13, i);
        BsdfSample s;
        float      u[3];
        draw(&sampler, u);
        if (!bsdf_sample(&model->bsdf, wo, u, &s)) continue;
        float ior = model->bsdf.kind == BSDF_DIELECTRIC ? model->bsdf.dielectric.ior : 1;
        float squeeze = s.wi.z * wo.z > 0 ? 1 : wo.z > 0 ? ior * ior : 1 / (ior * ior);
        sum += s.weight * spectrum_all(squeeze);
    }
    return sum / spectrum_all((float)count);
}

static void energy_holds(const Model *model, Vec3 wo)
{
    Spectrum sent = furnace(model, wo, 16384);
    for (int k = 0; k < SPECTRUM_LANES; k += 5) {
        if (!(sent[k] <= 1.004f))
            fail_msg("%s, cos %g: sends back %g", model->name, (double)wo.z, (double)sent[k]);
        if (model->lossless && !(sent[k] >= (model->both_sides ? 0.9f : 0.98f)))
            fail_msg("%s, cos %g: loses light, %g", model->name, (double)wo.z, (double)sent[k]);
    }
}

TEST(no_surface_sends_back_more_than_it_gets)
{
    (void)state;
    for_all(energy_holds);
}

static void albedo_is_near(const Model *model, Vec3 wo)
{
    bool tilted =
        strstr(model->name, "tilted") != NULL; /* loses light, by how much is not told */
    if (model->bsdf.kind == BSDF_DIELECTRIC || tilted) return;
    Spectrum sent = furnace(model, wo, 4096), told = bsdf_albedo(&model->bsdf, wo);
    for (int k = 0; k < SPECTRUM_LANES; k += 5)
        if (!(fabsf(sent[k] - told[k]) < 0.12f))
            fail_msg("%s, cos %g: albedo %g, furnace %g", model->name, (double)wo.z,
                     (double)told[k], (double)sent[k]);
}

TEST(albedo_is_a_fair_estimate)
{
    (void)state;
    for_all(albedo_is_near);
}

/* ---- reciprocity --------------------------------------------------------------------- */

static Vec3 turned_over(Vec3 w)
{
    return vec3(w.x, w.y, -w.z);
}

/* f(wo, wi) against f(wi, wo). Frames of one-sided models are always turned to the eye; a
 * solid's transmitted radiance scales with the square of the index on the light's side. */
static void check_reciprocity(const Model *model, Vec3 wo, Vec3 wi)
{
    bool  is_solid = model->bsdf.kind == BSDF_DIELECTRIC;
    bool  crosses = wo.z * wi.z < 0, turn = crosses && !is_solid;
    float pdf, ior = crosses && is_solid ? model->bsdf.dielectric.ior : 1;
    float scale = wo.z > 0 ? ior * ior : 1 / (ior * ior);
    double tolerance = is_solid || model->width < 0.05f ? 1e-3 : 1e-4; /* rounding */
    if (turn && model->bsdf.kind == BSDF_METALLIC_ROUGHNESS &&
        model->bsdf.metallic_roughness.clearcoat > 0)
        return; /* its coat is on one side */
    Spectrum a = bsdf_eval(&model->bsdf, wo, wi, &pdf);
    Spectrum b =
        bsdf_eval(&model->bsdf, turn ? turned_over(wi) : wi, turn ? turned_over(wo) : wo, &pdf);
    for (int k = 0; k < SPECTRUM_LANES; k += 3) {
        double forth = (double)(a[k] * scale), back = (double)b[k];
        if (!(fabs(forth - back) <= tolerance * (forth + back) + 1e-6))
            fail_msg("%s: f(%g,%g,%g / %g,%g,%g) is %g and %g back", model->name, (double)wo.x,
                     (double)wo.y, (double)wo.z, (double)wi.x, (double)wi.y, (double)wi.z,
                     forth, back);
    }
}

TEST(light_goes_back_the_way_it_came)
{
    (void)state;
    for (int m = 0; m < model_count; m++)
        for (uint32_t i = 0; i < 2000; i++) {
            Sampler sampler = sampler_start(17, m, 0, i);
            Vec3    wo = random_direction(&sampler), wi = random_direction(&sampler);
            if (!models[m].both_sides) wo.z = fabsf(wo.z);
            if (fabsf(wo.z) < 1e-3f || fabsf(wi.z) < 1e-3f) continue;
            check_reciprocity(&models[m], wo, wi);
        }
}

/* ---- smooth parts --------------------------------------------------------------------- */

TEST(what_passes_a_pane_is_what_shadow_rays_see)
{
    (void)state;
    int panes = 0;
    for (int m = 0; m < model_count; m++)
        for (int i = 0; i < EYE_COUNT; i++) {
            Vec3     wo = eye(i);
            Spectrum pass = bsdf_pass(&models[m].bsdf, wo);
            Spectrum sampled = spectrum_all(0);
            for (int k = 0; k < 4000; k++) {
                float      pick = ((float)k + 0.5f) / 4000; /* whichever number chooses */
                float      u[3] = {pick, 0.5f, pick};
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
    assert_true(panes >= 4 * EYE_COUNT);
}

/* Roughness just above and just below the threshold must look alike. */
TEST(a_narrow_lobe_sends_what_a_mirror_sends)
{
    (void)state;
    for (int metallic = 0; metallic < 2; metallic++)
        for (int i = 0; i < 4; i++) {
            Model mirror = {.bsdf.kind = BSDF_METALLIC_ROUGHNESS}, narrow;
            mirror.bsdf.metallic_roughness = metallic_roughness_default(glass);
            mirror.bsdf.metallic_roughness.metallic = (float)metallic;
            mirror.bsdf.metallic_roughness.alpha = 0;
            mirror.bsdf.metallic_roughness.base_color = ramp(0, 0.5f);
            narrow = mirror;
            narrow.bsdf.metallic_roughness.alpha = 0.0011f;
            Spectrum a = furnace(&mirror, eye(i), 8192), b = furnace(&narrow, eye(i), 8192);
            for (int k = 0; k < SPECTRUM_LANES; k++) assert_near(a[k], b[k], 4e-3);
        }
}

/* ---- measured displays --------------------------------------------------------------- */

static void mirror_is_where_it_belongs(const Model *model, Vec3 wo)
{
    int mirrors = 0;
    for (uint32_t i = 0; i < 500; i++) {
        Sampler    sampler = sampler_start(3, 4, 5, i);
        BsdfSample s;
        float      u[3];
        draw(&sampler, u);
        if (!bsdf_sample(&model->bsdf, wo, u, &s) || !s.is_delta) continue;
        assert_near(vec3_length(vec3_sub(s.wi, vec3(-wo.x, -wo.y, wo.z))), 0, 1e-6);
        assert_false(s.passes);
        mirrors++;
    }
    assert_true(mirrors > 0 || !strstr(model->name, "oled"));
}

TEST(shipped_displays_obey_the_same_laws)
{
    (void)state;
    static const char *const names[] = {"ips_cluster", "oled_centre"};
    int         found = 0;
    for (int i = 0; i < 2; i++) {
        char   path[1024];
        Panel *panel;
        Error  err;
        snprintf(path, sizeof path, "%s/assets/panels/%s.panel", PROJECT_DIR, names[i]);
        FILE *file = fopen(path, "rb");
        if (!file) continue;
        fclose(file);
        if (!panel_open(path, &arena, &panel, &err)) fail_msg("%s", err.text);
        Model model = {.name = names[i], .width = 0.05f, .bsdf.kind = BSDF_DISPLAY,
                       .bsdf.display.panel = panel};
        panel_lanes(panel, &wavelengths, &model.bsdf.display.lanes);
        for (int k = 0; k < EYE_COUNT; k++) {
            sample_agrees(&model, eye(k));
            mirror_is_where_it_belongs(&model, eye(k));
            energy_holds(&model, eye(k));
            albedo_is_near(&model, eye(k));
        }
        model.bsdf.display.cover =
            coating_of_cover(stack_silver(&arena), 1.5, &arena)->front;
        model.bsdf.display.wavelengths = &wavelengths;
        for (int k = 0; k < EYE_COUNT; k++) {
            sample_agrees(&model, eye(k));
            energy_holds(&model, eye(k));
            albedo_is_near(&model, eye(k));
        }
        assert_true(bsdf_scatters(&model.bsdf));
        assert_true(spectrum_is_zero(bsdf_pass(&model.bsdf, eye(1))));
        panel_close(panel);
        found++;
    }
    if (!found) skip();
}

int main(void)
{
    return run_cases(make_models, drop_models);
}
