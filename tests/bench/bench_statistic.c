/* SPDX-License-Identifier: Apache-2.0 */
/* bench_statistic.c -- the statistical test of two frames, as one line of JSON.
 *
 * usage: bench_statistic REFERENCE.exr TEST.exr [LEVEL]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "compare/statistic/statistic.h"

static void print_number(double value, const char *after) {
    if (isfinite(value)) printf("%.4g%s", value, after);
    else printf("null%s", after);
}

static void print_result(const StatisticResult *r) {
    static const char *const VERDICTS[] = {"equal", "same", "different"};
    printf("{\"verdict\": \"%s\", \"p\": %.4g, \"p_blocks\": %.4g, \"p_histogram\": %.4g, "
           "\"p_regions\": %.4g, \"fraction_failed\": %.4g, \"mean_shift\": %.4g, "
           "\"mean_square\": %.4g, \"shares_noise\": %s, \"differing\": %ld, \"pixels\": %ld, "
           "\"reason\": \"%s\", \"note\": \"%s\", \"regions\": {",
           VERDICTS[r->verdict], r->p_value, r->p_blocks, r->p_histogram, r->p_regions,
           r->fraction_failed, r->mean_shift, r->mean_square, r->shares_noise ? "true" : "false",
           r->differing, r->pixels, r->reason, r->note);
    for (int i = 0; i < r->region_count; i++) {
        const StatisticRegion *g = &r->regions[i];
        const double figures[] = {g->shift, g->shift_sigma, g->change, g->change_sigma};
        printf("%s\"%s\": [", i ? ", " : "", g->name);
        for (int k = 0; k < 4; k++) print_number(figures[k], ", ");
        print_number(g->p_value, "]");
    }
    printf("}}\n");
}

int main(int argc, char **argv) {
    Arena arena = arena_reserve((size_t)4 << 30);
    FrameImage frames[2];
    StatisticResult result;
    Error err;
    char line[2048];
    if (argc < 3) {
        fprintf(stderr, "usage: bench_statistic REFERENCE.exr TEST.exr [LEVEL]\n");
        return 2;
    }
    StatisticOptions options = {
        .level = argc > 3 ? atof(argv[3]) : 0, .reference_name = argv[1], .test_name = argv[2]};
    if (!frame_read(argv[1], &arena, &frames[0], &err) ||
        !frame_read(argv[2], &arena, &frames[1], &err) ||
        !statistic_compare(&frames[0], &frames[1], &options, &arena, &result, &err)) {
        error_line(&err, line, sizeof line);
        fprintf(stderr, "bench_statistic: %s\n", line);
        return 1;
    }
    print_result(&result);
    arena_release(&arena);
    return 0;
}
