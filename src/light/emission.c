#include "light/emission.h"

#include "panel/query/panel_emission.h"
#include "spectrum/photometry.h"

#include "base/units.h"

static Vec3 vertex_position(const Scene *scene, const Triangle *t, int corner)
{
    const float *p = scene->vertices[t->vertex[corner]].position;
    return vec3(p[0], p[1], p[2]);
}

static Vec3 interpolate(const float *a, const float *b, const float *c, float u, float v)
{
    float w = 1 - u - v;
    return vec3(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1],
                w * a[2] + u * b[2] + v * c[2]);
}

TrianglePoint triangle_point(const Scene *scene, uint32_t triangle, float u, float v)
{
    const Triangle *t = &scene->triangles[triangle];
    const Vertex *a = &scene->vertices[t->vertex[0]], *b = &scene->vertices[t->vertex[1]],
                 *c = &scene->vertices[t->vertex[2]];
    TrianglePoint point;
    point.position = interpolate(a->position, b->position, c->position, u, v);
    Vec3 origin = vertex_position(scene, t, 0);
    point.ng = vec3_normalize(vec3_cross(vec3_sub(vertex_position(scene, t, 1), origin),
                                         vec3_sub(vertex_position(scene, t, 2), origin)));
    point.ns = vec3_normalize(interpolate(a->normal, b->normal, c->normal, u, v));
    if (!(vec3_dot(point.ns, point.ns) > 0.5f)) point.ns = point.ng;
    for (int set = 0; set < SCENE_UV_SETS; set++)
        for (int i = 0; i < 2; i++)
            point.uv[set][i] =
                (1 - u - v) * a->uv[set][i] + u * b->uv[set][i] + v * c->uv[set][i];
    return point;
}

Vec2 slot_uv(const TextureSlot *slot, const float uv[][2])
{
    const float *m = slot->uv_from_uv, *p = uv[slot->uv_set];
    return (Vec2){m[0] * p[0] + m[1] * p[1] + m[2], m[3] * p[0] + m[4] * p[1] + m[5]};
}

/* The direction in the triangle's plane in which the slot's u grows: with edges e1, e2 and the
 * differences (du1, dv1), (du2, dv2) along them, dP/du ~ (dv2 e1 - dv1 e2) / det. */
static Vec3 direction_of_u(const Scene *scene, const TextureSlot *slot, uint32_t triangle)
{
    const Triangle *t = &scene->triangles[triangle];
    Vec2 uv[3];
    Vec3 p[3];
    for (int i = 0; i < 3; i++) {
        uv[i] = slot_uv(slot, (const float(*)[2])scene->vertices[t->vertex[i]].uv);
        p[i] = vertex_position(scene, t, i);
    }
    float du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    float du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    float det = du1 * dv2 - du2 * dv1;
    Vec3  along = vec3_sub(vec3_scale(vec3_sub(p[1], p[0]), dv2),
                           vec3_scale(vec3_sub(p[2], p[0]), dv1));
    return det < 0 ? vec3_neg(along) : along;
}

Frame display_frame(const Scene *scene, const Display *display, uint32_t triangle,
                    const TrianglePoint *point)
{
    Vec3 n = vec3_dot(point->ns, point->ng) < 0 ? vec3_neg(point->ns) : point->ns;
    Vec3 right = direction_of_u(scene, &display->content, triangle);
    right = vec3_normalize(vec3_along(right, n, -vec3_dot(right, n)));
    if (!(vec3_dot(right, right) > 0.5f)) return frame_from_z(n);
    return (Frame){right, vec3_cross(n, right), n};
}

void display_codes(const Scene *scene, const Display *display, const TrianglePoint *point,
                   float codes[3])
{
    codes[0] = codes[1] = codes[2] = 255;
    if (display->content.texture_id == NO_ID) return;
    Vec2 uv = slot_uv(&display->content, point->uv);
    texture_codes(&scene->textures[display->content.texture_id], uv.x, uv.y, codes);
}

void emitted_rgb(const Scene *scene, const Material *material, const TrianglePoint *point,
                 float rgb[3])
{
    const float *factor = material->unlit ? material->base_color : material->emissive_cd_m2;
    const TextureSlot *slot =
        material->unlit ? &material->base_color_texture : &material->emissive_texture;
    for (int i = 0; i < 3; i++) rgb[i] = factor[i];
    if (slot->texture_id == NO_ID) return;
    float texel[4];
    Vec2  uv = slot_uv(slot, point->uv);
    texture_colour(&scene->textures[slot->texture_id], uv.x, uv.y, texel);
    for (int i = 0; i < 3; i++) rgb[i] *= texel[i];
}

void display_emission_xyz(const Scene *scene, const Display *display, uint32_t triangle,
                          const TrianglePoint *point, Vec3 direction, float xyz[3])
{
    float codes[3];
    Frame frame = display_frame(scene, display, triangle, point);
    display_codes(scene, display, point, codes);
    panel_emission_xyz(display->panel, frame_to_local(&frame, direction), codes, xyz);
    for (int i = 0; i < 3; i++) xyz[i] *= display->level;
}

static Spectrum display_emission(const Scene *scene, const Display *display, uint32_t triangle,
                                 const TrianglePoint *point, Vec3 direction,
                                 const Wavelengths *wavelengths)
{
    float codes[3];
    Frame frame = display_frame(scene, display, triangle, point);
    display_codes(scene, display, point, codes);
    return panel_emission_spectrum(display->panel, frame_to_local(&frame, direction), codes,
                                   wavelengths) *
           spectrum_all(display->level);
}

/* A measured spectrum is stored with a luminance of 1 cd m^-2; the colour gives how much. */
static Spectrum material_emission(const Scene *scene, const Material *material,
                                  const TrianglePoint *point, const Wavelengths *wavelengths)
{
    float rgb[3];
    emitted_rgb(scene, material, point, rgb);
    if (material->emission_curve_id == NO_ID)
        return spectrum_from_rgb_emission(wavelengths, rgb);
    float luminance = luminance_from_rgb(rgb);
    return curve_lookup(&scene->curves[material->emission_curve_id], wavelengths) *
           spectrum_all(luminance);
}

bool triangle_emits_to(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                       Vec3 direction)
{
    const Material *material =
        &scene->materials[scene->parts[scene->triangles[triangle].part_id].material_id];
    bool front = vec3_dot(point->ng, direction) > 0;
    bool back_is_dark = material->display_id != NO_ID || !material->double_sided;
    return material->is_emitter && (front || !back_is_dark);
}

Spectrum triangle_emission(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                           Vec3 direction, const Wavelengths *wavelengths)
{
    const Material *material =
        &scene->materials[scene->parts[scene->triangles[triangle].part_id].material_id];
    if (!triangle_emits_to(scene, triangle, point, direction)) return spectrum_all(0);
    if (material->display_id != NO_ID)
        return display_emission(scene, &scene->displays[material->display_id], triangle, point,
                                direction, wavelengths);
    return material_emission(scene, material, point, wavelengths);
}
