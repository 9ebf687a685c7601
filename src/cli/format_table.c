/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/format_table.h"

#include "base/count.h"
#include "equip/equip_file.h"
#include "import/import_request.h"
#include "panel/set/manifest.h"
#include "panel/set/synthetic_format.h"
#include "review/profile.h"
#include "review/request/request_read.h"
#include "scene/check/our_extensions.h"

const NamedFormat format_table[] = {
    {"profile", "Limits that a glare review holds its figures against", &profile_format},
    {"equip", "EQUIP.json, what a model is equipped with", &equip_format},
    {"review", "REVIEW.json: what a glare review is asked", &review_format},
    {"import_declaration", "--layout DECLARATION.json of panel import", &import_format},
    {"measurement_set", "MANIFEST.json of a measurement set", &manifest_format},
    {"recipe", "A synthetic panel, *.recipe.json", &synthetic_format},
    {"PARHELION_display", "PARHELION_display on a glTF material", &display_extension},
    {"PARHELION_glazing", "PARHELION_glazing on a glTF material", &glazing_extension},
    {"PARHELION_spectrum", "PARHELION_spectrum on a glTF material", &spectrum_extension},
    {"PARHELION_coating", "PARHELION_coating on a glTF material", &coating_extension},
    {"PARHELION_environment", "PARHELION_environment on a glTF scene", &environment_extension},
};
const int schema_count = COUNT_OF(format_table);
const int format_count = COUNT_OF(format_table) - 5;
