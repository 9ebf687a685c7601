/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/change.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "spectrum/photometry.h"

#define SIDE_MOST 8
#define CELLS_ALONG 8        /* at least, where pixels suffice and no noise is; */
#define NOISY_CELLS_ALONG 32 /* in noise boxes of cells are told, not cells */
#define NOISY 0.1            /* share of the pixels: fewer that differ are no noise */
#define ROUNDING 1e-5        /* as SIGN_FLIP_ROUNDING */
#define FALSE_CELLS 0.01     /* expected of all, in independent noise */
#define SURE 3.3             /* standard errors: one false in a thousand */
#define OUTSIDE 0.5          /* of a box's change: more of it beside the box is no one place */
#define EVERYWHERE 0.8       /* share of the lit cells */
#define FAINT 0.25       /* of the cells' root mean square change: less is not where it changed */
#define SPREAD (2 / 3.0) /* of a picture's side: what spans more has no place along it */
#define DARK 1e-3        /* of the mean: light that is as good as none */
#define LEAST_UV 0.001
#define LEAST_WAYS 0.002 /* of the light: less is rounding of a colour at equal luminance */

/* ---- sums -------------------------------------------------------------------------------- */

ChangeGrid change_grid(int width, int height, bool is_paired, Arena *arena) {
    int least = width < height ? width : height;
    int side = is_paired ? least / CELLS_ALONG : least / NOISY_CELLS_ALONG;
    int fewest = is_paired ? 1 : 2; /* of one pixel no noise is known */
    side = side > SIDE_MOST ? SIDE_MOST : side < fewest ? fewest : side;
    ChangeGrid grid = {.width = width,
                       .height = height,
                       .side = side,
                       .columns = (width + side - 1) / side,
                       .rows = (height + side - 1) / side};
    grid.cells = ARENA_NEW(arena, ChangeSum, (size_t)grid.columns * (size_t)grid.rows);
    return grid;
}

static void add_pixel(double rgb[2][3], int x, int y, ChangeGrid *grid) {
    ChangeSum *cell = &grid->cells[y / grid->side * grid->columns + x / grid->side];
    double most = 0, d[3], luminance[2] = {rgb_luminance(rgb[0]), rgb_luminance(rgb[1])};
    bool differs = false;
    for (int c = 0; c < 3; c++) {
        d[c] = rgb[1][c] - rgb[0][c];
        differs = differs || fabs(d[c]) > ROUNDING * fmax(fabs(rgb[0][c]), fabs(rgb[1][c]));
        most = fmax(most, fabs(d[c]));
        for (int s = 0; s < 2; s++) cell->light[s][c] += rgb[s][c];
    }
    for (int k = 0; k < 6 && differs; k++) cell->changed[k / 3][k % 3] += rgb[k / 3][k % 3];
    double dy = luminance[1] - luminance[0];
    cell->pixels++;
    cell->differing += differs;
    cell->squares += dy * dy;
    for (int k = 0; k < 2; k++) {
        cell->colour[k] += d[2 * k] * d[2 * k];
        cell->cross[k] += d[2 * k] * dy;
    }
    if (!(most > grid->most_difference)) return;
    grid->most_difference = most;
    grid->most = (ChangedPixel){x, y, {luminance[0], luminance[1]}};
}

void change_add_rows(ChangeGrid *grid, const Planes *const light[2], PixelMask mask, int top,
                     const int rows[2]) {
    for (int y = rows[0]; y < rows[1]; y++)
        for (int x = 0; x < grid->width; x++) {
            size_t i = (size_t)(y - top) * (size_t)grid->width + (size_t)x;
            double rgb[2][3];
            if (mask && !mask[i]) continue;
            for (int s = 0; s < 2; s++)
                for (int c = 0; c < 3; c++) rgb[s][c] = (double)light[s]->rgb[c][i];
            add_pixel(rgb, x, y, grid);
        }
}

