/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sights.h"

#include <string.h>

#include "camera/camera.h"
#include "review/chain/outlook_picture.h"
#include "review/run/explain.h"

static CaseView view_of(const Camera *camera)
{
    const Transform *t = &camera->world_from_camera;
    return (CaseView){t->origin, t->x, t->y, vec3_neg(t->z), camera->is_perspective,
                      (double)camera->half_width, (double)camera->half_height, camera->width,
                      camera->height};
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
        for (int i = 0; i < count && ok; i++)
            if (!strcmp(symbols[i].name, c->symbol))
                ok = add_outlook(ask, &symbols[i], c, arena, err);
    }
    arena_release(&own);
    return ok;
}
