/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/symbols.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/sampler.h"
#include "base/units.h"
#include "panel/query/panel_stated.h"
#include "render/identity.h"
#include "review/keep/frame_kept.h"
#include "review/light/response_suns.h"
#include "review/request/request_check.h"
#include "review/symbol/text_find.h"
#include "text/text.h"

/* One list that grows; its elements lie apart, since surfaces are pointed at. */
typedef struct SymbolList {
    const Setup *setup;
    SetupSymbol *list;
    int count;
} SymbolList;

static bool add_symbol(SymbolList *list, SetupSymbol symbol, const SymbolQuestion *question,
                       Arena *arena, Error *err) {
    const Scene *scene = list->setup->scene;
    if (!symbol_split(question, arena, &symbol.split, err)) return false;
    SetupSymbol *kept = &list->list[list->count];
    *kept = symbol;
    SymbolPlace place = {.scene = scene, .display = &kept->display, .point_count = SYMBOL_POINTS};
    SymbolSurface rectangle;
    memcpy(place.uv, question->uv, sizeof place.uv);
    memcpy(kept->uv, question->uv, sizeof kept->uv);
    if (!symbol_surface_build(&place, arena, &rectangle, err) ||
        !symbol_surface_within(&rectangle, kept->split.box, SYMBOL_POINTS, arena, &kept->surface,
                               err))
        return false;
    list->count++;
    return true;
}

#define MASK_BYTES_MAX ((size_t)1 << 30)

/* Without one *file and *mask stay as they are. */
static bool read_mask(const ReviewSymbol *asked, ReviewInput *file, Image *mask, Arena *arena,
                      Error *err) {
    FileBytes bytes;
    if (!asked->mask) return true;
    if (!file_read(asked->mask, MASK_BYTES_MAX, arena, &bytes, err)) return false;
    *file = (ReviewInput){asked->mask, XXH3_64bits(bytes.data, bytes.size)};
    return image_read_memory(bytes.data, bytes.size, asked->mask, arena, mask, err);
}

static bool add_found(SymbolList *list, const SetupSymbol *symbol, SymbolQuestion *question,
                      Arena *arena, Error *err) {
    ContentLight light;
    if (!content_light(question->panel, question->content, question->uv, arena, &light, err))
        return false;
    TextProposal *found;
    int count = text_find(&light, SYMBOLS_FOUND_MOST, arena, &found);
    if (count == 0) return error_set(err, ERROR_INPUT, "no text was found there");
    for (int i = 0; i < count; i++) {
        SetupSymbol one = *symbol;
        one.name = arena_format(arena, "%s %d", symbol->name, i + 1);
        memcpy(question->uv, found[i].uv, sizeof question->uv);
        question->polarity =
            found[i].is_light_on_dark ? POLARITY_LIGHT_ON_DARK : POLARITY_DARK_ON_LIGHT;
        if (!add_symbol(list, one, question, arena, err)) return false;
    }
    return true;
}

static const char *copied(const char *text, Arena *arena) {
    return text ? arena_string(arena, text, strlen(text)) : NULL;
}

CasePanel symbol_panel(const SetupSymbol *symbol, Arena *arena) {
    CasePanel panel = symbol->panel;
    panel.verdict = copied(panel.verdict, arena);
    panel.reason = copied(panel.reason, arena);
    panel.assumed = copied(panel.assumed, arena);
    return panel;
}

/* A shape whose shortest chords are more than a quarter of its height, such as a filled sign or
 * a bar, is not made of strokes: bold faces of type have a fifth, the heaviest a quarter. */
#define STROKE_MOST 0.25

double symbol_stroke_ratio(const SetupSymbol *symbol) {
    const SymbolSplit *split = &symbol->split;
    double ratio = split->stroke_px / (split->character_v * split->light.content_height);
    return ratio <= STROKE_MOST ? ratio : (double)NAN;
}

