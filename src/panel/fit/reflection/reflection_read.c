/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_read.h"

#include <math.h>
#include <stdlib.h>

#include "base/arena.h"
#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/peak_window.h"
#include "panel/query/panel_file.h"
#include "panel/query/panel_reach.h"
#include "panel/set/angle_table.h"

/* ---- how far it was measured ------------------------------------------------------------ */

/* The hull of a table's directions, as panel_reach.h keeps it.
 *
 * About the rows' mean direction, with angles to it as radii, their convex hull is taken. Its
 * edges are lines there, or, where they turn by less than 60 degrees, linear in the turn: rings
 * of eight directions are round. */

#define ROUND (PI / 3) /* edges of smaller turns are linear in the turn */
#define ROOM_DEG 2.0f  /* a cone is held if it lacks no more than this */
#define CONE_SIDES 72

typedef struct HullPoint {
    double x, y, angle, turn;
} HullPoint;

static int order_by_x(const void *a, const void *b) {
    const HullPoint *p = a, *q = b;
    double rise = p->x != q->x ? p->x - q->x : p->y - q->y;
    return (rise > 0) - (rise < 0);
}

static double turned_left(const HullPoint *a, const HullPoint *b, const HullPoint *c) {
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

/* Andrew's monotone chain: anticlockwise; points are sorted. */
static int convex_hull(HullPoint *point, int count, HullPoint *hull) {
    int n = 0;
    qsort(point, (size_t)count, sizeof *point, order_by_x);
    for (int side = 0; side < 2; side++) {
        int begin = n;
        for (int i = 0; i < count; i++) {
            const HullPoint *next = &point[side ? count - 1 - i : i];
            while (n > begin + 1 && turned_left(&hull[n - 2], &hull[n - 1], next) <= 0) n--;
            hull[n++] = *next;
        }
        n--; /* the other side begins with it */
    }
    return n;
}

/* ---- the centre -------------------------------------------------------------------------- */

static void set_centre(const AngleTable *table, bool mirrored, PanelReachStored *out) {
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < table->rows; i++) {
        Vec3 d = table_row_direction(table, i);
        sum[0] += (double)d.x, sum[1] += mirrored ? 0 : (double)d.y, sum[2] += (double)d.z;
    }
    double theta = atan2_d(hypot_d(sum[0], sum[1]), sum[2]), phi = atan2_d(sum[1], sum[0]);
    out->theta = (uint16_t)rint(fmin(1, theta / (0.5 * PI)) * 65535);
    out->phi = (uint16_t)(int)rint((phi < 0 ? phi + 2 * PI : phi) / (2 * PI) * 65536);
}

static HullPoint point_at(const Vec3 axis[3], double theta, double phi) {
    PanelReachPlace at = panel_reach_place(axis, table_direction(theta, phi));
    double angle = (double)at.angle, turn = (double)at.turn;
    return (HullPoint){angle * cos_d(turn), angle * sin_d(turn), angle, turn};
}

/* ---- the edge ---------------------------------------------------------------------------- */

/* Where the edge from a to b is at a turn, which it spans. */
static double edge_at(const HullPoint *a, const HullPoint *b, double turn) {
    double span = b->turn - a->turn, from = turn - a->turn;
    span -= 2 * PI * floor(span / (2 * PI));
    from -= 2 * PI * floor(from / (2 * PI));
    if (!(from <= span) || !(span > 0)) return 0;
    if (span < ROUND) return a->angle + (b->angle - a->angle) * from / span;
    double across = cos_d(turn) * (b->y - a->y) - sin_d(turn) * (b->x - a->x);
    return across != 0 ? fmax(0, (a->x * b->y - a->y * b->x) / across) : 0;
}

/* Sides in units of the largest, none rounded down; some room is left for corners. */
#define CORNERS 1.02
static void store_sides(const double side[PANEL_REACH_SIDES], PanelReachStored *out) {
    double most = 1e-3;
    for (int k = 0; k < PANEL_REACH_SIDES; k++) most = fmax(most, side[k]);
    out->most = (uint16_t)fmin(65535, ceil(CORNERS * most / PI * 65535));
    for (int k = 0; k < PANEL_REACH_SIDES; k++)
        out->side[k] = (uint8_t)fmin(255, ceil(side[k] / (double)panel_reach_unit(out)));
}

