/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/explain.h"

#include <math.h>
#include <string.h>

#include "review/request/request_check.h"
#include "review/run/causes.h"
#include "review/run/sweep.h"
#include "text/text.h"

#define SETUP_BYTES ((size_t)1 << 36)

/* ---- names ------------------------------------------------------------------------------- */

/* A list of names, and what they name. */
typedef struct KnownNames {
    const char  *what;
    const char **names;
    int          count;
} KnownNames;

static const char *all_names(const KnownNames *list, Arena *arena)
{
    Text text = {.arena = arena};
    for (int i = 0; i < list->count; i++)
        text_format(&text, "%s'%s'", i ? ", " : "", list->names[i]);
    return text.size ? text.data : "none";
}

/* wanted NULL: the only one. */
static bool find_name(const KnownNames *list, const char *wanted, int *out, Arena scratch,
                      Error *err)
{
    for (int i = 0; i < list->count && wanted; i++)
        if (!strcmp(list->names[i], wanted)) {
            *out = i;
            return true;
        }
    *out = 0;
    if (!wanted && list->count == 1) return true;
    if (!wanted)
        return error_set(err, ERROR_USAGE, "--%s: which one? There are %s", list->what,
                         all_names(list, &scratch));
    return error_set(err, ERROR_USAGE, "--%s '%s': there is none of this name, but %s",
                     list->what, wanted, all_names(list, &scratch));
}

static bool find_condition(const ReviewRequest *request, const ExplainOptions *options,
                           const ReviewCondition **out, Arena scratch, Error *err)
{
    KnownNames list = {"condition", ARENA_NEW(&scratch, const char *, request->condition_count),
                     request->condition_count};
    int      id;
    for (int i = 0; i < list.count; i++) list.names[i] = request->conditions[i].name;
    if (!find_name(&list, options->condition, &id, scratch, err)) return false;
    *out = &request->conditions[id];
    bool is_sweep = (*out)->kind != CONDITION_MOMENT;
    if (is_sweep == options->has_sun) return true;
    return error_set(err, ERROR_USAGE,
                     is_sweep ? "--sun AZ,EL: condition '%s' is a sweep: which of its suns?"
                              : "--sun: condition '%s' has its own sun",
                     (*out)->name);
}

static bool find_eye(const ReviewRequest *request, const char *wanted, const ReviewEye **out,
                     Arena scratch, Error *err)
{
    KnownNames list = {"eye", ARENA_NEW(&scratch, const char *, request->eye_count),
                     request->eye_count};
    int      id;
    for (int i = 0; i < list.count; i++) list.names[i] = request->eyes[i].name;
    if (!find_name(&list, wanted, &id, scratch, err)) return false;
    *out = &request->eyes[id];
    return true;
}

static bool find_symbol(const SetupSymbol *symbols, int count, const char *wanted,
                        const SetupSymbol **out, Arena scratch, Error *err)
{
    KnownNames list = {"symbol", ARENA_NEW(&scratch, const char *, count), count};
    int      id;
    for (int i = 0; i < count; i++) list.names[i] = symbols[i].name;
    if (!find_name(&list, wanted, &id, scratch, err)) return false;
    *out = &symbols[id];
    return true;
}

/* ---- a symbol of a review ---------------------------------------------------------------- */

Outlook setup_outlook(const Setup *setup, const SetupSymbol *symbol, Vec3 eye, Arena *arena)
{
    SymbolPoint middle = symbol_middle(symbol);
    OutlookAsk  ask = {&setup->context, &setup->tools, middle.position, middle.ng,
                       outlook_up(middle.ng), eye};
    return outlook_take(&ask, arena);
}

static bool explain_symbol(const CaseTools *tools, const SetupSymbol *symbol,
                           const ReviewEye *eye, Arena *arena, Explained *out, Error *err)
{
    ReviewCase *c = &out->of;
    if (!setup_case(tools, symbol, eye, arena, c, err)) return false;
    c->symbol = arena_string(arena, c->symbol, strlen(c->symbol));
    out->paths = tools->cause_paths;
    out->shown = (double)NAN;
    for (int i = 0; i < c->cause_count; i++) out->all.cd_m2 += c->causes[i].cd_m2;
    return true;
}

static bool light_setup(Setup *setup, const ExplainOptions *options, Arena *scratch, Error *err)
{
    const ReviewCondition *condition = setup->condition;
    if (condition->kind == CONDITION_MOMENT)
        return setup_light(setup, condition->has_environment ? &condition->environment : NULL,
                           scratch, err);
    SweepSun    sun = {.azimuth_deg = options->sun_deg[0], .compass_deg = options->sun_deg[0],
                       .elevation_deg = options->sun_deg[1], .step = -1};
    Environment sky = sweep_environment(setup, &sun);
    return setup_light(setup, &sky, scratch, err);
}

/* The setup is open. */
static bool explain_on(Setup *setup, const ExplainOptions *options, Arena *scratch,
                       Arena *arena, Explained *out, Error *err)
{
    const ReviewEye   *eye;
    const SetupSymbol *symbol;
    SetupSymbol       *symbols;
    CaseTools tools = {.setup = setup, .profile = options->profile,
                       .cause_paths = options->paths, .cause_rays = CHAIN_RAYS};
    if (!light_setup(setup, options, scratch, err) ||
        !setup_symbols(setup, scratch, &symbols, &tools.symbol_count, err) ||
        (setup->condition->kind == CONDITION_MOMENT &&
         !setup_learn(setup, symbols, tools.symbol_count, scratch, err)) ||
        !find_symbol(symbols, tools.symbol_count, options->symbol, &symbol, *scratch, err) ||
        !find_eye(setup->request, options->eye, &eye, *scratch, err))
        return false;
    tools.symbols = symbols;
    if (!explain_symbol(&tools, symbol, eye, arena, out, err)) return false;
    out->has_outlook = options->with_outlook && out->of.visible_share > 0;
    if (out->has_outlook) out->outlook = setup_outlook(setup, symbol, out->of.eye_m, arena);
    return true;
}

bool explain_review(const ReviewRequest *request, const ExplainOptions *options, Arena *arena,
                    Explained *out, Error *err)
{
    SetupOptions setup_options = {.request = request, .root = options->root,
                                  .state = options->state, .threads = options->threads,
                                  .isa = options->isa};
    Setup setup;
    *out = (Explained){.has_outlook = false};
    if (!find_condition(request, options, &setup_options.condition, *arena, err)) return false;
    Arena scratch = arena_reserve(SETUP_BYTES);
    bool  ok = setup_open(&setup_options, &scratch, options->problems, &setup, err);
    if (ok) {
        ok = (review_request_check(request, setup.scene, options->problems) ||
              problems_verdict(options->problems, err)) &&
             explain_on(&setup, options, &scratch, arena, out, err);
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}
