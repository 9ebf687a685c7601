/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/shape/panel_profiles.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

#define STEPS 16         /* nodes of a profile between two rings */
#define JUMP 8.0         /* ratio of neighbours that no smooth lamp has, */
#define STEEPER 3.0      /* than the intervals beside it */
#define SEEN 0.05        /* where the brighter is such a share of the largest */
#define HELD_SHARE 1e-3  /* of what counts: logarithms go no lower */
#define REST_MOST 0.4    /* of an interval at either end */
#define THETA_SHARE 0.01 /* of V: a profile without edges goes by theta */
#define HALVINGS 16
#define BETTER 0.9 /* what following must leave of the error */

/* ---- between four samples --------------------------------------------------------------- */

/* Rising places and what stands there; read between the middle ones. */
typedef struct Four {
    double x[4], y[4];
} Four;

/* ln of what counts of some light. */
static double seen_log(double light, double least) {
    return log_d(light + least);
}

/* Between the middle ones the light jumps: by far, and by far more than beside them. The flank
 * of a narrow beam is as steep, but so are its neighbours. */
static bool is_jump(const Four *f, double least) {
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = fabs(seen_log(f->y[i + 1], least) - seen_log(f->y[i], least));
    return d[1] > log_d(JUMP) && d[1] > STEEPER * fmax(d[0], d[2]);
}

/* Hermite's cubic with given slopes over a unit interval. */
static double hermite(double a, double b, double slope_a, double slope_b, double t) {
    double s = 1 - t;
    return s * s * (1 + 2 * t) * a + t * t * (1 + 2 * s) * b + s * s * t * slope_a -
           t * t * s * slope_b;
}

/* Slope of the parabola through three places at the middle one. */
static double parabola_slope(const double x[3], double before, double after) {
    double h0 = x[1] - x[0], h1 = x[2] - x[1];
    return (h1 * before + h0 * after) / (h0 + h1);
}

/* The ends of the middle interval beside which values are far steeper: there the cubic has the
 * interval's own slope. */
typedef struct Steep {
    bool before, behind;
} Steep;

static Steep steep_of(const double y[4], double least) {
    double most = fmax(least, STEEPER * fabs(y[2] - y[1]));
    return (Steep){fabs(y[1] - y[0]) > most, fabs(y[3] - y[2]) > most};
}

