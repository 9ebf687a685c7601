/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_reach.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/query/panel_reach.h"

#define ROUND (PI / 3)      /* edges of smaller turns are linear in the turn */
#define ROOM_DEG 2.0f       /* a cone is held if it lacks no more than this */
#define CONE_SIDES 72

typedef struct HullPoint {
    double x, y, angle, turn;
} HullPoint;

static int order_by_x(const void *a, const void *b)
{
    const HullPoint *p = a, *q = b;
    double           rise = p->x != q->x ? p->x - q->x : p->y - q->y;
    return (rise > 0) - (rise < 0);
}

static double turned_left(const HullPoint *a, const HullPoint *b, const HullPoint *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

/* Andrew's monotone chain: anticlockwise; points are sorted. */
static int convex_hull(HullPoint *point, int count, HullPoint *hull)
{
    int n = 0;
    qsort(point, (size_t)count, sizeof *point, order_by_x);
    for (int side = 0; side < 2; side++) {
        int begin = n;
        for (int i = 0; i < count; i++) {
            const HullPoint *next = &point[side ? count - 1 - i : i];
            while (n > begin + 1 && turned_left(&hull[n - 2], &hull[n - 1], next) <= 0) n--;
            hull[n++] = *next;
        }
        n--; /* the other side begins with it */
    }
    return n;
}

/* ---- the centre -------------------------------------------------------------------------- */

static void set_centre(const AngleTable *table, bool mirrored, PanelReachStored *out)
{
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < table->rows; i++) {
        Vec3 d = table_row_direction(table, i);
        sum[0] += (double)d.x, sum[1] += mirrored ? 0 : (double)d.y, sum[2] += (double)d.z;
    }
    double theta = atan2_d(hypot_d(sum[0], sum[1]), sum[2]), phi = atan2_d(sum[1], sum[0]);
    out->theta = (uint16_t)rint(fmin(1, theta / (0.5 * PI)) * 65535);
    out->phi = (uint16_t)(int)rint((phi < 0 ? phi + 2 * PI : phi) / (2 * PI) * 65536);
}

static HullPoint point_at(const Vec3 axis[3], double theta, double phi)
{
    PanelReachPlace at = panel_reach_place(axis, table_direction(theta, phi));
    double          angle = (double)at.angle, turn = (double)at.turn;
    return (HullPoint){angle * cos_d(turn), angle * sin_d(turn), angle, turn};
}

/* ---- the edge ---------------------------------------------------------------------------- */

/* Where the edge from a to b is at a turn, which it spans. */
static double edge_at(const HullPoint *a, const HullPoint *b, double turn)
{
    double span = b->turn - a->turn, from = turn - a->turn;
    span -= 2 * PI * floor(span / (2 * PI));
    from -= 2 * PI * floor(from / (2 * PI));
    if (!(from <= span) || !(span > 0)) return 0;
    if (span < ROUND) return a->angle + (b->angle - a->angle) * from / span;
    double across = cos_d(turn) * (b->y - a->y) - sin_d(turn) * (b->x - a->x);
    return across != 0 ? fmax(0, (a->x * b->y - a->y * b->x) / across) : 0;
}

/* Sides in units of the largest, none rounded down; some room is left for corners. */
#define CORNERS 1.02
static void store_sides(const double side[PANEL_REACH_SIDES], PanelReachStored *out)
{
    double most = 1e-3;
    for (int k = 0; k < PANEL_REACH_SIDES; k++) most = fmax(most, side[k]);
    out->most = (uint16_t)fmin(65535, ceil(CORNERS * most / PI * 65535));
    for (int k = 0; k < PANEL_REACH_SIDES; k++)
        out->side[k] = (uint8_t)fmin(255, ceil(side[k] / (double)panel_reach_unit(out)));
}

/* Between two sides a corner of the hull may stand out: both are raised to hold it. */
static void hold_point(const HullPoint *point, PanelReachStored *out)
{
    double at = point->turn * PANEL_REACH_SIDES / (2 * PI);
    int    side = (int)at % PANEL_REACH_SIDES, next = (side + 1) % PANEL_REACH_SIDES;
    double edge = (double)panel_reach_edge(out, (float)point->turn);
    if (point->angle <= edge) return;
    int more = (int)ceil((point->angle - edge) / (double)panel_reach_unit(out) + 1e-3);
    out->side[side] = (uint8_t)fmin(255, out->side[side] + more);
    out->side[next] = (uint8_t)fmin(255, out->side[next] + more);
}

PanelReachStored reflection_reach(const AngleTable *table, bool mirrored, Arena scratch)
{
    PanelReachStored out = {0};
    Vec3             axis[3];
    HullPoint *point = ARENA_NEW(&scratch, HullPoint, 2 * table->rows);
    HullPoint *hull = ARENA_NEW(&scratch, HullPoint, 4 * table->rows + 1);
    double     side[PANEL_REACH_SIDES] = {0};
    int        count = 0;
    set_centre(table, mirrored, &out);
    panel_reach_axes(&out, axis);
    for (int i = 0; i < table->rows; i++) {
        double theta = (double)table->theta[i], phi = (double)table->phi[i];
        point[count++] = point_at(axis, theta, phi);
        if (mirrored) point[count++] = point_at(axis, theta, -phi);
    }
    count = convex_hull(point, count, hull);
    for (int k = 0; k < PANEL_REACH_SIDES; k++)
        for (int i = 0; i < count; i++)
            side[k] = fmax(side[k], edge_at(&hull[i], &hull[(i + 1) % count],
                                            2 * PI * k / PANEL_REACH_SIDES));
    store_sides(side, &out);
    for (int i = 0; i < count; i++) hold_point(&hull[i], &out);
    return out;
}

PanelReachStored reflection_reach_cone(float theta)
{
    PanelReachStored out = {0};
    double           side[PANEL_REACH_SIDES];
    for (int k = 0; k < PANEL_REACH_SIDES; k++) side[k] = (double)theta;
    store_sides(side, &out);
    return out;
}

bool reflection_reach_is_cone(const PanelReachStored *reach, float theta)
{
    float inner = fmaxf(0, theta - (float)radians_from_degrees((double)ROOM_DEG));
    for (int k = 0; k < CONE_SIDES; k++) {
        Vec3 d = table_direction((double)inner, 2 * PI * k / CONE_SIDES);
        if (panel_reach_room(reach, d) < 0) return false;
    }
    return true;
}