/* Between two sides a corner of the hull may stand out: both are raised to hold it. */
static void hold_point(const HullPoint *point, PanelReachStored *out) {
    double at = point->turn * PANEL_REACH_SIDES / (2 * PI);
    int side = (int)at % PANEL_REACH_SIDES, next = (side + 1) % PANEL_REACH_SIDES;
    double edge = (double)panel_reach_edge(out, (float)point->turn);
    if (point->angle <= edge) return;
    int more = (int)ceil((point->angle - edge) / (double)panel_reach_unit(out) + 1e-3);
    out->side[side] = (uint8_t)fmin(255, out->side[side] + more);
    out->side[next] = (uint8_t)fmin(255, out->side[next] + more);
}

/* mirrored: directions at -phi count as those at phi. */
static PanelReachStored reflection_reach(const AngleTable *table, bool mirrored, Arena scratch) {
    PanelReachStored out = {0};
    Vec3 axis[3];
    HullPoint *point = ARENA_NEW(&scratch, HullPoint, 2 * table->rows);
    HullPoint *hull = ARENA_NEW(&scratch, HullPoint, 4 * table->rows + 1);
    double side[PANEL_REACH_SIDES] = {0};
    int count = 0;
    set_centre(table, mirrored, &out);
    panel_reach_axes(&out, axis);
    for (int i = 0; i < table->rows; i++) {
        double theta = (double)table->theta[i], phi = (double)table->phi[i];
        point[count++] = point_at(axis, theta, phi);
        if (mirrored) point[count++] = point_at(axis, theta, -phi);
    }
    count = convex_hull(point, count, hull);
    for (int k = 0; k < PANEL_REACH_SIDES; k++)
        for (int i = 0; i < count; i++)
            side[k] = fmax(
                side[k], edge_at(&hull[i], &hull[(i + 1) % count], 2 * PI * k / PANEL_REACH_SIDES));
    store_sides(side, &out);
    for (int i = 0; i < count; i++) hold_point(&hull[i], &out);
    return out;
}

/* All directions up to an angle. */
static PanelReachStored reflection_reach_cone(float theta) {
    PanelReachStored out = {0};
    double side[PANEL_REACH_SIDES];
    for (int k = 0; k < PANEL_REACH_SIDES; k++) side[k] = (double)theta;
    store_sides(side, &out);
    return out;
}

/* Does it hold the cone, but for what lies between two samples of its last ring? */
static bool reflection_reach_is_cone(const PanelReachStored *reach, float theta) {
    float inner = fmaxf(0, theta - (float)radians_from_degrees((double)ROOM_DEG));
    for (int k = 0; k < CONE_SIDES; k++) {
        Vec3 d = table_direction((double)inner, 2 * PI * k / CONE_SIDES);
        if (panel_reach_room(reach, d) < 0) return false;
    }
    return true;
}

#define LEAST_SHARE 1e-6 /* of a table's largest value: values below it are held there */
#define LEAST_VALUE 1e-8 /* sr^-1 */
#define EDGE_CELLS 3.0f  /* so far beyond it places still count: triangles reach across */
#define CHUNK 512        /* places that one thread reads at a time */
/* what a logarithm may change by beyond the last ring: held there at once, its kink takes eight
 * times the time of a fit to code */
#define STEEPEST 0.5f
#define FILLED_SHARE 0.05 /* of a grid's cells: with more of them it is no grid */

double reflection_read_least(const AngleTable *table) {
    double most = 0;
    size_t count = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < count; i++) most = fmax(most, (double)table->value[i]);
    return fmax(LEAST_VALUE, LEAST_SHARE * most);
}

static int count_below(const AngleTable *table, double least) {
    int count = 0;
    size_t values = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < values; i++) count += (double)table->value[i] < least;
    return count;
}

