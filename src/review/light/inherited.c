/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/inherited.h"

#include <string.h>

#include "render/identity.h"

#define BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */
#define SKIES_MAX 64            /* 130 MB; what is requested beyond is built again each time */

typedef struct KeptGuide {
    const LightGuide *guide; /* NULL: there is none */
    GuideScene        scene;
} KeptGuide;

typedef struct KeptSky {
    const char *identity;
    Daylight    sky;
} KeptSky;

struct Inherited {
    const ReviewRequest *request;
    Arena      arena;
    Arena      beyond; /* for a sky that is not kept */
    KeptGuide *guides; /* [condition] */
    KeptSky    skies[SKIES_MAX];
    int        sky_count;
};

Inherited *inherited_start(const ReviewRequest *request)
{
    Arena      arena = arena_reserve(BYTES);
    Inherited *inherited = ARENA_NEW(&arena, Inherited, 1);
    inherited->request = request;
    inherited->guides = ARENA_NEW(&arena, KeptGuide, request->condition_count);
    inherited->beyond = arena_reserve(BYTES);
    inherited->arena = arena;
    return inherited;
}

void inherited_end(Inherited *inherited)
{
    if (!inherited) return;
    Arena arena = inherited->arena;
    arena_release(&inherited->beyond);
    arena_release(&arena);
}

/* ---- guides ------------------------------------------------------------------------------ */

Arena *inherited_room(Inherited *inherited)
{
    return &inherited->arena;
}

void inherited_keep_guide(Inherited *inherited, int condition_id, const LightGuide *guide,
                          const GuideScene *scene)
{
    inherited->guides[condition_id] = (KeptGuide){guide, *scene};
}

static bool fits(const GuideScene *a, const GuideScene *b)
{
    return a->light_count == b->light_count && a->lamp_count == b->lamp_count &&
           memcmp(a->has, b->has, sizeof a->has) == 0;
}

static bool has_same_files(const ReviewRequest *a, const ReviewRequest *b)
{
    if (a->scene_count != b->scene_count) return false;
    for (int i = 0; i < a->scene_count; i++)
        if (strcmp(a->scenes[i], b->scenes[i]) != 0) return false;
    return true;
}

const LightGuide *inherited_guide(const Inherited *inherited, const ReviewRequest *variant,
                                  int condition_id, const GuideScene *scene)
{
    const KeptGuide *kept = &inherited->guides[condition_id];
    bool is_mirrored = variant->change && variant->change->mirror;
    bool is_same =
        !is_mirrored && has_same_files(inherited->request, variant) && kept->guide;
    return is_same && fits(&kept->scene, scene) ? kept->guide : NULL;
}

/* ---- skies ------------------------------------------------------------------------------- */

static const char *identity_of(const DaylightInput *input, Arena *arena)
{
    Text text = {.arena = arena};
    identity_add_daylight(&text, input);
    identity_number(&text, "sun azimuth", input->sun_azimuth);
    identity_number(&text, "sun elevation", input->sun_elevation);
    return text.data;
}

static const Daylight *build(const DaylightInput *input, Daylight *sky, Arena *arena,
                             Error *err)
{
    return daylight_build(input, arena, sky, err) ? sky : NULL;
}

const Daylight *inherited_sky(Inherited *inherited, const DaylightInput *input, Error *err)
{
    Arena       scratch = inherited->beyond, *arena = &inherited->arena;
    const char *identity = identity_of(input, &scratch);
    for (int i = 0; i < inherited->sky_count; i++)
        if (!strcmp(inherited->skies[i].identity, identity)) return &inherited->skies[i].sky;
    if (inherited->sky_count == SKIES_MAX)
        return build(input, ARENA_NEW(&scratch, Daylight, 1), &scratch, err);
    KeptSky *kept = &inherited->skies[inherited->sky_count];
    if (!build(input, &kept->sky, arena, err)) return NULL;
    kept->identity = arena_string(arena, identity, strlen(identity));
    inherited->sky_count++;
    return &kept->sky;
}
