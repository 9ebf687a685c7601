/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/symbol_sight.h"

#include <math.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "scene/point/ray_ends.h"

#define COLUMNS 9
#define MOST_PIXELS 20000
#define HIDES_BELOW 0.01f /* of the light that passes */

/* ---- height ------------------------------------------------------------------------------ */

typedef struct Arrow {
    double x, y, z;
} Arrow;

static Arrow arrow(Vec3 from, Vec3 to) {
    return (Arrow){(double)to.x - (double)from.x, (double)to.y - (double)from.y,
                   (double)to.z - (double)from.z};
}

/* By sine and cosine: small angles keep their digits. */
static double angle_between(Arrow a, Arrow b) {
    double x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x;
    return atan2_d(sqrt(x * x + y * y + z * z), a.x * b.x + a.y * b.y + a.z * b.z);
}

double symbol_height_arcmin(const SymbolSurface *surface, const double box[4], Vec3 eye) {
    double sum = 0;
    for (int k = 0; k < COLUMNS; k++) {
        double u = box[0] + (k + 0.5) / COLUMNS * (box[2] - box[0]);
        SymbolPoint top, bottom;
        if (!symbol_surface_at(surface, (double[2]){u, box[1]}, &top) ||
            !symbol_surface_at(surface, (double[2]){u, box[3]}, &bottom))
            return (double)NAN;
        sum += angle_between(arrow(eye, top.position), arrow(eye, bottom.position));
    }
    return 60 * degrees_from_radians(sum / COLUMNS);
}

/* ---- what is seen of it ------------------------------------------------------------------ */

typedef struct SightQuestion {
    const PathContext *context;
    const Wavelengths *wavelengths;
    Vec3 direction; /* of the look */
    Spectrum passed;
} SightQuestion;

static float luminous(const Wavelengths *wavelengths, const Spectrum *passed) {
    return spectrum_sum(*passed * wavelengths->xyz[1]) / spectrum_sum(wavelengths->xyz[1]);
}

static bool passes(void *user, const Hit *hit) {
    SightQuestion *question = user;
    const PathContext *context = question->context;
    question->passed *= surface_pass(context->scene, context->tables, hit, question->direction,
                                     question->wavelengths);
    return luminous(question->wavelengths, &question->passed) >= HIDES_BELOW;
}

static bool faces(const SymbolPoint *point, Vec3 eye) {
    return vec3_dot(vec3_sub(point->position, eye), point->ng) < 0;
}

/* From the eye to just before the point: a bezel may lie closely over the display. */
static Ray look_at(const Scene *scene, const SymbolPoint *point, Vec3 eye) {
    TrianglePoint at = triangle_point(scene, point->triangle, point->u, point->v);
    return ray_to(eye, &at, vec3_sub(eye, point->position));
}

/* Solid plates shift a look: it goes back from its end, where it must be exact, and misses the
 * eye by about a third of their thickness. */
static bool is_stopped(const Ray *ray, SightQuestion *question) {
    const PathContext *context = question->context;
    question->direction = ray->direction;
    if (!bvh_occluded(context->bvh, *ray, passes, question)) return false;
    PlateWay way = {
        .view = plate_view(context, question->wavelengths), .passes = passes, .user = question};
    Ray back = *ray;
    if (isfinite(ray->t_max))
        back = (Ray){vec3_along(ray->origin, ray->direction, ray->t_max), vec3_neg(ray->direction),
                     0, ray->t_max};
    question->direction = back.direction;
    question->passed = spectrum_all(1);
    if (!plates_follow(&way, back)) return true;
    question->passed *= way.passed;
    return luminous(question->wavelengths, &question->passed) < HIDES_BELOW;
}

float symbol_point_passed(const SymbolPoint *point, const PathContext *context,
                          const Wavelengths *wavelengths, Vec3 eye, Spectrum *by_lane) {
    SightQuestion question = {
        .context = context, .wavelengths = wavelengths, .passed = spectrum_all(1)};
    Ray look = look_at(context->scene, point, eye);
    if (!faces(point, eye) || is_stopped(&look, &question)) return 0;
    if (by_lane) *by_lane = question.passed;
    return luminous(wavelengths, &question.passed);
}

