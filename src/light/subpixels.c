/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: sub-pixels. No allocation, no lock, no libm. */
#include "light/subpixels.h"

/* Where a point lies: a pixel by its number (whole), and the part of the way through it. */
typedef struct PixelPlace {
    float pixel[2], part[2];
} PixelPlace;

/* One open area: its primary, by how much its light is denser than the mean over the pixel, and
 * the pixels, one or two in a row, whose mean it shows. */
typedef struct Opening {
    int   primary; /* 0..2; -1: the point lies between the sub-pixels */
    float gain;
    float pixel[2][2];
    int   pixels;
} Opening;

/* Floor without libm, for any number: those too large to have a fraction are whole. */
static float whole_below(float x)
{
    if (!(fabsf(x) < 0x1p23f)) return x;
    float cut = (float)(int)x;
    return cut > x ? cut - 1 : cut;
}

static bool is_odd(float whole)
{
    return whole - 2 * whole_below(0.5f * whole) > 0.5f;
}

static PixelPlace pixel_place(const CloseView *view)
{
    Vec2       uv = slot_uv(&view->display->content, view->point);
    float      at[2] = {uv.x + view->beside.x, uv.y + view->beside.y};
    PixelPlace out;
    for (int k = 0; k < 2; k++) {
        float x = at[k] * (float)view->display->subpixels->pixels[k];
        out.pixel[k] = whole_below(x);
        out.part[k] = x - out.pixel[k];
    }
    return out;
}

/* ---- layouts ----------------------------------------------------------------------------- */

static Opening stripe_at(const PixelPlace *at, float fill)
{
    int   primary = at->part[0] < 1 / 3.0f ? 0 : at->part[0] < 2 / 3.0f ? 1 : 2;
    float side = 0.5f * sqrtf(fill), across = 3 * at->part[0] - (float)primary - 0.5f;
    bool  is_open = fabsf(across) <= side && fabsf(at->part[1] - 0.5f) <= side;
    return (Opening){.primary = is_open ? primary : -1, .gain = 3 / fill, .pixels = 1,
                     .pixel = {{at->pixel[0], at->pixel[1]}}};
}

/* The diamond whose middle is nearest. */
static Opening pentile_at(const PixelPlace *at, float fill)
{
    float half = 0.5f * sqrtf(fill), pixel[2], x[2];
    float least = 0;
    int   nearest = 0;
    for (int kind = 0; kind < 2; kind++) { /* 0: green, 1: red or blue */
        float middle = kind ? 0.75f : 0.25f, off = 0;
        for (int k = 0; k < 2; k++) {
            float shift = whole_below(at->part[k] - middle + 0.5f);
            x[k] = at->pixel[k] + shift;
            off += fabsf(at->part[k] - middle - shift);
        }
        if (kind && !(off < least)) continue;
        least = off;
        nearest = kind;
        for (int k = 0; k < 2; k++) pixel[k] = x[k];
    }
    Opening out = {.primary = least <= half ? 1 : -1, .gain = 2 / fill, .pixels = 1,
                   .pixel = {{pixel[0], pixel[1]}, {pixel[0], pixel[1]}}};
    if (!nearest || out.primary < 0) return out;
    out.primary = is_odd(pixel[0] + pixel[1]) ? 2 : 0;
    out.gain = 4 / fill;
    out.pixels = 2;
    out.pixel[1][0] += is_odd(pixel[0]) ? -1.0f : 1.0f;
    return out;
}

/* ---- what counts ------------------------------------------------------------------------- */

/* How long the content's U and V are in the triangle's plane, m; false: they span no area. */
static bool content_lengths(const CloseView *view, float length[2])
{
    const Scene *scene = view->scene;
    Vec2 uv[3];
    for (int i = 0; i < 3; i++)
        uv[i] = slot_corner_uv(scene, &view->display->content, view->triangle, i);
    Vec3  p = scene_corner(scene, view->triangle, 0);
    Vec3  e1 = vec3_sub(scene_corner(scene, view->triangle, 1), p);
    Vec3  e2 = vec3_sub(scene_corner(scene, view->triangle, 2), p);
    float du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    float du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    float det = fabsf(du1 * dv2 - du2 * dv1);
    length[0] = vec3_length(vec3_along(vec3_scale(e1, dv2), e2, -dv1)) / det;
    length[1] = vec3_length(vec3_along(vec3_scale(e2, du1), e1, -du2)) / det;
    return det > 0;
}

