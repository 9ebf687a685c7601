/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_file.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/mathd.h"
#include "equip/usual_material.h"
#include "record/rows.h"
#include "review/profile_table.h"
#include "scene/check/display_frame.h"

#define METRES_MAX 1e6
#define LEAST_M 0.001 /* a display's side of any size */
#define MOST_M 100.0
#define LEVEL_MAX 100.0
#define NEAR_M 0.001 /* an eye that is nearer looks nowhere */
#define SQUARE 1e-3  /* of two unit vectors' product */
#define MATERIALS_MAX 10000
#define VERTICAL 1e-6 /* of a unit vector's level part */

#define POSITION(key, flag, member, words) \
    VECTOR(key, flag, member, 3, -METRES_MAX, METRES_MAX, words)

/* ---- displays ---------------------------------------------------------------------------- */

#define OWNER EquipSymbol
static const char *const POLARITIES[] = {"auto", "light-on-dark", "dark-on-light", NULL};

static const RecordRow SYMBOL[] = {
    TEXT("name", MUST | RECORD_FILLED, name, NULL),
    VECTOR("uv", MUST, uv, 4, 0, 1,
           "Left, top, right, bottom of the content, left < right, top < bottom."),
    {"polarity", RECORD_WORD, RECORD_AT(OWNER, polarity), .words = POLARITIES},
    {0}};
#undef OWNER

static bool check_symbol(const JsonView *view, void *item, Error *err) {
    const double *uv = ((const EquipSymbol *)item)->uv;
    return (uv[0] < uv[2] && uv[1] < uv[3]) ||
           record_fails(view, "uv", err,
                        "is [%g, %g, %g, %g], required: left < right and top < bottom", uv[0],
                        uv[1], uv[2], uv[3]);
}

static const RecordFormat symbol_format = {"symbol", sizeof(EquipSymbol), SYMBOL,
                                           .check = check_symbol};

#define OWNER EquipMesh
#define VERTICES EQUIP_VERTICES_MAX
static const RecordRow MESH[] = {
    FIGURES("positions_m", MUST, positions_m, vertex_count, 3, 3 * VERTICES, -METRES_MAX,
            METRES_MAX, "x, y, z of each corner."),
    FIGURES("uv", MUST, uv, uv_count, 2, 2 * VERTICES, 0, 1, "u, v of each corner, v down."),
    FIGURES("triangles", MUST | RECORD_WHOLE, triangles, triangle_count, 3, 6 * VERTICES, 0,
            VERTICES, "Three corners each, against the clock as seen from the front."),
    {0}};
#undef OWNER

/* From numbers to items of so many. */
static bool divide(const JsonView *view, const char *key, int each, int *count, Error *err) {
    if (*count % each)
        return record_fails(view, key, err, "has %d numbers, required: a multiple of %d", *count,
                            each);
    *count /= each;
    return true;
}

static bool check_mesh(const JsonView *view, void *item, Error *err) {
    EquipMesh *mesh = item;
    if (!divide(view, "positions_m", 3, &mesh->vertex_count, err) ||
        !divide(view, "uv", 2, &mesh->uv_count, err) ||
        !divide(view, "triangles", 3, &mesh->triangle_count, err))
        return false;
    if (mesh->uv_count != mesh->vertex_count)
        return record_fails(view, "uv", err, "has %d pairs, required: one of each of %d positions",
                            mesh->uv_count, mesh->vertex_count);
    for (int i = 0; i < 3 * mesh->triangle_count; i++)
        if (mesh->triangles[i] >= mesh->vertex_count)
            return record_fails(view, "triangles", err,
                                "holds %g, required: whole numbers below %d", mesh->triangles[i],
                                mesh->vertex_count);
    return true;
}

static const RecordFormat mesh_format = {
    "mesh", sizeof(EquipMesh), MESH, .check = check_mesh,
    .doc = "A face that is the display itself, curved or cut out, in place of the rectangle: "
           "corners in the world, as far before the face as they are to be."};

