/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_section.h"

#include <math.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_spectra.h"
#include "panel/query/panel_open_reflection.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_reflection_layout.h"

#define INTEGRAL_ROOM 0.5 /* of the bound: what the integrals may move all values by */
#define ALBEDO_MOST 0.995 /* haze and mirror together */
#define ALBEDO_LEVEL 6
#define LAMBERTIAN_QUANTILE 100 /* one row in so many is dimmer than the lambertian part */
#define LAMBERTIAN_DEG 60.0     /* rows further from the normal do not count */
#define NODES 7
#define SIDES_MOST 8 /* azimuths of the light beyond the last incidence */
#define FAR 1.13     /* radians: where measurements usually end before; else nodes are even */

/* The first stands for the last measured incidence. */
static const double beyond_deg[NODES] = {0, 70, 75, 80, 84, 87, 89.5};

/* A section under construction, its parts writable. */
typedef struct SectionDraft {
    PanelReflectionStored *stored;
    ReflectionLayout layout;
    ReflectionSection *out;
} SectionDraft;

static float *floats(const float *at) {
    return (float *)(uintptr_t)at;
}
static int16_t *shorts(const int16_t *at) {
    return (int16_t *)(uintptr_t)at;
}
static uint16_t *shares(const uint16_t *at) {
    return (uint16_t *)(uintptr_t)at;
}

static int16_t stepped(double value, double scale) {
    return (int16_t)fmax(-32767, fmin(32767, scale > 0 ? rint(value / scale) : 0));
}

static uint16_t share(double value) {
    return (uint16_t)rint(65535 * fmax(0, fmin(1, value)));
}

/* ---- integrals as measured --------------------------------------------------------------- */

typedef struct IntegralPass {
    const ReflectionModel *model;
    Tree tree;
    double *change; /* tables x wavelengths, of the logarithm */
} IntegralPass;

/* The change of a table's means by which its rows add up to the same as the haze. */
static void match_integrals(void *context, int t, int worker) {
    IntegralPass *pass = context;
    const ReflectionModel *model = pass->model;
    const AngleTable *table = &model->parts->haze[t];
    double found[MEASUREMENT_WAVELENGTHS_MAX] = {0}, wanted[MEASUREMENT_WAVELENGTHS_MAX] = {0};
    double room = INTEGRAL_ROOM * model->bound;
    ReflectionView view = reflection_view(model, t);
    (void)worker;
    for (int i = 0; i < table->rows; i++) {
        float component[PANEL_REFLECTION_COMPONENTS_MAX], logs[MEASUREMENT_WAVELENGTHS_MAX];
        Vec3 d = table_row_direction(table, i);
        double weight = table_row_weight(table, i);
        tree_interpolate(&pass->tree, specular_frame_stored(&view.frame, d), component);
        reflection_spectra_logs(model, t, component, logs);
        for (int w = 0; w < model->wavelengths; w++) {
            found[w] += weight * exp_d((double)logs[w]) * view.fresnel;
            wanted[w] +=
                weight * (double)table->value[(size_t)i * (size_t)model->wavelengths + (size_t)w];
        }
    }
    for (int w = 0; w < model->wavelengths; w++) {
        double change = wanted[w] > 0 && found[w] > 0 ? log_d(wanted[w] / found[w]) : 0;
        pass->change[t * model->wavelengths + w] = fmax(-room, fmin(room, change));
    }
}

static bool settle_integrals(ReflectionModel *model, Error *err) {
    IntegralPass pass = {.model = model};
    int count = model->tables * model->wavelengths;
    pass.change = ARENA_NEW(model->arena, double, count);
    if (!tree_open(model->tree, tree_size(model->tree), model->geodesic, model->arena, &pass.tree,
                   err))
        return error_prefix(err, "reflection");
    parallel_for(model->options->threads, model->tables, match_integrals, &pass);
    for (int i = 0; i < count; i++) model->mean[i] += (float)pass.change[i];
    return true;
}

/* ---- the lambertian part ----------------------------------------------------------------- */

