/* SPDX-License-Identifier: Apache-2.0 */
/* Glass and clear plastic among the models that obey all laws. */
#include "fixture.h"

#include "brushed_fixture.h"
#include "bsdf_laws.h"
#include "layer_fixture.h"

#include "shaders/layers/coating_tables.h"
#include "shaders/facets/microfacet.h"
#include "spectrum/dispersion.h"

static Arena arena;
static Wavelengths wavelengths;

static void add_dielectric(const char *name, float ior, float alpha) {
    float width = alpha < SMOOTH_ALPHA ? 1 : 0.5f * alpha * fabsf(ior - 1) + 1e-4f;
    models[model_count++] =
        (Model){.name = name,
                .bsdf.kind = BSDF_DIELECTRIC,
                .bsdf.dielectric = {.tint = spectrum_all(1), .ior = ior, .alpha = alpha},
                .lossless = true,
                .both_sides = true,
                .width = width};
    if (alpha >= SMOOTH_ALPHA)
        models[model_count - 1].bsdf.dielectric.energy =
            solid_energy_build(ior, alpha, alpha, false, &arena);
}

/* Of single facets alone, which lose light. */
static void add_bare_facets(const char *name, float ior, float alpha) {
    add_dielectric(name, ior, alpha);
    models[model_count - 1].bsdf.dielectric.energy = NULL;
    models[model_count - 1].lossless = false;
}

static GlazedWindow *add_glazing(const char *name, float through, float haze, float width) {
    Glazing *pane = ARENA_NEW(&arena, Glazing, 1);
    *pane = (Glazing){.layers = {{0.0021f, 1.52f}, {0.00076f, 1.485f}, {0.0021f, 1.6f}},
                      .layer_count = 3,
                      .absorbing_ior = 1.52f,
                      .wedge_ior = 1.485f,
                      .haze_share = haze,
                      .haze_width = width};
    Model *model = &models[model_count++];
    *model = (Model){.name = name,
                     .bsdf.kind = BSDF_GLAZED_WINDOW,
                     .both_sides = true,
                     .lossless = through >= 1 && haze <= 0,
                     .width = haze > 0 ? width : 1};
    model->bsdf.glazed_window =
        (GlazedWindow){.pane = pane, .absorbance = spectrum_all(-logf(through))};
    return &model->bsdf.glazed_window;
}

static void add_glass(void) {
    models[model_count++] = (Model){.name = "windscreen",
                                    .bsdf.kind = BSDF_THIN_WINDOW,
                                    .bsdf.thin_window = {.tint = ramp(0.6f, 0.9f), .ior = 1.52f},
                                    .both_sides = true,
                                    .width = 1};
    models[model_count++] = (Model){.name = "clear window",
                                    .bsdf.kind = BSDF_THIN_WINDOW,
                                    .bsdf.thin_window = {.tint = spectrum_all(1), .ior = 1.52f},
                                    .both_sides = true,
                                    .lossless = true,
                                    .width = 1};
    add_glazing("laminated", 0.8f, 0, 0)->front_is_up = true;
    add_glazing("clear laminated", 1, 0, 0);
    add_glazing("dirty", 0.9f, 0.3f, 0.4f);
    add_glazing("dusty with a wedge", 0.9f, 0.02f, 0.05f)->slope[1] = 3e-4f;
    GlazedWindow *curved = add_glazing("curved laminated", 1, 0, 0);
    curved->bend[0][0] = 0.4f;
    curved->bend[0][1] = curved->bend[1][0] = -0.2f;
    curved->slope[0] = -2e-4f;
    add_dielectric("smooth glass", 1.5f, 0);
    add_dielectric("nearly smooth glass", 1.5f, 0.02f);
    add_dielectric("frosted glass", 1.5f, 0.3f);
    add_dielectric("very rough water", 1.33f, 0.8f);
    add_dielectric("bubble", 0.75f, 0.1f);
    add_dielectric("rough diamond", 2.42f, 1);
    add_bare_facets("single facets", 1.5f, 0.5f);
    add_dielectric("no boundary", 1, 0.05f);
    models[model_count++] = (Model){.name = "black", .bsdf.kind = BSDF_BLACK, .width = 1};
}

