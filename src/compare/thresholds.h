/* SPDX-License-Identifier: Apache-2.0 */
/* thresholds.h -- the metrics of a comparison by name, and the limits that a user sets.
 *
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

typedef enum Metric {
    METRIC_FLIP,
    METRIC_FLIP_MEDIAN,
    METRIC_FLIP_P95,
    METRIC_FLIP_MAX,
    METRIC_PSNR,
    METRIC_SSIM,
    METRIC_DELTAE_MEAN,
    METRIC_DELTAE_P95,
    METRIC_DELTAE_MAX,
    METRIC_MSE,
    METRIC_RELMSE,
    METRIC_MAE,
    METRIC_MAX_DIFFERENCE,
    METRIC_MEAN_SHIFT,
    METRIC_DIFFERING,
    METRIC_P_VALUE,
    METRIC_FRACTION_FAILED,
    METRIC_CONTRAST_CHANGE,
    METRIC_COUNT
} Metric;

/* Groups of metrics that are computed together. */
enum {
    GROUP_FLIP = 1,
    GROUP_PSNR = 2,
    GROUP_SSIM = 4,
    GROUP_DELTAE = 8,
    GROUP_MSE = 16,
    GROUP_STAT = 32,
    GROUP_CONTRAST = 64,
    GROUP_ALL = 127
};

typedef struct MetricInfo {
    const char *name;  /* as typed, and the key in JSON */
    unsigned group;    /* 0: always computed */
    bool is_min;       /* greater is better: --min */
    bool is_change;    /* limits its absolute value */
    const char *label; /* for people */
    const char *unit;  /* "" none; "light": cd/m2, or a share of the codes' range; "light^2" */
} MetricInfo;

const MetricInfo *metric_info(Metric metric);

typedef struct Threshold {
    Metric metric;
    double limit; /* at most, or at least where is_min */
} Threshold;

/* METRIC_COUNT for a name that there is not. */
Metric metric_find(const char *name);

/* The group of a group's name or of a metric's; 0 for neither. */
unsigned metric_group_find(const char *name);

/* NaN is within no limit. */
bool threshold_holds(Threshold threshold, double value);
