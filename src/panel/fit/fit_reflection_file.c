/* The reflection's sections of a panel file: integrals and energy are settled on what the file
 * will say itself. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree_query.h"
#include "panel/fit/fit_reflect.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_reflection_layout.h"

#define INTEGRAL_ROOM 0.5   /* of the bound: what the integrals may move all values by */
#define LOBE_SQUARE 42.25   /* of the distance over sigma: where queries end the lobe */
#define ALBEDO_MOST 0.995   /* haze, lobe and mirror together */
#define ALBEDO_LEVEL 6
#define FLOOR_QUANTILE 100  /* one row in so many is dimmer than the floor */
#define FLOOR_DEG 60.0      /* rows further from the normal say nothing of the floor */
#define NODES 7
#define FAR 1.13 /* radians: where measurements usually end before; else nodes are even */

/* The first stands for the last measured incidence. */
static const double beyond_deg[NODES] = {0, 70, 75, 80, 84, 87, 89.5};

/* A section under construction, its parts writable. */
typedef struct Section {
    PanelReflectionStored *stored;
    ReflectionLayout       layout;
    size_t                 size;
} Section;

static float   *floats(const float *at)     { return (float *)(uintptr_t)at; }
static int16_t *shorts(const int16_t *at)   { return (int16_t *)(uintptr_t)at; }
static uint16_t *shares(const uint16_t *at) { return (uint16_t *)(uintptr_t)at; }

static int16_t stepped(double value, double scale)
{
    return (int16_t)fmax(-32767, fmin(32767, scale > 0 ? rint(value / scale) : 0));
}

static uint16_t share(double value)
{
    return (uint16_t)rint(65535 * fmax(0, fmin(1, value)));
}

/* ---- integrals as measured --------------------------------------------------------------- */

typedef struct IntegralPass {
    const ReflectionFit *fit;
    Tree    tree;
    double *change; /* tables x wavelengths, of the logarithm */
    double *gain;   /* the same of the lobe, a factor */
} IntegralPass;

/* The lobe of reflectance 1 at a row, sr^-1. */
static double lobe_shape(const ReflectionFit *fit, int table, Vec3 d)
{
    double theta = reflect_incidence(fit, table), sigma = fit->out->lobe_sigma[table];
    double x = (double)d.x - sin_d(theta), y = (double)d.y, z = (double)d.z - cos_d(theta);
    double chord = x * x + y * y + z * z, square = chord * (1 + chord / 12) / (sigma * sigma);
    if (square > LOBE_SQUARE) return 0;
    return exp_d(-0.5 * square) / (2 * PI * sigma * sigma * cos_d(theta));
}

/* By what the lobe must be multiplied so that the sums of haze and lobe over the rows are those
 * of the table. */
static void match_lobe(IntegralPass *pass, int t)
{
    const ReflectionFit *fit = pass->fit;
    const AngleTable    *kept = &fit->out->kept[t], *haze = &fit->out->haze[t];
    double shape = 0, wanted[MEASUREMENT_WAVELENGTHS_MAX] = {0};
    for (int i = 0; i < kept->rows; i++) {
        double weight = fit_row_weight(kept, i);
        size_t at = (size_t)i * (size_t)fit->wavelengths;
        shape += weight * lobe_shape(fit, t, fit_row_direction(kept, i));
        for (int w = 0; w < fit->wavelengths; w++)
            wanted[w] += weight * (double)(kept->value[at + (size_t)w] -
                                           haze->value[at + (size_t)w]);
    }
    for (int w = 0; w < fit->wavelengths; w++) {
        int    i = t * fit->wavelengths + w;
        double lobe = shape * fit->out->lobe[i], room = INTEGRAL_ROOM * fit->bound;
        double gain = lobe > 0 ? wanted[w] / lobe : 1;
        pass->gain[i] = fmax(1 - room, fmin(1 + room, gain));
    }
}

