/* SPDX-License-Identifier: Apache-2.0 */
/* panel_levels.h -- between grey levels. Private to src/panel.
 *
 * Threads  pure functions. Fails: never.
 */
#pragma once

/* How the levels of a channel make a code's logarithm: fixed weights over at most four levels,
 * of cubic Hermite pieces over ln code whose slopes are those of Fritsch and Butland (1984) at
 * the channel's mean curve, as first-order changes of it. Exact on the mean curve, linear in
 * the levels' logarithms. */
typedef struct PanelLevelWeights {
    int first;       /* level of weight[0] */
    float weight[4]; /* of logarithms; those beyond the last level are 0 */
    float offset;    /* to be added: power laws of a single level */
} PanelLevelWeights;

/* curve: the levels' mean logarithms; log_level: ln of their codes. code > 0. */
PanelLevelWeights panel_level_weights(const float *log_level, const float *curve, int count,
                                      float level_power, float log_code);
