/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/display.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_zones.h"
#include "scene/gltf/document.h"
#include "scene/load/image.h"
#include "scene/gltf/part_draft.h"
#include "scene/load/texture_slot.h"
#include "scene/load/wearer.h"
#include "text/nearest_word.h"

static int add_display(Loader *load, Display display, const char *file, const char *pointer) {
    Material *material = list_item(&load->materials, display.material_id);
    *(Display *)list_add(&load->displays, &load->scratch) = display;
    *(DisplayPlace *)list_add(&load->display_places, &load->scratch) =
        (DisplayPlace){file, load_keep(load, pointer)};
    return material->display_id = load->displays.count - 1;
}

void display_build(GltfFile *file, const GltfValue *extension, int material_id) {
    Loader *load = file->load;
    const char *path = "";
    char pointer[256];
    const GltfValue *panel = tree_member(extension, "panel");
    const Material *material = list_item(&load->materials, material_id);
    if (panel && !document_resolve(file, panel, &path)) return;
    tree_pointer(panel ? panel : extension, pointer, sizeof pointer);
    add_display(load,
                (Display){.name = material->name,
                          .material_id = material_id,
                          .panel_path = load_keep(load, path),
                          .content = texture_slot(file, tree_member(extension, "content")),
                          .level = tree_float(extension, "level", 1),
                          .any_size = tree_boolean(extension, "any_size", false)},
                file->path, pointer);
}

/* ---- the command line's overrides ------------------------------------------------------ */

static bool option_error(Loader *load, const char *option, const char *format, const char *a,
                         const char *b) {
    char message[1024];
    snprintf(message, sizeof message, format, a, b);
    problems_add(load->problems, SEVERITY_ERROR, option, "", "%s", message);
    return false;
}

/* The names that would be right: displays, then, where any material serves, the others. */
static const char *advice(Loader *load, const char *name, bool with_others, char *buffer,
                          int size) {
    int count = 0;
    const char **names = ARENA_NEW(&load->scratch, const char *, load->materials.count);
    for (int pass = 0; pass < 1 + with_others; pass++) {
        for (int i = 0; i < load->materials.count; i++) {
            const Material *m = list_item(&load->materials, i);
            if ((m->display_id == NO_ID) == (pass == 1)) names[count++] = m->name;
        }
    }
    return nearest_word_advice(name, names, count, buffer, size);
}

/* Reports that no material, or none that is a display, has this name. */
static void report_unknown(Loader *load, const char *option, const char *name, bool is_panel) {
    char names[600];
    option_error(load, option,
                 is_panel ? "no material is named \"%.200s\" — %s"
                          : "no display is named \"%.200s\" — %s; --panel makes "
                            "a material one",
                 name, advice(load, name, is_panel, names, (int)sizeof names));
}

static void report_not_display(Loader *load, const char *option, const char *name) {
    char names[600];
    option_error(load, option, "material \"%.200s\" is no display; --panel makes it one — %s", name,
                 advice(load, "", false, names, (int)sizeof names));
}

/* A material that was no display becomes one: it shows what it emitted. */
static int make_display(Loader *load, int material_id) {
    Material *m = list_item(&load->materials, material_id);
    if (m->display_id != NO_ID) return m->display_id;
    return add_display(load,
                       (Display){.name = m->name,
                                 .material_id = material_id,
                                 .panel_path = "",
                                 .content = m->emissive_texture,
                                 .level = 1},
                       "--panel", "");
}

typedef void ApplyOverride(Loader *load, int display_id, const char *option, const char *value);

static void set_panel(Loader *load, int display_id, const char *option, const char *value) {
    Display *display = list_item(&load->displays, display_id);
    display->panel_path = load_keep(load, value);
    *(DisplayPlace *)list_item(&load->display_places, display_id) = (DisplayPlace){option, ""};
}

static void set_content(Loader *load, int display_id, const char *option, const char *value) {
    Error err;
    DecodedImage decoded;
    Display *display = list_item(&load->displays, display_id);
    if (!load_image(load, value, &decoded, &err)) {
        option_error(load, option, "%.300s: %.600s", value, err.text);
        return;
    }
    Texture texture = {.wrap_u = WRAP_CLAMP, .wrap_v = WRAP_CLAMP, .nearest = true};
    if (display->content.texture_id == NO_ID)
        display->content = (TextureSlot){.uv_from_uv = {1, 0, 0, 0, 1, 0}};
    else /* another picture on the same sampler */
        texture = *(const Texture *)list_item(&load->textures, display->content.texture_id);
    texture.image = decoded.image;
    display->content.texture_id = texture_add(load, texture, decoded.words);
}

/* Percent. Below 1 a share may be meant, above 100 what was measured is left: both are said
 * with the unit behind them. */
