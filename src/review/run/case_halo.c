/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/case_halo.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "light/emission.h"
#include "panel/query/panel_zones.h"
#include "review/symbol/symbol_sight.h"
#include "scene/point/display_frame.h"
#include "vision/eye_spread.h"
#include "vision/visibility.h"

#define SIDE 32       /* cells along each side */
#define FINE 3        /* looks along each side of a cell: strokes are thinner than cells */
#define SPREADS 3.0   /* how far around the symbol */
#define SCATTER_LEAST_DEG 0.1 /* the eye's spread is known from there on */

typedef struct HaloCell {
    Vec3   towards;       /* from the eye, unit */
    double shown, black;  /* cd m^-2 at the eye */
    double sr;            /* 0: not seen */
} HaloCell;

typedef struct HaloGrid {
    const HaloLook *look;
    const Scene    *scene;
    const Display  *display;
    SymbolSurface   surface;
    double          level;
    HaloCell        cell[SIDE * SIDE];
} HaloGrid;

/* How far a zone's light goes, as a share of the width or height of the active area. */
static double spread_share(const DimmingZones *zones, int k)
{
    double mm = zones->sigma_mm;
    if (!(mm > 0)) { /* of a table: where half of it is left */
        for (int i = 0; i < zones->spread.rows; i++) {
            mm = zones->spread.at[i];
            if (zones->spread.value[i] <= 0.5 * zones->spread.value[0]) break;
        }
    }
    return mm / zones->size_mm[k];
}

/* The rectangle of uv that is looked at: within the active area. */
static void area_around(const HaloGrid *grid, double uv[4])
{
    const float  *m = grid->display->place_from_uv;
    const double *own = grid->look->symbol->uv;
    for (int k = 0; k < 2; k++) {
        double scale = (double)m[2 * k], shift = (double)m[2 * k + 1];
        double far = SPREADS * spread_share(panel_zones(grid->display->panel), k) / scale;
        uv[k] = fmax(own[k] - far, -shift / scale);
        uv[2 + k] = fmin(own[2 + k] + far, (1 - shift) / scale);
    }
}

/* Y towards the eye of what a place shows, and of its black; false: it is not there, or turns
 * its back. */
static bool look_at(const HaloGrid *grid, const double uv[2], double y[2], Vec3 *at)
{
    static const float black[3] = {0, 0, 0};
    const Display *display = grid->display;
    SymbolPoint    found;
    float          codes[3], xyz[2][3];
    if (!symbol_surface_at(&grid->surface, uv, &found)) return false;
    Vec3 to_eye = vec3_normalize(vec3_sub(grid->look->eye, found.position));
    if (!(vec3_dot(to_eye, found.ng) > 0)) return false;
    TrianglePoint point = triangle_point(grid->scene, found.triangle, found.u, found.v);
    Frame         frame = display_frame(grid->scene, display, found.triangle, &point);
    Vec3          local = frame_to_local(&frame, to_eye);
    display_codes(grid->scene, display, &point, codes);
    display_panel_xyz(display, &point, local, codes, xyz[0]);
    display_panel_xyz(display, &point, local, black, xyz[1]);
    for (int i = 0; i < 2; i++)
        y[i] = (double)xyz[i][1] * grid->level * grid->look->transmittance;
    *at = found.position;
    return true;
}

/* Means over a cell of uv. */
static HaloCell cell_of(const HaloGrid *grid, const double box[4])
{
    HaloCell out = {.sr = 0};
    Vec3     middle = vec3(0, 0, 0), at;
    for (int i = 0; i < FINE * FINE; i++) {
        double y[2], uv[2] = {box[0] + (box[2] - box[0]) * (i % FINE + 0.5) / FINE,
                              box[1] + (box[3] - box[1]) * (i / FINE + 0.5) / FINE};
        if (!look_at(grid, uv, y, &at)) return (HaloCell){.sr = 0};
        out.shown += y[0] / (FINE * FINE);
        out.black += y[1] / (FINE * FINE);
        if (i == FINE * FINE / 2) middle = at;
    }
    SymbolPatch patch = symbol_patch_of(&grid->surface, box, middle);
    Vec3   seen = vec3_sub(middle, grid->look->eye), area = vec3_cross(patch.along, patch.down);
    double squares = (double)vec3_dot(seen, seen);
    out.towards = vec3_normalize(seen);
    out.sr = fabs((double)vec3_dot(area, out.towards)) / squares;
    return out;
}

/* Stray light of all cells at the retina's place of one. */
static double scattered_at(const HaloGrid *grid, const HaloCell *at)
{
    double veil = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const HaloCell *from = &grid->cell[i];
        if (from == at || !(from->sr * from->shown > 0)) continue;
        double cosine = fmin(1, (double)vec3_dot(from->towards, at->towards));
        double angle = degrees_from_radians(acos_d(cosine));
        veil += from->shown * from->sr * cosine *
                eye_spread_at(fmax(angle, SCATTER_LEAST_DEG), grid->look->observer);
    }
    return veil;
}

