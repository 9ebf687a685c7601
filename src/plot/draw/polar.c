/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/polar.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/units.h"
#include "plot/draw/polar_lines.h"
#include "plot/draw/ticks.h"

/* ---- the colours ------------------------------------------------------------------------ */

static uint32_t pixel_of(const PolarMap *map, double value, uint32_t nothing)
{
    double srgb[3];
    if (!isfinite(value) || (map->is_log && !(value > 0))) return nothing;
    colour_map_at(map->map, polar_disc_position(map, value), srgb);
    uint32_t pixel = 0xff000000;
    for (int c = 0; c < 3; c++)
        pixel |= (uint32_t)(srgb[c] * 255 + 0.5) << (16 - 8 * c);
    return pixel;
}

/* Colours by table: 1024 of them are more than eight bits can resolve. */
typedef struct Palette {
    uint32_t colour[1024], nothing;
} Palette;

static void fill_palette(const PolarDisc *disc, Palette *palette)
{
    const PolarMap *map = disc->map;
    Ink grey = ink_mix(disc->canvas->theme.grid, disc->canvas->theme.faint, 0.25);
    palette->nothing = 0xff000000 | (uint32_t)(grey.red * 255) << 16 |
                       (uint32_t)(grey.green * 255) << 8 | (uint32_t)(grey.blue * 255);
    for (int i = 0; i < 1024; i++) {
        double t = i / 1023.0;
        double v = map->is_log ? map->low * pow(map->high / map->low, t)
                               : map->low + t * (map->high - map->low);
        palette->colour[i] = pixel_of(map, v, palette->nothing);
    }
}

static void paint_colours(const PolarDisc *disc)
{
    Canvas *canvas = disc->canvas;
    Palette palette;
    int side = (int)(2 * disc->radius * canvas->pixels_per_point + 0.5);
    side = side < 32 ? 32 : side > 1400 ? 1400 : side;
    cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, side, side);
    unsigned char   *bytes = cairo_image_surface_get_data(image);
    if (!bytes) return;
    fill_palette(disc, &palette);
    double scale = (disc->map->field->side - 1.0) / side;
    for (int row = 0; row < side; row++) {
        uint32_t *pixel = (uint32_t *)(void *)(bytes + row * cairo_image_surface_get_stride(
                                                              image));
        for (int column = 0; column < side; column++) {
            double v = field_at(disc->map->field, (column + 0.5) * scale, (row + 0.5) * scale);
            bool   ok = isfinite(v) && (!disc->map->is_log || v > 0);
            int    i = ok ? (int)(1023 * polar_disc_position(disc->map, v) + 0.5) : 0;
            pixel[column] = ok ? palette.colour[i] : palette.nothing;
        }
    }
    cairo_surface_mark_dirty(image);
    cairo_save(canvas->cr);
    cairo_translate(canvas->cr, disc->x - disc->radius, disc->y - disc->radius);
    cairo_scale(canvas->cr, 2 * disc->radius / side, 2 * disc->radius / side);
    cairo_set_source_surface(canvas->cr, image, 0, 0);
    cairo_paint(canvas->cr);
    cairo_restore(canvas->cr);
    cairo_surface_destroy(image);
}

/* ---- what was not measured -------------------------------------------------------------- */

static void hatch_outside(const PolarDisc *disc)
{
    double from = disc->map->theta_measured / disc->map->field->theta_rim * disc->radius;
    if (from >= disc->radius - 0.5) return;
    cairo_t *cr = disc->canvas->cr;
    cairo_save(cr);
    cairo_new_sub_path(cr);
    cairo_arc(cr, disc->x, disc->y, disc->radius, 0, 2 * PI);
    cairo_new_sub_path(cr);
    cairo_arc_negative(cr, disc->x, disc->y, from, 2 * PI, 0);
    cairo_clip(cr);
    canvas_hatch(disc->canvas, (Box){disc->x - disc->radius, disc->y - disc->radius,
                                     2 * disc->radius, 2 * disc->radius});
    cairo_restore(cr);
    cairo_new_sub_path(cr);
    cairo_arc(cr, disc->x, disc->y, from, 0, 2 * PI);
    canvas_stroke(disc->canvas, (Stroke){disc->canvas->theme.ink, 0.8, DASH_SHORT});
}