static void set_level(Loader *load, int display_id, const char *option, const char *value) {
    double percent;
    const char *end = number_read(value, &percent);
    bool has_unit = end && strcmp(end, "%") == 0;
    if (!end || (*end && !has_unit) || !(percent >= 0 && percent <= 1e4)) {
        option_error(load, option,
                     "\"%.100s\" is no percentage; a number from 0 to 10000 is "
                     "required%s",
                     value, "");
        return;
    }
    if (percent > 100 && !has_unit) {
        option_error(load, option,
                     "\"%.100s\" is above 100 percent, what was measured: required 0 to 100, "
                     "or \"%.100s%%\" for a panel that is driven above that",
                     value, value);
        return;
    }
    if (percent > 0 && percent < 1 && !has_unit)
        problems_add(load->problems, SEVERITY_WARNING, option, "",
                     "\"%.40s\" is %g percent, a level of %g: write \"%.40s%%\" if it is "
                     "meant, or \"%g\" for a level of %g",
                     value, percent, percent / 100, value, 100 * percent, percent);
    Display *display = list_item(&load->displays, display_id);
    display->level = (float)(percent / 100);
}

/* "*" means every display; later entries speak last, so that one may differ. */
static bool is_meant(const Material *material, const char *name) {
    if (strcmp(name, "*") == 0) return material->display_id != NO_ID;
    return strcmp(material->name, name) == 0;
}

/* One option's list; set_panel makes a display of any material. */
typedef struct Overrides {
    const char *option;
    const SceneOverride *list;
    int count;
    ApplyOverride *set;
} Overrides;

static void apply_to(Loader *load, const Overrides *overrides, int material_id, const char *value) {
    const Material *material = list_item(&load->materials, material_id);
    if (overrides->set != set_panel && material->display_id == NO_ID)
        report_not_display(load, overrides->option, material->name);
    else overrides->set(load, make_display(load, material_id), overrides->option, value);
}

static void apply_by_name(Loader *load, const Overrides *overrides, const SceneOverride *one) {
    bool is_found = false;
    int count = load->materials.count;
    for (int m = 0; m < count; m++) {
        const Material *material = list_item(&load->materials, m);
        if (!is_meant(material, one->material)) continue;
        is_found = true;
        if (overrides->set == set_panel && material->display_id == NO_ID)
            wearer_warn_of_sharing(load, overrides->option, m);
        apply_to(load, overrides, m, one->value);
    }
    if (!is_found)
        report_unknown(load, overrides->option, one->material, overrides->set == set_panel);
}

static bool is_material(const Loader *load, const char *name) {
    for (int m = 0; m < load->materials.count; m++)
        if (is_meant(list_item(&load->materials, m), name)) return true;
    return false;
}

/* A material whose own name begins with "node:" is still found by it. */
static void apply(Loader *load, Overrides overrides) {
    const char *option = overrides.option;
    for (int i = 0; i < overrides.count; i++) {
        const SceneOverride *one = &overrides.list[i];
        overrides.option = one->said ? one->said : option;
        if (!wearer_is_named(one->material) || is_material(load, one->material)) {
            apply_by_name(load, &overrides, one);
            continue;
        }
        int id = wearer_material(load, overrides.option, one->material);
        if (id != NO_ID) apply_to(load, &overrides, id, one->value);
    }
}

void displays_override(Loader *load) {
    const SceneOptions *o = load->options;
    apply(load, (Overrides){"--panel", o->panels, o->panel_count, set_panel});
    apply(load, (Overrides){"--content", o->contents, o->content_count, set_content});
    apply(load, (Overrides){"--display-level", o->levels, o->level_count, set_level});
}

/* ---- what is tried out ------------------------------------------------------------------- */

/* Of all displays of the material; returns how many there are. */
static int set_finish(Loader *load, const char *material, const DisplayFinish *finish) {
    int count = 0;
    for (int i = 0; i < load->displays.count; i++) {
        Display *display = list_item(&load->displays, i);
        if (strcmp(display->name, material) != 0) continue;
        display->finish = *finish;
        count++;
    }
    return count;
}

void displays_change(Loader *load) {
    for (int i = 0; i < load->options->change_count; i++) {
        const SceneChange *change = &load->options->changes[i];
        const char *name = change->name;
        if (change->kind != CHANGE_FINISH) continue;
        if (wearer_is_named(name) && !is_material(load, name)) {
            int id = wearer_material(load, change->place, name);
            if (id == NO_ID) continue; /* it is reported */
            name = ((const Material *)list_item(&load->materials, id))->name;
        }
        load->change_uses[i] += set_finish(load, name, &change->finish);
    }
}

/* ---- what is checked when all files are read ------------------------------------------- */

static const Panel *find_panel(const Loader *load, int before, const Display *like) {
    for (int i = 0; i < before; i++) {
        const Display *display = list_item(&load->displays, i);
        if (!strcmp(display->panel_path, like->panel_path)) return display->panel;
    }
    return NULL;
}

static void open_panel(Loader *load, int id) {
    Error err;
    Panel *panel;
    FileBytes bytes;
    Display *display = list_item(&load->displays, id);
    const DisplayPlace *place = list_item(&load->display_places, id);
    display->panel = find_panel(load, id, display);
    if (display->panel) return;
    ARENA_NEW(load->arena, uint64_t, 0); /* the next bytes are aligned as a panel needs it */
    if (load_read(load, display->panel_path, load->arena, &bytes, &err) &&
        panel_open_memory(bytes.data, bytes.size, display->panel_path, load->arena, &panel, &err))
        display->panel = panel;
    if (display->panel) return;
    problems_add(load->problems, SEVERITY_ERROR, place->file, place->pointer,
                 "display \"%s\": %s: %s", display->name, display->panel_path, err.text);
}

