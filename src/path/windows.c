/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/windows.h"

#include <string.h>

#include "base/mathf.h"
#include "scene/point/ray_ends.h"

#define SHEET_SHARE 0.5f /* of an eye's samples that follow what a thin sheet itself shows */
#define OFF_PANE 0.05f   /* of an image's shift: by which its ray starts off along its way */

/* ---- images of panes --------------------------------------------------------------------- */

/* The point `along` m along the surface from the hit, towards wi: images of a pane's far face
 * start there, and what is seen through a pane goes on there. A pane may be curved: the ray
 * starts a little along its way. */
static Vec3 beside(const Surface *surface, Vec3 wi, float along) {
    Vec3 n = surface->frame.z;
    Vec3 towards = vec3_normalize(vec3_along(wi, n, -vec3_dot(wi, n)));
    Vec3 place = vec3_along(ray_start(&surface->point, wi), towards, along);
    return vec3_along(place, wi, OFF_PANE * fabsf(along));
}

/* It may start under the pane's frame or beyond its rim. Tested along the ray: a pane goes on
 * under its seal. */
bool pane_image_start(const PathState *path, const Surface *surface, Vec3 wi, float along,
                      Vec3 *out) {
    float cosine = vec3_dot(wi, surface->frame.z), flat2 = 1 - cosine * cosine;
    float reach = along * (1 / sqrtf(max_f(flat2, 1e-6f)) + 2 * OFF_PANE); /* and a little */
    Ray ray = {ray_start(&surface->point, wi), wi, 0, reach};
    path->statistics->shadow_rays++;
    *out = beside(surface, wi, along);
    return !bvh_occluded(path->context->bvh, ray, sheets_let_pass, NULL);
}

/* Only the eye's own view through a pane is shifted: no light sample has found it. */
static void start_behind_pane(PathState *path, const Surface *surface) {
    Vec3 way = path->ray.direction;
    float cosine = fabsf(vec3_dot(surface->frame.z, way));
    float shift = bsdf_shift(&surface->bsdf, cosine);
    if (shift != 0) path->ray.origin = beside(surface, way, shift);
}

/* ---- straight on ------------------------------------------------------------------------- */

void sheet_go_behind(PathState *path, const Surface *surface) {
    collect_behind(path, surface);
    Vec3 direction = path->ray.direction, ng = surface->ng;
    float cosine = fabsf(vec3_dot(ng, direction));
    if (path->stack->next < path->stack->count) return;
    if (surface->plate) {
        path->ray = (Ray){surface->plate->start, direction, 0, INFINITY};
        path->straight += surface->plate->inside;
        path->sheets_from = 0;
        path->by_plates = true;
        return;
    }
    path->sheets_from =
        path->stack->count ? 2 * ray_step(&surface->point) / max_f(cosine, 1e-6f) : 0;
    Vec3 side = path->stack->count ? vec3_neg(direction) : direction;
    path->ray = (Ray){ray_start(&surface->point, side), direction, 0, INFINITY};
    if (!path->bounce && !path->stack->count) start_behind_pane(path, surface);
}

void plate_meet(const PathState *path, const Hit *hit, Vec3 way, Surface *surface, Plate *plate) {
    PlateView view = plate_view(path->context, path->wavelengths);
    if (path->medium_id == NO_ID && plate_at(&view, surface, hit, way, plate))
        plate_be_pane(plate, surface);
}

/* ---- both ways --------------------------------------------------------------------------- */

static bool is_hole(const Surface *surface) {
    return surface->alpha > 0 && surface->alpha < 1;
}

static bool is_window(const Surface *surface) {
    return surface->alpha >= 1 && bsdf_is(&surface->bsdf, BSDF_IS_SHEET);
}

bool sheet_is_followed(PathState *path, const Surface *surface) {
    if (path->bounce != path->first_bounce || !path->splits_left ||
        !(is_hole(surface) || is_window(surface)))
        return false;
    path->splits_left--;
    return true;
}

/* Copies all of them into the room, one after the other. */
static PathCollector *copy_collectors(const PathCollector *from, char *room) {
    PathCollector *first = NULL, **link = &first;
    for (; from; from = from->next) {
        PathCollector *copy = memcpy(room, from, from->kind->size);
        room += (from->kind->size + 63) / 64 * 64;
        *link = copy;
        link = &copy->next;
    }
    *link = NULL;
    return first;
}

void sheet_branch(const PathState *path, SheetRoom *room, PathState *branch) {
    *branch = *path;
    branch->splits_left = 0;
    branch->first.is_awaited = false;
    branch->gathered = (PathLight){.radiance = spectrum_all(0)};
    branch->collector = copy_collectors(path->collector, room->collectors);
}

bool sheet_is_shown(PathState *path, const Surface *surface, SheetRoom *room, PathState *sheet) {
    float share = path->manner.has_sheets ? 1 : SHEET_SHARE; /* of samples that follow it */
    numbers_for(path, NUMBERS_SPLIT);
    if (!(sampler_1d(path->sampler) < share)) return false;
    sheet_branch(path, room, sheet);
    if (path->stack->count) room->stack = *path->stack;
    else sheets_none(&room->stack);
    sheet->stack = &room->stack;
    sheet->steps += STEPS_FAR * (1 + path->splits_left);
    sheet->throughput *= spectrum_all(surface->alpha / share);
    return true;
}

bool window_reflects(PathState *sheet, const Surface *surface, Vec3 wo, BsdfSample *mirror) {
    Vec3 local_wo = surface->local_wo;
    *mirror =
        (BsdfSample){.wi = vec3(-local_wo.x, -local_wo.y, local_wo.z), .is_delta = true, .pdf = 1};
    if (sheet->bounce >= sheet->context->max_bounces) return false;
    path_weigh(sheet, surface, bsdf_mirror(&surface->bsdf, local_wo));
    collect_leave(sheet, surface, wo, mirror);
    return true;
}

bool pane_shows_itself(const Surface *surface, Surface *pane) {
    *pane = *surface;
    return bsdf_show_itself(&pane->bsdf);
}

void sheet_pass(PathState *path, const Surface *surface, Vec3 wo) {
    if (is_hole(surface)) path->throughput *= spectrum_all(1 - surface->alpha);
    else path_weigh(path, surface, bsdf_pass(&surface->bsdf, surface->local_wo));
    if (is_window(surface)) collect_pass(path, surface, wo);
    sheet_go_behind(path, surface);
}
