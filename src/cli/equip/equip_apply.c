/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/equip/equip_apply.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "base/reference.h"
#include "cli/equip/equip_files.h"
#include "cli/equip/equip_model.h"
#include "cli/equip/equip_patch.h"
#include "cli/equip/equip_shipped.h"
#include "scene/load/material_data.h"
#include "scene/load/scene_load.h"
#include "text/json_print.h"
#include "text/json_text.h"
#include "text/uri.h"

#define DIGITS 9 /* tell any two floats apart */

/* ---- before anything is written ---------------------------------------------------------- */

/* Where a display's panel or content lies. */
static bool find_file(const EquipOrder *order, const ShippedKind *kind, const char *text,
                      Arena *arena, const char **path, Error *err)
{
    if (equip_shipped_is_name(text)) return equip_shipped_find(kind, text, arena, path, err);
    if (!reference_resolve(order->model, text, order->root, arena, path, err)) return false;
    return file_exists(*path) ||
           error_set(err, ERROR_INPUT, "%s cannot be found", *path);
}

static bool name_file(const EquipOrder *order, EquipFiles *files, const ShippedKind *kind,
                      const char *text, const char **uri, Error *err)
{
    const char *path;
    return find_file(order, kind, text, files->arena, &path, err) &&
           equip_files_uri(files, path, uri, err);
}

/* A fault of a name in the equip file, at its place there. */
static bool at_place(const Equip *equip, const EquipDisplay *display, const char *key,
                     Error *err)
{
    const Error why = *err;
    char        place[256];
    snprintf(place, sizeof place, "%.200s/%s", display->place, key);
    return error_at(err, why.code, equip->file, place, "%s%s%.800s", why.file,
                    why.file[0] ? ": " : "", why.text);
}

static bool name_files(const EquipOrder *order, const Equip *equip, EquipFiles *files,
                       EquipNames *names, Error *err)
{
    for (int i = 0; i < equip->display_count; i++) {
        const EquipDisplay *d = &equip->displays[i];
        if (!name_file(order, files, &shipped_panels, d->panel, &names[i].panel, err))
            return at_place(equip, d, "panel", err);
        if (d->content && !name_file(order, files, &shipped_contents, d->content,
                                     &names[i].content, err))
            return at_place(equip, d, "content", err);
    }
    return true;
}

/* Who names a part, a material or a camera must mean one thing. */
static bool is_in_model(const Scene *scene, const char *name)
{
    for (int i = 0; i < scene->part_count; i++)
        if (!strcmp(scene->parts[i].name, name)) return true;
    for (int i = 0; i < scene->material_count; i++)
        if (!strcmp(scene->materials[i].name, name)) return true;
    for (int i = 0; i < scene->camera_count; i++)
        if (!strcmp(scene->cameras[i].node_name, name) ||
            !strcmp(scene->cameras[i].camera_name, name))
            return true;
    return false;
}

static bool check_name(const Equip *equip, const Scene *scene, const char *name,
                       const char *place, Error *err)
{
    char path[256];
    if (!is_in_model(scene, name)) return true;
    snprintf(path, sizeof path, "%.200s/name", place);
    return error_at(err, ERROR_INPUT, equip->file, path,
                    "is '%.60s', which the model has already, wanted a new name", name);
}

static bool check_names(const Equip *equip, const Scene *scene, Error *err)
{
    for (int i = 0; i < equip->display_count; i++)
        if (!check_name(equip, scene, equip->displays[i].name, equip->displays[i].place, err))
            return false;
    for (int i = 0; i < equip->eye_count; i++)
        if (!check_name(equip, scene, equip->eyes[i].name, equip->eyes[i].place, err))
            return false;
    return true;
}

static bool check_output(const EquipOrder *order, const char *path, Error *err)
{
    if (file_is_same(path, order->model))
        return error_at(err, ERROR_OUTPUT, path, "", "is the model itself, wanted a new file");
    if (!order->overwrites && file_exists(path))
        return error_at(err, ERROR_OUTPUT, path, "",
                        "is there already, wanted the name of a new file, or --overwrite");
    return file_check_writable(path, err);
}

/* ---- the document ------------------------------------------------------------------------ */

/* A .glb's bytes get a file of their own, which the first buffer then names. */
static bool name_bin(const EquipOrder *order, EquipModel *model, const EquipFiles *files,
                     EquipResult *out, Error *err)
{
    json_t *buffer = json_array_get(json_object_get(model->document, "buffers"), 0);
    if (!model->bin.data || !buffer || json_object_get(buffer, "uri")) return true;
    const char *path = equip_files_beside(files, ".bin");
    const char *name = arena_format(files->arena, "/%s", path_name(path));
    json_object_set_new(buffer, "uri", json_text(uri_between("/", name, files->arena)));
    if (!check_output(order, path, err) ||
        !file_write(path, model->bin.data, model->bin.size, err))
        return false;
    out->bin = path;
    return true;
}

