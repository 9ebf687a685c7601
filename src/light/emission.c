/* SPDX-License-Identifier: Apache-2.0 */
#include "light/emission.h"

#include "base/mathf.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_place.h"
#include "panel/zones/backlight_at.h"
#include "scene/point/coverage.h"
#include "spectrum/fresnel.h"
#include "spectrum/photometry.h"

#include "base/units.h"

void display_codes(const Scene *scene, const Display *display, const TrianglePoint *point,
                   float codes[3]) {
    codes[0] = codes[1] = codes[2] = 255;
    if (display->content.texture_id == NO_ID) return;
    Vec2 uv = slot_uv(&display->content, point);
    texture_codes(&scene->textures[display->content.texture_id], uv.x, uv.y, codes);
}

/* KHR_materials_unlit: base colour, its texture and the vertices' colour, multiplied. */
void emitted_rgb(const Scene *scene, uint32_t triangle, const TrianglePoint *point, float rgb[3]) {
    const Material *material = &scene->materials[scene_part(scene, triangle)->material_id];
    float texel[4];
    const float *factor = material->unlit ? material->base_color : material->emissive_cd_m2;
    const TextureSlot *slot =
        material->unlit ? &material->base_color_texture : &material->emissive_texture;
    for (int i = 0; i < 3; i++) rgb[i] = factor[i];
    if (slot->texture_id != NO_ID) {
        Vec2 uv = slot_uv(slot, point);
        texture_colour(&scene->textures[slot->texture_id], uv.x, uv.y, texel);
        for (int i = 0; i < 3; i++) rgb[i] *= texel[i];
    }
    if (!material->unlit || !vertex_color(scene, triangle, point, texel)) return;
    for (int i = 0; i < 3; i++) rgb[i] *= texel[i];
}

void display_full_xyz(const Display *display, const TrianglePoint *point, Vec3 local,
                      const float codes[3], float xyz[3]) {
    float place[2];
    if (!panel_varies(display->panel)) {
        panel_emission_xyz(display->panel, local, codes, xyz);
        return;
    }
    display_place(display, point, place);
    panel_place_emission_xyz(display->panel, place, local, codes, xyz);
}

Spectrum display_full_spectrum(const Display *display, const TrianglePoint *point, Vec3 local,
                               const float codes[3], const Wavelengths *wavelengths) {
    float place[2];
    if (!panel_varies(display->panel))
        return panel_emission_spectrum(display->panel, local, codes, wavelengths);
    display_place(display, point, place);
    return panel_place_emission_spectrum(display->panel, place, local, codes, wavelengths);
}

/* The backlight there, and the codes that pixels get. */
static float dimmed(const Display *display, const TrianglePoint *point, const float codes[3],
                    float driven[3]) {
    float place[2];
    display_place(display, point, place);
    float b = backlight_at(display->backlight, place);
    backlight_codes(display->backlight, b, codes, driven);
    return b;
}

void display_panel_xyz(const Display *display, const TrianglePoint *point, Vec3 local,
                       const float codes[3], float xyz[3]) {
    float driven[3];
    if (!display->backlight) {
        display_full_xyz(display, point, local, codes, xyz);
        return;
    }
    float b = dimmed(display, point, codes, driven);
    display_full_xyz(display, point, local, driven, xyz);
    for (int i = 0; i < 3; i++) xyz[i] *= b;
}

Spectrum display_panel_spectrum(const Display *display, const TrianglePoint *point, Vec3 local,
                                const float codes[3], const Wavelengths *wavelengths) {
    float driven[3];
    if (!display->backlight)
        return display_full_spectrum(display, point, local, codes, wavelengths);
    float b = dimmed(display, point, codes, driven);
    return display_full_spectrum(display, point, local, driven, wavelengths) * spectrum_all(b);
}

bool display_is_measured(const Display *display, const TrianglePoint *point, Vec3 local) {
    float place[2];
    display_place(display, point, place);
    return panel_place_emission_is_measured(display->panel, place, local);
}