#define TINT 1e-5 /* of the light: by less wavelengths differ in rounding alone */

/* Sums of what passes in one set of wavelengths, over points by their areas. */
typedef struct PassedSums {
    double seen, passed, nm[SPECTRUM_LANES], by_lane[SPECTRUM_LANES];
} PassedSums;

/* False: it is hidden. */
static bool add_passed(const SymbolPoint *point, const PathContext *context, Vec3 eye, float offset,
                       PassedSums *to) {
    Spectrum by_lane = spectrum_all(1);
    Wavelengths wavelengths;
    wavelengths_sample(offset, &wavelengths);
    double share = (double)symbol_point_passed(point, context, &wavelengths, eye, &by_lane);
    if (!(share > 0)) return false;
    to->seen += (double)point->area_m2;
    to->passed += share * (double)point->area_m2;
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        to->nm[k] = (double)wavelengths.nm[k];
        to->by_lane[k] += (double)by_lane[k] * (double)point->area_m2;
    }
    return true;
}

static bool is_tinted(const PassedSums *sums) {
    for (int k = 0; k < SPECTRUM_LANES; k++)
        if (fabs(sums->by_lane[k] - sums->passed) > TINT * sums->passed) return true;
    return false;
}

#define STRATA 16 /* of SPECTRUM_LANES wavelengths each: steps of 1 to 2 nm */

static void set_way(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                    Curve *out) {
    double nm[STRATA * SPECTRUM_LANES], share[STRATA * SPECTRUM_LANES];
    for (int s = 0; s < STRATA; s++) {
        PassedSums sums = {0};
        for (int i = 0; i < surface->point_count; i++)
            add_passed(&surface->points[i], context, eye, ((float)s + 0.5f) / STRATA, &sums);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            nm[k * STRATA + s] = sums.nm[k];
            share[k * STRATA + s] = sums.by_lane[k] / sums.seen;
        }
    }
    curve_from_points(nm, share, STRATA * SPECTRUM_LANES, out);
}

SymbolVisibility symbol_visibility(const SymbolSurface *surface, const PathContext *context,
                                   Vec3 eye, bool *is_visible) {
    PassedSums sums = {0};
    for (int i = 0; i < surface->point_count; i++) {
        bool is_seen = add_passed(&surface->points[i], context, eye, 0.5f, &sums);
        if (is_visible) is_visible[i] = is_seen;
    }
    SymbolVisibility out = {.visible_share = sums.seen / surface->area_m2,
                            .transmittance = sums.passed / sums.seen,
                            .is_tinted = is_tinted(&sums)};
    if (out.is_tinted) set_way(surface, context, eye, &out.way);
    return out;
}

/* The first part that hides a look, which must be hidden. */
static uint32_t hiding_part(Ray look, SightQuestion *question) {
    const Scene *scene = question->context->scene;
    uint32_t part = 0;
    Hit hit;
    question->passed = spectrum_all(1);
    while (bvh_intersect(question->context->bvh, look, 0, &hit)) {
        PlateView view = plate_view(question->context, question->wavelengths);
        Surface face;
        Plate plate;
        part = scene->triangles[hit.triangle].part_id;
        surface_at(scene, view.tables, &hit, vec3_neg(look.direction), view.wavelengths, &face);
        bool is_plate = plate_at(&view, &face, &hit, look.direction, &plate);
        if (is_plate) question->passed *= plate.pane.passed;
        if (is_plate ? luminous(view.wavelengths, &question->passed) < HIDES_BELOW
                     : hit.triangle < scene->opaque_count || !passes(question, &hit))
            break;
        look = is_plate ? ray_from_plate(look, &plate) : ray_behind(scene, look, &hit);
    }
    return part;
}