/* The cubic through the middle two. */
static double read_cubic(const double x[4], const double y[4], Steep steep, double at) {
    double d[3], h = x[2] - x[1];
    for (int i = 0; i < 3; i++) d[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    double first = steep.before ? d[1] : parabola_slope(x, d[0], d[1]);
    double last = steep.behind ? d[1] : parabola_slope(x + 1, d[1], d[2]);
    return hermite(y[1], y[2], first * h, last * h, (at - x[1]) / h);
}

double panel_profiles_cubic(const double x[4], const double y[4], double at) {
    return read_cubic(x, y, (Steep){false, false}, at);
}

/* How the light goes between four places: decided once, by the channel that counts, for all
 * channels of a direction. Were each decided alone, one would end where another goes on, and
 * between samples a white would shine in a colour that no sample has. */
typedef struct Course {
    Four leader;     /* the light that decides, its logarithms where it is smooth */
    double at, ramp; /* the place; how far a jump is passed there, 0 to 1 */
    double light;    /* ln of the leader's light there, where it is smooth */
    bool jumps;
    Steep steep;
} Course;

/* Of a light that jumps, a ramp between `rest` of the interval at either end, which leaves the
 * mean where it is. */
static Course course_of(const Four *leader, double at, double rest, double least) {
    Course c = {.leader = *leader, .at = at, .jumps = is_jump(leader, least)};
    double width = leader->x[2] - leader->x[1];
    if (c.jumps) {
        double share = fmin(REST_MOST, rest / width);
        double t = (at - leader->x[1]) / width;
        c.ramp = fmin(1, fmax(0, (t - share) / (1 - 2 * share)));
        return c;
    }
    for (int i = 0; i < 4; i++) c.leader.y[i] = log_d(fmax(leader->y[i], HELD_SHARE * least));
    c.steep = steep_of(c.leader.y, log_d(JUMP));
    c.light = read_cubic(c.leader.x, c.leader.y, c.steep, at);
    return c;
}

/* A channel's light. Over a jump it is a mean of both ends; else its ratio to the leader's goes
 * by a cubic that stays between those of both ends. */
static double light_on(const Course *c, const double y[4], double least) {
    double ratio[4];
    if (c->jumps) return y[1] + (y[2] - y[1]) * c->ramp;
    for (int i = 0; i < 4; i++) ratio[i] = log_d(fmax(y[i], HELD_SHARE * least)) - c->leader.y[i];
    double value = read_cubic(c->leader.x, ratio, c->steep, c->at);
    return exp_d(c->light + fmin(fmax(ratio[1], ratio[2]), fmax(fmin(ratio[1], ratio[2]), value)));
}

/* ---- profiles over theta ---------------------------------------------------------------- */

int panel_profiles_opposite(const PanelAxes *grid, int azimuth) {
    double wanted = (double)grid->phi[azimuth] + PI;
    int best = azimuth;
    double least = INFINITY;
    for (int i = 0; i < grid->phis; i++) {
        double far = fabs(remainder((double)grid->phi[i] - wanted, 2 * PI));
        if (far < least) least = far, best = i;
    }
    return best;
}

/* Four rings around an interval of an azimuth: through the pole, straight on at the end. */
static Four four_rings(const PanelProfiles *e, const float *cells, int azimuth, int interval,
                       int channel) {
    const PanelAxes *g = &e->grid;
    Four f;
    for (int i = 0; i < 4; i++) {
        int ring = interval - 1 + i, at = azimuth;
        if (ring < 0) ring = 1, at = panel_profiles_opposite(g, azimuth);
        if (ring > g->thetas - 1) ring = g->thetas - 1;
        f.x[i] = interval - 1 + i < 0 ? -(double)g->theta[1] : (double)g->theta[ring];
        f.y[i] = (double)cells[(ring * g->phis + at) * e->channels + channel];
    }
    if (interval + 2 > g->thetas - 1) {
        f.x[3] = 2 * f.x[2] - f.x[1];
        f.y[3] = f.y[2];
    }
    return f;
}

static float *light_at(const PanelProfiles *e, int azimuth, int node) {
    return e->light + ((size_t)azimuth * (size_t)e->nodes + (size_t)node) * (size_t)e->channels;
}

static void make_profile(PanelProfiles *e, const float *cells, int azimuth) {
    for (int m = 0; m < e->nodes; m++) {
        int last = e->grid.thetas - 2, interval = m / STEPS < last ? m / STEPS : last;
        Four f = four_rings(e, cells, azimuth, interval, e->bright);
        Course course = course_of(&f, e->theta[m], e->rest, e->least[e->bright]);
        for (int c = 0; c < e->channels; c++) {
            f = four_rings(e, cells, azimuth, interval, c);
            light_at(e, azimuth, m)[c] = (float)light_on(&course, f.y, e->least[c]);
        }
    }
}

/* V of a profile. */
static void find_variation(PanelProfiles *e, int azimuth) {
    double *v = e->variation + (size_t)azimuth * (size_t)e->nodes, sum = 0;
    int last = e->nodes - 1;
    for (int m = 1; m <= last; m++) {
        sum += fabs(
            (double)(light_at(e, azimuth, m)[e->bright] - light_at(e, azimuth, m - 1)[e->bright]));
        v[m] = sum;
    }
    double share = sum > e->least[e->bright] ? THETA_SHARE : 1;
    for (int m = 1; m <= last; m++)
        v[m] = (share < 1 ? (1 - share) * v[m] / sum : 0) + share * e->theta[m] / e->theta[last];
}

/* Where a rising list has a value: the index before it; *t: how far towards the next. */
static int find_place(const double *list, int count, double value, double *t) {
    int low = 0, high = count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (list[middle] <= value) low = middle;
        else high = middle;
    }
    double span = list[high] - list[low];
    *t = span > 0 ? fmin(1, fmax(0, (value - list[low]) / span)) : 0;
    return low;
}

/* ---- between azimuths ------------------------------------------------------------------- */

/* Azimuths around one, or around a gap that one was left out of. */
typedef struct Around {
    int azimuth[4];
    double x[4]; /* their phi, rising */
    bool follows;
} Around;

static Around around_of(const PanelProfiles *e, const int index[4], bool follows) {
    int n = e->grid.phis;
    Around a = {.follows = follows};
    for (int i = 0; i < 4; i++) {
        int turn = (int)floor((double)index[i] / n);
        a.azimuth[i] = index[i] - turn * n;
        a.x[i] = (double)e->grid.phi[a.azimuth[i]] + 2 * PI * turn;
    }
    return a;
}

