/* SPDX-License-Identifier: Apache-2.0 */
#include "render/pilot.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"
#include "render/tiles.h"

#define SEED 0x70696c6fu             /* not a frame's own samples */
#define USUAL_STEP (16 * PILOT_SIDE) /* rows: one row of squares in so many shows the usual, */
#define USUAL_ROWS 4                 /* in low frames one of fewer, that there are as many */

/* What is usual in the frame. */
typedef struct Usual {
    double lowest; /* luminance that noise is judged by at least, cd m^-2 */
    double weight; /* mean of the squares' */
} Usual;

typedef struct PilotBand {
    const Pilot *pilot;
    FilmRect rect;
    TileJob job;
    WorkerCounts *counts; /* the kernel's, which nobody reads: only frames' rays are reported */
} PilotBand;

static size_t pixels_of(FilmRect rect) {
    return (size_t)(rect.x1 - rect.x0) * (size_t)(rect.y1 - rect.y0);
}

/* ---- samples ----------------------------------------------------------------------------- */

static void render_band_tile(void *context, int item, int worker) {
    PilotBand *band = context;
    band->pilot->kernel->render(&band->job, render_tile(band->rect, item),
                                &band->counts[worker].statistics);
}

static Film *band_film(const Pilot *pilot, FilmRect rect, Arena *arena) {
    const Camera *camera = pilot->camera;
    Film *film = film_create(camera->width, camera->height, rect, 0, NULL, arena);
    PilotBand band = {
        .pilot = pilot, .rect = rect, .counts = ARENA_NEW(arena, WorkerCounts, pilot->threads)};
    band.job = (TileJob){.context = pilot->context,
                         .camera = camera,
                         .film = film,
                         .seed = SEED,
                         .end_sample = PILOT_SAMPLES};
    parallel_for(pilot->threads, render_tile_count(rect), render_band_tile, &band);
    return film;
}

/* ---- squares ----------------------------------------------------------------------------- */

typedef struct Square {
    double luminance, sigma; /* of its pixels */
    int pixels;
} Square;

/* Sigma: the lesser of two that are both too great. A pixel's samples spread as if they were
 * independent, and Sobol points are better than that; what neighbours differ by is their noise
 * and the picture's detail. */
static Square square_of(const Film *film, FilmRect rect) {
    double sum = 0, squares = 0, sigma = 0;
    int count = 0;
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++) {
            FilmPixel pixel = film_pixel(film, x, y);
            if (!pixel.samples) continue; /* out of view */
            count++;
            sum += pixel.mean_xyz[1];
            squares += pixel.mean_xyz[1] * pixel.mean_xyz[1];
            sigma += pixel.sigma_y;
        }
    if (!count) return (Square){.pixels = 0};
    double mean = sum / count;
    double detail = count > 1 ? (squares - sum * mean) / (count - 1) : (double)INFINITY;
    return (Square){mean, fmin(sigma / count, sqrt(fmax(detail, 0))), count};
}

/* Of the rectangle, up to its end. */
static FilmRect square_at(FilmRect rect, int x, int y) {
    int x1 = x + PILOT_SIDE, y1 = y + PILOT_SIDE;
    return (FilmRect){x, y, x1 < rect.x1 ? x1 : rect.x1, y1 < rect.y1 ? y1 : rect.y1};
}

/* What a pixel of the square has of samples, but for a factor that is the frame's. */
static double square_weight(const Square *square, double lowest) {
    double by = fmax(square->luminance, lowest);
    return by > 0 ? (double)pow_f((float)(square->sigma / by), 2.0f / 3) : 0;
}

/* ---- what is usual ----------------------------------------------------------------------- */

/* How far apart the rows of squares are, in rows of pixels. */
static int step_of_rows(int height) {
    int step = height / USUAL_ROWS / PILOT_SIDE * PILOT_SIDE;
    return step < PILOT_SIDE ? PILOT_SIDE : step > USUAL_STEP ? USUAL_STEP : step;
}

