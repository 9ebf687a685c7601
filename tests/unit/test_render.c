/* SPDX-License-Identifier: Apache-2.0 */
/* The render loop's parts that need no scene: tiles, passes, workers, signals, progress. */
#include "fixture.h"

#include <math.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "render/forecast.h"
#include "render/render.h"
#include "render/signals.h"

/* ---- signals ----------------------------------------------------------------------------- */

/* The thread sanitizer delivers a signal at the next call that may block. */
static void raise_and_wait(int number) {
    raise(number);
    usleep(1000);
}

/* The life of a process that is interrupted twice: `test_render raise NUMBER`. */
static int raise_twice(int number) {
    signals_watch();
    if (signals_stop_requested()) return 1;
    raise_and_wait(number);
    if (signals_stop_requested() != number) return 2;
    raise_and_wait(number);
    return 3;
}

/* A program of its own: the thread sanitizer loses signals between fork and exec. The first
 * case, for it needs a fork before any thread, too. */
TEST(the_first_interrupt_asks_and_the_second_ends) {
    static const int numbers[] = {SIGINT, SIGTERM};
    for (int i = 0; i < 2; i++) {
        char text[16];
        snprintf(text, sizeof text, "%d", numbers[i]);
        pid_t child = fork();
        if (child == 0) {
            execl("/proc/self/exe", "test_render", "raise", text, (char *)NULL);
            _exit(4);
        }
        assert_int_equal(status_of(child), 128 + numbers[i]);
    }
}

TEST(a_snapshot_is_taken_once) {
    signals_watch();
    assert_false(signals_take_snapshot());
    raise_and_wait(SIGUSR1);
    assert_true(signals_take_snapshot());
    assert_false(signals_take_snapshot());
}

/* ---- tiles and passes -------------------------------------------------------------------- */

TEST(tiles_cover_every_pixel_of_the_crop_once) {
    static const FilmRect crops[] = {{0, 0, 1, 1}, {0, 0, 64, 48}, {5, 7, 86, 60}, {3, 2, 19, 18}};
    for (size_t c = 0; c < sizeof crops / sizeof *crops; c++) {
        unsigned char hits[100][100] = {{0}};
        FilmRect crop = crops[c];
        for (int i = 0; i < render_tile_count(crop); i++) {
            FilmRect tile = render_tile(crop, i);
            assert_true(tile.x0 < tile.x1 && tile.y0 < tile.y1);
            for (int y = tile.y0; y < tile.y1; y++)
                for (int x = tile.x0; x < tile.x1; x++) hits[y][x]++;
        }
        for (int y = 0; y < 100; y++)
            for (int x = 0; x < 100; x++)
                assert_int_equal(hits[y][x],
                                 x >= crop.x0 && x < crop.x1 && y >= crop.y0 && y < crop.y1);
    }
}

TEST(passes_double_and_then_stay) {
    static const uint32_t wanted[] = {1, 1, 2, 4, 8, 16, 16, 16, 16, 16};
    uint32_t done = 0;
    for (int i = 0; i < 10; i++) {
        assert_int_equal(render_pass_samples(done, 4096), wanted[i]);
        done += wanted[i];
    }
    assert_int_equal(render_pass_samples(8, (size_t)1280 * 720), 4);
    assert_int_equal(render_pass_samples(1000, (size_t)1 << 28), 1);
}

/* Noise whose measured error is all there is from the first pass on: the first answer stays. */
TEST(honest_noise_is_foretold_at_once) {
    Forecast forecast = {0};
    for (uint32_t done = 2; done <= 192; done += render_pass_samples(done, 4096))
        assert_true(fabs(forecast_samples(&forecast, done, sqrt(190.0 / done)) - 190) < 1e-9);
}

/* Rare light that is found late: the required samples grow by 40 % with the first doubling, and
 * by 0.6 of that with each further one. */
