/* SPDX-License-Identifier: Apache-2.0 */
/* display_traits.h -- keys that manifests and recipes share: how a display's light is
 * polarised, and how its backlight is dimmed.
 *
 * Both hold for the whole display, at every angle and place.
 * Fails    with file, JSON path, found and required.
 */
#pragma once
#include "panel/query/panel.h"
#include "panel/set/dimming_keys.h"
#include "record/record.h"

typedef struct DisplayTraits {
    double polarisation_degree;      /* linear, 0 to 1; 0: unpolarised */
    double polarisation_azimuth_deg; /* -360 to 360: 0 right, 90 up */
    DimmingZones zones;              /* its count 0: the backlight is one, always full */
    bool has_zones;
} DisplayTraits;

/* "polarisation" and "local_dimming" of a document whose struct has them in `member`. */
#define DISPLAY_TRAITS_ROWS(Type, member) \
    {"polarisation", RECORD_OBJECT, RECORD_AT(Type, member), .of = &polarisation_format, \
     .doc = "Of the emitted light. Absent: unpolarised."}, \
        {"local_dimming", \
         RECORD_OBJECT, \
         RECORD_AT(Type, member.zones), \
         .of = &dimming_format, \
         .count = offsetof(Type, member.has_zones), \
         .doc = "A backlight of zones that follow the picture; needs size_mm. Absent: it is " \
                "one, always full."}
extern const RecordFormat polarisation_format; /* of a DisplayTraits */

/* What rows cannot say, once they are read. size_mm: of the active area; 0: not stated. */
bool display_traits_check(const JsonView *root, const double size_mm[2], DisplayTraits *traits,
                          Error *err);
