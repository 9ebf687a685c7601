/* SPDX-License-Identifier: Apache-2.0 */
#include "image/frame_view.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"

/* ---- what a frame says ------------------------------------------------------------------- */

#define PROJECTION "parhelion:projection"

void frame_set_fisheye(FrameImage *frame, Fisheye kind, Arena *arena)
{
    frame_set_string(frame, PROJECTION,
                     arena_format(arena, "%s fisheye of 180 degrees; pixels outside its circle "
                                  "are black and have no samples", fisheye_name(kind)), arena);
}

Fisheye frame_fisheye(const FrameImage *frame)
{
    const char *text = frame_string(frame, PROJECTION);
    if (!text) return FISHEYE_NONE;
    return strncmp(text, "equisolid", 9) ? FISHEYE_EQUIDISTANT : FISHEYE_EQUISOLID;
}

/* Without the attribute the head's own axes: figures of one eye need no others. */
static void read_axes(const FrameImage *frame, FrameView *out)
{
    const ExrAttribute *matrix = frame_attribute(frame, "worldToCamera");
    bool has_axes = matrix && matrix->kind == EXR_MATRIX44;
    double own[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double *m = has_axes ? matrix->values : own;
    for (int i = 0; i < 3; i++) {
        out->right[i] = m[4 * i];
        out->up[i] = m[4 * i + 1];
        out->ahead[i] = 0.0 - m[4 * i + 2];
        out->eye[i] = 0.0 - (m[12] * m[4 * i] + m[13] * m[4 * i + 1] + m[14] * m[4 * i + 2]);
    }
}

static bool read_number(const FrameImage *frame, const char *name, double most, double *out,
                        Error *err)
{
    const ExrAttribute *a = frame_attribute(frame, name);
    *out = a->kind == EXR_STRING ? (double)NAN : a->values[0];
    return (*out > 0 && *out < most) ||
           error_set(err, ERROR_INPUT, "%s is %g, wanted a number between 0 and %g", name, *out,
                     most);
}

bool frame_view_find(const FrameImage *frame, FrameView *out, Error *err)
{
    const char *words = frame_string(frame, "VIEW");
    FrameView   view = {.is_perspective = true, .fisheye = frame_fisheye(frame),
                        .width = frame->display.x1 - frame->display.x0,
                        .height = frame->display.y1 - frame->display.y0};
    double      aspect = (double)view.width / view.height, high;
    if (words) return frame_view_parse(words, view.width, view.height, out, err);
    if (view.fisheye) {
        view.half_height = aspect < 1 ? 1 / aspect : 1;
    } else if (frame_attribute(frame, "parhelion:ymag_m")) {
        view.is_perspective = false;
        if (!read_number(frame, "parhelion:ymag_m", 1e9, &view.half_height, err)) return false;
    } else if (frame_attribute(frame, "parhelion:yfov_deg")) {
        if (!read_number(frame, "parhelion:yfov_deg", 180, &high, err)) return false;
        view.half_height = tan_d(radians_from_degrees(high) / 2);
    } else {
        return error_set(err, ERROR_INPUT, "does not say its view (parhelion:projection, "
                         "parhelion:yfov_deg; VIEW= of a Radiance picture)");
    }
    view.half_width = view.half_height * aspect;
    read_axes(frame, &view);
    *out = view;
    return true;
}

/* ---- pixels ------------------------------------------------------------------------------ */

/* A place of the picture's plane: right and up in the units of half_width. */
typedef struct Place {
    double x, y;
} Place;

static Place place_of(const FrameView *view, double x, double y)
{
    return (Place){(2 * x / view->width - 1 + 2 * view->shift[0]) * view->half_width,
                   (1 - 2 * y / view->height + 2 * view->shift[1]) * view->half_height};
}

static double clamp(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

bool frame_view_sees(const FrameView *view, int x, int y)
{
    if (!view->fisheye) return true;
    double middle_x = (0.5 - view->shift[0]) * view->width;
    double middle_y = (0.5 + view->shift[1]) * view->height;
    Place  near = place_of(view, clamp(middle_x, x, x + 1), clamp(middle_y, y, y + 1));
    return near.x * near.x + near.y * near.y < 1;
}

/* 1 - cos a and sin^2 a / 2 over the square of the radius. */
static void over_square(const FrameView *view, double square, double out[2])
{
    if (view->fisheye == FISHEYE_EQUISOLID) {
        out[0] = 1;
        out[1] = 1 - square / 2;
    } else if (view->fisheye) {
        double half = sqrt(square) * PI / 4; /* of the angle */
        double sine = half > 1e-6 ? sin_d(half) / half * PI / 4 : PI / 4, cosine = cos_d(half);
        out[0] = 2 * sine * sine;
        out[1] = 2 * sine * sine * cosine * cosine;
    } else {
        double far = sqrt(1 + square);
        out[0] = 1 / (far * (1 + far));
        out[1] = 0.5 / (1 + square);
    }
}

/* From a to b, both in view, where the angle about the middle grows by (a x b) / radius^2. */
static void add_seen(const FrameView *view, Place a, Place b, double out[2])
{
    static const double AT[5] = {0, 0.538469310105683, -0.538469310105683, 0.906179845938664,
                                 -0.906179845938664};
    static const double WEIGHT[5] = {0.568888888888889, 0.478628670499366, 0.478628670499366,
                                     0.236926885056189, 0.236926885056189};
    double cross = a.x * b.y - a.y * b.x;
    for (int i = 0; i < 5; i++) {
        double t = 0.5 + 0.5 * AT[i], x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y);
        double value[2];
        over_square(view, x * x + y * y, value);
        for (int k = 0; k < 2; k++) out[k] += 0.5 * WEIGHT[i] * cross * value[k];
    }
}

/* Out of view the integrands stay what they are on the rim. */
static void add_unseen(Place a, Place b, double out[2])
{
    double turn = atan2_d(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    out[0] += turn;
    out[1] += 0.5 * turn;
}

/* Where the edge crosses the circle; 0 and 1 where it does not. */
static void crossings(Place a, Place b, double at[2])
{
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double half = (a.x * dx + a.y * dy) / square;
    double root = half * half - (a.x * a.x + a.y * a.y - 1) / square;
    at[0] = root > 0 ? clamp(-half - sqrt(root), 0, 1) : 0;
    at[1] = root > 0 ? clamp(-half + sqrt(root), 0, 1) : 0;
}

static void add_edge(const FrameView *view, Place a, Place b, double out[2])
{
    double at[2] = {0, 1};
    if (view->fisheye) crossings(a, b, at);
    Place in = {a.x + at[0] * (b.x - a.x), a.y + at[0] * (b.y - a.y)};
    Place away = {a.x + at[1] * (b.x - a.x), a.y + at[1] * (b.y - a.y)};
    if (at[0] > 0) add_unseen(a, in, out);
    if (at[1] > at[0]) add_seen(view, in, away, out);
    if (at[1] < 1) add_unseen(away, b, out);
}

#define RIM (1 - 1e-9) /* still before the eye */

static void direction_of(const FrameView *view, Place at, double out[3])
{
    double radius = hypot_d(at.x, at.y), sine, cosine;
    double reach = view->fisheye && radius > RIM ? RIM : radius;
    if (view->fisheye == FISHEYE_EQUISOLID) {
        cosine = 1 - reach * reach;
        sine = reach * sqrt(2 - reach * reach);
    } else if (view->fisheye) {
        cosine = cos_d(reach * PI / 2);
        sine = sin_d(reach * PI / 2);
    } else {
        cosine = 1 / sqrt(1 + radius * radius);
        sine = radius * cosine;
    }
    out[0] = radius > 0 ? sine * at.x / radius : 0;
    out[1] = radius > 0 ? sine * at.y / radius : 0;
    out[2] = cosine;
}

ViewPixel frame_view_pixel(const FrameView *view, int x, int y)
{
    static const int CORNERS[5][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}};
    ViewPixel out;
    double    sums[2] = {0, 0};
    for (int i = 0; i < 4; i++) {
        const int *from = CORNERS[i], *to = CORNERS[i + 1];
        add_edge(view, place_of(view, x + from[0], y + from[1]),
                 place_of(view, x + to[0], y + to[1]), sums);
    }
    direction_of(view, place_of(view, x + 0.5, y + 0.5), out.direction);
    out.sr = fmax(sums[0], 0);
    out.projected_sr = fmax(sums[1], 0);
    return out;
}