/* ---- angles ----------------------------------------------------------------------------- */

static double ring_step_deg(const PolarDisc *disc)
{
    double rim = degrees_from_radians(disc->map->field->theta_rim);
    return rim <= 30 ? 5 : rim <= 50 ? 10 : disc->radius < 45 ? 30 : 20;
}

static Ink ink_at(const PolarDisc *disc, double theta, double phi)
{
    double column, row;
    field_place(disc->map->field, theta, phi, &column, &row);
    double v = field_at(disc->map->field, column, row);
    return isfinite(v) ? polar_disc_ink(disc, v) : disc->canvas->theme.ink;
}

static void draw_rings(const PolarDisc *disc)
{
    double   rim = degrees_from_radians(disc->map->field->theta_rim);
    double   step = ring_step_deg(disc);
    cairo_t *cr = disc->canvas->cr;
    for (double deg = step; deg < rim - 1; deg += step) {
        double r = deg / rim * disc->radius;
        cairo_new_sub_path(cr);
        cairo_arc(cr, disc->x, disc->y, r, 0, 2 * PI);
        Ink ink = ink_at(disc, radians_from_degrees(deg), POLAR_RING_PHI);
        canvas_stroke(disc->canvas, (Stroke){ink_alpha(ink, 0.38), 0.6, DASH_DOT});
    }
    for (int deg = 0; deg < 180; deg += 45) {
        double a = radians_from_degrees(deg);
        cairo_move_to(cr, disc->x - disc->radius * cos(a), disc->y + disc->radius * sin(a));
        cairo_line_to(cr, disc->x + disc->radius * cos(a), disc->y - disc->radius * sin(a));
    }
    canvas_stroke(disc->canvas, (Stroke){ink_alpha(ink_hex(0x808890), 0.45), 0.5, DASH_NONE});
}

/* Written last but placed first, so that the numbers of lines keep clear of them. */
static void write_ring_labels(PolarDisc *disc, bool only_reserve)
{
    double rim = degrees_from_radians(disc->map->field->theta_rim);
    double step = ring_step_deg(disc), size = polar_disc_letter_size(disc);
    for (double deg = step; deg < rim - 1; deg += step) {
        double theta = radians_from_degrees(deg), r = deg / rim * disc->radius;
        double x = disc->x + r * cos(POLAR_RING_PHI), y = disc->y - r * sin(POLAR_RING_PHI);
        if (only_reserve) {
            polar_disc_reserve(disc, (Box){x - 10, y - 6, 20, 12});
            continue;
        }
        bool hatched = theta > disc->map->theta_measured;
        Ink  ink = hatched ? disc->canvas->theme.ink : ink_at(disc, theta, POLAR_RING_PHI);
        Ink  halo = hatched ? disc->canvas->theme.paper
                            : ink.red > 0.5 ? ink_hex(0x000000) : ink_hex(0xffffff);
        canvas_text(disc->canvas, x, y, (Letters){.size = size, .ink = ink, .across = 0.5,
                    .down = 0.5, .halo = ink_alpha(halo, hatched ? 0.75 : 0.22)},
                    arena_format(disc->canvas->arena, "%g°", deg));
    }
}

static void write_azimuths(const PolarDisc *disc)
{
    int step = disc->radius < 60 ? 90 : 45;
    for (int deg = 0; deg < 360; deg += step) {
        double a = radians_from_degrees(deg), r = disc->radius + 5;
        double x = disc->x + r * cos(a), y = disc->y - r * sin(a);
        canvas_text(disc->canvas, x, y,
                    (Letters){.size = SIZE_SMALL, .ink = disc->canvas->theme.soft,
                              .across = 0.5 - 0.5 * cos(a), .down = 0.5 + 0.5 * sin(a)},
                    arena_format(disc->canvas->arena, "%d°", deg));
    }
}