static bool add_asked(SymbolList *list, int id, Arena *arena, Error *err) {
    const ReviewSymbol *asked = &list->setup->request->symbols[id];
    const Scene *scene = list->setup->scene;
    SetupSymbol symbol = {.name = asked->name, .display_name = asked->display, .symbol_id = id};
    Image mask;
    if (!review_display_find(scene, asked->display, arena, &symbol.display, err)) return false;
    const Display *display = &scene->displays[symbol.display.display_id];
    const ReviewCondition *condition = list->setup->condition;
    int content = display->content.texture_id;
    PanelStated stated = panel_stated(display->panel, arena);
    symbol.panel = (CasePanel){stated.verdict,     stated.reason,         stated.is_coarse,
                               stated.is_unusable, stated.emission_error, stated.reflection_error,
                               stated.assumed};
    SymbolQuestion question = {.panel = display->panel,
                               .content = content == NO_ID ? NULL : &scene->textures[content].image,
                               .uv = {0, 0, 1, 1},
                               .polarity = condition ? condition->polarity[id] : asked->polarity};
    if (asked->has_uv) memcpy(question.uv, asked->uv, sizeof question.uv);
    if (!read_mask(asked, &symbol.mask, &mask, arena, err)) return false;
    if (symbol.mask.path) question.mask = &mask;
    if (asked->find_text) return add_found(list, &symbol, &question, arena, err);
    return add_symbol(list, symbol, &question, arena, err);
}

SymbolPoint symbol_middle(const SetupSymbol *symbol) {
    const double *uv = symbol->surface.uv;
    const double middle[2] = {0.5 * (uv[0] + uv[2]), 0.5 * (uv[1] + uv[3])};
    SymbolPoint point;
    bool is_shown = symbol_surface_at(&symbol->surface, middle, &point);
    return is_shown ? point : symbol->surface.points[0];
}

SymbolVisibility symbol_aim(const SymbolSurface *surface, Arena *arena, ProbeAim *aim) {
    Vec3 *targets = ARENA_NEW(arena, Vec3, surface->point_count);
    ProbePatch *patches = ARENA_NEW(arena, ProbePatch, surface->point_count);
    Arena scratch = *arena;
    bool *is_visible = ARENA_NEW(&scratch, bool, surface->point_count);
    SymbolVisibility seen = symbol_visibility(surface, aim->context, aim->eye, is_visible);
    aim->targets = targets;
    aim->patches = patches;
    aim->target_count = 0;
    for (int i = 0; i < surface->point_count; i++) {
        if (!is_visible[i]) continue;
        SymbolPatch patch = symbol_patch_seen(surface, i, aim->context, aim->eye);
        targets[aim->target_count] = patch.middle;
        patches[aim->target_count++] = (ProbePatch){patch.along, patch.down};
    }
    return seen;
}

/* ---- its parts --------------------------------------------------------------------------- */

#define STEPS_MOST 8 /* in which a part slides over its own length */

/* Cells of one length of the box, of which `steps` make a part. */
static int cells_along(double box, double part, int steps) {
    return part > 0 && part < box ? (int)floor(steps * box / part) : steps;
}

/* Sets how the box is divided into no more than so many cells. */
static void divide(const SymbolSplit *split, int most, LightParts *parts) {
    double width = split->box[2] - split->box[0], height = split->box[3] - split->box[1];
    double stroke = split->stroke_px / split->light.content_width, larger = 1;
    int steps = STEPS_MOST;
    do {
        parts->columns = cells_along(width, larger * stroke, steps);
        parts->rows = cells_along(height, larger * split->character_v, steps);
        parts->wide = parts->high = steps;
        if (steps > 1) steps /= 2;
        else larger *= 2;
    } while ((double)parts->columns * parts->rows > most);
}

static void cell_box(const SymbolSplit *split, const LightParts *parts, const int cell[4],
                     double uv[4]) {
    for (int k = 0; k < 4; k++) {
        double low = split->box[k % 2], high = split->box[k % 2 + 2];
        uv[k] = low + cell[k] * (high - low) / (k % 2 ? parts->rows : parts->columns);
    }
}

/* Left, top, right and bottom of one of them, uv. */
static void symbol_part_box(const SetupSymbol *symbol, const LightParts *parts, int part,
                            double uv[4]) {
    int column, row;
    light_parts_place(parts, part, &column, &row);
    const int cell[4] = {column, row, column + parts->wide, row + parts->high};
    cell_box(&symbol->split, parts, cell, uv);
}

