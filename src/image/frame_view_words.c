/* SPDX-License-Identifier: Apache-2.0 */
/* Radiance's words of a view, both ways. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "image/frame_view.h"

/* ---- written ----------------------------------------------------------------------------- */

/* The full size of part `share` of the view, as -vh and -vv have it. */
static double size_of(const FrameView *view, double half, double share)
{
    if (view->fisheye) return 180 * half * share;
    if (!view->is_perspective) return 2 * half * share;
    return 2 * degrees_from_radians(atan2_d(half * share, 1));
}

bool frame_view_words(const FrameView *view, ExrWindow crop, Arena *arena, const char **out,
                      Error *err)
{
    double wide = (double)(crop.x1 - crop.x0) / view->width;
    double high = (double)(crop.y1 - crop.y0) / view->height;
    double right = (0.5 * (crop.x0 + crop.x1) / view->width - 0.5 + view->shift[0]) / wide;
    double up = (0.5 - 0.5 * (crop.y0 + crop.y1) / view->height + view->shift[1]) / high;
    char   type = view->fisheye ? 'a' : view->is_perspective ? 'v' : 'l';
    const double *p = view->eye, *d = view->ahead, *u = view->up;
    if (view->fisheye == FISHEYE_EQUISOLID)
        return error_set(err, ERROR_USAGE, "Radiance has no equisolid views: wanted "
                         "--projection equidistant, or a file that ends in .exr");
    *out = arena_format(arena, "-vt%c -vp %.9g %.9g %.9g -vd %.9g %.9g %.9g -vu %.9g %.9g %.9g "
                        "-vh %.9g -vv %.9g -vo 0 -va 0 -vs %.9g -vl %.9g", type, p[0], p[1],
                        p[2], d[0], d[1], d[2], u[0], u[1], u[2],
                        size_of(view, view->half_width, wide),
                        size_of(view, view->half_height, high), right, up);
    return true;
}

/* ---- read -------------------------------------------------------------------------------- */

/* Options as they are found; rpict's defaults. */
typedef struct ViewWords {
    char   type;
    double p[3], d[3], u[3], h, v, s, l, o, a;
} ViewWords;

/* Numbers of one option; NULL: it has none such. */
static double *slot_of(ViewWords *words, char letter, int *count)
{
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

static bool read_numbers(const char **at, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        char *end;
        out[i] = strtod(*at, &end);
        if (end == *at || !isfinite(out[i])) return false;
        *at = end;
    }
    return true;
}

/* Words that are no options of a view are a program's name: "rvu -vtv ...". */
static bool read_words(const char *text, ViewWords *out, Error *err)
{
    const char *at = text;
    while (at += strspn(at, " \t"), *at) {
        const char *word = at;
        size_t      length = strcspn(at, " \t");
        int         count;
        at += length;
        if (length < 3 || strncmp(word, "-v", 2) != 0) continue;
        if (word[2] == 't' && length == 4) {
            out->type = word[3];
            continue;
        }
        double *slot = length == 3 ? slot_of(out, word[2], &count) : NULL;
        if (!slot || !read_numbers(&at, count, slot))
            return error_set(err, ERROR_INPUT, "VIEW=: '%.40s', wanted an option of a view with "
                             "its numbers", word);
    }
    return true;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) v[i] /= length;
    return isfinite(length) && length > 1e-12;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static bool set_axes(const ViewWords *words, FrameView *out)
{
    memcpy(out->eye, words->p, sizeof out->eye);
    memcpy(out->ahead, words->d, sizeof out->ahead);
    if (!normalize(out->ahead)) return false;
    cross(out->ahead, words->u, out->right);
    if (!normalize(out->right)) return false;
    cross(out->right, out->ahead, out->up);
    return true;
}

/* Half of -vh or -vv in the units of half_width; 0: no such view. */
static double half_of(char type, double size)
{
    if (!(size > 0)) return 0;
    if (type == 'a') return size <= 360 ? size / 180 : 0;
    if (type == 'l') return size / 2;
    return size < 180 ? tan_d(radians_from_degrees(size) / 2) : 0;
}

bool frame_view_parse(const char *words, int width, int height, FrameView *out, Error *err)
{
    ViewWords in = {.type = 'v', .d = {0, 1, 0}, .u = {0, 0, 1}, .h = 45, .v = 45};
    if (!read_words(words, &in, err)) return false;
    FrameView view = {.is_perspective = in.type != 'l',
                      .fisheye = in.type == 'a' ? FISHEYE_EQUIDISTANT : FISHEYE_NONE,
                      .half_width = half_of(in.type, in.h),
                      .half_height = half_of(in.type, in.v), .shift = {in.s, in.l},
                      .width = width, .height = height};
    if (!strchr("val", in.type))
        return error_set(err, ERROR_INPUT, "VIEW=: -vt%c, wanted -vta (angular fisheye), -vtv "
                         "(perspective) or -vtl (parallel)", in.type);
    if (!(view.half_width > 0) || !(view.half_height > 0))
        return error_set(err, ERROR_INPUT, "VIEW=: -vh %g -vv %g of -vt%c, wanted %s", in.h,
                         in.v, in.type, in.type == 'a' ? "angles up to 360 degrees"
                         : in.type == 'v' ? "angles below 180 degrees" : "sizes above 0");
    if (!set_axes(&in, &view))
        return error_set(err, ERROR_INPUT, "VIEW=: -vd %g %g %g -vu %g %g %g, wanted two "
                         "directions that are not along one line", in.d[0], in.d[1], in.d[2],
                         in.u[0], in.u[1], in.u[2]);
    *out = view;
    return true;
}
