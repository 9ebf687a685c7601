/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/equip/equip_file.h"

#include <math.h>
#include <string.h>

#include "cli/equip/usual_material.h"
#include "review/profile.h"
#include "review/request/request_eyes.h"
#include "review/request/request_fields.h"
#include "scene/check/display_frame.h"

#define METRES_MAX 1e6
#define LEAST_M 0.001   /* a display's side of any size */
#define MOST_M 100.0
#define LEVEL_MAX 100.0
#define NEAR_M 0.001    /* an eye that is nearer looks nowhere */
#define SQUARE 1e-3     /* of two unit vectors' product */
#define MATERIALS_MAX 10000
#define VERTICAL 1e-6   /* of a unit vector's level part */

static const JsonRange PLACE_RANGE = {-METRES_MAX, METRES_MAX, 3};

static bool position(const JsonView *view, const char *key, double out[3], Error *err)
{
    return field_wanted(view, key, err) &&
           field_numbers(view, key, PLACE_RANGE, out, NULL, err);
}

static bool direction(const JsonView *view, const char *key, double out[3], Error *err)
{
    return field_wanted(view, key, err) && field_unit_vector(view, key, out, NULL, err);
}

static bool wanted_number(const JsonView *view, const char *key, const double range[2],
                          double *out, Error *err)
{
    return field_wanted(view, key, err) &&
           json_view_number(view, key, range[0], range[1], out, err);
}

/* ---- displays ---------------------------------------------------------------------------- */

/* Rounding leaves them a little off: up is made square again. */
static bool square(const JsonView *view, EquipDisplay *display, Error *err)
{
    double *r = display->right, *u = display->up;
    double  along = r[0] * u[0] + r[1] * u[1] + r[2] * u[2], length = 0;
    if (fabs(along) > SQUARE)
        return field_fails(view, "up", err,
                           "stands at %.4g degrees to \"right\", required: 90",
                           acos(along) * 180 / M_PI);
    for (int i = 0; i < 3; i++) u[i] -= along * r[i];
    for (int i = 0; i < 3; i++) length += u[i] * u[i];
    for (int i = 0; i < 3; i++) u[i] /= sqrt(length);
    return true;
}

/* 25 is meant as 25 %: a level above what was measured has to say so. */
static bool read_level(const JsonView *view, EquipDisplay *out, Error *err)
{
    out->level = out->max_level = 1;
    return json_view_number(view, "max_level", 1, LEVEL_MAX, &out->max_level, err) &&
           json_view_number(view, "level", 0, LEVEL_MAX, &out->level, err) &&
           (out->level <= out->max_level ||
            field_fails(view, "level", err,
                        "is %g, required: a level from 0 to %g: 1 is as measured, 0.25 a "
                        "quarter of it; \"max_level\" beside it allows a panel driven above "
                        "that",
                        out->level, out->max_level));
}

static bool check_side(const JsonView *view, const EquipDisplay *display, const char *key,
                       double m, Error *err)
{
    return display->any_size || display_side_is_plausible(m) ||
           field_fails(view, key, err,
                       "is %.4g m, required: %g to %g m: is the model in metres? If it is "
                       "meant: \"any_size\": true beside it",
                       m, DISPLAY_LEAST_M, DISPLAY_MOST_M);
}

static bool read_size(const JsonView *view, EquipDisplay *out, Error *err)
{
    const double side[2] = {LEAST_M, MOST_M};
    return field_boolean(view, "any_size", &out->any_size, err) &&
           wanted_number(view, "width_m", side, &out->width_m, err) &&
           wanted_number(view, "height_m", side, &out->height_m, err) &&
           check_side(view, out, "width_m", out->width_m, err) &&
           check_side(view, out, "height_m", out->height_m, err);
}

/* Absent: full white. */
static bool read_content(const JsonView *view, const char **out, Error *err)
{
    return !json_object_get(view->object, "content") || field_name(view, "content", out, err);
}