#define OWNER EquipDisplay
static const RecordRow DISPLAY[] = {
    TEXT("name", MUST | RECORD_FILLED, name, NULL),
    NOTE("on", 0, "For people: the node that was clicked."),
    POSITION("centre_m", MUST, centre_m, "On the face."),
    POSITION("right", MUST | RECORD_UNIT, right, "Of the picture."),
    POSITION("up", MUST | RECORD_UNIT, up, "At right angles to right."),
    NUMBER("width_m", MUST, width_m, LEAST_M, MOST_M, NULL),
    NUMBER("height_m", MUST, height_m, LEAST_M, MOST_M, NULL),
    FLAG("any_size", 0, any_size, "A width or height outside 0.005 to 1.5 m is meant."),
    NUMBER("before_mm", RECORD_METRES, before_m, 0.05, 1000,
           "So far before the face the display is laid."),
    TEXT("panel", MUST | RECORD_FILLED, panel,
         "A shipped panel's name, or a path as seen from the model."),
    TEXT("content", RECORD_FILLED, content, "Likewise a picture; without it the display is white."),
    NUMBER("max_level", 0, max_level, 1, LEVEL_MAX, "How far the panel can be driven."),
    NUMBER("level", 0, level, 0, LEVEL_MAX, "1 is as measured; above it only up to max_level."),
    LIST("symbols", 0, symbols, symbol_count, 0, EQUIP_SYMBOLS_MAX, symbol_format,
         "What is read of it; empty: nothing. Left out, a review looks for text itself."),
    OBJECT("mesh", 0, mesh, mesh_format, NULL),
    {0}};
#undef OWNER

static void start_display(void *item) {
    *(EquipDisplay *)item = (EquipDisplay){.before_m = 0.5e-3, .level = 1, .max_level = 1};
}

/* Rounding leaves them a little off: up is made square again. */
static bool square(const JsonView *view, EquipDisplay *display, Error *err) {
    double *r = display->right, *u = display->up;
    double along = r[0] * u[0] + r[1] * u[1] + r[2] * u[2], length = 0;
    if (fabs(along) > SQUARE)
        return record_fails(view, "up", err, "stands at %.4g degrees to \"right\", required: 90",
                            acos(along) * 180 / M_PI);
    for (int i = 0; i < 3; i++) u[i] -= along * r[i];
    for (int i = 0; i < 3; i++) length += u[i] * u[i];
    for (int i = 0; i < 3; i++) u[i] /= sqrt(length);
    return true;
}

static bool check_side(const JsonView *view, const EquipDisplay *display, const char *key, double m,
                       Error *err) {
    return display->any_size || display_side_is_plausible(m) ||
           record_fails(view, key, err,
                        "is %.4g m, required: %g to %g m: is the model in metres? If it is "
                        "meant: \"any_size\": true beside it",
                        m, DISPLAY_LEAST_M, DISPLAY_MOST_M);
}

/* 25 is meant as 25 %: a level above what was measured has to say so. */
static bool check_level(const JsonView *view, const EquipDisplay *display, Error *err) {
    return display->level <= display->max_level ||
           record_fails(view, "level", err,
                        "is %g, required: a level from 0 to %g: 1 is as measured, 0.25 a "
                        "quarter of it; \"max_level\" beside it allows a panel driven above "
                        "that",
                        display->level, display->max_level);
}

static bool check_display(const JsonView *view, void *item, Error *err) {
    EquipDisplay *display = item;
    display->place = view->path;
    display->has_symbols = record_has(view, "symbols");
    for (int i = 0; i < display->symbol_count; i++)
        for (int k = 0; k < i; k++)
            if (!strcmp(display->symbols[k].name, display->symbols[i].name))
                return record_fails(view, arena_format(view->arena, "symbols/%d/name", i), err,
                                    "is '%.60s' once more, required: a new name",
                                    display->symbols[i].name);
    return square(view, display, err) &&
           check_side(view, display, "width_m", display->width_m, err) &&
           check_side(view, display, "height_m", display->height_m, err) &&
           check_level(view, display, err);
}

