/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/zones/dimming_zones.h"

#include <math.h>
#include <stddef.h>

#include "base/mathd.h"

double zone_table_at(const ZoneTable *table, double at) {
    int last = table->rows - 1, i = 0;
    if (!(at > table->at[0])) return table->value[0];
    if (at >= table->at[last]) return table->value[last];
    while (at >= table->at[i + 1]) i++;
    double t = (at - table->at[i]) / (table->at[i + 1] - table->at[i]);
    return table->value[i] + t * (table->value[i + 1] - table->value[i]);
}

double dimming_zones_spread(const DimmingZones *zones, double mm) {
    double over = mm / zones->sigma_mm;
    if (zones->sigma_mm > 0) return exp_d(-0.5 * over * over);
    return mm > zones->spread.at[zones->spread.rows - 1] ? 0 : zone_table_at(&zones->spread, mm);
}

/* ---- what is wrong ----------------------------------------------------------------------- */

/* Values from 0 to `most`. */
static bool is_table(const ZoneTable *table, double most) {
    if (table->rows != table->values || table->rows < 2 || table->rows > ZONE_ROWS_MAX)
        return false;
    for (int i = 0; i < table->rows; i++)
        if (!(table->value[i] >= 0 && table->value[i] <= most) || !isfinite(table->at[i]) ||
            (i && !(table->at[i] > table->at[i - 1])))
            return false;
    return true;
}

static const char *zones_fault(const DimmingZones *zones) {
    for (int k = 0; k < 2; k++) {
        if (zones->count[k] < 1 || zones->count[k] > ZONES_SIDE_MAX)
            return "has too many, required: 1 to 512 columns and 1 to 512 rows";
        if (!(zones->size_mm[k] >= 1 && zones->size_mm[k] <= 1e5))
            return "has no size of the active area, required: 1 to 100000 mm";
    }
    return zones->count[0] * zones->count[1] > ZONES_MOST
               ? "has too many, required: at most 65536 in all"
               : NULL;
}

static const char *spread_fault(const DimmingZones *zones) {
    double wide = zones->size_mm[0] / zones->count[0], high = zones->size_mm[1] / zones->count[1];
    if (zones->sigma_mm > 0 && zones->spread.rows)
        return "has both 'sigma_mm' and a table, required: one of them";
    if (zones->sigma_mm > 0)
        return zones->sigma_mm >= ZONE_SIGMA_LEAST * fmax(wide, high) && zones->sigma_mm <= 1e6
                   ? NULL
                   : "has a sigma_mm that leaves it dark between zones, required: an eighth of "
                     "a zone's longer side at least";
    if (!is_table(&zones->spread, 1e9) || zones->spread.at[0] != 0)
        return "has no spread, required: 'sigma_mm', or 2 to 64 values from 0 on at as many "
               "radii that rise from 0";
    double reach = zones->spread.at[zones->spread.rows - 1];
    if (!(dimming_zones_spread(zones, 0.5 * sqrt(wide * wide + high * high)) > 0))
        return "has a table that leaves it dark between zones, required: light at half a "
               "zone's diagonal";
    return reach <= ZONE_REACH_MAX * fmin(wide, high)
               ? NULL
               : "has a table that reaches too far, required: at most over 64 zones";
}

static const char *drive_fault(const DimmingZones *zones) {
    const ZoneTable *drive = &zones->drive;
    if (!(zones->least >= 0 && zones->least <= 1))
        return "has a least drive that is none, required: 0 to 1";
    if (zones->rule != ZONES_MAXIMUM && zones->rule != ZONES_MEAN)
        return "has an unknown rule, required: maximum or mean";
    if (!drive->rows && !drive->values) return NULL;
    if (!is_table(drive, 1) || drive->at[0] < 0 || drive->at[drive->rows - 1] > 255)
        return "has a wrong table, required: 2 to 64 drives from 0 to 1 at as many codes that "
               "rise, 0 to 255";
    return NULL;
}

const char *dimming_zones_fault(const DimmingZones *zones, const char **key) {
    const char *fault = zones_fault(zones);
    *key = "zones";
    if (fault) return fault;
    *key = "spread";
    fault = spread_fault(zones);
    if (fault) return fault;
    *key = "drive";
    return drive_fault(zones);
}
