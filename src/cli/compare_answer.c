/* SPDX-License-Identifier: Apache-2.0 */
/* The printed answer of `parhelion compare`. */
#include <math.h>
#include <stdio.h>

#include "cli/compare_answer.h"
#include "compare/metrics.h"

static bool is_known(const Comparison *c, Metric metric)
{
    return !isnan(c->value[metric]);
}

static void print_flip(const Comparison *c)
{
    if (!is_known(c, METRIC_FLIP)) return;
    printf("%-12s %.4g, median %.4g, p95 %.4g, max %.4g", "flip", c->value[METRIC_FLIP],
           c->value[METRIC_FLIP_MEDIAN], c->value[METRIC_FLIP_P95], c->value[METRIC_FLIP_MAX]);
    if (c->reference.kind == INPUT_FRAME)
        printf(" (%d exposures, EV %.1f to %.1f)", c->exposures.count,
               ev_of_stops(c->exposures.stop_ev), ev_of_stops(c->exposures.start_ev));
    printf("\n");
}

static void print_errors(const Comparison *c)
{
    const char *unit = c->reference.kind == INPUT_FRAME ? " cd/m2" : "";
    if (is_known(c, METRIC_MEAN_SHIFT))
        printf("%-12s %+.4g %%\n", "mean_shift", 100 * c->value[METRIC_MEAN_SHIFT]);
    if (is_known(c, METRIC_MSE))
        printf("%-12s mae %.4g%s, mse %.4g, relmse %.4g, max %.4g%s\n", "error",
               c->value[METRIC_MAE], unit, c->value[METRIC_MSE], c->value[METRIC_RELMSE],
               c->value[METRIC_MAX_DIFFERENCE], unit);
    if (is_known(c, METRIC_PSNR)) printf("%-12s %.4g dB\n", "psnr", c->value[METRIC_PSNR]);
    if (is_known(c, METRIC_SSIM)) printf("%-12s %.6g\n", "ssim", c->value[METRIC_SSIM]);
    if (is_known(c, METRIC_DELTAE_MEAN))
        printf("%-12s mean %.4g, p95 %.4g, max %.4g\n", "deltae",
               c->value[METRIC_DELTAE_MEAN], c->value[METRIC_DELTAE_P95],
               c->value[METRIC_DELTAE_MAX]);
}

static void print_statistic(const StatisticResult *s)
{
    printf("%-12s p = %.3g, %.3g %% of %d x %d blocks beyond the level, mean %+.4g %%\n",
           "stat", s->p_value, 100 * s->fraction_failed, s->blocks_x, s->blocks_y,
           100 * s->mean_shift);
    for (int i = 0; i < s->region_count; i++) {
        const StatisticRegion *r = &s->regions[i];
        if (r->moved)
            printf("%-12s %s: %.5g to %.5g cd/m2, %+.3g +- %.2g %% (p = %.2g)\n", "  moved",
                   r->name, r->reference, r->test, 100 * r->shift, 196 * r->shift_sigma,
                   r->p_value);
    }
}

static void print_contrasts(const Comparison *c)
{
    for (int i = 0; i < c->contrast_count; i++) {
        const ContrastChange *d = &c->contrasts[i];
        printf("%-12s %s: %.4g : 1 to %.4g : 1, %+.3g", "contrast", d->display,
               d->reference.contrast.value, d->test.contrast.value,
               100 * (d->ratio.value - 1));
        if (isfinite(d->ratio.low)) printf(" +- %.2g", 100 * measured_half_width(d->ratio));
        printf(" %%\n");
    }
}

void compare_print_pair(const CompareRequest *request, const Comparison *c)
{
    if (c->has_pixels) {
        print_contrasts(c);
        if (c->has_stat) print_statistic(&c->stat);
        printf("%-12s %ld of %ld differ\n", "pixels", c->channels.differing,
               c->selection.pixels);
        print_errors(c);
        print_flip(c);
    }
    for (int i = 0; i < c->notes.count; i++) printf("note: %s\n", c->notes.list[i]);
    for (int i = 0; i < c->reasons.count && c->reasons.count > 1; i++)
        printf("reason: %s\n", c->reasons.list[i]);
    if (request->report) printf("report: %s\n", request->report);
    printf("%s: %s%s%s\n", c->same ? "same" : "different", c->verdict,
           c->mean[0] ? ". " : "", c->mean);
}

void compare_print_line(const char *name, const Comparison *c)
{
    printf("%-10s %s: %s", c->same ? "same" : "different", name, c->verdict);
    if (c->has_pixels && is_known(c, METRIC_FLIP) && c->channels.differing > 0)
        printf(" [flip %.3g]", c->value[METRIC_FLIP]);
    printf("\n");
}