/* What the model says of who wrote it stays; who changed it is added. */
static void sign(json_t *document, Arena scratch)
{
    json_t     *asset = json_object_get(document, "asset");
    const char *by = json_string_value(json_object_get(asset, "generator"));
    const char *text = arena_format(&scratch, "%s%sParhelion %s, equip", by ? by : "",
                                    by ? "; " : "", PARHELION_VERSION);
    json_object_set_new(asset, "generator", json_string(text));
}

static bool make_document(const EquipOrder *order, const Equip *equip, EquipFiles *files,
                          EquipModel *model, Error *err)
{
    EquipNames *names = ARENA_NEW(files->arena, EquipNames, equip->display_count);
    if (!equip_files_refer(files, model->document, err) ||
        !name_files(order, equip, files, names, err) ||
        !equip_patch(model->document, equip, names, *files->arena, err))
        return false;
    sign(model->document, *files->arena);
    return true;
}

/* ---- writing ----------------------------------------------------------------------------- */

static bool start_review(const EquipOrder *order, const Equip *equip, const Scene *scene,
                         const EquipResult *result, Arena *arena, Error *err)
{
    const char **eyes = ARENA_NEW(arena, const char *, equip->eye_count);
    for (int i = 0; i < equip->eye_count; i++) eyes[i] = equip->eyes[i].name;
    const ReviewWishes wishes = {
        equip->profile, {equip->forward[0], equip->forward[1], equip->forward[2]}, eyes,
        equip->eye_count, equip->has_place ? &equip->place : NULL};
    const ReviewStart start = {&order->output, 1, result->review, NULL, &wishes,
                               order->overwrites};
    return review_request_start(&start, scene, arena, err);
}

/* The scene under a name that nobody sees is loaded as it will be, then it gets its own. */
static bool write_scene(const EquipOrder *order, const EquipModel *model, Arena *arena,
                        Problems *problems, Scene **scene, Error *err)
{
    Text        text = {.arena = arena};
    const char *draft = file_temporary_name(order->output, arena);
    json_print(&text, model->document, (JsonDigits){DIGITS, false});
    SceneOptions options = {.paths = &draft, .path_count = 1};
    if (!text_write(&text, draft, err)) return false;
    if (!scene_load(&options, arena, problems, scene, err)) {
        file_discard(draft);
        return error_prefix(err, "what was to become %s", order->output);
    }
    if (file_commit(draft, order->output, err)) return true;
    scene_close(*scene);
    return false;
}

static void tell_copies(const EquipFiles *files, EquipResult *out)
{
    out->copies = ARENA_NEW(files->arena, const char *, files->count);
    out->copy_count = files->count;
    for (int i = 0; i < files->count; i++) out->copies[i] = files->copies[i].name;
}

static bool write_all(const EquipOrder *order, const Equip *equip, EquipFiles *files,
                      EquipModel *model, EquipResult *out, Problems *problems, Error *err)
{
    Scene *scene;
    if (!equip_files_write(files, err) || !name_bin(order, model, files, out, err) ||
        !write_scene(order, model, files->arena, problems, &scene, err)) {
        equip_files_undo(files);
        if (out->bin && !order->overwrites) file_remove(out->bin);
        return false;
    }
    scene_without_data(scene, &out->without_data, files->arena);
    bool ok = start_review(order, equip, scene, out, files->arena, err);
    scene_close(scene);
    tell_copies(files, out);
    return ok;
}

static bool check_model(const EquipOrder *order, const Equip *equip, Arena *arena, Error *err)
{
    const SceneOptions options = {.paths = &order->model, .path_count = 1, .root = order->root};
    Problems           problems = problems_start(arena);
    Scene             *scene;
    if (!scene_load(&options, arena, &problems, &scene, err)) return false;
    bool ok = check_names(equip, scene, err);
    scene_close(scene);
    return ok;
}

bool equip_apply(const EquipOrder *order, Arena *arena, Problems *problems, EquipResult *out,
                 Error *err)
{
    Equip       equip;
    EquipFiles  files;
    EquipModel  model = {0};
    EquipResult result = {.scene = order->output};
    if (!equip_file_read(order->with, arena, &equip, err) ||
        !equip_files_open(order->model, order->output, order->root, arena, &files, err))
        return false;
    result.review = equip_files_beside(&files, ".review.json");
    if (!check_output(order, result.scene, err) || !check_output(order, result.review, err) ||
        !check_model(order, &equip, arena, err) ||
        !equip_model_read(order->model, arena, &model, err))
        return false;
    bool ok = make_document(order, &equip, &files, &model, err) &&
              write_all(order, &equip, &files, &model, &result, problems, err);
    equip_model_close(&model);
    if (!ok) return false;
    result.display_count = equip.display_count;
    result.eye_count = equip.eye_count;
    result.material_count = equip.material_count;
    *out = result;
    return true;
}
