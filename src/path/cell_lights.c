/* SPDX-License-Identifier: Apache-2.0 */
#include "path/cell_lights.h"

#include "base/units.h"

/* A set whose samples' root mean square is a fifth of all light is always asked. */
#define GENEROSITY 5.0
#define LEAST 0.1f

/* The MIS weight of a path's light sample: the share that BSDF samples do not find. */
static double own_share(const Guiding *guiding, LitPoint point, const LightSample *light)
{
    if (light->is_delta) return 1;
    float cosine = vec3_dot(light->wi, point.ns);
    float other = guiding_pdf(guiding, light->wi, cosine * INV_PI_F) / light->pdf;
    return 1 / (1 + (double)(other * other));
}

static void note_lamp(const PathContext *context, LitPoint point, const LightSample *light,
                      float u, bool arrives, LightFinds *finds)
{
    double lx = light_selection_lx(context->lights, point, light, u);
    if (!(lx > 0)) return;
    lamp_finds_add(&finds->lamps, (LampFind){light->light_id, lx, arrives ? lx : 0});
}

void cell_lights_try(const PathContext *context, LitPoint point, uint32_t cell,
                     Sampler *sampler, LightFinds *finds)
{
    Guiding guiding;
    guiding_of_white(context, cell, point.ns, &guiding);
    finds->points++;
    for (int set = 0; set < LIGHT_SETS; set++) {
        LightSample light;
        float       u[4];
        if (!lights_has(context->lights, (LightSet)set)) continue;
        sampler_4d(sampler, u);
        if (!guiding_choose_light(&guiding, context->lights, (LightSet)set, point, u, &light))
            continue;
        bool arrives = light_selection_arrives(context->bvh, point, &light);
        if (set == LIGHTS_PUNCTUAL) note_lamp(context, point, &light, u[3], arrives, finds);
        if (!arrives) continue;
        guiding_weigh_light(&guiding, context->lights, point, &light);
        double lx = light_selection_lx(context->lights, point, &light, u[3]) *
                    own_share(&guiding, point, &light);
        finds->sum[set] += lx;
        finds->squares[set] += lx * lx;
    }
}

void cell_lights_weigh(const Lights *lights, const LightFinds *finds, double total,
                       float prob[LIGHT_SETS])
{
    for (int set = 0; set < LIGHT_SETS; set++) {
        prob[set] = 0;
        if (!lights_has(lights, (LightSet)set)) continue;
        double worth = finds->points > 0 ? sqrt(finds->squares[set] / finds->points) : 0;
        double wanted = total > 0 ? GENEROSITY * worth / total : 1;
        prob[set] = clampf((float)wanted, LEAST, 1);
    }
}
