/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_identity.h"

#include "render/favour.h"
#include "render/identity.h"
#include "render/pilot.h"

static void add_eye(Text *text, const PolarisedEye *eye) {
    identity_line(text, "polarised", "yes");
    if (!eye->has_glasses) return;
    identity_line(text, "sunglasses", "%.9g %.9g %.9g", (double)eye->axis[0], (double)eye->axis[1],
                  (double)eye->blocks);
}

static void add_favoured(Text *text, const FilmArea *area) {
    identity_line(text, "all samples for", "display %d, pixels %d,%d,%d,%d; of others 1 in %u",
                  area->display, area->rect.x0, area->rect.y0, area->rect.x1, area->rect.y1,
                  FAVOUR_OTHERS);
}

static void add_pilot(Text *text) {
    identity_line(text, "all samples for", "noise; pilot %u, squares of %d, usual %d, least %d",
                  PILOT_SAMPLES, PILOT_SIDE, PILOT_USUAL, PILOT_LEAST);
}

const char *render_identity(const RenderRequest *request, const Scene *scene,
                            const SceneCamera *camera, const Kernel *kernel, Arena *arena) {
    const RenderOptions *options = &request->render;
    Text text = {.arena = arena};
    identity_add_program(&text, kernel);
    identity_line(&text, "size", "%dx%d", options->width, options->height);
    identity_line(&text, "seed", "%u", options->seed);
    identity_line(&text, "max bounces", "%d", options->max_bounces);
    identity_line(&text, "sun in mirrors", "%s", options->no_mirrors ? "by chance" : "asked for");
    if (options->eye) add_eye(&text, options->eye);
    if (options->favoured) add_favoured(&text, options->favoured);
    if (options->favours_noise) add_pilot(&text);
    identity_line(&text, "layers", "%s", render_layer_list(options->layers, arena));
    identity_add_scene(&text, &request->scene, scene);
    identity_add_environment(&text, scene);
    identity_add_camera(&text, camera);
    if (request->field_hash) /* last: it changes with most of the others */
        identity_line(&text, "field", "%016llx", (unsigned long long)request->field_hash);
    return text.data;
}
