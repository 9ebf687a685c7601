/* SPDX-License-Identifier: Apache-2.0 */
#include "render/noise_stop.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"
#include "render/favour.h"
#include "render/forecast.h"
#include "render/signals.h"
#include "render/tiles.h"

#define SEED 0x6e6f6973u /* of other random numbers than the frame's */
#define SPREAD 0x73707264u
#define CHANCE 0.27 /* half the deviation of two halves' errors' mean, for one pixel */

/* A pixel, its own film, and the moments of its samples' luminances about their mean. */
struct NoisePixel {
    int x, y;
    bool counts; /* it is of the area; else only for what is dark in the frame */
    uint32_t share;
    Film *film;
    double samples, sum, mean, m2, m3, m4; /* cd m^-2 and powers */
};

typedef struct NoiseSearch {
    const NoiseArgs *args;
    NoisePixel *of;
    int count, area_count;
    double stands_for[2];              /* pixels of the frame: those beside the area, its own */
    uint32_t first_sample, end_sample; /* of the pass in hand */
    bool area_alone;
    WorkerCounts *counts;
} NoiseSearch;

/* ---- which pixels ------------------------------------------------------------------------ */

static bool holds(FilmRect rect, int x, int y) {
    return x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1;
}

static size_t pixel_count(FilmRect rect) {
    return (size_t)(rect.x1 - rect.x0) * (size_t)(rect.y1 - rect.y0);
}

/* How many of so many pixels are looked at. */
static size_t count_of(size_t pixels) {
    size_t some = pixels / NOISE_PIXELS_SHARE;
    if (some < NOISE_PIXELS_LEAST) some = NOISE_PIXELS_LEAST;
    if (some > NOISE_PIXELS_MOST) some = NOISE_PIXELS_MOST;
    return some < pixels ? some : pixels;
}

/* The pixels of one kind, row by row: one of each stretch of equal length is taken, at a place
 * that a hash decides. */
typedef struct NoisePicks {
    size_t pixels, taken, most; /* seen so far, taken of them, to be taken of all */
    size_t all;
    uint32_t seed;
} NoisePicks;

static NoisePicks picks_of(size_t all, uint32_t seed) {
    return (NoisePicks){.most = count_of(all), .all = all, .seed = seed};
}

static bool takes_next(NoisePicks *picks) {
    size_t k = picks->taken, at = picks->pixels++;
    if (k == picks->most) return false;
    uint64_t low = k * picks->all / picks->most;
    uint64_t high = (k + 1) * picks->all / picks->most;
    uint64_t place = low + hash_combine(picks->seed, (uint32_t)k) % (high - low);
    if (at != place) return false;
    picks->taken++;
    return true;
}

/* 0: out of view, 1: in view, 2: of the area. */
static uint8_t *find_kinds(const NoiseArgs *args, size_t of_kind[3], Arena *arena) {
    FilmRect crop = args->crop;
    uint8_t *kinds = ARENA_NEW(arena, uint8_t, pixel_count(crop)), *next = kinds;
    Arena scratch = *arena;
    const Favour favour = {args->kernel, args->context, args->camera,
                           &args->area,  crop,          args->threads};
    const uint8_t *shows =
        args->area.display == FILM_ALL_PIXELS ? NULL : favour_shows(&favour, &scratch);
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++, next++) {
            bool counts = holds(args->area.rect, x, y) && (!shows || shows[next - kinds]);
            *next = !camera_sees_pixel(args->camera, x, y) ? 0 : counts ? 2 : 1;
            of_kind[*next]++;
        }
    return kinds;
}

static NoisePixel pixel_at(const NoiseArgs *args, int x, int y, Arena *arena) {
    const Camera *camera = args->camera;
    const FilmRect rect = {x, y, x + 1, y + 1};
    return (NoisePixel){.x = x,
                        .y = y,
                        .share = sample_shares_at(&args->shares, x, y),
                        .film = film_create(camera->width, camera->height, rect, 0, NULL, arena)};
}

static void choose_pixels(NoiseSearch *search, Arena *arena) {
    const NoiseArgs *args = search->args;
    FilmRect crop = args->crop;
    size_t of_kind[3] = {0};
    search->of = ARENA_NEW(arena, NoisePixel, 2 * NOISE_PIXELS_MOST);
    const uint8_t *next = find_kinds(args, of_kind, arena);
    NoisePicks picks[3] = {{0}, picks_of(of_kind[1], SPREAD), picks_of(of_kind[2], SPREAD + 1)};
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++) {
            int kind = *next++;
            if (!kind || !takes_next(&picks[kind])) continue;
            NoisePixel pixel = pixel_at(args, x, y, arena);
            pixel.counts = kind == 2;
            search->of[search->count++] = pixel;
            search->area_count += pixel.counts;
        }
    for (int i = 0; i < 2; i++)
        search->stands_for[i] = (double)of_kind[i + 1] / fmax((double)picks[i + 1].taken, 1);
}

