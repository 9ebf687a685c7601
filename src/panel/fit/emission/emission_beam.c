/* SPDX-License-Identifier: Apache-2.0 */
/* A narrow beam of the emission: its centre, its width along two axes and its profiles
 * (panel_beam.h) by least squares, beside a cubic background, on the samples around it. */
#include "panel/fit/emission/emission_beam.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/shape/least_squares.h"
#include "panel/shape/panel_beam.h"
#include "panel/query/panel_turn.h"

#define WINDOW 1.3        /* of the samples that determine it, over a beam's reach */
#define CLIMB_DEG 3.0     /* from the worst sample to the top */
#define NARROW_DEG 1.5    /* a tree resolves what is wider at half its (log) height */
#define LEAST_HEIGHT 0.05 /* of ln E */
#define LEAST_SAMPLES 8   /* above half the height */
#define EVEN_DEG 0.1      /* samples count by their share of ln r, nearer than this of r^2 */
#define WORTH 0.1         /* weighted squares that a beam may leave of what was there */
#define ELLIPSE_WORTH 0.7 /* and an ellipse of what a circle leaves */
#define BACKGROUND 9      /* terms */
#define UNKNOWNS_MAX (PANEL_BEAM_KNOTS_MAX + BACKGROUND)
#define EVEN_SHARE 1e-5 /* of the samples' weight: third differences against it */
#define CURVATURE 0.1   /* second differences of coefficients that are expected */
#define CORE_LEAST_DEG 0.01
#define CORE_MOST_DEG 2.0
#define CORE_STEPS 1.5 /* of the samples: less, and none would fix the first knots */
#define TURN_MOST 60.0 /* of narrow^2 */
#define KNOTS_LEAST 4  /* of a profile: a cubic spline has no fewer */
#define RIDGE 1e-12    /* of the samples' weight, on the diagonal: no unknown is free */

/* The search: a first core with a first walk of the centre, then the core that fits, then the
 * ellipse. Steps grow after a gain and shrink without one. */
#define FIRST_DEG 0.3     /* the first core, and the centre's first steps */
#define FIRST_END 0.02    /* of them: where the first walk ends */
#define CENTRE_STEP 0.2   /* of the core: the centre's steps in the second walk */
#define ELLIPSE_STEP 0.05 /* of the core: in the third, which turns, too, by */
#define TURN_STEP 0.3     /* of narrow^2 */
#define WALK_END 5e-4     /* of the core: where both end */
#define WALK_ROUNDS 60
#define STEP_GROWS 1.5
#define STEP_SHRINKS 0.5

#define HALF_STEP 0.02                  /* of ln(1 + r^2): how closely half the height is sought */
#define STORED_STEP 0.25f               /* of the tree's steps: of a stored profile */
#define SCRATCH_BYTES ((size_t)1 << 30) /* address space: what is not touched costs nothing */

/* The samples around a beam in the tangent plane of a centre, in units of chord. */
typedef struct BeamWindow {
    const EmissionModel *model;
    int count;
    int *row;
    double *x, *y, *z;       /* along the tangents and the centre, less the centre */
    double *weight, *signal; /* signal: ln E of one channel */
    double total;
    double step;  /* chord from the centre to the next sample */
    double reach; /* chord, of a beam */
    Vec3 centre;
    Frame frame;
} BeamWindow;

/* Unknowns of the search: the shift of the centre (chord), the ellipse as narrow^2 times cos
 * and sin of twice its azimuth, the core (chord). */
typedef struct BeamShape {
    double shift[2], turn[2];
    double core;
} BeamShape;

typedef struct BeamEquations {
    int knots, unknowns;
    double matrix[UNKNOWNS_MAX * UNKNOWNS_MAX]; /* lower half */
} BeamEquations;

/* ---- the samples ------------------------------------------------------------------------ */

/* The Y channel that is brightest at a row. */
static int bright_channel(const EmissionSamples *s, int row) {
    int best = 1;
    size_t at = (size_t)row * (size_t)s->channels;
    for (int c = 1; c < s->channels && (s->black < 0 || c < s->black); c += 3)
        if (s->total[at + (size_t)c] > s->total[at + (size_t)best]) best = c;
    return best;
}