/* Display pixels from one frame pixel to the next along axis k of the display: what lies across
 * the ray is moved along it to the surface. */
static float pixels_covered(const CloseView *view, const float length[2], int k)
{
    float slope = (k ? view->local.y : view->local.x) / view->local.z, squares = 0;
    for (int i = 0; i < 2; i++) {
        Vec3  across = view->across[i];
        float moved = (k ? across.y : across.x) - slope * across.z;
        squares += moved * moved;
    }
    return sqrtf(squares) * (float)view->display->subpixels->pixels[k] / length[k];
}

/* How much of the light is even: by the display pixels that a frame's pixel covers along the
 * rows or the columns, whichever are more. */
static float even_share(const CloseView *view)
{
    float length[2];
    if (!(view->local.z > 0) || !content_lengths(view, length)) return 1;
    float columns = pixels_covered(view, length, 0), rows = pixels_covered(view, length, 1);
    if (!(columns + rows > 0)) return 1; /* NaN too */
    float share =
        (fmaxf(columns, rows) - SUBPIXELS_WHOLE) / (SUBPIXELS_GONE - SUBPIXELS_WHOLE);
    return share < 1 ? fmaxf(share, 0) : 1;
}

static float *add_term(SubpixelMix *mix, float weight)
{
    float *codes = mix->codes[mix->count];
    codes[0] = codes[1] = codes[2] = 0;
    mix->weight[mix->count++] = weight;
    return codes;
}

/* The code of a primary that a pixel shows: that of the content in its middle. */
static float code_of_pixel(const CloseView *view, const float pixel[2], int primary)
{
    const TextureSlot *slot = &view->display->content;
    const int         *pixels = view->display->subpixels->pixels;
    float codes[3];
    if (slot->texture_id == NO_ID) return 255;
    texture_codes(&view->scene->textures[slot->texture_id],
                  (pixel[0] + 0.5f) / (float)pixels[0], (pixel[1] + 0.5f) / (float)pixels[1],
                  codes);
    return codes[primary];
}

/* Adds black, and `gain` times what a primary adds to it. */
static void add_opening(const CloseView *view, float share, SubpixelMix *out)
{
    const Subpixels *subpixels = view->display->subpixels;
    PixelPlace       at = pixel_place(view);
    Opening opening = subpixels->layout == SUBPIXELS_STRIPE ? stripe_at(&at, subpixels->fill)
                                                           : pentile_at(&at, subpixels->fill);
    float lit = opening.primary < 0 ? 0 : share * opening.gain;
    add_term(out, share - lit);
    for (int i = 0; lit > 0 && i < opening.pixels; i++)
        add_term(out, lit / (float)opening.pixels)[opening.primary] =
            code_of_pixel(view, opening.pixel[i], opening.primary);
}

void subpixels_seen(const CloseView *view, SubpixelMix *out)
{
    float even = even_share(view);
    out->count = 0;
    if (even > 0)
        display_codes(view->scene, view->display, view->point, add_term(out, even));
    if (even < 1) add_opening(view, 1 - even, out);
}

void subpixels_xyz(const CloseView *view, float xyz[3])
{
    SubpixelMix mix;
    subpixels_seen(view, &mix);
    for (int j = 0; j < 3; j++) xyz[j] = 0;
    for (int i = 0; i < mix.count; i++) {
        float one[3];
        display_panel_xyz(view->display, view->point, view->local, mix.codes[i], one);
        for (int j = 0; j < 3; j++) xyz[j] += mix.weight[i] * one[j];
    }
    for (int j = 0; j < 3; j++) xyz[j] = fmaxf(xyz[j], 0) * view->display->level;
}

Spectrum subpixels_spectrum(const CloseView *view, const Wavelengths *wavelengths)
{
    SubpixelMix mix;
    Spectrum    sum = spectrum_all(0);
    subpixels_seen(view, &mix);
    for (int i = 0; i < mix.count && i < SUBPIXEL_TERMS; i++) /* gcc 14 sees one bound */
        sum += display_panel_spectrum(view->display, view->point, view->local, mix.codes[i],
                                      wavelengths) *
               spectrum_all(mix.weight[i]);
    return spectrum_max(sum, spectrum_all(0)) * spectrum_all(view->display->level);
}
