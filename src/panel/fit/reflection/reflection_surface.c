/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_surface.h"

#include <math.h>

#include "panel/shape/least_squares.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_read.h"
#include "panel/query/panel_reference.h"
#include "panel/query/panel_turn.h"

#define ROWS_ENOUGH 400     /* of a table, to judge a law by */
#define TRIPLES_ENOUGH 48   /* tables predicted from two neighbours */
#define TRIAL_EXPONENT 1.5f /* of the specular-following frame, where it is judged */
#define MUST_HELP 0.8       /* another frame is taken if it misses less than this share */
#define FAR_ABOVE 3         /* rows brighter than this times the dimmest show how haze moves */
#define INDEX_LEAST 1.2
#define INDEX_MOST 2.6
#define INDEX_REST 0.02 /* rms of logarithms: what more leaves unexplained is no bare face */

/* ---- predicting one table from others ---------------------------------------------------- */

/* A sum of squared misses in the logarithm. */
typedef struct Misses {
    double squares;
    int count;
} Misses;

static double rms_of(Misses misses) {
    return misses.count ? sqrt(misses.squares / misses.count) : 1e9;
}

/* ln f of a table at its middle wavelength; false beyond its last ring. */
static bool read_log(const ReflectionModel *model, int table, Vec3 local, double *out) {
    float logs[MEASUREMENT_WAVELENGTHS_MAX];
    if (reflection_read_logs(model, table, local, logs) > 0) return false;
    *out = (double)logs[model->wavelengths / 2];
    return true;
}

/* ln (f / reference) at the place where `stored` is in a table. */
static bool read_stored(const ReflectionModel *model, int table, Vec3 stored, double *out) {
    ReflectionView view = reflection_view(model, table);
    Vec3 local = reflection_view_local(&view, stored);
    if (!(local.z > 0) || !read_log(model, table, local, out)) return false;
    *out -= log_d(reflection_view_reference(&view, local));
    return true;
}

static void predict_row(const ReflectionModel *model, const int from[2], int table, Vec3 local,
                        Misses *misses) {
    ReflectionView view = reflection_view(model, table);
    Vec3 stored = reflection_view_stored(&view, local);
    double here, a, b;
    if (!read_stored(model, table, stored, &here) || !read_stored(model, from[0], stored, &a) ||
        !read_stored(model, from[1], stored, &b))
        return;
    misses->squares += (here - 0.5 * (a + b)) * (here - 0.5 * (a + b));
    misses->count++;
}

/* A table from the mean of two, between which it was measured. */
static void predict_table(const ReflectionModel *model, const int from[2], int table,
                          Misses *misses) {
    const AngleTable *rows = &model->parts->haze[table];
    int stride = 1 + rows->rows / ROWS_ENOUGH;
    for (int i = 0; i < rows->rows; i += stride)
        predict_row(model, from, table, table_row_direction(rows, i), misses);
}

/* How far the model's frame is off between azimuths and between incidences. */
static double frame_misses(const ReflectionModel *model) {
    Misses misses = {0, 0};
    int n = model->set->incidence_count, m = model->set->azimuth_count;
    int stride = 1 + 2 * model->tables / TRIPLES_ENOUGH;
    for (int t = 0; t < model->tables; t += stride) {
        int i = t % n, a = t / n;
        predict_table(model, (int[2]){(a + 1) % m * n + i, (a + m - 1) % m * n + i}, t, &misses);
        if (i > 0 && i + 1 < n) predict_table(model, (int[2]){t - 1, t + 1}, t, &misses);
    }
    return rms_of(misses);
}

/* ---- how wide the haze's lobe is, and along which axes ----------------------------------- */

/* Around the mirror direction a lobe is taken for (1 + x^T M x)^-2 over slopes or direction
 * cosines x, GGX's shape: fitted where a table is above a quarter of its peak, mean over the
 * tables. Other shapes get the axes of what is about as wide. M is 1 / alpha^2 for facets. */
#define CORE 4.0      /* rows above this part of the peak belong to the lobe's core */
#define NEAR_COS 0.86 /* the peak is looked for within 30 degrees of the mirror direction */
#define ROWS_LEAST 12
#define WIDTH 0.2 /* where no table shows a lobe */
#define NARROWEST 0.003
#define WIDEST 2.0