static double theta_of(const PanelProfiles *e, int azimuth, double variation) {
    double t;
    int m = find_place(e->variation + (size_t)azimuth * (size_t)e->nodes, e->nodes, variation, &t);
    return e->theta[m] + t * (e->theta[m + 1] - e->theta[m]);
}

/* The thetas of the four profiles that belong to theta at phi. */
static void find_thetas(const PanelProfiles *e, const Around *a, double phi, double theta,
                        double out[4]) {
    double low = 0, high = 1;
    Four f;
    for (int i = 0; i < 4; i++) out[i] = theta, f.x[i] = a->x[i];
    for (int step = 0; step < HALVINGS && a->follows; step++) {
        double middle = (low + high) / 2;
        for (int i = 0; i < 4; i++) f.y[i] = out[i] = theta_of(e, a->azimuth[i], middle);
        if (panel_profiles_cubic(f.x, f.y, phi) <= theta) low = middle;
        else high = middle;
    }
}

/* Places on four profiles, and how the light goes between them. */
typedef struct Mix {
    const Around *around;
    int node[4];
    double t[4];
    Course course;
} Mix;

/* A channel at the four places. */
static Four four_profiles(const PanelProfiles *e, const Mix *mix, int channel) {
    Four f;
    for (int i = 0; i < 4; i++) {
        int at = mix->around->azimuth[i];
        double a = (double)light_at(e, at, mix->node[i])[channel];
        double b = (double)light_at(e, at, mix->node[i] + 1)[channel];
        f.x[i] = mix->around->x[i];
        f.y[i] = a + (b - a) * mix->t[i];
    }
    return f;
}

static Mix mix_at(const PanelProfiles *e, const Around *a, double phi, double theta) {
    Mix mix = {.around = a};
    double thetas[4];
    find_thetas(e, a, phi, theta, thetas);
    for (int i = 0; i < 4; i++) mix.node[i] = find_place(e->theta, e->nodes, thetas[i], &mix.t[i]);
    Four f = four_profiles(e, &mix, e->bright);
    mix.course = course_of(&f, phi, e->rest / fmax(1e-3, sin_d(theta)), e->least[e->bright]);
    return mix;
}

static double mixed_light(const PanelProfiles *e, const Mix *mix, int channel) {
    Four f = four_profiles(e, mix, channel);
    return light_on(&mix->course, f.y, e->least[channel]);
}

/* The interval of azimuths that phi is in. */
static int interval_of(const PanelProfiles *e, double *phi) {
    int n = e->grid.phis, i = 0;
    *phi -= 2 * PI * floor((*phi - (double)e->grid.phi[0]) / (2 * PI));
    while (i + 1 < n && (double)e->grid.phi[i + 1] <= *phi) i++;
    return i;
}

/* ---- do edges move? --------------------------------------------------------------------- */

/* The light that an azimuth's neighbours miss of it; *whole: its own. */
static double miss_of(const PanelProfiles *e, int azimuth, bool follows, double *whole) {
    int index[4] = {azimuth - 2, azimuth - 1, azimuth + 1, azimuth + 2};
    Around a = around_of(e, index, follows);
    double sum = 0, phi = (double)e->grid.phi[azimuth];
    *whole = 0;
    for (int m = STEPS; m < e->nodes; m += STEPS) {
        double theta = e->theta[m], weight = sin_d(theta) * cos_d(theta);
        Mix mix = mix_at(e, &a, phi, theta);
        double measured = (double)light_at(e, azimuth, m)[e->bright];
        weight *= e->theta[m] - e->theta[m - STEPS];
        sum += weight * fabs(mixed_light(e, &mix, e->bright) - measured);
        *whole += weight * measured;
    }
    return sum;
}

PanelFollowing panel_profiles_follow(PanelProfiles *e, Arena scratch) {
    int n = e->grid.phis;
    double *still = ARENA_NEW(&scratch, double, n), *moved = ARENA_NEW(&scratch, double, n);
    double light = 0, whole, sum = 0, squares = 0;
    PanelFollowing out = {0};
    for (int i = 0; i < n; i++) {
        still[i] = miss_of(e, i, false, &whole);
        moved[i] = miss_of(e, i, true, &whole);
        light += whole;
        sum += still[i], squares += still[i] * still[i];
    }
    out.shared = squares > 0 ? sum * sum / (n * squares) : 1;
    for (int i = 0; i < n; i++) {
        int next = (i + 1) % n;
        e->follows[i] = moved[i] + moved[next] < BETTER * (still[i] + still[next]);
        out.intervals += e->follows[i];
        out.missed_still += still[i] / light;
        out.missed +=
            (e->follows[i] ? moved[i] + moved[next] : still[i] + still[next]) / (2 * light);
    }
    return out;
}

