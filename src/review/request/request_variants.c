/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "review/request/request_levels.h"
#include "text/text.h"

#define VARIANTS_MAX 100
#define NAMES_MAX 1000
#define METRES_MAX 100.0
#define HOOD_MAX_M 2.0
#define FINISH_MOST_DEG 20.0 /* beyond, its facets lose light (shaders/display.c) */

static const char *const KEYS[] = {"panels",  "contents",  "levels", "brightness",
                                   "coatings", "glazings", "materials", "nodes", "hoods",
                                   "finishes", "mirror",   "eyes",      "scene", "add"};

/* A variant while it is read, with room for its changes of the scene. */
typedef struct VariantReading {
    RequestReading *reading;
    JsonView        view;
    ReviewVariant  *variant;
    SceneChange    *scene; /* the change's own */
} VariantReading;

static Arena *arena_of(const VariantReading *v)
{
    return v->view.arena;
}

static void say(VariantReading *v, const char *words)
{
    v->variant->words[v->variant->word_count++] = words;
}

static SceneChange *add_change(VariantReading *v, SceneChangeKind kind, const FieldMembers *of,
                               int i)
{
    SceneChange *change = &v->scene[v->variant->change.scene_count++];
    const char  *place = json_view_path(&of->view, of->name[i]);
    *change = (SceneChange){.kind = kind, .name = of->name[i], .file = v->view.file,
                            .place = place};
    return change;
}

/* ---- displays ---------------------------------------------------------------------------- */

static bool read_panels(VariantReading *v, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, "panels", NAMES_MAX, &members, err)) return false;
    SceneOverride *panels = ARENA_NEW(arena_of(v), SceneOverride, members.count);
    for (int i = 0; i < members.count; i++) {
        const char *path = NULL, *name = members.name[i];
        if (!field_file(&members.view, name, &path, err)) return false;
        const char *said = arena_format(arena_of(v), "%s: %s", v->view.file,
                                        json_view_path(&members.view, name));
        panels[i] = (SceneOverride){name, path, said};
        say(v, arena_format(arena_of(v), "panel of %s: %s", name, path_name(path)));
    }
    v->variant->change.panels = panels;
    v->variant->change.panel_count = members.count;
    return true;
}

static bool read_contents(VariantReading *v, Error *err)
{
    ReviewContent *contents;
    int            count;
    if (!request_contents_read(&v->view, &contents, &count, err)) return false;
    for (int i = 0; i < count; i++)
        say(v, arena_format(arena_of(v), "%s shows %s", contents[i].display,
                            path_name(contents[i].path)));
    v->variant->change.contents = contents;
    v->variant->change.content_count = count;
    return true;
}

/* Those that it names must be there: another name would change nothing. */
static bool read_levels(VariantReading *v, Error *err)
{
    const ReviewRequest *request = v->reading->request;
    ReviewVariant       *variant = v->variant;
    FieldWords names = request_level_names(request, arena_of(v));
    JsonView   levels;
    if (!request_levels_of(&v->view, request->max_level, &variant->levels,
                           &variant->level_count, err))
        return false;
    for (int i = 0; i < variant->level_count; i++) {
        const char *name = variant->levels[i].name;
        if (!json_view_child(&v->view, "levels", true, &levels, err) ||
            !field_knows(&levels, name, names, "level", err))
            return false;
        say(v, arena_format(arena_of(v), "level '%s'", name));
    }
    return true;
}

#define BRIGHTNESS_USUAL 10.0 /* times; beyond it per cent may be meant */

static void doubt_brightness(VariantReading *v, const JsonView *view, const ReviewFixedLevel *b)
{
    if (b->level > BRIGHTNESS_USUAL)
        problems_add(v->reading->problems, SEVERITY_WARNING, view->file,
                     json_view_path(view, b->display),
                     "is %g times as bright: if per cent are meant, %g is", b->level,
                     b->level / 100);
}

static bool read_brightness(VariantReading *v, Error *err)
{
    FieldMembers      members;
    ReviewFixedLevel *list;
    if (!field_members(&v->view, "brightness", NAMES_MAX, &members, err) ||
        !request_brightness_read(&members, &list, err))
        return false;
    for (int i = 0; i < members.count; i++) doubt_brightness(v, &members.view, &list[i]);
    for (int i = 0; i < members.count; i++)
        say(v, arena_format(arena_of(v), "%s %g times as bright",
                            strcmp(list[i].display, "*") ? list[i].display : "every display",
                            list[i].level));
    v->variant->change.brightness = list;
    v->variant->change.brightness_count = members.count;
    return true;
}

