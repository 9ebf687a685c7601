/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/dimming_keys.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathd.h"
#include "record/rows.h"

static const char *const RULES[] = {"maximum", "mean", NULL};

#define OWNER DimmingZones

static const RecordRow SPREAD[] = {
    NUMBER("sigma_mm", RECORD_OPEN, sigma_mm, 0.01, 1e6, "Standard deviation of a Gaussian, mm."),
    NUMBERS("radius_mm", 0, spread.at, spread.rows, ZONE_ROWS_MAX, 0, 1e5,
            "Of a table: distances from the zone's middle that rise from 0, mm; behind the "
            "last there is no light."),
    NUMBERS("value", 0, spread.value, spread.values, ZONE_ROWS_MAX, 0, 1e9,
            "Light there, relative; as many as of radius_mm."),
    {0}};
static const RecordFormat spread_format = {
    "spread", sizeof(OWNER), SPREAD,
    .rules = "{'oneOf': [{'required': ['sigma_mm'], 'properties': {'radius_mm': false, "
             "'value': false}}, {'required': ['radius_mm', 'value'], 'properties': "
             "{'sigma_mm': false, 'radius_mm': {'minItems': 2}, 'value': {'minItems': 2}}}]}",
    .doc = "How the light of one zone falls with the distance from its middle."};

static const RecordRow DRIVE[] = {
    CHOICE("rule", 0, rule, RULES,
           "What of a zone's pixels decides: the largest light of any primary at any pixel, or "
           "the mean over pixels of each one's largest."),
    NUMBERS("codes", 0, drive.at, drive.rows, ZONE_ROWS_MAX, 0, 255,
            "Of a table: codes that rise; the rule is then over codes, not over their light."),
    NUMBERS("drives", 0, drive.value, drive.values, ZONE_ROWS_MAX, 0, 1,
            "The zone's drive at those codes, a share of full; straight lines between."),
    NUMBER("least", 0, least, 0, 1, "Drive of any zone, also of a black one."),
    {0}};
static const RecordFormat drive_format = {
    "drive", sizeof(OWNER), DRIVE,
    .rules = "{'dependentRequired': {'codes': ['drives'], 'drives': ['codes']}, "
             "'allOf': [{'properties': {'codes': {'minItems': 2}, "
             "'drives': {'minItems': 2}}}]}",
    .doc = "How a zone follows the picture. Without codes its drive is the light itself."};

static const RecordRow DIMMING[] = {
    WHOLES("zones", MUST, count, 2, 1, ZONES_SIDE_MAX,
           "Columns and rows of zones, even over the active area; at most 65536 in all."),
    {"spread", RECORD_OBJECT, RECORD_REQUIRED, .of = &spread_format},
    {"drive", RECORD_OBJECT, .of = &drive_format},
    FLAG("compensates", 0, compensates,
         "The controller opens lit pixels as their backlight falls, so that they keep their "
         "light where they can; false: they get the picture's codes."),
    {0}};
#undef OWNER

const RecordFormat dimming_format = {"local_dimming", sizeof(DimmingZones), DIMMING, .doc = NULL};

bool dimming_keys_check(const JsonView *root, const double size_mm[2], DimmingZones *zones,
                        Error *err) {
    const char *key, *fault;
    if (!(size_mm[0] > 0 && size_mm[1] > 0))
        return record_fails(root, "local_dimming", err,
                            "is there, but not 'size_mm': the "
                            "light of a zone spreads over millimetres");
    for (int k = 0; k < 2; k++) zones->size_mm[k] = size_mm[k];
    fault = dimming_zones_fault(zones, &key);
    if (!fault) return true;
    return error_at(err, ERROR_INPUT, root->file,
                    arena_format(root->arena, "%s/local_dimming/%s", root->path, key), "%s", fault);
}

/* ---- written ----------------------------------------------------------------------------- */

/* A file keeps single precision: 7 digits. */
static json_t *tidy(double value) {
    double digits = value != 0 ? pow_d(10, 6 - floor(log10_d(fabs(value)))) : 1;
    return json_real(round(value * digits) / digits);
}

static void add_list(json_t *object, const char *key, const double *value, int count) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, tidy(value[i]));
    json_object_set_new(object, key, list);
}

json_t *dimming_keys_json(const DimmingZones *zones) {
    json_t *spread = json_object(), *drive = json_object();
    if (zones->sigma_mm > 0) {
        json_object_set_new(spread, "sigma_mm", tidy(zones->sigma_mm));
    } else {
        add_list(spread, "radius_mm", zones->spread.at, zones->spread.rows);
        add_list(spread, "value", zones->spread.value, zones->spread.rows);
    }
    json_object_set_new(drive, "rule", json_string(RULES[zones->rule]));
    if (zones->drive.rows) {
        add_list(drive, "codes", zones->drive.at, zones->drive.rows);
        add_list(drive, "drives", zones->drive.value, zones->drive.rows);
    }
    json_object_set_new(drive, "least", tidy(zones->least));
    return json_pack("{s:[i,i], s:o, s:o, s:b}", "zones", zones->count[0], zones->count[1],
                     "spread", spread, "drive", drive, "compensates", zones->compensates);
}