static double signal_of(const EmissionModel *model, int row, int channel) {
    int n = model->rank->components;
    double sum = 0;
    float score[PANEL_COMPONENTS_MAX];
    emission_model_bare_scores(model, row, score);
    for (int k = 0; k < n; k++)
        sum += (double)model->rank->loading[channel * n + k] * (double)score[k];
    return sum;
}

static double chord_of(double degrees) {
    return 2 * sin_d(radians_from_degrees(degrees) / 2);
}

static double distance_of(Vec3 a, Vec3 b) {
    Vec3 v = vec3_sub(a, b);
    return sqrt((double)vec3_dot(v, v));
}

/* The brightest sample around, step by step. */
static int climb(const EmissionModel *model, int row, int channel) {
    const EmissionSamples *s = model->samples;
    for (int step = 0; step < 8; step++) {
        int best = row;
        double most = signal_of(model, row, channel);
        for (int i = 0; i < s->rows; i++) {
            if (distance_of(s->direction[i], s->direction[row]) > chord_of(CLIMB_DEG)) continue;
            double f = signal_of(model, i, channel);
            if (f > most) most = f, best = i;
        }
        if (best == row) break;
        row = best;
    }
    return row;
}

static void gather(const EmissionModel *model, int top, double reach, Arena *arena,
                   BeamWindow *out) {
    const EmissionSamples *s = model->samples;
    size_t rows = (size_t)s->rows;
    *out = (BeamWindow){.model = model, .step = 2, .reach = reach, .centre = s->direction[top]};
    out->frame = frame_from_z(out->centre);
    out->row = ARENA_NEW(arena, int, rows);
    out->x = ARENA_NEW(arena, double, rows), out->y = ARENA_NEW(arena, double, rows);
    out->z = ARENA_NEW(arena, double, rows), out->weight = ARENA_NEW(arena, double, rows);
    out->signal = ARENA_NEW(arena, double, rows);
    double even = chord_of(EVEN_DEG);
    int channel = bright_channel(s, top);
    for (int i = 0; i < s->rows; i++) {
        Vec3 v = vec3_sub(s->direction[i], out->centre);
        double r = sqrt((double)vec3_dot(v, v));
        int at = out->count;
        if (r > WINDOW * reach) continue;
        if (i != top) out->step = fmin(out->step, r);
        out->row[at] = i;
        out->x[at] = (double)vec3_dot(v, out->frame.x);
        out->y[at] = (double)vec3_dot(v, out->frame.y);
        out->z[at] = (double)vec3_dot(v, out->centre);
        out->weight[at] = (double)model->rank->belief[i] * s->area[i] / (r * r + even * even);
        out->signal[at] = signal_of(model, i, channel);
        out->total += out->weight[at];
        out->count++;
    }
}

/* ---- least squares ---------------------------------------------------------------------- */

/* Distance from the shifted centre in units of the core, squared. */
static double squares_at(const BeamWindow *w, const BeamShape *shape, int i) {
    double a = shape->shift[0], b = shape->shift[1];
    double x = w->x[i] - a, y = w->y[i] - b, z = w->z[i] + (1 - sqrt(1 - a * a - b * b));
    double turn = hypot_d(shape->turn[0], shape->turn[1]);
    /* turn (x cos + y sin)^2 by the double angle */
    double along = 0.5 * (turn * (x * x + y * y) + shape->turn[0] * (x * x - y * y) +
                          2 * shape->turn[1] * x * y);
    return (x * x + y * y + z * z + along) / (shape->core * shape->core);
}

static int knots_for(const BeamWindow *w, double core) {
    double cores = w->reach / core;
    double knots = log_d(1 + cores * cores) / (double)PANEL_BEAM_STEP;
    return (int)fmin(PANEL_BEAM_KNOTS_MAX, fmax(KNOTS_LEAST, knots));
}

/* The numbers of a sample's equation: at most 4 of the beam, then the background. */
typedef struct BeamLine {
    int count;
    int at[4 + BACKGROUND];
    double value[4 + BACKGROUND];
} BeamLine;