/* ---- materials --------------------------------------------------------------------------- */

/* Takes the patch. The text is the arena's. */
static const char *patch_text(VariantReading *v, json_t *patch)
{
    char       *text = json_dumps(patch, JSON_COMPACT | JSON_ENCODE_ANY);
    const char *kept = text ? arena_string(arena_of(v), text, strlen(text)) : "{}";
    free(text);
    json_decref(patch);
    return kept;
}

static bool read_materials(VariantReading *v, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, "materials", NAMES_MAX, &members, err)) return false;
    for (int i = 0; i < members.count; i++) {
        json_t *patch = json_object_get(members.view.object, members.name[i]);
        if (!json_is_object(patch))
            return json_view_wrong_kind(&members.view, members.name[i], patch,
                                        "an object, merged into the material", err);
        SceneChange *change = add_change(v, CHANGE_MATERIAL, &members, i);
        change->patch = patch_text(v, json_incref(patch));
        say(v, arena_format(arena_of(v), "material of %s", members.name[i]));
    }
    return true;
}

/* A name is a stack that the program carries; null takes the coating away. */
static bool read_extension(VariantReading *v, const char *key, const char *extension,
                           bool takes_names, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, key, NAMES_MAX, &members, err)) return false;
    for (int i = 0; i < members.count; i++) {
        const char *name = members.name[i], *stack = NULL;
        json_t     *value = json_object_get(members.view.object, name);
        if (takes_names && json_is_string(value)) stack = json_string_value(value);
        else if (!json_is_object(value) && !json_is_null(value))
            return json_view_wrong_kind(&members.view, name, value,
                                        takes_names ? "an object, a stack's name or null"
                                                    : "an object or null", err);
        /* the old one is removed first: it is replaced, not merged */
        add_change(v, CHANGE_MATERIAL, &members, i)->patch = patch_text(
            v, json_pack("{s:{s:n}, s:{s:n}}", "extensions", extension, "extras", extension));
        json_t *inside = stack ? json_pack("{s:s}", "stack", stack) : json_incref(value);
        if (json_is_null(inside)) json_decref(inside);
        else
            add_change(v, CHANGE_MATERIAL, &members, i)->patch =
                patch_text(v, json_pack("{s:{s:o}}", "extensions", extension, inside));
        say(v, json_is_null(value)
                   ? arena_format(arena_of(v), "no %.*s on %s", (int)strlen(key) - 1, key, name)
                   : arena_format(arena_of(v), "%.*s of %s%s%s", (int)strlen(key) - 1, key,
                                  name, stack ? ": " : "", stack ? stack : ""));
    }
    return true;
}

/* ---- geometry ---------------------------------------------------------------------------- */

static void set_words(VariantReading *v, const SceneChange *c)
{
    static const char *const WAYS[3] = {"tilted", "turned", "rolled"};
    const float angles[3] = {c->tilt, c->turn, c->roll};
    Text        text = {.arena = arena_of(v)};
    text_add(&text, c->name);
    for (int i = 0; i < 3; i++)
        if (angles[i] != 0)
            text_format(&text, " %s by %.4g°", WAYS[i],
                        (double)degrees_from_radians((double)angles[i]));
    if (c->hinge.angle != 0)
        text_format(&text, " swung by %.4g°",
                    (double)degrees_from_radians((double)c->hinge.angle));
    if (c->move_m[0] != 0 || c->move_m[1] != 0 || c->move_m[2] != 0)
        text_format(&text, " moved by (%.4g, %.4g, %.4g) m", (double)c->move_m[0],
                    (double)c->move_m[1], (double)c->move_m[2]);
    say(v, text.data);
}

