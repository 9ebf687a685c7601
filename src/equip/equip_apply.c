/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_apply.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <jansson.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/reference.h"
#include "equip/equip_files.h"
#include "equip/equip_occupant.h"
#include "equip/equip_patch.h"
#include "equip/equip_shipped.h"
#include "scene/check/display_frame.h"
#include "scene/load/material_data.h"
#include "scene/load/scene_load.h"
#include "text/json_text.h"
#include "text/uri.h"

#define DIGITS 9 /* distinguish any two floats */

typedef struct EquipModel {
    json_t *document;
    FileBytes bin; /* a .glb's BIN chunk; data NULL: none */
} EquipModel;

/* The state of one order. */
typedef struct Applying {
    const EquipOrder *order;
    Equip equip;
    EquipFiles files;
    EquipModel model;
    EquipResult result;
    Problems *problems;
    Arena *arena;
} Applying;

/* ---- before anything is written ---------------------------------------------------------- */

/* Where a display's panel or content lies. */
static bool find_file(const EquipOrder *order, const ShippedKind *kind, const char *text,
                      Arena *arena, const char **path, Error *err) {
    if (equip_shipped_is_name(text)) return equip_shipped_find(kind, text, arena, path, err);
    const ReferenceReach reach = {order->root, true};
    if (!reference_resolve(order->model, text, reach, arena, path, err)) return false;
    return file_exists(*path) || error_set(err, ERROR_INPUT, "%s cannot be found", *path);
}

static bool name_file(const EquipOrder *order, EquipFiles *files, const ShippedKind *kind,
                      const char *text, const char **uri, Error *err) {
    const char *path;
    return find_file(order, kind, text, files->arena, &path, err) &&
           equip_files_take(files, path, uri, err);
}

/* A fault of a name in the equip file, at its place there. */
static bool at_place(const Equip *equip, const EquipDisplay *display, const char *key, Error *err) {
    const Error why = *err;
    char place[256];
    snprintf(place, sizeof place, "%.200s/%s", display->place, key);
    return error_at(err, why.code, equip->file, place, "%s%s%.800s", why.file,
                    why.file[0] ? ": " : "", why.text);
}

static bool name_files(const EquipOrder *order, const Equip *equip, EquipFiles *files,
                       EquipNames *names, Error *err) {
    for (int i = 0; i < equip->display_count; i++) {
        const EquipDisplay *d = &equip->displays[i];
        if (!name_file(order, files, &shipped_panels, d->panel, &names[i].panel, err))
            return at_place(equip, d, "panel", err);
        if (d->content &&
            !name_file(order, files, &shipped_contents, d->content, &names[i].content, err))
            return at_place(equip, d, "content", err);
    }
    return true;
}

