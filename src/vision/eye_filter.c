/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/eye_filter.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "base/mathd.h"
#include "base/units.h"
#include "vision/convolution.h"
#include "vision/eye_spread.h"

/* What a light at s sends to p depends on s and on the offset d = p - s; were it on d alone,
 * the sum over s would be one convolution. For a given d it is a smooth function of s: f of the
 * angle, which is that of two directions (x, y, 1) whose lengths are as smooth. Such a function
 * is its values at Chebyshev's nodes n, interpolated:
 *     K(s, d) = sum over n of l_n(s) K(n, d),
 * each term a convolution of l_n times the light with the kernel that belongs to the node. The
 * lengths vanish at x = +-i, so that over tangents of -t to t the error falls as r^-count with
 * r = (1 + sqrt(1 + t^2))/t (Bernstein's ellipse through +-i): 6 nodes across a view of 66
 * degrees, 11 across one of 120. What is left is below 0.4 % (tests/unit/test_eye_filter.c). */
#define INTERPOLATION_BOUND 1e-2
enum { NODES_MAX = 48 };

/* ---- the spread between two pixels ------------------------------------------------------- */

/* A node at work, and the light that it shares in. */
typedef struct NodeWork {
    const EyeFilter    *filter;
    const float *const *rgb;
    const double *omega;        /* of each pixel, 0 where nothing is to be spread */
    double        over_integral; /* 1 / eye_spread_integral */
    double        node_x, node_y; /* pixels */
    double       *weights_x, *weights_y; /* one a column or row */
} NodeWork;

/* Tangents of a place given in pixels. */
static void tangents(const EyeView *view, double x, double y, double out[2])
{
    out[0] = (x - view->axis_x) * view->pixel;
    out[1] = (y - view->axis_y) * view->pixel;
}

/* Between the directions (a, 1) and (b, 1). Their cross product tells small angles exactly. */
static double angle_deg(const double a[2], const double b[2])
{
    double dx = b[0] - a[0], dy = b[1] - a[1], turn = a[0] * b[1] - a[1] * b[0];
    double cross = sqrt(dx * dx + dy * dy + turn * turn);
    return degrees_from_radians(atan2_d(cross, 1 + a[0] * b[0] + a[1] * b[1]));
}

/* How finely a pixel is divided at that many pixels from the light: f falls about as the cube
 * of the distance, which leaves 0.1 % in its mean. */
static int divisions(int dx, int dy)
{
    int far_x = abs(dx), far_y = abs(dy), distance = far_x > far_y ? far_x : far_y;
    return distance <= 2 ? 32 : distance <= 8 ? 8 : distance <= 32 ? 2 : 1;
}

/* Mean of f over the pixel at (dx, dy) from the node, beyond 90 degrees as at 90; 0 at the
 * node's own, which keeps what it does not send away. */
static double kernel_value(const NodeWork *k, int dx, int dy)
{
    const EyeFilter *filter = k->filter;
    int    count = divisions(dx, dy);
    double sum = 0, node[2], place[2];
    if (dx == 0 && dy == 0) return 0;
    tangents(&filter->view, k->node_x, k->node_y, node);
    for (int i = 0; i < count * count; i++) {
        double x = k->node_x + dx + (i % count + 0.5) / count - 0.5;
        double y = k->node_y + dy + (i / count + 0.5) / count - 0.5;
        tangents(&filter->view, x, y, place);
        sum += eye_spread_published(fmin(angle_deg(node, place), 90), filter->eye);
    }
    return sum * k->over_integral / (count * count);
}

static void kernel_row(const void *context, int dy, double *values)
{
    const NodeWork *work = context;
    int             width = work->filter->view.width;
    for (int dx = 1 - width; dx < width; dx++)
        values[dx + width - 1] = kernel_value(work, dx, dy);
}

/* ---- nodes ------------------------------------------------------------------------------- */

typedef struct Nodes {
    int    count;
    double place[NODES_MAX]; /* pixels */
} Nodes;

/* Over `size` pixels; half_tangent: of half of them. */
static Nodes make_nodes(int size, double half_tangent)
{
    double t = half_tangent, ratio = (1 + sqrt(1 + t * t)) / t;
    int    count = 2 + (int)ceil(-log_d(INTERPOLATION_BOUND) / log_d(ratio));
    Nodes  nodes = {.count = count > NODES_MAX ? NODES_MAX : count};
    for (int i = 0; i < nodes.count; i++)
        nodes.place[i] = size / 2.0 * (1 - cos_d((2 * i + 1) * PI / (2 * nodes.count)));
    return nodes;
}

