/* SPDX-License-Identifier: Apache-2.0 */
/* Narrow beams of an emission as they are stored. */
#include "panel/shape/panel_beam.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof(PanelBeamHead) == 32, "the file's layout");

#define CORE_LEAST 1e-5f
#define NARROW_MOST 100.0f
#define STEP_MOST 1e3f /* a component that bears more than this does nothing */

size_t panel_beam_pack(const PanelBeamHead *head, const float *coefficient, const float *step,
                       int components, Arena *arena, const void **bytes) {
    size_t knots = head->knots, steps = sizeof(float) * (size_t)components;
    unsigned char *out =
        ARENA_NEW(arena, unsigned char, sizeof *head + steps + 2 * knots * (size_t)components);
    unsigned char *at = out + sizeof *head + steps;
    memcpy(out, head, sizeof *head);
    for (int k = 0; k < components; k++) {
        const float *from = coefficient + (size_t)k * knots;
        float most = 0, unit = step[k];
        for (size_t i = 0; i < knots; i++) most = fmaxf(most, fabsf(from[i]));
        if (most > 32766 * unit) unit = most / 32766;
        if (most < 0.5f * unit || unit > STEP_MOST) unit = 0;
        memcpy(out + sizeof *head + sizeof unit * (size_t)k, &unit, sizeof unit);
        for (size_t i = 0; i < knots && unit > 0; i++, at += sizeof(int16_t)) {
            int16_t value = (int16_t)rintf(from[i] / unit);
            memcpy(at, &value, sizeof value);
        }
    }
    *bytes = out;
    return (size_t)(at - out);
}

static bool head_fits(const PanelBeamHead *head) {
    Vec3 c = vec3(head->centre[0], head->centre[1], head->centre[2]);
    Vec3 n = vec3(head->narrow[0], head->narrow[1], head->narrow[2]);
    return fabsf(vec3_dot(c, c) - 1) < 1e-3f && c.z >= 0 &&
           vec3_dot(n, n) <= NARROW_MOST * NARROW_MOST && head->core >= CORE_LEAST &&
           head->core <= 1 && head->knots >= 4 && head->knots <= PANEL_BEAM_KNOTS_MAX;
}

bool panel_beam_open(const void *bytes, size_t size, int components, Arena *arena, PanelBeam *out,
                     size_t *used) {
    PanelBeamHead head;
    const unsigned char *at = bytes, *end = at + size;
    size_t steps = sizeof(float) * (size_t)components;
    if (size < sizeof head + steps) return false;
    memcpy(&head, at, sizeof head);
    if (!head_fits(&head)) return false;
    const unsigned char *step = at + sizeof head;
    int stride = (components + 3) / 4 * 4;
    float *rows = ARENA_NEW(arena, float, (head.knots + 3) * stride);
    at = step + steps;
    for (int k = 0; k < components; k++) {
        float unit;
        memcpy(&unit, step + sizeof unit * (size_t)k, sizeof unit);
        if (!(unit >= 0 && unit <= STEP_MOST)) return false;
        if (unit > 0 && (size_t)(end - at) < 2 * (size_t)head.knots) return false;
        for (int i = 0; i < head.knots && unit > 0; i++, at += sizeof(int16_t)) {
            int16_t value;
            memcpy(&value, at, sizeof value);
            rows[i * stride + k] = unit * (float)value;
        }
    }
    *out = (PanelBeam){.centre = vec3(head.centre[0], head.centre[1], head.centre[2]),
                       .narrow = vec3(head.narrow[0], head.narrow[1], head.narrow[2]),
                       .core = head.core,
                       .core_squares = 1 / (head.core * head.core),
                       .knots = head.knots,
                       .stride = stride,
                       .coefficient = rows};
    *used = (size_t)(at - (const unsigned char *)bytes);
    return true;
}
