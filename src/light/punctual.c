/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: choosing a lamp. No allocation, no lock, no libm. */
#include "light/punctual.h"

#include "base/mathf.h"
#include "base/sampler.h"
#include "light/branch_choice.h"
#include "light/opening.h"
#include "spectrum/photometry.h"

#define BLIND_SHARE 0.1f  /* of the choices that go by intensity alone among what can be seen */
#define NEAR_SPREAD 4.0f  /* of the mean square extent, that softens the horizon */
#define LEAST_COSINE 0.1f /* polished surfaces may show lamps on their horizon brightest */

/* Share of its largest intensity with which a lamp that has an opening stays in the choice
 * where its middle sends nothing: its rim may. */
#define LEAST_OF_OPENING 0.1f

/* ---- one lamp ---------------------------------------------------------------------------- */

/* Directions between the world and the luminaire's frame. */
static Vec3 lamp_from_world(const PunctualLight *light, Vec3 v) {
    return vec3(vec3_dot(light->axis_x, v), vec3_dot(light->axis_y, v), vec3_dot(light->axis_z, v));
}

static Vec3 world_from_lamp(const PunctualLight *light, Vec3 v) {
    return vec3_along(vec3_along(vec3_scale(light->axis_x, v.x), light->axis_y, v.y), light->axis_z,
                      v.z);
}

float punctual_falloff(const PunctualLight *light, Vec3 from_light) {
    if (light->kind == LIGHT_LUMINAIRE)
        return intensity_web_at(light->web, lamp_from_world(light, from_light));
    if (light->kind != LIGHT_SPOT) return 1;
    float range = max_f(light->cos_inner - light->cos_outer, 1e-6f);
    float ramp = clampf((vec3_dot(light->direction, from_light) - light->cos_outer) / range, 0, 1);
    return ramp * ramp;
}

static bool has_opening(const PunctualLight *light) {
    return light->kind == LIGHT_LUMINAIRE && light->opening.shape != OPENING_POINT;
}

float punctual_radius(const PunctualLight *light) {
    return has_opening(light) ? opening_radius(&light->opening) : 0;
}

/* Where the light, or the middle of its opening, is as seen from position, and its illuminance
 * (lx per unit of its colour's intensity) on a plane that faces it. */
static float point_geometry(const PunctualLight *light, Vec3 position, PunctualSample *sample) {
    if (light->kind == LIGHT_DIRECTIONAL) {
        sample->wi = vec3_neg(light->direction);
        sample->distance = INFINITY;
        return 1;
    }
    Vec3 to_light = vec3_sub(light->position, position);
    float d2 = vec3_dot(to_light, to_light);
    sample->distance = sqrtf(d2);
    sample->wi = vec3_normalize(to_light);
    return d2 > 0 ? punctual_falloff(light, vec3_neg(sample->wi)) / d2 : 0;
}

/* The same of a point of its opening. */
static float opening_geometry(const PunctualLight *light, Vec3 position, const float u[2],
                              PunctualSample *sample) {
    float weight;
    Vec3 from = lamp_from_world(light, vec3_sub(position, light->position));
    Vec3 at = opening_sample(&light->opening, from, u, &weight), away = vec3_sub(from, at);
    float d2 = vec3_dot(away, away);
    sample->distance = sqrtf(d2);
    sample->wi = vec3_normalize(vec3_neg(world_from_lamp(light, away)));
    return d2 > 0 && weight > 0 ? weight * intensity_web_at(light->web, vec3_normalize(away)) / d2
                                : 0;
}

PunctualPoint punctual_point(const PunctualLight *light, int light_id, const float u[4]) {
    PunctualPoint out = {.light_id = light_id, .is_distant = light->kind == LIGHT_DIRECTIONAL};
    out.at = out.is_distant ? vec3_neg(light->direction) : light->position;
    if (!has_opening(light)) return out;
    out.opening = opening_point(&light->opening, u);
    out.at = vec3_add(out.at, world_from_lamp(light, out.opening.at));
    return out;
}

bool punctual_towards(const PunctualLight *light, const PunctualPoint *point, Vec3 place,
                      PunctualSample *sample) {
    sample->light_id = point->light_id;
    if (!has_opening(light)) {
        sample->scale = point_geometry(light, place, sample);
        return sample->scale > 0;
    }
    Vec3 from = lamp_from_world(light, vec3_sub(place, light->position));
    Vec3 away = vec3_sub(from, point->opening.at);
    float d2 = vec3_dot(away, away);
    if (!(d2 > 0)) return false;
    sample->distance = sqrtf(d2);
    sample->wi = vec3_normalize(vec3_neg(world_from_lamp(light, away)));
    sample->scale = opening_share(&light->opening, &point->opening, from) *
                    intensity_web_at(light->web, vec3_normalize(away)) / d2;
    return sample->scale > 0;
}