/* Of a patch as wide as two spreads, as the eye sees it. */
static double patch_arcmin(const HaloGrid *grid, const double uv[4])
{
    const double  mid = 0.5 * (uv[1] + uv[3]);
    const double  ends[2][2] = {{uv[0] + 1e-6, mid}, {uv[2] - 1e-6, mid}};
    double        y[2];
    Vec3          at[2];
    for (int i = 0; i < 2; i++)
        if (!look_at(grid, ends[i], y, &at[i])) return (double)NAN;
    Vec3   a = vec3_normalize(vec3_sub(at[0], grid->look->eye));
    Vec3   b = vec3_normalize(vec3_sub(at[1], grid->look->eye));
    double whole = atan2((double)vec3_length(vec3_cross(a, b)), (double)vec3_dot(a, b));
    double share = 2 * spread_share(panel_zones(grid->display->panel), 0) /
                   ((double)grid->display->place_from_uv[0] * (ends[1][0] - ends[0][0]));
    return fmin(60 * degrees_from_radians(whole * share), VISIBILITY_SIZE_LARGE);
}

/* One cell: is the halo there more visible than where it was so far? */
static void try_cell(const HaloGrid *grid, const HaloCell *cell, double size_arcmin,
                     const ReviewCase *c, CaseHalo *out)
{
    const DimmingZones *zones = panel_zones(grid->display->panel);
    double least = zones->drive.rows ? fmax(zones->least, zones->drive.value[0]) : zones->least;
    double halo = fmax(cell->black - least * out->full_cd_m2, 0);
    double veil = scattered_at(grid, cell), other = c->luminance_cd_m2.veil;
    out->black_cd_m2 = fmax(out->black_cd_m2, cell->black);
    VisibilityTarget target = {.size_arcmin = size_arcmin,
                               .adapted_cd_m2 = c->luminance_cd_m2.reflected + cell->shown -
                                                halo + fmax(veil, other > 0 ? other : 0),
                               .age_years = grid->look->observer.age_years,
                               .glance_s = HUGE_VAL};
    double threshold = visibility_threshold(&target);
    if (halo / threshold <= out->level) return;
    out->level = halo / threshold;
    out->halo_cd_m2 = halo;
    out->threshold_cd_m2 = threshold;
    out->scattered_cd_m2 = veil;
}

/* Black towards the eye with all zones full, at a cell that shows it with b of that. */
static double full_black(const HaloGrid *grid, const double uv[4])
{
    static const float black[3] = {0, 0, 0};
    double        at[2] = {0.5 * (uv[0] + uv[2]), 0.5 * (uv[1] + uv[3])};
    float         xyz[3];
    SymbolPoint   found;
    if (!symbol_surface_at(&grid->surface, at, &found)) return (double)NAN;
    TrianglePoint point = triangle_point(grid->scene, found.triangle, found.u, found.v);
    Frame         frame = display_frame(grid->scene, grid->display, found.triangle, &point);
    Vec3          to_eye = vec3_normalize(vec3_sub(grid->look->eye, found.position));
    display_full_xyz(grid->display, &point, frame_to_local(&frame, to_eye), black, xyz);
    return (double)xyz[1] * grid->level * grid->look->transmittance;
}

static void fill_cells(HaloGrid *grid, const double uv[4])
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x = i % SIDE, y = i / SIDE, w = (uv[2] - uv[0]) / SIDE;
        double h = (uv[3] - uv[1]) / SIDE;
        double box[4] = {uv[0] + w * x, uv[1] + h * y, uv[0] + w * (x + 1),
                         uv[1] + h * (y + 1)};
        grid->cell[i] = cell_of(grid, box);
    }
}

void case_halo(const HaloLook *look, ReviewCase *c, Arena scratch)
{
    const SymbolSurface *own = &look->symbol->surface;
    const Display       *display = &own->scene->displays[own->display_id];
    Error     err;
    double    uv[4];
    HaloGrid *grid = ARENA_NEW(&scratch, HaloGrid, 1);
    if (!display->backlight) return;
    *grid = (HaloGrid){.look = look, .scene = own->scene, .display = display,
                       .level = c->level};
    area_around(grid, uv);
    SymbolPlace place = {own->scene, &look->symbol->display, {uv[0], uv[1], uv[2], uv[3]}, 1};
    if (!symbol_surface_build(&place, &scratch, &grid->surface, &err)) { /* no rectangle */
        grid->surface = *own;
        for (int i = 0; i < 4; i++) uv[i] = own->uv[i];
    }
    c->has_halo = true;
    c->halo = (CaseHalo){.mean_drive = display->backlight->mean_drive,
                         .full_cd_m2 = full_black(grid, uv)};
    fill_cells(grid, uv);
    double size = patch_arcmin(grid, uv);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (grid->cell[i].sr > 0) try_cell(grid, &grid->cell[i], size, c, &c->halo);
    c->halo.is_visible = c->halo.level >= 1;
}
