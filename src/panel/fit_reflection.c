/* Reflection: slices in the specular-following frame in one Haar tree. */
#include <math.h>
#include <string.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/direction_grid.h"
#include "panel/fit_parts.h"

#define DEFAULT_LEVEL 6

/* What happens in one fit, with everything that its steps share. */
typedef struct Work {
    const Measurement *set;
    const FitOptions  *options;
    Arena             *arena;
    FitNotes          *notes;
    FitReflection     *out;
    FitPlaces places; /* in the stored frame */
    int    leaves, wavelengths, slices, mirrored, measured;
    float  k;
    float *logs[PANEL_SLICES_MAX]; /* places x wavelengths: ln (f / F) */
    DirectionGrid grid;
    float *cells; /* of the last slice: ln f */
} Work;

double fit_fresnel(double cos_theta)
{
    double n = FIT_REFRACTIVE_INDEX, c = fmin(1, fmax(0, cos_theta));
    double t = sqrt(1 - (1 - c * c) / (n * n));
    double s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
    return 0.5 * (s * s + p * p);
}

static double clamped_angle(double cosine)
{
    return acos(fmax(-1, fmin(1, cosine)));
}

static float *slice_logs(Work *work)
{
    return ARENA_NEW(work->arena, float,
                     (size_t)work->places.count * (size_t)work->wavelengths);
}

/* ln of the haze at the cells of a slice's grid; noise and zeros are held above a floor. */
static float *log_cells(Work *work, int slice)
{
    const AngleTable *table = &work->out->haze[slice];
    if (!slice || !direction_grid_same_rows(table, &work->out->haze[slice - 1]))
        direction_grid_build(table, true, work->arena, &work->grid);
    float *cells = direction_grid_cells(&work->grid, table->value, work->wavelengths,
                                        work->arena);
    size_t count = (size_t)(work->grid.thetas * work->grid.phis) * (size_t)work->wavelengths;
    float  most = 0;
    for (size_t i = 0; i < count; i++) most = fmaxf(most, cells[i]);
    float floor = fmaxf(1e-7f, 1e-7f * most);
    for (size_t i = 0; i < count; i++) cells[i] = logf(fmaxf(cells[i], floor));
    return cells;
}

/* A measured slice at the leaves' centres. */
static void read_slice(Work *work, int slice)
{
    double theta_i = work->set->incidence[slice];
    float  offset = (float)log(fit_fresnel(cos(theta_i)));
    SpecularFrame frame = specular_frame((float)theta_i, work->k);
    float *logs = work->logs[work->mirrored + slice] = slice_logs(work);
    work->cells = log_cells(work, slice);
    for (int i = 0; i < work->places.count; i++) {
        GridTaps taps;
        Vec3     d = specular_frame_outer(&frame, work->places.direction[i]);
        float   *to = logs + (size_t)i * (size_t)work->wavelengths;
        direction_grid_taps(&work->grid, (float)clamped_angle((double)d.z), atan2f(d.y, d.x),
                            &taps);
        direction_grid_read(&taps, work->cells, work->wavelengths, to);
        for (int w = 0; w < work->wavelengths; w++) to[w] -= offset;
    }
}

/* A slice mirrored at the normal: leaves of octants 0 and 1 change places. */
static void mirror_slice(Work *work, int to, int from)
{
    size_t half = (size_t)work->leaves / 2 * (size_t)work->wavelengths;
    work->logs[to] = slice_logs(work);
    memcpy(work->logs[to], work->logs[from] + half, half * sizeof(float));
    memcpy(work->logs[to] + half, work->logs[from], half * sizeof(float));
    size_t size = (size_t)work->wavelengths;
    for (int i = work->leaves; i < work->places.count; i++) {
        int ring = (i - work->leaves) / FIT_RING, turn = (i - work->leaves) % FIT_RING;
        int other = work->leaves + ring * FIT_RING + FIT_RING - 1 - turn;
        memcpy(work->logs[to] + (size_t)i * size, work->logs[from] + (size_t)other * size,
               sizeof(float) * size);
    }
}

/* The smallest value of the last slice per wavelength inside 60 degrees: its floor. */
static void slice_floor(const Work *work, double *floor)
{
    for (int w = 0; w < work->wavelengths; w++) floor[w] = 1e30;
    for (int t = 0; t < work->grid.thetas; t++) {
        if (work->grid.theta[t] > (float)radians_from_degrees(60)) break;
        for (int c = t * work->grid.phis; c < (t + 1) * work->grid.phis; c++)
            for (int w = 0; w < work->wavelengths; w++)
                floor[w] = fmin(floor[w], exp((double)work->cells[c * work->wavelengths + w]));
    }
}