/* What the means of a table must change by, so that its rows add up to what the haze does. */
static void match_integrals(void *context, int t, int worker)
{
    IntegralPass        *pass = context;
    const ReflectionFit *fit = pass->fit;
    const AngleTable    *table = &fit->out->haze[t];
    double fresnel = fit_fresnel(cos_d(reflect_incidence(fit, t)));
    double found[MEASUREMENT_WAVELENGTHS_MAX] = {0}, wanted[MEASUREMENT_WAVELENGTHS_MAX] = {0};
    double room = INTEGRAL_ROOM * fit->bound;
    SpecularFrame frame = specular_frame((float)reflect_incidence(fit, t), fit->k);
    (void)worker;
    for (int i = 0; i < table->rows; i++) {
        float  component[PANEL_REFLECTION_COMPONENTS_MAX], logs[MEASUREMENT_WAVELENGTHS_MAX];
        Vec3   d = fit_row_direction(table, i);
        double weight = fit_row_weight(table, i);
        tree_interpolate(&pass->tree, specular_frame_stored(&frame, d), component);
        reflect_logs(fit, t, component, logs);
        for (int w = 0; w < fit->wavelengths; w++) {
            found[w] += weight * exp_d((double)logs[w]) * fresnel;
            wanted[w] += weight * (double)table->value[(size_t)i * (size_t)fit->wavelengths +
                                                       (size_t)w];
        }
    }
    if (fit->out->has_lobe) match_lobe(pass, t);
    for (int w = 0; w < fit->wavelengths; w++) {
        double change = wanted[w] > 0 && found[w] > 0 ? log_d(wanted[w] / found[w]) : 0;
        pass->change[t * fit->wavelengths + w] = fmax(-room, fmin(room, change));
    }
}

static bool settle_integrals(ReflectionFit *fit, Error *err)
{
    IntegralPass pass = {.fit = fit};
    int count = fit->tables * fit->wavelengths;
    pass.change = ARENA_NEW(fit->arena, double, count);
    pass.gain = ARENA_NEW(fit->arena, double, count);
    if (!tree_open(fit->out->tree, tree_size(fit->out->tree), fit->geodesic,
                   &pass.tree, err))
        return error_prefix(err, "reflection");
    parallel_for(fit->options->threads, fit->tables, match_integrals, &pass);
    for (int i = 0; i < count; i++) {
        fit->mean[i] += (float)pass.change[i];
        if (fit->out->has_lobe) fit->out->lobe[i] *= pass.gain[i];
    }
    return true;
}

/* ---- the floor --------------------------------------------------------------------------- */

/* What is left far from the peak: nearly the least value inside 60 degrees. */
static double table_floor(const AngleTable *table, int wavelength, double *list)
{
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        if ((double)table->theta[i] < radians_from_degrees(FLOOR_DEG))
            list[count++] = (double)table->value[(size_t)i * (size_t)table->channels +
                                                 (size_t)wavelength];
    if (!count) return 1e-12;
    qsort(list, (size_t)count, sizeof *list, fit_by_value);
    return fmax(1e-12, list[count / FLOOR_QUANTILE]);
}

static void fill_floors(const ReflectionFit *fit, const Section *section)
{
    for (int t = 0; t < fit->tables; t++) {
        Arena   scratch = *fit->arena;
        double *list = ARENA_NEW(&scratch, double, fit->out->haze[t].rows), sum = 0;
        for (int w = 0; w < fit->wavelengths; w++) {
            double floor = table_floor(&fit->out->haze[t], w, list);
            shorts(section->layout.floor)[t * fit->wavelengths + w] =
                stepped(log_d(floor), (double)section->stored->mean_scale);
            sum += fit->out->luminous[w] * floor;
        }
        if (t < fit->set->incidence_count) fit->out->floor_y[t] = PI * sum;
    }
}

/* ---- the numbers of the fit -------------------------------------------------------------- */

static double lobe_logarithm(const ReflectionFit *fit, int table, int wavelength)
{
    double r = fit->out->lobe[table * fit->wavelengths + wavelength];
    return log_d(fmax(r, 1e-9) / fit_fresnel(cos_d(reflect_incidence(fit, table))));
}

static double largest_lobe(const ReflectionFit *fit)
{
    double most = 1;
    for (int t = 0; t < fit->tables; t++)
        for (int w = 0; w < fit->wavelengths; w++)
            most = fmax(most, fabs(lobe_logarithm(fit, t, w)));
    return most;
}