static bool read_symbol(const JsonView *view, int i, EquipSymbol *out, Error *err)
{
    static const char *const keys[] = {"name", "uv", "polarity"};
    JsonView       item;
    ReviewPolarity any;
    if (!field_item(view, "symbols", i, (FieldWords){keys, COUNT_OF(keys)}, &item, err) ||
        !field_name(&item, "name", &out->name, err) || !field_wanted(&item, "uv", err) ||
        !field_numbers(&item, "uv", (JsonRange){0, 1, 4}, out->uv, NULL, err) ||
        !request_polarity_read(&item, "polarity", &any, err) ||
        !json_view_text(&item, "polarity", &out->polarity, err))
        return false;
    return (out->uv[0] < out->uv[2] && out->uv[1] < out->uv[3]) ||
           field_fails(&item, "uv", err,
                       "is [%g, %g, %g, %g], required: left < right and top < bottom",
                       out->uv[0], out->uv[1], out->uv[2], out->uv[3]);
}

/* An empty list: nothing of it is read. */
static bool read_symbols(const JsonView *view, EquipDisplay *out, Error *err)
{
    const json_t *list = json_object_get(view->object, "symbols");
    out->has_symbols = list != NULL;
    if (!list || (json_is_array(list) && !json_array_size(list))) return true;
    if (!field_list(view, "symbols", EQUIP_SYMBOLS_MAX, &out->symbol_count, err)) return false;
    EquipSymbol *symbols = ARENA_NEW(view->arena, EquipSymbol, out->symbol_count);
    for (int i = 0; i < out->symbol_count; i++) {
        if (!read_symbol(view, i, &symbols[i], err)) return false;
        for (int k = 0; k < i; k++)
            if (!strcmp(symbols[k].name, symbols[i].name))
                return field_fails(view, arena_format(view->arena, "symbols/%d/name", i), err,
                                   "is '%.60s' once more, required: a new name",
                                   symbols[i].name);
    }
    out->symbols = symbols;
    return true;
}

/* A list of numbers of a mesh, so many an item. */
typedef struct MeshColumn {
    const char    *key;
    JsonRange      range;
    int            each;
    const double **out;
    int           *count; /* of items */
} MeshColumn;

static bool read_column(const JsonView *view, const MeshColumn *c, Error *err)
{
    double *list = ARENA_NEW(view->arena, double, c->range.capacity);
    *c->out = list;
    if (!field_wanted(view, c->key, err) ||
        !json_view_numbers(view, c->key, c->range, list, c->count, err))
        return false;
    if (*c->count % c->each)
        return field_fails(view, c->key, err, "has %d numbers, required: a multiple of %d",
                           *c->count, c->each);
    *c->count /= c->each;
    return true;
}

static bool check_mesh(const JsonView *view, const EquipMesh *mesh, int uv_count, Error *err)
{
    if (uv_count != mesh->vertex_count)
        return field_fails(view, "uv", err,
                           "has %d pairs, required: one of each of %d positions", uv_count,
                           mesh->vertex_count);
    for (int i = 0; i < 3 * mesh->triangle_count; i++) {
        double vertex = mesh->triangles[i];
        if (vertex != floor(vertex) || vertex >= mesh->vertex_count)
            return field_fails(view, "triangles", err,
                               "holds %g, required: whole numbers below %d", vertex,
                               mesh->vertex_count);
    }
    return true;
}

static bool read_mesh(const JsonView *view, EquipMesh *out, Error *err)
{
    static const char *const keys[] = {"positions_m", "uv", "triangles"};
    JsonView mesh;
    int      uv_count = 0;
    const MeshColumn columns[] = {
        {"positions_m", {-METRES_MAX, METRES_MAX, 3 * EQUIP_VERTICES_MAX}, 3,
         &out->positions_m, &out->vertex_count},
        {"uv", {0, 1, 2 * EQUIP_VERTICES_MAX}, 2, &out->uv, &uv_count},
        {"triangles", {0, EQUIP_VERTICES_MAX, 6 * EQUIP_VERTICES_MAX}, 3, &out->triangles,
         &out->triangle_count}};
    if (!json_view_child(view, "mesh", false, &mesh, err)) return false;
    if (!mesh.object) return true;
    if (!json_view_check_keys(&mesh, keys, COUNT_OF(keys), err)) return false;
    for (int i = 0; i < COUNT_OF(columns); i++)
        if (!read_column(&mesh, &columns[i], err)) return false;
    return check_mesh(&mesh, out, uv_count, err);
}

