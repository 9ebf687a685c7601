/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion equip: displays, eyes and materials for somebody else's model, by clicking. */
#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/reference.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "equip/equip_apply.h"
#include "equip/equip_page.h"
#include "equip/equip_shipped.h"
#include "scene/load/scene_load.h"
#include "text/json_text.h"
#include "text/text.h"

typedef struct EquipWords {
    const char *output, *with, *root;
    const char *reach; /* the root, or where all lies that ships */
    bool overwrites;
    Cli cli;
} EquipWords;

/* ---- what it answers --------------------------------------------------------------------- */

static const Column PAGE[] = {COLUMN_TEXT("page", "page"), COLUMN_TEXT("triangles", "triangles"),
                              COLUMN_TEXT("parts", "parts"), COLUMN_TEXT("materials", "materials"),
                              COLUMN_TEXT("next", "next")};
static const TableKind PAGE_KIND = TABLE_KIND("page", NULL, PAGE);

static const Column RESULT[] = {
    COLUMN_TEXT("scene", "scene"),
    COLUMN_TEXT("displays", "displays"),
    COLUMN_TEXT("eyes", "eyes"),
    COLUMN_TEXT("materials", "materials"),
    COLUMN_DIGITS("forward", "ahead", NULL, 0),
    COLUMN_TEXT("forward_is_proposed", "ahead by where the first eye looks"),
    COLUMN_TEXT("bin", "bytes"),
    {.key = "occupant", .words = "occupant", .none = "none: nobody sits in the driver's seat"},
    COLUMN_TEXT("copies", "copy"),
    {.key = "review",
     .words = "review",
     .none = "none: no display shows content that could be read"},
    {.key = "without_data", .words = "without data (parhelion check)", .hides_zero = true},
    COLUMN_TEXT("next", "next"),
    COLUMN_TEXT("look", "look")};
static const TableKind RESULT_KIND = TABLE_KIND("equip", NULL, RESULT);

/* ---- the command line -------------------------------------------------------------------- */

static bool parse(int argc, char **argv, Arena *arena, EquipWords *out, Error *err) {
    const Option options[] = {
        {"-o", OPTION_TEXT, "FILE", "the page (default: MODEL.equip.html), or the scene",
         &out->output, .file = OPTION_OUTPUT},
        {"--with", OPTION_TEXT, "EQUIP.json",
         "what the page saved: writes the scene, a .gltf, and a review of it", &out->with},
        {"--overwrite", OPTION_FLAG, NULL, "a scene and a review that are there already",
         &out->overwrites},
        {"--root", OPTION_TEXT, "DIR",
         "a folder whose files may be named too (default: the model's own folder alone)",
         &out->root},
    };
    const CliCommand command = {
        "equip",
        command_equip.summary,
        "MODEL.gltf|.glb [-o PAGE.html] | MODEL --with EQUIP.json -o NEW.gltf",
        "parhelion equip scenes/cockpit.gltf -o equip.html",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers = (const Answer[]){{"", &PAGE_KIND}, {"--with", &RESULT_KIND}, {0}}};
    return cli_parse(&command, argc, argv, arena, &out->cli, err);
}

/* ---- the page ---------------------------------------------------------------------------- */

static bool make_page(EquipWords *words, Arena *arena, Error *err) {
    const char *model = words->cli.arguments[0];
    const SceneOptions options = {
        .paths = &model, .path_count = 1, .root = words->reach, .own_folder = true};
    const char *name = path_name(model);
    int stem = (int)(strlen(name) - strlen(path_ending(name)));
    const char *page =
        words->output ? words->output : arena_format(arena, "%.*s.equip.html", stem, name);
    Problems problems = problems_start(arena);
    Scene *scene;
    if (!words->output) outputs_note(&words->cli.outputs, "-o", page);
    if (!file_check_writable(page, err) ||
        !scene_load_shown(&options, words->cli.progress, arena, &problems, &scene, err))
        return false;
    cli_print_warnings(&problems);
    const char *root =
        words->root ? arena_format(arena, " --root %s", escape_shell(words->root, arena)) : "";
    const char *command =
        arena_format(arena, "parhelion equip %s%s", escape_shell(model, arena), root);
    bool ok = outputs_spare(&words->cli.outputs, scene->inputs, scene->input_count, err) &&
              equip_page_write(scene, model, command, page, arena, err) &&
              cli_print_answer(&PAGE_KIND,
                               json_pack("{s:o, s:I, s:i, s:i, s:s}", "page", json_text(page),
                                         "triangles", (json_int_t)scene->triangle_count, "parts",
                                         scene->part_count, "materials", scene->material_count,
                                         "next", "open it in a browser, click, and save"),
                               words->cli.json, err);
    scene_close(scene);
    return ok;
}

/* ---- the scene --------------------------------------------------------------------------- */

#define LOOK_LIGHT "constant:3183" /* 10,000 lx of even cloud, the ordinary day of its review */

/* What the first eye sees, in a moment: the page draws the model without light. */
static const char *look_command(const EquipResult *r, Arena *arena) {
    return arena_format(arena,
                        "parhelion render %s --camera %s --environment " LOOK_LIGHT
                        " --preview -o look.exr --png look.png",
                        escape_shell(r->scene, arena), escape_shell(r->first_eye, arena));
}

static bool print_result(const EquipWords *words, const EquipResult *r, Arena *arena, Error *err) {
    const char *next = r->review ? arena_format(arena, "parhelion review %s --dry-run",
                                                escape_shell(r->review, arena))
                                 : NULL;
    json_t *answer = json_pack(
        "{s:o, s:o, s:o, s:o, s:i, s:i, s:i, s:i, s:[f,f,f], s:b, s:o}", "scene",
        json_text(r->scene), "bin", json_text_or_null(r->bin), "review",
        json_text_or_null(r->review), "copies", json_texts(r->copies, r->copy_count), "displays",
        r->display_count, "eyes", r->eye_count, "materials", r->material_count, "without_data",
        r->without_data, "forward", r->forward[0], r->forward[1], r->forward[2],
        "forward_is_proposed", r->forward_is_proposed, "occupant", json_text_or_null(r->occupant));
    json_object_set_new(answer, "next", json_text_or_null(next));
    json_object_set_new(answer, "look", json_text(look_command(r, arena)));
    return cli_print_answer(&RESULT_KIND, answer, words->cli.json, err);
}

static bool apply(const EquipWords *words, Arena *arena, Error *err) {
    const EquipOrder order = {words->cli.arguments[0], words->with, words->output, words->reach,
                              words->overwrites};
    Problems problems = problems_start(arena);
    EquipResult result;
    if (!order.output || strcmp(path_ending(order.output), ".gltf") != 0)
        return error_set(err, ERROR_USAGE, "-o NEW.gltf: %s%s%s", order.output ? "\"" : "",
                         order.output ? order.output : "",
                         order.output ? "\" does not end in .gltf, as what is written does"
                                      : "nothing says where the scene goes");
    if (!equip_apply(&order, arena, &problems, &result, err)) return false;
    cli_print_warnings(&problems);
    return print_result(words, &result, arena, err);
}

static Outcome run_equip(int argc, char **argv, Arena *arena, Error *err) {
    EquipWords words = {0};
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    if (!reference_check_root(words.root, err)) return OUTCOME_FAILED;
    words.reach = words.root ? words.root : equip_shipped_assets(arena);
    return outcome_of(words.with ? apply(&words, arena, err) : make_page(&words, arena, err));
}

const Command command_equip = {
    "equip", "displays, eyes and materials for a model, clicked in a page", run_equip};
