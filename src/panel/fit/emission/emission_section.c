/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_section.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"

static void put(unsigned char **to, const void *from, size_t bytes)
{
    memcpy(*to, from, bytes);
    *to += bytes;
}

static void put_levels(unsigned char **to, const Measurement *set)
{
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++) {
            double   units = rint(set->primary[p].level[i] * (double)PANEL_LEVEL_UNIT);
            uint16_t level = (uint16_t)fmax(1, fmin(255 * (double)PANEL_LEVEL_UNIT, units));
            put(to, &level, sizeof level);
        }
}

/* The step of a component's loadings: what is left of the rounding, times scores of up to five
 * times their deviation, must not matter. */
static int loading_exponent(const EmissionModel *model)
{
    double step = 2 * model->tolerance / (24 * 5 * sqrt((double)model->rank->components));
    int    exponent = 0;
    frexp(step, &exponent);
    return 1 - exponent < 0 ? 0 : 1 - exponent > 20 ? 20 : 1 - exponent;
}

typedef struct LoadingCode {
    uint8_t exponent, width;
} LoadingCode;

static LoadingCode loading_code(const EmissionModel *model, int component)
{
    const EmissionRank *rank = model->rank;
    int   channels = model->samples->channels, e = loading_exponent(model);
    float most = 0;
    for (int c = 0; c < channels; c++)
        most = fmaxf(most, fabsf(rank->loading[c * rank->components + component]));
    while (e > 0 && most > ldexpf(32766, -e)) e--;
    return (LoadingCode){(uint8_t)e, ldexpf(most, e) < 126.5f ? 1 : 2};
}

static int rounded_to(float value, int exponent)
{
    return (int)fminf(32767, fmaxf(-32767, rintf(ldexpf(value, exponent))));
}

void emission_section_round(EmissionModel *model)
{
    EmissionRank *rank = model->rank;
    for (int c = 0; c < model->samples->channels; c++)
        rank->mean[c] = ldexpf((float)rounded_to(rank->mean[c], PANEL_MEAN_BITS),
                               -PANEL_MEAN_BITS);
    for (int k = 0; k < rank->components; k++) {
        LoadingCode code = loading_code(model, k);
        for (int c = 0; c < model->samples->channels; c++) {
            float *at = &rank->loading[c * rank->components + k];
            *at = ldexpf((float)rounded_to(*at, code.exponent), -code.exponent);
        }
    }
}

static PanelEmissionHead section_head(const EmissionModel *model)
{
    const EmissionSamples *s = model->samples;
    PanelEmissionHead head = {.components = (uint8_t)model->rank->components,
        .has_black = s->black >= 0, .beams = (uint8_t)model->beams,
        .cone_cos = fmaxf(0, (float)cos_d(s->cone)),
        .level_power = 2.2f, .cosine_power = model->rank->cosine_power};
    for (int p = 0; p < 3; p++)
        head.level_count[p] = (uint8_t)s->set->primary[p].level_count;
    return head;
}

static void put_loadings(unsigned char **to, const EmissionModel *model)
{
    const EmissionRank *rank = model->rank;
    LoadingCode code[PANEL_COMPONENTS_MAX];
    for (int k = 0; k < rank->components; k++) code[k] = loading_code(model, k);
    for (int k = 0; k < rank->components; k++) put(to, &code[k].exponent, 1);
    for (int k = 0; k < rank->components; k++) put(to, &code[k].width, 1);
    for (int pass = 2; pass >= 1; pass--)
        for (int k = 0; k < rank->components; k++)
            for (int c = 0; c < model->samples->channels && code[k].width == pass; c++) {
                int     value = rounded_to(rank->loading[c * rank->components + k],
                                           code[k].exponent);
                int16_t wide = (int16_t)value;
                int8_t  narrow = (int8_t)value;
                put(to, pass == 2 ? (const void *)&wide : (const void *)&narrow, (size_t)pass);
            }
}

const void *emission_section_write(const EmissionModel *model, Arena *arena, size_t *size)
{
    size_t channels = (size_t)model->samples->channels;
    size_t most = sizeof(PanelEmissionHead) + 4 * channels +
                  (size_t)model->rank->components * (2 + 2 * channels) + model->spline_size;
    for (int b = 0; b < model->beams; b++) most += model->beam[b].size;
    unsigned char    *bytes = ARENA_NEW(arena, unsigned char, most), *at = bytes;
    PanelEmissionHead head = section_head(model);
    put(&at, &head, sizeof head);
    put_levels(&at, model->samples->set);
    for (size_t c = 0; c < channels; c++) {
        int16_t mean = (int16_t)rounded_to(model->rank->mean[c], PANEL_MEAN_BITS);
        put(&at, &mean, sizeof mean);
    }
    put_loadings(&at, model);
    put(&at, model->spline_bytes, model->spline_size);
    for (int b = 0; b < model->beams; b++) put(&at, model->beam[b].bytes, model->beam[b].size);
    *size = (size_t)(at - bytes);
    return bytes;
}