/* The background has no term of r alone: that is the beam's. */
static void write_line(const BeamWindow *w, const BeamShape *shape, int knots, int i,
                       BeamLine *out) {
    double u = log_d(1 + squares_at(w, shape, i)) / (double)PANEL_BEAM_STEP;
    out->count = 0;
    if (u < knots) {
        float weight[4];
        panel_beam_weights((float)(u - floor(u)), weight);
        for (int k = 0; k < 4 && (int)u + k < knots; k++) {
            out->at[out->count] = (int)u + k;
            out->value[out->count++] = (double)weight[k];
        }
    }
    double unit = WINDOW * w->reach, x = w->x[i] / unit, y = w->y[i] / unit;
    double rr = x * x + y * y;
    const double term[BACKGROUND] = {1,
                                     x,
                                     y,
                                     x * x - y * y,
                                     x * y,
                                     x * rr,
                                     y * rr,
                                     x * (x * x - 3 * y * y),
                                     y * (3 * x * x - y * y)};
    for (int k = 0; k < BACKGROUND; k++) {
        out->at[out->count] = knots + k;
        out->value[out->count++] = term[k];
    }
}

static void add_line(const BeamLine *line, double weight, BeamEquations *out) {
    for (int a = 0; a < line->count; a++) {
        double *row = out->matrix + (size_t)line->at[a] * (size_t)out->unknowns;
        double w = weight * line->value[a];
        for (int b = 0; b <= a; b++) row[line->at[b]] += w * line->value[b];
    }
}

/* Adds weight times the squares of differences of neighbouring coefficients. */
static void add_differences(const double *difference, int count, double weight,
                            BeamEquations *out) {
    size_t n = (size_t)out->unknowns;
    for (int i = 0; i < out->knots; i++)
        for (int a = 0; a < count && i + a < out->knots; a++)
            for (int b = 0; b <= a; b++)
                out->matrix[(size_t)(i + a) * n + (size_t)(i + b)] +=
                    weight * difference[a] * difference[b];
}

/* Coefficients that samples do not determine, or only through noise, are even ones; the last
 * differences are against the zeros behind. */
static void add_smoothness(const BeamWindow *w, BeamEquations *out) {
    static const double second[3] = {1, -2, 1}, third[4] = {1, -3, 3, -1};
    double doubt = w->model->noise / CURVATURE;
    size_t n = (size_t)out->unknowns;
    add_differences(second, 3, w->total * doubt * doubt / (1 + w->count), out);
    add_differences(third, 4, w->total * EVEN_SHARE, out);
    for (size_t i = 0; i < n; i++) out->matrix[i * n + i] += w->total * RIDGE;
}

/* Weighted squares that a beam of a shape leaves of the signal. right: the solution. */
static double try_shape(const BeamWindow *w, const BeamShape *shape, BeamEquations *e,
                        double *right) {
    double squares = 0;
    e->knots = knots_for(w, shape->core);
    e->unknowns = e->knots + BACKGROUND;
    memset(e->matrix, 0, sizeof *e->matrix * (size_t)(e->unknowns * e->unknowns));
    memset(right, 0, sizeof *right * UNKNOWNS_MAX);
    for (int i = 0; i < w->count; i++) {
        BeamLine line;
        write_line(w, shape, e->knots, i, &line);
        add_line(&line, w->weight[i], e);
        for (int k = 0; k < line.count; k++)
            right[line.at[k]] += w->weight[i] * line.value[k] * w->signal[i];
        squares += w->weight[i] * w->signal[i] * w->signal[i];
    }
    add_smoothness(w, e);
    least_squares_factor(e->matrix, (size_t)e->unknowns);
    return fmax(0, squares - least_squares_solve(e->matrix, right, (size_t)e->unknowns));
}

/* ---- the search ------------------------------------------------------------------------- */

typedef struct BeamSearch {
    const BeamWindow *window;
    BeamEquations *equations;
    double right[UNKNOWNS_MAX];
    BeamShape best;
    double left; /* squares */
} BeamSearch;