static const RecordFormat display_format = {
    "display",
    sizeof(EquipDisplay),
    DISPLAY,
    start_display,
    check_display,
    .rules = "{'allOf': [{'if': {'not': {'required': ['max_level']}}, "
             "'then': {'properties': {'level': {'maximum': 1}}}}, "
             "{'if': {'not': {'required': ['any_size']}}, 'then': {'properties': {"
             "'width_m': {'minimum': 0.005, 'maximum': 1.5}, "
             "'height_m': {'minimum': 0.005, 'maximum': 1.5}}}}]}"};

/* ---- eyes -------------------------------------------------------------------------------- */

static const RecordNames DISPLAY_NAMES = {"displays", "display", offsetof(Equip, displays),
                                          offsetof(Equip, display_count), sizeof(EquipDisplay)};
static const RecordNames EYE_NAMES = {"eyes", "eye", offsetof(Equip, eyes),
                                      offsetof(Equip, eye_count), sizeof(EquipEye)};

#define OWNER EquipEye
static const RecordRow EYE[] = {
    TEXT("name", MUST | RECORD_FILLED, name, NULL),
    POSITION("position_m", MUST, position_m, NULL),
    TEXT("proposed_from", 0, proposed_from,
         "From what the page proposed it; `set by hand` and `as it was saved`: nobody did. The "
         "review of it says so."),
    {"looks_at", RECORD_REFER, RECORD_AT(OWNER, display_id), .among = &DISPLAY_NAMES,
     .doc = "A display's name."},
    POSITION("target_m", 0, target_m, NULL),
    {0}};
#undef OWNER

static void start_eye(void *item) {
    *(EquipEye *)item = (EquipEye){.target_m = {NAN}, .display_id = NO_ID};
}

/* What the page writes of an eye whose place somebody typed, or of an older file's. */
static const char *const GIVEN[] = {"", "set by hand", "as it was saved"};

static bool check_eye(const JsonView *view, void *item, Error *err) {
    const Equip *equip = view->whole;
    EquipEye *eye = item;
    bool has_target = !isnan(eye->target_m[0]);
    double way = 0;
    eye->place = view->path;
    for (int i = 0; eye->proposed_from && i < COUNT_OF(GIVEN); i++)
        if (!strcmp(eye->proposed_from, GIVEN[i])) eye->proposed_from = NULL;
    if (eye->display_id == NO_ID && !has_target) return record_misses(view, "target_m", err);
    if (eye->display_id != NO_ID && has_target)
        return record_fails(view, "target_m", err,
                            "stands beside \"looks_at\", required: one of the two");
    if (!has_target)
        memcpy(eye->target_m, equip->displays[eye->display_id].centre_m, sizeof eye->target_m);
    for (int k = 0; k < 3; k++) way += pow(eye->target_m[k] - eye->position_m[k], 2);
    return sqrt(way) >= NEAR_M || record_fails(view, "position_m", err,
                                               "is where it looks at, required: another "
                                               "place");
}

static const RecordFormat eye_format = {
    "eye",     sizeof(EquipEye),
    EYE,       start_eye,
    check_eye, .rules = "{'oneOf': [{'required': ['looks_at']}, {'required': ['target_m']}]}"};

/* ---- materials --------------------------------------------------------------------------- */

#define OWNER EquipMaterial
#define USUAL .words = &usual_materials[0].name, .stride = sizeof(UsualMaterial)

/* Its figures; those beside it are read after them. */
static bool read_usual(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    int id;
    EquipMaterial *out = item;
    RecordRow choice = {row->key, RECORD_CHOICE, USUAL};
    if (!record_read_value(view, &choice, &id, err)) return false;
    const UsualMaterial *usual = &usual_materials[id];
    out->as = usual->name;
    memcpy(out->base_color, usual->base_color, sizeof out->base_color);
    out->roughness = usual->roughness;
    out->metallic = usual->metallic;
    out->transmission = usual->transmission;
    out->ior = usual->ior;
    return true;
}