static PanelReflectionStored head_of(const ReflectionFit *fit)
{
    double edge = 0.5 * PI, most = 30;
    for (int t = 0; t < fit->tables; t++)
        edge = fmin(edge, (double)fit->out->haze[t].theta_max);
    return (PanelReflectionStored){
        .incidences = (uint16_t)fit->set->incidence_count,
        .azimuths = (uint16_t)(fit->tables / fit->set->incidence_count),
        .components = (uint16_t)fit->components,
        .coefficients = (uint16_t)fit->coefficients,
        .wavelengths = (uint16_t)fit->wavelengths,
        .nodes = NODES,
        .is_cubic = !fit->options->is_linear_in_incidence,
        .has_mirror = fit->out->has_mirror,
        .has_lobe = fit->out->has_lobe,
        .frame_exponent = fit->k,
        .refractive_index = (float)FIT_REFRACTIVE_INDEX,
        .cone_cos = (float)fmax(0, cos_d(edge)),
        .mean_scale = (float)fmax((double)fit->mean_scale, most / 32767),
        .lobe_scale = fit->out->has_lobe ? (float)(largest_lobe(fit) / 32767) : 0};
}

static void fill_axes(const ReflectionFit *fit, const Section *section)
{
    const ReflectionLayout *to = &section->layout;
    int incidences = fit->set->incidence_count, n = 0;
    double last = fit->set->incidence[incidences - 1];
    for (int i = 0; i < incidences; i++)
        floats(to->incidence)[i] = (float)fit->set->incidence[i];
    for (int i = 0; i < section->stored->azimuths; i++)
        floats(to->azimuth)[i] = (float)(section->stored->azimuths > 1 ? fit->set->azimuth[i]
                                                                       : 0);
    for (int i = 0; i < fit->wavelengths; i++)
        floats(to->wavelength_nm)[i] = fit->set->wavelength_nm[i];
    floats(to->node_theta)[n++] = (float)last;
    for (int i = 1; i < NODES; i++) {
        double theta = radians_from_degrees(beyond_deg[i]), room = 0.5 * PI - last;
        double spaced = last + room * i / (NODES - 0.9);
        bool   is_usual = last < FAR && theta > last;
        floats(to->node_theta)[n++] = (float)(is_usual ? theta : spaced);
    }
    for (int k = 0; k < fit->coefficients; k++)
        floats(to->basis_scale)[k] = fit->basis_scale[k];
    for (int c = 0; c < fit->components; c++)
        floats(to->loading_scale)[c] = fit->loading_scale[c];
    for (int t = 0; t < fit->tables && fit->out->has_lobe; t++)
        floats(to->lobe_sigma)[t] = (float)fit->out->lobe_sigma[t];
}

static void fill_numbers(const ReflectionFit *fit, const Section *section)
{
    const ReflectionLayout *to = &section->layout;
    int m = fit->coefficients, n = fit->components, wavelengths = fit->wavelengths;
    for (int i = 0; i < fit->tables * wavelengths; i++)
        shorts(to->mean)[i] = stepped((double)fit->mean[i],
                                      (double)section->stored->mean_scale);
    for (int i = 0; i < m * wavelengths; i++)
        shorts(to->basis)[i] = stepped((double)fit->basis[i],
                                       (double)fit->basis_scale[i / wavelengths]);
    for (int i = 0; i < fit->tables * m * n; i++)
        shorts(to->loading)[i] = stepped((double)fit->loading[i],
                                         (double)fit->loading_scale[i % n]);
    for (int i = 0; i < fit->tables * wavelengths && fit->out->has_lobe; i++)
        shorts(to->lobe)[i] = stepped(lobe_logarithm(fit, i / wavelengths, i % wavelengths),
                                      (double)section->stored->lobe_scale);
}

/* Mirror reflectance, of the azimuths the mean. */
static void fill_mirror(const ReflectionFit *fit, const Section *section)
{
    int incidences = fit->set->incidence_count, azimuths = section->stored->azimuths;
    for (int i = 0; i < incidences && fit->out->has_mirror; i++)
        for (int w = 0; w < fit->wavelengths; w++) {
            double sum = 0;
            for (int a = 0; a < azimuths; a++)
                sum += fit->out->reflectance[(a * incidences + i) * fit->wavelengths + w];
            shares(section->layout.mirror)[i * fit->wavelengths + w] = share(sum / azimuths);
        }
}

/* ---- energy ------------------------------------------------------------------------------ */