static bool improve(BeamSearch *search, const BeamShape *shape) {
    double a = shape->shift[0], b = shape->shift[1];
    if (hypot_d(a, b) > chord_of(CLIMB_DEG) || hypot_d(shape->turn[0], shape->turn[1]) > TURN_MOST)
        return false;
    double left = try_shape(search->window, shape, search->equations, search->right);
    if (!(left < search->left)) return false;
    search->left = left;
    search->best = *shape;
    return true;
}

static void choose_core(BeamSearch *search) {
    BeamShape shape = search->best;
    double core = fmax(chord_of(CORE_LEAST_DEG), CORE_STEPS * search->window->step);
    for (; core < chord_of(CORE_MOST_DEG); core *= sqrt(2)) {
        shape.core = core;
        improve(search, &shape);
    }
}

static void walk(BeamSearch *search, int axes, double shift_step, double turn_step, double least) {
    double step[4] = {shift_step, shift_step, turn_step, turn_step};
    for (int round = 0; round < WALK_ROUNDS && step[0] + step[1] > 2 * least; round++)
        for (int axis = 0; axis < axes; axis++) {
            bool gained = false;
            for (int sign = -1; sign <= 1 && !gained; sign += 2) {
                BeamShape shape = search->best;
                double *at = axis < 2 ? &shape.shift[axis] : &shape.turn[axis - 2];
                *at += sign * step[axis];
                gained = improve(search, &shape);
            }
            step[axis] *= gained ? STEP_GROWS : STEP_SHRINKS;
        }
}

static void find_shape(BeamSearch *search) {
    double first = chord_of(FIRST_DEG);
    search->left = INFINITY;
    search->best = (BeamShape){.core = first};
    choose_core(search);
    walk(search, 2, first, 0, FIRST_END * first);
    choose_core(search);
    double core = search->best.core;
    walk(search, 2, CENTRE_STEP * core, 0, WALK_END * core);
    BeamSearch round = *search;
    walk(search, 4, ELLIPSE_STEP * core, TURN_STEP, WALK_END * core);
    if (search->left > ELLIPSE_WORTH * round.left) *search = round;
}

/* ---- is it one -------------------------------------------------------------------------- */

/* Squares that a smooth background alone leaves: a beam so wide that it is one. */
static double without_beam(const BeamWindow *w, BeamEquations *e, double *right) {
    BeamShape shape = {.core = w->reach};
    return try_shape(w, &shape, e, right);
}

static double profile_at(const double *coefficient, int knots, double u) {
    float weight[4];
    double at = u / (double)PANEL_BEAM_STEP, sum = 0;
    panel_beam_weights((float)(at - floor(at)), weight);
    for (int k = 0; k < 4 && (int)at + k < knots; k++)
        sum += (double)weight[k] * coefficient[(int)at + k];
    return sum;
}

/* Narrow, high, and determined by more than a few samples. */
static bool is_beam(const BeamSearch *search, double before, double *width) {
    const BeamWindow *w = search->window;
    int knots = knots_for(w, search->best.core), inside = 0;
    double top = profile_at(search->right, knots, 0), u = 0;
    if (!(search->left < WORTH * before) || top < LEAST_HEIGHT) return false;
    while (profile_at(search->right, knots, u) > 0.5 * top) u += HALF_STEP;
    double half = exp_d(u) - 1;
    for (int i = 0; i < w->count; i++) inside += squares_at(w, &search->best, i) < half;
    *width = search->best.core * sqrt(half);
    return inside >= LEAST_SAMPLES && *width < chord_of(NARROW_DEG);
}

