/* SPDX-License-Identifier: Apache-2.0 */
#include "path/cell_lights.h"

#include "base/units.h"

/* ---- lamps ------------------------------------------------------------------------------- */

/* Bounds on a lamp's share of light that arrives and on the share of samples for lamps that
 * are not kept: a few samples may miss light that is there. */
#define LEAST_ARRIVES 0.1f
#define LEAST_OTHERS 0.1f
#define MOST_OTHERS 0.9f

static LampFind *place_of(LampFinds *finds, const LampFind *find) {
    LampFind *least = &finds->lamp[0];
    for (int i = 0; i < finds->count; i++) {
        if (finds->lamp[i].id == find->id) return &finds->lamp[i];
        if (finds->lamp[i].arrived < least->arrived) least = &finds->lamp[i];
    }
    if (finds->count < LAMP_FINDS) least = &finds->lamp[finds->count++];
    else if (find->arrived <= least->arrived) return NULL;
    *least = (LampFind){.id = find->id};
    return least;
}

void lamp_finds_add(LampFinds *finds, LampFind find) {
    LampFind *place = place_of(finds, &find);
    if (!place) return;
    place->sent += find.sent;
    place->arrived += find.arrived;
}

void lamp_finds_join(LampFinds *finds, const LampFinds *neighbour, double weight) {
    for (int i = 0; i < neighbour->count; i++) {
        const LampFind *find = &neighbour->lamp[i];
        lamp_finds_add(finds, (LampFind){find->id, find->sent * weight, find->arrived * weight});
    }
}

/* Takes the lamp of which most arrived out of the finds. */
static LampFind take_best(LampFinds *finds) {
    int best = 0;
    for (int i = 1; i < finds->count; i++)
        if (finds->lamp[i].arrived > finds->lamp[best].arrived) best = i;
    LampFind find = finds->lamp[best];
    finds->lamp[best] = finds->lamp[--finds->count];
    return find;
}

static void keep(GuideLamps *lamps, const LampFind *find) {
    double arrives = find->sent > 0 ? find->arrived / find->sent : 0;
    lamps->id[lamps->count] = find->id;
    lamps->arrives[lamps->count++] = clampf((float)arrives, LEAST_ARRIVES, 1);
}

GuideLamps cell_lamps_keep(const LampFinds *finds, int lamp_count) {
    LampFinds left = *finds;
    GuideLamps lamps = {0};
    double all = 0, kept = 0;
    for (int i = 0; i < left.count; i++) all += left.lamp[i].arrived;
    if (!(all > 0)) return lamps;
    while (left.count && lamps.count < GUIDE_LAMPS) {
        LampFind find = take_best(&left);
        if (!(find.arrived > 0) && lamp_count > GUIDE_LAMPS) break;
        kept += find.arrived;
        keep(&lamps, &find);
    }
    bool is_all = lamps.count == lamp_count;
    lamps.others = is_all ? 0 : clampf((float)(1 - kept / all), LEAST_OTHERS, MOST_OTHERS);
    return lamps;
}

/* ---- sets of lights ---------------------------------------------------------------------- */

/* A set whose samples' root mean square is a fifth of all light is always sampled. */
#define GENEROSITY 5.0
#define LEAST 0.1f

/* The MIS weight of a path's light sample: the share that BSDF samples do not find. */
static double own_share(const Guiding *guiding, LitPoint point, const LightSample *light) {
    if (light->is_delta) return 1;
    float cosine = vec3_dot(light->wi, point.ns);
    float other = guiding_pdf(guiding, light->wi, cosine * INV_PI_F) / light->pdf;
    return 1 / (1 + (double)(other * other));
}

static void note_lamp(const PathContext *context, LitPoint point, const LightSample *light, float u,
                      bool arrives, LightFinds *finds) {
    double lx = lights_sample_lx(context->lights, point, light, u);
    if (!(lx > 0)) return;
    lamp_finds_add(&finds->lamps, (LampFind){light->light_id, lx, arrives ? lx : 0});
}

static void try_sunlit(const PathContext *context, const Guiding *guiding, LitPoint point,
                       Sampler *sampler, LightFinds *finds) {
    const SunlitTools tools = {context->scene, context->bvh, context->lights};
    SunlitTry found;
    float u[8];
    sampler_4d(sampler, u);
    sampler_4d(sampler, u + 4);
    if (!sunlit_try(&tools, &context->sunlit, point, u, &found)) return;
    float cosine = vec3_dot(found.wi, point.ns);
    sunlit_finds_add(&finds->sunlit, &found, guiding_pdf(guiding, found.wi, cosine * INV_PI_F));
}

void cell_lights_try(const PathContext *context, LitPoint point, uint32_t cell, Sampler *sampler,
                     LightFinds *finds) {
    Guiding guiding;
    Wavelengths middle;
    PlateView plates = plate_view(context, &middle);
    wavelengths_sample(0.5f, &middle);
    guiding_of_white(context, cell, point.ns, &guiding);
    finds->points++;
    for (int set = 0; set < LIGHT_SETS; set++) {
        LightSample light;
        float u[4];
        if (!lights_has(context->lights, (LightSet)set)) continue;
        sampler_4d(sampler, u);
        if (!guiding_choose_light(&guiding, context->lights, (LightSet)set, point, u, &light))
            continue;
        bool arrives = light_selection_arrives(&plates, point, &light);
        if (set == LIGHTS_PUNCTUAL) note_lamp(context, point, &light, u[3], arrives, finds);
        if (!arrives) continue;
        guiding_weigh_light(&guiding, context->lights, point, &light);
        double lx = lights_sample_lx(context->lights, point, &light, u[3]) *
                    own_share(&guiding, point, &light);
        finds->sum[set] += lx;
        finds->squares[set] += lx * lx;
    }
    if (context->sunlit.nodes) try_sunlit(context, &guiding, point, sampler, finds);
}

void cell_lights_weigh(const PathContext *context, const LightFinds *finds, CellLight light,
                       float prob[LIGHT_CHOICES]) {
    double rest = light.usual * light.usual;
    for (int set = 0; set < LIGHT_SETS; set++) {
        prob[set] = 0;
        if (!lights_has(context->lights, (LightSet)set)) continue;
        double square = finds->points > 0 ? finds->squares[set] / finds->points : 0;
        double wanted = light.total > 0 ? GENEROSITY * sqrt(square) / light.total : 1;
        prob[set] = clampf((float)wanted, LEAST, 1);
        rest += square;
    }
    prob[LIGHTS_SUNLIT] = 0;
    if (context->sunlit.nodes)
        prob[LIGHTS_SUNLIT] = sunlit_finds_prob(&finds->sunlit, finds->points, rest);
}