/* Absent: none. */
static bool read_hinge(const JsonView *node, SceneHinge *out, Error *err)
{
    static const char *const keys[] = {"axis", "through_m", "angle_deg"};
    JsonView view;
    double   axis[3] = {0, 0, 0}, through[3] = {0, 0, 0}, angle = 0;
    bool     has_point = false;
    if (!json_object_get(node->object, "hinge")) return true;
    if (!json_view_child(node, "hinge", true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_wanted(&view, "axis", err) || !field_wanted(&view, "angle_deg", err) ||
        !field_unit_vector(&view, "axis", axis, NULL, err) ||
        !json_view_number(&view, "angle_deg", -180, 180, &angle, err) ||
        !field_numbers(&view, "through_m", (JsonRange){-1e6, 1e6, 3}, through, &has_point, err))
        return false;
    *out = (SceneHinge){.is_own = !has_point, .angle = (float)radians_from_degrees(angle)};
    for (int k = 0; k < 3; k++) {
        out->axis[k] = (float)axis[k];
        out->through_m[k] = (float)through[k];
    }
    return true;
}

static bool read_node(VariantReading *v, const FieldMembers *members, int i, Error *err)
{
    static const char *const keys[] = {"tilt_deg", "turn_deg", "roll_deg",
                                       "hinge",    "move_m",   "with"};
    JsonView     view;
    double       angle[3] = {0, 0, 0}, move[3] = {0, 0, 0};
    const char **with = NULL;
    SceneChange *change = add_change(v, CHANGE_NODES, members, i);
    if (!json_view_child(&members->view, members->name[i], true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err))
        return false;
    for (int k = 0; k < 3; k++)
        if (!json_view_number(&view, keys[k], -180, 180, &angle[k], err)) return false;
    if (!field_numbers(&view, "move_m", (JsonRange){-METRES_MAX, METRES_MAX, 3}, move, NULL,
                       err) ||
        !field_names(&view, "with", "a node's name", &with, &change->with_count, err) ||
        !read_hinge(&view, &change->hinge, err))
        return false;
    change->with = with;
    change->tilt = (float)radians_from_degrees(angle[0]);
    change->turn = (float)radians_from_degrees(angle[1]);
    change->roll = (float)radians_from_degrees(angle[2]);
    for (int k = 0; k < 3; k++) {
        change->move_m[k] = (float)move[k];
        change->ahead[k] = (float)v->reading->request->forward[k];
    }
    set_words(v, change);
    return true;
}

static bool read_nodes(VariantReading *v, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, "nodes", NAMES_MAX, &members, err)) return false;
    for (int i = 0; i < members.count; i++)
        if (!read_node(v, &members, i, err)) return false;
    return true;
}

static bool read_hoods(VariantReading *v, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, "hoods", NAMES_MAX, &members, err)) return false;
    for (int i = 0; i < members.count; i++) {
        double depth = 0;
        if (!json_view_number(&members.view, members.name[i], 1e-3, HOOD_MAX_M, &depth, err))
            return false;
        add_change(v, CHANGE_HOOD, &members, i)->depth_m = (float)depth;
        say(v, arena_format(arena_of(v), "hood of %.4g mm over %s", 1000 * depth,
                            members.name[i]));
    }
    return true;
}

/* Of a lobe whose full width at half its height is `width` radians: facets turn light by twice
 * their slope's angle, and GGX falls to a half where tan^2 = alpha^2 (sqrt 2 - 1). */
static double alpha_of(double width)
{
    return tan_d(width / 4) / sqrt(sqrt(2.0) - 1);
}

static bool read_finish(VariantReading *v, const FieldMembers *members, int i, Error *err)
{
    static const char *const keys[] = {"scatters", "width_deg"};
    const char  *name = members->name[i];
    SceneChange *change = add_change(v, CHANGE_FINISH, members, i);
    double       share = 0, width = 0;
    JsonView     view;
    if (!json_view_child(&members->view, name, true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_wanted(&view, "scatters", err) || !field_wanted(&view, "width_deg", err) ||
        !json_view_number(&view, "scatters", 0, 1, &share, err) ||
        !json_view_number(&view, "width_deg", 0.3, FINISH_MOST_DEG, &width, err))
        return false;
    change->finish = (DisplayFinish){(float)share,
                                     (float)alpha_of(radians_from_degrees(width))};
    say(v, arena_format(arena_of(v), "%s matte: %.3g %% of its mirror image scattered, %.3g° "
                        "wide (modelled)", name, 100 * share, width));
    return true;
}

static bool read_finishes(VariantReading *v, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, "finishes", NAMES_MAX, &members, err)) return false;
    for (int i = 0; i < members.count; i++)
        if (!read_finish(v, &members, i, err)) return false;
    return true;
}