static bool read_display(const JsonView *view, EquipDisplay *out, Error *err)
{
    double before_mm = 0.5;
    out->place = view->path;
    bool ok = field_name(view, "name", &out->name, err) &&
              position(view, "centre_m", out->centre_m, err) &&
              direction(view, "right", out->right, err) &&
              direction(view, "up", out->up, err) && square(view, out, err) &&
              read_size(view, out, err) &&
              json_view_number(view, "before_mm", 0.05, 1000, &before_mm, err) &&
              field_name(view, "panel", &out->panel, err) &&
              read_content(view, &out->content, err) &&
              read_level(view, out, err) && read_symbols(view, out, err) &&
              read_mesh(view, &out->mesh, err);
    out->before_m = before_mm / 1000;
    return ok;
}

static bool is_taken(const Equip *equip, int displays, int eyes, const char *name)
{
    bool found = false;
    for (int i = 0; i < displays && !found; i++)
        found = !strcmp(equip->displays[i].name, name);
    for (int i = 0; i < eyes && !found; i++) found = !strcmp(equip->eyes[i].name, name);
    return found;
}

static bool read_displays(const JsonView *root, Equip *out, Error *err)
{
    static const char *const keys[] = {"name", "on", "centre_m", "right", "up", "width_m",
                                       "height_m", "before_mm", "panel", "content", "level",
                                       "max_level", "any_size", "symbols", "mesh"};
    int count;
    if (!field_list(root, "displays", EQUIP_DISPLAYS_MAX, &count, err)) return false;
    EquipDisplay *list = ARENA_NEW(root->arena, EquipDisplay, count);
    out->displays = list;
    for (int i = 0; i < count; i++) {
        JsonView view;
        if (!field_item(root, "displays", i, (FieldWords){keys, COUNT_OF(keys)}, &view, err) ||
            !read_display(&view, &list[i], err))
            return false;
        if (is_taken(out, i, 0, list[i].name))
            return field_fails(&view, "name", err, "is '%.60s' once more, required: a new name",
                               list[i].name);
    }
    out->display_count = count;
    return true;
}

/* ---- eyes -------------------------------------------------------------------------------- */

static bool find_target(const JsonView *view, const Equip *equip, EquipEye *eye, Error *err)
{
    const char *names[EQUIP_DISPLAYS_MAX];
    FieldWords  words = {names, equip->display_count};
    int         id = -1;
    for (int i = 0; i < words.count; i++) names[i] = equip->displays[i].name;
    if (!json_object_get(view->object, "looks_at"))
        return position(view, "target_m", eye->target_m, err);
    if (json_object_get(view->object, "target_m"))
        return field_fails(view, "target_m", err,
                           "stands beside \"looks_at\", required: one of the two");
    if (!words.count)
        return field_fails(view, "looks_at", err,
                           "names a display where there is none, required: \"target_m\"");
    if (!field_choice(view, "looks_at", words, &id, err)) return false;
    memcpy(eye->target_m, equip->displays[id].centre_m, sizeof eye->target_m);
    return true;
}

/* What the page writes of an eye whose place somebody typed, or of an older file's. */
static const char *const GIVEN[] = {"set by hand", "as it was saved"};

static bool read_proposal(const JsonView *view, EquipEye *out, Error *err)
{
    const char *from = NULL;
    if (!json_view_text(view, "proposed_from", &from, err)) return false;
    for (int i = 0; from && i < COUNT_OF(GIVEN); i++)
        if (!strcmp(from, GIVEN[i])) return true;
    out->proposed_from = from && from[0] ? from : NULL;
    return true;
}

static bool read_eye(const JsonView *view, const Equip *equip, EquipEye *out, Error *err)
{
    out->place = view->path;
    if (!field_name(view, "name", &out->name, err) ||
        !position(view, "position_m", out->position_m, err) ||
        !read_proposal(view, out, err) || !find_target(view, equip, out, err))
        return false;
    double way = 0;
    for (int i = 0; i < 3; i++) way += pow(out->target_m[i] - out->position_m[i], 2);
    return sqrt(way) >= NEAR_M ||
           field_fails(view, "position_m", err, "is where it looks at, required: another "
                                                "place");
}