/* Lagrange's polynomial of a node. */
static double node_weight(const Nodes *nodes, int node, double place)
{
    double weight = 1;
    for (int i = 0; i < nodes->count; i++)
        if (i != node)
            weight *= (place - nodes->place[i]) / (nodes->place[node] - nodes->place[i]);
    return weight;
}

/* Of every pixel of a row or column. */
static void set_weights(const Nodes *nodes, int node, int size, double *out)
{
    for (int i = 0; i < size; i++) out[i] = node_weight(nodes, node, i + 0.5);
}

/* ---- the sum over all pixels ------------------------------------------------------------- */

/* R and G, then B and a constant 1, times solid angle and the node's weight. */
static void light_row(const void *context, int pair, int y, double *values)
{
    const NodeWork *work = context;
    size_t          width = (size_t)work->filter->view.width, start = (size_t)y * width;
    const float    *one = work->rgb[2 * pair] + start;
    const float    *other = pair == 0 ? work->rgb[1] + start : NULL;
    for (size_t x = 0; x < width; x++) {
        double omega = work->omega[start + x];
        double share = omega * work->weights_x[x] * work->weights_y[y];
        values[2 * x] = omega == 0 ? 0 : share * (double)one[x];
        values[2 * x + 1] = omega == 0 ? 0 : share * (other ? (double)other[x] : 1);
    }
}

/* A square pixel of side a on the plane at distance 1: a^2 cos^3 of the angle from the axis. */
static double solid_angle(const EyeView *view, int x, int y)
{
    double t[2];
    tangents(view, x + 0.5, y + 0.5, t);
    double square = 1 + t[0] * t[0] + t[1] * t[1];
    return view->pixel * view->pixel / (square * sqrt(square));
}

static const double *solid_angles(const EyeFilter *filter, const float *const rgb[3],
                                  Arena *arena)
{
    size_t  width = (size_t)filter->view.width, height = (size_t)filter->view.height;
    double *omega = ARENA_NEW(arena, double, width * height);
    for (size_t i = 0; i < width * height; i++)
        if (isfinite(rgb[0][i]) && isfinite(rgb[1][i]) && isfinite(rgb[2][i]))
            omega[i] = solid_angle(&filter->view, (int)(i % width), (int)(i / width));
    return omega;
}

static void add_nodes(NodeWork *work, Convolution *convolution)
{
    const EyeView        *view = &work->filter->view;
    const ConvolutionTerm term = {work, kernel_row, light_row};
    const Nodes across_x = make_nodes(view->width, view->width * view->pixel / 2);
    const Nodes across_y = make_nodes(view->height, view->height * view->pixel / 2);
    for (int node = 0; node < across_x.count * across_y.count; node++) {
        int i = node % across_x.count, j = node / across_x.count;
        work->node_x = across_x.place[i];
        work->node_y = across_y.place[j];
        set_weights(&across_x, i, view->width, work->weights_x);
        set_weights(&across_y, j, view->height, work->weights_y);
        convolution_add(convolution, &term);
    }
    convolution_finish(convolution);
}

/* What arrived minus what went, of one row. */
static void exchange_row(const NodeWork *work, const Convolution *sums, int y,
                         float *const out[3])
{
    size_t        width = (size_t)work->filter->view.width;
    const double *pairs[2] = {convolution_row(sums, 0, y), convolution_row(sums, 1, y)};
    for (size_t x = 0; x < width; x++) {
        size_t i = (size_t)y * width + x;
        double went = pairs[1][2 * x + 1];
        for (int c = 0; c < 3; c++) {
            double light = (double)work->rgb[c][i];
            double arrived = pairs[c / 2][2 * x + (size_t)(c % 2)];
            out[c][i] = work->omega[i] == 0 ? work->rgb[c][i]
                                            : (float)(light + arrived - light * went);
        }
    }
}

bool eye_filter(const EyeFilter *filter, const float *const rgb[3], float *const out[3],
                Arena scratch, Error *err)
{
    const EyeView *view = &filter->view;
    Convolution   *sums;
    if (!convolution_create(view->width, view->height, filter->threads, &scratch, &sums, err))
        return false;
    NodeWork work = {.filter = filter, .rgb = rgb, .omega = solid_angles(filter, rgb, &scratch),
                     .over_integral = 1 / eye_spread_integral(filter->eye),
                     .weights_x = ARENA_NEW(&scratch, double, view->width),
                     .weights_y = ARENA_NEW(&scratch, double, view->height)};
    add_nodes(&work, sums);
    for (int y = 0; y < view->height; y++) exchange_row(&work, sums, y, out);
    convolution_destroy(sums);
    return true;
}
