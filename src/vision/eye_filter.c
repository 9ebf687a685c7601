/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/eye_filter.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "kissfft/fourier.h"
#include "vision/eye_spread.h"

/* ---- sums of convolutions ----------------------------------------------------------------
 *
 * Of planes with kernels as large as they are:
 *     out(x, y) = sum over terms of sum over (u, v) of light(u, v) kernel(x - u, y - v)
 *
 * By Fourier transforms of a plane with so much nothing around it that nothing wraps. Kernels
 * are real, so that two planes are done at once, as the real and the imaginary part. */

/* The kernel's values at (dx, dy): 2 * height - 1 rows from -(height - 1) on, of each its
 * 2 * width - 1 columns from -(width - 1) on. Mirrored: that at (-dx, dy), at (dx, -dy). */
typedef struct ConvolutionKernel {
    const double *values;
    bool is_mirrored_x, is_mirrored_y;
} ConvolutionKernel;

/* A term of the sum: a kernel, and the light that it is convolved with. */
typedef struct ConvolutionTerm {
    ConvolutionKernel kernel;
    const void *context;
    /* 2 * width numbers: two planes' light at (0, y), at (1, y) ...; pair: which two. Called
     * from several threads. */
    void (*light_row)(const void *context, int pair, int y, double *values);
} ConvolutionTerm;

/* Planes of complex numbers. Rows are transformed where they are made, then columns, some at a
 * time: what a line of the processor's cache holds. Products are added up column by column. */
enum { COLUMNS = 4 };

typedef struct Convolution {
    int width, height;  /* of the planes */
    int pairs, threads; /* planes in pairs */
    int wide, high;     /* padded */
    double *kernel;     /* high rows of wide, rows transformed */
    double **light;     /* [pair] height rows of wide, rows transformed */
    double **sums;      /* [pair] wide columns of high, transformed */
    double **scratch;   /* one a worker */
    Fourier *row_forwards, *row_backwards, *column_forwards, *column_backwards;
    const ConvolutionTerm *term; /* at work */
} Convolution;

static int smaller(int a, int b) {
    return a < b ? a : b;
}

static int larger(int a, int b) {
    return a > b ? a : b;
}

/* The next length that the transform is quick with. */
static int quick_length(int least) {
    for (int length = larger(least, 2);; length++) {
        int rest = length;
        while (rest % 2 == 0) rest /= 2;
        while (rest % 3 == 0) rest /= 3;
        while (rest % 5 == 0) rest /= 5;
        if (rest == 1) return length;
    }
}

static double *new_plane(int wide, int high, Arena *arena) {
    return ARENA_NEW(arena, double, 2 * (size_t)wide * (size_t)high);
}

static void convolution_destroy(Convolution *convolution) {
    fourier_destroy(convolution->row_forwards);
    fourier_destroy(convolution->row_backwards);
    fourier_destroy(convolution->column_forwards);
    fourier_destroy(convolution->column_backwards);
}

/* To be destroyed. Fails when memory is out. */
static bool convolution_create(const EyeFilter *filter, int pairs, Arena *arena, Convolution **out,
                               Error *err) {
    Convolution *c = ARENA_NEW(arena, Convolution, 1);
    c->width = filter->view.width;
    c->height = filter->view.height;
    c->pairs = pairs;
    c->threads = smaller(filter->threads, PARALLEL_THREADS_MAX);
    c->wide = quick_length(2 * c->width - 1);
    c->high = quick_length(2 * c->height - 1);
    if (!fourier_create(c->wide, false, &c->row_forwards, err) ||
        !fourier_create(c->wide, true, &c->row_backwards, err) ||
        !fourier_create(c->high, false, &c->column_forwards, err) ||
        !fourier_create(c->high, true, &c->column_backwards, err)) {
        convolution_destroy(c);
        return false;
    }
    c->kernel = new_plane(c->wide, c->high, arena);
    c->light = ARENA_NEW(arena, double *, c->pairs);
    c->sums = ARENA_NEW(arena, double *, c->pairs);
    for (int i = 0; i < c->pairs; i++) {
        c->light[i] = new_plane(c->wide, c->height, arena);
        c->sums[i] = new_plane(c->wide, c->high, arena);
    }
    c->scratch = ARENA_NEW(arena, double *, c->threads);
    for (int i = 0; i < c->threads; i++)
        c->scratch[i] = new_plane(larger(c->wide, c->high), 3 * COLUMNS, arena);
    *out = c;
    return true;
}

