/* SPDX-License-Identifier: Apache-2.0 */
/* dimming_zones.h -- a backlight of zones that are dimmed apart (local dimming), as a panel's
 * manifest and file state it: where they are, how far a zone's light spreads, how it is driven.
 *
 * Zones    even columns and rows over the active area, the first at its upper left corner.
 * Units    mm on the panel; drives are shares of full, 0 to 1; codes 0 to 255.
 * Threads  const once it is read. Fails: dimming_zones_fault says in words what is wrong.
 */
#pragma once
#include <stdbool.h>

#define ZONES_SIDE_MAX 512
#define ZONES_MOST 65536       /* in all */
#define ZONE_ROWS_MAX 64       /* of a table */
#define ZONE_REACH_MAX 64      /* a table's spread, in zones */
#define ZONE_SIGMA_LEAST 0.125 /* of a zone's longer side: less would leave it dark between */

typedef enum ZoneRule {
    ZONES_MAXIMUM, /* by the brightest pixel of the zone */
    ZONES_MEAN     /* by the mean of its pixels */
} ZoneRule;

/* Straight lines between rows; `at` rises. No rows: there is no table. */
typedef struct ZoneTable {
    int rows, values; /* equal, but while a file is read */
    double at[ZONE_ROWS_MAX], value[ZONE_ROWS_MAX];
} ZoneTable;

typedef struct DimmingZones {
    int count[2];      /* columns and rows; 0: the backlight is one, always full */
    double size_mm[2]; /* of the active area */
    double sigma_mm;   /* of the Gaussian of a zone's light; 0: `spread` says it */
    ZoneTable spread;  /* mm from the zone's middle; relative light, 0 behind it */
    int rule;          /* ZoneRule */
    ZoneTable drive;   /* code to drive; no rows: the drive is the light of the code */
    double least;      /* drive of any zone */
    bool compensates;  /* the controller opens pixels as their backlight falls */
} DimmingZones;

/* Why a backlight cannot be so, in words that follow the place: "has ..., required: ..."; NULL:
 * it can. *key: the one of "zones", "spread", "drive" that is wrong. */
const char *dimming_zones_fault(const DimmingZones *zones, const char **key);

/* Of a table with rows: straight lines between them, held outside. */
double zone_table_at(const ZoneTable *table, double at);

/* Relative light of one zone at so many mm from its middle. */
double dimming_zones_spread(const DimmingZones *zones, double mm);
