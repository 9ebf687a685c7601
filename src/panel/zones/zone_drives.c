/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/zones/zone_drives.h"

#include <math.h>
#include <stddef.h>

#include "base/mathd.h"

double level_share_at(const LevelShares *levels, int primary, double code) {
    const float *share = levels->share[primary];
    if (!(code > 0)) return 0;
    if (code >= 255) return 1;
    int whole = (int)code;
    if (whole < 1) return (double)share[1] * code * code;
    double low = (double)share[whole], high = (double)share[whole + 1];
    if (!(low > 0)) return high * (code - whole);
    return low * pow_d(high / low, log_d(code / whole) / log_d((whole + 1.0) / whole));
}

/* What counts of a pixel: its largest code where a table says the drive, else its largest
 * share of light. */
static double pixel_value(const DimmingZones *zones, const LevelShares *levels,
                          const float codes[3]) {
    double most = 0;
    for (int p = 0; p < 3; p++)
        most = fmax(most, zones->drive.rows ? fmax((double)codes[p], 0)
                                            : level_share_at(levels, p, (double)codes[p]));
    return most;
}

/* Pixels along an axis: the picture's, or a few in each zone where it has fewer. */
static int pixels_along(const DimmingZones *zones, const ShownPicture *picture, int k) {
    int least = 2 * zones->count[k], own = k ? picture->rows : picture->columns;
    return own < least ? least : own;
}

static double drive_of(const DimmingZones *zones, double value) {
    double drive = zones->drive.rows ? zone_table_at(&zones->drive, value) : value;
    return fmin(fmax(drive, zones->least), 1);
}

double backlight_drives(const DimmingZones *zones, const LevelShares *levels,
                        const ShownPicture *picture, double *drive) {
    int columns = zones->count[0], count = columns * zones->count[1];
    int across = pixels_along(zones, picture, 0), down = pixels_along(zones, picture, 1);
    double pixels[ZONES_SIDE_MAX] = {0}, sum = 0;
    for (int i = 0; i < count; i++) drive[i] = 0;
    for (int x = 0; x < across; x++) pixels[(long)x * columns / across]++;
    for (int y = 0; y < down; y++) {
        int row = (int)((long)y * zones->count[1] / down);
        double *of_row = drive + (size_t)row * (size_t)columns;
        for (int x = 0; x < across; x++) {
            float place[2] = {((float)x + 0.5f) / (float)across, ((float)y + 0.5f) / (float)down};
            float codes[3];
            int column = (int)((long)x * columns / across);
            picture->codes(picture->user, place, codes);
            double value = pixel_value(zones, levels, codes);
            if (zones->rule == ZONES_MAXIMUM) of_row[column] = fmax(of_row[column], value);
            else of_row[column] += value / pixels[column];
        }
    }
    for (int row = 0; row < zones->count[1]; row++) {
        long first = ((long)row * down + zones->count[1] - 1) / zones->count[1];
        long end = ((long)(row + 1) * down + zones->count[1] - 1) / zones->count[1];
        for (int x = 0; x < columns; x++) {
            double *one = drive + (size_t)row * (size_t)columns + x;
            if (zones->rule == ZONES_MEAN) *one /= (double)(end - first);
            *one = drive_of(zones, *one);
            sum += *one;
        }
    }
    return sum / count;
}
