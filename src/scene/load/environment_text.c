/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/environment_text.h"

#include "scene/check/schema.h"
#include "scene/check/schema_extensions.h"
#include "scene/load/environment.h"

static void check(GltfFile *file, const GltfValue *value)
{
    bool is_known;
    const DocumentCheck check = {file, SEVERITY_ERROR};
    schema_check(&check, value,
                 extension_rule("PARHELION_environment", "scene", &is_known)->schema);
}

static void pass_warnings(const Problems *from, Problems *to)
{
    for (int i = 0; i < from->count; i++)
        if (from->list[i].severity == SEVERITY_WARNING)
            problems_add(to, SEVERITY_WARNING, from->list[i].file, from->list[i].path, "%s",
                         from->list[i].message);
}

static bool first_error(const Problems *problems, Error *err)
{
    const Problem *first = problems->list;
    while (first->severity != SEVERITY_ERROR) first++;
    return error_at(err, ERROR_INPUT, first->file, first->path, "%s", first->message);
}

bool environment_text_read(const EnvironmentText *text, Arena *arena, Problems *problems,
                           EnvironmentFound *out, Error *err)
{
    Problems own = problems_start(arena);
    SceneOptions options = {.root = text->root};
    Loader load = {.arena = arena,
                   .scratch = arena_reserve(LOAD_SCRATCH_BYTES),
                   .problems = &own,
                   .options = &options,
                   .inputs = list_of(sizeof(const char *)),
                   .input_hashes = list_of(sizeof(uint64_t))};
    GltfFile file = {.load = &load, .path = text->file, .root = text->value};
    check(&file, text->value);
    if (!own.error_count) environment_build(&file, text->value);
    bool is_sound = !own.error_count || first_error(&own, err);
    if (is_sound) {
        pass_warnings(&own, problems);
        *out = (EnvironmentFound){.environment = load.environment};
        if (load.inputs.count) {
            out->picture = *(const char **)list_item(&load.inputs, 0);
            out->picture_hash = *(uint64_t *)list_item(&load.input_hashes, 0);
        }
    }
    arena_release(&load.scratch);
    return is_sound;
}
