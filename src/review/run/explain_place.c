/* SPDX-License-Identifier: Apache-2.0 */
#include "review/judge.h"
#include "review/run/explain_place.h"

#include <math.h>

#include "light/emission.h"
#include "review/run/causes.h"

#define SEED 0x6578706cu
#define PANES 16 /* before a display, at most */

/* ---- what is there ----------------------------------------------------------------------- */

/* Leaves the targets that show a display, if at least half of them do. */
static bool aim_at_displays(const ExplainPlace *place, ProbeAim *aim, Arena *arena)
{
    const ProbeAim *all = &place->aim;
    Vec3       *targets = ARENA_NEW(arena, Vec3, all->target_count);
    ProbePatch *patches = all->patches ? ARENA_NEW(arena, ProbePatch, all->target_count) : NULL;
    int         count = 0;
    for (int i = 0; i < all->target_count; i++) {
        ProbeLook      look;
        PathStatistics statistics = {0};
        place->tools->kernel->look(aim, i, i + 1, &look, &statistics);
        if (!look.is_found) continue;
        if (patches) patches[count] = all->patches[i];
        targets[count++] = all->targets[i];
    }
    if (count == 0 || 2 * count < all->target_count) return false;
    aim->targets = targets;
    aim->patches = patches;
    aim->target_count = count;
    return true;
}

/* The first surface along the look that is no pane, or NO_ID; of a display its face. */
static bool meet(const ExplainPlace *place, Vec3 target, bool wants_display, Hit *hit)
{
    const Scene *scene = place->aim.context->scene;
    Ray ray = {place->aim.eye, vec3_normalize(vec3_sub(target, place->aim.eye)), 0, INFINITY};
    for (int i = 0; i < PANES && bvh_intersect(place->aim.context->bvh, ray, 0, hit); i++) {
        const Part     *part = &scene->parts[scene->triangles[hit->triangle].part_id];
        const Material *m = &scene->materials[part->material_id];
        if (wants_display ? m->display_id != NO_ID : !m->lets_light_through) return true;
        ray.t_min = hit->t + 2 * ray_offset_step(vec3_along(ray.origin, ray.direction, hit->t));
    }
    return false;
}

/* Adds the Y that the display there sends towards the eye, in white, in black and as it is. */
static bool add_sent(const ExplainPlace *place, Vec3 target, double sent[3], int *display_id)
{
    static const float codes[2][3] = {{255, 255, 255}, {0, 0, 0}};
    const Scene *scene = place->aim.context->scene;
    Hit   hit;
    float xyz[3];
    if (!meet(place, target, true, &hit)) return false;
    TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
    const Part   *part = &scene->parts[scene->triangles[hit.triangle].part_id];
    *display_id = scene->materials[part->material_id].display_id;
    const Display *display = &scene->displays[*display_id];
    Frame frame = display_frame(scene, display, hit.triangle, &point);
    Vec3  wo = vec3_normalize(vec3_sub(place->aim.eye, point.position));
    for (int k = 0; k < 2; k++) {
        display_panel_xyz(display, &point, frame_to_local(&frame, wo), codes[k], xyz);
        sent[k] += (double)(xyz[1] * display->level);
    }
    display_emission_xyz(scene, display, hit.triangle, &point, wo, xyz);
    sent[2] += (double)xyz[1];
    return true;
}

static void set_sent(const ExplainPlace *place, const ProbeAim *aim, Explained *out)
{
    const Scene *scene = place->aim.context->scene;
    double sent[3] = {0, 0, 0};
    int    count = 0, display_id = NO_ID;
    for (int i = 0; i < aim->target_count; i++)
        count += add_sent(place, aim->targets[i], sent, &display_id);
    if (!count) return;
    out->of.luminance_cd_m2.foreground = sent[0] / count;
    out->of.luminance_cd_m2.background = sent[1] / count;
    out->shown = sent[2] / count;
    out->of.display = scene->displays[display_id].name;
    out->of.level = (double)scene->displays[display_id].level;
}

static void set_outlook(const ExplainPlace *place, const ProbeAim *aim, bool is_display,
                        Arena *arena, Explained *out)
{
    const Scene *scene = place->aim.context->scene;
    Hit   hit;
    if (!meet(place, aim->targets[aim->target_count / 2], is_display, &hit)) return;
    TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
    Vec3       to_eye = vec3_sub(place->aim.eye, point.position);
    Vec3       ng = vec3_dot(to_eye, point.ng) < 0 ? vec3_neg(point.ng) : point.ng;
    OutlookAsk ask = {place->aim.context, place->tools, point.position, ng, outlook_up(ng),
                      place->aim.eye};
    out->has_outlook = true;
    out->outlook = outlook_take(&ask, arena);
}

/* ---- all of it --------------------------------------------------------------------------- */

void explain_place(const ExplainPlace *place, Arena *arena, Explained *out)
{
    const double nan = (double)NAN;
    ProbeAim aim = place->aim;
    aim.seed = SEED;
    bool is_display = aim_at_displays(place, &aim, arena);
    *out = (Explained){.shown = nan, .paths = place->paths};
    ReviewCase *c = &out->of;
    *c = (ReviewCase){.luminance_cd_m2 = {nan, nan, nan, nan, nan, nan}, .contrast_ratio = nan,
                      .contrast_low = nan, .contrast_high = nan, .limit_id = -1, .level = nan,
                      .eye_m = place->aim.eye, .visible_share = 1};
    if (is_display) set_sent(place, &aim, out);
    CauseAsk   ask = {place->tools, &aim, place->paths, CHAIN_RAYS, !is_display, true};
    CauseFacts facts = case_causes(&ask, c, arena);
    out->all = facts.all;
    c->reflected_range = (Range){facts.all.low, facts.all.high};
    if (is_display) judge_contrasts(c, c->reflected_range);
    else c->luminance_cd_m2.mirror = c->luminance_cd_m2.scattered = nan;
    if (place->with_outlook) set_outlook(place, &aim, is_display, arena, out);
}