static const RecordRow MATERIAL[] = {
    WHOLE("index", MUST, index, 0, MATERIALS_MAX,
          "In the model's list; its length is glTF's default material."),
    TEXT("name", 0, name, "As the model has it: another is an error."),
    {"as", RECORD_OWN, .read = read_usual, USUAL, .doc = "A usual one, with its figures."},
    VECTOR("base_color", 0, base_color, 3, 0, 1, "Linear Rec.709 reflectance."),
    NUMBER("roughness", 0, roughness, 0, 1, NULL),
    NUMBER("metallic", 0, metallic, 0, 1, NULL),
    NUMBER("transmission", 0, transmission, 0, 1, NULL),
    NUMBER("ior", 0, ior, 1, 4, NULL),
    {0}};
#undef OWNER

static void start_material(void *item) {
    *(EquipMaterial *)item =
        (EquipMaterial){.name = "", .base_color = {NAN}, .roughness = 0.6, .ior = 1.5};
}

static bool check_material(const JsonView *view, void *item, Error *err) {
    EquipMaterial *material = item;
    material->place = view->path;
    return !isnan(material->base_color[0]) || record_misses(view, "base_color", err);
}

static const RecordFormat material_format = {
    "material",
    sizeof(EquipMaterial),
    MATERIAL,
    start_material,
    check_material,
    .rules = "{'anyOf': [{'required': ['as']}, {'required': ['base_color']}]}",
    .doc = "A material of the model is replaced; figures beside `as` change the usual ones."};

/* ---- the review -------------------------------------------------------------------------- */

#define OWNER ReviewPlace
static const RecordRow PLACE[] = {
    VECTOR("where", MUST, where, 3, -1000, 10000,
           "Latitude and longitude in degrees, altitude in metres."),
    WHOLE("year", 0, year, 1950, 2100, NULL),
    FIGURES("headings_deg", 0, headings_deg, heading_count, 1, EQUIP_HEADINGS_MAX, 0, 360, NULL),
    {0}};
#undef OWNER

static bool check_place(const JsonView *view, void *item, Error *err) {
    const double *where = ((const ReviewPlace *)item)->where;
    return (fabs(where[0]) <= 90 && fabs(where[1]) <= 180) ||
           record_fails(view, "where", err,
                        "is %g, %g: required: a latitude of -90 to 90 and a longitude of -180 "
                        "to 180 degrees",
                        where[0], where[1]);
}

static const RecordFormat place_format = {
    "place",
    sizeof(ReviewPlace),
    PLACE,
    .check = check_place,
    .rules = "{'allOf': [{'properties': {'where': {'prefixItems': ["
             "{'minimum': -90, 'maximum': 90}, {'minimum': -180, 'maximum': 180}]}}}]}",
    .doc = "Noon and a year of the review are there."};

#define OWNER EquipOccupant
static const char *const SHIRTS[] = {"white", "grey", "black", NULL};
static const char *const SHIRT_SCENES[] = {"occupant", "occupant_grey", "occupant_dark"};

static const RecordRow OCCUPANT[] = {{"eye", RECORD_REFER, MUST, RECORD_AT(OWNER, eye_id),
                                      .among = &EYE_NAMES, .doc = "An eye's name."},
                                     CHOICE("shirt", 0, shirt_id, SHIRTS, NULL),
                                     {0}};
#undef OWNER

static bool check_occupant(const JsonView *view, void *item, Error *err) {
    EquipOccupant *occupant = item;
    (void)err;
    occupant->scene = SHIRT_SCENES[occupant->shirt_id];
    occupant->name = arena_format(view->arena, "driver in %s", SHIRTS[occupant->shirt_id]);
    return true;
}

static const RecordFormat occupant_format = {
    "occupant", sizeof(EquipOccupant), OCCUPANT, .check = check_occupant,
    .doc = "The shipped driver, seated so that his eyes are where that eye is, in every "
           "condition of the review."};

/* ---- the whole --------------------------------------------------------------------------- */

