/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: a backlight at a place. No allocation, no lock, no libm. */
#include "panel/zones/backlight_at.h"

#include "base/mathf.h"

float backlight_at(const Backlight *backlight, const float place[2]) {
    int right, below;
    float s, t;
    int x = sample_place(place[0], backlight->width, &right, &s);
    int y = sample_place(place[1], backlight->height, &below, &t);
    const float *top = backlight->light + (size_t)y * (size_t)backlight->width;
    const float *low = backlight->light + (size_t)below * (size_t)backlight->width;
    float light = lerpf(lerpf(top[x], top[right], s), lerpf(low[x], low[right], s), t);
    if (backlight->is_log) light = light < 0 ? exp_f(light) : 1;
    return clampf(light, BACKLIGHT_DARK, 1);
}

/* ln of a primary's share at a code above 0: linear over ln code between whole ones, a power
 * law below 1, as panels' emission is (panel_components.c). */
static float log_share_of(const float *log_share, float code) {
    int whole = code < 255 ? (int)code : 255;
    if (whole == 255) return log_share[255];
    if (whole < 1) return log_share[1] + 2 * log_f(code);
    float span = log_f((float)(whole + 1) / (float)whole);
    return lerpf(log_share[whole], log_share[whole + 1], log_f(code / (float)whole) / span);
}

/* The least code with that share. */
static float code_of(const float *log_share, float wanted) {
    int low = 0, high = 255; /* log_share[low] < wanted <= log_share[high]; low 0: unknown */
    if (wanted >= log_share[255]) return 255;
    if (wanted < log_share[1]) return exp_f(0.5f * (wanted - log_share[1]));
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (log_share[middle] < wanted) low = middle;
        else high = middle;
    }
    if (low < 1 || !(log_share[high] > log_share[low])) return (float)high;
    float t = (wanted - log_share[low]) / (log_share[high] - log_share[low]);
    return (float)low * exp_f(t * log_f((float)high / (float)low));
}

void backlight_codes(const Backlight *backlight, float b, const float shown[3], float codes[3]) {
    float log = backlight->compensates && b < 1 ? log_f(b) : 0;
    for (int p = 0; p < 3; p++) {
        const float *log_share = backlight->log_share[p];
        codes[p] = shown[p];
        if (log < 0 && shown[p] > 0)
            codes[p] = max_f(code_of(log_share, log_share_of(log_share, shown[p]) - log), shown[p]);
    }
}