SymbolHiding symbol_hiding(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                           Arena *arena) {
    const Scene *scene = context->scene;
    SymbolHiding hiding = {ARENA_NEW(arena, double, scene->part_count), 0};
    Wavelengths wavelengths;
    wavelengths_sample(0.5f, &wavelengths);
    for (int i = 0; i < surface->point_count; i++) {
        const SymbolPoint *point = &surface->points[i];
        double share = (double)point->area_m2 / surface->area_m2;
        SightQuestion question = {
            .context = context, .wavelengths = &wavelengths, .passed = spectrum_all(1)};
        Ray look = look_at(scene, point, eye);
        if (!faces(point, eye)) hiding.turned_away += share;
        else if (is_stopped(&look, &question))
            hiding.by_part[hiding_part(look, &question)] += share;
    }
    return hiding;
}

#define INSET 0.01 /* of a patch: the rim of a display may lie on its own corners */

static bool sees_corners(const SymbolSurface *surface, const double box[4],
                         const PathContext *context, Vec3 eye) {
    Wavelengths wavelengths;
    wavelengths_sample(0.5f, &wavelengths);
    for (int k = 0; k < 4; k++) {
        double u = k & 1 ? 1 - INSET : INSET, v = k & 2 ? 1 - INSET : INSET;
        double uv[2] = {box[0] + u * (box[2] - box[0]), box[1] + v * (box[3] - box[1])};
        SymbolPoint corner;
        if (!symbol_surface_at(surface, uv, &corner) ||
            !(symbol_point_passed(&corner, context, &wavelengths, eye, NULL) > 0))
            return false;
    }
    return true;
}

SymbolPatch symbol_patch_seen(const SymbolSurface *surface, int point, const PathContext *context,
                              Vec3 eye) {
    double box[4];
    if (symbol_patch_box(surface, point, box) && sees_corners(surface, box, context, eye))
        return symbol_patch(surface, point);
    return (SymbolPatch){.middle = surface->points[point].position};
}

bool symbol_box_seen(const SymbolSurface *surface, const double uv[4], const PathContext *context,
                     Vec3 eye, SymbolPatch *out) {
    const double at[2] = {0.5 * (uv[0] + uv[2]), 0.5 * (uv[1] + uv[3])};
    SymbolPoint middle;
    Wavelengths wavelengths;
    wavelengths_sample(0.5f, &wavelengths);
    if (!symbol_surface_at(surface, at, &middle) ||
        !(symbol_point_passed(&middle, context, &wavelengths, eye, NULL) > 0))
        return false;
    *out = sees_corners(surface, uv, context, eye) ? symbol_patch_of(surface, uv, middle.position)
                                                   : (SymbolPatch){.middle = middle.position};
    return true;
}

static bool is_lit(const SymbolPoint *point, const PathContext *context,
                   const Wavelengths *wavelengths, Vec3 towards) {
    SightQuestion question = {
        .context = context, .wavelengths = wavelengths, .passed = spectrum_all(1)};
    Ray ray = {symbol_point_start(context->scene, point), towards, 0, INFINITY};
    return vec3_dot(towards, point->ng) > 0 && !is_stopped(&ray, &question);
}

double symbol_lit_share(const SymbolSurface *surface, const bool *is_visible,
                        const PathContext *context, Vec3 towards) {
    double lit = 0, visible = 0;
    Wavelengths wavelengths;
    wavelengths_sample(0.5f, &wavelengths);
    for (int i = 0; i < surface->point_count; i++) {
        const SymbolPoint *point = &surface->points[i];
        if (!is_visible[i]) continue;
        visible += (double)point->area_m2;
        if (is_lit(point, context, &wavelengths, towards)) lit += (double)point->area_m2;
    }
    return lit / visible;
}

/* ---- light ------------------------------------------------------------------------------- */