static double *row_of(double *plane, int wide, int row) {
    return plane + 2 * (size_t)wide * (size_t)row;
}

/* ---- a term ------------------------------------------------------------------------------ */

/* At (0, dy). */
static const double *kernel_middle(const Convolution *c, int dy) {
    const ConvolutionKernel *kernel = &c->term->kernel;
    int row = (kernel->is_mirrored_y ? -dy : dy) + c->height - 1;
    return kernel->values + (size_t)row * (size_t)(2 * c->width - 1) + (c->width - 1);
}

/* Offset 0 comes first, those below it from the end backwards; what lies between is nothing. */
static void do_kernel_row(void *context, int row, int worker) {
    const Convolution *c = context;
    double *in = c->scratch[worker], *out = row_of(c->kernel, c->wide, row);
    int dy = row < c->height ? row : row - c->high;
    int sign = c->term->kernel.is_mirrored_x ? -1 : 1;
    if (dy <= -c->height) {
        memset(out, 0, sizeof *out * 2 * (size_t)c->wide);
        return;
    }
    const double *middle = kernel_middle(c, dy);
    memset(in, 0, sizeof *in * 2 * (size_t)c->wide);
    for (int dx = 1 - c->width; dx < c->width; dx++)
        in[2 * (dx < 0 ? dx + c->wide : dx)] = middle[sign * dx];
    fourier_transform(c->row_forwards, in, out);
}

static void do_light_row(void *context, int item, int worker) {
    const Convolution *c = context;
    int pair = item / c->height, y = item % c->height;
    double *in = c->scratch[worker];
    memset(in, 0, sizeof *in * 2 * (size_t)c->wide);
    c->term->light_row(c->term->context, pair, y, in);
    fourier_transform(c->row_forwards, in, row_of(c->light[pair], c->wide, y));
}

/* COLUMNS of them, or what is left. */
typedef struct ColumnsAtWork {
    int first, count;
    double *in, *kernel, *light; /* each for COLUMNS columns of `high` */
} ColumnsAtWork;

static ColumnsAtWork columns_of(const Convolution *c, int item, int worker) {
    size_t size = 2 * (size_t)COLUMNS * (size_t)c->high;
    double *scratch = c->scratch[worker];
    return (ColumnsAtWork){item * COLUMNS, smaller(COLUMNS, c->wide - item * COLUMNS), scratch,
                           scratch + size, scratch + 2 * size};
}

/* Out of a plane of `rows` rows, one column behind the other. */
static void transform_columns(const Convolution *c, const ColumnsAtWork *columns,
                              const double *plane, int rows, double *out) {
    for (int y = 0; y < c->high; y++) {
        const double *from = plane + 2 * ((size_t)c->wide * (size_t)y + (size_t)columns->first);
        for (int k = 0; k < columns->count; k++) {
            double *to = columns->in + 2 * (k * c->high + y);
            to[0] = y < rows ? from[2 * k] : 0;
            to[1] = y < rows ? from[2 * k + 1] : 0;
        }
    }
    for (int k = 0; k < columns->count; k++)
        fourier_transform(c->column_forwards, columns->in + 2 * k * c->high, out + 2 * k * c->high);
}

static void add_products(double *sum, const double *a, const double *b, int count) {
    for (int i = 0; i < count; i++) {
        sum[2 * i] += a[2 * i] * b[2 * i] - a[2 * i + 1] * b[2 * i + 1];
        sum[2 * i + 1] += a[2 * i] * b[2 * i + 1] + a[2 * i + 1] * b[2 * i];
    }
}

