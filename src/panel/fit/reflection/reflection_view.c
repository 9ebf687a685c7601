/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_view.h"

#include "panel/query/panel_reference.h"
#include "panel/query/panel_turn.h"

Vec3 reflection_view_from_local(Vec3 light, Vec3 local)
{
    return panel_turned_back(light, local);
}

Vec3 reflection_view_to_local(Vec3 light, Vec3 towards)
{
    return panel_turned(light, towards);
}

ReflectionView reflection_view(const ReflectionModel *model, int table)
{
    double theta = reflection_model_incidence(model, table);
    return (ReflectionView){&model->surface, specular_frame((float)theta, model->k),
                            reflection_model_light(model->set, table),
                            reflection_model_fresnel(model, table)};
}

Vec3 reflection_view_stored(const ReflectionView *view, Vec3 local)
{
    if (view->surface->stored.frame == PANEL_FRAME_SPECULAR)
        return specular_frame_stored(&view->specular, local);
    return surface_frame_stored(&view->surface->frame, view->light,
                                panel_turned_back(view->light, local));
}

Vec3 reflection_view_local(const ReflectionView *view, Vec3 stored)
{
    if (view->surface->stored.frame == PANEL_FRAME_SPECULAR)
        return specular_frame_outer(&view->specular, stored);
    return panel_turned(view->light,
                        surface_frame_leaving(&view->surface->frame, view->light, stored));
}

double reflection_view_reference(const ReflectionView *view, Vec3 local)
{
    PanelFrameKind frame = (PanelFrameKind)view->surface->stored.frame;
    if (frame == PANEL_FRAME_SPECULAR) return view->fresnel;
    return (double)panel_reference(frame, (float)REFLECTION_REFRACTIVE_INDEX, view->light,
                                   panel_turned_back(view->light, local));
}
