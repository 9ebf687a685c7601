/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_axes.h"

#include <math.h>

#include "panel/fit/common/least_squares.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_view.h"
#include "panel/query/panel_reference.h"

#define CORE 4.0       /* rows above this part of the peak belong to the lobe's core */
#define NEAR_COS 0.86  /* the peak is looked for within 30 degrees of the mirror direction */
#define ROWS_LEAST 12
#define WIDTH 0.2      /* where no table shows a lobe */
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
    bool   is_near;
} LobeRow;

static LobeRow lobe_row(const AngleTable *table, int row, PanelFrameKind frame, Vec3 light)
{
    Vec3   local = table_row_direction(table, row);
    Vec3   wo = reflection_view_from_local(light, local);
    double scale = frame == PANEL_FRAME_COSINES ? 1 : 1 / (double)(light.z + wo.z), sum = 0;
    float  reference = panel_reference(frame, (float)REFLECTION_REFRACTIVE_INDEX, light, wo);
    for (int w = 0; w < table->channels; w++)
        sum += (double)table->value[(size_t)row * (size_t)table->channels + (size_t)w];
    double x = (double)(light.x + wo.x) * scale, y = (double)(light.y + wo.y) * scale;
    double spread = frame == PANEL_FRAME_SLOPES ? (1 + x * x + y * y) * (1 + x * x + y * y) : 1;
    float  cosine = light.z * wo.z - light.x * wo.x - light.y * wo.y; /* to the mirror image */
    return (LobeRow){x, y, sum / table->channels / (double)reference / spread,
                     (double)cosine > NEAR_COS};
}

/* M of one table: sqrt (peak / height) = a (1 + x^T M x) by least squares. */
static bool fit_table(const AngleTable *table, PanelFrameKind frame, Vec3 light, Symmetric *out)
{
    double matrix[16] = {0}, right[4] = {0}, peak = 0;
    int    count = 0;
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
    return right[0] > 0 && out->xx > 0 && out->yy > 0 &&
           out->xx * out->yy > out->xy * out->xy;
}

/* The matrix with its eigenvalues raised to a power; as widths, eigenvalue^-1/2 is held between
 * the narrowest and the widest. */
static SurfaceAxes raised(Symmetric m, double power)
{
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

static Symmetric lobe_matrix(const ReflectionModel *model, PanelFrameKind frame)
{
    Symmetric sum = {0, 0, 0}, one;
    int       count = 0;
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

SurfaceAxes reflection_axes_of_lobe(const ReflectionModel *model, PanelFrameKind frame)
{
    return raised(lobe_matrix(model, frame), 0.5);
}

SurfaceAxes reflection_axes_roughness(const ReflectionModel *model)
{
    return raised(lobe_matrix(model, PANEL_FRAME_SLOPES), -1);
}

float reflection_axes_reach(const ReflectionModel *model, PanelFrameKind frame,
                            SurfaceAxes axes)
{
    double most = 1;
    for (int t = 0; t < model->tables; t++) {
        const AngleTable *table = &model->parts->haze[t];
        Vec3 light = reflection_model_light(model->set, t);
        for (int i = 0; i < table->rows; i++) {
            LobeRow row = lobe_row(table, i, frame, light);
            double  x = (double)axes.xx * row.x + (double)axes.xy * row.y;
            double  y = (double)axes.xy * row.x + (double)axes.yy * row.y;
            most = fmax(most, hypot_d(x, y));
        }
    }
    return (float)(1.001 * most);
}
