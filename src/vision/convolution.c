/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/convolution.h"

#include <string.h>

#include "base/parallel.h"
#include "kissfft/fourier.h"

/* Planes of complex numbers. Rows are transformed where they are made, then columns, some at a
 * time: what a line of the processor's cache holds. Products are added up column by column. */
enum { COLUMNS = 4 };

struct Convolution {
    int      width, height, pairs, threads;
    int      wide, high; /* padded */
    double  *kernel;     /* high rows of wide, rows transformed */
    double **light;      /* [pair] height rows of wide, rows transformed */
    double **sums;       /* [pair] wide columns of high, transformed */
    double **scratch;    /* one a worker */
    Fourier *row_forwards, *row_backwards, *column_forwards, *column_backwards;
    const ConvolutionTerm *term;       /* at work */
};

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* The next length that the transform is quick with. */
static int quick_length(int least)
{
    for (int length = larger(least, 2);; length++) {
        int rest = length;
        while (rest % 2 == 0) rest /= 2;
        while (rest % 3 == 0) rest /= 3;
        while (rest % 5 == 0) rest /= 5;
        if (rest == 1) return length;
    }
}

static double *new_plane(int wide, int high, Arena *arena)
{
    return ARENA_NEW(arena, double, 2 * (size_t)wide * (size_t)high);
}