/* A symmetric 2 x 2 matrix in double precision. */
typedef struct Symmetric {
    double xx, xy, yy;
} Symmetric;

/* One row of a table as the lobe's fit sees it. */
typedef struct LobeRow {
    double x, y, height; /* height: f over the reference, mean over the wavelengths; of facets'
                            density per slope instead of per direction */
    bool is_near;
} LobeRow;

static LobeRow lobe_row(const AngleTable *table, int row, PanelFrameKind frame, Vec3 light) {
    Vec3 local = table_row_direction(table, row);
    Vec3 wo = panel_turned_back(light, local);
    double scale = frame == PANEL_FRAME_COSINES ? 1 : 1 / (double)(light.z + wo.z), sum = 0;
    float reference = panel_reference(frame, (float)REFLECTION_REFRACTIVE_INDEX, light, wo);
    for (int w = 0; w < table->channels; w++)
        sum += (double)table->value[(size_t)row * (size_t)table->channels + (size_t)w];
    double x = (double)(light.x + wo.x) * scale, y = (double)(light.y + wo.y) * scale;
    double spread = frame == PANEL_FRAME_SLOPES ? (1 + x * x + y * y) * (1 + x * x + y * y) : 1;
    float cosine = light.z * wo.z - light.x * wo.x - light.y * wo.y; /* to the mirror image */
    return (LobeRow){x, y, sum / table->channels / (double)reference / spread,
                     (double)cosine > NEAR_COS};
}

/* M of one table: sqrt (peak / height) = a (1 + x^T M x) by least squares. */
static bool fit_table(const AngleTable *table, PanelFrameKind frame, Vec3 light, Symmetric *out) {
    double matrix[16] = {0}, right[4] = {0}, peak = 0;
    int count = 0;
    for (int i = 0; i < table->rows; i++) {
        LobeRow row = lobe_row(table, i, frame, light);
        if (row.is_near) peak = fmax(peak, row.height);
    }
    for (int i = 0; i < table->rows; i++) {
        LobeRow row = lobe_row(table, i, frame, light);
        if (!row.is_near || !(CORE * row.height > peak)) continue;
        double terms[4] = {1, row.x * row.x, 2 * row.x * row.y, row.y * row.y};
        double weight = table_row_weight(table, i), value = sqrt(peak / row.height);
        for (int r = 0; r < 4; r++) {
            right[r] += weight * terms[r] * value;
            for (int c = 0; c < 4; c++) matrix[4 * r + c] += weight * terms[r] * terms[c];
        }
        count++;
    }
    if (count < ROWS_LEAST) return false;
    least_squares_factor(matrix, 4);
    least_squares_solve(matrix, right, 4);
    *out = (Symmetric){right[1] / right[0], right[2] / right[0], right[3] / right[0]};
    return right[0] > 0 && out->xx > 0 && out->yy > 0 && out->xx * out->yy > out->xy * out->xy;
}

/* The matrix with its eigenvalues raised to a power; as widths, eigenvalue^-1/2 is held between
 * the narrowest and the widest. */
static SurfaceAxes raised(Symmetric m, double power) {
    double mean = 0.5 * (m.xx + m.yy), half = 0.5 * (m.xx - m.yy);
    double root = sqrt(half * half + m.xy * m.xy), value[2];
    double cosine = root > 0 ? half / root : 1, sine = root > 0 ? m.xy / root : 0;
    for (int k = 0; k < 2; k++) {
        double width = 1 / sqrt(fmax(1e-9, k ? mean - root : mean + root));
        value[k] = pow_d(fmin(WIDEST, fmax(NARROWEST, width)), -2 * power);
    }
    double centre = 0.5 * (value[0] + value[1]), spread = 0.5 * (value[0] - value[1]);
    return (SurfaceAxes){(float)(centre + spread * cosine), (float)(spread * sine),
                         (float)(centre - spread * cosine)};
}

