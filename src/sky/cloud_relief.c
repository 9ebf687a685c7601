/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/cloud_relief.h"

#include "base/mathf.h"
#include "base/units.h"

float cloud_relief_row(const CloudRelief *relief, float elevation) {
    float below = relief->horizon - elevation;
    return (safe_sqrtf(relief->first + below) - safe_sqrtf(relief->first)) * relief->rows;
}

float cloud_relief_factor(const CloudRelief *relief, float elevation, float azimuth) {
    float turns = azimuth * (0.5f * INV_PI_F);
    float x = (turns - floorf(turns)) * CLOUD_RELIEF_COLUMNS; /* a column's own azimuth */
    float y = cloud_relief_row(relief, elevation) - 0.5f;     /* a row's middle */
    y = clampf(y, 0, CLOUD_RELIEF_ROWS - 1.001f);
    int i = (int)y, j = (int)x;
    float t = y - (float)i, u = x - (float)j;
    j = j < CLOUD_RELIEF_COLUMNS ? j : 0;
    int next = j + 1 < CLOUD_RELIEF_COLUMNS ? j + 1 : 0;
    const uint16_t *low = relief->factor + (size_t)i * CLOUD_RELIEF_COLUMNS;
    const uint16_t *high = low + CLOUD_RELIEF_COLUMNS;
    return lerpf(lerpf((float)low[j], (float)low[next], u),
                 lerpf((float)high[j], (float)high[next], u), t) *
           (1 / CLOUD_RELIEF_ONE);
}
