/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/question.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "guide/guide_file.h"
#include "render/identity.h"

static JournalKey key_of(XXH128_hash_t hash)
{
    return (JournalKey){hash.low64, hash.high64};
}

static void add_floats(XXH3_state_t *state, Vec3 v)
{
    const float values[3] = {v.x, v.y, v.z};
    XXH3_128bits_update(state, values, sizeof values);
}

static void add_count(XXH3_state_t *state, int64_t count)
{
    XXH3_128bits_update(state, &count, sizeof count);
}

static void add_polariser(XXH3_state_t *state, const PolarisedEye *eye)
{
    add_floats(state, eye->right);
    add_floats(state, vec3(eye->axis[0], eye->axis[1], eye->lets));
    add_floats(state, vec3(eye->blocks, 0, 0));
}

static void add_aim(XXH3_state_t *state, const ProbeAim *aim)
{
    add_count(state, aim->seed);
    add_count(state, aim->meter ? 1 + aim->meter->both_sides : 0);
    if (aim->meter) {
        add_floats(state, aim->meter->position);
        add_floats(state, aim->meter->ns);
        return;
    }
    add_floats(state, aim->eye);
    if (aim->colour) XXH3_128bits_update(state, aim->colour, sizeof *aim->colour);
    if (aim->context->eye) add_polariser(state, aim->context->eye);
    add_count(state, aim->target_count);
    XXH3_128bits_update(state, aim->targets, (size_t)aim->target_count * sizeof *aim->targets);
    if (aim->patches)
        XXH3_128bits_update(state, aim->patches,
                            (size_t)aim->target_count * sizeof *aim->patches);
}

uint64_t question_aim(const ProbeAim *aim)
{
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    add_aim(&state, aim);
    return XXH3_128bits_digest(&state).low64;
}

/* The light that shines now: surroundings and displays. */
static void add_light(XXH3_state_t *state, const PathContext *context, Arena scratch)
{
    const Scene *scene = context->scene;
    Text         text = {.arena = &scratch};
    identity_add_environment(&text, scene);
    XXH3_128bits_update(state, text.data, text.size);
    for (int i = 0; i < scene->display_count; i++)
        XXH3_128bits_update(state, &scene->displays[i].level, sizeof(float));
    add_count(state, context->max_bounces);
    add_count(state, (int64_t)context->strategy);
    add_count(state, context->without_mirrored_sun);
    add_count(state, context->guide ? (int64_t)guide_hash(context->guide) : 0);
}

JournalKey question_key(const Question *question, const ProbeAim *aim, Arena scratch)
{
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    XXH3_128bits_update(&state, &question->base, sizeof question->base);
    XXH3_128bits_update(&state, question->kind, strlen(question->kind));
    add_light(&state, aim->context, scratch);
    add_aim(&state, aim);
    add_count(&state, question->number_count);
    XXH3_128bits_update(&state, question->numbers,
                        (size_t)question->number_count * sizeof *question->numbers);
    add_count(&state, question->towards_count);
    if (question->towards_count)
        XXH3_128bits_update(&state, question->towards,
                            (size_t)question->towards_count * sizeof *question->towards);
    return key_of(XXH3_128bits_digest(&state));
}