/* Whole squares of the frame. */
static Square *survey_rows(const Pilot *pilot, Arena *arena, int *count) {
    const Camera *camera = pilot->camera;
    int step = step_of_rows(camera->height);
    int first = step / 2 / PILOT_SIDE * PILOT_SIDE;
    int columns = (camera->width + PILOT_SIDE - 1) / PILOT_SIDE;
    int rows = (camera->height - 1 - first) / step + 1;
    Square *squares = ARENA_NEW(arena, Square, (size_t)rows * (size_t)columns);
    *count = 0;
    for (int y = first; y < camera->height; y += step) {
        FilmRect row = square_at((FilmRect){0, 0, camera->width, camera->height}, 0, y);
        row.x1 = camera->width;
        Arena scratch = *arena;
        Film *film = band_film(pilot, row, &scratch);
        for (int x = 0; x < row.x1; x += PILOT_SIDE)
            squares[(*count)++] = square_of(film, square_at(row, x, y));
    }
    return squares;
}

/* Half the geometric mean of the squares' luminances above zero. */
static double lowest_luminance(const Square *squares, int count) {
    double logarithms = 0;
    int lit = 0;
    for (int i = 0; i < count; i++) {
        if (!(squares[i].luminance > 0)) continue;
        logarithms += (double)log_f((float)squares[i].luminance);
        lit++;
    }
    return lit ? 0.5 * (double)exp_f((float)(logarithms / lit)) : 0;
}

static Usual find_usual(const Pilot *pilot, Arena scratch) {
    int count;
    Square *squares = survey_rows(pilot, &scratch, &count);
    Usual usual = {.lowest = lowest_luminance(squares, count)};
    double pixels = 0;
    for (int i = 0; i < count; i++) {
        usual.weight += square_weight(&squares[i], usual.lowest) * squares[i].pixels;
        pixels += squares[i].pixels;
    }
    usual.weight /= pixels;
    return usual;
}

/* ---- shares ------------------------------------------------------------------------------ */

static uint8_t share_of(double weight, const Usual *usual) {
    if (!(usual->weight > 0)) return SAMPLE_SHARE_ALL;
    double share = rint(PILOT_USUAL * weight / usual->weight);
    return (uint8_t)fmin(fmax(share, PILOT_LEAST), SAMPLE_SHARE_ALL);
}

static void share_square(FilmRect crop, FilmRect square, uint8_t share, uint8_t *of) {
    for (int y = square.y0; y < square.y1; y++)
        for (int x = square.x0; x < square.x1; x++)
            if (x >= crop.x0 && x < crop.x1 && y >= crop.y0 && y < crop.y1)
                of[(size_t)(y - crop.y0) * (size_t)(crop.x1 - crop.x0) + (size_t)(x - crop.x0)] =
                    share;
}

/* With whole squares at its edges. */
static FilmRect widened(FilmRect crop, const Camera *camera) {
    int x1 = (crop.x1 + PILOT_SIDE - 1) / PILOT_SIDE * PILOT_SIDE;
    int y1 = (crop.y1 + PILOT_SIDE - 1) / PILOT_SIDE * PILOT_SIDE;
    return (FilmRect){crop.x0 / PILOT_SIDE * PILOT_SIDE, crop.y0 / PILOT_SIDE * PILOT_SIDE,
                      x1 < camera->width ? x1 : camera->width,
                      y1 < camera->height ? y1 : camera->height};
}

SampleShares pilot_shares(const Pilot *pilot, Arena *arena) {
    uint8_t *of = ARENA_NEW(arena, uint8_t, pixels_of(pilot->crop));
    FilmRect rect = widened(pilot->crop, pilot->camera);
    Usual usual = find_usual(pilot, *arena);
    Progress progress = progress_start(pilot->progress, "pilot", "samples",
                                       (double)pixels_of(rect) * PILOT_SAMPLES);
    for (int y0 = rect.y0; y0 < rect.y1; y0 += PILOT_BAND) {
        int y1 = y0 + PILOT_BAND < rect.y1 ? y0 + PILOT_BAND : rect.y1;
        FilmRect band = {rect.x0, y0, rect.x1, y1};
        Arena scratch = *arena;
        Film *film = band_film(pilot, band, &scratch);
        for (int y = y0; y < y1; y += PILOT_SIDE)
            for (int x = rect.x0; x < rect.x1; x += PILOT_SIDE) {
                FilmRect at = square_at(band, x, y);
                Square square = square_of(film, at);
                double weight = square_weight(&square, usual.lowest);
                share_square(pilot->crop, at, share_of(weight, &usual), of);
            }
        progress_update(&progress, (double)pixels_of(rect) * PILOT_SAMPLES * (y1 - rect.y0) /
                                       (rect.y1 - rect.y0));
    }
    progress_end(&progress, (double)pixels_of(rect) * PILOT_SAMPLES);
    return (SampleShares){of, pilot->crop};
}
