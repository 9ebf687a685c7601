#include "panel/query/panel_emission.h"
#include "path/path_features.h"

#include "base/units.h"
#include "spectrum/photometry.h"

/* Reflectance under D65 as linear Rec.709: the mean over paths is exact. */
static void albedo_rgb(Spectrum albedo, const Wavelengths *wavelengths, float rgb[3])
{
    float xyz[3] = {0};
    spectrum_add_xyz(wavelengths, albedo * wavelengths->d65, xyz);
    rgb_from_xyz(xyz, rgb);
}

static void scaled_emission(const Display *display, Vec3 direction, const float codes[3],
                            float xyz[3])
{
    panel_emission_xyz(display->panel, direction, codes, xyz);
    for (int i = 0; i < 3; i++) xyz[i] *= display->level;
}

static void display_features(const Scene *scene, const Display *display, uint32_t triangle,
                             const Surface *surface, Vec3 wo, PathFeatures *out)
{
    static const float white[3] = {255, 255, 255}, black[3] = {0, 0, 0};
    Frame frame = display_frame(scene, display, triangle, &surface->point);
    Vec3  local = frame_to_local(&frame, wo);
    float phi = atan2_f(local.y, local.x);
    display_emission_xyz(scene, display, triangle, &surface->point, wo, out->emitted);
    scaled_emission(display, local, white, out->white);
    scaled_emission(display, local, black, out->black);
    out->theta = acos_f(local.z);
    out->phi = phi < 0 ? phi + 2 * PI_F : phi;
}

bool path_display_emission(const PathContext *context, const PathResult *result,
                           const Wavelengths *wavelengths, float xyz[3])
{
    const Scene *scene = context->scene;
    Surface surface;
    Vec3    wo = vec3_neg(result->direction);
    surface_at(scene, context->tables, &result->first, wo, wavelengths, &surface);
    int display_id = scene->materials[surface.material_id].display_id;
    if (display_id == NO_ID || !surface.emits) return false;
    display_emission_xyz(scene, &scene->displays[display_id], result->first.triangle,
                         &surface.point, wo, xyz);
    return true;
}

void path_features(const PathContext *context, const PathResult *result,
                   const Wavelengths *wavelengths, PathFeatures *out)
{
    const Scene *scene = context->scene;
    Surface surface;
    Vec3    wo = vec3_neg(result->direction);
    surface_at(scene, context->tables, &result->first, wo, wavelengths, &surface);
    *out = (PathFeatures){.depth = result->first.t, .position = surface.position,
                          .normal = surface.frame.z, .part_id = surface.part_id,
                          .uv = {surface.point.uv[0].x, surface.point.uv[0].y},
                          .display_id = NO_ID};
    albedo_rgb(bsdf_albedo(&surface.bsdf, frame_to_local(&surface.frame, wo)), wavelengths,
               out->albedo);
    int display_id = scene->materials[surface.material_id].display_id;
    if (display_id == NO_ID || !surface.emits) return;
    out->display_id = display_id;
    display_features(scene, &scene->displays[display_id], result->first.triangle, &surface, wo,
                     out);
}