/* sign: 1 adds, -1 takes away. */
static void join(ChangeSum *to, const ChangeSum *from, double sign) {
    to->pixels += sign * from->pixels;
    to->differing += sign * from->differing;
    to->squares += sign * from->squares;
    for (int s = 0; s < 2; s++) {
        for (int c = 0; c < 3; c++) {
            to->light[s][c] += sign * from->light[s][c];
            to->changed[s][c] += sign * from->changed[s][c];
        }
        to->colour[s] += sign * from->colour[s];
        to->cross[s] += sign * from->cross[s];
    }
}

/* ---- how sure a sum is ------------------------------------------------------------------- */

static double difference_of(const ChangeSum *sum) {
    return rgb_luminance(sum->light[1]) - rgb_luminance(sum->light[0]);
}

static double quotient(double sum, double squares) {
    return squares > 0 ? fabs(sum) / sqrt(squares) : 0;
}

/* In standard errors, what red and blue changed beside the luminance: the sum of d - r dY, with r
 * what they are of the luminance in both together. */
static double colour_quotient(const ChangeSum *sum) {
    double both = rgb_luminance(sum->light[0]) + rgb_luminance(sum->light[1]), most = 0;
    for (int k = 0; k < 2; k++) {
        double r = both > 0 ? (sum->light[0][2 * k] + sum->light[1][2 * k]) / both : 0;
        double beside = sum->light[1][2 * k] - sum->light[0][2 * k] - r * difference_of(sum);
        double squares = sum->colour[k] - 2 * r * sum->cross[k] + r * r * sum->squares;
        most = fmax(most, quotient(beside, squares));
    }
    return most;
}

static double surest(const ChangeSum *sum) {
    return fmax(quotient(difference_of(sum), sum->squares), colour_quotient(sum));
}

/* The greatest change of a channel, as a share of the brighter side's light: 0 .. 1. */
static double size_of(const ChangeSum *cell, double floor) {
    double most = 0;
    for (int c = 0; c < 3; c++) {
        double a = cell->light[0][c], b = cell->light[1][c];
        most = fmax(most, fabs(b - a) / fmax(fmax(fabs(a), fabs(b)), floor * cell->pixels));
    }
    return most;
}

static bool is_lit(const ChangeSum *cell, double floor) {
    return cell->pixels > 0 && fmax(rgb_luminance(cell->light[0]), rgb_luminance(cell->light[1])) >
                                   floor * cell->pixels;
}

static double relative(const ChangeSum *sum) {
    double before = rgb_luminance(sum->light[0]), change = difference_of(sum);
    return change == 0 ? 0 : change / before;
}

static void uv_of(const double light[3], double uv[2]) {
    const float rgb[3] = {(float)light[0], (float)light[1], (float)light[2]};
    float xyz[3];
    xyz_from_rgb(rgb, xyz);
    double sum = (double)xyz[0] + 15 * (double)xyz[1] + 3 * (double)xyz[2];
    uv[0] = sum > 0 ? 4 * (double)xyz[0] / sum : 0.1978; /* D65 */
    uv[1] = sum > 0 ? 9 * (double)xyz[1] / sum : 0.4683;
}

/* ---- where ------------------------------------------------------------------------------- */

static const char *place_of(const ChangeGrid *grid, const LightChange *change, double floor) {
    static const char *const NAMES[4][4] = {{"upper left", "top", "upper right", "top"},
                                            {"left", "centre", "right", "middle"},
                                            {"lower left", "bottom", "lower right", "bottom"},
                                            {"left", "centre", "right", ""}};
    double sum = 0, middle[2] = {0, 0};
    int low[2] = {grid->columns, grid->rows}, high[2] = {-1, -1}, third[2];
    const int size[2] = {grid->columns, grid->rows};
    for (int i = 0; i < grid->columns * grid->rows; i++) {
        if (!change->cells[i]) continue;
        double weight = size_of(&grid->cells[i], floor) * grid->cells[i].pixels;
        const int at[2] = {i % grid->columns, i / grid->columns};
        sum += weight;
        for (int k = 0; k < 2; k++) {
            middle[k] += weight * (at[k] + 0.5);
            if (at[k] < low[k]) low[k] = at[k];
            if (at[k] > high[k]) high[k] = at[k];
        }
    }
    for (int k = 0; k < 2; k++) {
        third[k] = (int)(3 * middle[k] / sum / size[k]);
        if (high[k] - low[k] + 1 > SPREAD * size[k]) third[k] = 3;
    }
    return sum > 0 ? NAMES[third[1]][third[0]] : "";
}