static PanelBeamHead head_of(const BeamWindow *w, const BeamShape *shape) {
    double a = shape->shift[0], b = shape->shift[1], c = sqrt(1 - a * a - b * b);
    double size = hypot_d(shape->turn[0], shape->turn[1]);
    double azimuth = atan2_d(shape->turn[1], shape->turn[0]) / 2;
    double p = sqrt(size) * cos_d(azimuth), q = sqrt(size) * sin_d(azimuth);
    Vec3 centre = vec3_along(vec3_scale(w->centre, (float)c), w->frame.x, (float)a);
    centre = vec3_along(centre, w->frame.y, (float)b);
    Vec3 narrow = vec3_along(vec3_scale(w->frame.x, (float)p), w->frame.y, (float)q);
    return (PanelBeamHead){{centre.x, centre.y, centre.z},
                           {narrow.x, narrow.y, narrow.z},
                           (float)shape->core,
                           (uint8_t)knots_for(w, shape->core),
                           {0}};
}

/* The profiles of all components, [components][knots]. */
static float *find_profiles(const BeamWindow *w, const BeamShape *shape, BeamEquations *e,
                            Arena *arena) {
    double signal[UNKNOWNS_MAX];
    int n = w->model->rank->components;
    try_shape(w, shape, e, signal);
    double *right = ARENA_NEW(arena, double, n * e->unknowns);
    float *out = ARENA_NEW(arena, float, n * e->knots);
    for (int i = 0; i < w->count; i++) {
        BeamLine line;
        float score[PANEL_COMPONENTS_MAX];
        write_line(w, shape, e->knots, i, &line);
        emission_model_bare_scores(w->model, w->row[i], score);
        for (int k = 0; k < n; k++)
            for (int j = 0; j < line.count; j++)
                right[k * e->unknowns + line.at[j]] +=
                    w->weight[i] * line.value[j] * (double)score[k];
    }
    for (int k = 0; k < n; k++) {
        least_squares_solve(e->matrix, right + k * e->unknowns, (size_t)e->unknowns);
        for (int i = 0; i < e->knots; i++)
            out[k * e->knots + i] = (float)right[k * e->unknowns + i];
    }
    return out;
}

/* The beam as the file will have it, behind those that the model has. False: not storable. */
static bool keep_beam(const BeamSearch *search, double width, Arena scratch, Arena *arena,
                      EmissionModel *model) {
    int n = model->rank->components;
    PanelBeamHead head = head_of(search->window, &search->best);
    const float *profile =
        find_profiles(search->window, &search->best, search->equations, &scratch);
    float step[PANEL_COMPONENTS_MAX];
    size_t used;
    EmissionBeam *beam = &model->beam[model->beams];
    for (int k = 0; k < n; k++) step[k] = STORED_STEP * model->step[k];
    beam->size = panel_beam_pack(&head, profile, step, n, arena, &beam->bytes);
    beam->half_width = width;
    if (!panel_beam_open(beam->bytes, beam->size, n, arena, &beam->view, &used)) return false;
    model->beams++;
    return true;
}

bool emission_beam_find(EmissionModel *model, int row, double reach, Arena *arena) {
    Arena scratch = arena_reserve(SCRATCH_BYTES);
    BeamWindow window;
    BeamSearch search = {&window, ARENA_NEW(&scratch, BeamEquations, 1), {0}, {{0}, {0}, 0}, 0};
    double width = 0;
    row = climb(model, row, bright_channel(model->samples, row));
    emission_rank_free_scores(model->samples, model->samples->direction[row],
                              WINDOW * chord_of(reach), scratch, model->rank);
    gather(model, row, chord_of(reach), &scratch, &window);
    double before = without_beam(&window, search.equations, search.right);
    find_shape(&search);
    try_shape(&window, &search.best, search.equations, search.right);
    bool found =
        is_beam(&search, before, &width) && keep_beam(&search, width, scratch, arena, model);
    arena_release(&scratch);
    return found;
}

void emission_beam_note(const EmissionModel *model, FitNotes *notes) {
    for (int b = 0; b < model->beams; b++) {
        Vec3 c = model->beam[b].view.centre;
        fit_note(notes,
                 "emission: the beam at theta %.2f, phi %.2f deg, whose logarithm is "
                 "down by half %.2f deg from there, has a profile of its own",
                 degrees_from_radians((double)panel_polar_angle(c)),
                 degrees_from_radians(atan2_d((double)c.y, (double)c.x)),
                 degrees_from_radians(model->beam[b].half_width));
    }
}