LightParts symbol_parts(const SetupSymbol *symbol, const ProbeAim *aim, int most, Arena *arena) {
    LightParts parts = {.aim = *aim};
    divide(&symbol->split, most, &parts);
    int count = parts.columns * parts.rows;
    Vec3 *targets = ARENA_NEW(arena, Vec3, count);
    ProbePatch *patches = ARENA_NEW(arena, ProbePatch, count);
    int *cell_of = ARENA_NEW(arena, int, count);
    parts.aim.targets = targets;
    parts.aim.patches = patches;
    parts.aim.target_count = 0;
    parts.cell_of = cell_of;
    for (int i = 0; i < count; i++) {
        double uv[4];
        SymbolPatch patch;
        int column = i % parts.columns, row = i / parts.columns;
        const int cell[4] = {column, row, column + 1, row + 1};
        cell_box(&symbol->split, &parts, cell, uv);
        if (!symbol_box_seen(&symbol->surface, uv, aim->context, aim->eye, &patch)) continue;
        targets[parts.aim.target_count] = patch.middle;
        patches[parts.aim.target_count] = (ProbePatch){patch.along, patch.down};
        cell_of[parts.aim.target_count++] = i;
    }
    return parts;
}

bool setup_symbols(const Setup *setup, Arena *arena, SetupSymbol **out, int *count, Error *err) {
    int most = setup->request->symbol_count * SYMBOLS_FOUND_MOST;
    SymbolList list = {setup, ARENA_NEW(arena, SetupSymbol, most), 0};
    for (int id = 0; id < setup->request->symbol_count; id++) {
        if (add_asked(&list, id, arena, err)) continue;
        error_prefix(err, "symbol '%s'", setup->request->symbols[id].name);
        return error_in_file(err, setup->request->file);
    }
    *out = list.list;
    *count = list.count;
    return true;
}

/* ---- through glasses --------------------------------------------------------------------- */

static double brighter(const SymbolEmission *shown) {
    return fmax(shown->xyz[SYMBOL_FOREGROUND][1], shown->xyz[SYMBOL_BACKGROUND][1]);
}

static void polarise(const PolarisedEye *polariser, const SymbolLook *look, ProbeAim *aim,
                     SymbolEmission *shown, Arena *arena) {
    PathContext *context = ARENA_NEW(arena, PathContext, 1);
    double passed = symbol_polarised_share(look->surface, aim->context, look->eye, polariser);
    *context = *aim->context;
    context->eye = polariser;
    aim->context = context;
    for (int i = 0; i < 6; i++) shown->xyz[i / 3][i % 3] *= passed;
}

void symbol_put_on_glasses(const Glasses *glasses, const SymbolLook *look, ProbeAim *aim,
                           SymbolEmission *shown, ReviewCase *c, Arena *arena) {
    double bare = brighter(shown);
    c->glasses_transmittance = glasses->transmittance;
    c->glasses = glasses->words;
    aim->colour = glasses->colour;
    if (glasses->polariser) polarise(glasses->polariser, look, aim, shown, arena);
    if (glasses->colour) symbol_emission_behind(look, glasses->colour, shown);
    c->glasses_display_loss = bare > 0 ? 1 - brighter(shown) / bare : 0;
}

/* ---- its colour -------------------------------------------------------------------------- */

void symbol_colour_start(const SetupSymbol *symbol, const SymbolEmission *shown, ReviewCase *c,
                         Arena *arena) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    const double nan = (double)NAN;
    bool is_light_on_dark = l->foreground >= l->background;
    const double *lit = shown->xyz[is_light_on_dark ? SYMBOL_FOREGROUND : SYMBOL_BACKGROUND];
    ColourLight *light = ARENA_NEW(arena, ColourLight, 1);
    CaseColour *colour = ARENA_NEW(arena, CaseColour, 1);
    *light = (ColourLight){.lit = lit[1],
                           .emission_error = symbol->panel.emission_error,
                           .reflection_error = symbol->panel.reflection_error,
                           .is_on_display = true};
    memcpy(light->emitted, lit, sizeof light->emitted);
    *colour = (CaseColour){.symbol = arena_string(arena, symbol->name, strlen(symbol->name)),
                           .uv = {nan, nan},
                           .dark_uv = {nan, nan},
                           .apart = nan,
                           .low = nan,
                           .high = nan,
                           .light = light};
    c->colours = colour;
    c->colour_count = 1;
}