/* R / F over the measured incidences, straight lines in F; beyond the last one the line goes
 * on (a coating loses its effect towards grazing), held between half the last ratio and 1. */
static double mirror_ratio(const Work *work, int wavelength, double fresnel)
{
    int    m = work->measured, i = 0;
    double f[2], ratio[2];
    while (i + 2 < m && fit_fresnel(cos(work->set->incidence[i + 1])) < fresnel) i++;
    for (int k = 0; k < 2; k++) {
        int j = i + k < m ? i + k : m - 1;
        f[k] = fit_fresnel(cos(work->set->incidence[j]));
        ratio[k] = work->out->reflectance[j][wavelength] / f[k];
    }
    if (m < 2 || fresnel <= f[0] || !(f[1] - f[0] > 1e-6)) return ratio[fresnel > f[0]];
    double value = ratio[0] + (ratio[1] - ratio[0]) * (fresnel - f[0]) / (f[1] - f[0]);
    return fmin(1, fmax(value, 0.5 * fmin(ratio[0], ratio[1])));
}

/* Reflectance of the glossy surface at a wavelength: the mirror part's where there is one (the
 * coating is the same), Fresnel's otherwise. Up to a constant. */
static double gloss(const Work *work, int wavelength, double fresnel)
{
    return work->out->has_mirror ? fresnel * mirror_ratio(work, wavelength, fresnel) : fresnel;
}

/* A slice beyond the last measured incidence, by the invariance of scatter from surfaces of
 * low slope (Harvey): in the projection on the panel's plane the lobe only moves, and its
 * height follows the root of the surface's reflectances at theta_i and theta_o. The floor
 * follows the light that enters. */
static void extrapolate_slice(Work *work, int slice, double theta_i)
{
    double last = work->set->incidence[work->measured - 1];
    double floor[MEASUREMENT_WAVELENGTHS_MAX], fi = fit_fresnel(cos(theta_i));
    double fl = fit_fresnel(cos(last)), entering = (1 - fi) / (1 - fl);
    double edge = sin((double)work->grid.theta[work->grid.thetas - 1]);
    SpecularFrame frame = specular_frame((float)theta_i, work->k);
    work->logs[slice] = slice_logs(work);
    slice_floor(work, floor);
    for (int i = 0; i < work->places.count; i++) {
        GridTaps taps;
        float    from[MEASUREMENT_WAVELENGTHS_MAX];
        Vec3     d = specular_frame_outer(&frame, work->places.direction[i]);
        double   x = (double)d.x - sin(theta_i) + sin(last), y = (double)d.y;
        double   r = sqrt(x * x + y * y), s = r > edge ? edge : r;
        double   fo = fit_fresnel((double)d.z), fs = fit_fresnel(sqrt(1 - s * s));
        direction_grid_taps(&work->grid, (float)asin(s), (float)atan2(y, x), &taps);
        direction_grid_read(&taps, work->cells, work->wavelengths, from);
        for (int w = 0; w < work->wavelengths; w++) {
            double haze = fmax(0, exp((double)from[w]) - floor[w]);
            double gain = sqrt(gloss(work, w, fi) * gloss(work, w, fo) /
                               (gloss(work, w, fl) * gloss(work, w, fs)));
            double value = haze * gain + floor[w] * entering;
            work->logs[slice][(size_t)i * (size_t)work->wavelengths + (size_t)w] =
                (float)log(fmax(value, 1e-9) / fi);
        }
    }
}

/* ---- which slices there are ------------------------------------------------------------ */

static void name_slices(Work *work)
{
    static const double beyond_deg[] = {67, 75, 82, 88};
    PanelReflection *head = &work->out->head;
    int    n = 0, m = work->measured;
    double first = work->set->incidence[0], last = work->set->incidence[m - 1];
    work->mirrored = first > 1e-6 ? (m < 2 ? m : 2) : (m < 2 ? 0 : 1);
    for (int i = work->mirrored; i > 0; i--)
        head->slice_theta[n++] = (float)-work->set->incidence[first > 1e-6 ? i - 1 : i];
    for (int i = 0; i < m; i++) head->slice_theta[n++] = (float)work->set->incidence[i];
    for (int i = 0; i < 4; i++)
        if (radians_from_degrees(beyond_deg[i]) > last + radians_from_degrees(4))
            head->slice_theta[n++] = (float)radians_from_degrees(beyond_deg[i]);
    work->slices = n;
    head->slices = (uint32_t)n;
    head->first_theta = (float)first;
    head->last_theta = (float)last;
}

