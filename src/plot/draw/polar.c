/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/polar.h"

#include <math.h>
#include <stdint.h>

#include "base/units.h"
#include "plot/draw/ticks.h"

#define RING_PHI (-1.1780972450961724) /* the rings' degrees stand 67.5 below right */
#define BOXES_MAX 64

/* The disc of a map, and where letters stand already; points of the page. */
typedef struct PolarDisc {
    Canvas *canvas;
    const PolarMap *map;
    double x, y, radius;
    int box_count;
    Box box[BOXES_MAX]; /* taken by letters */
} PolarDisc;

/* 0 .. 1 along the colours. */
static double position(const PolarMap *map, double value) {
    double t = map->is_log ? log(value / map->low) / log(map->high / map->low)
                           : (value - map->low) / (map->high - map->low);
    return t > 0 ? (t < 1 ? t : 1) : 0;
}

/* Black or white, whichever reads on the colour of the value. */
static Ink ink_on(const PolarDisc *disc, double value) {
    double at = position(disc->map, value);
    bool light = colour_map_wants_light_ink(disc->map->map, at);
    return light ? ink_hex(0xffffff) : ink_hex(0x14181c);
}

/* For the numbers inside the disc. */
static double letter_size(const PolarDisc *disc) {
    return disc->radius < 60 ? 7 : disc->radius > 180 ? 10.5 : SIZE_SMALL;
}

static void reserve(PolarDisc *disc, Box box) {
    if (disc->box_count < BOXES_MAX) disc->box[disc->box_count++] = box;
}

static bool is_free(const PolarDisc *disc, Box box) {
    for (int i = 0; i < disc->box_count; i++) {
        const Box *b = &disc->box[i];
        if (box.x < b->x + b->w && b->x < box.x + box.w && box.y < b->y + b->h &&
            b->y < box.y + box.h)
            return false;
    }
    return true;
}

/* ---- the colours ------------------------------------------------------------------------ */

static bool has_colour(const PolarMap *map, double value) {
    return isfinite(value) && (!map->is_log || value > 0);
}

/* Colours by table: 1024 of them are more than eight bits can resolve. */
typedef struct Palette {
    const PolarMap *map;
    uint32_t colour[1024], nothing;
    double scale; /* grid points of the map to a pixel */
} Palette;

static void fill_palette(const PolarDisc *disc, Palette *palette) {
    const PolarMap *map = palette->map = disc->map;
    Ink grey = ink_mix(disc->canvas->theme.grid, disc->canvas->theme.faint, 0.25);
    palette->nothing = 0xff000000 | (uint32_t)(grey.red * 255) << 16 |
                       (uint32_t)(grey.green * 255) << 8 | (uint32_t)(grey.blue * 255);
    for (int i = 0; i < 1024; i++) {
        double t = i / 1023.0;
        double v = map->is_log ? map->low * pow(map->high / map->low, t)
                               : map->low + t * (map->high - map->low);
        palette->colour[i] =
            has_colour(map, v) ? colour_map_pixel(map->map, position(map, v)) : palette->nothing;
    }
}

static uint32_t pixel_at(const void *context, int column, int row) {
    const Palette *palette = context;
    double v = field_at(palette->map->field, (column + 0.5) * palette->scale,
                        (row + 0.5) * palette->scale);
    return has_colour(palette->map, v)
               ? palette->colour[(int)(1023 * position(palette->map, v) + 0.5)]
               : palette->nothing;
}

static void paint_colours(const PolarDisc *disc) {
    Palette palette;
    double across = 2 * disc->radius;
    int side = (int)(across * disc->canvas->pixels_per_point + 0.5);
    side = side < 32 ? 32 : side > 1400 ? 1400 : side;
    fill_palette(disc, &palette);
    palette.scale = (disc->map->field->side - 1.0) / side;
    canvas_image(disc->canvas,
                 (Box){disc->x - disc->radius, disc->y - disc->radius, across, across},
                 &(CanvasRaster){side, side, CAIRO_FORMAT_RGB24, false, pixel_at, &palette});
}

/* ---- what was not measured -------------------------------------------------------------- */

