/* SPDX-License-Identifier: Apache-2.0 */
#include "image/frame_view.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/number.h"
#include "base/units.h"

/* ---- Radiance's words, read -------------------------------------------------------------- */

/* Options as they are found; rpict's defaults. */
typedef struct ViewWords {
    char type;
    double p[3], d[3], u[3], h, v, s, l, o, a;
} ViewWords;

/* Numbers of one option; NULL: it has none such. */
static double *slot_of(ViewWords *words, char letter, int *count) {
    *count = letter == 'p' || letter == 'd' || letter == 'u' ? 3 : 1;
    switch (letter) {
    case 'p': return words->p;
    case 'd': return words->d;
    case 'u': return words->u;
    case 'h': return &words->h;
    case 'v': return &words->v;
    case 's': return &words->s;
    case 'l': return &words->l;
    case 'o': return &words->o;
    case 'a': return &words->a;
    default: return NULL;
    }
}

static bool read_numbers(const char **at, int count, double *out) {
    for (int i = 0; i < count; i++) {
        const char *end = number_read(*at, &out[i]);
        if (!end || (*end && *end != ' ' && *end != '\t')) return false;
        *at = end;
    }
    return true;
}

/* Words that are no options of a view are a program's name: "rvu -vtv ...". */
static bool read_words(const char *text, ViewWords *out, Error *err) {
    const char *at = text;
    while (at += strspn(at, " \t"), *at) {
        const char *word = at;
        size_t length = strcspn(at, " \t");
        int count;
        at += length;
        if (length < 3 || strncmp(word, "-v", 2) != 0) continue;
        if (word[2] == 't' && length == 4) {
            out->type = word[3];
            continue;
        }
        double more, *slot = length == 3 ? slot_of(out, word[2], &count) : NULL;
        if (!slot || !read_numbers(&at, count, slot) || number_read(at, &more))
            return error_set(err, ERROR_INPUT,
                             "VIEW=: '%.40s', required: an option of a view "
                             "with its numbers and no more, blanks between",
                             word);
    }
    return true;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool normalize(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) v[i] /= length;
    return isfinite(length) && length > 1e-12;
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static bool set_axes(const ViewWords *words, FrameView *out) {
    memcpy(out->eye, words->p, sizeof out->eye);
    memcpy(out->ahead, words->d, sizeof out->ahead);
    if (!normalize(out->ahead)) return false;
    cross(out->ahead, words->u, out->right);
    if (!normalize(out->right)) return false;
    cross(out->right, out->ahead, out->up);
    return true;
}

/* Half of -vh or -vv in the units of half_width; 0: no such view. */
static double half_of(char type, double size) {
    if (!(size > 0)) return 0;
    if (type == 'a') return size <= 360 ? size / 180 : 0;
    if (type == 'l') return size / 2;
    return size < 180 ? tan_d(radians_from_degrees(size) / 2) : 0;
}

/* words: what stands behind "VIEW="; width, height: the picture's pixels. */
static bool parse_words(const char *words, int width, int height, FrameView *out, Error *err) {
    ViewWords in = {.type = 'v', .d = {0, 1, 0}, .u = {0, 0, 1}, .h = 45, .v = 45};
    if (!read_words(words, &in, err)) return false;
    FrameView view = {.is_perspective = in.type != 'l',
                      .fisheye = in.type == 'a' ? FISHEYE_EQUIDISTANT : FISHEYE_NONE,
                      .half_width = half_of(in.type, in.h),
                      .half_height = half_of(in.type, in.v),
                      .shift = {in.s, in.l},
                      .width = width,
                      .height = height};
    if (!strchr("val", in.type))
        return error_set(err, ERROR_INPUT,
                         "VIEW=: -vt%c, required: -vta (angular fisheye), "
                         "-vtv (perspective) or -vtl (parallel)",
                         in.type);
    if (!(view.half_width > 0) || !(view.half_height > 0))
        return error_set(err, ERROR_INPUT, "VIEW=: -vh %g -vv %g of -vt%c, required: %s", in.h,
                         in.v, in.type,
                         in.type == 'a'   ? "angles up to 360 degrees"
                         : in.type == 'v' ? "angles below 180 degrees"
                                          : "sizes above 0");
    if (!set_axes(&in, &view))
        return error_set(err, ERROR_INPUT,
                         "VIEW=: -vd %g %g %g -vu %g %g %g, required: two "
                         "directions that are not along one line",
                         in.d[0], in.d[1], in.d[2], in.u[0], in.u[1], in.u[2]);
    *out = view;
    return true;
}

/* ---- what a frame says ------------------------------------------------------------------- */

#define PROJECTION "parhelion:projection"

void frame_set_fisheye(FrameImage *frame, Fisheye kind, Arena *arena) {
    frame_set_string(frame, PROJECTION,
                     arena_format(arena,
                                  "%s fisheye of 180 degrees; pixels outside its circle "
                                  "are black and have no samples",
                                  fisheye_name(kind)),
                     arena);
}

Fisheye frame_fisheye(const FrameImage *frame) {
    const char *text = frame_string(frame, PROJECTION);
    if (!text) return FISHEYE_NONE;
    return strncmp(text, "equisolid", 9) ? FISHEYE_EQUIDISTANT : FISHEYE_EQUISOLID;
}

/* Without the attribute the head's own axes: figures of one eye need no others. */
static void read_axes(const FrameImage *frame, FrameView *out) {
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
                        Error *err) {
    const ExrAttribute *a = frame_attribute(frame, name);
    *out = a->kind == EXR_STRING ? (double)NAN : a->values[0];
    return (*out > 0 && *out < most) || error_set(err, ERROR_INPUT,
                                                  "%s is %g, required: a number between 0 and "
                                                  "%g",
                                                  name, *out, most);
}

bool frame_view_find(const FrameImage *frame, FrameView *out, Error *err) {
    const char *words = frame_string(frame, "VIEW");
    FrameView view = {.is_perspective = true,
                      .fisheye = frame_fisheye(frame),
                      .width = frame->display.x1 - frame->display.x0,
                      .height = frame->display.y1 - frame->display.y0};
    double aspect = (double)view.width / view.height, high;
    if (words) return parse_words(words, view.width, view.height, out, err);
    if (view.fisheye) {
        view.half_height = aspect < 1 ? 1 / aspect : 1;
    } else if (frame_attribute(frame, "parhelion:ymag_m")) {
        view.is_perspective = false;
        if (!read_number(frame, "parhelion:ymag_m", 1e9, &view.half_height, err)) return false;
    } else if (frame_attribute(frame, "parhelion:yfov_deg")) {
        if (!read_number(frame, "parhelion:yfov_deg", 180, &high, err)) return false;
        view.half_height = tan_d(radians_from_degrees(high) / 2);
    } else {
        return error_set(err, ERROR_INPUT,
                         "does not say its view (parhelion:projection, "
                         "parhelion:yfov_deg; VIEW= of a Radiance picture)");
    }
    view.half_width = view.half_height * aspect;
    read_axes(frame, &view);
    *out = view;
    return true;
}

FrameView frame_view_circle(const FrameImage *frame) {
    FrameView view;
    Error unused;
    return frame_view_find(frame, &view, &unused) ? view : (FrameView){.width = 0};
}

/* ---- pixels ------------------------------------------------------------------------------ */

/* A place of the picture's plane: right and up in the units of half_width. */
typedef struct PlanePlace {
    double x, y;
} PlanePlace;

static PlanePlace place_of(const FrameView *view, double x, double y) {
    return (PlanePlace){(2 * x / view->width - 1 + 2 * view->shift[0]) * view->half_width,
                        (1 - 2 * y / view->height + 2 * view->shift[1]) * view->half_height};
}

static double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

bool frame_view_sees(const FrameView *view, int x, int y) {
    if (!view->fisheye) return true;
    double middle_x = (0.5 - view->shift[0]) * view->width;
    double middle_y = (0.5 + view->shift[1]) * view->height;
    PlanePlace near = place_of(view, clamp(middle_x, x, x + 1), clamp(middle_y, y, y + 1));
    return near.x * near.x + near.y * near.y < 1;
}

/* 1 - cos a and sin^2 a / 2 over the square of the radius. */
static void over_square(const FrameView *view, double square, double out[2]) {
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
static void add_seen(const FrameView *view, PlanePlace a, PlanePlace b, double out[2]) {
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
static void add_unseen(PlanePlace a, PlanePlace b, double out[2]) {
    double turn = atan2_d(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    out[0] += turn;
    out[1] += 0.5 * turn;
}

/* Where the edge crosses the circle; 0 and 1 where it does not. */
static void crossings(PlanePlace a, PlanePlace b, double at[2]) {
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double half = (a.x * dx + a.y * dy) / square;
    double root = half * half - (a.x * a.x + a.y * a.y - 1) / square;
    at[0] = root > 0 ? clamp(-half - sqrt(root), 0, 1) : 0;
    at[1] = root > 0 ? clamp(-half + sqrt(root), 0, 1) : 0;
}

static void add_edge(const FrameView *view, PlanePlace a, PlanePlace b, double out[2]) {
    double at[2] = {0, 1};
    if (view->fisheye) crossings(a, b, at);
    PlanePlace in = {a.x + at[0] * (b.x - a.x), a.y + at[0] * (b.y - a.y)};
    PlanePlace away = {a.x + at[1] * (b.x - a.x), a.y + at[1] * (b.y - a.y)};
    if (at[0] > 0) add_unseen(a, in, out);
    if (at[1] > at[0]) add_seen(view, in, away, out);
    if (at[1] < 1) add_unseen(away, b, out);
}

#define RIM (1 - 1e-9) /* still before the eye */

static void direction_of(const FrameView *view, PlanePlace at, double out[3]) {
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

ViewPixel frame_view_pixel(const FrameView *view, int x, int y) {
    static const int CORNERS[5][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}};
    ViewPixel out;
    double sums[2] = {0, 0};
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

/* ---- Radiance's words, written ----------------------------------------------------------- */

/* The full size of part `share` of the view, as -vh and -vv have it. */
static double size_of(const FrameView *view, double half, double share) {
    if (view->fisheye) return 180 * half * share;
    if (!view->is_perspective) return 2 * half * share;
    return 2 * degrees_from_radians(atan2_d(half * share, 1));
}

bool frame_view_words(const FrameView *view, ExrWindow crop, Arena *arena, const char **out,
                      Error *err) {
    double wide = (double)(crop.x1 - crop.x0) / view->width;
    double high = (double)(crop.y1 - crop.y0) / view->height;
    double right = (0.5 * (crop.x0 + crop.x1) / view->width - 0.5 + view->shift[0]) / wide;
    double up = (0.5 - 0.5 * (crop.y0 + crop.y1) / view->height + view->shift[1]) / high;
    char type = view->fisheye ? 'a' : view->is_perspective ? 'v' : 'l';
    const double *p = view->eye, *d = view->ahead, *u = view->up;
    if (view->fisheye == FISHEYE_EQUISOLID)
        return error_set(err, ERROR_USAGE,
                         "Radiance has no equisolid views: required: "
                         "--projection equidistant, or a file that ends in .exr");
    *out = arena_format(arena,
                        "-vt%c -vp %.9g %.9g %.9g -vd %.9g %.9g %.9g -vu %.9g %.9g %.9g "
                        "-vh %.9g -vv %.9g -vo 0 -va 0 -vs %.9g -vl %.9g",
                        type, p[0], p[1], p[2], d[0], d[1], d[2], u[0], u[1], u[2],
                        size_of(view, view->half_width, wide),
                        size_of(view, view->half_height, high), right, up);
    return true;
}
