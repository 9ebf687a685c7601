/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/grey_inversion.h"

#include <math.h>

#include "base/parallel.h"
#include "base/units.h"

#define SIDE 121 /* grid of the map: a degree and a half a step */

GreyLevels grey_levels(const PlotData *data) {
    GreyLevels out = {.count = 0};
    if (!data->emits || data->is_white_only) return out;
    int measured = panel_info_levels(data->source.panel, 1, out.code + 1);
    out.count = measured > 1 ? measured + 1 : 0;
    return out;
}

static GreyInversion inversion_at(const PlotData *data, const GreyLevels *levels, double theta,
                                  double phi) {
    GreyInversion out = {.theta = theta, .phi = phi};
    double brightest = 0, code = 0; /* of the levels before */
    for (int i = 0; i < levels->count; i++) {
        float c = (float)levels->code[i];
        double light = panel_figure_luminance(data->source.panel, theta, phi, (float[3]){c, c, c});
        double share = brightest > 0 ? 1 - light / brightest : 0;
        if (share > out.share) out.share = share, out.low = code, out.high = levels->code[i];
        if (light > brightest) brightest = light, code = levels->code[i];
    }
    return out;
}

static bool inverts(const PlotData *data, const GreyLevels *levels, double theta, double phi) {
    return inversion_at(data, levels, theta, phi).share >= GREY_INVERSION_LEAST;
}

/* Between a theta without and one with it. */
static double where_it_begins(const PlotData *data, const GreyLevels *levels, double low,
                              double high, double phi) {
    while (high - low > radians_from_degrees(0.005)) {
        double middle = 0.5 * (low + high);
        if (inverts(data, levels, middle, phi)) high = middle;
        else low = middle;
    }
    return high;
}

GreyInversion grey_inversion_along(const PlotData *data, const GreyLevels *levels, double phi,
                                   double *first) {
    GreyInversion most = {.phi = phi};
    double step = radians_from_degrees(0.5), theta = 0, before = 0;
    *first = NAN;
    for (;; before = theta, theta = fmin(theta + step, data->cone)) {
        GreyInversion one = inversion_at(data, levels, theta, phi);
        if (one.share > most.share) most = one;
        if (isnan(*first) && one.share >= GREY_INVERSION_LEAST)
            *first = theta > 0 ? where_it_begins(data, levels, before, theta, phi) : 0;
        if (theta >= data->cone) break;
    }
    return most.share >= GREY_INVERSION_LEAST ? most : (GreyInversion){.phi = phi};
}

GreyInversion grey_inversion_most(const PlotData *data, const GreyLevels *levels) {
    GreyInversion most = {.share = 0};
    const json_t *emission = json_object_get(data->source.report, "emission");
    const json_t *few = json_object_get(emission, "azimuths_deg");
    size_t count = json_array_size(few) ? json_array_size(few) : 72;
    for (size_t i = 0; i < count; i++) {
        double unused, deg = few ? json_number_value(json_array_get(few, i)) : 5 * (double)i;
        double phi = radians_from_degrees(deg);
        GreyInversion one = grey_inversion_along(data, levels, phi, &unused);
        if (one.share > most.share) most = one;
    }
    return most;
}

/* ---- over the hemisphere ----------------------------------------------------------------- */

typedef struct InversionWork {
    const PlotData *data;
    const GreyLevels *levels;
    Field field;
} InversionWork;

static void sample_row(void *context, int row, int worker) {
    const InversionWork *work = context;
    (void)worker;
    for (int column = 0; column < SIDE; column++) {
        Vec3 d = field_direction(&work->field, row, column);
        double theta = atan2(hypot((double)d.x, (double)d.y), (double)d.z);
        double share =
            inversion_at(work->data, work->levels, theta, atan2((double)d.y, (double)d.x)).share;
        work->field.value[row * SIDE + column] =
            share >= GREY_INVERSION_LEAST ? (float)(100 * share) : 0;
    }
}

Field grey_inversion_field(const PlotData *data, const GreyLevels *levels, Arena *arena) {
    InversionWork work = {data, levels, field_new(SIDE, PI / 2, arena)};
    parallel_for(data->source.threads, SIDE, sample_row, &work);
    return work.field;
}