/* The level away from the peak: nearly the least value inside 60 degrees. */
static double lambertian_of(const AngleTable *table, int wavelength, double *list) {
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        if ((double)table->theta[i] < radians_from_degrees(LAMBERTIAN_DEG))
            list[count++] =
                (double)table->value[(size_t)i * (size_t)table->channels + (size_t)wavelength];
    if (!count) return 1e-12;
    sort_doubles(list, count);
    return fmax(1e-12, list[count / LAMBERTIAN_QUANTILE]);
}

static void fill_lambertian(const ReflectionModel *model, const SectionDraft *section) {
    for (int t = 0; t < model->tables; t++) {
        Arena scratch = *model->arena;
        double *list = ARENA_NEW(&scratch, double, model->parts->haze[t].rows), sum = 0;
        for (int w = 0; w < model->wavelengths; w++) {
            double value = lambertian_of(&model->parts->haze[t], w, list);
            shorts(section->layout.lambertian)[t * model->wavelengths + w] =
                stepped(log_d(value), (double)section->stored->mean_scale);
            sum += model->parts->luminous[w] * value;
        }
        if (t < model->set->incidence_count) section->out->lambertian_y[t] = PI * sum;
    }
}

/* ---- the numbers of the fit -------------------------------------------------------------- */

static PanelReflectionStored head_of(const ReflectionModel *model) {
    double edge = 0.5 * PI, most = 30;
    for (int t = 0; t < model->tables; t++)
        edge = fmin(edge, (double)model->parts->haze[t].theta_max);
    return (PanelReflectionStored){
        .incidences = (uint16_t)model->set->incidence_count,
        .azimuths = (uint16_t)(model->tables / model->set->incidence_count),
        .components = (uint16_t)model->components,
        .coefficients = (uint16_t)model->coefficients,
        .wavelengths = (uint16_t)model->wavelengths,
        .nodes = NODES,
        .one = 1,
        .has_mirror = model->parts->has_mirror,
        .frame_exponent = model->k,
        .refractive_index = (float)REFLECTION_REFRACTIVE_INDEX,
        .cone_cos = (float)fmax(0, cos_d(edge)),
        .mean_scale = (float)fmax((double)model->mean_scale, most / 32767)};
}

static void fill_axes(const ReflectionModel *model, const SectionDraft *section) {
    const ReflectionLayout *to = &section->layout;
    int incidences = model->set->incidence_count, n = 0;
    double last = model->set->incidence[incidences - 1];
    for (int i = 0; i < incidences; i++) floats(to->incidence)[i] = (float)model->set->incidence[i];
    for (int i = 0; i < section->stored->azimuths; i++)
        floats(to->azimuth)[i] =
            (float)(section->stored->azimuths > 1 ? model->set->azimuth[i] : 0);
    for (int i = 0; i < model->wavelengths; i++)
        floats(to->wavelength_nm)[i] = model->set->wavelength_nm[i];
    floats(to->node_theta)[n++] = (float)last;
    for (int i = 1; i < NODES; i++) {
        double theta = radians_from_degrees(beyond_deg[i]), room = 0.5 * PI - last;
        double spaced = last + room * i / (NODES - 0.9);
        bool is_usual = last < FAR && theta > last;
        floats(to->node_theta)[n++] = (float)(is_usual ? theta : spaced);
    }
    for (int k = 0; k < model->coefficients; k++)
        floats(to->basis_scale)[k] = model->basis_scale[k];
    for (int c = 0; c < model->components; c++)
        floats(to->loading_scale)[c] = model->loading_scale[c];
}

static void fill_numbers(const ReflectionModel *model, const SectionDraft *section) {
    const ReflectionLayout *to = &section->layout;
    int m = model->coefficients, n = model->components, wavelengths = model->wavelengths;
    for (int i = 0; i < model->tables * wavelengths; i++)
        shorts(to->mean)[i] = stepped((double)model->mean[i], (double)section->stored->mean_scale);
    for (int i = 0; i < m * wavelengths; i++)
        shorts(to->basis)[i] =
            stepped((double)model->basis[i], (double)model->basis_scale[i / wavelengths]);
    for (int i = 0; i < model->tables * m * n; i++)
        shorts(to->loading)[i] =
            stepped((double)model->loading[i], (double)model->loading_scale[i % n]);
}