static Symmetric lobe_matrix(const ReflectionModel *model, PanelFrameKind frame) {
    Symmetric sum = {0, 0, 0}, one;
    int count = 0;
    for (int t = 0; t < model->tables; t++) {
        Vec3 light = reflection_model_light(model->set, t);
        if (!fit_table(&model->parts->haze[t], frame, light, &one)) continue;
        sum.xx += one.xx, sum.xy += one.xy, sum.yy += one.yy;
        count++;
    }
    if (!count) return (Symmetric){1 / (WIDTH * WIDTH), 0, 1 / (WIDTH * WIDTH)};
    Symmetric mean = {sum.xx / count, sum.xy / count, sum.yy / count};
    if (model->set->azimuth_count < 2) /* the same in all directions, but for the fit's noise */
        mean = (Symmetric){0.5 * (mean.xx + mean.yy), 0, 0.5 * (mean.xx + mean.yy)};
    return mean;
}

/* The root of M: makes the lobe round, and 1 wide at a quarter of its height. */
static SurfaceAxes axes_of_lobe(const ReflectionModel *model, PanelFrameKind frame) {
    return raised(lobe_matrix(model, frame), 0.5);
}

/* The inverse of M over slopes: squared GGX alphas. */
static SurfaceAxes roughness_of(const ReflectionModel *model) {
    return raised(lobe_matrix(model, PANEL_FRAME_SLOPES), -1);
}

/* The longest x of any row in these axes. */
static float reach_in(const ReflectionModel *model, PanelFrameKind frame, SurfaceAxes axes) {
    double most = 1;
    for (int t = 0; t < model->tables; t++) {
        const AngleTable *table = &model->parts->haze[t];
        Vec3 light = reflection_model_light(model->set, t);
        for (int i = 0; i < table->rows; i++) {
            LobeRow row = lobe_row(table, i, frame, light);
            double x = (double)axes.xx * row.x + (double)axes.xy * row.y;
            double y = (double)axes.xy * row.x + (double)axes.yy * row.y;
            most = fmax(most, hypot_d(x, y));
        }
    }
    return (float)(1.001 * most);
}

/* ---- the frame --------------------------------------------------------------------------- */

static ReflectionSurface surface_in(const ReflectionModel *model, PanelFrameKind frame) {
    ReflectionSurface surface = {{.frame = (uint8_t)frame}, {{0, 0, 0}, {0, 0, 0}, 0, false}};
    if (frame == PANEL_FRAME_SPECULAR) return surface;
    SurfaceAxes axes = axes_of_lobe(model, frame);
    surface.stored.axes[0] = axes.xx;
    surface.stored.axes[1] = axes.xy;
    surface.stored.axes[2] = axes.yy;
    surface.stored.reach = reach_in(model, frame, axes);
    surface.frame = surface_frame(frame == PANEL_FRAME_COSINES, axes, surface.stored.reach);
    return surface;
}

/* The specular-following frame turns with the light, which a brushed surface does not. */
static void choose_coordinates(ReflectionModel *model, FitNotes *notes) {
    static const char *const names[] = {"", "facets' slopes", "direction cosines"};
    ReflectionModel trial = *model;
    double least;
    trial.k = TRIAL_EXPONENT;
    least = MUST_HELP * frame_misses(&trial);
    for (int kind = PANEL_FRAME_SLOPES; kind <= PANEL_FRAME_COSINES; kind++) {
        trial.surface = surface_in(model, (PanelFrameKind)kind);
        double misses = frame_misses(&trial);
        if (!(misses < least)) continue;
        least = misses;
        model->surface = trial.surface;
    }
    if (model->surface.stored.frame == PANEL_FRAME_SPECULAR) return;
    model->k = 1;
    fit_note(notes,
             "the haze is anisotropic: stored over %s in its own axes, where tables "
             "tell the one between them within %.2g %% (rms)",
             names[model->surface.stored.frame], 100 * least);
}

/* ---- refractive indices ------------------------------------------------------------------ */

/* ln of measured values over incidences, and of what they are besides Fresnel's reflectance. */
typedef struct FaceCurve {
    int count;
    double cosine[MEASUREMENT_INCIDENCES_MAX], log[MEASUREMENT_INCIDENCES_MAX];
} FaceCurve;