static void fill_slices(Work *work)
{
    int skip = work->set->incidence[0] > 1e-6 ? 0 : 1; /* a slice at 0 is its own mirror */
    for (int i = 0; i < work->measured; i++) read_slice(work, i);
    for (int i = 0; i < work->mirrored; i++)
        mirror_slice(work, i, work->mirrored + (work->mirrored - 1 - i) + skip);
    for (int i = work->mirrored + work->measured; i < work->slices; i++)
        extrapolate_slice(work, i, (double)work->out->head.slice_theta[i]);
}

/* ---- the mirror part ------------------------------------------------------------------- */

static void fill_mirror(Work *work)
{
    size_t padded = work->out->head.padded_wavelengths;
    work->out->mirror = ARENA_NEW(work->arena, float, PANEL_ANGLES * padded);
    for (int a = 0; a < PANEL_ANGLES && work->out->has_mirror; a++) {
        double f = fit_fresnel(cos(radians_from_degrees(0.5 * a)));
        for (int w = 0; w < work->wavelengths; w++)
            work->out->mirror[(size_t)a * padded + (size_t)w] =
                (float)fmin(1, f * mirror_ratio(work, w, f));
    }
}

static void luminous_weights(const Measurement *set, double *luminous)
{
    double total = 0;
    for (int w = 0; w < set->wavelength_count; w++) {
        int i = (int)((double)set->wavelength_nm[w] + 0.5) - SPECTRAL_FIRST_NM;
        i = i < 0 ? 0 : i >= SPECTRAL_COUNT ? SPECTRAL_COUNT - 1 : i;
        luminous[w] = (double)spectral_table[i].y + 0.002;
        total += luminous[w];
    }
    for (int w = 0; w < set->wavelength_count; w++) luminous[w] /= total;
}

static void note_mirror(const Measurement *set, const FitReflection *out, FitNotes *notes)
{
    int last = set->incidence_count - 1;
    if (out->has_mirror)
        fit_note(notes, "a mirror image as wide as the instrument (%g deg) was moved to the "
                 "mirror part: luminous reflectance %.4f at %g deg, %.4f at %g deg",
                 set->instrument_fwhm_deg, out->mirror_y[0],
                 degrees_from_radians(set->incidence[0]), out->mirror_y[last],
                 degrees_from_radians(set->incidence[last]));
    else if (set->instrument_fwhm_deg > 0)
        fit_note(notes, "no image as narrow as the instrument (%g deg) stands out of the haze: "
                 "no mirror part", set->instrument_fwhm_deg);
    else
        fit_note(notes, "the instrument's width is not declared (instrument_fwhm_deg): no "
                 "mirror part was separated");
}

void fit_separate(const Measurement *set, Arena *arena, FitNotes *notes, FitReflection *out)
{
    double fwhm = radians_from_degrees(set->instrument_fwhm_deg);
    luminous_weights(set, out->luminous);
    for (int i = 0; i < set->incidence_count; i++) {
        const AngleTable *slice = &set->brdf[i];
        out->haze[i] = *slice;
        out->noise[i] = fit_noise(slice, set->wavelength_count / 2, *arena);
        if (!(fwhm > 0)) continue;
        fit_mirror(slice, set->incidence[i], fwhm, arena, out->reflectance[i], &out->haze[i]);
        for (int w = 0; w < set->wavelength_count; w++)
            out->mirror_y[i] += out->luminous[w] * out->reflectance[i][w];
        out->has_mirror |= out->mirror_y[i] > 0;
    }
    note_mirror(set, out, notes);
}

/* ---- energy ---------------------------------------------------------------------------- */

/* Directional-hemispherical reflectance of a slice, per wavelength. */
static void slice_albedo(const Work *work, int slice, double *albedo)
{
    double theta = fabs((double)work->out->head.slice_theta[slice]);
    double fresnel = fit_fresnel(cos(theta));
    bool   is_mirrored = work->out->head.slice_theta[slice] < 0;
    SpecularFrame frame = specular_frame((float)theta, work->k);
    memset(albedo, 0, sizeof *albedo * (size_t)work->wavelengths);
    for (int i = 0; i < work->leaves; i++) {
        Vec3 stored = work->places.direction[i];
        int  from = is_mirrored ? (i + work->leaves / 2) % work->leaves : i;
        Vec3 outer = specular_frame_outer(&frame, stored);
        double weight = 2 * work->places.area[i] * fresnel * fmax(0, (double)outer.z) *
                        (double)specular_frame_jacobian(&frame, stored);
        const float *logs = work->logs[slice] + (size_t)from * (size_t)work->wavelengths;
        for (int w = 0; w < work->wavelengths; w++) albedo[w] += weight * exp((double)logs[w]);
    }
}