/* A query's view of the section as it stands. */
static bool view_section(const ReflectionFit *fit, const Section *section, Arena *arena,
                         Panel *panel, Error *err)
{
    PanelBytes at = {(const unsigned char *)section->stored, section->size, "panel", err};
    PanelBytes tree = {fit->out->tree, tree_size(fit->out->tree), "panel", err};
    return panel_expand_reflection(&at, &tree, fit->geodesic, arena, panel);
}

typedef struct AlbedoPass {
    const ReflectionFit *fit;
    const Panel         *panel;
    const Section       *section;
    double              *albedo; /* items x wavelengths */
    Vec3                *direction;
    double              *area;
    int                  leaves;
} AlbedoPass;

/* 16 of the measured wavelengths from `first` on; the last one repeats. */
static Wavelengths wavelengths_from(const Measurement *set, int first)
{
    Wavelengths wavelengths = {0};
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int w = first + i < set->wavelength_count ? first + i : set->wavelength_count - 1;
        wavelengths.nm[i] = set->wavelength_nm[w];
    }
    return wavelengths;
}

/* Where the light is of an item: tables first, then the nodes beyond the last incidence. */
static Vec3 light_of(const AlbedoPass *pass, int item)
{
    const ReflectionFit *fit = pass->fit;
    bool   is_table = item < fit->tables;
    double theta = is_table ? reflect_incidence(fit, item)
        : (double)pass->section->layout.node_theta[item - fit->tables] + 1e-5;
    double phi = is_table && fit->set->azimuth_count > 1
                     ? fit->set->azimuth[item / fit->set->incidence_count] : PI;
    return vec3((float)(sin_d(theta) * cos_d(phi)), (float)(sin_d(theta) * sin_d(phi)),
                (float)cos_d(theta));
}

static void haze_albedo(void *context, int item, int worker)
{
    AlbedoPass          *pass = context;
    const ReflectionFit *fit = pass->fit;
    Vec3   wi = light_of(pass, item);
    double s = sqrt((double)(wi.x * wi.x + wi.y * wi.y)), theta = atan2_d(s, (double)wi.z);
    float  ex = s > 1e-7 ? (float)((double)-wi.x / s) : 1;
    float  ey = s > 1e-7 ? (float)((double)-wi.y / s) : 0;
    SpecularFrame frame = specular_frame((float)theta, 2);
    double *albedo = pass->albedo + item * fit->wavelengths;
    (void)worker;
    for (int first = 0; first < fit->wavelengths; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = wavelengths_from(fit->set, first);
        for (int i = 0; i < pass->leaves; i++) {
            Vec3   d = specular_frame_outer(&frame, pass->direction[i]);
            double weight = pass->area[i] * fmax(0, (double)d.z) *
                            (double)specular_frame_jacobian(&frame, pass->direction[i]);
            Spectrum f = panel_brdf(pass->panel, vec3(ex * d.x - ey * d.y, ey * d.x + ex * d.y,
                                                      d.z), wi, &wavelengths);
            for (int k = 0; k < SPECTRUM_LANES && first + k < fit->wavelengths; k++)
                albedo[first + k] += weight * (double)f[k];
        }
    }
}

/* Directional-hemispherical reflectance of the haze without the lobe: tables, then nodes. */
static double *all_albedos(const ReflectionFit *fit, const Panel *panel, const Section *section,
                           Arena *arena)
{
    AlbedoPass pass = {.fit = fit, .panel = panel, .section = section};
    int  items = fit->tables + NODES, octants = fit->lattice.octants;
    pass.albedo = ARENA_NEW(arena, double, items * fit->wavelengths);
    pass.leaves = octants << 2 * ALBEDO_LEVEL;
    pass.direction = ARENA_NEW(arena, Vec3, pass.leaves);
    pass.area = ARENA_NEW(arena, double, pass.leaves);
    for (int i = 0; i < pass.leaves; i++) {
        pass.direction[i] = geodesic_center(ALBEDO_LEVEL, (uint32_t)i);
        pass.area[i] = 4.0 / octants * geodesic_area(ALBEDO_LEVEL, (uint32_t)i);
    }
    parallel_for(fit->options->threads, items, haze_albedo, &pass);
    return pass.albedo;
}

