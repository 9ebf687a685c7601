/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "record/rows.h"
#include "review/request/request_format.h"
#include "text/text.h"

#define METRES_MAX 100.0
#define NAMES_MAX 1000
#define BRIGHTNESS_USUAL 10.0 /* times; beyond it per cent may be meant */

/* ---- by display -------------------------------------------------------------------------- */

static bool check_panel(const JsonView *view, void *item, Error *err) {
    SceneOverride *panel = item;
    (void)err;
    panel->said =
        arena_format(view->arena, "%s: %s", view->file, json_view_path(view, panel->material));
    return true;
}

static const RecordRow PANEL = {.kind = RECORD_FILE, RECORD_AT(SceneOverride, value)};
static const RecordFormat panel_format = {"panel", sizeof(SceneOverride), .value = &PANEL,
                                          .check = check_panel};

static bool check_brightness(const JsonView *view, void *item, Error *err) {
    const ReviewFixedLevel *b = item;
    (void)err;
    if (b->level > BRIGHTNESS_USUAL)
        problems_add(view->problems, SEVERITY_WARNING, view->file, json_view_path(view, b->display),
                     "is %g times as bright: if per cent are meant, %g is", b->level,
                     b->level / 100);
    return true;
}

static const RecordRow BRIGHTNESS = {
    .kind = RECORD_NUMBER, RECORD_AT(ReviewFixedLevel, level), RECORD_RANGE(0, 100)};
static const RecordFormat brightness_format = {"brightness", sizeof(ReviewFixedLevel),
                                               .value = &BRIGHTNESS, .check = check_brightness};

/* A hood's depth in m is kept as a level is. */
static const RecordRow HOOD = {
    .kind = RECORD_NUMBER, RECORD_AT(ReviewFixedLevel, level), RECORD_RANGE(1e-3, 2)};
static const RecordFormat hood_format = {"hood", sizeof(ReviewFixedLevel), .value = &HOOD};

typedef struct FinishSaid {
    const char *display;
    double scatters, width_deg;
} FinishSaid;

#define OWNER FinishSaid

/* Wider than 20 degrees its facets lose light (shaders/display.c). */
static const RecordRow FINISH[] = {
    NUMBER("scatters", MUST, scatters, 0, 1, "Share of its mirror image that becomes haze."),
    NUMBER("width_deg", MUST, width_deg, 0.3, 20,
           "Of the haze: full width at half its height, as it is reflected."),
    {0}};
static const RecordFormat finish_format = {"finish", sizeof(OWNER), FINISH, .doc = NULL};
#undef OWNER

/* ---- by material ------------------------------------------------------------------------- */

/* JSON of a material's; valid while the file is read. */
typedef struct PatchSaid {
    const char *material;
    json_t *json;
} PatchSaid;

/* The row's schema names the kinds that it takes, its words say them. */
static bool read_patch(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    json_t *value = json_object_get(view->object, row->key);
    if (!json_is_object(value) && !(json_is_null(value) && strstr(row->schema, "null")) &&
        !(json_is_string(value) && strstr(row->schema, "string")))
        return json_view_wrong_kind(view, row->key, value, row->words[0], err);
    ((PatchSaid *)item)->json = value;
    return true;
}

