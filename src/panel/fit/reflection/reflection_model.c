/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_model.h"

#include "base/units.h"
#include "panel/fit/common/table_rows.h"

Vec3 reflection_model_light(const Measurement *set, int table) {
    double theta = set->incidence[table % set->incidence_count];
    bool is_turned = set->azimuth_count > 1;
    return table_direction(theta, is_turned ? set->azimuth[table / set->incidence_count] : PI);
}

Wavelengths reflection_model_wavelengths(const Measurement *set, int first) {
    Wavelengths wavelengths = {0};
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int w = first + i < set->wavelength_count ? first + i : set->wavelength_count - 1;
        wavelengths.nm[i] = set->wavelength_nm[w];
    }
    return wavelengths;
}

ReflectionView reflection_view(const ReflectionModel *model, int table) {
    double theta = reflection_model_incidence(model, table);
    return (ReflectionView){specular_frame((float)theta, model->k),
                            reflection_model_fresnel(model, table)};
}