/* rms by which a face of index n misses the curve, its height free. */
static double face_rest(const FaceCurve *curve, double n) {
    double sum = 0, squares = 0;
    for (int i = 0; i < curve->count; i++) {
        double rest = curve->log[i] - log_d(fresnel_unpolarised_d(curve->cosine[i], n));
        sum += rest;
        squares += rest * rest;
    }
    double mean = sum / curve->count;
    return sqrt(fmax(0, squares / curve->count - mean * mean));
}

/* By golden sections; 0: the curve is not a bare face's. */
static double face_index(const FaceCurve *curve) {
    double low = INDEX_LEAST, high = INDEX_MOST;
    if (curve->count < 3) return 0;
    for (int i = 0; i < 30; i++) {
        double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
        if (face_rest(curve, a) < face_rest(curve, b)) high = b;
        else low = a;
    }
    double n = 0.5 * (low + high);
    bool at_end = n < INDEX_LEAST + 0.01 || n > INDEX_MOST - 0.01;
    return at_end || face_rest(curve, n) > INDEX_REST ? 0 : n;
}

/* ln F of the last incidence over that of the one before it, for a bare face. */
static double face_step(const FaceCurve *curve, double n) {
    int last = curve->count - 1;
    return log_d(fresnel_unpolarised_d(curve->cosine[last], n) /
                 fresnel_unpolarised_d(curve->cosine[last - 1], n));
}

/* Error at the last incidence, as a logarithm, of R / F of ordinary glass on a straight line
 * over F through the two before it. */
static double line_miss(const FaceCurve *curve) {
    int last = curve->count - 1;
    double f[3], ratio[3];
    for (int k = 0; k < 3; k++) {
        f[k] = reflection_fresnel(curve->cosine[last - 2 + k]);
        ratio[k] = exp_d(curve->log[last - 2 + k]) / f[k];
    }
    double line = ratio[1] + (ratio[1] - ratio[0]) * (f[2] - f[1]) / (f[1] - f[0]);
    return fabs(log_d(fmax(line, 1e-9) / ratio[2]));
}

/* The mirror part: a bare face where that predicts the last incidence better than the line. */
static void choose_mirror(ReflectionModel *model) {
    FaceCurve curve = {0};
    for (int i = 0; i < model->set->incidence_count; i++) {
        if (!(model->parts->mirror_y[i] > 0)) continue;
        curve.cosine[curve.count] = cos_d(model->set->incidence[i]);
        curve.log[curve.count++] = log_d(model->parts->mirror_y[i]);
    }
    if (curve.count < 4 || curve.count < model->set->incidence_count) return;
    FaceCurve before = curve;
    before.count--;
    double n = face_index(&before), step = curve.log[curve.count - 1] - curve.log[curve.count - 2];
    bool is_face = n > 0 && fabs(face_step(&curve, n) - step) < line_miss(&curve);
    if (is_face) model->surface.stored.mirror_index = (float)face_index(&curve);
}

/* ---- haze beyond the last incidence ------------------------------------------------------ */

static Vec3 mirror_direction(double theta) {
    return vec3((float)sin_d(theta), 0, (float)cos_d(theta));
}

/* Refractive index by the haze's peaks over incidences, less masking; 0: none fits. */
static double haze_index(const ReflectionModel *model, SurfaceAxes roughness) {
    FaceCurve curve = {0};
    for (int i = 0; i < model->set->incidence_count; i++) {
        double theta = model->set->incidence[i], log;
        Vec3 light = reflection_model_light(model->set, i);
        Vec3 away = vec3(-light.x, -light.y, light.z);
        if (!read_log(model, i, mirror_direction(theta), &log)) continue;
        curve.cosine[curve.count] = cos_d(theta);
        curve.log[curve.count++] = log - log_d((double)panel_masking(roughness, light, away));
    }
    return face_index(&curve);
}

/* ln of what haze of a kind follows, up to a constant. */
static double beyond_log(const PanelSurfaceStored *s, Vec3 wi, Vec3 wo) {
    SurfaceAxes roughness = {s->roughness[0], s->roughness[1], s->roughness[2]};
    if (s->beyond == PANEL_BEYOND_COSINES)
        return log_d((double)panel_reference(PANEL_FRAME_COSINES, s->refractive_index, wi, wo));
    return log_d((double)(fresnel_unpolarised(panel_facet_cosine(wi, wo), s->refractive_index) *
                          panel_masking(roughness, wi, wo)));
}

