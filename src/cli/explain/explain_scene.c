/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/explain_scene.h"

#include "camera/camera.h"
#include "cli/render/render_setup.h"
#include "review/request/request_check.h"
#include "review/run/explain_place.h"
#include "review/run/symbols.h"
#include "scene/load/scene_load.h"

#define BOUNCES 64
#define SIDE 32 /* of the raster of a region */

/* Points along the looks of a raster. */
static void aim_at_region(const SceneQuestion *question, const SceneCamera *camera,
                          Arena *arena, ProbeAim *aim)
{
    const double *r = question->region;
    Camera seen = camera_from_scene(camera, question->size[0], question->size[1]);
    Vec3  *targets = ARENA_NEW(arena, Vec3, SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = (i + 0.5) / (SIDE * SIDE), v = reverse_bits((uint32_t)i) * 0x1p-32;
        Ray    ray = camera_ray(&seen, (float)(r[0] + u * (r[2] - r[0])),
                                (float)(r[1] + (v + 0.5 / (SIDE * SIDE)) * (r[3] - r[1])));
        targets[i] = vec3_add(aim->eye, ray.direction);
    }
    aim->targets = targets;
    aim->target_count = SIDE * SIDE;
}

static bool aim_at_display(const SceneQuestion *question, Arena *arena, ProbeAim *aim,
                           Error *err)
{
    const Scene  *scene = aim->context->scene;
    const double *uv = question->uv;
    ReviewDisplay display;
    SymbolSurface surface;
    if (!review_display_find(scene, question->display, arena, &display, err))
        return error_prefix(err, "--display %s", question->display);
    SymbolPlace place = {.scene = scene, .display = &display,
                         .uv = {uv[0], uv[1], uv[2], uv[3]}, .point_count = SYMBOL_POINTS};
    if (!symbol_surface_build(&place, arena, &surface, err))
        return error_prefix(err, "--display %s", question->display);
    bool *is_visible = ARENA_NEW(arena, bool, surface.point_count);
    symbol_visibility(&surface, aim->context, aim->eye, is_visible);
    symbol_aim(&surface, is_visible, arena, aim);
    return aim->target_count > 0 ||
           error_set(err, ERROR_USAGE, "--display %s: the eye sees nothing of it",
                     question->display);
}

static bool explain_lit(const SceneQuestion *question, const PathContext *context,
                        const ReadingTools *tools, Arena *arena, Explained *out, Error *err)
{
    SceneCamera camera;
    if (!render_choose_camera(context->scene, &question->camera, question->problems, &camera,
                              err))
        return false;
    ProbeAim aim = {.context = context, .eye = camera.world_from_camera.origin};
    if (!question->display) aim_at_region(question, &camera, arena, &aim);
    else if (!aim_at_display(question, arena, &aim, err)) return false;
    ExplainPlace place = {tools, aim, question->paths, question->with_outlook};
    explain_place(&place, arena, out);
    return true;
}

bool explain_scene(const SceneQuestion *question, Arena *arena, Explained *out, Error *err)
{
    ReadingTools tools = {NULL, question->threads};
    Scene       *scene;
    Bvh         *bvh = NULL;
    Lights      *lights;
    const SceneAsked asked = {&question->scene, &question->environment, question->progress};
    if (!kernel_choose(question->isa, &tools.kernel, err) ||
        !scene_options_load(&asked, arena, question->problems, &scene, err))
        return false;
    render_warn_of_darkness(scene, question->problems);
    bool ok = bvh_create(scene, question->threads, question->isa, &bvh, err) &&
              lights_build(scene, arena, &lights, err);
    if (ok) {
        PathContext context = path_context_build(scene, bvh, lights, BOUNCES, arena);
        ok = explain_lit(question, &context, &tools, arena, out, err);
    }
    bvh_destroy(bvh);
    scene_close(scene);
    return ok;
}