/* Adds the XYZ that the pixel sends to the eye; false: it turns its back. */
static bool add_pixel(const SymbolSurface *surface, const ContentLight *light, size_t pixel,
                      Vec3 eye, double sum[3]) {
    const Scene *scene = surface->scene;
    const Display *display = &scene->displays[surface->display_id];
    int x = light->x + (int)(pixel % (size_t)light->width);
    int y = light->y + (int)(pixel / (size_t)light->width);
    double uv[2] = {(x + 0.5) / light->content_width, (y + 0.5) / light->content_height};
    float codes[3], xyz[3];
    SymbolPoint at;
    if (!symbol_surface_at(surface, uv, &at)) return false;
    Vec3 to_eye = vec3_normalize(vec3_sub(eye, at.position));
    if (!(vec3_dot(to_eye, at.ng) > 0)) return false;
    TrianglePoint point = triangle_point(scene, at.triangle, at.u, at.v);
    Frame frame = display_frame(scene, display, at.triangle, &point);
    content_codes(light->content, x, y, codes);
    display_panel_xyz(display, &point, frame_to_local(&frame, to_eye), codes, xyz);
    for (int k = 0; k < 3; k++) sum[k] += (double)xyz[k];
    return true;
}

#define EMISSION_PIECES 32

/* Pixels of one class, in pieces, so that the sum is the same for any number of threads. */
typedef struct ClassWork {
    const SymbolSurface *surface;
    const ContentLight *light;
    Vec3 eye;
    uint32_t pixels[MOST_PIXELS];
    long count;
    double sum[EMISSION_PIECES][3];
    long counted[EMISSION_PIECES];
} ClassWork;

static void add_piece(void *user, int piece, int worker) {
    (void)worker;
    ClassWork *work = user;
    long first = piece * work->count / EMISSION_PIECES;
    long end = (piece + 1) * work->count / EMISSION_PIECES;
    for (long i = first; i < end; i++)
        work->counted[piece] +=
            add_pixel(work->surface, work->light, work->pixels[i], work->eye, work->sum[piece]);
}

static void list_pixels(const SymbolSplit *split, SymbolClass which, ClassWork *work) {
    size_t all = (size_t)split->light.width * (size_t)split->light.height;
    long of_class = which == SYMBOL_FOREGROUND ? split->foreground_count : split->background_count;
    long wanted = of_class < MOST_PIXELS ? of_class : MOST_PIXELS;
    long met = 0;
    for (size_t i = 0; i < all; i++) {
        if (split->class_of[i] != which) continue;
        if (met++ != (2 * work->count + 1) * of_class / (2 * wanted)) continue;
        work->pixels[work->count++] = (uint32_t)i;
    }
}

static void mean_of_class(const SymbolLook *look, SymbolClass which, double xyz[3]) {
    ClassWork work = {.surface = look->surface, .light = &look->split->light, .eye = look->eye};
    long counted = 0;
    list_pixels(look->split, which, &work);
    parallel_for(look->threads, EMISSION_PIECES, add_piece, &work);
    for (int k = 0; k < 3; k++) xyz[k] = 0;
    for (int i = 0; i < EMISSION_PIECES; i++) {
        counted += work.counted[i];
        for (int k = 0; k < 3; k++) xyz[k] += work.sum[i][k];
    }
    for (int k = 0; k < 3; k++) xyz[k] /= (double)counted;
}

#define COLOUR_PIXELS 64 /* of a class: it shows few colours */

/* Adds a pixel's XYZ behind one glass, or none, and behind both. */
static void add_coloured(const SymbolLook *look, uint32_t pixel, const Curve *const glass[2],
                         double sum[2][3]) {
    const Scene *scene = look->surface->scene;
    const ContentLight *light = &look->split->light;
    int x = light->x + (int)(pixel % (uint32_t)light->width);
    int y = light->y + (int)(pixel / (uint32_t)light->width);
    double uv[2] = {(x + 0.5) / light->content_width, (y + 0.5) / light->content_height};
    SymbolPoint at;
    if (!symbol_surface_at(look->surface, uv, &at)) return;
    Vec3 way = vec3_normalize(vec3_sub(look->eye, at.position));
    TrianglePoint point = triangle_point(scene, at.triangle, at.u, at.v);
    for (int i = 0; i < STRATA; i++) {
        Wavelengths w;
        wavelengths_sample(((float)i + 0.5f) / STRATA, &w);
        Spectrum sent = triangle_emission(scene, at.triangle, &point, way, &w);
        for (int j = 0; j < 2; j++) {
            if (glass[j]) sent *= curve_lookup(glass[j], &w);
            for (int k = 0; k < 3; k++) sum[j][k] += (double)spectrum_mean(sent * w.xyz[k]);
        }
    }
}

