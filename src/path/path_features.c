/* SPDX-License-Identifier: Apache-2.0 */
#include "path/path_features.h"

#include "base/units.h"
#include "light/emission.h"
#include "spectrum/photometry.h"

/* Reflectance under D65 as linear Rec.709: the mean over paths is exact. */
static void albedo_rgb(Spectrum albedo, const Wavelengths *wavelengths, float rgb[3]) {
    float xyz[3] = {0};
    spectrum_add_xyz(wavelengths, albedo * wavelengths->d65, xyz);
    rgb_from_xyz(xyz, rgb);
}

/* A display as a path meets it. */
typedef struct SeenDisplay {
    const Display *display;
    const TrianglePoint *point;
    Vec3 direction; /* to the eye, in the display's frame */
    const PathResult *path;
    const Wavelengths *wavelengths;
} SeenDisplay;

static SeenDisplay view_of(const PathContext *context, const PathResult *path,
                           const Surface *surface, const Wavelengths *wavelengths) {
    const Scene *scene = context->scene;
    const Display *display = &scene->displays[scene->materials[surface->material_id].display_id];
    Frame frame = display_frame(scene, display, path->first.triangle, &surface->point);
    return (SeenDisplay){display, &surface->point,
                         frame_to_local(&frame, vec3_neg(path->direction)), path, wavelengths};
}

/* XYZ that it sends to the eye for these codes: the same sum that the path adds. is_full: with
 * the backlight full, whatever is shown. */
static void emission_seen(const SeenDisplay *view, bool is_full, const float codes[3],
                          float xyz[3]) {
    const Display *display = view->display;
    Spectrum through = view->path->through;
    if (view->path->through_is_grey) {
        (is_full ? display_full_xyz : display_panel_xyz)(display, view->point, view->direction,
                                                         codes, xyz);
        for (int i = 0; i < 3; i++) xyz[i] = spectrum_mean(through) * (xyz[i] * display->level);
        return;
    }
    Spectrum sent = (is_full ? display_full_spectrum : display_panel_spectrum)(
                        display, view->point, view->direction, codes, view->wavelengths) *
                    spectrum_all(display->level);
    for (int i = 0; i < 3; i++) xyz[i] = 0;
    spectrum_add_xyz(view->wavelengths, through * sent, xyz);
}

static void content_seen(const PathContext *context, const SeenDisplay *view,
                         const Surface *surface, float xyz[3]) {
    float codes[3];
    display_codes(context->scene, view->display, &surface->point, codes);
    emission_seen(view, false, codes, xyz);
}

static void display_features(const PathContext *context, const SeenDisplay *view,
                             const Surface *surface, PathFeatures *out) {
    static const float white[3] = {255, 255, 255}, black[3] = {0, 0, 0};
    float phi = atan2_f(view->direction.y, view->direction.x);
    content_seen(context, view, surface, out->emitted);
    emission_seen(view, true, white, out->white);
    emission_seen(view, false, black, out->black);
    out->theta = acos_f(view->direction.z);
    out->phi = phi < 0 ? phi + 2 * PI_F : phi;
    out->is_measured = display_is_measured(view->display, view->point, view->direction);
}

bool path_display_emission(const PathContext *context, const PathResult *result,
                           const Wavelengths *wavelengths, float xyz[3]) {
    Surface surface;
    Vec3 wo = vec3_neg(result->direction);
    surface_at(context->scene, context->tables, &result->first, wo, wavelengths, &surface);
    if (!surface_is_display(context->scene, &surface) || !surface.emits) return false;
    SeenDisplay view = view_of(context, result, &surface, wavelengths);
    content_seen(context, &view, &surface, xyz);
    return true;
}

/* Of a surface that is no display: the same product that the path adds. */
static void source_seen(const PathContext *context, const PathResult *result,
                        const Surface *surface, const Wavelengths *wavelengths, float xyz[3]) {
    Spectrum sent = triangle_emission(context->scene, result->first.triangle, &surface->point,
                                      vec3_neg(result->direction), wavelengths);
    spectrum_add_xyz(wavelengths, result->through * sent, xyz);
}

void path_features(const PathContext *context, const PathResult *result,
                   const Wavelengths *wavelengths, PathFeatures *out) {
    Surface surface;
    Vec3 wo = vec3_neg(result->direction);
    surface_at(context->scene, context->tables, &result->first, wo, wavelengths, &surface);
    *out = (PathFeatures){.depth = result->first.t,
                          .position = surface.position,
                          .normal = surface.frame.z,
                          .part_id = surface.part_id,
                          .uv = {surface.point.uv[0].x, surface.point.uv[0].y},
                          .display_id = NO_ID};
    albedo_rgb(bsdf_albedo(&surface.bsdf, surface.local_wo), wavelengths, out->albedo);
    if (!surface.emits) return;
    if (!surface_is_display(context->scene, &surface)) {
        source_seen(context, result, &surface, wavelengths, out->sources);
        return;
    }
    SeenDisplay view = view_of(context, result, &surface, wavelengths);
    out->display_id = context->scene->materials[surface.material_id].display_id;
    display_features(context, &view, &surface, out);
}
