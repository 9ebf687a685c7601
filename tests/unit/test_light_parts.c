/* SPDX-License-Identifier: Apache-2.0 */
/* The worst part of what an eye looks at: windows of cells by sums one by one, what is hidden
 * left out, and no part chosen by luck. */
#include "fixture.h"

#include "base/sampler.h"
#include "review/light/light_parts.h"

enum { COLUMNS = 12, ROWS = 5, WIDE = 3, HIGH = 2, CELLS = COLUMNS * ROWS };

typedef struct Cells {
    LightParts parts;
    int cell_of[CELLS];
    double values[CELLS]; /* [target] */
} Cells;

/* All that is not hidden; hidden: [cell], or NULL. */
static void see(Cells *cells, const bool *hidden) {
    cells->parts = (LightParts){
        .cell_of = cells->cell_of, .columns = COLUMNS, .rows = ROWS, .wide = WIDE, .high = HIGH};
    for (int i = 0; i < CELLS; i++)
        if (!hidden || !hidden[i]) cells->cell_of[cells->parts.aim.target_count++] = i;
}

static float number(uint32_t i, uint32_t k) {
    return (float)hash_combine(hash_u32(i), k) * 0x1p-32f;
}

/* Mean over the seen cells of a window. */
static double mean_of(const Cells *cells, int part, int *count) {
    double sum = 0;
    int column, row;
    light_parts_place(&cells->parts, part, &column, &row);
    *count = 0;
    for (int i = 0; i < cells->parts.aim.target_count; i++) {
        int x = cells->cell_of[i] % COLUMNS, y = cells->cell_of[i] / COLUMNS;
        if (x < column || x >= column + WIDE || y < row || y >= row + HIGH) continue;
        sum += cells->values[i];
        (*count)++;
    }
    return sum / *count;
}

ARENA_TEST(means_are_those_of_windows) {
    Cells cells;
    bool hidden[CELLS] = {false};
    for (uint32_t k = 0; k < 20; k++) {
        double means[CELLS], worst = -1;
        int counts[CELLS], most = 0;
        for (uint32_t i = 0; i < CELLS; i++) hidden[i] = number(i, k + 100) < 0.02f * (float)k;
        see(&cells, hidden);
        for (uint32_t i = 0; i < CELLS; i++) cells.values[i] = (double)number(i, k);
        int found = light_parts_worst(&cells.parts, cells.values, means, counts, arena);
        int parts = light_parts_count(&cells.parts);
        assert_int_equal(parts, (COLUMNS - WIDE + 1) * (ROWS - HIGH + 1));
        for (int i = 0; i < parts; i++) {
            int count;
            mean_of(&cells, i, &count);
            assert_int_equal(counts[i], count);
            most = count > most ? count : most;
        }
        for (int i = 0; i < parts; i++) {
            int count;
            double mean = mean_of(&cells, i, &count);
            if (counts[i] < 0.95 * most) {
                assert_true(isnan(means[i]));
                continue;
            }
            assert_near(means[i], mean, 1e-12);
            worst = fmax(worst, mean);
        }
        assert_near(means[found], worst, 1e-12);
    }
}

ARENA_TEST(nothing_seen_has_no_worst) {
    Cells cells = {0};
    bool hidden[CELLS];
    double means[CELLS];
    memset(hidden, true, sizeof hidden);
    see(&cells, hidden);
    assert_int_equal(light_parts_worst(&cells.parts, cells.values, means, NULL, arena), -1);
}

ARENA_TEST(of_equal_parts_the_middle_one) {
    Cells cells;
    double means[CELLS];
    int column, row;
    see(&cells, NULL);
    for (int i = 0; i < CELLS; i++) cells.values[i] = 7;
    int found = light_parts_worst(&cells.parts, cells.values, means, NULL, arena);
    light_parts_place(&cells.parts, found, &column, &row);
    assert_int_equal(column, (COLUMNS - WIDE) / 2);
    assert_true(row == (ROWS - HIGH) / 2 || row == (ROWS - HIGH + 1) / 2);
}

/* Samples of a mean a target, each of so much spread. */
static void sample(const Cells *cells, const double *means, float spread, uint32_t seed,
                   TargetLight *out) {
    for (int i = 0; i < cells->parts.aim.target_count; i++) {
        out[i] = (TargetLight){0, 0, 0};
        for (uint32_t k = 0; k < 8; k++) {
            float x = (float)means[i] + spread * (number((uint32_t)i * 8 + k, seed) - 0.5f);
            out[i].paths++;
            out[i].sum += x;
            out[i].squares += x * x;
        }
    }
}

/* Half of the cells lie in the sun, which is known. What samples find besides is alike all
 * over: however noisy they are, a part that lies in the sun whole is chosen. */
ARENA_TEST(luck_does_not_choose) {
    Cells cells;
    double known[CELLS], means[CELLS];
    TargetLight sampled[CELLS];
    int in_sun = 0;
    see(&cells, NULL);
    for (int i = 0; i < CELLS; i++) {
        known[i] = i % COLUMNS < COLUMNS / 2 ? 5 : 0;
        means[i] = known[i] + 20;
    }
    for (uint32_t seed = 0; seed < 100; seed++) {
        int column, row;
        sample(&cells, means, 80, seed, sampled);
        light_parts_place(&cells.parts, light_parts_choose(&cells.parts, sampled, known, arena),
                          &column, &row);
        in_sun += column + WIDE <= COLUMNS / 2;
    }
    assert_true(in_sun >= 95); /* by the samples alone about 85 */
}

