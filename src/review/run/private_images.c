/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/private_images.h"

#include <math.h>

#include "base/units.h"
#include "light/emission.h"
#include "review/chain/chains.h"
#include "review/eye/pane_image_reading.h"

#define PRECISION 0.01
#define PATHS_MOST 32768
#define COARSE_PRECISION 0.05
#define COARSE_PATHS 4096
#define COARSE_SEED 0x70727669u
/* of a cell, at which its emission is read: of a bar of 20 x 14 pixels the mean of all is then
 * known to 1 in 10,000, by 16 to 6 in 1,000 */
#define PLACES 61
#define SEARCH_BYTES ((size_t)1 << 32) /* of address space */

/* ---- the symbol's box -------------------------------------------------------------------- */

/* The point of the display that shows a place of the box, 0..1; false: none does. */
static bool box_point(const SymbolSurface *surface, double s, double t, uint32_t *triangle,
                      TrianglePoint *out) {
    const double *box = surface->uv;
    double uv[2] = {box[0] + s * (box[2] - box[0]), box[1] + t * (box[3] - box[1])};
    SymbolPoint at;
    if (!symbol_surface_at(surface, uv, &at)) return false;
    *triangle = at.triangle;
    *out = triangle_point(surface->scene, at.triangle, at.u, at.v);
    return true;
}

static void set_raster(const SetupSymbol *symbol, PaneRaster *out) {
    const SymbolSurface *surface = &symbol->surface;
    const double n = PANE_RASTER;
    const int wide = PANE_RASTER + 1;
    uint32_t triangle = surface->points[0].triangle;
    for (int i = 0; i < wide * wide; i++)
        out->has_corner[i] =
            box_point(surface, i % wide / n, (double)(i / wide) / n, &triangle, &out->corner[i]);
    for (int i = 0; i < 2 * PANE_RASTER * PANE_RASTER; i++) {
        double third = (1 + i % 2) / 3.0;
        int field = i / 2;
        out->has_middle[i] =
            box_point(surface, (field % PANE_RASTER + third) / n,
                      ((double)(field / PANE_RASTER) + third) / n, &triangle, &out->middle[i]);
    }
    out->part_id = (int)surface->scene->triangles[triangle].part_id;
}

/* ---- what it sends towards a pane -------------------------------------------------------- */

static double fraction(double x) {
    return x - floor(x);
}

/* A place of a cell, in the box. */
static void place_of(const PaneCell *cell, int k, double *s, double *t) {
    double u = fraction(EVEN_STEP_U * (k + 0.5)), v = fraction(EVEN_STEP_V * (k + 0.5));
    int field = cell->id / 2;
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (cell->id % 2) u = 1 - u, v = 1 - v;
    *s = (field % PANE_RASTER + u) / PANE_RASTER;
    *t = ((double)(field / PANE_RASTER) + v) / PANE_RASTER;
}

/* The mean luminance that what is shown of the box sends along the ways of its image. */
static double sent_mean(const SymbolSurface *surface, const PaneImage *image) {
    const Scene *scene = surface->scene;
    double sum = 0, sr = 0;
    for (int i = 0; i < image->cell_count * PLACES; i++) {
        const PaneCell *cell = &image->cells[i / PLACES];
        TrianglePoint point;
        uint32_t triangle;
        double s, t;
        float xyz[3];
        place_of(cell, i, &s, &t);
        if (!box_point(surface, s, t, &triangle, &point)) continue;
        Vec3 way = vec3_normalize(vec3_sub(cell->seen_from, point.position));
        display_emission_xyz(scene, &scene->displays[surface->display_id], triangle, &point, way,
                             xyz);
        sum += cell->sr * (double)xyz[1];
        sr += cell->sr;
    }
    return sr > 0 ? sum / sr : 0;
}

/* From where an eye would see straight what the pane shows: mean over the image. */
static Vec3 seen_from(const PaneImage *image) {
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < image->cell_count; i++) {
        const PaneCell *cell = &image->cells[i];
        sum[0] += cell->sr * (double)cell->seen_from.x;
        sum[1] += cell->sr * (double)cell->seen_from.y;
        sum[2] += cell->sr * (double)cell->seen_from.z;
    }
    for (int k = 0; k < 3; k++) sum[k] /= image->sr;
    return vec3_from_doubles(sum);
}