static float *log_cells(ReflectionModel *model, int table) {
    const DirectionGrid *grid = &model->grid[table];
    float *cells = direction_grid_cells(grid, model->parts->haze[table].value, model->wavelengths,
                                        model->arena);
    size_t count = (size_t)(grid->thetas * grid->phis) * (size_t)model->wavelengths;
    float least = (float)model->least_value[table];
    for (size_t i = 0; i < count; i++) cells[i] = log_f(fmaxf(cells[i], least));
    return cells;
}

/* ---- guides between rows ----------------------------------------------------------------- */

#define GUIDE_MISS 0.02 /* relative: rows that miss less between them need no guide */
#define WINDOW_STEPS 3.0

/* The guide that a peak's model makes. */
static ReflectionGuide guide_of(const PeakMirror *peak, double incidence) {
    const PeakModel *model = &peak->model;
    return (ReflectionGuide){.incidence = incidence,
                             .width = model->width,
                             .power = model->power,
                             .a = model->a,
                             .lambertian = fmax(1e-9, peak->lambertian),
                             .reach = WINDOW_STEPS * peak->spacing.widest};
}

double reflection_guide_log(const ReflectionGuide *guide, double theta, double phi) {
    double b2 = peak_window_squares(theta, phi, guide->incidence);
    double haze = guide->a * pow_d(1 + b2 / (guide->width * guide->width), -guide->power);
    return log_d(haze + guide->lambertian);
}

/* A direction between cells; the middle channel is what is compared there. */
typedef struct GuideCheck {
    const DirectionGrid *grid;
    const float *cells;
    int channels;
    ReflectionGuide *guide;
} GuideCheck;

/* Both ways of reading, from the same cells. */
static void compare_at(const GuideCheck *at, double theta, double phi) {
    const DirectionGrid *grid = at->grid;
    GridTaps taps;
    double plain = 0, rest = 0;
    if (peak_window_angle(theta, phi, at->guide->incidence) > at->guide->reach) return;
    direction_grid_taps(grid, (float)theta, (float)phi, &taps);
    for (int i = 0; i < taps.count; i++) {
        int cell = taps.cell[i];
        double log =
            (double)at->cells[(size_t)cell * (size_t)at->channels + (size_t)at->channels / 2];
        plain += (double)taps.weight[i] * log;
        rest += (double)taps.weight[i] *
                (log - reflection_guide_log(at->guide, (double)grid->theta[cell / grid->phis],
                                            (double)grid->phi[cell % grid->phis]));
    }
    double guided = rest + reflection_guide_log(at->guide, theta, phi);
    at->guide->miss = fmax(at->guide->miss, fabs(exp_d(fmin(5, plain - guided)) - 1));
}

/* Compares reading halfway between neighbouring rings and azimuths, from cells that hold
 * logarithms, with and without the guide, and decides; the middle channel is compared. */
static void choose_guide(const DirectionGrid *grid, const float *cells, int channels,
                         ReflectionGuide *guide) {
    GuideCheck at = {grid, cells, channels, guide};
    for (int i = 0; i + 1 < grid->thetas; i++)
        for (int k = 0; k < grid->phis; k++) {
            double theta = (double)grid->theta[i], phi = (double)grid->phi[k], turn = phi;
            double outer = 0.5 * (theta + (double)grid->theta[i + 1]);
            if (k + 1 < grid->phis) turn = 0.5 * (phi + (double)grid->phi[k + 1]);
            compare_at(&at, outer, phi);
            compare_at(&at, theta, turn);
            compare_at(&at, outer, turn);
        }
    guide->is_used = guide->miss > GUIDE_MISS;
}

#define GUIDE_REST 0.02   /* relative, rms: a model that misses rows by more is no guide */
#define GUIDE_SPREAD 0.25 /* relative: nor is one whose peak is anybody's guess */

/* The peak's model, where it is one that rows do determine. */
static bool find_guide(const ReflectionModel *model, int table, ReflectionGuide *guide) {
    const PeakMirror *peak = model->parts->peak ? &model->parts->peak[table] : NULL;
    if (!peak || !peak->range.has_model || !(peak->model.a > 0) ||
        peak->range.spread > GUIDE_SPREAD ||
        peak->rest > fmax(GUIDE_REST, 2 * model->parts->noise[table]))
        return false;
    *guide = guide_of(peak, reflection_model_incidence(model, table));
    return true;
}

