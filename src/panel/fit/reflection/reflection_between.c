/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_between.h"

#include <math.h>

#include "base/mathd.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_read.h"
#include "panel/fit/reflection/reflection_spectra.h"
#include "panel/fit/reflection/reflection_view.h"

/* A table beside the tree. */
typedef struct BetweenCheck {
    const ReflectionModel *model;
    int            table;
    ReflectionView view;
    Tree           tree;
    double         worst;
} BetweenCheck;

static double tree_log(const BetweenCheck *check, Vec3 local)
{
    float component[PANEL_REFLECTION_COMPONENTS_MAX], logs[MEASUREMENT_WAVELENGTHS_MAX];
    tree_interpolate(&check->tree, reflection_view_stored(&check->view, local), component);
    reflection_spectra_logs(check->model, check->table, component, logs);
    return (double)logs[check->model->wavelengths / 2] +
           log_d(reflection_view_reference(&check->view, local));
}

static void compare(BetweenCheck *check, double theta, double phi)
{
    const ReflectionModel *model = check->model;
    const ReflectionGuide *guide = &model->guide[check->table];
    float logs[MEASUREMENT_WAVELENGTHS_MAX];
    Vec3  local = table_direction(theta, phi);
    if (peak_window_angle(theta, phi, guide->incidence) > guide->reach) return;
    if (reflection_read_logs(model, check->table, local, logs) > 0) return;
    double difference = tree_log(check, local) - (double)logs[model->wavelengths / 2];
    check->worst = fmax(check->worst, fabs(exp_d(fmin(5, difference)) - 1));
}

double reflection_between(const ReflectionModel *model, int table, Arena scratch)
{
    const DirectionGrid *grid = &model->grid[table];
    BetweenCheck check = {.model = model, .table = table,
                          .view = reflection_view(model, table)};
    const Geodesic *geodesic = geodesic_create(model->lattice.level, &scratch);
    Error err;
    if (!model->guide[table].is_used ||
        !tree_open(model->tree, tree_size(model->tree), geodesic, &check.tree, &err))
        return 0;
    compare(&check, model->guide[table].incidence, 0);
    for (int i = 0; i + 1 < grid->thetas; i++)
        for (int k = 0; k < grid->phis; k++) {
            double theta = (double)grid->theta[i], phi = (double)grid->phi[k], turn = phi;
            double outer = 0.5 * (theta + (double)grid->theta[i + 1]);
            if (k + 1 < grid->phis) turn = 0.5 * (phi + (double)grid->phi[k + 1]);
            compare(&check, outer, phi);
            compare(&check, theta, turn);
            compare(&check, outer, turn);
        }
    return check.worst;
}