/* ---- samples ----------------------------------------------------------------------------- */

/* Moments about the mean with one value more (Pebay 2008, of samples one by one). */
static void add_value(NoisePixel *pixel, double value) {
    double n = ++pixel->samples, d = value - pixel->mean, step = d / n, d2 = d * step * (n - 1);
    pixel->mean += step;
    pixel->m4 +=
        d2 * step * step * (n * n - 3 * n + 3) + 6 * step * step * pixel->m2 - 4 * step * pixel->m3;
    pixel->m3 += d2 * step * (n - 2) - 3 * step * pixel->m2;
    pixel->m2 += d2;
}

static double luminance_sum(const FilmPixel *pixel) {
    return pixel->mean_xyz[1] * pixel->samples;
}

/* The frame's samples [first, end) of a pixel, one by one. */
static void sample_pixel(const NoiseSearch *search, NoisePixel *pixel, PathStatistics *counts) {
    const NoiseArgs *args = search->args;
    const FilmRect rect = {pixel->x, pixel->y, pixel->x + 1, pixel->y + 1};
    TileJob job = {.context = args->context,
                   .camera = args->camera,
                   .film = pixel->film,
                   .seed = hash_combine(args->seed, SEED),
                   .shares = args->shares};
    for (uint32_t i = search->first_sample; i < search->end_sample; i++) {
        job.first_sample = i;
        job.end_sample = i + 1;
        args->kernel->render(&job, rect, counts);
        FilmPixel now = film_pixel(pixel->film, pixel->x, pixel->y);
        if (now.samples == pixel->samples) continue; /* not its share, or dropped */
        double sum = luminance_sum(&now);
        add_value(pixel, sum - pixel->sum);
        pixel->sum = sum;
    }
}

static void sample_item(void *context, int item, int worker) {
    const NoiseSearch *search = context;
    NoisePixel *pixel = &search->of[item];
    if (search->area_alone && !pixel->counts) return;
    if (search->args->stops_at_once && signals_stop_requested()) return;
    sample_pixel(search, pixel, &search->counts[worker].statistics);
}

/* The frame's samples up to `end`, counted from its first. */
static void sample_to(NoiseSearch *search, uint32_t end) {
    search->first_sample = search->end_sample;
    search->end_sample = search->args->first_sample + end;
    parallel_for(search->args->threads, search->count, sample_item, search);
}

/* ---- errors ------------------------------------------------------------------------------ */

/* Half the geometric mean of the luminances above zero (film.h): the area's pixels and the
 * others stand for as many of the frame as there are. */
static double lowest_luminance(const NoiseSearch *search) {
    double logarithms[2] = {0}, lit[2] = {0}, sum = 0, weight = 0;
    for (int i = 0; i < search->count; i++) {
        const NoisePixel *pixel = &search->of[i];
        double mean = pixel->samples > 0 ? pixel->sum / pixel->samples : 0;
        if (!(mean > 0)) continue;
        logarithms[pixel->counts] += (double)log_f((float)mean);
        lit[pixel->counts]++;
    }
    for (int i = 0; i < 2; i++) {
        sum += search->stands_for[i] * logarithms[i];
        weight += search->stands_for[i] * lit[i];
    }
    return weight > 0 ? 0.5 * (double)exp_f((float)(sum / weight)) : 0;
}

static double error_of(const NoisePixel *of, double lowest) {
    FilmPixel pixel = film_pixel(of->film, of->x, of->y);
    double by = fmax(pixel.mean_xyz[1], lowest);
    if (pixel.samples < 2) return 1;
    return by > 0 ? pixel.sigma_y / by : 0;
}

/* The mean error of the area's pixels, and its standard error. */
typedef struct MeanError {
    double mean, sigma;
} MeanError;

static MeanError mean_error(const NoiseSearch *search, double lowest) {
    double sum = 0, squares = 0, count = 0;
    for (int i = 0; i < search->count; i++) {
        if (!search->of[i].counts) continue;
        double error = error_of(&search->of[i], lowest);
        sum += error;
        squares += error * error;
        count++;
    }
    double mean = sum / count, spread = fmax(squares / count - mean * mean, 0);
    return (MeanError){mean, count > 1 ? sqrt(spread / (count - 1)) : 0};
}

/* ---- how many samples -------------------------------------------------------------------- */

