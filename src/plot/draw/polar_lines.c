/* SPDX-License-Identifier: Apache-2.0 */
/* The lines of equal value of a polar map: drawn with a gap in which the number stands. */
#include "plot/draw/polar_lines.h"

#include <math.h>

#include "base/units.h"
#include "plot/draw/contour.h"
#include "plot/draw/ticks.h"

/* One line with the length of the way to every point, points of the page. */
typedef struct Way {
    int     count;
    bool    is_closed;
    double *x, *y, *length;
} Way;

static Way way_of(const PolarDisc *disc, const ContourLine *line)
{
    Arena *arena = disc->canvas->arena;
    Way    way = {line->count, line->is_closed, ARENA_NEW(arena, double, line->count),
                  ARENA_NEW(arena, double, line->count), ARENA_NEW(arena, double, line->count)};
    double scale = 2 * disc->radius / (disc->map->field->side - 1);
    for (int i = 0; i < line->count; i++) {
        way.x[i] = disc->x - disc->radius + scale * line->point[i].x;
        way.y[i] = disc->y - disc->radius + scale * line->point[i].y;
        if (i > 0)
            way.length[i] = way.length[i - 1] +
                            hypot(way.x[i] - way.x[i - 1], way.y[i] - way.y[i - 1]);
    }
    return way;
}

static ContourPoint way_at(const Way *way, double s)
{
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
static double upright(double angle)
{
    while (angle > PI / 2) angle -= PI;
    while (angle <= -PI / 2) angle += PI;
    return angle;
}

static Box spot_box(const Spot *spot, double width, double height)
{
    double c = fabs(cos(spot->angle)), s = fabs(sin(spot->angle));
    double w = width * c + height * s, h = width * s + height * c;
    return (Box){spot->x - w / 2, spot->y - h / 2, w, h};
}

/* Straight enough, inside the disc and free; ladder: the azimuth where numbers should line up.
 * Nearly level text is liked, text on its side is not. */
static bool try_spot(const PolarDisc *disc, const Way *way, double s, double width, Spot *spot)
{
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
    if (!polar_disc_is_free(disc, spot_box(spot, width + 4, 11))) return false;
    double phi = atan2(disc->y - m.y, m.x - disc->x);
    double away = fabs(remainder(phi - 0.58 * PI, 2 * PI));
    spot->cost = away + 1.2 * fabs(spot->angle) + 0.02 * (2 * half - chord);
    return true;
}

static bool find_spot(const PolarDisc *disc, const Way *way, double width, Spot *best)
{
    double total = way->length[way->count - 1];
    bool   found = false;
    for (double s = 0; s < total; s += 3) {
        Spot spot;
        if (!try_spot(disc, way, s, width, &spot)) continue;
        if (!found || spot.cost < best->cost) *best = spot;
        found = true;
    }
    return found;
}

static void add_part(const PolarDisc *disc, const Way *way, double from, double to)
{
    if (to <= from) return;
    Arena        scratch = *disc->canvas->arena;
    double      *x = ARENA_NEW(&scratch, double, way->count + 2);
    double      *y = ARENA_NEW(&scratch, double, way->count + 2);
    ContourPoint first = way_at(way, from), last = way_at(way, to);
    Canvas       canvas = *disc->canvas;
    int          count = 0;
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

static const char *level_text(const PolarDisc *disc, int i)
{
    char   text[32];
    double level = disc->map->level[i];
    if (disc->map->level_text[i]) return disc->map->level_text[i];
    if (level == disc->map->strong && disc->map->strong_text) return disc->map->strong_text;
    return arena_format(disc->canvas->arena, "%s", tick_text(level, disc->map->step, text));
}

static void draw_way(PolarDisc *disc, const Way *way, int i, bool wants_number)
{
    Spot        spot = {0};
    double      level = disc->map->level[i];
    bool        strong = level == disc->map->strong;
    double      size = polar_disc_letter_size(disc), total = way->length[way->count - 1];
    const char *text = level_text(disc, i);
    double      width = canvas_text_width(disc->canvas, size, strong, text);
    Ink         ink = polar_disc_ink(disc, level);
    Stroke      stroke = {ink_alpha(ink, strong ? 1 : 0.8), strong ? 1.7 : 0.85, DASH_NONE};
    bool        has_spot = wants_number && find_spot(disc, way, width, &spot);
    if (!has_spot) {
        add_part(disc, way, 0, total);
        canvas_stroke(disc->canvas, stroke);
        return;
    }
    add_part(disc, way, 0, spot.s - width / 2 - 3);
    add_part(disc, way, spot.s + width / 2 + 3, total);
    canvas_stroke(disc->canvas, stroke);
    polar_disc_reserve(disc, spot_box(&spot, width + 8, 14));
    canvas_text(disc->canvas, spot.x, spot.y,
                (Letters){.size = size, .ink = ink, .across = 0.5, .down = 0.5,
                          .angle = spot.angle, .is_bold = strong}, text);
}

void polar_lines_draw(PolarDisc *disc)
{
    for (int pass = 0; pass < 2; pass++) { /* the strong line chooses its place first */
        for (int i = 0; i < disc->map->level_count; i++) {
            double level = disc->map->level[i];
            if ((level == disc->map->strong) != (pass == 0)) continue;
            ContourSet set = contour_lines(disc->map->field->value, disc->map->field->side,
                                           level, disc->canvas->arena);
            for (int k = 0; k < set.count; k++) {
                if (set.line[k].count < 3) continue;
                Way way = way_of(disc, &set.line[k]);
                draw_way(disc, &way, i, way.length[way.count - 1] > 70);
            }
        }
    }
}