/* Of a class that emits nothing all passes. */
static void pass_glass(const SymbolLook *look, const Curve *before, const Curve *glass,
                       SymbolEmission *emission) {
    for (SymbolClass which = SYMBOL_BACKGROUND; which <= SYMBOL_FOREGROUND; which++) {
        ClassWork work = {.surface = look->surface, .light = &look->split->light, .eye = look->eye};
        double sum[2][3] = {{0}};
        list_pixels(look->split, which, &work);
        long step = work.count / COLOUR_PIXELS + 1;
        for (long i = 0; i < work.count; i += step)
            add_coloured(look, work.pixels[i], (const Curve *[2]){before, glass}, sum);
        for (int k = 0; k < 3; k++)
            emission->xyz[which][k] *= sum[0][k] > 0 ? sum[1][k] / sum[0][k] : 1;
    }
}

SymbolEmission symbol_emission(const SymbolLook *look, double level) {
    const SymbolVisibility *through = look->through;
    double lets = through && !through->is_tinted ? through->transmittance : 1;
    SymbolEmission out;
    for (SymbolClass which = SYMBOL_BACKGROUND; which <= SYMBOL_FOREGROUND; which++) {
        mean_of_class(look, which, out.xyz[which]);
        for (int k = 0; k < 3; k++) out.xyz[which][k] *= level, out.xyz[which][k] *= lets;
    }
    if (through && through->is_tinted) pass_glass(look, NULL, &through->way, &out);
    return out;
}

void symbol_emission_behind(const SymbolLook *look, const Curve *colour, SymbolEmission *emission) {
    const SymbolVisibility *through = look->through;
    pass_glass(look, through && through->is_tinted ? &through->way : NULL, colour, emission);
}

/* ---- behind glasses ---------------------------------------------------------------------- */

static double polarised_at(const SymbolPoint *point, const PathContext *context, Vec3 eye,
                           const PolarisedEye *polariser) {
    const Scene *scene = context->scene;
    Ray look = look_at(scene, point, eye);
    Vec3 wo = vec3_neg(look.direction);
    Wavelengths wavelengths;
    Polarised light;
    Hit hit;
    wavelengths_sample(0.5f, &wavelengths);
    PlateView view = plate_view(context, &wavelengths);
    polarised_start(polariser, look.direction, &light);
    while (bvh_intersect(context->bvh, look, 0, &hit) && hit.triangle != point->triangle) {
        Surface pane;
        Plate plate;
        surface_at(scene, context->tables, &hit, wo, &wavelengths, &pane);
        bool is_plate = plate_at(&view, &pane, &hit, look.direction, &plate);
        if (is_plate) plate_be_pane(&plate, &pane);
        polarised_pass(&light, &pane, wo);
        look = is_plate ? ray_from_plate(look, &plate) : ray_behind(scene, look, &hit);
    }
    TrianglePoint at = triangle_point(scene, point->triangle, point->u, point->v);
    PolarisedLight from;
    float degree;
    bool is_polarised = triangle_polarisation(scene, point->triangle, &at, wo, &from.axis, &degree);
    if (is_polarised) from.degree = spectrum_all(degree);
    return (double)spectrum_mean(polarised_take(&light) *
                                 polarised_seen(&light, 0, wo, is_polarised ? &from : NULL));
}

double symbol_polarised_share(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                              const PolarisedEye *polariser) {
    double sum = 0, area = 0;
    Wavelengths wavelengths;
    wavelengths_sample(0.5f, &wavelengths);
    for (int i = 0; i < surface->point_count; i++) {
        const SymbolPoint *point = &surface->points[i];
        if (!(symbol_point_passed(point, context, &wavelengths, eye, NULL) > 0)) continue;
        sum += (double)point->area_m2 * polarised_at(point, context, eye, polariser);
        area += (double)point->area_m2;
    }
    return area > 0 ? sum / area : 1;
}