/* Where rows are too far apart for the peak, cells hold what they have over the guide. */
static void guide_cells(ReflectionModel *model, int table) {
    const DirectionGrid *grid = &model->grid[table];
    ReflectionGuide *guide = &model->guide[table];
    float *cells = model->cells[table];
    if (!find_guide(model, table, guide)) return;
    choose_guide(grid, cells, model->wavelengths, guide);
    for (int c = 0; c < grid->thetas * grid->phis && guide->is_used; c++) {
        float log = (float)reflection_guide_log(guide, (double)grid->theta[c / grid->phis],
                                                (double)grid->phi[c % grid->phis]);
        for (int w = 0; w < model->wavelengths; w++)
            cells[(size_t)c * (size_t)model->wavelengths + (size_t)w] -= log;
    }
}

/* ---- tables without a grid's order ------------------------------------------------------- */

static bool is_scattered(const DirectionGrid *grid) {
    return grid->is_scattered || grid->filled_cells > FILLED_SHARE * grid->thetas * grid->phis;
}

/* The surface through a table's logarithms; over the guide wherever there is one. */
static void scatter_table(ReflectionModel *model, int t, bool mirrored) {
    const AngleTable *table = &model->parts->haze[t];
    ReflectionGuide *guide = &model->guide[t];
    size_t channels = (size_t)model->wavelengths;
    float *logs = ARENA_NEW(model->arena, float, (size_t)table->rows *channels);
    float least = (float)model->least_value[t];
    guide->is_used = find_guide(model, t, guide);
    for (int i = 0; i < table->rows; i++) {
        float log = 0;
        if (guide->is_used)
            log =
                (float)reflection_guide_log(guide, (double)table->theta[i], (double)table->phi[i]);
        for (size_t k = (size_t)i * channels; k < (size_t)(i + 1) * channels; k++)
            logs[k] = log_f(fmaxf(table->value[k], least)) - log;
    }
    model->scatter[t] =
        scatter_surface_make(table, mirrored, logs, model->wavelengths, model->arena);
    model->reach[t] = reflection_reach(table, mirrored, *model->arena);
    model->parts->noise[t] = fmax(model->parts->noise[t], scatter_surface_noise(model->scatter[t]));
}

/* What the samples of all tables surround counts where some do not surround the cone. */
static void find_reach(ReflectionModel *model) {
    float edge = 0.5f * PI_F;
    for (int t = 0; t < model->tables; t++) edge = fminf(edge, model->parts->haze[t].theta_max);
    for (int t = 0; t < model->tables; t++) {
        if (!model->scatter[t])
            model->reach[t] = reflection_reach_cone(model->parts->haze[t].theta_max);
        model->has_reach |= !reflection_reach_is_cone(&model->reach[t], edge);
    }
}

void reflection_read_tables(ReflectionModel *model) {
    bool mirrored = model->set->azimuth_count < 2;
    model->grid = ARENA_NEW(model->arena, DirectionGrid, model->tables);
    model->cells = ARENA_NEW(model->arena, float *, model->tables);
    model->least_value = ARENA_NEW(model->arena, double, model->tables);
    model->guide = ARENA_NEW(model->arena, ReflectionGuide, model->tables);
    model->scatter = ARENA_NEW(model->arena, const ScatterSurface *, model->tables);
    model->reach = ARENA_NEW(model->arena, PanelReachStored, model->tables);
    model->masked = 0;
    for (int t = 0; t < model->tables; t++) {
        const AngleTable *table = &model->parts->haze[t];
        model->least_value[t] = reflection_read_least(table);
        model->masked += count_below(table, model->least_value[t]);
        if (t > 0 && angle_table_same_rows(table, &model->parts->haze[t - 1]))
            model->grid[t] = model->grid[t - 1];
        else direction_grid_build(table, mirrored, model->arena, &model->grid[t]);
        model->cells[t] = log_cells(model, t);
        if (is_scattered(&model->grid[t])) scatter_table(model, t, mirrored);
        else guide_cells(model, t);
    }
    find_reach(model);
}