/* Inside the measured theta: rows of cells. */
static void hatch_cells(const PolarDisc *disc) {
    const Field *measured = disc->map->measured;
    cairo_t *cr = disc->canvas->cr;
    double cell = 2 * disc->radius / (measured->side - 1);
    double most = disc->map->theta_measured / measured->theta_rim * disc->radius;
    double left = disc->x - disc->radius, top = disc->y - disc->radius;
    cairo_save(cr);
    canvas_circle(disc->canvas, disc->x, disc->y, fmin(most, disc->radius));
    cairo_clip(cr);
    for (int row = 0; row < measured->side; row++)
        for (int begin = 0, i = 0; i <= measured->side; i++) {
            int cell_index = row * measured->side + i;
            if (i < measured->side && !(measured->value[cell_index] > 0)) continue;
            if (i > begin)
                cairo_rectangle(cr, left + (begin - 0.5) * cell, top + (row - 0.5) * cell,
                                (i - begin) * cell, cell);
            begin = i + 1;
        }
    cairo_clip(cr);
    canvas_hatch(disc->canvas, (Box){left, top, 2 * disc->radius, 2 * disc->radius});
    cairo_restore(cr);
}

static void hatch_outside(const PolarDisc *disc) {
    if (disc->map->measured) hatch_cells(disc);
    double from = disc->map->theta_measured / disc->map->field->theta_rim * disc->radius;
    if (from >= disc->radius - 0.5) return;
    cairo_t *cr = disc->canvas->cr;
    cairo_save(cr);
    canvas_circle(disc->canvas, disc->x, disc->y, disc->radius);
    cairo_new_sub_path(cr);
    cairo_arc_negative(cr, disc->x, disc->y, from, 2 * PI, 0);
    cairo_clip(cr);
    canvas_hatch(disc->canvas, (Box){disc->x - disc->radius, disc->y - disc->radius,
                                     2 * disc->radius, 2 * disc->radius});
    cairo_restore(cr);
    canvas_circle(disc->canvas, disc->x, disc->y, from);
    canvas_stroke(disc->canvas, (Stroke){disc->canvas->theme.ink, 0.8, DASH_SHORT});
}

/* ---- angles ----------------------------------------------------------------------------- */

static double ring_step_deg(const PolarDisc *disc) {
    double rim = degrees_from_radians(disc->map->field->theta_rim);
    return rim <= 30 ? 5 : rim <= 50 ? 10 : disc->radius < 45 ? 30 : 20;
}

static Ink ink_at(const PolarDisc *disc, double theta, double phi) {
    double column, row;
    field_place(disc->map->field, theta, phi, &column, &row);
    double v = field_at(disc->map->field, column, row);
    return isfinite(v) ? ink_on(disc, v) : disc->canvas->theme.ink;
}