static double dimmest(const AngleTable *table) {
    float least = 1e30f;
    for (int i = 0; i < table->rows; i++)
        if (table->theta[i] < 1.05f)
            least = fminf(
                least,
                table->value[(size_t)i * (size_t)table->channels + (size_t)table->channels / 2]);
    return (double)least;
}

/* Where light from `before` goes by the facet, or with the difference of direction cosines, by
 * which wi goes to wo; z may be 0 or below. */
static Vec3 same_place(const PanelSurfaceStored *law, Vec3 wi, Vec3 wo, Vec3 before) {
    if (law->beyond == PANEL_BEYOND_SLOPES) return surface_frame_same_facet(wi, wo, before);
    float x = wi.x + wo.x - before.x, y = wi.y + wo.y - before.y;
    return vec3(x, y, sqrtf(fmaxf(0, 1 - x * x - y * y)));
}

/* How far a law is off that makes the last table from the one before it; light at azimuth 180,
 * as in every table of its own. */
static double beyond_misses(const ReflectionModel *model, const PanelSurfaceStored *law) {
    int last = model->set->incidence_count - 1;
    const AngleTable *rows = &model->parts->haze[last];
    double least = FAR_ABOVE * dimmest(rows), here, there;
    Vec3 wi = reflection_model_light(model->set, last);
    Vec3 before = reflection_model_light(model->set, last - 1);
    Misses misses = {0, 0};
    for (int i = 0; i < rows->rows; i += 1 + rows->rows / (16 * ROWS_ENOUGH)) {
        Vec3 local = table_row_direction(rows, i);
        Vec3 wo = panel_turned_back(wi, local);
        Vec3 from = same_place(law, wi, wo, before);
        if (!(from.z > 0) || !read_log(model, last, local, &here) || exp_d(here) < least ||
            !read_log(model, last - 1, panel_turned(before, from), &there))
            continue;
        double miss = here - there - beyond_log(law, wi, wo) + beyond_log(law, before, from);
        misses.squares += miss * miss;
        misses.count++;
    }
    return rms_of(misses);
}

/* Haze of facets if that makes the last table from the one before it better than haze that
 * depends on direction cosines. */
static void choose_beyond(ReflectionModel *model) {
    PanelSurfaceStored *s = &model->surface.stored, facets;
    if (model->parts->has_lobe || model->set->incidence_count < 2) return;
    SurfaceAxes roughness = roughness_of(model);
    double n = haze_index(model, roughness);
    facets = *s;
    facets.beyond = PANEL_BEYOND_SLOPES;
    facets.roughness[0] = roughness.xx;
    facets.roughness[1] = roughness.xy;
    facets.roughness[2] = roughness.yy;
    if (n > 0) facets.refractive_index = (float)n;
    if (beyond_misses(model, &facets) < MUST_HELP * beyond_misses(model, s)) *s = facets;
}

static void note_beyond(const ReflectionModel *model, FitNotes *notes) {
    const PanelSurfaceStored *s = &model->surface.stored;
    if (s->mirror_index > 0)
        fit_note(notes,
                 "the mirror part beyond the measured incidences is that of a bare face "
                 "of index %.3f",
                 (double)s->mirror_index);
    if (s->beyond == PANEL_BEYOND_SLOPES)
        fit_note(notes,
                 "the haze beyond the measured incidences is that of facets of index "
                 "%.3f and roughness (GGX) %.3f along phi 0, %.3f along phi 90: it moves with "
                 "their slopes, and they mask each other",
                 (double)s->refractive_index, sqrt((double)s->roughness[0]),
                 sqrt((double)s->roughness[2]));
}

void reflection_surface_choose(ReflectionModel *model, FitNotes *notes) {
    model->surface = (ReflectionSurface){{0}, {{0, 0, 0}, {0, 0, 0}, 0, false}};
    if (model->set->azimuth_count > 1 && !(model->options->frame_exponent > 0))
        choose_coordinates(model, notes);
    model->surface.stored.refractive_index = (float)REFLECTION_REFRACTIVE_INDEX;
    if (model->parts->has_mirror) choose_mirror(model);
    choose_beyond(model);
    note_beyond(model, notes);
}
