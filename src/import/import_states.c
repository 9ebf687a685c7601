/* SPDX-License-Identifier: Apache-2.0 */
#include "import/import_states.h"

#include <fnmatch.h>

#include "base/file.h"
#include "import/set/import.h"

static bool is_of(const ImportStateFiles *state, const char *file)
{
    for (int i = 0; i < state->count; i++)
        if (!fnmatch(state->pattern[i], file, 0) ||
            !fnmatch(state->pattern[i], path_name(file), 0))
            return true;
    return false;
}

/* Of which state a file is; -1: of all. */
static bool find_state(const ImportRequest *request, const char *file, int *out, Error *err)
{
    *out = -1;
    for (int k = 0; k < request->state_count; k++) {
        if (!is_of(&request->states[k], file)) continue;
        if (*out >= 0)
            return error_at(err, ERROR_INPUT, file, "", "is of the states '%s' and '%s', "
                            "required: of one of them", request->states[*out].name,
                            request->states[k].name);
        *out = k;
    }
    return true;
}

/* The files of state k; -1: those of all. */
static bool files_of(const char *const *file, int count, const ImportRequest *request, int k,
                     Lines *out, Error *err)
{
    for (int i = 0; i < count; i++) {
        int state;
        if (!find_state(request, file[i], &state, err)) return false;
        if (state == k) lines_put(out, file[i]);
    }
    return true;
}

static bool is_light(ImportSource source)
{
    return source <= IMPORT_WHITE;
}

/* Notes of a state stand with those of the whole, under its name. */
static void take_notes(const ImportSet *from, ImportSet *to)
{
    for (int i = 0; i < from->note_count; i++)
        import_note(to, "%s: %s", from->state_name, from->note[i]);
}

static bool run_state(const Lines *files, const ImportRequest *request, ImportSet *whole,
                      ImportSet *out, Error *err)
{
    const char *name = out->state_name;
    *out = import_set(whole->arena);
    out->state_name = name;
    if (!files->count)
        return error_set(err, ERROR_INPUT, "no file is of the state '%s', required: some that "
                         "its patterns name", name);
    if (!import_run(files->list, files->count, request, out, err))
        return error_prefix(err, "the state '%s'", name);
    take_notes(out, whole);
    for (int i = 0; i < out->count; i++)
        if (is_light(out->table[i].source)) return true;
    return error_set(err, ERROR_INPUT, "the state '%s' has no table of light, required: an "
                     "emission in each state", name);
}

/* What is of all states reflects, or is no table. */
static bool run_shared(const Lines *files, const ImportRequest *request, ImportSet *set,
                       Error *err)
{
    ImportRequest *shared = ARENA_NEW(set->arena, ImportRequest, 1);
    *shared = *request;
    shared->levels = NULL; /* of each state's white */
    if (!files->count) {
        if (request->specular.file || request->specular.gloss.count)
            return error_set(err, ERROR_INPUT, "a specular table or gloss is given, but all "
                             "files are of one state alone; required: a reflection of no "
                             "state");
        return import_begin(files->list, files->count, shared, set, err);
    }
    if (!import_run(files->list, files->count, shared, set, err))
        return error_prefix(err, "files of no state");
    for (int i = 0; i < set->count; i++)
        if (is_light(set->table[i].source))
            return error_at(err, ERROR_INPUT, set->table[i].file, "", "is light of no state, "
                            "required: a pattern of one state that names it");
    return true;
}

bool import_run_states(const char *const *file, int count, const ImportRequest *request,
                       ImportSet *set, Error *err)
{
    Lines          shared = {.arena = set->arena};
    ImportRequest *own = ARENA_NEW(set->arena, ImportRequest, 1);
    if (!request->state_count) return import_run(file, count, request, set, err);
    *own = *request;
    own->specular = (ImportSpecular){.file = NULL}; /* of the glass */
    if (!files_of(file, count, request, -1, &shared, err) ||
        !run_shared(&shared, request, set, err))
        return false;
    set->state = ARENA_NEW(set->arena, ImportSet, request->state_count);
    for (int k = 0; k < request->state_count; k++) {
        Lines files = {.arena = set->arena};
        set->state[k].state_name = request->states[k].name;
        if (!files_of(file, count, request, k, &files, err) ||
            !run_state(&files, own, set, &set->state[k], err))
            return false;
        for (int i = 0; i < files.count; i++) lines_put(&set->inputs, files.list[i]);
        set->state_count = k + 1;
    }
    if (request->levels) lines_put(&set->inputs, request->levels);
    return true;
}