static void draw_rings(const PolarDisc *disc) {
    double rim = degrees_from_radians(disc->map->field->theta_rim);
    double step = ring_step_deg(disc);
    cairo_t *cr = disc->canvas->cr;
    for (double deg = step; deg < rim - 1; deg += step) {
        canvas_circle(disc->canvas, disc->x, disc->y, deg / rim * disc->radius);
        Ink ink = ink_at(disc, radians_from_degrees(deg), RING_PHI);
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
static void write_ring_labels(PolarDisc *disc, bool only_reserve) {
    double rim = degrees_from_radians(disc->map->field->theta_rim);
    double step = ring_step_deg(disc), size = letter_size(disc);
    for (double deg = step; deg < rim - 1; deg += step) {
        double theta = radians_from_degrees(deg), r = deg / rim * disc->radius;
        double x = disc->x + r * cos(RING_PHI), y = disc->y - r * sin(RING_PHI);
        if (only_reserve) {
            reserve(disc, (Box){x - 10, y - 6, 20, 12});
            continue;
        }
        bool hatched = theta > disc->map->theta_measured;
        Ink ink = hatched ? disc->canvas->theme.ink : ink_at(disc, theta, RING_PHI);
        Ink halo = hatched         ? disc->canvas->theme.paper
                   : ink.red > 0.5 ? ink_hex(0x000000)
                                   : ink_hex(0xffffff);
        canvas_text(disc->canvas, x, y,
                    (Letters){.size = size,
                              .ink = ink,
                              .across = 0.5,
                              .down = 0.5,
                              .halo = ink_alpha(halo, hatched ? 0.75 : 0.22)},
                    arena_format(disc->canvas->arena, "%g°", deg));
    }
}

static void write_azimuths(const PolarDisc *disc) {
    int step = disc->radius < 60 ? 90 : 45;
    for (int deg = 0; deg < 360; deg += step) {
        double a = radians_from_degrees(deg), r = disc->radius + 5;
        double x = disc->x + r * cos(a), y = disc->y - r * sin(a);
        canvas_text(disc->canvas, x, y,
                    (Letters){.size = SIZE_SMALL,
                              .ink = disc->canvas->theme.soft,
                              .across = 0.5 - 0.5 * cos(a),
                              .down = 0.5 + 0.5 * sin(a)},
                    arena_format(disc->canvas->arena, "%d°", deg));
    }
}

static void mark_light(const PolarDisc *disc) {
    double r = disc->map->theta_light / disc->map->field->theta_rim * disc->radius;
    Ink ink = ink_at(disc, disc->map->theta_light, PI);
    canvas_circle(disc->canvas, disc->x - r, disc->y, 4);
    canvas_stroke(disc->canvas, (Stroke){ink, 1.2, DASH_NONE});
    canvas_circle(disc->canvas, disc->x - r, disc->y, 1.4);
    canvas_fill(disc->canvas, ink);
    canvas_text(disc->canvas, disc->x - r, disc->y + 8,
                (Letters){.size = SIZE_SMALL, .ink = ink, .across = 0.5}, "light");
}

/* ---- the scale -------------------------------------------------------------------------- */

static Ticks scale_ticks(const PolarMap *map, double height) {
    int most = (int)(height / 18);
    most = most < 3 ? 3 : most > 11 ? 11 : most;
    return map->is_log ? ticks_log(map->low, map->high, most)
                       : ticks_linear(map->low, map->high, most);
}

/* On the bar's end at y, its tip `down` from there. */
static void draw_arrow(Canvas *canvas, Box bar, double y, double down, uint32_t pixel) {
    cairo_move_to(canvas->cr, bar.x, y);
    cairo_line_to(canvas->cr, bar.x + bar.w / 2, y + down);
    cairo_line_to(canvas->cr, bar.x + bar.w, y);
    canvas_fill(canvas, ink_hex(pixel & 0xffffff));
}

/* The colours from bottom to top, with arrows where values are cut. */
static void paint_ramp(const PolarDisc *disc, Box bar) {
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
    if (!disc->map->is_cut) return;
    draw_arrow(canvas, bar, bar.y, -8, palette.colour[1023]);
    if (disc->map->map == MAP_SIGNED) draw_arrow(canvas, bar, bar.y + bar.h, 8, palette.colour[0]);
}

static void draw_scale_ticks(const PolarDisc *disc, Box bar) {
    Canvas *canvas = disc->canvas;
    Ticks ticks = scale_ticks(disc->map, bar.h);
    for (int i = 0; i < ticks.count; i++) {
        char text[32];
        double y = bar.y + bar.h * (1 - position(disc->map, ticks.value[i]));
        canvas_line(canvas, bar.x + bar.w, y, bar.x + bar.w + (ticks.is_labelled[i] ? 3.5 : 2), y,
                    (Stroke){canvas->theme.faint, 0.8, DASH_NONE});
        if (ticks.is_labelled[i])
            canvas_text(canvas, bar.x + bar.w + 6, y,
                        (Letters){.size = SIZE_TICK, .ink = canvas->theme.soft, .down = 0.5},
                        tick_text(ticks.value[i], ticks.step, text));
    }
}

static void draw_scale(const PolarDisc *disc, Box bar) {
    Canvas *canvas = disc->canvas;
    paint_ramp(disc, bar);
    draw_scale_ticks(disc, bar);
    for (int i = 0; i < disc->map->level_count; i++) { /* the lines of the map, on the scale */
        double t = position(disc->map, disc->map->level[i]);
        double y = bar.y + bar.h * (1 - t);
        if (!(t > 0 && t < 1)) continue;
        canvas_line(canvas, bar.x, y, bar.x + bar.w, y,
                    (Stroke){ink_alpha(ink_on(disc, disc->map->level[i]), 0.75), 0.7, DASH_NONE});
    }
    canvas_text(canvas, bar.x, bar.y - (disc->map->is_cut ? 14 : 8),
                (Letters){.size = SIZE_TICK, .ink = canvas->theme.ink, .down = 1}, disc->map->unit);
}

/* ---- lines of equal value, with a gap in which the number stands ------------------------- */

/* One line with the length of the way to every point, points of the page. */
typedef struct Way {
    int count;
    bool is_closed;
    double *x, *y, *length;
} Way;

static Way way_of(const PolarDisc *disc, const ContourLine *line) {
    Arena *arena = disc->canvas->arena;
    Way way = {line->count, line->is_closed, ARENA_NEW(arena, double, line->count),
               ARENA_NEW(arena, double, line->count), ARENA_NEW(arena, double, line->count)};
    double scale = 2 * disc->radius / (disc->map->field->side - 1);
    for (int i = 0; i < line->count; i++) {
        way.x[i] = disc->x - disc->radius + scale * line->point[i].x;
        way.y[i] = disc->y - disc->radius + scale * line->point[i].y;
        if (i > 0)
            way.length[i] =
                way.length[i - 1] + hypot(way.x[i] - way.x[i - 1], way.y[i] - way.y[i - 1]);
    }
    return way;
}

static ContourPoint way_at(const Way *way, double s) {
    int i = 0;
    while (i + 2 < way->count && way->length[i + 1] < s) i++;
    double step = way->length[i + 1] - way->length[i];
    double f = step > 0 ? fmin(fmax((s - way->length[i]) / step, 0), 1) : 0;
    return (ContourPoint){way->x[i] + f * (way->x[i + 1] - way->x[i]),
                          way->y[i] + f * (way->y[i + 1] - way->y[i])};
}

/* A number's place on the way: centre, direction, and how much it is liked (less is better). */
typedef struct Spot {
    double s, x, y, angle, cost;
} Spot;

/* Upright: turned by at most a quarter. */
static double upright(double angle) {
    while (angle > PI / 2) angle -= PI;
    while (angle <= -PI / 2) angle += PI;
    return angle;
}

static Box spot_box(const Spot *spot, double width, double height) {
    double c = fabs(cos(spot->angle)), s = fabs(sin(spot->angle));
    double w = width * c + height * s, h = width * s + height * c;
    return (Box){spot->x - w / 2, spot->y - h / 2, w, h};
}

/* Straight enough, inside the disc and free; ladder: the azimuth where numbers should line up.
 * Nearly level text is liked, text on its side is not. */
static bool try_spot(const PolarDisc *disc, const Way *way, double s, double width, Spot *spot) {
    double half = width / 2 + 3, total = way->length[way->count - 1];
    if (s < half || s > total - half) return false;
    ContourPoint a = way_at(way, s - half), b = way_at(way, s + half), m = way_at(way, s);
    double chord = hypot(b.x - a.x, b.y - a.y);
    if (chord < 1.86 * half) return false;
    double from_centre = hypot(m.x - disc->x, m.y - disc->y);
    double measured = disc->map->theta_measured / disc->map->field->theta_rim * disc->radius;
    if (from_centre > fmin(disc->radius, measured) - 7) return false;
    *spot = (Spot){s, (m.x + (a.x + b.x) / 2) / 2, (m.y + (a.y + b.y) / 2) / 2,
                   upright(atan2(b.y - a.y, b.x - a.x)), 0};
    if (!is_free(disc, spot_box(spot, width + 4, 11))) return false;
    double phi = atan2(disc->y - m.y, m.x - disc->x);
    double away = fabs(remainder(phi - 0.58 * PI, 2 * PI));
    spot->cost = away + 1.2 * fabs(spot->angle) + 0.02 * (2 * half - chord);
    return true;
}

static bool find_spot(const PolarDisc *disc, const Way *way, double width, Spot *best) {
    double total = way->length[way->count - 1];
    bool found = false;
    for (double s = 0; s < total; s += 3) {
        Spot spot;
        if (!try_spot(disc, way, s, width, &spot)) continue;
        if (!found || spot.cost < best->cost) *best = spot;
        found = true;
    }
    return found;
}

static void add_part(const PolarDisc *disc, const Way *way, double from, double to) {
    if (to <= from) return;
    Arena scratch = *disc->canvas->arena;
    double *x = ARENA_NEW(&scratch, double, way->count + 2);
    double *y = ARENA_NEW(&scratch, double, way->count + 2);
    ContourPoint first = way_at(way, from), last = way_at(way, to);
    Canvas canvas = *disc->canvas;
    int count = 0;
    canvas.arena = &scratch;
    x[count] = first.x;
    y[count++] = first.y;
    for (int i = 0; i < way->count; i++) {
        if (!(way->length[i] > from && way->length[i] < to)) continue;
        x[count] = way->x[i];
        y[count++] = way->y[i];
    }
    x[count] = last.x;
    y[count++] = last.y;
    canvas_polyline(&canvas, x, y, count);
}

static const char *level_text(const PolarDisc *disc, int i) {
    char text[32];
    double level = disc->map->level[i];
    if (disc->map->level_text[i]) return disc->map->level_text[i];
    if (level == disc->map->strong && disc->map->strong_text) return disc->map->strong_text;
    return arena_format(disc->canvas->arena, "%s", tick_text(level, disc->map->step, text));
}

static void draw_way(PolarDisc *disc, const Way *way, int i, bool wants_number) {
    Spot spot = {0};
    double level = disc->map->level[i];
    bool strong = level == disc->map->strong;
    double size = letter_size(disc), total = way->length[way->count - 1];
    const char *text = level_text(disc, i);
    double width = canvas_text_width(disc->canvas, size, strong, text);
    Ink ink = ink_on(disc, level);
    Stroke stroke = {ink_alpha(ink, strong ? 1 : 0.8), strong ? 1.7 : 0.85, DASH_NONE};
    bool has_spot = wants_number && find_spot(disc, way, width, &spot);
    if (!has_spot) {
        add_part(disc, way, 0, total);
        canvas_stroke(disc->canvas, stroke);
        return;
    }
    add_part(disc, way, 0, spot.s - width / 2 - 3);
    add_part(disc, way, spot.s + width / 2 + 3, total);
    canvas_stroke(disc->canvas, stroke);
    reserve(disc, spot_box(&spot, width + 8, 14));
    canvas_text(disc->canvas, spot.x, spot.y,
                (Letters){.size = size,
                          .ink = ink,
                          .across = 0.5,
                          .down = 0.5,
                          .angle = spot.angle,
                          .is_bold = strong},
                text);
}

static void draw_lines(PolarDisc *disc) {
    for (int pass = 0; pass < 2; pass++) { /* the strong line chooses its place first */
        for (int i = 0; i < disc->map->level_count; i++) {
            double level = disc->map->level[i];
            if ((level == disc->map->strong) != (pass == 0)) continue;
            ContourSet set = contour_lines(disc->map->field->value, disc->map->field->side, level,
                                           disc->canvas->arena);
            for (int k = 0; k < set.count; k++) {
                if (set.line[k].count < 3) continue;
                Way way = way_of(disc, &set.line[k]);
                draw_way(disc, &way, i, way.length[way.count - 1] > 70);
            }
        }
    }
}

#define SCALE_WIDTH 62.0
#define LABEL_ROOM 26.0

/* Saves cairo's state. */
static void clip_to_disc(const PolarDisc *disc, double radius) {
    cairo_save(disc->canvas->cr);
    canvas_circle(disc->canvas, disc->x, disc->y, radius);
    cairo_clip(disc->canvas->cr);
}

/* A narrow rim that was not measured has no room for lines; a wide one shows them dimmed. */
static void draw_lines_inside(PolarDisc *disc) {
    double share = disc->map->theta_measured / disc->map->field->theta_rim;
    clip_to_disc(disc, disc->radius * (share < 1 && share > 0.88 ? share : 1));
    draw_lines(disc);
    cairo_restore(disc->canvas->cr);
}

PolarPlace polar_draw(Canvas *canvas, Box box, const PolarMap *asked) {
    PolarMap with_extent = *asked; /* data without any spread still get a scale */
    PolarMap *map = &with_extent;
    if (map->is_log && !(map->high > 0)) map->high = 1;
    if (map->is_log && !(map->low > 0 && map->low < map->high)) map->low = map->high / 10;
    if (!map->is_log && !(map->high > map->low)) map->high = map->low + 1;
    double across = box.w - SCALE_WIDTH - 2 * LABEL_ROOM - 6, down = box.h - 34;
    double radius = fmin(across, down) / 2;
    PolarDisc disc = {.canvas = canvas, .map = map, .radius = radius, .y = box.y + box.h / 2};
    double whole = 2 * radius + 2 * LABEL_ROOM + 6 + SCALE_WIDTH;
    disc.x = box.x + (box.w - whole) / 2 + LABEL_ROOM + radius;
    write_ring_labels(&disc, true);
    clip_to_disc(&disc, radius);
    paint_colours(&disc);
    draw_rings(&disc);
    cairo_restore(canvas->cr);
    if (!map->is_residual) draw_lines_inside(&disc);
    hatch_outside(&disc);
    write_ring_labels(&disc, false);
    if (map->has_light) mark_light(&disc);
    canvas_circle(canvas, disc.x, disc.y, radius);
    canvas_stroke(canvas, (Stroke){canvas->theme.faint, 0.9, DASH_NONE});
    write_azimuths(&disc);
    double height = fmin(1.55 * radius, 2 * radius - 20);
    draw_scale(&disc, (Box){disc.x + radius + LABEL_ROOM + 6, disc.y - height / 2 + 6, 10, height});
    return (PolarPlace){disc.x, disc.y, radius};
}
