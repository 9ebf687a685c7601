/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/eye_filter.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "vision/convolution.h"
#include "vision/eye_spread.h"

/* The light that s sends to p depends on s and on the offset d = p - s; were it on d alone,
 * the sum over s would be one convolution. For a given d it is a smooth function of s: f of the
 * angle, which is that of two directions (x, y, 1) whose lengths are as smooth. Such a function
 * is its values at Chebyshev's nodes n, interpolated:
 *     K(s, d) = sum over n of l_n(s) K(n, d),
 * each term a convolution of l_n times the light with the kernel that belongs to the node. The
 * lengths vanish at x = +-i, so that over tangents of -t to t the error falls as r^-count with
 * r = (1 + sqrt(1 + t^2))/t (Bernstein's ellipse through +-i): 6 nodes across a view of 66
 * degrees, 11 across one of 120. The error is below 0.4 % (tests/unit/test_eye_filter.c). */
#define INTERPOLATION_BOUND 1e-2
enum { NODES_MAX = 48 };

/* ---- the spread between two pixels ------------------------------------------------------- */

/* A node at work, and the light that it shares in. */
typedef struct NodeWork {
    const EyeFilter *filter;
    const EyeLayer  *layers;
    int              layer_count;
    const double *omega;         /* of each pixel, 0 where nothing is to be spread */
    double        over_integral; /* 1 / eye_spread_integral */
    double        node_x, node_y; /* pixels: of the kernel, */
    double       *kernel;         /* convolution.h's */
    double       *weights_x, *weights_y; /* one a column or row */
} NodeWork;

/* Tangents of a place given in pixels. */
static void tangents(const EyeView *view, double x, double y, double out[2])
{
    out[0] = (x - view->axis_x) * view->pixel;
    out[1] = (y - view->axis_y) * view->pixel;
}

/* Between the directions (a, 1) and (b, 1). Their cross product gives small angles exactly. */
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

static void kernel_row(void *context, int row, int worker)
{
    (void)worker;
    const NodeWork *work = context;
    const EyeView  *view = &work->filter->view;
    double *values = work->kernel + (size_t)row * (size_t)(2 * view->width - 1);
    for (int dx = 1 - view->width; dx < view->width; dx++)
        *values++ = kernel_value(work, dx, row - (view->height - 1));
}