static void do_columns(void *context, int item, int worker) {
    const Convolution *c = context;
    ColumnsAtWork columns = columns_of(c, item, worker);
    transform_columns(c, &columns, c->kernel, c->high, columns.kernel);
    for (int pair = 0; pair < c->pairs; pair++) {
        transform_columns(c, &columns, c->light[pair], c->height, columns.light);
        add_products(row_of(c->sums[pair], c->high, columns.first), columns.light, columns.kernel,
                     columns.count * c->high);
    }
}

static int column_items(const Convolution *c) {
    return (c->wide + COLUMNS - 1) / COLUMNS;
}

static void convolution_add(Convolution *convolution, const ConvolutionTerm *term) {
    Convolution *c = convolution;
    c->term = term;
    parallel_for(c->threads, c->high, do_kernel_row, c);
    parallel_for(c->threads, c->pairs * c->height, do_light_row, c);
    parallel_for(c->threads, column_items(c), do_columns, c);
    c->term = NULL;
}

/* Columns back, of which only the picture's rows are kept, in the place of the light. */
static void finish_columns(void *context, int item, int worker) {
    const Convolution *c = context;
    int pair = item / column_items(c);
    ColumnsAtWork columns = columns_of(c, item % column_items(c), worker);
    for (int k = 0; k < columns.count; k++)
        fourier_transform(c->column_backwards, row_of(c->sums[pair], c->high, columns.first + k),
                          columns.in + 2 * k * c->high);
    for (int y = 0; y < c->height; y++) {
        double *to = row_of(c->light[pair], c->wide, y) + 2 * columns.first;
        for (int k = 0; k < columns.count; k++) {
            to[2 * k] = columns.in[2 * (k * c->high + y)];
            to[2 * k + 1] = columns.in[2 * (k * c->high + y) + 1];
        }
    }
}

static void finish_row(void *context, int item, int worker) {
    const Convolution *c = context;
    double *row = row_of(c->light[item / c->height], c->wide, item % c->height);
    double *in = c->scratch[worker];
    double scale = 1.0 / ((double)c->wide * c->high);
    for (int i = 0; i < 2 * c->wide; i++) in[i] = scale * row[i];
    fourier_transform(c->row_backwards, in, row);
}

/* After the last term, once: ends the sums. */
static void convolution_finish(Convolution *convolution) {
    Convolution *c = convolution;
    parallel_for(c->threads, c->pairs * column_items(c), finish_columns, c);
    parallel_for(c->threads, c->pairs * c->height, finish_row, c);
}

/* 2 * width numbers: row y of two planes, as light_row has them. */
static const double *convolution_row(const Convolution *convolution, int pair, int y) {
    return row_of(convolution->light[pair], convolution->wide, y);
}

/* ---- the eye's spread as such a sum ------------------------------------------------------ */

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
    const EyeLayer *layers;
    int layer_count;
    const double *omega;           /* of each pixel, 0 where nothing is to be spread */
    double node_x, node_y;         /* pixels: of the kernel, */
    double *kernel;                /* ConvolutionKernel's */
    double *weights_x, *weights_y; /* one a column or row */
} NodeWork;

/* Tangents of a place given in pixels. */
static void tangents(const EyeView *view, double x, double y, double out[2]) {
    out[0] = (x - view->axis_x) * view->pixel;
    out[1] = (y - view->axis_y) * view->pixel;
}

/* Between the directions (a, 1) and (b, 1). Their cross product gives small angles exactly. */
static double angle_deg(const double a[2], const double b[2]) {
    double dx = b[0] - a[0], dy = b[1] - a[1], turn = a[0] * b[1] - a[1] * b[0];
    double cross = sqrt(dx * dx + dy * dy + turn * turn);
    return degrees_from_radians(atan2_d(cross, 1 + a[0] * b[0] + a[1] * b[1]));
}

/* How finely a pixel is divided at that many pixels from the light: f falls about as the cube
 * of the distance, which leaves 0.1 % in its mean. */
static int divisions(int dx, int dy) {
    int far_x = abs(dx), far_y = abs(dy), distance = far_x > far_y ? far_x : far_y;
    return distance <= 2 ? 32 : distance <= 8 ? 8 : distance <= 32 ? 2 : 1;
}