/* Holds haze plus mirror at 1 in every slice, and tabulates the luminous haze albedo. */
static void settle_energy(Work *work)
{
    double ratio[PANEL_SLICES_MAX], albedo[MEASUREMENT_WAVELENGTHS_MAX];
    PanelReflection *head = &work->out->head;
    for (int s = 0; s < work->slices; s++) {
        double theta = fabs((double)head->slice_theta[s]), f = fit_fresnel(cos(theta)), sum = 0;
        slice_albedo(work, s, albedo);
        for (int w = 0; w < work->wavelengths; w++) {
            double mirror = work->out->has_mirror ? f * mirror_ratio(work, w, f) : 0;
            double total = albedo[w] + mirror, room = fmax(0.01, 0.995 - mirror);
            work->out->largest_albedo = fmax(work->out->largest_albedo, total);
            sum += work->out->luminous[w] * fmin(albedo[w], room);
            if (albedo[w] <= room) continue;
            float lower = (float)log(albedo[w] / room);
            for (int i = 0; i < work->places.count; i++)
                work->logs[s][(size_t)i * (size_t)work->wavelengths + (size_t)w] -= lower;
        }
        ratio[s] = sum / f;
    }
    for (int a = 0; a < PANEL_ANGLES; a++) {
        double theta = radians_from_degrees(0.5 * a);
        int    s = work->mirrored > 0 ? work->mirrored - 1 : 0;
        while (s + 2 < work->slices && (double)head->slice_theta[s + 1] <= theta) s++;
        int    next = s + 1 < work->slices ? s + 1 : s;
        double span = (double)(head->slice_theta[next] - head->slice_theta[s]);
        double t = span > 0 ? fmin(1, (theta - (double)head->slice_theta[s]) / span) : 0;
        head->haze_albedo[a] = (float)(fit_fresnel(cos(theta)) *
                                       (ratio[s] + t * (ratio[next] - ratio[s])));
    }
    if (work->out->largest_albedo > 0.995)
        fit_note(work->notes, "directional-hemispherical reflectance reached %.4f in a slice; "
                 "held at 0.995", work->out->largest_albedo);
}

/* ---- wavelengths ----------------------------------------------------------------------- */

/* Which wavelet coefficients carry the spectra: the strongest until what is left out is small
 * against the tolerance. Returns how many; index[] holds them, strongest first. */
static int choose_coefficients(const Work *work, const double *energy, double tolerance,
                               int *index)
{
    bool   used[MEASUREMENT_WAVELENGTHS_MAX] = {false};
    double rest = 0;
    int    count = 0;
    for (int w = 0; w < work->wavelengths; w++) rest += energy[w];
    while (count < work->wavelengths && count < PANEL_COEFFICIENTS_MAX &&
           (count + 1) * work->slices <= TREE_MAX_COMPONENTS) {
        int best = -1;
        for (int w = 0; w < work->wavelengths; w++)
            if (!used[w] && (best < 0 || energy[w] > energy[best])) best = w;
        bool is_enough = count && sqrt(rest / work->wavelengths) <= tolerance;
        if (is_enough && count % 4 == 0) break; /* queries sum four at a time */
        used[best] = true;
        rest -= energy[best];
        index[count++] = best;
    }
    return count;
}

/* Spectra of all leaves and slices to wavelet coefficients, in place; mean square of each
 * coefficient, weighted by what it inverts to. */
static void transform_spectra(Work *work, double *energy)
{
    float norm[MEASUREMENT_WAVELENGTHS_MAX];
    int   n = work->wavelengths;
    wavelet1d_norms(work->options->wavelet, n, norm);
    memset(energy, 0, sizeof *energy * (size_t)n);
    for (int s = 0; s < work->slices; s++)
        for (int i = 0; i < work->places.count; i++) {
            float *row = work->logs[s] + (size_t)i * (size_t)n;
            wavelet1d_forward(work->options->wavelet, row, n);
            for (int w = 0; w < n; w++) {
                double c = (double)(row[w] * norm[w]);
                energy[w] += c * c / ((double)work->places.count * work->slices);
            }
        }
}