/* The cells that changed; returns how many of them are lit. */
static double mark_cells(const ChangeGrid *grid, double floor, LightChange *out) {
    int count = grid->columns * grid->rows;
    double lit = 0, squares = 0, marked = 0;
    for (int i = 0; i < count; i++) {
        const ChangeSum *cell = &grid->cells[i];
        double size = cell->pixels > 0 ? size_of(cell, floor) : 0;
        lit += is_lit(cell, floor);
        squares += size * size;
    }
    double least = FAINT * sqrt(squares / fmax(lit, 1)), sure = sqrt(2 * log(count / FALSE_CELLS));
    for (int i = 0; i < count; i++) {
        const ChangeSum *cell = &grid->cells[i];
        out->cells[i] = cell->differing > 0 && size_of(cell, floor) >= least &&
                        (!out->is_noisy || surest(cell) > sure);
        if (!out->cells[i]) continue;
        join(&out->area, cell, 1);
        marked += is_lit(cell, floor);
    }
    return marked / fmax(lit, 1);
}

/* ---- one box ----------------------------------------------------------------------------- */

#define BOX_ALONG 24 /* cells, or groups of them, of which all boxes are tried */
#define EXACT 1e-3   /* of a cell's light: no noise makes it surer */
#define KINDS 3      /* luminance, red, blue */

/* A change f of a box in proportion: its cells send L, are known with the variance V, which is
 * that of pixels about their own cell's mean, there and in the cells around, in proportion to L^2,
 * and differ by d = f L. With S = sum(L d / V) and Q = sum(L^2 / V) least squares give f = S / Q,
 * known to 1 / sqrt(Q), and S^2 / Q is by how much the box explains d better than no change.
 * However noise differs from place to place, what is even all over is explained best by all. */
typedef struct BoxSums {
    double s[KINDS], q[KINDS];
} BoxSums;

typedef struct ChangeBox {
    int low[2], high[2]; /* columns, rows: half-open */
    double explains;     /* S^2 / Q, of the kind that has most */
} ChangeBox;

/* Of one kind: the light of a cell, mean of both sides, and its difference. */
static double light_of(const ChangeSum *cell, int kind, double *difference) {
    double side[2];
    for (int i = 0; i < 2; i++)
        side[i] = kind ? cell->light[i][2 * (kind - 1)] : rgb_luminance(cell->light[i]);
    *difference = side[1] - side[0];
    return 0.5 * fabs(side[0] + side[1]);
}

/* V / L^2 of a cell. */
static double noise_around(const ChangeGrid *grid, int x, int y, int kind) {
    double sum = 0, cells = 0, d;
    for (int i = 0; i < 9; i++) {
        int u = x + i % 3 - 1, v = y + i / 3 - 1;
        if (u < 0 || v < 0 || u >= grid->columns || v >= grid->rows) continue;
        const ChangeSum *cell = &grid->cells[v * grid->columns + u];
        double light = light_of(cell, kind, &d), n = cell->pixels;
        double squares = kind ? cell->colour[kind - 1] : cell->squares;
        if (!(n > 1 && light > 0)) continue;
        sum += (squares - d * d / n) * n / (n - 1) / (light * light);
        cells++;
    }
    return fmax(sum / fmax(cells, 1), EXACT * EXACT);
}

static BoxSums box_sums_of(const ChangeGrid *grid, int x, int y) {
    BoxSums out = {{0}, {0}};
    for (int k = 0; k < KINDS; k++) {
        double d, light = light_of(&grid->cells[y * grid->columns + x], k, &d);
        double noise = noise_around(grid, x, y, k);
        out.s[k] = light > 0 ? d / light / noise : 0;
        out.q[k] = light > 0 ? 1 / noise : 0;
    }
    return out;
}

