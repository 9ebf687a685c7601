/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/flip.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/arena.h"
#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/lab.h"
#include "compare/metrics/planes.h"
#include "compare/metrics/rank.h"
#include "image/colour.h"

/* ---- one tile --------------------------------------------------------------------------- */

/* LDR-FLIP of one part of a picture, at one exposure after the other.
 *
 * A tile is at most FLIP_TILE columns wide and as high as one likes: the rows that the filters
 * along x have done stand in a ring as high as the filters along y, so that what a tile needs
 * of memory fits a cache and does not grow with the picture. A pixel's value depends on no
 * tile's border. */

enum { FLIP_TILE = 128 }; /* columns */

typedef struct FlipJob {
    const Planes *reference, *test;
    FlipFilters filters;
    ColourMatrix ratios_from_rgb, rgb_from_ratios;
    double log_most;              /* of the difference of pure green and pure blue, a power */
    double log_knee, log_stretch; /* of colour differences, see flip_tile.c */
    bool is_hdr;
    int exposures;       /* LDR: 1 */
    const double *gains; /* HDR: 2^ev, one per exposure */
    float *map;          /* zeroed before the tiles start */
} FlipJob;

typedef struct FlipScratch FlipScratch;

typedef struct FlipTile {
    int x0, x1, y0, y1; /* pixels; x1 and y1 are the first ones outside */
} FlipTile;

#define COLOUR_POWER 0.7
#define KNEE 0.4         /* of the greatest colour difference ... */
#define KNEE_MAPPED 0.95 /* ... is mapped to this */

/* sRGB to XYZ as FLIP has it, in 1 / 73733382; only ratios to white are needed. */
static const ColourMatrix FLIP_XYZ_FROM_RGB = {
    {{30406656, 26366430, 13305225}, {15678432, 52732860, 5322090}, {1425312, 8788810, 70074185}}};

/* FLIP filters Y, Cx and Cz (lightness, red against green, blue against yellow), which are
 * linear in XYZ over that of white (x, y, z): 116 y - 16, 500 (x - y), 200 (y - z). The
 * smoothing filters have the sum 1, so the factors and the offset may as well be left out:
 * here the channels are y, x - y and y - z; y is also the grey that features are sought in. */
enum { GREY, RED_GREEN, BLUE_YELLOW, CHANNELS };

/* One picture's row after the filters along x. */
typedef struct RingRow {
    double grey[FLIP_TILE], red_green[FLIP_TILE], blue_yellow[2][FLIP_TILE];
    double gauss[FLIP_TILE], slope[FLIP_TILE], curve[FLIP_TILE];
} RingRow;

/* One picture's row after those along y. */
typedef struct Filtered {
    double channel[CHANNELS][FLIP_TILE];
    double slope_x[FLIP_TILE], slope_y[FLIP_TILE], curve_x[FLIP_TILE], curve_y[FLIP_TILE];
} Filtered;

enum { REFERENCE, TEST, PICTURES };

struct FlipScratch {
    double *line[CHANNELS];  /* a row before the filters: FLIP_TILE + 2 radius */
    RingRow *ring[PICTURES]; /* row y at y % (2 radius + 1) */
    Filtered filtered[PICTURES];
};

/* Lightness and chromas, which weigh less in the dark: Hunt's effect. */
static void hunt_lab(const double ratios[3], double lab[3]) {
    lab_from_ratios(ratios, lab);
    lab[1] *= 0.01 * lab[0];
    lab[2] *= 0.01 * lab[0];
}

/* HyAB: lightness and chroma are seen apart. */
static double colour_distance(const double a[3], const double b[3]) {
    double da = a[1] - b[1], db = a[2] - b[2];
    return fabs(a[0] - b[0]) + sqrt(da * da + db * db);
}

