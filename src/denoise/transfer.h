/* SPDX-License-Identifier: Apache-2.0 */
/* transfer.h -- light as the network was trained to see it: a curve like that of lightness, the
 * joints included (README.md, sources).
 *
 * Range    0 .. TRANSFER_MOST of exposed light, relative, becomes 0 .. 1 and back.
 */
#pragma once
#include "base/mathf.h"

#define TRANSFER_MOST 65504.0f
#define TRANSFER_OF_MOST 3.13511904f /* transfer_curve(TRANSFER_MOST) */

static inline float transfer_curve(float y) {
    if (y <= 1.5794576e-6f) return 1412.83765f * y;
    if (y <= 0.0322087631f) return 1.64593172f * pow_f(y, 0.431384981f) - 0.00294139609f;
    return 0.192653254f * log_f(y + 0.00626026094f) + 0.998620152f;
}

static inline float transfer_encode(float light) {
    return transfer_curve(light) / TRANSFER_OF_MOST;
}

static inline float transfer_decode(float code) {
    const float x = code * TRANSFER_OF_MOST;
    if (x <= 0.00223151711f) return x / 1412.83765f;
    if (x <= 0.370974749f) return pow_f((x + 0.00294139609f) / 1.64593172f, 1 / 0.431384981f);
    return exp_f((x - 0.998620152f) / 0.192653254f) - 0.00626026094f;
}