/* The lobe's reflectance at an item: its own, and beyond the last incidence like Fresnel's. */
static double lobe_albedo(const ReflectionFit *fit, const Section *section, int item, int w)
{
    int last = fit->set->incidence_count - 1;
    if (!fit->out->has_lobe) return 0;
    if (item < fit->tables) return fit->out->lobe[item * fit->wavelengths + w];
    double theta = (double)section->layout.node_theta[item - fit->tables];
    return fit->out->lobe[last * fit->wavelengths + w] * fit_fresnel(cos_d(theta)) /
           fit_fresnel(cos_d(fit->set->incidence[last]));
}

static double mirror_albedo(const Panel *panel, const ReflectionFit *fit, Vec3 light, int w)
{
    Wavelengths wavelengths = wavelengths_from(fit->set, w);
    return (double)panel_mirror(panel, light.z, &wavelengths)[0];
}

/* Writes albedos down, and holds haze, lobe and mirror at 1 in every table and node. */
static void hold_energy(ReflectionFit *fit, const Panel *panel, const Section *section,
                        const double *albedo)
{
    const ReflectionLayout *to = &section->layout;
    AlbedoPass where = {.fit = fit, .section = section};
    int n = fit->wavelengths;
    for (int i = 0; i < (fit->tables + NODES) * n; i++) {
        int    item = i / n, w = i % n, node = i - fit->tables * n;
        double mirror = mirror_albedo(panel, fit, light_of(&where, item), w);
        double lobe = lobe_albedo(fit, section, item, w), haze = albedo[i];
        double room = fmax(0.01, ALBEDO_MOST - mirror), both = haze + lobe;
        double factor = both > room ? room / both : 1;
        bool   is_table = item < fit->tables;
        if (is_table)
            fit->out->largest_albedo = fmax(fit->out->largest_albedo, both + mirror);
        if (is_table) shares(to->albedo)[i] = share(both * factor);
        else shares(to->node_albedo)[node] = share(both * factor);
        if (!is_table) shares(to->held)[node] = factor < 1 ? share(factor - 1e-5) : 65535;
        else if (factor < 1) {
            fit->mean[i] += (float)log_d(factor);
            if (fit->out->has_lobe) fit->out->lobe[i] *= factor;
        }
    }
}

static bool settle_energy(ReflectionFit *fit, const Section *section, FitNotes *notes,
                          Error *err)
{
    Arena scratch = *fit->arena;
    Panel panel = {0};
    if (!view_section(fit, section, &scratch, &panel, err)) return false;
    PanelReflection *without_lobe = ARENA_NEW(&scratch, PanelReflection, 1);
    *without_lobe = *panel.reflection;
    without_lobe->has_lobe = false;
    panel.reflection = without_lobe;
    double *albedo = all_albedos(fit, &panel, section, &scratch);
    hold_energy(fit, &panel, section, albedo);
    if (fit->out->largest_albedo > ALBEDO_MOST)
        fit_note(notes, "directional-hemispherical reflectance reached %.4f in a table; held "
                 "at %.3f", fit->out->largest_albedo, ALBEDO_MOST);
    return true;
}

bool reflect_finish(ReflectionFit *fit, FitNotes *notes, Error *err)
{
    PanelReflectionStored head;
    Section section;
    if (!settle_integrals(fit, err)) return false;
    head = head_of(fit);
    section.size = reflection_layout(&head, &section.layout);
    section.stored = arena_alloc(fit->arena, 1, 8, section.size);
    *section.stored = head;
    reflection_layout(section.stored, &section.layout);
    fill_axes(fit, &section);
    fill_numbers(fit, &section);
    fill_floors(fit, &section);
    fill_mirror(fit, &section);
    for (int i = 0; i < NODES * fit->wavelengths; i++) shares(section.layout.held)[i] = 65535;
    if (!settle_energy(fit, &section, notes, err)) return false;
    fill_numbers(fit, &section); /* again: energy may have lowered the means */
    fit->out->section = section.stored;
    fit->out->section_size = section.size;
    return true;
}

void fit_write_reflection(FitWriter *writer, const FitReflection *r)
{
    FitPiece section = {r->section, r->section_size}, tree = {r->tree, tree_size(r->tree)};
    FitPiece sampling = {r->sampling, r->sampling_size};
    fit_write_section(writer, PANEL_REFLECTION, 0, &section, 1);
    fit_write_section(writer, PANEL_REFLECTION_TREE, 0, &tree, 1);
    if (r->sampling) fit_write_section(writer, PANEL_SAMPLING, 0, &sampling, 1);
}