/* Mirror reflectance, of the azimuths the mean. */
static void fill_mirror(const ReflectionModel *model, const SectionDraft *section) {
    int incidences = model->set->incidence_count, azimuths = section->stored->azimuths;
    for (int i = 0; i < incidences && model->parts->has_mirror; i++)
        for (int w = 0; w < model->wavelengths; w++) {
            double sum = 0;
            for (int a = 0; a < azimuths; a++)
                sum += model->parts->reflectance[(a * incidences + i) * model->wavelengths + w];
            shares(section->layout.mirror)[i * model->wavelengths + w] = share(sum / azimuths);
        }
}

/* ---- energy ------------------------------------------------------------------------------ */

/* A query's view of the section as it stands. */
static bool view_section(const ReflectionModel *model, const SectionDraft *section, Arena *arena,
                         Panel *panel, Error *err) {
    PanelReflectionBytes sections = {
        {(const unsigned char *)section->stored, section->out->size, "panel", err},
        {model->tree, tree_size(model->tree), "panel", err},
        {NULL, 0, "panel", err}};
    if (model->has_reach)
        sections.reach.data = (const unsigned char *)model->reach,
        sections.reach.size = sizeof *model->reach * (size_t)model->tables;
    return panel_expand_reflection(&sections, model->geodesic, arena, panel);
}

typedef struct AlbedoPass {
    const ReflectionModel *model;
    const Panel *panel;
    const SectionDraft *section;
    double *albedo; /* items x wavelengths */
    Vec3 *direction;
    double *area;
    int leaves;
} AlbedoPass;

/* Azimuths of the light at which an incidence beyond the last is looked at. */
static int sides_of(const ReflectionModel *model) {
    int azimuths = model->set->azimuth_count;
    return azimuths < 2 ? 1 : azimuths < SIDES_MOST ? azimuths : SIDES_MOST;
}

/* Where the light is of an item: tables first, then the nodes beyond the last incidence, side
 * after side. */
static Vec3 light_of(const AlbedoPass *pass, int item) {
    const ReflectionModel *model = pass->model;
    if (item < model->tables) return reflection_model_light(model->set, item);
    int node = (item - model->tables) % NODES, side = (item - model->tables) / NODES;
    double theta = (double)pass->section->layout.node_theta[node] + 1e-5;
    return table_direction(theta, PI + 2 * PI * side / sides_of(model));
}

static void haze_albedo(void *context, int item, int worker) {
    AlbedoPass *pass = context;
    const ReflectionModel *model = pass->model;
    Vec3 wi = light_of(pass, item);
    double s = sqrt((double)(wi.x * wi.x + wi.y * wi.y)), theta = atan2_d(s, (double)wi.z);
    float ex = s > 1e-7 ? (float)((double)-wi.x / s) : 1;
    float ey = s > 1e-7 ? (float)((double)-wi.y / s) : 0;
    SpecularFrame frame = specular_frame((float)theta, 2);
    double *albedo = pass->albedo + item * model->wavelengths;
    (void)worker;
    for (int first = 0; first < model->wavelengths; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = reflection_model_wavelengths(model->set, first);
        for (int i = 0; i < pass->leaves; i++) {
            Vec3 d = specular_frame_outer(&frame, pass->direction[i]);
            double weight = pass->area[i] * fmax(0, (double)d.z) *
                            (double)specular_frame_jacobian(&frame, pass->direction[i]);
            Spectrum f = panel_brdf(
                pass->panel, vec3(ex * d.x - ey * d.y, ey * d.x + ex * d.y, d.z), wi, &wavelengths);
            for (int k = 0; k < SPECTRUM_LANES && first + k < model->wavelengths; k++)
                albedo[first + k] += weight * (double)f[k];
        }
    }
}

/* A node's is that of its brightest side. */
static void take_brightest_side(const ReflectionModel *model, double *albedo) {
    int row = NODES * model->wavelengths;
    double *first = albedo + model->tables * model->wavelengths;
    for (int i = row; i < sides_of(model) * row; i++)
        first[i % row] = fmax(first[i % row], first[i]);
}