static bool read_eyes(const JsonView *root, Equip *out, Error *err)
{
    static const char *const keys[] = {"name", "position_m", "looks_at", "target_m",
                                       "proposed_from"};
    int count;
    if (!field_wanted(root, "eyes", err) ||
        !field_list(root, "eyes", EQUIP_EYES_MAX, &count, err))
        return false;
    EquipEye *list = ARENA_NEW(root->arena, EquipEye, count);
    out->eyes = list;
    for (int i = 0; i < count; i++) {
        JsonView view;
        if (!field_item(root, "eyes", i, (FieldWords){keys, COUNT_OF(keys)}, &view, err) ||
            !read_eye(&view, out, &list[i], err))
            return false;
        if (is_taken(out, out->display_count, i, list[i].name))
            return field_fails(&view, "name", err, "is '%.60s' once more, required: a new name",
                               list[i].name);
    }
    out->eye_count = count;
    return true;
}

/* ---- materials --------------------------------------------------------------------------- */

static bool start_usual(const JsonView *view, EquipMaterial *out, Error *err)
{
    const char **names = ARENA_NEW(view->arena, const char *, usual_material_count);
    int          id = -1;
    usual_material_names(names);
    if (!json_object_get(view->object, "as")) return field_wanted(view, "base_color", err);
    if (!field_choice(view, "as", (FieldWords){names, usual_material_count}, &id, err))
        return false;
    const UsualMaterial *usual = &usual_materials[id];
    out->as = usual->name;
    memcpy(out->base_color, usual->base_color, sizeof out->base_color);
    out->roughness = usual->roughness;
    out->metallic = usual->metallic;
    out->transmission = usual->transmission;
    out->ior = usual->ior;
    return true;
}

static bool read_material(const JsonView *view, EquipMaterial *out, Error *err)
{
    *out = (EquipMaterial){.name = "", .place = view->path, .roughness = 0.6, .ior = 1.5};
    return field_wanted(view, "index", err) &&
           field_integer(view, "index", (FieldBounds){0, MATERIALS_MAX}, &out->index, err) &&
           json_view_text(view, "name", &out->name, err) && start_usual(view, out, err) &&
           field_numbers(view, "base_color", (JsonRange){0, 1, 3}, out->base_color, NULL,
                         err) &&
           json_view_number(view, "roughness", 0, 1, &out->roughness, err) &&
           json_view_number(view, "metallic", 0, 1, &out->metallic, err) &&
           json_view_number(view, "transmission", 0, 1, &out->transmission, err) &&
           json_view_number(view, "ior", 1, 4, &out->ior, err);
}

static bool read_materials(const JsonView *root, Equip *out, Error *err)
{
    static const char *const keys[] = {"index", "name", "as", "base_color", "roughness",
                                       "metallic", "transmission", "ior"};
    int count;
    if (!field_list(root, "materials", MATERIALS_MAX, &count, err)) return false;
    EquipMaterial *list = ARENA_NEW(root->arena, EquipMaterial, count);
    out->materials = list;
    for (int i = 0; i < count; i++) {
        JsonView view;
        if (!field_item(root, "materials", i, (FieldWords){keys, COUNT_OF(keys)}, &view,
                        err) ||
            !read_material(&view, &list[i], err))
            return false;
        for (int j = 0; j < i; j++)
            if (list[j].index == list[i].index)
                return field_fails(&view, "index", err, "is %d once more, required: each once",
                                   list[i].index);
    }
    out->material_count = count;
    return true;
}

/* ---- the review -------------------------------------------------------------------------- */

static bool read_place(const JsonView *root, Equip *out, Error *err)
{
    static const char *const keys[] = {"where", "year", "headings_deg"};
    JsonView view;
    double  *headings = ARENA_NEW(root->arena, double, EQUIP_HEADINGS_MAX);
    if (!json_view_child(root, "place", false, &view, err)) return false;
    out->has_place = view.object != NULL;
    if (!out->has_place) return true;
    out->place = (ReviewPlace){.year = 2026, .headings_deg = headings, .heading_count = 8};
    for (int i = 0; i < 8; i++) headings[i] = 45 * i;
    double *where = out->place.where;
    if (!json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_wanted(&view, "where", err) ||
        !field_numbers(&view, "where", (JsonRange){-1000, 10000, 3}, where, NULL, err) ||
        !field_integer(&view, "year", (FieldBounds){1950, 2100}, &out->place.year, err) ||
        !json_view_numbers(&view, "headings_deg", (JsonRange){0, 360, EQUIP_HEADINGS_MAX},
                           headings, &out->place.heading_count, err))
        return false;
    return (fabs(where[0]) <= 90 && fabs(where[1]) <= 180) ||
           field_fails(&view, "where", err,
                       "is %g, %g: required: a latitude of -90 to 90 and a longitude of -180 "
                       "to 180 degrees",
                       where[0], where[1]);
}