/* Passes as the frame's, until the error is small enough or there are no more samples. */
static void find_samples(NoiseSearch *search, NoiseStop *stop) {
    const NoiseArgs *args = search->args;
    size_t pixels = pixel_count(args->crop);
    Forecast forecast = {0};
    Progress progress =
        progress_start(args->progress, "noise", "samples", (double)args->most * search->count);
    while (!stop->reached && stop->samples < args->most) {
        if (args->stops_at_once && signals_stop_requested()) {
            stop->samples = args->most;
            break;
        }
        uint32_t next = render_pass_samples(stop->samples, pixels);
        uint32_t left = args->most - stop->samples;
        stop->samples += next < left ? next : left;
        sample_to(search, stop->samples);
        stop->lowest = lowest_luminance(search);
        MeanError error = mean_error(search, stop->lowest);
        stop->error = error.mean;
        stop->reached =
            stop->samples >= NOISE_LEAST_SAMPLES && error.mean + error.sigma <= args->error;
        double end = forecast_samples(&forecast, stop->samples, stop->error / args->error);
        progress.total = fmin(fmax(end, stop->samples), args->most) * search->count;
        progress_update(&progress, (double)stop->samples * search->count);
    }
    progress_end(&progress, (double)stop->samples * search->count);
}

/* The frame's samples up to which the area's pixels are looked at: with the frame's own they
 * have NOISE_LEAST_PATHS. */
static uint32_t samples_to_look(const NoiseSearch *search, uint32_t samples) {
    double shares = 0;
    for (int i = 0; i < search->count; i++)
        if (search->of[i].counts) shares += search->of[i].share;
    double each = shares / SAMPLE_SHARE_ALL, all = each * search->stands_for[1];
    double looked = ceil((NOISE_LEAST_PATHS - all * samples) / each);
    return looked > samples ? (uint32_t)looked : samples;
}

NoiseStop noise_stop_find(const NoiseArgs *args, Arena *arena) {
    const double begun_s = monotonic_seconds();
    NoiseStop stop = {
        .samples = args->most, .error = (double)NAN, .first_sample = args->first_sample};
    NoiseSearch search = {.args = args,
                          .end_sample = args->first_sample,
                          .counts = ARENA_NEW(arena, WorkerCounts, args->threads)};
    choose_pixels(&search, arena);
    if (search.area_count) {
        stop.samples = 0;
        find_samples(&search, &stop);
        search.area_alone = true;
        sample_to(&search, samples_to_look(&search, stop.samples));
    }
    stop.of = search.of;
    stop.count = search.count;
    stop.pixels = search.area_count;
    stop.paths = worker_counts_sum(search.counts, args->threads).samples;
    stop.seconds = monotonic_seconds() - begun_s;
    return stop;
}

/* ---- rare light -------------------------------------------------------------------------- */

/* Whether few samples made the most of its noise; of few samples it always are few. */
static bool is_rare(const NoisePixel *pixel) {
    double few = fmin(NOISE_FEW, pixel->samples / 8);
    return pixel->m2 > 0 && pixel->m2 * pixel->m2 < few * pixel->m4;
}

/* Variance after the frame's samples by that after those looked at. */
static double growth_of(const NoiseStop *stop, const NoisePixel *pixel, uint32_t samples) {
    uint32_t before = sample_shares_own(pixel->share, stop->first_sample);
    double own = sample_shares_own(pixel->share, stop->first_sample + samples) - before;
    return pixel->samples / fmax(own, 1);
}

/* What one pixel is, and what it brings to the others. */
typedef struct NoiseShare {
    double own;             /* relative variance, but for what is rare */
    double rare, rare_mean; /* that of what is rare, and its light, relative to the other */
} NoiseShare;

static NoiseShare noise_of(const NoiseStop *stop, const NoisePixel *of, uint32_t samples) {
    FilmPixel pixel = film_pixel(of->film, of->x, of->y);
    double growth = growth_of(stop, of, samples), s = sqrt(pixel.square_y);
    double others = fmax(pixel.mean_xyz[1] - s, stop->lowest);
    if (!is_rare(of)) {
        double error = error_of(of, stop->lowest);
        return (NoiseShare){.own = error * error * growth};
    }
    if (!(others > 0)) return (NoiseShare){0};
    return (NoiseShare){.rare = growth * s * s / (others * others), .rare_mean = s / others};
}

double noise_stop_doubt(const NoiseStop *stop, FilmSpikes spikes, uint32_t samples) {
    double rare = 0, light = 0, sum = 0;
    for (int i = 0; i < stop->count; i++) {
        if (!stop->of[i].counts) continue;
        NoiseShare noise = noise_of(stop, &stop->of[i], samples);
        rare += noise.rare / stop->pixels;
        light += noise.rare_mean / stop->pixels;
    }
    if (spikes.square > rare) {
        rare = spikes.square;
        light = spikes.mean;
    }
    for (int i = 0; i < stop->count; i++)
        if (stop->of[i].counts)
            sum += sqrt(noise_of(stop, &stop->of[i], samples).own + rare) / stop->pixels;
    return stop->pixels ? sum / (1 + light) : (double)NAN;
}

/* Both errors are means over pixels whose noise one difference shows, or some samples. */
bool noise_stop_is_rare(const NoiseStop *stop, double told, double doubt) {
    double chance = stop->pixels ? CHANCE / sqrt(stop->pixels) : 0;
    return doubt > NOISE_DOUBT * (1 + chance) * 0.5 * (told + stop->error);
}