#define PATCH_FORMAT(name, VALUE, kinds, said) \
    static const char *const VALUE##_WORDS[] = {said}; \
    static const RecordRow VALUE = {.kind = RECORD_OWN, \
                                    .read = read_patch, \
                                    .words = VALUE##_WORDS, \
                                    .schema = "{'type': " kinds "}"}; \
    static const RecordFormat name = {#name, sizeof(PatchSaid), .value = &VALUE}

PATCH_FORMAT(coating_format, COATING, "['object', 'string', 'null']",
             "an object, a stack's name or null");
PATCH_FORMAT(glazing_format, GLAZING, "['object', 'null']", "an object or null");
PATCH_FORMAT(material_format, MATERIAL, "'object'", "an object, merged into the material");

/* ---- by node, by eye --------------------------------------------------------------------- */

#define OWNER SceneHinge

static const RecordRow HINGE[] = {VECTOR("axis", MUST | RECORD_UNIT | RECORD_FLOAT, axis, 3, -1e6,
                                         1e6, "In the scene's axes; of any length but 0."),
                                  VECTOR("through_m", RECORD_OPEN, through_m, 3, -1e6, 1e6,
                                         "A point of the axis, m; default: the node's own origin."),
                                  NUMBER("angle_deg", MUST | RECORD_RADIANS | RECORD_FLOAT, angle,
                                         -180, 180, "Anticlockwise as seen against the axis."),
                                  {0}};

static bool check_hinge(const JsonView *view, void *item, Error *err) {
    (void)err;
    ((SceneHinge *)item)->is_own = !record_has(view, "through_m");
    return true;
}

static const RecordFormat hinge_format = {"hinge", sizeof(OWNER), HINGE, .check = check_hinge};
#undef OWNER
#define OWNER SceneChange
#define ANGLE(key, member, words) \
    NUMBER(key, RECORD_RADIANS | RECORD_FLOAT, member, -180, 180, words)

static const RecordRow NODE[] = {
    ANGLE("tilt_deg", tilt, "Its face turns up, about its middle and its own level axis."),
    ANGLE("turn_deg", turn, "To the right of who faces it."),
    ANGLE("roll_deg", roll, "Clockwise, as seen by who faces it."),
    VECTOR("move_m", RECORD_FLOAT, move_m, 3, -METRES_MAX, METRES_MAX, "In the scene's axes."),
    {"with", RECORD_TEXTS, RECORD_MANY(OWNER, with, with_count), RECORD_COUNT(1, NAMES_MAX),
     .doc = "Nodes of the same file that move along: glass, rim."},
    OBJECT("hinge", 0, hinge, hinge_format,
           "It turns about this axis, as a door that opens, after tilt, turn and roll."),
    {0}};
static const RecordFormat node_format = {"node", sizeof(OWNER), NODE, .doc = NULL};
#undef OWNER

typedef struct EyeMove {
    const char *eye;
    double move_m[3];
} EyeMove;

#define OWNER EyeMove

static const RecordRow EYE_MOVE[] = {
    VECTOR("move_m", MUST, move_m, 3, -METRES_MAX, METRES_MAX, "In the scene's axes."), {0}};
static const RecordFormat eye_format = {"eye_move", sizeof(OWNER), EYE_MOVE, .doc = NULL};
#undef OWNER

/* ---- a variant as the file has it -------------------------------------------------------- */

typedef struct MirrorSaid {
    double middle_m;
} MirrorSaid;

#define OWNER MirrorSaid

static const RecordRow MIRROR[] = {
    NUMBER("middle_m", 0, middle_m, -METRES_MAX, METRES_MAX,
           "Where its middle plane stands, to the right of the scene's origin, m."),
    {0}};
static const RecordFormat mirror_format = {"mirror", sizeof(OWNER), MIRROR, .doc = NULL};
#undef OWNER

/* What a variant keeps as the file has it, and what becomes changes of its scene. */
typedef struct VariantSaid {
    ReviewVariant of;
    const PatchSaid *coatings, *glazings, *materials;
    const SceneChange *nodes;
    const ReviewFixedLevel *hoods;
    const FinishSaid *finishes;
    const MirrorSaid *mirror;
    const EyeMove *eyes;
    int coating_count, glazing_count, material_count, node_count, hood_count, finish_count,
        eye_count;
} VariantSaid;

#define OWNER VariantSaid
#define BY_NAME(key, member, counted, format, words) \
    MAP(key, 0, member, counted, NAMES_MAX, format, words)

static const RecordRow VARIANT[] = {
    BY_NAME("panels", of.change.panels, of.change.panel_count, panel_format,
            "By display: its panel."),
    BY_NAME("contents", of.change.contents, of.change.content_count, review_content_format,
            "By display: what it shows, in every condition."),
    {"levels", RECORD_MAP, RECORD_MANY(OWNER, of.levels, of.level_count),
     RECORD_COUNT(1, NAMES_MAX), .among = &review_level_names, .of = &review_level_format,
     .doc = "They take the places of the review's of their names."},
    BY_NAME("brightness", of.change.brightness, of.change.brightness_count, brightness_format,
            "By display (* all others): times as bright, whatever sets its level."),
    BY_NAME("coatings", coatings, coating_count, coating_format,
            "By material: a PARHELION_coating instead of its own, a stack's name, or null for "
            "none. Files count from the scene's."),
    BY_NAME("glazings", glazings, glazing_count, glazing_format,
            "By material: a PARHELION_glazing instead of its own, or null for none."),
    BY_NAME("materials", materials, material_count, material_format,
            "By material: JSON that is merged into it (RFC 7396). Files count from the "
            "scene's."),
    BY_NAME("nodes", nodes, node_count, node_format,
            "By node: how it is turned and moved, with all that hangs below it."),
    BY_NAME("hoods", hoods, hood_count, hood_format,
            "By display: a hood that reaches so far out, m."),
    BY_NAME("finishes", finishes, finish_count, finish_format,
            "By display: a matte surface in place of its clear one. Modelled."),
    OBJECT("mirror", RECORD_APART, mirror, mirror_format,
           "A right-hand drive of a left-hand one: all of the scene, lamps and people "
           "included, eyes and sensors are mirrored at the vehicle's vertical middle plane. "
           "Displays keep their panels and contents as they are. Sun and sky stay."),
    {"eyes", RECORD_MAP, RECORD_MANY(OWNER, eyes, eye_count), RECORD_COUNT(1, NAMES_MAX),
     .among = &review_eye_names, .of = &eye_format, .doc = "By eye: where it is moved."},
    FILES("scene", 0, of.scenes, of.scene_count, 256, "Instead of the review's."),
    FILES("add", 0, of.more, of.more_count, 256, "More files of the scene."),
    {0}};

static const RecordFormat said_format = {"variant", sizeof(OWNER), VARIANT,
                                         .rules = "{'minProperties': 1}"};

/* ---- and what it changes ----------------------------------------------------------------- */

/* view: of the variant. */
typedef struct Making {
    const JsonView *view;
    const VariantSaid *said;
    ReviewVariant *variant;
    SceneChange *scene; /* the change's own */
} Making;

static void say(Making *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(Making *m, const char *format, ...) {
    va_list list;
    va_start(list, format);
    m->variant->words[m->variant->word_count++] =
        arena_format_list(m->view->arena, ARENA_FORMAT_MOST, format, list);
    va_end(list);
}

/* group: the member that it stands in. */
static SceneChange *add_change(Making *m, SceneChangeKind kind, const char *group,
                               const char *name) {
    SceneChange *change = &m->scene[m->variant->change.scene_count++];
    const double *ahead = ((const ReviewRequest *)m->view->whole)->forward;
    *change = (SceneChange){.kind = kind,
                            .name = name,
                            .file = m->view->file,
                            .place = arena_format(m->view->arena, "%s/%s%s%s", m->view->path, group,
                                                  *name ? "/" : "", name)};
    if (kind == CHANGE_NODES || kind == CHANGE_MIRROR)
        for (int k = 0; k < 3; k++) change->ahead[k] = (float)ahead[k];
    return change;
}

/* Those of displays: their words alone. */
static void make_displays(Making *m) {
    const ReviewChange *change = &m->variant->change;
    for (int i = 0; i < change->panel_count; i++)
        say(m, "panel of %s: %s", change->panels[i].material, path_name(change->panels[i].value));
    for (int i = 0; i < change->content_count; i++)
        say(m, "%s shows %s", change->contents[i].display, path_name(change->contents[i].path));
    for (int i = 0; i < m->variant->level_count; i++)
        say(m, "level '%s'", m->variant->levels[i].name);
    for (int i = 0; i < change->brightness_count; i++) {
        const ReviewFixedLevel *b = &change->brightness[i];
        say(m, "%s %g times as bright", strcmp(b->display, "*") ? b->display : "every display",
            b->level);
    }
}

/* Takes the patch. The text is the arena's. */
static void add_patch(Making *m, const char *group, const char *material, json_t *patch) {
    char *text = json_dumps(patch, JSON_COMPACT | JSON_ENCODE_ANY);
    add_change(m, CHANGE_MATERIAL, group, material)->patch =
        text ? arena_string(m->view->arena, text, strlen(text)) : "{}";
    free(text);
    json_decref(patch);
}

/* A name is a stack that the program carries; null takes the coating away. The old one is
 * removed first: it is replaced, not merged. */
static void make_extension(Making *m, const char *group, const char *extension,
                           const PatchSaid *p) {
    const char *stack = json_string_value(p->json);
    int one = (int)strlen(group) - 1; /* "coating" */
    add_patch(m, group, p->material,
              json_pack("{s:{s:n}, s:{s:n}}", "extensions", extension, "extras", extension));
    if (json_is_null(p->json)) {
        say(m, "no %.*s on %s", one, group, p->material);
        return;
    }
    add_patch(m, group, p->material,
              json_pack("{s:{s:o}}", "extensions", extension,
                        stack ? json_pack("{s:s}", "stack", stack) : json_incref(p->json)));
    say(m, "%.*s of %s%s%s", one, group, p->material, stack ? ": " : "", stack ? stack : "");
}

static void make_materials(Making *m) {
    const VariantSaid *said = m->said;
    for (int i = 0; i < said->coating_count; i++)
        make_extension(m, "coatings", "PARHELION_coating", &said->coatings[i]);
    for (int i = 0; i < said->glazing_count; i++)
        make_extension(m, "glazings", "PARHELION_glazing", &said->glazings[i]);
    for (int i = 0; i < said->material_count; i++) {
        const PatchSaid *p = &said->materials[i];
        add_patch(m, "materials", p->material, json_incref(p->json));
        say(m, "material of %s", p->material);
    }
}

static void make_node(Making *m, const SceneChange *said) {
    static const char *const WAYS[3] = {"tilted", "turned", "rolled"};
    SceneChange *c = add_change(m, CHANGE_NODES, "nodes", said->name);
    const float angles[3] = {said->tilt, said->turn, said->roll};
    Text text = {.arena = m->view->arena};
    c->tilt = said->tilt, c->turn = said->turn, c->roll = said->roll;
    c->hinge = said->hinge, c->with = said->with, c->with_count = said->with_count;
    memcpy(c->move_m, said->move_m, sizeof c->move_m);
    text_add(&text, c->name);
    for (int i = 0; i < 3; i++)
        if (angles[i] != 0)
            text_format(&text, " %s by %.4g°", WAYS[i],
                        (double)degrees_from_radians((double)angles[i]));
    if (c->hinge.angle != 0)
        text_format(&text, " swung by %.4g°", (double)degrees_from_radians((double)c->hinge.angle));
    if (c->move_m[0] != 0 || c->move_m[1] != 0 || c->move_m[2] != 0)
        text_format(&text, " moved by (%.4g, %.4g, %.4g) m", (double)c->move_m[0],
                    (double)c->move_m[1], (double)c->move_m[2]);
    m->variant->words[m->variant->word_count++] = text.data;
}

/* Of a lobe whose full width at half its height is `width` radians: facets turn light by twice
 * their slope's angle, and GGX falls to a half where tan^2 = alpha^2 (sqrt 2 - 1). */
static double alpha_of(double width) {
    return tan_d(width / 4) / sqrt(sqrt(2.0) - 1);
}

static void make_surfaces(Making *m) {
    const VariantSaid *said = m->said;
    for (int i = 0; i < said->hood_count; i++) {
        const ReviewFixedLevel *h = &said->hoods[i];
        add_change(m, CHANGE_HOOD, "hoods", h->display)->depth_m = (float)h->level;
        say(m, "hood of %.4g mm over %s", 1000 * h->level, h->display);
    }
    for (int i = 0; i < said->finish_count; i++) {
        const FinishSaid *f = &said->finishes[i];
        add_change(m, CHANGE_FINISH, "finishes", f->display)->finish = (DisplayFinish){
            (float)f->scatters, (float)alpha_of(radians_from_degrees(f->width_deg))};
        say(m, "%s matte: %.3g %% of its mirror image scattered, %.3g° wide (modelled)", f->display,
            100 * f->scatters, f->width_deg);
    }
}

/* The plane is vertical and along where the vehicle points. */
static void make_mirror(Making *m) {
    const double *ahead = ((const ReviewRequest *)m->view->whole)->forward;
    double level = hypot_d(ahead[0], ahead[2]), middle = m->said->mirror->middle_m;
    ReviewMirror *mirror = ARENA_NEW(m->view->arena, ReviewMirror, 1);
    *mirror = (ReviewMirror){{-ahead[2] / level, 0, ahead[0] / level}, middle};
    add_change(m, CHANGE_MIRROR, "mirror", "")->middle_m = (float)middle;
    m->variant->change.mirror = mirror;
    say(m, "mirrored, at %.4g m right of the origin; displays are not", middle);
}

static void make_eyes(Making *m) {
    const ReviewRequest *request = m->view->whole;
    if (!m->said->eye_count) return;
    m->variant->eye_moves = (double(*)[3])ARENA_NEW(m->view->arena, double, 3 * request->eye_count);
    for (int i = 0; i < m->said->eye_count; i++) {
        const EyeMove *moved = &m->said->eyes[i];
        double *move = m->variant->eye_moves[review_eye_named(request, moved->eye) - request->eyes];
        memcpy(move, moved->move_m, sizeof moved->move_m);
        say(m, "%s moved by (%.4g, %.4g, %.4g) m", moved->eye, move[0], move[1], move[2]);
    }
}

static void make_files(Making *m) {
    const ReviewVariant *v = m->variant;
    if (v->scene_count) say(m, "scene %s", path_name(v->scenes[0]));
    for (int i = 0; i < v->more_count; i++) say(m, "with %s", path_name(v->more[i]));
}

static void make_variant(const JsonView *view, const VariantSaid *said, ReviewVariant *out) {
    const ReviewChange *c = &said->of.change;
    int changes = 2 * (said->coating_count + said->glazing_count) + said->material_count +
                  said->node_count + said->hood_count + said->finish_count + 1;
    int words = changes + c->panel_count + c->content_count + said->of.level_count +
                c->brightness_count + said->eye_count + said->of.more_count + 1;
    Making m = {view, said, out, ARENA_NEW(view->arena, SceneChange, changes)};
    const char *name = out->name;
    *out = said->of;
    out->name = name;
    out->words = ARENA_NEW(view->arena, const char *, words);
    out->change.place = view->path;
    out->change.scene = m.scene;
    make_displays(&m);
    make_materials(&m);
    for (int i = 0; i < said->node_count; i++) make_node(&m, &said->nodes[i]);
    make_surfaces(&m);
    if (said->mirror) make_mirror(&m);
    make_eyes(&m);
    make_files(&m);
}

static bool read_variant(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    JsonView inside;
    VariantSaid said = {.coatings = NULL};
    if (!json_view_child(view, row->key, &inside, err)) return false;
    if (!json_object_size(inside.object))
        return record_fails(view, row->key, err,
                            "changes nothing, required: one of 'panels', "
                            "'levels', 'nodes' ...");
    if (!record_read(&inside, &said_format, &said, err)) return false;
    make_variant(&inside, &said, item);
    return true;
}

static const RecordRow VALUE = {.kind = RECORD_OBJECT, .of = &said_format, .read = read_variant};
const RecordFormat review_variant_format = {"variant", sizeof(ReviewVariant), .value = &VALUE};