/* The cosine at the point, of light that comes from `height` above its plane at `distance` and
 * from `radius` around; kept above 0 where anything can come. */
static float cosine_above(float height, float distance, float radius) {
    if (!(height + radius > 0)) return 0;
    float soft = 0.5f * (height + sqrtf(height * height + radius * radius));
    float cosine = soft / sqrtf(distance * distance + radius * radius);
    return LEAST_COSINE + (1 - LEAST_COSINE) * cosine;
}

/* A light's weight in the choice at a point: above 0 where it may light, finite inside it. */
static float target_at(const PunctualLight *light, const LitPoint *point) {
    PunctualSample middle;
    float candela = luminance_from_rgb(light->intensity);
    if (!has_opening(light)) {
        float lux = candela * point_geometry(light, point->position, &middle);
        float cosine = vec3_dot(point->ns, middle.wi);
        return lux > 0 ? lux * cosine_above(point->both_sides ? fabsf(cosine) : cosine, 1, 0) : 0;
    }
    Vec3 away = vec3_sub(point->position, light->position);
    float radius = opening_radius(&light->opening), d2 = vec3_dot(away, away);
    float relative = d2 > 0 ? punctual_falloff(light, vec3_normalize(away)) : 0;
    float height = -vec3_dot(point->ns, away);
    return candela * max_f(relative, LEAST_OF_OPENING) / (d2 + radius * radius) *
           cosine_above(point->both_sides ? fabsf(height) : height, sqrtf(d2), radius);
}

/* ---- which branch ------------------------------------------------------------------------ */

static Spectrum roots(Spectrum squares) {
    float value[SPECTRUM_LANES];
    memcpy(value, &squares, sizeof value);
    for (int i = 0; i < SPECTRUM_LANES; i++) value[i] = sqrtf(value[i]);
    memcpy(&squares, value, sizeof value);
    return squares;
}

/* Bilinear over the octahedral map: the upper half is the diamond inside, the lower one is
 * folded out over its edges. d of any length. */
static float profile_at(const PunctualProfile *profile, Vec3 d) {
    const float middle = 0.5f * (PUNCTUAL_PROFILE_SIDE - 1);
    float sum = fabsf(d.x) + fabsf(d.y) + fabsf(d.z), scale = sum > 0 ? 1 / sum : 0;
    float p = d.x * scale, q = d.y * scale;
    if (d.z < 0) {
        float folded = copysignf(1 - fabsf(q), p);
        q = copysignf(1 - fabsf(p), q);
        p = folded;
    }
    float s = middle * (p + 1), t = middle * (q + 1);
    int i = (int)s, j = (int)t;
    i = i < 0 ? 0 : i > PUNCTUAL_PROFILE_SIDE - 2 ? PUNCTUAL_PROFILE_SIDE - 2 : i;
    j = j < 0 ? 0 : j > PUNCTUAL_PROFILE_SIDE - 2 ? PUNCTUAL_PROFILE_SIDE - 2 : j;
    const float *row = profile->value + j * PUNCTUAL_PROFILE_SIDE + i;
    float a = s - (float)i, b = t - (float)j;
    float low = lerpf(row[0], row[1], a);
    return lerpf(low, lerpf(row[PUNCTUAL_PROFILE_SIDE], row[PUNCTUAL_PROFILE_SIDE + 1], a), b);
}

/* Light that the branches send towards the point, intensity over power. The wider their lamps
 * lie as seen from there (near: about half the sine of that angle), the more they count as
 * shining evenly, since narrow cones from other places may meet there. d: from the centres. */
static Spectrum sent(const PunctualNode *node, const Spectrum d[3], Spectrum near) {
    Spectrum value = spectrum_all(1);
    for (int k = 0; k < node->count; k++)
        if (node->profile[k])
            value[k] = profile_at(node->profile[k], vec3(d[0][k], d[1][k], d[2][k]));
    return value + (node->mean - value) * near;
}