static void add_box(BoxSums *to, const BoxSums *from, double sign) {
    for (int k = 0; k < KINDS; k++) {
        to->s[k] += sign * from->s[k];
        to->q[k] += sign * from->q[k];
    }
}

/* Of the cells above and to the left of each corner, [(rows + 1) (columns + 1)]. */
static BoxSums *corner_sums(const ChangeGrid *grid, Arena *arena) {
    size_t wide = (size_t)grid->columns + 1;
    BoxSums *at = ARENA_NEW(arena, BoxSums, wide * ((size_t)grid->rows + 1));
    for (int y = 0; y < grid->rows; y++)
        for (int x = 0; x < grid->columns; x++) {
            BoxSums *to = &at[((size_t)y + 1) * wide + (size_t)x + 1];
            *to = box_sums_of(grid, x, y);
            add_box(to, to - 1, 1);
            add_box(to, to - wide, 1);
            add_box(to, to - wide - 1, -1);
        }
    return at;
}

static void try_box(const ChangeGrid *grid, const BoxSums *corners, ChangeBox box,
                    ChangeBox *best) {
    const int most[2] = {grid->columns, grid->rows};
    for (int k = 0; k < 2; k++) {
        if (box.high[k] > most[k]) box.high[k] = most[k];
        if (box.low[k] < 0 || box.low[k] >= box.high[k]) return;
    }
    const BoxSums *top = &corners[box.low[1] * (grid->columns + 1)];
    const BoxSums *bottom = &corners[box.high[1] * (grid->columns + 1)];
    BoxSums sum = bottom[box.high[0]];
    add_box(&sum, &bottom[box.low[0]], -1);
    add_box(&sum, &top[box.high[0]], -1);
    add_box(&sum, &top[box.low[0]], 1);
    box.explains = 0;
    for (int k = 0; k < KINDS; k++)
        if (sum.q[k] > 0) box.explains = fmax(box.explains, sum.s[k] * sum.s[k] / sum.q[k]);
    if (box.explains > best->explains) *best = box;
}

/* The best of all boxes: of groups of cells first, then its edges by less and less. */
static ChangeBox best_box(const ChangeGrid *grid, const BoxSums *corners, double *tried) {
    int columns = grid->columns, rows = grid->rows, most = columns > rows ? columns : rows;
    int step = (most + BOX_ALONG - 1) / BOX_ALONG;
    ChangeBox best = {.explains = 0};
    *tried = 0;
    for (int y0 = 0; y0 < rows; y0 += step)
        for (int y1 = y0 + step; y1 < rows + step; y1 += step)
            for (int x0 = 0; x0 < columns; x0 += step)
                for (int x1 = x0 + step; x1 < columns + step; x1 += step, ++*tried)
                    try_box(grid, corners, (ChangeBox){{x0, y0}, {x1, y1}, 0}, &best);
    for (; step > 0; step /= 2)
        for (double before = -1; best.explains > before;) {
            before = best.explains;
            for (int edge = 0; edge < 8; edge++) {
                ChangeBox box = best;
                (edge & 1 ? box.high : box.low)[edge >> 1 & 1] += edge & 4 ? step : -step;
                try_box(grid, corners, box, &best);
            }
        }
    return best;
}

/* How much light changed, either way. */
static double weight_of(const ChangeSum *sum) {
    double weight = 0;
    for (int c = 0; c < 3; c++) weight += fabs(sum->light[1][c] - sum->light[0][c]);
    return weight;
}

/* Takes the best box for what changed in independent noise, where it explains clearly more than
 * the whole picture does and holds most of what changed. A single cell stands out by chance, too,
 * and by more than it changed. */