static void make_basis(Work *work, const int *index, int count, float *largest)
{
    size_t padded = work->out->head.padded_wavelengths;
    work->out->basis = ARENA_NEW(work->arena, float, padded * (size_t)count);
    for (int k = 0; k < count; k++) {
        float *row = work->out->basis + (size_t)k * padded;
        row[index[k]] = 1;
        wavelet1d_inverse(work->options->wavelet, row, work->wavelengths);
        largest[k] = 1e-6f;
        for (int w = 0; w < work->wavelengths; w++)
            largest[k] = fmaxf(largest[k], fabsf(row[w]));
    }
}

static double largest_noise(const FitReflection *out, int measured)
{
    double most = 0;
    for (int i = 0; i < measured; i++) most = fmax(most, out->noise[i]);
    return most;
}

static bool build_tree(Work *work, const int *index, int count, const float *largest,
                       Error *err)
{
    int    components = work->slices * count;
    float *values = ARENA_NEW(work->arena, float,
                              (size_t)work->places.count * (size_t)components);
    float  scale[TREE_MAX_COMPONENTS];
    for (int s = 0; s < work->slices; s++)
        for (int k = 0; k < count; k++) {
            int c = s * count + k;
            /* nobody measured beyond the last incidence: a quarter of the precision there */
            scale[c] = s < work->mirrored + work->measured ? largest[k] : 0.25f * largest[k];
            for (int i = 0; i < work->places.count; i++)
                values[(size_t)i * (size_t)components + (size_t)c] =
                    work->logs[s][(size_t)i * (size_t)work->wavelengths + (size_t)index[k]];
        }
    work->out->head.harmonics = FIT_REFLECTION_HARMONICS;
    work->out->profile = fit_profile(&work->places, values, components,
                                     FIT_REFLECTION_HARMONICS, work->arena);
    double bound = fmax(4 * (double)work->options->max_error,
                        3 * largest_noise(work->out, work->measured));
    TreeOptions options = {.shape = {work->places.level, 2, components, work->options->weights},
                           .keep_share = work->options->keep_share,
                           .max_error = work->options->max_error > 0 ? (float)bound : 0,
                           .component_scale = scale, .rows = TREE_ROWS_INT16};
    work->out->head.coefficients = (uint32_t)count;
    return tree_build(&options, values, work->arena, &work->out->tree, &work->out->tree_report,
                      err) || error_prefix(err, "reflection");
}

/* ---- all of it ------------------------------------------------------------------------- */

static void start_work(Work *work)
{
    PanelReflection *head = &work->out->head;
    work->measured = work->set->incidence_count;
    work->wavelengths = work->set->wavelength_count;
    work->places = fit_places(work->options->level ? work->options->level : DEFAULT_LEVEL, 2,
                              work->arena);
    work->leaves = work->places.leaves;
    memcpy(head->wavelength_nm, work->set->wavelength_nm,
           sizeof *head->wavelength_nm * (size_t)work->wavelengths);
    head->wavelengths = (uint32_t)work->wavelengths;
    head->padded_wavelengths = (head->wavelengths + 15) / 16 * 16;
    head->refractive_index = (float)FIT_REFRACTIVE_INDEX;
    head->is_cubic = !work->options->is_linear_in_incidence;
    head->frame_exponent = work->k = work->options->frame_exponent;
}

bool fit_reflection(const Measurement *set, const FitOptions *options, Arena *arena,
                    FitNotes *notes, FitReflection *out, Error *err)
{
    double energy[MEASUREMENT_WAVELENGTHS_MAX];
    int    index[MEASUREMENT_WAVELENGTHS_MAX];
    float  largest[PANEL_COEFFICIENTS_MAX];
    Work  *work = ARENA_NEW(arena, Work, 1);
    work->set = set;
    work->options = options;
    work->arena = arena;
    work->notes = notes;
    work->out = out;
    start_work(work);
    name_slices(work);
    fill_slices(work);
    settle_energy(work);
    fill_mirror(work);
    double edge = 0.5 * PI;
    for (int i = 0; i < work->measured; i++) edge = fmin(edge, (double)set->brdf[i].theta_max);
    out->head.cone_cos = (float)fmax(0, cos(edge));
    transform_spectra(work, energy);
    double tolerance = options->max_error > 0 ? (double)options->max_error : 3e-3;
    tolerance = fmax(tolerance, 2 * largest_noise(out, work->measured));
    int count = choose_coefficients(work, energy, tolerance, index);
    make_basis(work, index, count, largest);
    return build_tree(work, index, count, largest, err);
}