void display_emission_xyz(const Scene *scene, const Display *display, uint32_t triangle,
                          const TrianglePoint *point, Vec3 direction, float xyz[3]) {
    float codes[3];
    Frame frame = display_frame(scene, display, triangle, point);
    display_codes(scene, display, point, codes);
    display_panel_xyz(display, point, frame_to_local(&frame, direction), codes, xyz);
    for (int i = 0; i < 3; i++) xyz[i] *= display->level;
}

static Spectrum display_emission(const Scene *scene, const Display *display, uint32_t triangle,
                                 const TrianglePoint *point, Vec3 direction,
                                 const Wavelengths *wavelengths) {
    float codes[3];
    Frame frame = display_frame(scene, display, triangle, point);
    display_codes(scene, display, point, codes);
    return display_panel_spectrum(display, point, frame_to_local(&frame, direction), codes,
                                  wavelengths) *
           spectrum_all(display->level);
}

/* A measured spectrum is stored with a luminance of 1 cd m^-2; the colour gives how much. */
static Spectrum material_emission(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                                  const Wavelengths *wavelengths) {
    const Material *material = &scene->materials[scene_part(scene, triangle)->material_id];
    float rgb[3];
    emitted_rgb(scene, triangle, point, rgb);
    if (material->emission_curve_id == NO_ID) return spectrum_from_rgb_emission(wavelengths, rgb);
    float luminance = luminance_from_rgb(rgb);
    return curve_lookup(&scene->curves[material->emission_curve_id], wavelengths) *
           spectrum_all(luminance);
}

/* Share of the light from below that the coat lets out. */
static float coat_lets_out(const Scene *scene, const Material *m, uint32_t triangle,
                           const TrianglePoint *point, Vec3 direction) {
    float coat = m->clearcoat, texel[4];
    if (!material_shows_coat(m)) return 1;
    if (m->clearcoat_texture.texture_id != NO_ID) {
        Vec2 uv = slot_uv(&m->clearcoat_texture, point);
        texture_data(&scene->textures[m->clearcoat_texture.texture_id], uv.x, uv.y, texel);
        coat *= texel[0];
    }
    float cosine = fabsf(vec3_dot(coat_normal(scene, m, triangle, point), direction));
    return 1 - coat * fresnel_unpolarised(min_f(cosine, 1), CLEARCOAT_IOR);
}

bool triangle_emits_to(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                       Vec3 direction) {
    const Material *material = &scene->materials[scene_part(scene, triangle)->material_id];
    bool front = vec3_dot(point->ng, direction) > 0;
    bool back_is_dark = material->display_id != NO_ID || !material->double_sided;
    return material->is_emitter && (front || !back_is_dark);
}

bool triangle_polarisation(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                           Vec3 direction, Vec3 *axis, float *degree) {
    int display_id = scene->materials[scene_part(scene, triangle)->material_id].display_id;
    if (display_id == NO_ID) return false;
    const Display *display = &scene->displays[display_id];
    PanelPolarisation light = panel_polarisation(display->panel);
    if (!(light.degree > 0)) return false;
    float sine, cosine;
    sincos_turns(light.azimuth * (0.5f * INV_PI_F), &sine, &cosine);
    Frame frame = display_frame(scene, display, triangle, point);
    Vec3 absorbs = frame_to_world(&frame, vec3(-sine, cosine, 0));
    Vec3 lets = vec3_cross(absorbs, direction);
    if (!(vec3_dot(lets, lets) > 1e-12f)) return false;
    *axis = vec3_normalize(lets);
    *degree = light.degree;
    return true;
}

Spectrum triangle_emission(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                           Vec3 direction, const Wavelengths *wavelengths) {
    const Material *material = &scene->materials[scene_part(scene, triangle)->material_id];
    if (!triangle_emits_to(scene, triangle, point, direction)) return spectrum_all(0);
    if (material->display_id != NO_ID)
        return display_emission(scene, &scene->displays[material->display_id], triangle, point,
                                direction, wavelengths);
    return material_emission(scene, triangle, point, wavelengths) *
           spectrum_all(coat_lets_out(scene, material, triangle, point, direction));
}