TEST(noise_that_grows_is_foretold) {
    Forecast forecast = {0};
    double wanted[9] = {0, 100};
    for (int k = 2; k <= 8; k++) wanted[k] = wanted[k - 1] * (1 + 0.4 * pow(0.6, k - 2));
    for (int k = 1; k <= 8; k++) {
        uint32_t done = 1u << k;
        double told = forecast_samples(&forecast, done, sqrt(wanted[k] / done));
        if (k >= 3) assert_in_range((int)(100 * told / wanted[8]), 85, 115);
    }
}

TEST(growth_is_that_of_a_doubling_however_far_readings_are_apart) {
    Forecast forecast = {0};
    forecast_samples(&forecast, 2, sqrt(100.0 / 2));
    forecast_samples(&forecast, 16, sqrt(100.0 * 1.2 * 1.2 * 1.2 / 16));
    assert_near(forecast.growth, 0.2, 1e-9);
}

TEST(forecasts_of_nothing_and_of_no_end) {
    Forecast forecast = {0};
    assert_true(isinf(forecast_samples(&forecast, 4, (double)NAN)));
    assert_true(isinf(forecast_samples(&forecast, 4, (double)INFINITY)));
    assert_true(forecast_samples(&forecast, 4, 0) == 0);
}

/* A render that goes on from any number of samples decides where one that began decides. */
TEST(passes_end_at_the_same_samples_wherever_one_begins) {
    static const size_t pixels[] = {1, 4096, 600000, (size_t)1280 * 720, (size_t)1 << 23};
    for (size_t p = 0; p < sizeof pixels / sizeof *pixels; p++) {
        uint32_t end = 0;
        for (uint32_t done = 0; done < 1000; done++) {
            if (done == end) end += render_pass_samples(done, pixels[p]);
            assert_int_equal(done + render_pass_samples(done, pixels[p]), end);
        }
    }
    assert_int_equal(render_pass_samples(FILM_SAMPLES_MAX - 1, 4096), 2);
}

/* ---- workers ----------------------------------------------------------------------------- */

#define ITEMS 2000

typedef struct Counting {
    atomic_int items[ITEMS];
    atomic_int busy[PARALLEL_THREADS_MAX]; /* a worker index must not be used twice at a time */
    atomic_int clashes;
    int threads;
} Counting;

static void count_item(void *context, int item, int worker) {
    Counting *counting = context;
    if (worker < 0 || worker >= counting->threads || atomic_fetch_add(&counting->busy[worker], 1))
        atomic_fetch_add(&counting->clashes, 1);
    atomic_fetch_add(&counting->items[item], 1);
    atomic_fetch_sub(&counting->busy[worker], 1);
}

TEST(every_item_is_done_once_for_any_number_of_threads) {
    static const int threads[] = {1, 2, 3, 16, 200};
    for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) {
        Counting *counting = calloc(1, sizeof *counting);
        counting->threads = threads[t];
        parallel_for(threads[t], ITEMS, count_item, counting);
        for (int i = 0; i < ITEMS; i++) assert_int_equal(counting->items[i], 1);
        assert_int_equal(counting->clashes, 0);
        free(counting);
    }
}

static bool fails_at(void *context, int item, Error *err) {
    Counting *counting = context;
    atomic_fetch_add(&counting->items[item], 1);
    return item % 10 != 7 || error_set(err, ERROR_OUTPUT, "of %d", item);
}

TEST(the_first_item_that_fails_is_told_when_all_are_done) {
    ENDS_BY(arena_release) Arena arena = arena_reserve(1 << 20);
    for (int threads = 1; threads < 4; threads++) {
        Counting *counting = calloc(1, sizeof *counting);
        *why() = (Error){0};
        assert_true(parallel_try(threads, 7, fails_at, counting, arena, why()));
        assert_int_equal(why()->code, 0);
        assert_false(parallel_try(threads, 100, fails_at, counting, arena, why()));
        assert_int_equal(why()->code, ERROR_OUTPUT);
        assert_string_equal(why()->text, "of 7");
        for (int i = 0; i < 100; i++) assert_int_equal(counting->items[i], i < 7 ? 2 : 1);
        free(counting);
    }
}

