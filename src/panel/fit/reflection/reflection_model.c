/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_model.h"

#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/query/panel_reference.h"
#include "panel/query/panel_turn.h"

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
    return (ReflectionView){&model->surface, specular_frame((float)theta, model->k),
                            reflection_model_light(model->set, table),
                            reflection_model_fresnel(model, table)};
}

Vec3 reflection_view_stored(const ReflectionView *view, Vec3 local) {
    if (view->surface->stored.frame == PANEL_FRAME_SPECULAR)
        return specular_frame_stored(&view->specular, local);
    return surface_frame_stored(&view->surface->frame, view->light,
                                panel_turned_back(view->light, local));
}

Vec3 reflection_view_local(const ReflectionView *view, Vec3 stored) {
    if (view->surface->stored.frame == PANEL_FRAME_SPECULAR)
        return specular_frame_outer(&view->specular, stored);
    return panel_turned(view->light,
                        surface_frame_leaving(&view->surface->frame, view->light, stored));
}

double reflection_view_reference(const ReflectionView *view, Vec3 local) {
    PanelFrameKind frame = (PanelFrameKind)view->surface->stored.frame;
    if (frame == PANEL_FRAME_SPECULAR) return view->fresnel;
    return (double)panel_reference(frame, (float)REFLECTION_REFRACTIVE_INDEX, view->light,
                                   panel_turned_back(view->light, local));
}