static bool take_box(const ChangeGrid *grid, double floor, LightChange *out, Arena scratch) {
    int count = grid->columns * grid->rows;
    const BoxSums *corners = corner_sums(grid, &scratch);
    double tried, lit = 0, within = 0, outside = 0;
    ChangeBox box = best_box(grid, corners, &tried), all = {.explains = 0};
    try_box(grid, corners, (ChangeBox){{0, 0}, {grid->columns, grid->rows}, 0}, &all);
    if (!(box.explains > all.explains + 2 * log(tried / FALSE_CELLS))) return false;
    unsigned char *in_box = ARENA_NEW(&scratch, unsigned char, count);
    ChangeSum sum = {0}, rest = out->all;
    for (int i = 0; i < count; i++) {
        const ChangeSum *cell = &grid->cells[i];
        int x = i % grid->columns, y = i / grid->columns;
        bool is_in = x >= box.low[0] && x < box.high[0] && y >= box.low[1] && y < box.high[1];
        in_box[i] = is_in && cell->differing > 0;
        lit += is_lit(cell, floor);
        within += is_in && is_lit(cell, floor);
        if (is_in) join(&sum, cell, 1);
        else if (out->cells[i]) outside += weight_of(cell);
    }
    join(&rest, &sum, -1);
    if (surest(&rest) > SURE) outside = fmax(outside, weight_of(&rest));
    if (within >= EVERYWHERE * lit || outside > OUTSIDE * weight_of(&sum)) return false;
    memcpy(out->cells, in_box, (size_t)count);
    out->area = sum;
    return true;
}

/* What changes a little in every cell shows in those together that are not sure by themselves,
 * and in half of them by half as much at least. */
static bool is_everywhere(const ChangeGrid *grid, const LightChange *change, double floor,
                          double marked) {
    ChangeSum rest = change->all;
    double size = relative(marked > 0 ? &change->area : &change->all), lit = 0, agree = 0;
    if (marked >= EVERYWHERE) return true;
    if (!change->is_noisy) return false;
    join(&rest, &change->area, -1);
    for (int i = 0; i < grid->columns * grid->rows; i++) {
        const ChangeSum *cell = &grid->cells[i];
        if (!is_lit(cell, floor)) continue;
        lit++;
        agree += size > 0 ? relative(cell) > 0.5 * size : relative(cell) < 0.5 * size;
    }
    return surest(&rest) > SURE && fabs(relative(&rest)) >= 0.5 * fabs(size) && agree >= 0.5 * lit;
}

LightChange change_find(const ChangeGrid *grid, bool is_paired, double floor, Arena *arena) {
    int count = grid->columns * grid->rows;
    double ways = 0, scatter = 0, uv[2][2];
    LightChange out = {.cells = ARENA_NEW(arena, unsigned char, count), .place = ""};
    for (int i = 0; i < count; i++) join(&out.all, &grid->cells[i], 1);
    out.is_noisy = !is_paired && out.all.differing > NOISY * out.all.pixels;
    for (int s = 0; s < 2; s++)
        floor = fmax(floor, DARK * rgb_luminance(out.all.light[s]) / fmax(out.all.pixels, 1));
    double marked = mark_cells(grid, floor, &out);
    out.is_box = out.is_noisy && take_box(grid, floor, &out, *arena);
    out.is_everywhere = !out.is_box && is_everywhere(grid, &out, floor, marked);
    if (out.is_everywhere) out.area = out.all;
    else out.place = place_of(grid, &out, floor);
    for (int i = 0; i < count; i++)
        if (out.is_everywhere || out.cells[i]) {
            ways += fabs(difference_of(&grid->cells[i]));
            scatter += sqrt(grid->cells[i].squares);
        }
    out.share = (out.is_noisy ? out.area.pixels : out.area.differing) / fmax(out.all.pixels, 1);
    if (out.is_noisy)
        out.half_width = 1.96 * sqrt(out.area.squares) / rgb_luminance(out.area.light[0]);
    else if (!out.is_everywhere) memcpy(out.area.light, out.area.changed, sizeof out.area.light);
    out.luminance = relative(&out.area);
    out.is_both_ways = fabs(difference_of(&out.area)) < FAINT * ways && ways > scatter &&
                       ways > LEAST_WAYS * rgb_luminance(out.area.light[0]);
    for (int s = 0; s < 2; s++) uv_of(out.area.light[s], uv[s]);
    out.uv = hypot(uv[1][0] - uv[0][0], uv[1][1] - uv[0][1]);
    double sides[2] = {rgb_luminance(out.area.light[0]), rgb_luminance(out.area.light[1])};
    out.has_colour = out.uv >= LEAST_UV &&
                     fmin(sides[0], sides[1]) > DARK * fmax(sides[0], sides[1]) &&
                     (!out.is_noisy || colour_quotient(&out.area) > SURE);
    return out;
}