bool convolution_create(ConvolutionSize size, int threads, Arena *arena, Convolution **out,
                        Error *err)
{
    Convolution *c = ARENA_NEW(arena, Convolution, 1);
    c->width = size.width;
    c->height = size.height;
    c->pairs = size.pairs;
    c->threads = smaller(threads, PARALLEL_THREADS_MAX);
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

void convolution_destroy(Convolution *convolution)
{
    if (!convolution) return;
    fourier_destroy(convolution->row_forwards);
    fourier_destroy(convolution->row_backwards);
    fourier_destroy(convolution->column_forwards);
    fourier_destroy(convolution->column_backwards);
}

static double *row_of(double *plane, int wide, int row)
{
    return plane + 2 * (size_t)wide * (size_t)row;
}

/* ---- a term ------------------------------------------------------------------------------ */

/* At (0, dy). */
static const double *kernel_middle(const Convolution *c, int dy)
{
    const ConvolutionKernel *kernel = &c->term->kernel;
    int row = (kernel->is_mirrored_y ? -dy : dy) + c->height - 1;
    return kernel->values + (size_t)row * (size_t)(2 * c->width - 1) + (c->width - 1);
}

/* Offset 0 comes first, those below it from the end backwards; what lies between is nothing. */
static void do_kernel_row(void *context, int row, int worker)
{
    const Convolution *c = context;
    double *in = c->scratch[worker], *out = row_of(c->kernel, c->wide, row);
    int     dy = row < c->height ? row : row - c->high;
    int     sign = c->term->kernel.is_mirrored_x ? -1 : 1;
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

static void do_light_row(void *context, int item, int worker)
{
    const Convolution *c = context;
    int     pair = item / c->height, y = item % c->height;
    double *in = c->scratch[worker];
    memset(in, 0, sizeof *in * 2 * (size_t)c->wide);
    c->term->light_row(c->term->context, pair, y, in);
    fourier_transform(c->row_forwards, in, row_of(c->light[pair], c->wide, y));
}

/* COLUMNS of them, or what is left. */
typedef struct ColumnsAtWork {
    int     first, count;
    double *in, *kernel, *light; /* each for COLUMNS columns of `high` */
} ColumnsAtWork;

static ColumnsAtWork columns_of(const Convolution *c, int item, int worker)
{
    size_t  size = 2 * (size_t)COLUMNS * (size_t)c->high;
    double *scratch = c->scratch[worker];
    return (ColumnsAtWork){item * COLUMNS, smaller(COLUMNS, c->wide - item * COLUMNS), scratch,
                           scratch + size, scratch + 2 * size};
}

/* Out of a plane of `rows` rows, one column behind the other. */
static void transform_columns(const Convolution *c, const ColumnsAtWork *columns,
                              const double *plane, int rows, double *out)
{
    for (int y = 0; y < c->high; y++) {
        const double *from = plane + 2 * ((size_t)c->wide * (size_t)y + (size_t)columns->first);
        for (int k = 0; k < columns->count; k++) {
            double *to = columns->in + 2 * (k * c->high + y);
            to[0] = y < rows ? from[2 * k] : 0;
            to[1] = y < rows ? from[2 * k + 1] : 0;
        }
    }
    for (int k = 0; k < columns->count; k++)
        fourier_transform(c->column_forwards, columns->in + 2 * k * c->high,
                          out + 2 * k * c->high);
}

static void add_products(double *sum, const double *a, const double *b, int count)
{
    for (int i = 0; i < count; i++) {
        sum[2 * i] += a[2 * i] * b[2 * i] - a[2 * i + 1] * b[2 * i + 1];
        sum[2 * i + 1] += a[2 * i] * b[2 * i + 1] + a[2 * i + 1] * b[2 * i];
    }
}

static void do_columns(void *context, int item, int worker)
{
    const Convolution *c = context;
    ColumnsAtWork columns = columns_of(c, item, worker);
    transform_columns(c, &columns, c->kernel, c->high, columns.kernel);
    for (int pair = 0; pair < c->pairs; pair++) {
        transform_columns(c, &columns, c->light[pair], c->height, columns.light);
        add_products(row_of(c->sums[pair], c->high, columns.first), columns.light,
                     columns.kernel, columns.count * c->high);
    }
}

static int column_items(const Convolution *c)
{
    return (c->wide + COLUMNS - 1) / COLUMNS;
}

void convolution_add(Convolution *convolution, const ConvolutionTerm *term)
{
    Convolution *c = convolution;
    c->term = term;
    parallel_for(c->threads, c->high, do_kernel_row, c);
    parallel_for(c->threads, c->pairs * c->height, do_light_row, c);
    parallel_for(c->threads, column_items(c), do_columns, c);
    c->term = NULL;
}

/* ---- the end ----------------------------------------------------------------------------- */

/* Columns back, of which only the picture's rows are kept, in the place of the light. */
static void finish_columns(void *context, int item, int worker)
{
    const Convolution *c = context;
    int     pair = item / column_items(c);
    ColumnsAtWork columns = columns_of(c, item % column_items(c), worker);
    for (int k = 0; k < columns.count; k++)
        fourier_transform(c->column_backwards,
                          row_of(c->sums[pair], c->high, columns.first + k),
                          columns.in + 2 * k * c->high);
    for (int y = 0; y < c->height; y++) {
        double *to = row_of(c->light[pair], c->wide, y) + 2 * columns.first;
        for (int k = 0; k < columns.count; k++) {
            to[2 * k] = columns.in[2 * (k * c->high + y)];
            to[2 * k + 1] = columns.in[2 * (k * c->high + y) + 1];
        }
    }
}

static void finish_row(void *context, int item, int worker)
{
    const Convolution *c = context;
    double *row = row_of(c->light[item / c->height], c->wide, item % c->height);
    double *in = c->scratch[worker];
    double  scale = 1.0 / ((double)c->wide * c->high);
    for (int i = 0; i < 2 * c->wide; i++) in[i] = scale * row[i];
    fourier_transform(c->row_backwards, in, row);
}

void convolution_finish(Convolution *convolution)
{
    Convolution *c = convolution;
    parallel_for(c->threads, c->pairs * column_items(c), finish_columns, c);
    parallel_for(c->threads, c->pairs * c->height, finish_row, c);
}

const double *convolution_row(const Convolution *convolution, int pair, int y)
{
    return row_of(convolution->light[pair], convolution->wide, y);
}
