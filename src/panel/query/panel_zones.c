/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_zones.h"

#include <stdio.h>
#include <string.h>

#include "base/mathf.h"
#include "panel/query/panel_components.h"
#include "panel/query/panel_opened.h"

const DimmingZones *panel_zones(const Panel *panel) {
    return panel->zones;
}

void panel_level_shares(const Panel *panel, LevelShares *out) {
    float logs[3][256];
    memset(out, 0, sizeof *out);
    for (int code = 1; code < 256; code++) {
        PanelFloat4 sources[4];
        const float rgb[3] = {(float)code, (float)code, (float)code};
        panel_source_logs(panel, vec3(0, 0, 1), rgb, sources);
        for (int p = 0; p < 3; p++) logs[p][code] = sources[p][1];
    }
    for (int p = 0; p < 3; p++)
        for (int code = 1; code < 256; code++)
            out->share[p][code] =
                code == 255
                    ? 1
                    : fmaxf(out->share[p][code - 1], fminf(exp_f(logs[p][code] - logs[p][255]), 1));
}

/* ---- opening ----------------------------------------------------------------------------- */

static void read_pairs(const unsigned char *from, int rows, ZoneTable *out) {
    out->rows = out->values = rows;
    for (int i = 0; i < rows; i++) {
        float pair[2];
        memcpy(pair, from + (size_t)i * sizeof pair, sizeof pair);
        out->at[i] = (double)pair[0];
        out->value[i] = (double)pair[1];
    }
}

static bool check_head(const PanelBytes *bytes, const PanelBytes *at,
                       const PanelZonesStored *stored) {
    char what[96];
    if (stored->version != PANEL_ZONES_VERSION) {
        snprintf(what, sizeof what, "have version %u, known: %u", (unsigned)stored->version,
                 PANEL_ZONES_VERSION);
        return panel_refuse(bytes, "zones", what);
    }
    if (stored->spread_rows > ZONE_ROWS_MAX || stored->drive_rows > ZONE_ROWS_MAX ||
        stored->compensates > 1 || stored->reserved[0] || stored->reserved[1])
        return panel_refuse(bytes, "zones", "a number is out of range");
    return at->size == sizeof *stored +
                           2 * sizeof(float) * ((size_t)stored->spread_rows + stored->drive_rows) ||
           panel_refuse(bytes, "zones", "have a wrong number of bytes");
}

bool panel_open_zones(const PanelBytes *bytes, Arena *arena, Panel *panel) {
    PanelBytes at;
    bool found;
    const char *key, *fault;
    PanelZonesStored stored;
    if (!panel_find_section(bytes, PANEL_ZONES, 0, &at, &found)) return false;
    if (!found) return true;
    if (at.size < sizeof stored)
        return panel_refuse(bytes, "zones", "have a wrong number of bytes");
    memcpy(&stored, at.data, sizeof stored);
    if (!check_head(bytes, &at, &stored)) return false;
    if (!panel->emission) return panel_refuse(bytes, "zones", "stand without an emission");
    DimmingZones *zones = ARENA_NEW(arena, DimmingZones, 1);
    *zones = (DimmingZones){.count = {stored.columns, stored.rows},
                            .size_mm = {(double)stored.size_mm[0], (double)stored.size_mm[1]},
                            .sigma_mm = (double)stored.sigma_mm,
                            .rule = stored.rule,
                            .least = (double)stored.least,
                            .compensates = stored.compensates};
    const unsigned char *pairs = (const unsigned char *)at.data + sizeof stored;
    read_pairs(pairs, stored.spread_rows, &zones->spread);
    read_pairs(pairs + 2 * sizeof(float) * stored.spread_rows, stored.drive_rows, &zones->drive);
    fault = dimming_zones_fault(zones, &key);
    if (fault) return panel_refuse(bytes, key, fault);
    panel->zones = zones;
    return true;
}