/* ---- one pixel --------------------------------------------------------------------------- */

static int by_size(const void *a, const void *b) {
    float one = *(const float *)a, other = *(const float *)b;
    return (one > other) - (one < other);
}

/* The most that the other side has around a pixel, and the median around it on its own. */
static double around(const float *const luminance[2], int bright, const Planes *size, int x,
                     int y) {
    float most = 0, own[8];
    size_t count = 0;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            if (u < 0 || v < 0 || u >= size->width || v >= size->height) continue;
            size_t i = (size_t)v * (size_t)size->width + (size_t)u;
            most = fmaxf(most, luminance[1 - bright][i]);
            if (u != x || v != y) own[count++] = luminance[bright][i];
        }
    qsort(own, count, sizeof *own, by_size);
    return (double)fmaxf(most, count ? own[count / 2] : 0);
}

Standout change_standout(const Planes *const light[2], PixelMask mask, const float *sigma,
                         Arena scratch) {
    const Planes *size = light[0];
    size_t count = planes_pixel_count(size);
    float *luminance[2];
    double mean[2] = {0, 0}, pixels = 0, rest = 0;
    Standout best[2][2] = {{{0}}}; /* brighter in: explained */
    for (int s = 0; s < 2; s++) {
        luminance[s] = ARENA_NEW(&scratch, float, count);
        for (size_t i = 0; i < count; i++) {
            const float rgb[3] = {light[s]->rgb[0][i], light[s]->rgb[1][i], light[s]->rgb[2][i]};
            luminance[s][i] = luminance_from_rgb(rgb);
            if (!mask[i]) continue;
            mean[s] += (double)luminance[s][i];
            pixels += s;
        }
    }
    double floor = fmin(mean[0], mean[1]) / fmax(pixels, 1) / 100;
    for (size_t i = 0; i < count; i++) {
        int bright = luminance[1][i] > luminance[0][i];
        double most = (double)luminance[bright][i], least = (double)luminance[1 - bright][i];
        int x = (int)(i % (size_t)size->width), y = (int)(i / (size_t)size->width);
        if (!mask[i]) continue;
        if (!(most > STANDOUT * fmax(least, floor)) ||
            !(most > STANDOUT * around((const float *const *)luminance, bright, size, x, y))) {
            rest = fmax(rest, most - least);
            continue;
        }
        bool is_explained = sigma && !(most - least > STANDOUT_SIGMAS * (double)sigma[i]);
        Standout *to = &best[bright][is_explained];
        to->is_explained = is_explained;
        to->count++;
        if (to->count > 1 && most - least <= fabs(to->most.luminance[1] - to->most.luminance[0]))
            continue;
        to->most = (ChangedPixel){x, y, {(double)luminance[0][i], (double)luminance[1][i]}};
    }
    for (int explained = 0; explained < 2; explained++) {
        double reach[2];
        for (int s = 0; s < 2; s++) {
            const ChangedPixel *p = &best[s][explained].most;
            reach[s] = fabs(p->luminance[1] - p->luminance[0]);
        }
        int s = reach[1] >= reach[0];
        best[s][explained].rest = rest;
        if (best[s][explained].count && (!explained || reach[s] > STANDOUT_LIKE * reach[1 - s]))
            return best[s][explained];
    }
    return (Standout){0};
}