/* The axis nearest to where the first eye looks; of one that looks straight down, -Z. */
static void propose_forward(Equip *out)
{
    const EquipEye *eye = &out->eyes[0];
    double          x = eye->target_m[0] - eye->position_m[0];
    double          z = eye->target_m[2] - eye->position_m[2];
    bool            is_x = fabs(x) > fabs(z);
    out->forward[0] = is_x ? copysign(1, x) : 0;
    out->forward[2] = is_x ? 0 : z > 0 ? 1 : -1;
}

static bool read_forward(const JsonView *root, Equip *out, Error *err)
{
    bool is_given = false;
    propose_forward(out);
    if (!field_unit_vector(root, "forward", out->forward, &is_given, err)) return false;
    out->forward_is_proposed = !is_given;
    return hypot(out->forward[0], out->forward[2]) > VERTICAL ||
           field_fails(root, "forward", err,
                       "is vertical, required: where the vehicle points");
}

static bool read_occupant(const JsonView *root, Equip *out, Error *err)
{
    static const char *const keys[] = {"eye", "shirt"};
    static const char *const shirts[] = {"white", "grey", "black"};
    static const char *const scenes[] = {"occupant", "occupant_grey", "occupant_dark"};
    JsonView    view;
    const char *eyes[EQUIP_EYES_MAX];
    int         shirt = 0;
    out->occupant.eye_id = NO_ID;
    if (!json_view_child(root, "occupant", false, &view, err)) return false;
    if (!view.object) return true;
    for (int i = 0; i < out->eye_count; i++) eyes[i] = out->eyes[i].name;
    if (!json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_wanted(&view, "eye", err) ||
        !field_choice(&view, "eye", (FieldWords){eyes, out->eye_count}, &out->occupant.eye_id,
                      err) ||
        !field_choice(&view, "shirt", (FieldWords){shirts, COUNT_OF(shirts)}, &shirt, err))
        return false;
    out->occupant.shirt = shirts[shirt];
    out->occupant.scene = scenes[shirt];
    out->occupant.name = arena_format(root->arena, "driver in %s", shirts[shirt]);
    return true;
}

static bool read_profile(const JsonView *root, Equip *out, Error *err)
{
    const Profile *profile;
    Error          why;
    out->profile = "iso-15008";
    if (!json_view_text(root, "profile", &out->profile, err)) return false;
    if (!strchr(out->profile, '/') && !strchr(out->profile, '.') &&
        profile_load(out->profile, root->arena, &profile, &why))
        return true;
    return field_fails(root, "profile", err, "is '%.60s', required: one of %s", out->profile,
                       profile_names(root->arena));
}

static bool read_version(const JsonView *root, Error *err)
{
    int version = 0;
    return field_wanted(root, "equip", err) &&
           field_integer(root, "equip", (FieldBounds){EQUIP_VERSION, EQUIP_VERSION}, &version,
                         err);
}

static bool read_all(const JsonView *root, Equip *out, Error *err)
{
    static const char *const keys[] = {"equip", "model", "displays", "eyes", "materials",
                                       "profile", "forward", "place", "occupant"};
    const char *model = "";
    return json_view_check_keys(root, keys, COUNT_OF(keys), err) && read_version(root, err) &&
           json_view_text(root, "model", &model, err) && read_displays(root, out, err) &&
           read_eyes(root, out, err) && read_materials(root, out, err) &&
           read_profile(root, out, err) && read_forward(root, out, err) &&
           read_occupant(root, out, err) && read_place(root, out, err);
}

bool equip_file_read(const char *file, Arena *arena, Equip *out, Error *err)
{
    JsonView root;
    Equip    equip = {.file = file};
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = read_all(&root, &equip, err);
    json_view_close(&root);
    if (ok) *out = equip;
    return ok;
}