void symbol_colour_read(const Reading *reading, ReviewCase *c) {
    ColourLight *light = c->colours[0].light;
    light->range = c->reflected_range;
    for (int i = 0; i < CASE_BATCHES; i++) {
        const double xyz[3] = {reading->beside[i][0], reading->batches[i], reading->beside[i][1]};
        memcpy(light->batches[i], xyz, sizeof xyz);
        for (int k = 0; k < 3; k++) light->reflected[k] += xyz[k] / CASE_BATCHES;
    }
    light->reflected[1] = reading->reflected;
}

void symbol_colour_alike(const ColourLight *like, ReviewCase *c) {
    ColourLight *light = c->colours[0].light;
    memcpy(light->reflected, like->reflected, sizeof like->reflected);
    memcpy(light->batches, like->batches, sizeof like->batches);
    light->range = c->reflected_range;
}

/* ---- cells, of which the worst is read --------------------------------------------------- */

#define CELLS_MOST 1024
#define SUN_PATHS 2048         /* the direct sun's, of all cells together */
#define FIELD_PATHS 2048       /* where the direct sun tells parts apart; else */
#define SHADE_PATHS 8192       /* they show a rise of about 15 % in the shipped car, by day */
#define FIELD_SEED 0x6669656cu /* whatever the review's: all seeds judge the same part */
#define MEAN_SEED \
    0x6d65616eu         /* with the review's: what chose the part says no more of the mean \
                         */
#define LIT_POINTS 4096 /* that show the share in the sun: within half a percent */

/* The direct sun of each cell that is seen, and its mean by the display's mirror. */
static double add_sun(const Setup *setup, const LightParts *parts, double *known, Arena scratch) {
    Vec3 towards;
    float bands[3][LIGHT_BANDS];
    if (!setup_sun_xyz(setup, parts->aim.colour, &towards, bands)) return 0;
    ProbeSuns sun = {&towards, 1, (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG), false};
    ResponseOptions options = {setup->tools, 0, SUN_PATHS, 0};
    return sun_parts_light(parts, &options, &sun, bands[1], known, scratch);
}

void worst_part_set_mean(CaseWhole *whole, const Reading *reading) {
    whole->reflected = reading->reflected;
    whole->reflected_range = reading->interval;
}

/* The part, and the mean of all that paths find: of others, by the review's own seed, where a
 * part was chosen; else the judge's reading is one of it. The sun's image is not known by itself
 * as a polariser sees it: paths find it then. */
static int read_all(const Setup *setup, const LightParts *parts, CaseWhole *whole, Arena scratch) {
    int targets = parts->aim.target_count;
    double *known = ARENA_NEW(&scratch, double, targets);
    TargetLight *found = ARENA_NEW(&scratch, TargetLight, targets);
    double sun = add_sun(setup, parts, known, scratch);
    double mirror = parts->aim.context->eye ? 0 : sun;
    PathContext without = *parts->aim.context;
    ProbeAim aim = parts->aim;
    without.without_mirrored_sun = mirror > 0;
    aim.context = &without;
    aim.seed = FIELD_SEED;
    long paths = SHADE_PATHS;
    for (int i = 0; i < targets; i++)
        if (known[i] > 0) paths = FIELD_PATHS;
    Reading mean = reading_field(&aim, paths, mirror, &setup->tools, found, scratch);
    int part = light_parts_choose(parts, found, known, scratch);
    if (part != LIGHT_PARTS_ALL) {
        ReadingGoal goal = {.most = paths, .known = mirror};
        aim.seed = hash_combine(hash_u32(parts->aim.seed), MEAN_SEED);
        mean = reading_take(&aim, &goal, &setup->tools, scratch);
    }
    worst_part_set_mean(whole, &mean);
    return part;
}