static void add_coated_solid(const char *name, float alpha, bool lossless,
                             const CoatingTables *tables) {
    add_dielectric(name, 1.52f, alpha);
    Model *model = &models[model_count - 1];
    model->lossless = lossless;
    if (alpha > 0)
        model->bsdf.dielectric.energy = solid_energy_build(1.52f, alpha, alpha, true, &arena);
    model->bsdf.dielectric.coating = tables;
    model->bsdf.dielectric.wavelengths = &wavelengths;
}

static ThinWindow *add_coated_window(const char *name, bool lossless, const PaneCoating *sheet) {
    models[model_count++] = (Model){.name = name,
                                    .bsdf.kind = BSDF_THIN_WINDOW,
                                    .bsdf.thin_window = {.tint = spectrum_all(1),
                                                         .ior = 1.52f,
                                                         .coating = sheet,
                                                         .wavelengths = &wavelengths},
                                    .both_sides = true,
                                    .lossless = lossless,
                                    .width = 1};
    return &models[model_count - 1].bsdf.thin_window;
}

static void add_coated_pane(const char *name, const LayerStack *outside, const LayerStack *inside,
                            float haze) {
    GlazedWindow *window = add_glazing(name, 1, haze, 0.4f);
    Glazing pane = *window->pane;
    pane.coating[0] = outside;
    pane.coating[1] = inside;
    models[model_count - 1].lossless = !inside && haze <= 0;
    window->coating = coating_of_pane(&pane, &arena);
    window->wavelengths = &wavelengths;
}

static void add_coated_glass(void) {
    const LayerStack *four = stack_four(&arena), *silver = stack_silver(&arena);
    const LayerStack *mirror = stack_of(1, (ThinMedium[]){{0, 100, 2000}}, &arena);
    const PaneCoating *sheet = coating_of_sheet(four, 1.52, &arena);
    add_coated_solid("coated glass", 0, true, coating_of_solid(four, 1.52, &arena));
    add_coated_solid("coated frosted glass", 0.3f, true, coating_of_solid(four, 1.52, &arena));
    add_coated_solid("coated rough glass", 0.9f, true, coating_of_solid(four, 1.52, &arena));
    add_coated_solid("silvered glass", 0.1f, false, coating_of_solid(silver, 1.52, &arena));
    add_coated_window("coated window", true, sheet);
    add_coated_window("silvered window", false, coating_of_sheet(silver, 1.52, &arena));
    add_coated_window("coated smoked window", false, sheet)->tint = ramp(0, 0.8f);
    add_coated_pane("laminated, coated outside", four, NULL, 0);
    add_coated_pane("dirty, silver inside", NULL, silver, 0.3f);
    add_coated_pane("laminated, between mirrors", mirror, mirror, 0);
}

/* strength: 1 is glTF's strongest dispersion, of heavy flint; 2 twice that. */
static void add_dispersive(const char *name, float alpha, double strength) {
    Curve *index = ARENA_NEW(&arena, Curve, 1);
    for (int i = 0; i < CURVE_COUNT; i++)
        index->value[i] = (float)dispersion_index(1.6, strength, CURVE_FIRST_NM + i);
    add_dielectric(name, 1.6f, alpha);
    Dielectric *d = &models[model_count - 1].bsdf.dielectric;
    d->index = index;
    d->wavelengths = &wavelengths;
    if (alpha < SMOOTH_ALPHA) return;
    d->energy = solid_energy_build(index->value[CURVE_COUNT - 1], alpha, alpha, true, &arena);
    d->energy_most = solid_energy_build(index->value[0], alpha, alpha, false, &arena);
}

