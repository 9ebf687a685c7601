/* SPDX-License-Identifier: Apache-2.0 */
#include "light/sky_model.h"

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"

#define ROWS (2 * SKY_MODEL_ROWS)

Vec3 sky_model_direction(float scene_azimuth, float elevation) {
    double c = cos_d((double)elevation);
    return vec3((float)(c * sin_d((double)scene_azimuth)), (float)sin_d((double)elevation),
                (float)(-c * cos_d((double)scene_azimuth)));
}

/* ---- building --------------------------------------------------------------------------- */

/* Elevations rise from the nadir to the horizon to the zenith, closest at the horizon. */
static void place_edges(SkyModel *model, double horizon) {
    for (int i = 0; i <= SKY_MODEL_ROWS; i++) {
        double share = (double)i / SKY_MODEL_ROWS, square = share * share;
        double above = horizon + (PI / 2 - horizon) * square;
        double below = horizon - (PI / 2 + horizon) * square;
        model->edge[SKY_MODEL_ROWS + i] = (float)sin_d(above);
        model->edge[SKY_MODEL_ROWS - i] = (float)sin_d(below);
    }
}

/* Mean luminance of a cell from 3 x 3 places inside. */
static double cell_luminance(const SkyModel *model, int row, int column) {
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            float t = ((float)i + 0.5f) / 3, u = ((float)column + ((float)j + 0.5f) / 3);
            float sine = lerpf(model->edge[row], model->edge[row + 1], t);
            float azimuth = 2 * PI_F * u / SKY_MODEL_COLUMNS;
            float elevation = (float)asin_d((double)sine);
            sum += (double)daylight_luminance(model->daylight, elevation, azimuth);
        }
    return sum / 9;
}

static void fill_row(void *context, int row, int worker) {
    SkyModel *model = context;
    double running = 0, cell[SKY_MODEL_COLUMNS];
    (void)worker;
    for (int j = 0; j < SKY_MODEL_COLUMNS; j++) running += cell[j] = cell_luminance(model, row, j);
    /* a hundredth evenly: a cell may be brighter than its nine places show */
    double even = 0.01 * running / SKY_MODEL_COLUMNS + 1e-12, total = running * 1.01 + 1e-9;
    double sum = 0;
    for (int j = 0; j < SKY_MODEL_COLUMNS; j++)
        model->cdf[row][j + 1] = (float)((sum += cell[j] + even) / total);
    model->cdf[row][SKY_MODEL_COLUMNS] = 1;
    model->row_cdf[row + 1] = (float)(total * (double)(model->edge[row + 1] - model->edge[row]));
}

static void sum_rows(SkyModel *model) {
    double total = 0, running = 0;
    for (int i = 0; i < ROWS; i++) total += (double)model->row_cdf[i + 1];
    for (int i = 0; i < ROWS; i++) {
        running += (double)model->row_cdf[i + 1];
        model->row_cdf[i + 1] = (float)(running / total);
    }
    model->row_cdf[ROWS] = 1;
}

static DaylightInput input_of(const Environment *environment) {
    DaylightInput input = environment->daylight;
    input.threads = parallel_default_threads();
    input.has_sun = environment->has_sun;
    input.sun_azimuth = (double)environment->sun_azimuth;
    input.sun_elevation = (double)environment->sun_elevation;
    if (environment->has_sun) input.sun_lux = (double)environment->sun_illuminance_lx;
    return input;
}

bool sky_model_build(const Environment *environment, float turn, Arena *arena, const SkyModel **out,
                     Error *err) {
    Daylight *daylight = arena_alloc(arena, sizeof *daylight, 64, 1);
    SkyModel *model = ARENA_NEW(arena, SkyModel, 1);
    DaylightInput input = input_of(environment);
    if (!daylight_build(&input, arena, daylight, err)) return false;
    model->daylight = daylight;
    model->turn = turn;
    model->is_polarised = input.kind == DAYLIGHT_CLEAR;
    if (model->is_polarised)
        model->sun = sky_model_direction((float)daylight->sun_azimuth - turn,
                                         (float)daylight->sunlight.atmosphere.input.sun_elevation);
    place_edges(model, daylight->horizon);
    parallel_for(input.threads, ROWS, fill_row, model);
    sum_rows(model);
    *out = model;
    return true;
}

/* ---- queries ---------------------------------------------------------------------------- */

/* The largest i with value[i] <= x, 0 <= i < count. */
static int interval(const float *value, int count, float x) {
    int low = 0, high = count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (value[middle] <= x) low = middle;
        else high = middle;
    }
    return low;
}

static float cell_pdf(const SkyModel *model, int row, int column) {
    float share = (model->row_cdf[row + 1] - model->row_cdf[row]) *
                  (model->cdf[row][column + 1] - model->cdf[row][column]);
    float area = (model->edge[row + 1] - model->edge[row]) * (2 * PI_F / SKY_MODEL_COLUMNS);
    return area > 0 ? share / area : 0;
}

/* Compass azimuth in turns, [0, 1). */
static float azimuth_turns(const SkyModel *model, Vec3 d) {
    float turns = (atan2_f(d.x, -d.z) + model->turn) * (0.5f * INV_PI_F);
    turns -= floorf(turns);
    return turns < 1 ? turns : 0;
}

static float elevation_of(Vec3 d) {
    return atan2_f(d.y, safe_sqrtf(d.x * d.x + d.z * d.z));
}

static float pdf_at(const SkyModel *model, float turns, float height) {
    int column = (int)(turns * SKY_MODEL_COLUMNS);
    if (column > SKY_MODEL_COLUMNS - 1) column = SKY_MODEL_COLUMNS - 1;
    return cell_pdf(model, interval(model->edge, ROWS, height), column);
}

float sky_model_pdf(const SkyModel *model, Vec3 direction) {
    return pdf_at(model, azimuth_turns(model, direction), direction.y);
}

Spectrum sky_model_seen(const SkyModel *model, Vec3 direction, const Wavelengths *wavelengths,
                        float *pdf) {
    float turns = azimuth_turns(model, direction);
    *pdf = pdf_at(model, turns, direction.y);
    return daylight_radiance(model->daylight, elevation_of(direction), 2 * PI_F * turns,
                             wavelengths);
}

Spectrum sky_model_polarisation(const SkyModel *model, Vec3 direction,
                                const Wavelengths *wavelengths) {
    return daylight_polarisation(model->daylight, elevation_of(direction),
                                 2 * PI_F * azimuth_turns(model, direction), wavelengths);
}

Vec3 sky_model_sample(const SkyModel *model, float u0, float u1) {
    int row = interval(model->row_cdf, ROWS, u1);
    int column = interval(model->cdf[row], SKY_MODEL_COLUMNS, u0);
    float height = model->row_cdf[row + 1] - model->row_cdf[row];
    float width = model->cdf[row][column + 1] - model->cdf[row][column];
    float t = height > 0 ? (u1 - model->row_cdf[row]) / height : 0.5f;
    float u = width > 0 ? (u0 - model->cdf[row][column]) / width : 0.5f;
    /* a hair inside, so that rounding does not leave the cell */
    t = clampf(t, 1e-5f, 1 - 1e-5f), u = clampf(u, 1e-5f, 1 - 1e-5f);
    float y = lerpf(model->edge[row], model->edge[row + 1], t), sine, cosine;
    float turns = ((float)column + u) / SKY_MODEL_COLUMNS - model->turn * (0.5f * INV_PI_F);
    float across = safe_sqrtf(1 - y * y);
    sincos_turns(turns - floorf(turns), &sine, &cosine);
    return vec3(across * sine, y, -across * cosine);
}