static void mark_light(const PolarDisc *disc)
{
    double   r = disc->map->theta_light / disc->map->field->theta_rim * disc->radius;
    cairo_t *cr = disc->canvas->cr;
    Ink      ink = ink_at(disc, disc->map->theta_light, PI);
    cairo_new_sub_path(cr);
    cairo_arc(cr, disc->x - r, disc->y, 4, 0, 2 * PI);
    canvas_stroke(disc->canvas, (Stroke){ink, 1.2, DASH_NONE});
    cairo_new_sub_path(cr);
    cairo_arc(cr, disc->x - r, disc->y, 1.4, 0, 2 * PI);
    canvas_fill(disc->canvas, ink);
    canvas_text(disc->canvas, disc->x - r, disc->y + 8,
                (Letters){.size = SIZE_SMALL, .ink = ink, .across = 0.5}, "light");
}

/* ---- the scale -------------------------------------------------------------------------- */

static Ticks scale_ticks(const PolarMap *map, double height)
{
    int most = (int)(height / 18);
    most = most < 3 ? 3 : most > 11 ? 11 : most;
    return map->is_log ? ticks_log(map->low, map->high, most)
                       : ticks_linear(map->low, map->high, most);
}

/* The colours from bottom to top, with arrows where values are cut. */
static void paint_ramp(const PolarDisc *disc, Box bar)
{
    Canvas *canvas = disc->canvas;
    Palette palette;
    fill_palette(disc, &palette);
    cairo_pattern_t *ramp = cairo_pattern_create_linear(0, bar.y + bar.h, 0, bar.y);
    for (int i = 0; i <= 64; i++) {
        uint32_t c = palette.colour[i * 1023 / 64];
        cairo_pattern_add_color_stop_rgb(ramp, i / 64.0, (c >> 16 & 255) / 255.0,
                                         (c >> 8 & 255) / 255.0, (c & 255) / 255.0);
    }
    cairo_rectangle(canvas->cr, bar.x, bar.y, bar.w, bar.h);
    cairo_set_source(canvas->cr, ramp);
    cairo_fill(canvas->cr);
    cairo_pattern_destroy(ramp);
    if (disc->map->is_cut) {
        uint32_t c = palette.colour[1023];
        cairo_move_to(canvas->cr, bar.x, bar.y);
        cairo_line_to(canvas->cr, bar.x + bar.w / 2, bar.y - 8);
        cairo_line_to(canvas->cr, bar.x + bar.w, bar.y);
        canvas_fill(canvas, ink_hex(c & 0xffffff));
        if (disc->map->map == MAP_SIGNED) {
            cairo_move_to(canvas->cr, bar.x, bar.y + bar.h);
            cairo_line_to(canvas->cr, bar.x + bar.w / 2, bar.y + bar.h + 8);
            cairo_line_to(canvas->cr, bar.x + bar.w, bar.y + bar.h);
            canvas_fill(canvas, ink_hex(palette.colour[0] & 0xffffff));
        }
    }
}

static void draw_scale_ticks(const PolarDisc *disc, Box bar)
{
    Canvas *canvas = disc->canvas;
    Ticks ticks = scale_ticks(disc->map, bar.h);
    for (int i = 0; i < ticks.count; i++) {
        char   text[32];
        double y = bar.y + bar.h * (1 - polar_disc_position(disc->map, ticks.value[i]));
        canvas_line(canvas, bar.x + bar.w, y, bar.x + bar.w + (ticks.is_labelled[i] ? 3.5 : 2),
                    y, (Stroke){canvas->theme.faint, 0.8, DASH_NONE});
        if (ticks.is_labelled[i])
            canvas_text(canvas, bar.x + bar.w + 6, y,
                        (Letters){.size = SIZE_TICK, .ink = canvas->theme.soft, .down = 0.5},
                        tick_text(ticks.value[i], ticks.step, text));
    }
}