/* Mean of f over the pixel at (dx, dy) from the node, beyond 90 degrees as at 90; 0 at the
 * node's own, which keeps what it does not send away. */
static double kernel_value(const NodeWork *k, int dx, int dy) {
    const EyeFilter *filter = k->filter;
    int count = divisions(dx, dy);
    double sum = 0, node[2], place[2];
    if (dx == 0 && dy == 0) return 0;
    tangents(&filter->view, k->node_x, k->node_y, node);
    for (int i = 0; i < count * count; i++) {
        double x = k->node_x + dx + (i % count + 0.5) / count - 0.5;
        double y = k->node_y + dy + (i / count + 0.5) / count - 0.5;
        tangents(&filter->view, x, y, place);
        sum += eye_spread_at(fmin(angle_deg(node, place), 90), filter->eye);
    }
    return sum / (count * count);
}

static void kernel_row(void *context, int row, int worker) {
    (void)worker;
    const NodeWork *work = context;
    const EyeView *view = &work->filter->view;
    double *values = work->kernel + (size_t)row * (size_t)(2 * view->width - 1);
    for (int dx = 1 - view->width; dx < view->width; dx++)
        *values++ = kernel_value(work, dx, row - (view->height - 1));
}

static void make_kernel(NodeWork *work, double x, double y) {
    work->node_x = x;
    work->node_y = y;
    parallel_for(work->filter->threads, 2 * work->filter->view.height - 1, kernel_row, work);
}

/* ---- nodes ------------------------------------------------------------------------------- */

typedef struct Nodes {
    int count;
    double place[NODES_MAX]; /* pixels */
} Nodes;

/* Over `size` pixels; half_tangent: of half of them. */
static Nodes make_nodes(int size, double half_tangent) {
    double t = half_tangent, ratio = (1 + sqrt(1 + t * t)) / t;
    int count = 2 + (int)ceil(-log_d(INTERPOLATION_BOUND) / log_d(ratio));
    Nodes nodes = {.count = count > NODES_MAX ? NODES_MAX : count};
    for (int i = 0; i < nodes.count; i++)
        nodes.place[i] = size / 2.0 * (1 - cos_d((2 * i + 1) * PI / (2 * nodes.count)));
    return nodes;
}

/* Lagrange's polynomial of a node. */
static double node_weight(const Nodes *nodes, int node, double place) {
    double weight = 1;
    for (int i = 0; i < nodes->count; i++)
        if (i != node) weight *= (place - nodes->place[i]) / (nodes->place[node] - nodes->place[i]);
    return weight;
}

/* The node's weight at every pixel of a row or column. */
static void set_weights(const Nodes *nodes, int node, int size, double *out) {
    for (int i = 0; i < size; i++) out[i] = node_weight(nodes, node, i + 0.5);
}

/* ---- the sum over all pixels ------------------------------------------------------------- */

/* Planes are a layer's R, G and B, then the next one's, then a constant 1; two are a pair. */
static int plane_count(int layers) {
    return 3 * layers + 1;
}

/* Times solid angle and the node's weight. */
static void light_row(const void *context, int pair, int y, double *values) {
    const NodeWork *work = context;
    size_t width = (size_t)work->filter->view.width, start = (size_t)y * width;
    for (int k = 0; k < 2; k++) {
        int plane = 2 * pair + k;
        bool is_light = plane < 3 * work->layer_count;
        bool is_one = plane == 3 * work->layer_count;
        const float *light = is_light ? work->layers[plane / 3].rgb[plane % 3] + start : NULL;
        for (size_t x = 0; x < width; x++) {
            double omega = work->omega[start + x];
            double share = omega * work->weights_x[x] * work->weights_y[y];
            double value = is_light ? (double)light[x] : is_one;
            values[2 * x + (size_t)k] = omega == 0 ? 0 : share * value;
        }
    }
}

/* A square pixel of side a on the plane at distance 1: a^2 cos^3 of the angle from the axis. */
static double solid_angle(const EyeView *view, int x, int y) {
    double t[2];
    tangents(view, x + 0.5, y + 0.5, t);
    double square = 1 + t[0] * t[0] + t[1] * t[1];
    return view->pixel * view->pixel / (square * sqrt(square));
}