#define OWNER Equip
static const RecordRow EQUIP[] = {
    {"equip", RECORD_CONST, MUST, .low = EQUIP_VERSION, .doc = "The version of this format."},
    NOTE("model", 0, "For people: which model it was made for."),
    LIST("displays", 0, displays, display_count, 1, EQUIP_DISPLAYS_MAX, display_format, NULL),
    LIST("eyes", MUST, eyes, eye_count, 1, EQUIP_EYES_MAX, eye_format, NULL),
    LIST("materials", 0, materials, material_count, 1, MATERIALS_MAX, material_format, NULL),
    {"profile", RECORD_WORD, RECORD_AT(OWNER, profile), .words = &profile_table[0].name,
     .stride = sizeof(ProfileText), .doc = "A shipped profile's name."},
    POSITION("forward", RECORD_UNIT, forward,
             "Where the vehicle points to; not vertical. Left out: the axis (X or Z) that is "
             "nearest to where the first eye looks."),
    PART("place", place, has_place, place_format, NULL),
    OBJECT("occupant", 0, occupant, occupant_format, NULL),
    {0}};
#undef OWNER

static void start(void *item) {
    static const double headings[] = {0, 45, 90, 135, 180, 225, 270, 315};
    *(Equip *)item = (Equip){
        .profile = "iso-15008",
        .forward = {NAN},
        .place = {.year = 2026, .headings_deg = headings, .heading_count = COUNT_OF(headings)},
        .occupant.eye_id = NO_ID};
}

/* A display and an eye go by different names. */
static bool check_names(const JsonView *root, Error *err) {
    const char **displays, **eyes;
    int display_count = record_names(root, &DISPLAY_NAMES, &displays);
    int count = display_count + record_names(root, &EYE_NAMES, &eyes);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < i; k++) {
            int at = i - display_count;
            const char *name = at < 0 ? displays[i] : eyes[at];
            if (strcmp(name, k < display_count ? displays[k] : eyes[k - display_count]) != 0)
                continue;
            const char *place = at < 0 ? arena_format(root->arena, "displays/%d/name", i)
                                       : arena_format(root->arena, "eyes/%d/name", at);
            return record_fails(root, place, err, "is '%.60s' once more, required: a new name",
                                name);
        }
    return true;
}

static bool check_indices(const JsonView *root, const Equip *equip, Error *err) {
    const EquipMaterial *list = equip->materials;
    for (int i = 0; i < equip->material_count; i++)
        for (int k = 0; k < i; k++)
            if (list[k].index == list[i].index)
                return record_fails(root, arena_format(root->arena, "materials/%d/index", i), err,
                                    "is %d once more, required: each once", list[i].index);
    return true;
}

/* The axis nearest to where the first eye looks; of one that looks straight down, -Z. */
static void propose_forward(Equip *out) {
    const EquipEye *eye = &out->eyes[0];
    double x = eye->target_m[0] - eye->position_m[0];
    double z = eye->target_m[2] - eye->position_m[2];
    bool is_x = fabs(x) > fabs(z);
    out->forward[0] = is_x ? copysign(1, x) : 0;
    out->forward[2] = is_x ? 0 : z > 0 ? 1 : -1;
}

static bool check(const JsonView *root, void *item, Error *err) {
    Equip *equip = item;
    if (!check_names(root, err)) return false;
    equip->forward_is_proposed = isnan(equip->forward[0]);
    if (equip->forward_is_proposed) propose_forward(equip);
    if (!(hypot_d(equip->forward[0], equip->forward[2]) > VERTICAL))
        return record_fails(root, "forward", err,
                            "is vertical, required: where the vehicle "
                            "points");
    return check_indices(root, equip, err);
}

const RecordFormat equip_format = {
    "equip",
    sizeof(Equip),
    EQUIP,
    start,
    check,
    .doc = "Saved by the page of `parhelion equip MODEL`, applied by --with. Metres and "
           "degrees, in the model's world. A display, an eye and whatever the model has go by "
           "different names."};

bool equip_file_read(const char *file, Arena *arena, Equip *out, Error *err) {
    JsonView root;
    Equip equip;
    start(&equip);
    equip.file = file;
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = record_read(&root, &equip_format, &equip, err);
    json_view_close(&root);
    if (ok) *out = equip;
    return ok;
}