static void draw_scale(const PolarDisc *disc, Box bar)
{
    Canvas *canvas = disc->canvas;
    paint_ramp(disc, bar);
    draw_scale_ticks(disc, bar);
    for (int i = 0; i < disc->map->level_count; i++) { /* the lines of the map, on the scale */
        double t = polar_disc_position(disc->map, disc->map->level[i]);
        double y = bar.y + bar.h * (1 - t);
        if (!(t > 0 && t < 1)) continue;
        canvas_line(canvas, bar.x, y, bar.x + bar.w, y,
                    (Stroke){ink_alpha(polar_disc_ink(disc, disc->map->level[i]), 0.75), 0.7,
                             DASH_NONE});
    }
    canvas_text(canvas, bar.x, bar.y - (disc->map->is_cut ? 14 : 8),
                (Letters){.size = SIZE_TICK, .ink = canvas->theme.ink, .down = 1},
                disc->map->unit);
}

/* ---- the whole -------------------------------------------------------------------------- */

#define SCALE_WIDTH 62.0
#define LABEL_ROOM 26.0

static void clip_to_disc(const PolarDisc *disc)
{
    cairo_save(disc->canvas->cr);
    cairo_new_sub_path(disc->canvas->cr);
    cairo_arc(disc->canvas->cr, disc->x, disc->y, disc->radius, 0, 2 * PI);
    cairo_clip(disc->canvas->cr);
}

/* A narrow rim that was not measured has no room for lines; a wide one shows them dimmed. */
static void draw_lines_inside(PolarDisc *disc)
{
    double   share = disc->map->theta_measured / disc->map->field->theta_rim;
    cairo_t *cr = disc->canvas->cr;
    cairo_save(cr);
    cairo_new_sub_path(cr);
    cairo_arc(cr, disc->x, disc->y, disc->radius * (share < 1 && share > 0.88 ? share : 1), 0,
              2 * PI);
    cairo_clip(cr);
    polar_lines_draw(disc);
    cairo_restore(cr);
}

PolarPlace polar_draw(Canvas *canvas, Box box, const PolarMap *asked)
{
    PolarMap  with_extent = *asked; /* data without any spread still get a scale */
    PolarMap *map = &with_extent;
    if (map->is_log && !(map->high > 0)) map->high = 1;
    if (map->is_log && !(map->low > 0 && map->low < map->high)) map->low = map->high / 10;
    if (!map->is_log && !(map->high > map->low)) map->high = map->low + 1;
    double    across = box.w - SCALE_WIDTH - 2 * LABEL_ROOM - 6, down = box.h - 34;
    double    radius = fmin(across, down) / 2;
    PolarDisc disc = {.canvas = canvas, .map = map, .radius = radius, .y = box.y + box.h / 2};
    double    whole = 2 * radius + 2 * LABEL_ROOM + 6 + SCALE_WIDTH;
    disc.x = box.x + (box.w - whole) / 2 + LABEL_ROOM + radius;
    write_ring_labels(&disc, true);
    clip_to_disc(&disc);
    paint_colours(&disc);
    draw_rings(&disc);
    cairo_restore(canvas->cr);
    if (!map->is_residual) draw_lines_inside(&disc);
    hatch_outside(&disc);
    write_ring_labels(&disc, false);
    if (map->has_light) mark_light(&disc);
    cairo_new_sub_path(canvas->cr);
    cairo_arc(canvas->cr, disc.x, disc.y, radius, 0, 2 * PI);
    canvas_stroke(canvas, (Stroke){canvas->theme.faint, 0.9, DASH_NONE});
    write_azimuths(&disc);
    double height = fmin(1.55 * radius, 2 * radius - 20);
    draw_scale(&disc, (Box){disc.x + radius + LABEL_ROOM + 6, disc.y - height / 2 + 6, 10,
                            height});
    return (PolarPlace){disc.x, disc.y, radius};
}