/* What samples show surely is chosen, without any sun. */
ARENA_TEST(light_that_samples_find_chooses) {
    Cells cells;
    double known[CELLS] = {0}, means[CELLS];
    TargetLight sampled[CELLS];
    see(&cells, NULL);
    for (int i = 0; i < CELLS; i++) {
        bool is_bright = i % COLUMNS >= 8 && i % COLUMNS < 8 + WIDE && i / COLUMNS >= 3;
        means[i] = is_bright ? 30 : 10;
    }
    for (uint32_t seed = 0; seed < 20; seed++) {
        int column, row;
        sample(&cells, means, 10, seed, sampled);
        light_parts_place(&cells.parts, light_parts_choose(&cells.parts, sampled, known, arena),
                          &column, &row);
        assert_int_equal(column, 8);
        assert_int_equal(row, 3);
    }
}

/* An even rise is found, of which the parts' own noise would hide the end. */
ARENA_TEST(an_even_rise_chooses_its_end) {
    Cells cells;
    double known[CELLS] = {0}, means[CELLS];
    TargetLight sampled[CELLS];
    int at_end = 0;
    see(&cells, NULL);
    for (int i = 0; i < CELLS; i++) means[i] = 20 + 0.5 * (i % COLUMNS);
    for (uint32_t seed = 0; seed < 100; seed++) {
        int column, row;
        sample(&cells, means, 20, seed, sampled);
        light_parts_place(&cells.parts, light_parts_choose(&cells.parts, sampled, known, arena),
                          &column, &row);
        at_end += column == COLUMNS - WIDE;
    }
    assert_true(at_end >= 90); /* by the parts' means alone about 75 */
}

/* Where the light is even all is judged, not the part of luck; of a rise that samples hardly
 * show, all or its brighter half. */
ARENA_TEST(no_part_is_chosen_by_luck) {
    Cells cells;
    double known[CELLS] = {0}, means[CELLS];
    TargetLight sampled[CELLS];
    see(&cells, NULL);
    for (int rises = 0; rises < 2; rises++) {
        int all = 0, darker = 0;
        for (int i = 0; i < CELLS; i++) means[i] = 20 + 0.5 * rises * (i % COLUMNS);
        for (uint32_t seed = 0; seed < 200; seed++) {
            int column = COLUMNS, row;
            sample(&cells, means, 80, seed, sampled);
            int part = light_parts_choose(&cells.parts, sampled, known, arena);
            all += part == LIGHT_PARTS_ALL;
            if (part != LIGHT_PARTS_ALL) light_parts_place(&cells.parts, part, &column, &row);
            darker += 2 * column + WIDE < COLUMNS;
        }
        if (!rises) assert_true(all >= 170);
        if (rises) assert_true(darker <= 6);
    }
}

/* A sun that is known to lie on one half is not outvoted by samples that say little. */
ARENA_TEST(what_is_known_needs_no_samples) {
    Cells cells;
    double known[CELLS];
    TargetLight none[CELLS] = {{0, 0, 0}};
    int column, row;
    see(&cells, NULL);
    for (int i = 0; i < CELLS; i++) known[i] = i % COLUMNS < COLUMNS / 2 ? 5 : 0;
    light_parts_place(&cells.parts, light_parts_choose(&cells.parts, none, known, arena), &column,
                      &row);
    assert_true(column + WIDE <= COLUMNS / 2);
    for (int i = 0; i < CELLS; i++) known[i] = 5;
    assert_int_equal(light_parts_choose(&cells.parts, none, known, arena), LIGHT_PARTS_ALL);
}

/* Of what must not be read the part that gets least is worst: in the shade, where direct light
 * falls on the left third alone. */
ARENA_TEST(the_least_may_be_the_worst) {
    Cells cells;
    double means[CELLS], least = INFINITY;
    TargetLight none[CELLS] = {{0, 0, 0}};
    int column, row;
    see(&cells, NULL);
    for (int i = 0; i < CELLS; i++) cells.values[i] = i % COLUMNS < 4 ? 100 : 1;
    int lit = light_parts_choose(&cells.parts, none, cells.values, arena);
    cells.parts.takes_least = true;
    int shade = light_parts_choose(&cells.parts, none, cells.values, arena);
    light_parts_place(&cells.parts, lit, &column, &row);
    assert_true(column + WIDE <= 4);
    light_parts_place(&cells.parts, shade, &column, &row);
    assert_true(column >= 4);
    for (uint32_t i = 0; i < CELLS; i++) cells.values[i] = (double)number(i, 7);
    int found = light_parts_worst(&cells.parts, cells.values, means, NULL, arena);
    for (int i = 0; i < light_parts_count(&cells.parts); i++) least = fmin(least, means[i]);
    assert_near(means[found], least, 0);
    for (int i = 0; i < CELLS; i++) cells.values[i] = 5;
    assert_int_equal(light_parts_choose(&cells.parts, none, cells.values, arena), LIGHT_PARTS_ALL);
}

TEST_PROGRAM(make_arena, drop_arena)