static void make_kernel(NodeWork *work, double x, double y)
{
    work->node_x = x;
    work->node_y = y;
    parallel_for(work->filter->threads, 2 * work->filter->view.height - 1, kernel_row, work);
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

/* The node's weight at every pixel of a row or column. */
static void set_weights(const Nodes *nodes, int node, int size, double *out)
{
    for (int i = 0; i < size; i++) out[i] = node_weight(nodes, node, i + 0.5);
}

/* ---- the sum over all pixels ------------------------------------------------------------- */

/* Planes are a layer's R, G and B, then the next one's, then a constant 1; two are a pair. */
static int plane_count(int layers)
{
    return 3 * layers + 1;
}

/* Times solid angle and the node's weight. */
static void light_row(const void *context, int pair, int y, double *values)
{
    const NodeWork *work = context;
    size_t          width = (size_t)work->filter->view.width, start = (size_t)y * width;
    for (int k = 0; k < 2; k++) {
        int          plane = 2 * pair + k;
        bool         is_light = plane < 3 * work->layer_count;
        bool         is_one = plane == 3 * work->layer_count;
        const float *light =
            is_light ? work->layers[plane / 3].rgb[plane % 3] + start : NULL;
        for (size_t x = 0; x < width; x++) {
            double omega = work->omega[start + x];
            double share = omega * work->weights_x[x] * work->weights_y[y];
            double value = is_light ? (double)light[x] : is_one;
            values[2 * x + (size_t)k] = omega == 0 ? 0 : share * value;
        }
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

static bool is_finite_in_all(const NodeWork *work, size_t pixel)
{
    for (int plane = 0; plane < 3 * work->layer_count; plane++)
        if (!isfinite(work->layers[plane / 3].rgb[plane % 3][pixel])) return false;
    return true;
}

static const double *solid_angles(const NodeWork *work, Arena *arena)
{
    const EyeView *view = &work->filter->view;
    size_t  width = (size_t)view->width, height = (size_t)view->height;
    double *omega = ARENA_NEW(arena, double, width * height);
    for (size_t i = 0; i < width * height; i++)
        if (is_finite_in_all(work, i))
            omega[i] = solid_angle(view, (int)(i % width), (int)(i / width));
    return omega;
}

/* ---- all nodes --------------------------------------------------------------------------- */

/* Nodes lie evenly about the middle of a picture; where the camera looks there, what belongs to
 * a node is mirrored what belongs to the one on the other side. */
typedef struct NodeGrid {
    Nodes x, y;
    bool  is_even_x, is_even_y;
} NodeGrid;

static NodeGrid make_grid(const EyeView *view)
{
    return (NodeGrid){.x = make_nodes(view->width, view->width * view->pixel / 2),
                      .y = make_nodes(view->height, view->height * view->pixel / 2),
                      .is_even_x = 2 * view->axis_x == view->width,
                      .is_even_y = 2 * view->axis_y == view->height};
}

static void add_node(NodeWork *work, const NodeGrid *grid, int i, int j,
                     const ConvolutionKernel *kernel, Convolution *convolution)
{
    const EyeView        *view = &work->filter->view;
    const ConvolutionTerm term = {*kernel, work, light_row};
    set_weights(&grid->x, i, view->width, work->weights_x);
    set_weights(&grid->y, j, view->height, work->weights_y);
    convolution_add(convolution, &term);
}

/* The node, and those whose kernels are its own, mirrored. */
static void add_mirrored(NodeWork *work, const NodeGrid *grid, int i, int j,
                         Convolution *convolution)
{
    int other_i = grid->is_even_x ? grid->x.count - 1 - i : i;
    int other_j = grid->is_even_y ? grid->y.count - 1 - j : j;
    make_kernel(work, grid->x.place[i], grid->y.place[j]);
    for (int by_y = 0; by_y <= (other_j != j); by_y++) {
        for (int by_x = 0; by_x <= (other_i != i); by_x++) {
            ConvolutionKernel kernel = {work->kernel, by_x, by_y};
            add_node(work, grid, by_x ? other_i : i, by_y ? other_j : j, &kernel, convolution);
        }
    }
}

static void add_nodes(NodeWork *work, Convolution *convolution)
{
    const NodeGrid grid = make_grid(&work->filter->view);
    int across_x = grid.is_even_x ? (grid.x.count + 1) / 2 : grid.x.count;
    int across_y = grid.is_even_y ? (grid.y.count + 1) / 2 : grid.y.count;
    for (int node = 0; node < across_x * across_y; node++)
        add_mirrored(work, &grid, node % across_x, node / across_x, convolution);
    convolution_finish(convolution);
}

/* ---- out --------------------------------------------------------------------------------- */

static double plane_at(const Convolution *sums, int plane, int x, int y)
{
    return convolution_row(sums, plane / 2, y)[2 * x + plane % 2];
}

/* Adds what arrived in a row and takes off what went. */
static void exchange_row(const NodeWork *work, const Convolution *sums, int y)
{
    int width = work->filter->view.width;
    for (int plane = 0; plane < 3 * work->layer_count; plane++) {
        const EyeLayer *layer = &work->layers[plane / 3];
        size_t          start = (size_t)y * (size_t)width;
        const float    *from = layer->rgb[plane % 3] + start;
        float          *to = layer->out[plane % 3] + start;
        for (int x = 0; x < width; x++) {
            double light = (double)from[x], went = plane_at(sums, 3 * work->layer_count, x, y);
            double seen = light + plane_at(sums, plane, x, y) - light * went;
            to[x] = work->omega[start + (size_t)x] == 0 ? from[x] : (float)seen;
        }
    }
}

bool eye_filter(const EyeFilter *filter, const EyeLayer *layers, int count, Arena scratch,
                Error *err)
{
    const EyeView  *view = &filter->view;
    ConvolutionSize size = {view->width, view->height, (plane_count(count) + 1) / 2};
    Convolution    *sums;
    if (!convolution_create(size, filter->threads, &scratch, &sums, err)) return false;
    size_t   kernel = (size_t)(2 * view->width - 1) * (size_t)(2 * view->height - 1);
    NodeWork work = {.filter = filter, .layers = layers, .layer_count = count,
                     .over_integral = 1 / eye_spread_integral(filter->eye),
                     .kernel = ARENA_NEW(&scratch, double, kernel),
                     .weights_x = ARENA_NEW(&scratch, double, view->width),
                     .weights_y = ARENA_NEW(&scratch, double, view->height)};
    work.omega = solid_angles(&work, &scratch);
    add_nodes(&work, sums);
    for (int y = 0; y < view->height; y++) exchange_row(&work, sums, y);
    convolution_destroy(sums);
    return true;
}