void panel_profiles_light(const PanelProfiles *e, double theta, double phi, float *light) {
    theta = fmin(theta, e->theta[e->nodes - 1]);
    int i = interval_of(e, &phi), index[4] = {i - 1, i, i + 1, i + 2};
    Around a = around_of(e, index, e->follows[i]);
    Mix mix = mix_at(e, &a, phi, theta);
    for (int c = 0; c < e->channels; c++) light[c] = (float)mixed_light(e, &mix, c);
    if (!a.follows) return;
    a.follows = false;
    mix = mix_at(e, &a, phi, theta);
    double factor = (double)light[e->bright] / mixed_light(e, &mix, e->bright);
    for (int c = 0; c < e->lit; c++) light[c] = (float)(factor * mixed_light(e, &mix, c));
    if (e->lit == e->channels) return;
    factor = (double)light[e->lit + 1] / mixed_light(e, &mix, e->lit + 1);
    for (int c = e->lit; c < e->channels; c++) light[c] = (float)(factor * mixed_light(e, &mix, c));
}

/* ---- made from cells -------------------------------------------------------------------- */

void panel_profiles_start(const PanelAxes *grid, int channels, const float *cells,
                          double least_share, Arena *arena, PanelProfiles *out) {
    int count = grid->thetas * grid->phis;
    double most = 0;
    *out = (PanelProfiles){.grid = *grid,
                           .channels = channels,
                           .lit = channels,
                           .bright = 1,
                           .least = ARENA_NEW(arena, double, channels)};
    for (int i = 0; i < count * channels; i++)
        out->least[i % channels] = fmax(out->least[i % channels], (double)cells[i]);
    for (int c = 1; c < channels; c += 3)
        if (out->least[c] > most) most = out->least[c], out->bright = c;
    out->seen = SEEN * most;
    for (int c = 0; c < channels; c++) out->least[c] *= least_share;
}

void panel_profiles_make(PanelProfiles *e, const float *cells, double rest, Arena *arena) {
    size_t azimuths = (size_t)e->grid.phis;
    e->rest = rest;
    e->nodes = (e->grid.thetas - 1) * STEPS + 1;
    e->theta = ARENA_NEW(arena, double, e->nodes);
    e->light = ARENA_NEW(arena, float, azimuths *(size_t)(e->nodes * e->channels));
    e->variation = ARENA_NEW(arena, double, azimuths *(size_t)e->nodes);
    e->follows = ARENA_NEW(arena, bool, azimuths);
    for (int m = 0; m < e->nodes; m++) {
        int ring = m / STEPS, next = ring + 1 < e->grid.thetas ? ring + 1 : ring;
        double t = (double)(m % STEPS) / STEPS;
        e->theta[m] = (1 - t) * (double)e->grid.theta[ring] + t * (double)e->grid.theta[next];
    }
    for (int p = 0; p < e->grid.phis; p++) {
        make_profile(e, cells, p);
        find_variation(e, p);
    }
}

/* ---- jumps ------------------------------------------------------------------------------- */

static bool is_seen_jump(const PanelProfiles *e, const Four *f) {
    return fmax(f->y[1], f->y[2]) > e->seen && is_jump(f, e->least[e->bright]);
}

bool panel_profiles_jump(const PanelProfiles *e, const float *cells) {
    const PanelAxes *g = &e->grid;
    for (int p = 0; p < g->phis; p++)
        for (int t = 0; t + 1 < g->thetas; t++) {
            Four over_theta = four_rings(e, cells, p, t, e->bright), over_phi;
            for (int i = 0; i < 4; i++) {
                int at = (t + 1) * g->phis + (p + g->phis - 1 + i) % g->phis;
                over_phi.y[i] = (double)cells[at * e->channels + e->bright];
            }
            if (is_seen_jump(e, &over_theta) || is_seen_jump(e, &over_phi)) return true;
        }
    return false;
}