/* The name of a part, a material or a camera must be unambiguous. */
static bool is_in_model(const Scene *scene, const char *name) {
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

static bool check_name(const Equip *equip, const Scene *scene, const char *name, const char *place,
                       Error *err) {
    char path[256];
    if (!is_in_model(scene, name)) return true;
    snprintf(path, sizeof path, "%.200s/name", place);
    return error_at(err, ERROR_INPUT, equip->file, path,
                    "is '%.60s', which the model has already, required: a new name", name);
}

static bool check_names(const Equip *equip, const Scene *scene, Error *err) {
    for (int i = 0; i < equip->display_count; i++)
        if (!check_name(equip, scene, equip->displays[i].name, equip->displays[i].place, err))
            return false;
    for (int i = 0; i < equip->eye_count; i++)
        if (!check_name(equip, scene, equip->eyes[i].name, equip->eyes[i].place, err)) return false;
    return true;
}

static void doubt_forward(const Equip *equip, Problems *problems) {
    const double *f = equip->forward;
    for (int i = 0; i < equip->eye_count; i++) {
        const EquipEye *eye = &equip->eyes[i];
        double degrees, way[3];
        for (int k = 0; k < 3; k++) way[k] = eye->target_m[k] - eye->position_m[k];
        if (forward_angle_deg(f, way, &degrees) && degrees > FORWARD_MOST_DEG)
            problems_add(problems, SEVERITY_WARNING, equip->file, "/forward",
                         "(%.3g, %.3g, %.3g) is %.0f degrees off where \"%.60s\" looks, "
                         "(%.3g, %.3g, %.3g) m away, expected within %g: does the vehicle "
                         "point there?",
                         f[0], f[1], f[2], degrees, eye->name, way[0], way[1], way[2],
                         FORWARD_MOST_DEG);
    }
}

/* The model, its files and what is put into it are read: none is written over. */
static bool check_output(const Applying *at, const char *path, Error *err) {
    const EquipOrder *order = at->order;
    const Scene *scene = at->files.decoded;
    bool is_read = file_is_same(path, order->with);
    for (int i = 0; i < scene->input_count; i++) is_read |= file_is_same(path, scene->inputs[i]);
    if (is_read)
        return error_at(err, ERROR_OUTPUT, path, "",
                        "is read, required: the name of a new "
                        "file");
    if (!order->overwrites && file_exists(path))
        return error_at(err, ERROR_OUTPUT, path, "",
                        "is there already, required: the name of a new file, or --overwrite");
    return file_check_writable(path, err);
}

/* ---- the model's document, as it stands in its file -------------------------------------- */

#define FILE_BYTES_MAX ((size_t)4 << 30)

/* A .glb's frame (glTF 2.0, section 4): header, then chunks of a size, a type and bytes. */
enum { GLB_HEADER = 12, CHUNK_HEADER = 8, CHUNK_JSON = 0x4E4F534A, CHUNK_BIN = 0x004E4942 };

static uint32_t u32_at(const unsigned char *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void take_chunks(const FileBytes *bytes, FileBytes *json, FileBytes *bin) {
    size_t at = GLB_HEADER;
    while (at + CHUNK_HEADER <= bytes->size) {
        size_t size = u32_at(bytes->data + at);
        uint32_t type = u32_at(bytes->data + at + 4);
        at += CHUNK_HEADER;
        if (size > bytes->size - at) return;
        FileBytes chunk = {bytes->data + at, size};
        if (type == CHUNK_JSON) *json = chunk;
        if (type == CHUNK_BIN && !bin->data) *bin = chunk;
        at += size;
    }
}

/* path: a file that scene_load took. */
static bool equip_model_read(const char *path, Arena *arena, EquipModel *out, Error *err) {
    FileBytes bytes, json;
    json_error_t fault;
    EquipModel model = {0};
    if (!file_read(path, FILE_BYTES_MAX, arena, &bytes, err)) return false;
    json = bytes;
    if (bytes.size >= GLB_HEADER && !memcmp(bytes.data, "glTF", 4))
        take_chunks(&bytes, &json, &model.bin);
    json = file_unmarked(json);
    model.document = json_loadb((const char *)json.data, json.size, JSON_REJECT_DUPLICATES, &fault);
    if (!json_is_object(model.document)) {
        json_decref(model.document);
        return error_at(err, ERROR_INPUT, path, "", "cannot be written again: %s",
                        model.document ? "the document is no JSON object" : fault.text);
    }
    *out = model;
    return true;
}

/* NULL documents are fine. */
static void equip_model_close(EquipModel *model) {
    json_decref(model->document);
    model->document = NULL;
}

/* ---- the document ------------------------------------------------------------------------ */

/* A .glb's bytes get a file of their own, which the first buffer then names. */
static bool name_bin(Applying *at, Error *err) {
    json_t *buffer = json_array_get(json_object_get(at->model.document, "buffers"), 0);
    if (!at->model.bin.data || !buffer || json_object_get(buffer, "uri")) return true;
    const char *path = equip_files_beside(&at->files, ".bin");
    const char *name = arena_format(at->arena, "/%s", path_name(path));
    json_object_set_new(buffer, "uri", json_text(uri_between("/", name, at->arena)));
    if (!check_output(at, path, err) ||
        !file_write(path, at->model.bin.data, at->model.bin.size, err))
        return false;
    at->result.bin = path;
    return true;
}

/* Keeps the model's "generator" and adds this program to it. */
static void sign(json_t *document, Arena scratch) {
    json_t *asset = json_object_get(document, "asset");
    const char *by = json_string_value(json_object_get(asset, "generator"));
    const char *text = arena_format(&scratch, "%s%sParhelion %s, equip", by ? by : "",
                                    by ? "; " : "", PARHELION_VERSION);
    json_object_set_new(asset, "generator", json_text(text));
}

static bool make_document(Applying *at, Error *err) {
    EquipNames *names = ARENA_NEW(at->arena, EquipNames, at->equip.display_count);
    json_t *document = at->model.document;
    if (!equip_files_refer(&at->files, document, err) ||
        !name_files(at->order, &at->equip, &at->files, names, err) ||
        !equip_patch(document, &at->equip, names, *at->arena, err))
        return false;
    sign(document, *at->arena);
    return true;
}

/* ---- writing ----------------------------------------------------------------------------- */

/* Without content there is nothing for a review to read. */
static bool is_read(const EquipDisplay *display) {
    return display->content && (!display->has_symbols || display->symbol_count);
}

static bool has_content(const Equip *equip) {
    bool found = false;
    for (int i = 0; i < equip->display_count; i++) found |= is_read(&equip->displays[i]);
    return found;
}

/* Displays whose text a review finds itself, and what is read of the others. */
static void share_displays(const Equip *e, Arena *arena, ReviewWishes *wishes) {
    int total = 0;
    const char **found = ARENA_NEW(arena, const char *, e->display_count);
    for (int i = 0; i < e->display_count; i++) total += e->displays[i].symbol_count;
    ReviewRead *reads = ARENA_NEW(arena, ReviewRead, total);
    for (int i = 0; i < e->display_count; i++) {
        const EquipDisplay *d = &e->displays[i];
        if (!d->has_symbols) found[wishes->display_count++] = d->name;
        for (int k = 0; k < d->symbol_count; k++)
            reads[wishes->read_count++] =
                (ReviewRead){d->name, d->symbols[k].name, d->symbols[k].polarity, d->symbols[k].uv};
    }
    wishes->displays = found;
    wishes->reads = reads;
}

static const char *occupant_uri(const Applying *at) {
    if (!at->result.occupant) return NULL;
    const char *name = arena_format(at->arena, "/%s", path_name(at->result.occupant));
    return uri_between("/", name, at->arena);
}

static bool start_review(const Applying *at, const Scene *scene, Error *err) {
    const Equip *e = &at->equip;
    const char **eyes = ARENA_NEW(at->arena, const char *, e->eye_count);
    const char **eyes_from = ARENA_NEW(at->arena, const char *, e->eye_count);
    for (int i = 0; i < e->eye_count; i++) eyes[i] = e->eyes[i].name;
    for (int i = 0; i < e->eye_count; i++) eyes_from[i] = e->eyes[i].proposed_from;
    ReviewWishes wishes = {.profile = e->profile,
                           .forward = {e->forward[0], e->forward[1], e->forward[2]},
                           .eyes = eyes,
                           .eyes_from = eyes_from,
                           .eye_count = e->eye_count,
                           .place = e->has_place ? &e->place : NULL,
                           .occupant = at->result.occupant ? e->occupant.name : NULL,
                           .occupant_uri = occupant_uri(at)};
    share_displays(e, at->arena, &wishes);
    const ReviewStart start = {&at->order->output,   1, at->result.review, NULL, &wishes,
                               at->order->overwrites};
    return review_request_start(&start, scene, at->arena, err);
}

/* A draft's problems are reported for the file that it becomes. */
static void rename_draft(Problems *problems, const char *draft, const char *output) {
    for (int i = 0; i < problems->count; i++)
        if (!strcmp(problems->list[i].file, draft)) problems->list[i].file = output;
}

/* The scene under a name that nobody sees is loaded as it will be, then it gets its own. */
static bool write_scene(const Applying *at, Scene **scene, Error *err) {
    Text text = {.arena = at->arena};
    const char *output = at->order->output;
    const char *draft = file_temporary_name(output, at->arena);
    json_print(&text, at->model.document, (JsonDigits){DIGITS, false});
    SceneOptions options = {.paths = &draft, .path_count = 1};
    if (!text_write(&text, draft, err)) return false;
    bool ok = scene_load(&options, at->arena, at->problems, scene, err);
    rename_draft(at->problems, draft, output);
    if (!ok) {
        const Error why = *err;
        file_discard(draft);
        return error_at(err, why.code, output, why.path, "is not written: %.900s", why.text);
    }
    if (file_commit(draft, output, err)) return true;
    scene_close(*scene);
    return false;
}

static void report_copies(Applying *at) {
    const EquipFiles *files = &at->files;
    at->result.copies = ARENA_NEW(at->arena, const char *, files->count);
    at->result.copy_count = files->count;
    for (int i = 0; i < files->count; i++) at->result.copies[i] = files->copies[i].name;
}

/* Before the copies: it may name more of them. */
static bool write_occupant(Applying *at, Error *err) {
    const char *path = equip_files_beside(&at->files, ".occupant.gltf");
    if (at->equip.occupant.eye_id == NO_ID) return true;
    if (!check_output(at, path, err) || !equip_occupant_write(&at->equip, &at->files, path, err))
        return false;
    at->result.occupant = path;
    return true;
}

static void take_back(const Applying *at) {
    const char *const written[] = {at->result.bin, at->result.occupant};
    equip_files_undo(&at->files);
    for (int i = 0; i < COUNT_OF(written); i++)
        if (written[i] && !at->order->overwrites) file_remove(written[i]);
}

static bool write_all(Applying *at, Error *err) {
    Scene *scene;
    if (!write_occupant(at, err) || !equip_files_write(&at->files, err) || !name_bin(at, err) ||
        !write_scene(at, &scene, err)) {
        take_back(at);
        return false;
    }
    scene_without_data(scene, &at->result.without_data, at->arena);
    if (!has_content(&at->equip)) at->result.review = NULL;
    bool ok = !at->result.review || start_review(at, scene, err);
    scene_close(scene);
    report_copies(at);
    return ok;
}

static bool check_model(Applying *at, Error *err) {
    const SceneOptions options = {
        .paths = &at->order->model, .path_count = 1, .root = at->order->root, .own_folder = true};
    Problems problems = problems_start(at->arena);
    Scene *scene;
    if (!scene_load(&options, at->arena, &problems, &scene, err)) return false;
    bool ok = check_names(&at->equip, scene, err);
    scene_close(scene);
    at->files.decoded = scene; /* its lists stay */
    return ok;
}

static bool prepare(Applying *at, Error *err) {
    const EquipOrder *order = at->order;
    if (!equip_file_read(order->with, at->arena, &at->equip, err) ||
        !equip_files_open(order->model, order->output, order->root, at->arena, &at->files, err))
        return false;
    doubt_forward(&at->equip, at->problems);
    at->result.scene = order->output;
    at->result.review = equip_files_beside(&at->files, ".review.json");
    at->result.display_count = at->equip.display_count;
    at->result.eye_count = at->equip.eye_count;
    at->result.first_eye = at->equip.eyes[0].name;
    at->result.material_count = at->equip.material_count;
    at->result.forward_is_proposed = at->equip.forward_is_proposed;
    memcpy(at->result.forward, at->equip.forward, sizeof at->result.forward);
    return check_model(at, err) && check_output(at, at->result.scene, err) &&
           check_output(at, at->result.review, err);
}

bool equip_apply(const EquipOrder *order, Arena *arena, Problems *problems, EquipResult *out,
                 Error *err) {
    Applying at = {.order = order, .problems = problems, .arena = arena};
    if (!prepare(&at, err) || !equip_model_read(order->model, arena, &at.model, err)) return false;
    bool ok = make_document(&at, err) && write_all(&at, err);
    equip_model_close(&at.model);
    if (ok) *out = at.result;
    return ok;
}