static bool is_finite_in_all(const NodeWork *work, size_t pixel) {
    for (int plane = 0; plane < 3 * work->layer_count; plane++)
        if (!isfinite(work->layers[plane / 3].rgb[plane % 3][pixel])) return false;
    return true;
}

static const double *solid_angles(const NodeWork *work, Arena *arena) {
    const EyeView *view = &work->filter->view;
    size_t width = (size_t)view->width, height = (size_t)view->height;
    double *omega = ARENA_NEW(arena, double, width *height);
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
    bool is_even_x, is_even_y;
} NodeGrid;

static NodeGrid make_grid(const EyeView *view) {
    return (NodeGrid){.x = make_nodes(view->width, view->width * view->pixel / 2),
                      .y = make_nodes(view->height, view->height * view->pixel / 2),
                      .is_even_x = 2 * view->axis_x == view->width,
                      .is_even_y = 2 * view->axis_y == view->height};
}

static void add_node(NodeWork *work, const NodeGrid *grid, int i, int j,
                     const ConvolutionKernel *kernel, Convolution *convolution) {
    const EyeView *view = &work->filter->view;
    const ConvolutionTerm term = {*kernel, work, light_row};
    set_weights(&grid->x, i, view->width, work->weights_x);
    set_weights(&grid->y, j, view->height, work->weights_y);
    convolution_add(convolution, &term);
}

/* The node, and those whose kernels are its own, mirrored. */
static void add_mirrored(NodeWork *work, const NodeGrid *grid, int i, int j,
                         Convolution *convolution) {
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

static void add_nodes(NodeWork *work, Convolution *convolution) {
    const NodeGrid grid = make_grid(&work->filter->view);
    int across_x = grid.is_even_x ? (grid.x.count + 1) / 2 : grid.x.count;
    int across_y = grid.is_even_y ? (grid.y.count + 1) / 2 : grid.y.count;
    for (int node = 0; node < across_x * across_y; node++)
        add_mirrored(work, &grid, node % across_x, node / across_x, convolution);
    convolution_finish(convolution);
}

/* ---- out --------------------------------------------------------------------------------- */

static double plane_at(const Convolution *sums, int plane, int x, int y) {
    return convolution_row(sums, plane / 2, y)[2 * x + plane % 2];
}

/* Adds what arrived in a row and takes off what went; no pixel sends more than it has. */
static void exchange_row(const NodeWork *work, const Convolution *sums, int y) {
    int width = work->filter->view.width;
    for (int plane = 0; plane < 3 * work->layer_count; plane++) {
        const EyeLayer *layer = &work->layers[plane / 3];
        size_t start = (size_t)y * (size_t)width;
        const float *from = layer->rgb[plane % 3] + start;
        float *to = layer->out[plane % 3] + start;
        for (int x = 0; x < width; x++) {
            double light = (double)from[x], went = plane_at(sums, 3 * work->layer_count, x, y);
            double seen = light * fmax(1 - went, 0) + plane_at(sums, plane, x, y);
            to[x] = work->omega[start + (size_t)x] == 0 ? from[x] : (float)seen;
        }
    }
}

bool eye_filter(const EyeFilter *filter, const EyeLayer *layers, int count, Arena scratch,
                Error *err) {
    const EyeView *view = &filter->view;
    Convolution *sums;
    if (!convolution_create(filter, (plane_count(count) + 1) / 2, &scratch, &sums, err))
        return false;
    size_t kernel = (size_t)(2 * view->width - 1) * (size_t)(2 * view->height - 1);
    NodeWork work = {.filter = filter,
                     .layers = layers,
                     .layer_count = count,
                     .kernel = ARENA_NEW(&scratch, double, kernel),
                     .weights_x = ARENA_NEW(&scratch, double, view->width),
                     .weights_y = ARENA_NEW(&scratch, double, view->height)};
    work.omega = solid_angles(&work, &scratch);
    add_nodes(&work, sums);
    for (int y = 0; y < view->height; y++) exchange_row(&work, sums, y);
    convolution_destroy(sums);
    return true;
}
