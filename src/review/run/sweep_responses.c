/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sweep_responses.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "render/identity.h"
#include "review/keep/goes_on.h"
#include "review/light/question.h"
#include "review/pace/work.h"
#include "review/review_names.h"

#define OWN_PRECISION 0.02
#define OWN_PATHS 8192
#define OWN_BYTES ((size_t)1 << 30) /* address space: what is not touched costs nothing */

/* ---- files ------------------------------------------------------------------------------- */

static void add_meter(Text *text, const LitPoint *meter)
{
    identity_vector(text, "meter", meter->position);
    identity_vector(text, "meter's normal", meter->ns);
    identity_line(text, "meter's sides", "%d", 1 + meter->both_sides);
}

static void add_eye(Text *text, const ProbeAim *aim)
{
    identity_vector(text, "eye", aim->eye);
    identity_line(text, "looks at", "%d points, %016llx", aim->target_count,
                  (unsigned long long)question_aim(aim));
}

/* Everything that decides the response and what the probe reads of the scene's own light. */
static const char *identity_of(const Setup *setup, const ResponseAsk *ask, Arena *arena)
{
    const ProbeAim *aim = &ask->probe->aim;
    Text text = {.arena = arena};
    text_add(&text, setup->identity);
    if (aim->meter) add_meter(&text, aim->meter);
    else add_eye(&text, aim);
    identity_line(&text, "seed", "%u", aim->seed);
    identity_line(&text, "level of triangles", "%d", RESPONSE_LEVEL);
    identity_line(&text, "paths", "%d", ask->paths);
    identity_number(&text, "precision", ask->precision);
    return text.data;
}

static void name_file(const ReviewRun *run, const Setup *setup, ResponseAsk *ask, Arena *arena)
{
    const char *identity = identity_of(setup, ask, arena);
    uint64_t    hash = XXH3_64bits(identity, strlen(identity));
    const char *name = arena_format(arena, "%s-%016llx.response",
                                    words_file_name(ask->name, arena),
                                    (unsigned long long)hash);
    ask->file = (ResponseFile){.path = arena_format(arena, "%s/%s", run->responses, name),
                               .identity = identity};
    ask->shown = arena_format(arena, "%s/%s", run->responses_shown, name);
}

void responses_find(const ReviewRun *run, const Setup *setup, ResponseAsk *asks, int count,
                    Arena *arena)
{
    for (int i = 0; i < count; i++) {
        Error err;
        if (!run->responses) continue;
        name_file(run, setup, &asks[i], arena);
        if (!file_exists(asks[i].file.path)) continue;
        asks[i].is_kept = response_read(&asks[i].file, arena, &asks[i].probe->response,
                                        asks[i].own, &err);
        if (asks[i].is_kept) continue;
        problems_add(run->problems, SEVERITY_WARNING, err.file, err.path,
                     "%s — it is traced again", err.text);
    }
}

/* ---- the scene's own light --------------------------------------------------------------- */

static bool gives_light(const Lights *lights)
{
    return lights_has(lights, LIGHTS_EMITTERS) || lights_has(lights, LIGHTS_PUNCTUAL);
}

static double own_reading(const Setup *setup, const ProbeAim *aim, Arena scratch)
{
    ReadingGoal goal = {.precision = OWN_PRECISION, .most = OWN_PATHS};
    if (!gives_light(setup->context.lights)) return 0;
    return reading_take(aim, &goal, &setup->tools, scratch).reflected;
}

bool responses_read_own(const ReviewRun *run, const Setup *setup, const ResponseAsk *asks,
                        int count, bool displays, Error *err)
{
    Arena scratch = arena_reserve(OWN_BYTES);
    bool  ok = true;
    for (int i = 0; i < count && ok; i++) {
        if (asks[i].is_kept || asks[i].is_left) continue;
        ok = review_goes_on(setup->tools.journal, err);
        if (!ok) break;
        double own = own_reading(setup, &asks[i].probe->aim, scratch);
        if (displays) asks[i].own->displays = own - asks[i].own->lamps;
        else asks[i].own->lamps = own;
        work_add(run->work, WORK_OWN, work_of(WORK_OWN));
    }
    arena_release(&scratch);
    return ok;
}

/* ---- tracing ----------------------------------------------------------------------------- */

WorkKind responses_kind(const ResponseAsk *ask)
{
    return ask->probe->aim.meter ? WORK_METER : WORK_RESPONSE;
}

double responses_work(const ResponseAsk *ask)
{
    if (ask->is_kept || ask->is_left) return 0;
    return ask->probe->aim.meter ? work_of(WORK_METER) : work_of_response(ask->paths);
}

bool responses_trace(const ReviewRun *run, const Setup *setup, ResponseAsk *asks, int count,
                     Arena *arena, Error *err)
{
    DistantTools tools = {.setup = setup};
    for (int i = 0; i < count; i++) {
        ResponseAsk *ask = &asks[i];
        if (ask->is_kept || ask->is_left) continue;
        if (!review_goes_on(setup->tools.journal, err)) return false;
        tools.paths = ask->paths;
        tools.precision = ask->precision;
        distant_probe_respond(ask->probe, &tools, arena);
        if (!response_write(&ask->file, &ask->probe->response, ask->own, *arena, err))
            return false;
        work_add(run->work, responses_kind(ask), responses_work(ask));
    }
    return true;
}
