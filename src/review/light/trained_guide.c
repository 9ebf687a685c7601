/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/trained_guide.h"

#include "base/file.h"
#include "base/units.h"
#include "camera/camera.h"
#include "guide/guide_file.h"
#include "keep/journal.h"
#include "render/identity.h"
#include "render/train.h"
#include "text/text.h"

/* The picture from which guides are trained: one about the symbols. */
#define TRAINING_WIDTH 480
#define TRAINING_HEIGHT 270
#define TRAINING_DEG 60.0

static int condition_id(const Setup *setup)
{
    return (int)(setup->condition - setup->request->conditions);
}

static const char *guide_file(const Setup *setup, Vec3 eye, Vec3 towards, Arena *arena)
{
    Text text = {.arena = arena};
    identity_line(&text, "lesson", "%016llx%016llx, condition %d",
                  (unsigned long long)setup->planned.high,
                  (unsigned long long)setup->planned.low,
                  condition_id(setup));
    identity_vector(&text, "eye", eye);
    identity_vector(&text, "towards", towards);
    JournalKey key = journal_key(text.data);
    return arena_format(arena, "%s/%016llx%016llx.lesson", setup->guides,
                        (unsigned long long)key.high, (unsigned long long)key.low);
}

static bool read_guide(Setup *setup, const char *file, Arena *arena)
{
    GuideScene scene = train_guide_scene(&setup->context);
    Error      ignored;
    return file_exists(file) &&
           guide_read(file, &scene, arena, &setup->context.guide, &ignored);
}

/* A guide from the setup's folder, or a new one. */
static void train(Setup *setup, Vec3 eye, Vec3 towards, Arena *arena)
{
    SceneCamera    look = camera_look_at(eye, vec3_add(eye, towards),
                                         (float)radians_from_degrees(TRAINING_DEG));
    Camera         camera = camera_from_scene(&look, TRAINING_WIDTH, TRAINING_HEIGHT);
    TrainOptions   options = {setup->tools.kernel, setup->tools.threads, true};
    PathStatistics cost;
    const char    *file = setup->guides ? guide_file(setup, eye, towards, arena) : NULL;
    if (file && read_guide(setup, file, arena)) return;
    setup->context.guide = train_guide(&setup->context, &camera, &options, arena, &cost);
    Error ignored; /* unkept, it is trained again: the same guide, of the same seed */
    if (file && setup->context.guide) guide_write(file, setup->context.guide, *arena, &ignored);
}

static bool is_variant(const Setup *setup)
{
    return setup->request->change != NULL;
}

bool trained_guide_inherit(Setup *setup)
{
    GuideScene scene = train_guide_scene(&setup->context);
    if (!setup->inherited || !is_variant(setup)) return false;
    setup->context.guide =
        inherited_guide(setup->inherited, setup->request, condition_id(setup), &scene);
    return setup->context.guide != NULL;
}

void trained_guide_take(Setup *setup, Vec3 eye, Vec3 towards, Arena *arena)
{
    bool leaves = setup->inherited && !is_variant(setup);
    train(setup, eye, towards, leaves ? inherited_room(setup->inherited) : arena);
    GuideScene scene = train_guide_scene(&setup->context);
    if (leaves && setup->context.guide)
        inherited_keep_guide(setup->inherited, condition_id(setup), setup->context.guide,
                             &scene);
}