/* A panel shows the codes that it gets, whatever a viewer would make of them. */
static void warn_of_words(Loader *load, const Display *display, const DisplayPlace *place) {
    const char *words =
        *(const char **)list_item(&load->texture_words, display->content.texture_id);
    if (words && words[0])
        problems_add(load->problems, SEVERITY_WARNING, place->file, place->pointer,
                     "display \"%s\": its content states %s, which is not applied: the values "
                     "are taken as the codes that the panel gets, as they are stored",
                     display->name, words);
}

static void check_content(Loader *load, int id) {
    const Display *display = list_item(&load->displays, id);
    const DisplayPlace *place = list_item(&load->display_places, id);
    if (display->content.texture_id == NO_ID)
        problems_add(load->problems, SEVERITY_WARNING, place->file, place->pointer,
                     "display \"%s\" has no content: it shows full white", display->name);
    else warn_of_words(load, display, place);
}

/* The content's coordinates fix the panel's right and up, so they must not be mirrored. */
static void check_coordinates(Loader *load, const PartDraft *draft) {
    const Material *material = list_item(&load->materials, draft->part.material_id);
    if (material->display_id == NO_ID) return;
    const Display *display = list_item(&load->displays, material->display_id);
    TextureSlot slot = display->content;
    int counts[3] = {0};
    for (uint32_t t = 0; t < draft->triangle_count; t++) {
        Vec3 right;
        counts[draft_triangle_tangent(draft, t, &slot, &right)]++;
    }
    if (counts[2])
        file_error(draft->file, draft->primitive,
                   "display \"%s\": the texture coordinates of %d "
                   "triangles are mirrored, seen from the front",
                   display->name, counts[2]);
    if (counts[0])
        file_error(draft->file, draft->primitive,
                   "display \"%s\": the texture coordinates of %d "
                   "triangles span no area: right and up are unknown",
                   display->name, counts[0]);
}

/* The active area of a panel that is not the same everywhere is what the content's coordinates
 * cover on all that wears the display. */
static void find_place(Loader *load, int id) {
    Display *display = list_item(&load->displays, id);
    float box[4] = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    if (!display->panel) return;
    if (!panel_varies(display->panel) && !panel_zones(display->panel)) return;
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = list_item(&load->parts, i);
        if (draft->part.material_id == display->material_id)
            draft_slot_box(draft, &display->content, box);
    }
    for (int k = 0; k < 2; k++) {
        float low = box[2 * k], size = box[2 * k + 1] - low;
        bool is_area = size > 0 && size < INFINITY; /* else an error is reported elsewhere */
        display->place_from_uv[2 * k] = is_area ? 1 / size : 0;
        display->place_from_uv[2 * k + 1] = is_area ? -low / size : 0.5f;
    }
}

/* ---- local dimming ----------------------------------------------------------------------- */

/* The content of a display, by places of its active area. */
typedef struct ContentPicture {
    const Texture *texture;
    const float *place_from_uv;
} ContentPicture;

static void picture_codes(const void *user, const float place[2], float codes[3]) {
    const ContentPicture *picture = user;
    const float *m = picture->place_from_uv;
    codes[0] = codes[1] = codes[2] = 255;
    texture_codes(picture->texture, (place[0] - m[1]) / m[0], (place[1] - m[3]) / m[2], codes);
}

static int shown_pixels(int pixels, float place_from_uv) {
    return (int)clampf(roundf((float)pixels / fabsf(place_from_uv)), 1, 16384);
}

/* What the content makes of the zones, once and for all frames of the scene. Without content
 * all is white: they are full. */
static void dim_backlight(Loader *load, int id) {
    Display *display = list_item(&load->displays, id);
    const DimmingZones *zones = display->panel ? panel_zones(display->panel) : NULL;
    const float *m = display->place_from_uv;
    if (!zones || display->content.texture_id == NO_ID || !(m[0] * m[2] != 0)) return;
    const Texture *texture = list_item(&load->textures, display->content.texture_id);
    ContentPicture content = {texture, m};
    ShownPicture picture = {shown_pixels(texture->image.width, m[0]),
                            shown_pixels(texture->image.height, m[2]), picture_codes, &content};
    LevelShares levels;
    double *drive = ARENA_NEW(load->arena, double, zones->count[0] * zones->count[1]);
    panel_level_shares(display->panel, &levels);
    backlight_drives(zones, &levels, &picture, drive);
    display->backlight = backlight_make(zones, &levels, drive, load->arena);
}

void displays_finish(Loader *load) {
    for (int i = 0; i < load->displays.count; i++) {
        open_panel(load, i);
        check_content(load, i);
    }
    for (int i = 0; i < load->displays.count; i++) {
        find_place(load, i);
        dim_backlight(load, i);
    }
    for (int i = 0; i < load->parts.count; i++) check_coordinates(load, list_item(&load->parts, i));
}