/* Directional-hemispherical reflectance of the haze: tables, then nodes. */
static double *all_albedos(const ReflectionModel *model, const Panel *panel,
                           const SectionDraft *section, Arena *arena) {
    AlbedoPass pass = {.model = model, .panel = panel, .section = section};
    int items = model->tables + NODES * sides_of(model), octants = model->lattice.octants;
    pass.albedo = ARENA_NEW(arena, double, items * model->wavelengths);
    pass.leaves = octants << 2 * ALBEDO_LEVEL;
    pass.direction = ARENA_NEW(arena, Vec3, pass.leaves);
    pass.area = ARENA_NEW(arena, double, pass.leaves);
    for (int i = 0; i < pass.leaves; i++) {
        pass.direction[i] = geodesic_center(ALBEDO_LEVEL, (uint32_t)i);
        pass.area[i] = 4.0 / octants * geodesic_area(ALBEDO_LEVEL, (uint32_t)i);
    }
    parallel_for(model->options->threads, items, haze_albedo, &pass);
    take_brightest_side(model, pass.albedo);
    return pass.albedo;
}

static double mirror_albedo(const Panel *panel, const ReflectionModel *model, Vec3 light, int w) {
    Wavelengths wavelengths = reflection_model_wavelengths(model->set, w);
    return (double)panel_mirror(panel, light.z, &wavelengths)[0];
}

/* Writes albedos down, and holds haze and mirror at 1 in every table and node. */
static void hold_energy(ReflectionModel *model, const Panel *panel, const SectionDraft *section,
                        const double *albedo) {
    const ReflectionLayout *to = &section->layout;
    AlbedoPass where = {.model = model, .section = section};
    int n = model->wavelengths;
    for (int i = 0; i < (model->tables + NODES) * n; i++) {
        int item = i / n, w = i % n, node = i - model->tables * n;
        double mirror = mirror_albedo(panel, model, light_of(&where, item), w);
        double haze = albedo[i], room = fmax(0.01, ALBEDO_MOST - mirror);
        double factor = haze > room ? room / haze : 1;
        bool is_table = item < model->tables;
        if (is_table)
            section->out->largest_albedo = fmax(section->out->largest_albedo, haze + mirror);
        if (is_table) shares(to->albedo)[i] = share(haze * factor);
        else shares(to->node_albedo)[node] = share(haze * factor);
        if (!is_table) shares(to->held)[node] = factor < 1 ? share(factor - 1e-5) : 65535;
        else if (factor < 1) model->mean[i] += (float)log_d(factor);
    }
}

static bool settle_energy(ReflectionModel *model, const SectionDraft *section, FitNotes *notes,
                          Error *err) {
    Arena scratch = *model->arena;
    Panel panel = {0};
    if (!view_section(model, section, &scratch, &panel, err)) return false;
    double *albedo = all_albedos(model, &panel, section, &scratch);
    hold_energy(model, &panel, section, albedo);
    if (section->out->largest_albedo > ALBEDO_MOST)
        fit_note(notes,
                 "directional-hemispherical reflectance reached %.4f in a table; held "
                 "at %.3f",
                 section->out->largest_albedo, ALBEDO_MOST);
    return true;
}

bool reflection_section_write(ReflectionModel *model, FitNotes *notes, ReflectionSection *out,
                              Error *err) {
    PanelReflectionStored head;
    SectionDraft section = {.out = out};
    if (!settle_integrals(model, err)) return false;
    head = head_of(model);
    out->size = reflection_layout(&head, &section.layout);
    out->bytes = section.stored = arena_alloc(model->arena, 1, 8, out->size);
    *section.stored = head;
    reflection_layout(section.stored, &section.layout);
    fill_axes(model, &section);
    fill_numbers(model, &section);
    fill_lambertian(model, &section);
    fill_mirror(model, &section);
    for (int i = 0; i < NODES * model->wavelengths; i++) shares(section.layout.held)[i] = 65535;
    if (!settle_energy(model, &section, notes, err)) return false;
    fill_numbers(model, &section); /* again: energy may have lowered the means */
    return true;
}