TEST(no_items_is_no_work) {
    Counting counting = {.threads = 4};
    parallel_for(4, 0, count_item, &counting);
    assert_int_equal(counting.items[0], 0);
    assert_in_range(parallel_default_threads(), 1, PARALLEL_THREADS_MAX);
}

/* ---- progress ---------------------------------------------------------------------------- */

/* stderr while a test holds it: a file, which is no terminal. */
typedef struct Held {
    FILE *file;
    int kept;
} Held;

static Held hold_stderr(void) {
    Held held = {tmpfile(), dup(STDERR_FILENO)};
    assert_non_null(held.file);
    dup2(fileno(held.file), STDERR_FILENO);
    return held;
}

/* What was printed since. */
static void release_stderr(Held held, char *text, size_t size) {
    fflush(stderr);
    dup2(held.kept, STDERR_FILENO);
    close(held.kept);
    ssize_t length = pread(fileno(held.file), text, size - 1, 0);
    fclose(held.file);
    text[length < 0 ? 0 : length] = '\0';
}

/* What a whole life of a progress prints. */
static void progress_output(ProgressMode mode, char *text, size_t size) {
    Held held = hold_stderr();
    Progress progress = progress_start(mode, "render", "samples", 200);
    progress.interval_s = 0;
    progress.begun_s -= 10;
    progress_update(&progress, 50);
    progress_end(&progress, 200);
    release_stderr(held, text, size);
}

TEST(progress_shows_percent_rate_elapsed_and_remaining) {
    char text[2048];
    progress_output(PROGRESS_AUTO, text, sizeof text);
    assert_string_equal(text, "parhelion: render 25%, 5 samples/s, 0:10 elapsed, 0:30 left\n"
                              "parhelion: render 100%, 20 samples/s, 0:10 elapsed, 0:00 left\n");
    char asked[2048]; /* a bar needs a terminal: tests/hostile/cli.py has one */
    progress_output(PROGRESS_BAR, asked, sizeof asked);
    assert_string_equal(asked, text);
    progress_output(PROGRESS_NONE, text, sizeof text);
    assert_string_equal(text, "");
}

TEST(what_was_done_before_counts_for_the_share_alone) {
    char text[512];
    Held held = hold_stderr();
    Progress progress = progress_start(PROGRESS_PLAIN, "render", "samples", 200);
    progress.first = 100;
    progress.begun_s -= 10;
    progress_end(&progress, 150);
    release_stderr(held, text, sizeof text);
    assert_string_equal(text, "parhelion: render 75%, 5 samples/s, 0:10 elapsed, 0:10 left\n");
}

TEST(json_progress_is_one_object_a_line) {
    char text[2048];
    progress_output(PROGRESS_JSON, text, sizeof text);
    assert_non_null(strstr(text, "{\"progress\":{\"what\":\"render\",\"unit\":\"samples\","
                                 "\"done\":50,\"total\":200,\"fraction\":0.2500,"));
    assert_non_null(strstr(text, "\"elapsed_s\":10.0,\"remaining_s\":30.0}}\n"));
}

TEST(rates_have_three_digits) {
    char text[32];
    rate_text(950, text, (int)sizeof text);
    assert_string_equal(text, "950 ");
    rate_text(12345, text, (int)sizeof text);
    assert_string_equal(text, "12.3 k");
    rate_text(4.56e6, text, (int)sizeof text);
    assert_string_equal(text, "4.56 M");
}

int main(int argc, char **argv) {
    if (argc == 3 && !strcmp(argv[1], "raise")) return raise_twice(atoi(argv[2]));
    return run_cases(NULL, NULL);
}