/* ---- one pane ---------------------------------------------------------------------------- */

static MeanInterval within(Estimate found, double least, double scale) {
    return (MeanInterval){fmax(found.interval.low, least) * scale,
                          fmax(found.interval.high, least) * scale};
}

/* Read by goal's paths; what the case has of level and panel. */
static CaseImage read_by_pane(const PrivateLook *look, const PaneImageGoal *goal,
                              const ReviewCase *c, Arena scratch) {
    const Setup *setup = look->setup;
    const SetupSymbol *symbol = look->symbol;
    const PaneImage *image = goal->image;
    Vec3 from = seen_from(image);
    SymbolLook shown = {&symbol->surface, &symbol->split, from, setup->tools.threads, NULL};
    SymbolEmission sent = symbol_emission(&shown, c->level);
    PaneImageReading read = pane_image_read(setup, goal, scratch);
    double mean = sent_mean(&symbol->surface, image), over = mean > 0 ? 1 / mean : 0;
    double least = setup->request->pane_images ? setup->request->pane_images->against_cd_m2 : 0;
    CaseImage out = {.shown_share = image->share.shown,
                     .height_arcmin =
                         symbol_height_arcmin(&symbol->surface, symbol->split.box, from),
                     .sent_foreground = sent.xyz[SYMBOL_FOREGROUND][1],
                     .sent_background = sent.xyz[SYMBOL_BACKGROUND][1],
                     .reflectance = fmax(read.image.mean, 0) * over,
                     .reflectance_range = within(read.image, 0, over),
                     .against = fmax(read.against.mean, least),
                     .against_range = within(read.against, least, 1),
                     .verdict = VERDICT_UNJUDGED};
    world_from_scene(setup->scene->origin, goal->eye, out.eye_m);
    case_image_set_contrast(&out, c->panel.emission_error);
    return out;
}

/* Of the eye's places the one from which the pane shows it with most contrast; -1: none. */
static int best_place(const PrivateLook *look, int pane_id, const PaneRaster *raster,
                      const ReviewCase *c, Arena scratch) {
    double most = -1;
    int best = -1;
    for (int i = 0; i < look->point_count; i++) {
        Arena room = scratch;
        PaneImage image = pane_image_of(look->setup, look->points[i], pane_id, raster, &room);
        if (!image.cell_count) continue;
        if (look->point_count == 1) return 0;
        PaneImageGoal goal = {look->points[i], &image, COARSE_PRECISION, COARSE_PATHS, COARSE_SEED};
        CaseImage seen = read_by_pane(look, &goal, c, room);
        if (!(seen.contrast_ratio > most)) continue;
        most = seen.contrast_ratio;
        best = i;
    }
    return best;
}

static void add_image(const PrivateLook *look, int pane_id, const PaneRaster *raster, ReviewCase *c,
                      CaseImage *list, Arena *arena) {
    Arena scratch = arena_reserve(SEARCH_BYTES);
    int best = best_place(look, pane_id, raster, c, scratch);
    if (best >= 0) {
        Vec3 eye = look->points[best];
        PaneImage image = pane_image_of(look->setup, eye, pane_id, raster, &scratch);
        PaneImageGoal goal = {eye, &image, PRECISION, PATHS_MOST, 0};
        CaseImage *out = &list[c->image_count++];
        *out = read_by_pane(look, &goal, c, scratch);
        out->pane = chain_part_words(look->setup->scene, pane_id, arena);
    }
    arena_release(&scratch);
}

void private_images_find(const PrivateLook *look, ReviewCase *c, Arena *arena) {
    const Scene *scene = look->setup->scene;
    Arena scratch = arena_reserve(SEARCH_BYTES);
    int *panes = ARENA_NEW(&scratch, int, scene->part_count);
    PaneRaster *raster = ARENA_NEW(&scratch, PaneRaster, 1);
    int count = pane_images_panes(scene, panes);
    CaseImage *list = ARENA_NEW(arena, CaseImage, count);
    c->images = list;
    c->image_count = 0;
    set_raster(look->symbol, raster);
    for (int i = 0; i < count; i++) add_image(look, panes[i], raster, c, list, arena);
    arena_release(&scratch);
}