static int part_by_sun(const Setup *setup, const LightParts *parts, Arena scratch) {
    double *known = ARENA_NEW(&scratch, double, parts->aim.target_count);
    TargetLight *none = ARENA_NEW(&scratch, TargetLight, parts->aim.target_count);
    add_sun(setup, parts, known, scratch);
    return light_parts_choose(parts, none, known, scratch);
}

/* NaN: there is no sun. */
static double lit_share(const Setup *setup, const PartArgs *args, Arena scratch) {
    Vec3 towards;
    SymbolSurface surface;
    Error ignored;
    bool *is_visible = ARENA_NEW(&scratch, bool, LIT_POINTS);
    if (!setup_sun(setup, &towards, NULL) ||
        !symbol_surface_within(&args->symbol->surface, args->symbol->split.box, LIT_POINTS,
                               &scratch, &surface, &ignored))
        return (double)NAN;
    symbol_visibility(&surface, &setup->context, args->aim->eye, is_visible);
    return symbol_lit_share(&surface, is_visible, &setup->context, towards);
}

/* False: nothing of it is seen, or some of it is not shown. */
static bool aim_at_box(const SymbolSurface *all, const double uv[4], WorstPart *out, Arena *arena) {
    SymbolSurface surface;
    Error ignored;
    memcpy(&out->whole.part, uv, sizeof out->whole.part);
    out->aim.target_count = 0;
    if (symbol_surface_within(all, uv, SYMBOL_POINTS, arena, &surface, &ignored))
        symbol_aim(&surface, arena, &out->aim);
    return out->aim.target_count > 0;
}

void worst_part_take_all(const SetupSymbol *symbol, WorstPart *part, Arena *arena) {
    memcpy(&part->whole.part, symbol->surface.uv, sizeof part->whole.part);
    part->is_all = true;
    symbol_aim(&symbol->surface, arena, &part->aim);
}

WorstPart worst_part_find(const Setup *setup, const PartArgs *args, Arena *arena) {
    const SymbolSurface *all = &args->symbol->surface;
    WorstPart out = {*args->aim, case_whole_unknown(), true};
    Arena scratch = arena_reserve((size_t)1 << 28);
    double uv[4];
    LightParts parts = symbol_parts(args->symbol, args->aim, CELLS_MOST, &scratch);
    parts.takes_least = args->is_private;
    memcpy(uv, all->uv, sizeof uv);
    if (parts.aim.target_count) {
        int part = args->is_coarse ? part_by_sun(setup, &parts, scratch)
                                   : read_all(setup, &parts, &out.whole, scratch);
        out.is_all = part == LIGHT_PARTS_ALL;
        if (!out.is_all) symbol_part_box(args->symbol, &parts, part, uv);
        bool is_told = !args->is_coarse && !setup->request->change; /* of no variant */
        if (is_told) out.whole.lit_share = lit_share(setup, args, scratch);
    }
    arena_release(&scratch);
    if (!aim_at_box(all, uv, &out, arena)) worst_part_take_all(args->symbol, &out, arena);
    return out;
}

ProbeAim worst_part_aim(const SetupSymbol *symbol, const ProbeAim *aim, const CaseBox *part,
                        Arena *arena) {
    WorstPart out = {.aim = *aim};
    double uv[4];
    memcpy(uv, part, sizeof uv);
    aim_at_box(&symbol->surface, uv, &out, arena);
    return out.aim;
}

/* ---- the mean in its place --------------------------------------------------------------- */

bool worst_part_is_better(const CaseWhole *whole, MeanInterval reading, bool is_private) {
    MeanInterval mean = whole->reflected_range; /* NaN where it is not known */
    return is_private ? reading.low > mean.high : reading.high < mean.low;
}

bool setup_learn(Setup *setup, const SetupSymbol *symbols, int count, Arena *arena, Error *err) {
    Vec3 eye, sum = vec3(0, 0, 0);
    if (!setup_eye_middle(setup, &setup->request->eyes[0], *arena, &eye, err)) return false;
    for (int i = 0; i < count; i++) sum = vec3_add(sum, symbol_middle(&symbols[i]).position);
    Vec3 towards = vec3_sub(vec3_scale(sum, 1 / (float)count), eye);
    if (vec3_dot(towards, towards) > 0) trained_guide_take(setup, eye, towards, arena);
    return review_goes_on(err);
}