/* Constants and filters; all that is left is 0. */
static FlipJob flip_job_create(const Planes *reference, const Planes *test,
                               double pixels_per_degree, Arena *arena) {
    FlipJob job = {.reference = reference,
                   .test = test,
                   .filters = flip_filters_create(pixels_per_degree, arena),
                   .ratios_from_rgb = relative_to_white(FLIP_XYZ_FROM_RGB)};
    job.rgb_from_ratios = colour_inverse(&job.ratios_from_rgb);
    double ratios[3], green[3], blue[3];
    apply_matrix(&job.ratios_from_rgb, (const double[3]){0, 1, 0}, ratios);
    hunt_lab(ratios, green);
    apply_matrix(&job.ratios_from_rgb, (const double[3]){0, 0, 1}, ratios);
    hunt_lab(ratios, blue);
    job.log_most = COLOUR_POWER * log_d(colour_distance(green, blue));
    job.log_knee = log_d(KNEE);
    job.log_stretch = log_d(KNEE_MAPPED / KNEE);
    return job;
}

static FlipScratch *flip_scratch_create(const FlipJob *job, Arena *arena) {
    FlipScratch *scratch = ARENA_NEW(arena, FlipScratch, 1);
    int height = 2 * job->filters.radius + 1;
    for (int c = 0; c < CHANNELS; c++)
        scratch->line[c] = ARENA_NEW(arena, double, FLIP_TILE + height - 1);
    for (int p = 0; p < PICTURES; p++) scratch->ring[p] = ARENA_NEW(arena, RingRow, height);
    return scratch;
}

static double clamp_unit(double value) {
    return value > 1 ? 1 : value > 0 ? value : 0;
}

/* How a display shows light of any scale, which may be above 1: ACES as fitted in FLIP 1.6, a
 * quotient of polynomials. */
static const double ACES[6] = {0.36 * 2.51, 0.6 * 0.03, 0, 0.36 * 2.43, 0.6 * 0.59, 0.14};

static double tone_mapped(double x) {
    return (ACES[0] * x * x + ACES[1] * x + ACES[2]) / (ACES[3] * x * x + ACES[4] * x + ACES[5]);
}

