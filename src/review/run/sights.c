/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sights.h"

#include <string.h>

#include "camera/camera.h"
#include "review/chain/outlook_picture.h"
#include "review/run/explain.h"

#define RIM_STEPS 8 /* points along a side of a symbol's rectangle */

static CaseView view_of(const Camera *camera)
{
    const Transform *t = &camera->world_from_camera;
    return (CaseView){t->origin, t->x, t->y, vec3_neg(t->z), camera->is_perspective,
                      (double)camera->half_width, (double)camera->half_height, camera->width,
                      camera->height};
}

/* From corner to corner; a curved display bends between them. */
static void add_rim(const SymbolSurface *surface, ReviewCase *c, Arena *arena)
{
    const double *uv = surface->uv;
    const double  corner[5][2] = {{uv[0], uv[1]}, {uv[2], uv[1]}, {uv[2], uv[3]},
                                  {uv[0], uv[3]}, {uv[0], uv[1]}};
    Vec3 *rim = ARENA_NEW(arena, Vec3, 4 * RIM_STEPS);
    for (int i = 0; i < 4 * RIM_STEPS; i++) {
        const double *a = corner[i / RIM_STEPS], *b = corner[i / RIM_STEPS + 1];
        double      t = (double)(i % RIM_STEPS) / RIM_STEPS;
        double      at[2] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
        SymbolPoint point;
        if (symbol_surface_at(surface, at, &point)) rim[c->rim_count++] = point.position;
    }
    c->rim = rim;
}

static bool add_outlook(const FrameAsk *ask, const StageSymbol *symbol, ReviewCase *c,
                        Arena *arena, Error *err)
{
    Arena       scratch = arena_reserve((size_t)1 << 28);
    Outlook     outlook = stage_outlook(ask->stage, symbol, c->eye_m, &scratch);
    Picture     picture = outlook_picture(&outlook, &scratch);
    PictureFile file = {.bits = 8, .is_srgb = true};
    c->outlook_words = outlook_words(&outlook, arena);
    c->outlook = arena_format(arena, "frames/%s-outlook.png", ask->name);
    file.description = c->outlook_words;
    const char *path = arena_format(arena, "%s/%s", ask->folder, c->outlook);
    bool        ok = picture_write(path, &picture, file, scratch, err);
    arena_release(&scratch);
    return ok;
}

bool case_sights(const FrameAsk *ask, ReviewCase *c, Arena *arena, Error *err)
{
    Arena        own = arena_reserve((size_t)1 << 34);
    SceneCamera  camera;
    StageSymbol *symbols;
    int          count;
    bool         ok = frame_camera(ask, &camera, own, err) &&
              stage_symbols(ask->stage, &own, &symbols, &count, err);
    if (ok) {
        const ReviewFrames *frames = &ask->stage->request->frames;
        Camera    seen = camera_from_scene(&camera, frames->width, frames->height);
        CaseView *view = ARENA_NEW(arena, CaseView, 1);
        *view = view_of(&seen);
        c->view = view;
        for (int i = 0; i < count && ok; i++) {
            if (strcmp(symbols[i].name, c->symbol)) continue;
            add_rim(&symbols[i].surface, c, arena);
            ok = add_outlook(ask, &symbols[i], c, arena, err);
        }
    }
    arena_release(&own);
    return ok;
}