static Dielectric *add_filmed(const char *name, float ior, float alpha) {
    add_dielectric(name, ior, alpha);
    Dielectric *d = &models[model_count - 1].bsdf.dielectric;
    d->film = (ThinFilm){.share = 1, .ior = 1.8f, .thickness_nm = 350};
    if (d->energy) d->energy = solid_energy_build(ior, alpha, alpha, true, &arena);
    d->wavelengths = &wavelengths;
    return d;
}

static void add_films(void) {
    add_filmed("smooth filmed glass", 1.5f, 0);
    add_filmed("smooth filmed water", 1.33f, 0)->film.ior = 2.4f;
    add_filmed("nearly smooth filmed glass", 1.5f, 0.02f)->film.thickness_nm = 120;
    add_filmed("frosted filmed glass", 1.5f, 0.3f);
    add_filmed("very rough half filmed glass", 1.7f, 0.8f)->film.share = 0.5f;
    add_filmed("thickly filmed glass", 1.5f, 0.1f)->film.thickness_nm = 2500;
    add_filmed("film round nothing", 1, 0.05f)->film.ior = 1.33f;
    Dielectric *d = add_filmed("tinted filmed glass", 1.5f, 0.2f);
    d->tint = ramp(0.2f, 0.9f);
    models[model_count - 1].lossless = false;
    add_dispersive("smooth filmed flint", 0, 2);
    models[model_count - 1].bsdf.dielectric.film = d->film;
    add_dispersive("frosted filmed flint", 0.3f, 1);
    models[model_count - 1].bsdf.dielectric.film = d->film;
}

/* The last model, as bare or not as it is. */
static Dielectric *brush(const char *name, float along) {
    Model *model = &models[model_count - 1];
    Dielectric *d = &model->bsdf.dielectric;
    bool has_facets = d->film.share > 0 || d->coating;
    d->energy = brushed_energy(d->energy->ior, along, d->alpha, has_facets, &arena);
    if (d->index)
        d->energy_most = brushed_energy(d->energy_most->ior, along, d->alpha, false, &arena);
    d->alpha_along = along;
    model->name = name;
    model->width = fminf(model->width, 0.05f);
    return d;
}

static void add_brushed_solids(void) {
    add_dielectric("", 1.5f, 0.1f);
    brush("brushed glass", 0.5f);
    add_dielectric("", 1.5f, 0.6f);
    brush("glass brushed across x", 0.1f);
    add_dielectric("", 1.8f, 0.3f);
    brush("glass brushed to the utmost", 1);
    add_dielectric("", 2.42f, 1);
    brush("rough diamond brushed across x", 0.4f);
    add_dielectric("", 0.75f, 0.2f);
    brush("brushed bubble", 0.6f);
    add_dielectric("", 1.5f, 0.1f);
    brush("single brushed facets", 0.5f)->energy = NULL;
    models[model_count - 1].lossless = false;
    add_filmed("", 1.5f, 0.2f);
    brush("brushed filmed glass", 0.6f);
    add_coated_solid("", 0.2f, true, coating_of_solid(stack_four(&arena), 1.52, &arena));
    brush("brushed coated glass", 0.7f);
    add_dispersive("", 0.1f, 1);
    brush("brushed flint", 0.4f);
}

static int make_models(void **state) {
    make_arena(state);
    arena = test_arena(state);
    wavelengths_sample(0.3f, &wavelengths);
    add_glass();
    add_coated_glass();
    add_dispersive("smooth flint", 0, 2);
    add_dispersive("satin flint", 0.1f, 2);
    add_dispersive("frosted flint", 0.3f, 2);
    models[model_count - 1].bsdf.dielectric.tint = ramp(0.2f, 0.9f);
    models[model_count - 1].lossless = false;
    add_films();
    add_brushed_solids();
    return 0;
}

TEST_PROGRAM(make_models, drop_arena)
