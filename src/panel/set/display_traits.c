/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/display_traits.h"

#include "record/rows.h"

#define OWNER DisplayTraits

static const RecordRow POLARISATION[] = {
    NUMBER("degree", MUST, polarisation_degree, 0, 1, "The linearly polarised share."),
    NUMBER("azimuth_deg", MUST, polarisation_azimuth_deg, -360, 360,
           "Along which its electric field swings: 0 right, 90 up."),
    {0}};
const RecordFormat polarisation_format = {"polarisation", sizeof(DisplayTraits), POLARISATION,
                                          .doc = NULL};

bool display_traits_check(const JsonView *root, const double size_mm[2], DisplayTraits *traits,
                          Error *err) {
    return !traits->has_zones || dimming_keys_check(root, size_mm, &traits->zones, err);
}
