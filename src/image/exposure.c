/* SPDX-License-Identifier: Apache-2.0 */
#include "image/exposure.h"

#include <math.h>
#include <string.h>

#include "base/mathf.h"
#include "base/number.h"

#define KEY_LOW 0.05
#define KEY_HIGH 0.60
#define KEY_SHOWN_AT 0.12
#define NIGHT_RATIO 1.5
#define NIGHT_CD_M2 2.0
#define GUARD_PERCENTILE 0.99
#define BRIGHT_PERCENTILE 0.90
#define GUARD_RATIO 16.0
#define GUARD_NIGHT_CD_M2 300.0

double exposure_grey_of_ev(double ev) {
    return EXPOSURE_METER_CD_M2 * exp2(ev);
}

double exposure_ev_of_grey(double grey_cd_m2) {
    return log2(grey_cd_m2 / EXPOSURE_METER_CD_M2);
}

bool exposure_parse(const char *text, ExposureRequest *out, Error *err) {
    ExposureRequest request = {EXPOSURE_AUTO, 0};
    bool ok = !strcmp(text, "auto");
    if (!strncmp(text, "white:", 6)) {
        request.kind = EXPOSURE_WHITE;
        ok = number_is(text + 6, &request.value) && request.value > 0;
    } else if (!ok) {
        request.kind = EXPOSURE_EV;
        ok = number_is(text, &request.value) && fabs(request.value) <= 60;
    }
    if (!ok)
        return error_set(err, ERROR_USAGE,
                         "--exposure %s: required: auto, an exposure value (-60 to 60), or "
                         "white:CD_M2 with a luminance above 0",
                         text);
    *out = request;
    return true;
}

/* Luminances sorted into bins of 1/64 stop, with the sum of the logarithms in each. */
enum { BINS_A_STOP = 64, STOPS = 64, BIN_COUNT = BINS_A_STOP * STOPS };

typedef struct Histogram {
    double count[BIN_COUNT], log_sum[BIN_COUNT];
    double total;
} Histogram;

static Histogram *histogram_of(const float *luminance, size_t count, Arena *arena) {
    Histogram *h = ARENA_NEW(arena, Histogram, 1);
    for (size_t i = 0; i < count; i++) {
        if (!(luminance[i] > 0) || !isfinite(luminance[i])) continue;
        float stops = log_f(luminance[i]) * 1.44269504f;
        float at = clampf((stops + STOPS / 2) * BINS_A_STOP, 0, BIN_COUNT - 1);
        h->count[(int)at]++;
        h->log_sum[(int)at] += (double)stops;
        h->total++;
    }
    return h;
}

/* Mean of log2 over the ranks between two fractions; a bin that is cut counts in part. */
static double mean_log2(const Histogram *h, double low, double high) {
    double from = low * h->total, to = high * h->total, before = 0, sum = 0, weight = 0;
    for (int i = 0; i < BIN_COUNT; i++) {
        double after = before + h->count[i];
        double part = fmin(after, to) - fmax(before, from);
        if (part > 0) {
            sum += h->log_sum[i] * part / h->count[i];
            weight += part;
        }
        before = after;
    }
    return sum / weight;
}

static double percentile(const Histogram *h, double at) {
    return exp2(mean_log2(h, at - 0.005, at + 0.005));
}

/* The luminance that becomes middle grey by `auto`, made for a cabin with the day outside:
 *
 *   key   the geometric mean of the darker pixels: those between the 5th and the 60th
 *         percentile of all that are above zero. The view through the windows is brighter
 *         than the cabin by orders of magnitude and does not count.
 *   shown at 0.12 rather than 0.18 (trim is dark, and should look it): grey = key * 0.18/0.12;
 *   night a street under lamps should not look like one by day: grey is at least p90 / 1.5, of
 *         a p90 up to 2 cd/m2. Chosen by eye, on the car at night;
 *   guard at night the key is close to nothing and the displays would burn out: grey is at
 *         least p99 / G with G = 16 max(1, sqrt(p99 / 300 cd/m2)); the 99th percentile stays
 *         within four stops above middle grey at night, six to seven by day.
 *
 * Not finite and not positive values do not count; without any other the answer is 1. */
static double auto_grey(const float *luminance_cd_m2, size_t count, Arena scratch) {
    const Histogram *h = histogram_of(luminance_cd_m2, count, &scratch);
    if (h->total == 0) return 1;
    double key = exp2(mean_log2(h, KEY_LOW, KEY_HIGH));
    double bright = percentile(h, GUARD_PERCENTILE);
    double ratio = GUARD_RATIO * fmax(1, sqrt(bright / GUARD_NIGHT_CD_M2));
    double night = fmin(percentile(h, BRIGHT_PERCENTILE), NIGHT_CD_M2) / NIGHT_RATIO;
    return fmax(key * (MIDDLE_GREY / KEY_SHOWN_AT), fmax(bright / ratio, night));
}

double exposure_bright_stops(const float *luminance_cd_m2, size_t count, double grey_cd_m2,
                             Arena scratch) {
    const Histogram *h = histogram_of(luminance_cd_m2, count, &scratch);
    if (h->total == 0) return 0;
    return log2(percentile(h, BRIGHT_PERCENTILE) / grey_cd_m2);
}

double exposure_grey(ExposureRequest request, const float *luminance_cd_m2, size_t count,
                     Arena scratch) {
    switch (request.kind) {
    case EXPOSURE_EV: return exposure_grey_of_ev(request.value);
    case EXPOSURE_WHITE: return request.value * MIDDLE_GREY;
    case EXPOSURE_AUTO: break;
    }
    return auto_grey(luminance_cd_m2, count, scratch);
}