/* The light that is shown as `shown`, 0 < shown < 1. */
static double light_of_shown(double shown) {
    double a = ACES[0] - shown * ACES[3], b = ACES[1] - shown * ACES[4];
    double c = ACES[2] - shown * ACES[5];
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

/* Pixel i as a display of the exposure shows it, 0 .. 1. */
static void displayed_rgb(const FlipJob *job, const Planes *planes, size_t i, double gain,
                          double rgb[3]) {
    for (int c = 0; c < 3; c++) {
        double value = (double)planes->rgb[c][i];
        rgb[c] = value > 0 ? value : 0;
    }
    if (job->is_hdr) {
        for (int c = 0; c < 3; c++) rgb[c] = tone_mapped(gain * rgb[c]);
    }
    for (int c = 0; c < 3; c++) rgb[c] = clamp_unit(rgb[c]);
}

/* Outside the picture its border goes on. */
static void set_line(const FlipJob *job, const Planes *planes, int x0, int y, double gain,
                     FlipScratch *scratch) {
    const int radius = job->filters.radius, width = planes->width;
    for (int k = 0; k < FLIP_TILE + 2 * radius; k++) {
        int x = x0 - radius + k;
        double rgb[3], ratios[3];
        x = x < 0 ? 0 : x >= width ? width - 1 : x;
        displayed_rgb(job, planes, (size_t)y * (size_t)width + (size_t)x, gain, rgb);
        apply_matrix(&job->ratios_from_rgb, rgb, ratios);
        scratch->line[GREY][k] = ratios[1];
        scratch->line[RED_GREEN][k] = ratios[0] - ratios[1];
        scratch->line[BLUE_YELLOW][k] = ratios[1] - ratios[2];
    }
}

/* The four loops that nearly all the time is spent in: they have one length that the compiler
 * knows, so that it does several columns at once. */
static void put_scaled(double weight, const double *restrict a, double *restrict sum) {
    for (int x = 0; x < FLIP_TILE; x++) sum[x] = weight * a[x];
}

static void add_pair(double weight, const double *restrict a, const double *restrict b,
                     double *restrict sum) {
    for (int x = 0; x < FLIP_TILE; x++) sum[x] += weight * (a[x] + b[x]);
}

static void add_slope(double weight, const double *restrict a, const double *restrict b,
                      double *restrict sum) {
    for (int x = 0; x < FLIP_TILE; x++) sum[x] += weight * (b[x] - a[x]);
}

/* The weights of all of them have the sum 0; taken from the centre, an even surface gives 0
 * exactly. (The feature difference is a square root: 1e-16 would come out as 1e-8.) */
static void add_curve(double weight, const double *const abc[3], double *restrict sum) {
    const double *restrict a = abc[0], *restrict centre = abc[1], *restrict b = abc[2];
    for (int x = 0; x < FLIP_TILE; x++)
        sum[x] += weight * ((a[x] - centre[x]) + (b[x] - centre[x]));
}

static void smooth_line(const FlipFilter *filter, const double *line, double *sum) {
    put_scaled(filter->weights[0], line, sum);
    for (int k = 1; k <= filter->radius; k++) add_pair(filter->weights[k], line - k, line + k, sum);
}

static void filter_line(const FlipJob *job, const FlipScratch *scratch, RingRow *row) {
    const FlipFilters *f = &job->filters;
    const double *grey = scratch->line[GREY] + f->radius;
    const double *blue_yellow = scratch->line[BLUE_YELLOW] + f->radius;
    smooth_line(&f->lightness, grey, row->grey);
    smooth_line(&f->red_green, scratch->line[RED_GREEN] + f->radius, row->red_green);
    smooth_line(&f->blue_yellow[0], blue_yellow, row->blue_yellow[0]);
    smooth_line(&f->blue_yellow[1], blue_yellow, row->blue_yellow[1]);
    smooth_line(&f->gauss, grey, row->gauss);
    put_scaled(0, grey, row->slope);
    put_scaled(0, grey, row->curve);
    for (int k = 1; k <= f->gauss.radius; k++) {
        add_slope(f->slope.weights[k], grey - k, grey + k, row->slope);
        add_curve(f->curve.weights[k], (const double *[3]){grey - k, grey, grey + k}, row->curve);
    }
}

/* The rows k above and k below row y; the picture's border goes on. */
typedef struct RowPair {
    const RingRow *above, *below;
} RowPair;

static RowPair rows_around(const FlipJob *job, const RingRow *ring, int y, int k) {
    int height = job->reference->height, slots = 2 * job->filters.radius + 1;
    int above = y - k < 0 ? 0 : y - k, below = y + k < height ? y + k : height - 1;
    return (RowPair){ring + above % slots, ring + below % slots};
}

static void smooth_column(const FlipJob *job, const RingRow *ring, int y, Filtered *out) {
    const FlipFilters *f = &job->filters;
    const RingRow *centre = rows_around(job, ring, y, 0).above;
    put_scaled(f->lightness.weights[0], centre->grey, out->channel[GREY]);
    put_scaled(f->red_green.weights[0], centre->red_green, out->channel[RED_GREEN]);
    put_scaled(0, centre->grey, out->channel[BLUE_YELLOW]);
    for (int i = 0; i < 2; i++)
        add_pair(f->blue_yellow[i].weights[0] / 2, centre->blue_yellow[i], centre->blue_yellow[i],
                 out->channel[BLUE_YELLOW]);
    for (int k = 1; k <= f->radius; k++) {
        const RowPair rows = rows_around(job, ring, y, k);
        if (k <= f->lightness.radius)
            add_pair(f->lightness.weights[k], rows.above->grey, rows.below->grey,
                     out->channel[GREY]);
        if (k <= f->red_green.radius)
            add_pair(f->red_green.weights[k], rows.above->red_green, rows.below->red_green,
                     out->channel[RED_GREEN]);
        for (int i = 0; i < 2; i++)
            if (k <= f->blue_yellow[i].radius)
                add_pair(f->blue_yellow[i].weights[k], rows.above->blue_yellow[i],
                         rows.below->blue_yellow[i], out->channel[BLUE_YELLOW]);
    }
}

static void feature_column(const FlipJob *job, const RingRow *ring, int y, Filtered *out) {
    const FlipFilters *f = &job->filters;
    const RingRow *centre = rows_around(job, ring, y, 0).above;
    put_scaled(f->gauss.weights[0], centre->slope, out->slope_x);
    put_scaled(f->gauss.weights[0], centre->curve, out->curve_x);
    put_scaled(0, centre->gauss, out->slope_y);
    put_scaled(0, centre->gauss, out->curve_y);
    for (int k = 1; k <= f->gauss.radius; k++) {
        const RowPair rows = rows_around(job, ring, y, k);
        const RingRow *above = rows.above, *below = rows.below;
        add_pair(f->gauss.weights[k], above->slope, below->slope, out->slope_x);
        add_pair(f->gauss.weights[k], above->curve, below->curve, out->curve_x);
        add_slope(f->slope.weights[k], above->gauss, below->gauss, out->slope_y);
        add_curve(f->curve.weights[k],
                  (const double *[3]){above->gauss, centre->gauss, below->gauss}, out->curve_y);
    }
}

/* A pixel's colour after the eye's filters, for colour_distance. */
static void seen_lab(const FlipJob *job, const Filtered *filtered, int x, double lab[3]) {
    double y = filtered->channel[GREY][x], rgb[3];
    double ratios[3] = {y + filtered->channel[RED_GREEN][x], y,
                        y - filtered->channel[BLUE_YELLOW][x]};
    apply_matrix(&job->rgb_from_ratios, ratios, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = clamp_unit(rgb[c]);
    apply_matrix(&job->ratios_from_rgb, rgb, ratios);
    hunt_lab(ratios, lab);
}

/* Natural logarithm, since a power of it is required; -infinity for equal colours. Small
 * differences are stretched: those up to KNEE of the greatest fill 0 .. KNEE_MAPPED. */
static double log_colour_difference(const FlipJob *job, const FlipScratch *scratch, int x) {
    double reference[3], test[3];
    seen_lab(job, &scratch->filtered[REFERENCE], x, reference);
    seen_lab(job, &scratch->filtered[TEST], x, test);
    double distance = colour_distance(reference, test);
    double log_part = COLOUR_POWER * (double)log_f((float)distance) - job->log_most;
    if (log_part < job->log_knee) return log_part + job->log_stretch;
    double part = (double)exp_f((float)log_part);
    return (double)log_f((float)(KNEE_MAPPED + (part - KNEE) * (1 - KNEE_MAPPED) / (1 - KNEE)));
}

static double length(double x, double y) {
    return sqrt(x * x + y * y);
}

/* The difference of edges or of points, whichever is greater; 1 for the sharpest possible
 * ones. */
static double feature_difference(const FlipScratch *scratch, int x) {
    const Filtered *r = &scratch->filtered[REFERENCE], *t = &scratch->filtered[TEST];
    double edges =
        fabs(length(r->slope_x[x], r->slope_y[x]) - length(t->slope_x[x], t->slope_y[x]));
    double points =
        fabs(length(r->curve_x[x], r->curve_y[x]) - length(t->curve_x[x], t->curve_y[x]));
    return sqrt((edges > points ? edges : points) * 0.7071067811865476);
}

static void set_pixels(const FlipJob *job, FlipTile tile, int y, const FlipScratch *scratch) {
    size_t first = (size_t)y * (size_t)job->reference->width;
    for (int x = tile.x0; x < tile.x1; x++) {
        size_t i = first + (size_t)x;
        double log_colour = log_colour_difference(job, scratch, x - tile.x0);
        if (log_colour == (double)-INFINITY) continue;
        double feature = feature_difference(scratch, x - tile.x0);
        float value = clampf(exp_f((float)((1 - feature) * log_colour)), 0, 1);
        if (value > job->map[i]) job->map[i] = value;
    }
}

static void flip_exposure(const FlipJob *job, FlipTile tile, int exposure, FlipScratch *scratch) {
    const Planes *pictures[PICTURES] = {job->reference, job->test};
    const int radius = job->filters.radius, height = job->reference->height;
    const double gain = job->is_hdr ? job->gains[exposure] : 1;
    int next = tile.y0 > radius ? tile.y0 - radius : 0; /* row for the ring */
    for (int y = tile.y0; y < tile.y1; y++) {
        for (; next < height && next <= y + radius; next++)
            for (int p = 0; p < PICTURES; p++) {
                set_line(job, pictures[p], tile.x0, next, gain, scratch);
                filter_line(job, scratch, scratch->ring[p] + next % (2 * radius + 1));
            }
        for (int p = 0; p < PICTURES; p++) {
            smooth_column(job, scratch->ring[p], y, &scratch->filtered[p]);
            feature_column(job, scratch->ring[p], y, &scratch->filtered[p]);
        }
        set_pixels(job, tile, y, scratch);
    }
}

/* Raises map to the greatest of all exposures. */
static void flip_tile(const FlipJob *job, FlipTile tile, FlipScratch *scratch) {
    for (int i = 0; i < job->exposures; i++) flip_exposure(job, tile, i, scratch);
}

/* ---- what a mask leaves out ------------------------------------------------------------- */

/* A picture that ends where its mask does: for filters that reach over it.
 *
 * A pixel that does not count takes the value of the nearest one in its row that does; a row
 * without any is the nearest one that has some. So what lies under a mask decides nothing, and
 * pictures go on beyond it as FLIP lets them go on beyond their border. */

/* The nearest column of a row that counts for each column; false when none does. */
static bool nearest_columns(const unsigned char *mask, int width, int *nearest) {
    int last = -1;
    for (int x = 0; x < width; x++) {
        if (mask[x]) last = x;
        nearest[x] = last;
    }
    if (last < 0) return false;
    for (int x = width - 1, next = -1; x >= 0; x--) {
        if (mask[x]) next = x;
        if (next >= 0 && (nearest[x] < 0 || next - x < x - nearest[x])) nearest[x] = next;
    }
    return true;
}

/* Rows that have no values take those of the nearest row that has. */
static void fill_rows(float *plane, const bool *has, int width, int height) {
    for (int y = 0; y < height; y++) {
        int above = y, below = y;
        while (above >= 0 && !has[above]) above--;
        while (below < height && !has[below]) below++;
        int from = above < 0 || (below < height && below - y < y - above) ? below : above;
        if (from != y && from < height)
            memcpy(plane + (size_t)y * (size_t)width, plane + (size_t)from * (size_t)width,
                   (size_t)width * sizeof *plane);
    }
}

static bool all_count(const Planes *picture, PixelMask mask) {
    return !mask || !memchr(mask, 0, planes_pixel_count(picture));
}

/* The picture itself where every pixel counts, and black where none does. */
static Planes mask_fill(const Planes *picture, PixelMask mask, Arena *arena) {
    Planes out = *picture;
    int width = out.width;
    if (all_count(picture, mask)) return out;
    float *plane[3];
    for (int c = 0; c < 3; c++)
        out.rgb[c] = plane[c] = ARENA_NEW(arena, float, planes_pixel_count(picture));
    bool *has = ARENA_NEW(arena, bool, out.height);
    int *nearest = ARENA_NEW(arena, int, width);
    for (int y = 0; y < out.height; y++) {
        size_t row = (size_t)y * (size_t)width;
        has[y] = nearest_columns(mask + row, width, nearest);
        for (int x = 0; has[y] && x < width; x++)
            for (int c = 0; c < 3; c++)
                plane[c][row + (size_t)x] = picture->rgb[c][row + (size_t)nearest[x]];
    }
    for (int c = 0; c < 3; c++) fill_rows(plane[c], has, width, out.height);
    return out;
}

enum { TILE_ROWS = 128 };

typedef struct Tiles {
    const FlipJob *job;
    FlipScratch **scratch; /* of each worker */
    int columns;
} Tiles;

static int lower(int a, int b) {
    return a < b ? a : b;
}

static void work_on_tile(void *context, int item, int worker) {
    const Tiles *tiles = context;
    const Planes *picture = tiles->job->reference;
    int x0 = item % tiles->columns * FLIP_TILE;
    int y0 = item / tiles->columns * TILE_ROWS;
    FlipTile tile = {x0, lower(x0 + FLIP_TILE, picture->width), y0,
                     lower(y0 + TILE_ROWS, picture->height)};
    flip_tile(tiles->job, tile, tiles->scratch[worker]);
}

static void run(const FlipJob *job, int threads, Arena scratch) {
    const Planes *picture = job->reference;
    size_t count = planes_pixel_count(picture);
    int columns = (picture->width + FLIP_TILE - 1) / FLIP_TILE;
    int items = columns * ((picture->height + TILE_ROWS - 1) / TILE_ROWS);
    int workers = lower(lower(threads, items), PARALLEL_THREADS_MAX);
    Tiles tiles = {job, ARENA_NEW(&scratch, FlipScratch *, workers), columns};
    for (int i = 0; i < workers; i++) tiles.scratch[i] = flip_scratch_create(job, &scratch);
    memset(job->map, 0, count * sizeof *job->map);
    parallel_for(workers, items, work_on_tile, &tiles);
}

static double chosen_ppd(const FlipOptions *options) {
    return options->pixels_per_degree > 0 ? options->pixels_per_degree : FLIP_PIXELS_PER_DEGREE;
}

void flip_ldr(const Planes *reference, const Planes *test, const FlipOptions *options,
              Arena scratch, float *map) {
    const Planes filled[2] = {mask_fill(reference, options->mask, &scratch),
                              mask_fill(test, options->mask, &scratch)};
    FlipJob job = flip_job_create(&filled[0], &filled[1], chosen_ppd(options), &scratch);
    job.exposures = 1;
    job.map = map;
    run(&job, options->threads, scratch);
}

/* The greatest and the median luminance of what is not black; false for a black picture. The
 * median is that of FLIP 1.6 where less than half of the picture is black; beyond that the
 * authors' is 0, and their range has no end. */
static bool find_luminances(const Planes *picture, PixelMask mask, Arena scratch, double *median,
                            double *most) {
    size_t count = planes_pixel_count(picture), lit = 0, counting = 0;
    float *luminance = ARENA_NEW(&scratch, float, count);
    unsigned char *is_lit = ARENA_NEW(&scratch, unsigned char, count);
    for (size_t i = 0; i < count; i++) {
        const float weights[3] = {0.2126f, 0.7152f, 0.0722f};
        if (mask && !mask[i]) continue;
        counting++;
        for (int c = 0; c < 3; c++) luminance[i] += weights[c] * fmaxf(picture->rgb[c][i], 0);
        is_lit[i] = luminance[i] > 0;
        lit += is_lit[i];
    }
    if (!lit) return false;
    *most = (double)rank_value(luminance, count, mask, 1);
    /* the value at counting / 2, counted from 0 */
    double middle = ((double)(counting / 2) + 0.5) / (double)counting;
    *median = (double)rank_value(luminance, count, mask, middle);
    if (!(*median > 0)) *median = (double)rank_value(luminance, count, is_lit, 0.5);
    return true;
}

/* The brightest light just so at 0.85, and the median just so. */
static FlipExposures find_exposures(const Planes *reference, const FlipOptions *options,
                                    Arena scratch) {
    FlipExposures range = {options->start_ev, options->stop_ev, options->exposures};
    double median, most, bright = light_of_shown(0.85);
    if (!options->has_range) {
        bool has_light = find_luminances(reference, options->mask, scratch, &median, &most);
        range.start_ev = has_light ? log2_d(bright / most) : 0;
        range.stop_ev = has_light ? log2_d(bright / median) : 1;
    }
    double span = ceil(range.stop_ev - range.start_ev);
    if (range.count <= 0) range.count = span > 2 ? (int)span : 2;
    if (range.stop_ev == range.start_ev) range.count = 1;
    return range;
}

FlipExposures flip_hdr(const Planes *reference, const Planes *test, const FlipOptions *options,
                       Arena scratch, float *map) {
    const Planes filled[2] = {mask_fill(reference, options->mask, &scratch),
                              mask_fill(test, options->mask, &scratch)};
    FlipJob job = flip_job_create(&filled[0], &filled[1], chosen_ppd(options), &scratch);
    const FlipExposures range = find_exposures(reference, options, scratch);
    double *gains = ARENA_NEW(&scratch, double, range.count);
    double step = range.count > 1 ? (range.stop_ev - range.start_ev) / (range.count - 1) : 0;
    for (int i = 0; i < range.count; i++) gains[i] = exp2_d(range.start_ev + i * step);
    job.is_hdr = true;
    job.exposures = range.count;
    job.gains = gains;
    job.map = map;
    run(&job, options->threads, scratch);
    return range;
}