/* The probability of every branch; none goes to those below the horizon. False: all are. */
static bool weigh(const PunctualNode *node, const LitPoint *point, Spectrum *prob) {
    const Spectrum zero = spectrum_all(0), half = spectrum_all(0.5f);
    const Vec3 p = point->position, n = point->ns;
    const Spectrum d[3] = {spectrum_all(p.x) - node->centre[0], spectrum_all(p.y) - node->centre[1],
                           spectrum_all(p.z) - node->centre[2]};
    Spectrum radius2 = node->spread2 + node->spread2;
    Spectrum d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + radius2 + spectrum_all(1e-12f);
    Spectrum inverse2 = spectrum_all(1) / d2;
    Spectrum height =
        -(spectrum_all(n.x) * d[0] + spectrum_all(n.y) * d[1] + spectrum_all(n.z) * d[2]);
    if (point->both_sides) height = spectrum_max(height, -height);
    SpectrumMask seen = spectrum_above(height + node->radius, zero) | node->is_distant;
    Spectrum power = spectrum_select(seen, node->power, zero);
    Spectrum soft =
        half * (height + roots(height * height + spectrum_all(NEAR_SPREAD) * node->spread2));
    Spectrum cosine =
        spectrum_all(LEAST_COSINE) + spectrum_all(1 - LEAST_COSINE) * soft * roots(inverse2);
    Spectrum near = half * roots(radius2 * inverse2);
    Spectrum weight = power * inverse2 * cosine * sent(node, d, near);
    weight = spectrum_select(node->is_distant, node->lux * half, weight);
    float sum = spectrum_sum(weight), all = spectrum_sum(power);
    if (!(all > 0)) return false;
    *prob = power * spectrum_all(1 / all);
    if (sum > 0 && sum < 1e30f)
        *prob = weight * spectrum_all((1 - BLIND_SHARE) / sum) + *prob * spectrum_all(BLIND_SHARE);
    return true;
}

/* ---- which lamp -------------------------------------------------------------------------- */

typedef struct LampList {
    const int *ids;
    const float *arrives; /* share of each lamp's light; NULL: not known */
    int count;
} LampList;

/* Chooses one of the lights by what each gives; *prob_inverse makes the estimate unbiased.
 * *pick is a random number that is used up and left uniform. */
static int choose_among(const PunctualLights *lights, const LampList *list, const LitPoint *point,
                        float *pick, float *prob_inverse) {
    int chosen = NO_ID;
    float sum = 0, chosen_weight = 0;
    for (int i = 0; i < list->count; i++) {
        float weight = target_at(&lights->lights[list->ids[i]], point);
        if (list->arrives) weight *= list->arrives[i];
        if (!(weight > 0)) continue;
        sum += weight;
        if (*pick * sum < weight) { /* takes the newcomer with probability weight / sum */
            *pick = *pick * sum / weight;
            chosen = list->ids[i];
            chosen_weight = weight;
        } else {
            *pick = (*pick * sum - weight) / (sum - weight);
        }
        *pick = clampf(*pick, 0, BELOW_ONE);
    }
    *prob_inverse = chosen == NO_ID ? 0 : sum / chosen_weight;
    return chosen;
}

static int choose(const PunctualLights *lights, const LitPoint *point, float *pick,
                  float *prob_inverse) {
    const PunctualNode *node = lights->root;
    if (!node)
        return choose_among(lights, &(LampList){lights->order, NULL, lights->count}, point, pick,
                            prob_inverse);
    float prob = 1;
    int i;
    for (;; node = node->child[i]) {
        Spectrum probs;
        if (!weigh(node, point, &probs)) return NO_ID;
        i = choose_branch(probs, node->count, pick);
        prob *= probs[i];
        if (!node->child[i]) break;
    }
    LampList list = {lights->order + node->first[i], NULL, node->lamp_count[i]};
    int id = choose_among(lights, &list, point, pick, prob_inverse);
    *prob_inverse /= prob;
    return id;
}

static bool is_known(const PunctualKnown *known, int id) {
    for (int i = 0; i < known->count; i++)
        if (known->id[i] == id) return true;
    return false;
}

static int choose_by_known(const PunctualLights *lights, const PunctualKnown *known,
                           const LitPoint *point, float *pick, float *prob_inverse) {
    LampList list = {known->id, known->arrives, known->count};
    float prob = known->others;
    int id;
    *prob_inverse = 0;
    if (unit_choose(pick, known->others)) {
        id = choose(lights, point, pick, prob_inverse);
        if (is_known(known, id)) id = NO_ID;
    } else {
        prob = 1 - prob;
        id = choose_among(lights, &list, point, pick, prob_inverse);
    }
    *prob_inverse /= prob;
    return id;
}

bool punctual_sample(const PunctualLights *lights, const PunctualKnown *known,
                     const LitPoint *point, const float u[3], PunctualSample *sample) {
    float prob_inverse, pick = u[0];
    sample->light_id = known ? choose_by_known(lights, known, point, &pick, &prob_inverse)
                             : choose(lights, point, &pick, &prob_inverse);
    if (sample->light_id == NO_ID) return false;
    const PunctualLight *light = &lights->lights[sample->light_id];
    const float on_opening[2] = {pick, u[1]};
    float lux = has_opening(light) ? opening_geometry(light, point->position, on_opening, sample)
                                   : point_geometry(light, point->position, sample);
    sample->scale = lux * prob_inverse;
    return true;
}
