/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/thresholds.h"

#include <math.h>
#include <string.h>

static const MetricInfo METRICS[METRIC_COUNT] = {
    [METRIC_FLIP] = {"flip", GROUP_FLIP, false, false, "FLIP, mean", ""},
    [METRIC_FLIP_MEDIAN] = {"flip_median", GROUP_FLIP, false, false, "FLIP, median", ""},
    [METRIC_FLIP_P95] = {"flip_p95", GROUP_FLIP, false, false, "FLIP, 95th percentile", ""},
    [METRIC_FLIP_MAX] = {"flip_max", GROUP_FLIP, false, false, "FLIP, greatest", ""},
    [METRIC_PSNR] = {"psnr", GROUP_PSNR, true, false, "PSNR", "dB"},
    [METRIC_SSIM] = {"ssim", GROUP_SSIM, true, false, "SSIM", ""},
    [METRIC_DELTAE_MEAN] = {"deltae_mean", GROUP_DELTAE, false, false, "ΔE2000, mean", ""},
    [METRIC_DELTAE_P95] = {"deltae_p95", GROUP_DELTAE, false, false, "ΔE2000, 95th percentile", ""},
    [METRIC_DELTAE_MAX] = {"deltae_max", GROUP_DELTAE, false, false, "ΔE2000, greatest", ""},
    [METRIC_MSE] = {"mse", GROUP_MSE, false, false, "mean squared error", "light^2"},
    [METRIC_RELMSE] = {"relmse", GROUP_MSE, false, false, "relative mean squared error", ""},
    [METRIC_MAE] = {"mae", GROUP_MSE, false, false, "mean absolute error", "light"},
    [METRIC_MAX_DIFFERENCE] = {"max_difference", GROUP_MSE, false, false, "greatest difference",
                               "light"},
    [METRIC_MEAN_SHIFT] = {"mean_shift", GROUP_MSE, false, true, "change of the mean luminance",
                           "%"},
    [METRIC_DIFFERING] = {"differing", 0, false, false, "pixels that differ", "%"},
    [METRIC_P_VALUE] = {"p_value", GROUP_STAT, true, false, "p of the statistical test", ""},
    [METRIC_FRACTION_FAILED] = {"fraction_failed", GROUP_STAT, false, false,
                                "blocks beyond the level", "%"},
    [METRIC_CONTRAST_CHANGE] = {"contrast_change", GROUP_CONTRAST, false, true,
                                "greatest change of a display's contrast", "%"},
};

static const struct {
    const char *name;
    unsigned group;
} GROUPS[] = {
    {"flip", GROUP_FLIP},         {"mse", GROUP_MSE},       {"psnr", GROUP_PSNR},
    {"ssim", GROUP_SSIM},         {"deltae", GROUP_DELTAE}, {"stat", GROUP_STAT},
    {"contrast", GROUP_CONTRAST},
};

const MetricInfo *metric_info(Metric metric) {
    return &METRICS[metric];
}

Metric metric_find(const char *name) {
    int i = 0;
    while (i < METRIC_COUNT && strcmp(name, METRICS[i].name) != 0) i++;
    return (Metric)i;
}

unsigned metric_group_find(const char *name) {
    for (size_t i = 0; i < sizeof GROUPS / sizeof *GROUPS; i++)
        if (!strcmp(name, GROUPS[i].name)) return GROUPS[i].group;
    Metric metric = metric_find(name);
    return metric < METRIC_COUNT ? METRICS[metric].group : 0;
}

bool threshold_holds(Threshold threshold, double value) {
    const MetricInfo *info = &METRICS[threshold.metric];
    if (info->is_min) return value >= threshold.limit;
    return (info->is_change ? fabs(value) : value) <= threshold.limit;
}