static void read_at(const ReflectionModel *model, int table, float theta, float phi, float *logs) {
    GridTaps taps;
    if (model->scatter[table]) {
        scatter_surface_read(model->scatter[table], table_direction((double)theta, (double)phi),
                             logs);
    } else {
        direction_grid_taps(&model->grid[table], theta, phi, &taps);
        direction_grid_read(&taps, model->cells[table], model->wavelengths, logs);
    }
    if (!model->guide[table].is_used) return;
    float log = (float)reflection_guide_log(&model->guide[table], (double)theta, (double)phi);
    for (int w = 0; w < model->wavelengths; w++) logs[w] += log;
}

float reflection_read_logs(const ReflectionModel *model, int table, Vec3 outer, float *logs) {
    const DirectionGrid *grid = &model->grid[table];
    bool is_scattered = model->scatter[table] != NULL;
    if (is_scattered) outer = panel_reach_inside(&model->reach[table], outer);
    float across = sqrtf(outer.x * outer.x + outer.y * outer.y);
    float theta = atan2_f(across, fmaxf(outer.z, 0)), phi = atan2_f(outer.y, outer.x);
    float last = is_scattered ? theta : grid->theta[grid->thetas - 1];
    read_at(model, table, fminf(theta, last), phi, logs);
    float beyond = theta - last, inside[MEASUREMENT_WAVELENGTHS_MAX];
    if (beyond <= 1e-5f) return 0;
    read_at(model, table, fmaxf(0, last - beyond), phi, inside);
    for (int w = 0; w < model->wavelengths; w++)
        logs[w] += fminf(STEEPEST, fmaxf(-STEEPEST, logs[w] - inside[w]));
    return beyond;
}

/* ---- all places -------------------------------------------------------------------------- */

/* ln (f / F) of a table at a place. */
static void read_place(ReflectionModel *model, const ReflectionView *view, int table, int place) {
    float *row = reflection_model_row(model, model->value, place, table);
    Vec3 outer = specular_frame_outer(&view->frame, model->direction[place]);
    float beyond = reflection_read_logs(model, table, outer, row);
    float offset = (float)log_d(view->fresnel);
    for (int w = 0; w < model->wavelengths; w++) row[w] -= offset;
    /* so far behind the last ring that no triangle reaches back */
    float edge = EDGE_CELLS * 0.5f * PI_F / (float)(1 << model->lattice.level);
    model->is_free[(size_t)place * (size_t)model->tables + (size_t)table] = beyond > edge;
}

static void read_chunk(void *context, int item, int worker) {
    ReflectionModel *model = context;
    int last = (item + 1) * CHUNK < model->places ? (item + 1) * CHUNK : model->places;
    (void)worker;
    for (int t = 0; t < model->tables; t++) {
        ReflectionView view = reflection_view(model, t);
        for (int i = item * CHUNK; i < last; i++) read_place(model, &view, t, i);
    }
}

void reflection_read_places(ReflectionModel *model, int level) {
    model->lattice.level = level;
    model->geodesic = geodesic_create(level, model->arena);
    bool is_vertex = model->options->basis == FIT_VERTEX;
    model->places =
        is_vertex ? (int)vertex_count(model->lattice) : model->lattice.octants << 2 * level;
    model->direction = ARENA_NEW(model->arena, Vec3, model->places);
    if (is_vertex) vertex_directions(model->lattice, model->direction);
    for (int i = 0; i < model->places && !is_vertex; i++)
        model->direction[i] = geodesic_center(level, (uint32_t)i);
    size_t rows = (size_t)model->places * (size_t)model->tables;
    model->value = ARENA_NEW(model->arena, float, rows *(size_t)model->wavelengths);
    model->is_free = ARENA_NEW(model->arena, bool, rows);
    model->tolerance = ARENA_NEW(model->arena, float, rows);
    parallel_for(model->options->threads, (model->places + CHUNK - 1) / CHUNK, read_chunk, model);
}