/* The plane is vertical and along where the vehicle points. */
static bool read_mirror(VariantReading *v, Error *err)
{
    static const char *const keys[] = {"middle_m"};
    const double *ahead = v->reading->request->forward;
    JsonView      view;
    double        middle = 0;
    if (!json_object_get(v->view.object, "mirror")) return true;
    if (!json_view_child(&v->view, "mirror", true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !json_view_number(&view, "middle_m", -METRES_MAX, METRES_MAX, &middle, err))
        return false;
    ReviewMirror *mirror = ARENA_NEW(arena_of(v), ReviewMirror, 1);
    SceneChange  *change = &v->scene[v->variant->change.scene_count++];
    double        level = hypot_d(ahead[0], ahead[2]);
    *mirror = (ReviewMirror){{-ahead[2] / level, 0, ahead[0] / level}, middle};
    *change = (SceneChange){.kind = CHANGE_MIRROR, .name = "", .middle_m = (float)middle,
                            .file = v->view.file, .place = view.path};
    for (int k = 0; k < 3; k++) change->ahead[k] = (float)ahead[k];
    v->variant->change.mirror = mirror;
    say(v, arena_format(arena_of(v), "mirrored, at %.4g m right of the origin; displays "
                        "are not", middle));
    return true;
}

/* ---- eyes, files ------------------------------------------------------------------------- */

static bool read_eye(VariantReading *v, const FieldMembers *members, int i, Error *err)
{
    static const char *const keys[] = {"move_m"};
    JsonView view;
    const ReviewRequest *request = v->reading->request;
    const char          *name = members->name[i];
    if (!json_view_child(&members->view, name, true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_wanted(&view, "move_m", err) ||
        !field_knows(&members->view, name, request_eye_names(request, arena_of(v)), "eye", err))
        return false;
    const ReviewEye *eye = review_eye_named(request, name);
    double *move = v->variant->eye_moves[eye - request->eyes];
    if (!field_numbers(&view, "move_m", (JsonRange){-METRES_MAX, METRES_MAX, 3}, move, NULL,
                       err))
        return false;
    say(v, arena_format(arena_of(v), "%s moved by (%.4g, %.4g, %.4g) m", name, move[0], move[1],
                        move[2]));
    return true;
}

static bool read_eyes(VariantReading *v, Error *err)
{
    FieldMembers members;
    if (!field_members(&v->view, "eyes", NAMES_MAX, &members, err)) return false;
    if (members.count)
        v->variant->eye_moves = (double(*)[3])ARENA_NEW(arena_of(v), double,
                                                        3 * v->reading->request->eye_count);
    for (int i = 0; i < members.count; i++)
        if (!read_eye(v, &members, i, err)) return false;
    return true;
}

static bool read_files(VariantReading *v, Error *err)
{
    ReviewVariant *variant = v->variant;
    if (!field_files(&v->view, "scene", &variant->scenes, &variant->scene_count, err) ||
        !field_files(&v->view, "add", &variant->more, &variant->more_count, err))
        return false;
    if (variant->scene_count)
        say(v, arena_format(arena_of(v), "scene %s", path_name(variant->scenes[0])));
    for (int i = 0; i < variant->more_count; i++)
        say(v, arena_format(arena_of(v), "with %s", path_name(variant->more[i])));
    return true;
}

/* ---- a variant --------------------------------------------------------------------------- */

/* An upper bound of its changes: the members of its members. */
static size_t room_for(const JsonView *view)
{
    const char *key;
    json_t     *value;
    size_t      room = 0;
    json_object_foreach(view->object, key, value)
        room += json_is_array(value) ? json_array_size(value) : json_object_size(value);
    return room + 1;
}

static bool read_variant(RequestReading *reading, const FieldMembers *members, int i,
                         Error *err)
{
    VariantReading v = {.reading = reading, .variant = &reading->request->variants[i]};
    if (!json_view_child(&members->view, members->name[i], true, &v.view, err) ||
        !json_view_check_keys(&v.view, KEYS, COUNT_OF(KEYS), err))
        return false;
    if (!json_object_size(v.view.object))
        return field_fails(&members->view, members->name[i], err,
                           "changes nothing, required: one of 'panels', 'levels', 'nodes' ...");
    size_t room = 2 * room_for(&v.view);
    *v.variant = (ReviewVariant){.name = members->name[i],
                                 .words = ARENA_NEW(v.view.arena, const char *, room)};
    v.variant->change.place = v.view.path;
    v.variant->change.scene = v.scene = ARENA_NEW(v.view.arena, SceneChange, room);
    return read_panels(&v, err) && read_contents(&v, err) && read_levels(&v, err) &&
           read_brightness(&v, err) &&
           read_extension(&v, "coatings", "PARHELION_coating", true, err) &&
           read_extension(&v, "glazings", "PARHELION_glazing", false, err) &&
           read_materials(&v, err) && read_nodes(&v, err) && read_hoods(&v, err) &&
           read_finishes(&v, err) &&
           read_mirror(&v, err) && read_eyes(&v, err) && read_files(&v, err);
}

bool request_variants_read(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_members(&reading->root, "variants", VARIANTS_MAX, &members, err)) return false;
    request->variants = ARENA_NEW(reading->root.arena, ReviewVariant, members.count);
    request->variant_count = members.count;
    for (int i = 0; i < members.count; i++)
        if (!read_variant(reading, &members, i, err)) return false;
    return true;
}
