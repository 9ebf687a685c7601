/* SPDX-License-Identifier: Apache-2.0 */
#include "path/polarised.h"
#include "base/mathf.h"

#define NO_PLANE 1e-6f /* squared sine: below, s and p differ by no more */
#define LEAST 1e-12f

static void turn_row(PolarisedRow *row, float cosine2, float sine2) {
    Spectrum c = spectrum_all(cosine2), s = spectrum_all(sine2);
    Spectrum q1 = row->q[0] * c + row->q[1] * s;
    row->q[1] = row->q[1] * c - row->q[0] * s;
    row->q[0] = q1;
}

/* Cosine and sine of twice the angle from one axis to another, counter-clockwise as seen
 * against the light. */
static void twice_between(Vec3 from, Vec3 to, Vec3 way, float *cosine2, float *sine2) {
    float c = vec3_dot(from, to), s = vec3_dot(vec3_cross(from, to), way);
    float size2 = max_f(c * c + s * s, LEAST);
    *cosine2 = (c * c - s * s) / size2;
    *sine2 = 2 * c * s / size2;
}

static void turn_axis(Polarised *light, Vec3 to, Vec3 way) {
    float cosine2, sine2;
    twice_between(light->axis, to, way, &cosine2, &sine2);
    for (int i = 0; i < light->row_count; i++) turn_row(&light->row[i], cosine2, sine2);
    light->axis = to;
}

/* Multiplies the row by the matrix. Returns its first weight over what that was. */
static Spectrum times_matrix(PolarisedRow *row, const BsdfPolarisation *m) {
    Spectrum *q = row->q, zero = spectrum_all(0);
    Spectrum first = spectrum_max(spectrum_all(1) + m->difference * q[0], zero);
    SpectrumMask is_some = spectrum_above(first, spectrum_all(LEAST));
    Spectrum over = spectrum_all(1) / spectrum_max(first, spectrum_all(LEAST));
    Spectrum q2 = (m->along * q[1] + m->turned * q[2]) * over;
    Spectrum q3 = (m->along * q[2] - m->turned * q[1]) * over;
    q[0] = spectrum_select(is_some, (m->difference + m->kept * q[0]) * over, zero);
    q[1] = spectrum_select(is_some, q2, zero);
    q[2] = spectrum_select(is_some, q3, zero);
    return first;
}

/* No analyser weighs light more than twice as much as the eye does. */
static void scale_analyser(PolarisedRow *row, Spectrum first, Spectrum own) {
    Spectrum scale = row->scale * first / spectrum_max(own, spectrum_all(LEAST));
    row->scale = spectrum_clamp(scale, 0, 2);
}

static void apply(Polarised *light, const BsdfPolarisation *matrix) {
    Spectrum own = times_matrix(&light->row[0], matrix);
    light->share *= own;
    for (int i = 1; i < light->row_count; i++)
        scale_analyser(&light->row[i], times_matrix(&light->row[i], matrix), own);
}

/* Behind such a surface light counts alike, however polarised. */
static void forget(Polarised *light) {
    for (int i = 0; i < light->row_count; i++)
        for (int k = 0; k < 3; k++) light->row[i].q[k] = spectrum_all(0);
}

/* The axis across the plane of incidence; false: there is no such plane. */
static bool axis_across(Vec3 wo, Vec3 other, Vec3 *axis) {
    Vec3 across = vec3_cross(wo, other);
    float size2 = vec3_dot(across, across);
    if (!(size2 > NO_PLANE)) return false;
    *axis = vec3_scale(across, 1 / sqrtf(size2));
    return true;
}

/* The row of an analyser that weighs light along its axis by `lets`, across it by `blocks`;
 * cosine2, sine2: of twice that axis's angle. */
static PolarisedRow analyser(float cosine2, float sine2, float lets, float blocks) {
    float difference = lets + blocks > 0 ? (lets - blocks) / (lets + blocks) : 0;
    return (PolarisedRow){
        spectrum_all(1),
        {spectrum_all(difference * cosine2), spectrum_all(difference * sine2), spectrum_all(0)}};
}

/* Glasses block what lies along their absorption axis as the ray meets it: the axis less its
 * part along the ray; what they let through lies across that. */
static void put_on_glasses(const PolarisedEye *eye, Vec3 direction, Polarised *out) {
    float cosine2, sine2;
    Vec3 way = vec3_neg(direction), up = vec3_cross(eye->right, eye->forward);
    Vec3 absorbs = vec3_along(vec3_scale(eye->right, -eye->axis[1]), up, eye->axis[0]);
    Vec3 lets = vec3_cross(absorbs, way);
    if (!(vec3_dot(lets, lets) > NO_PLANE)) lets = out->axis;
    twice_between(out->axis, lets, way, &cosine2, &sine2);
    out->share *= spectrum_all(0.5f * (eye->lets + eye->blocks));
    out->row[0] = analyser(cosine2, sine2, eye->lets, eye->blocks);
}

void polarised_start(const PolarisedEye *eye, Vec3 direction, Polarised *out) {
    Vec3 right = vec3_along(eye->right, direction, -vec3_dot(eye->right, direction));
    if (!(vec3_dot(right, right) > NO_PLANE)) right = frame_from_z(direction).x;
    out->axis = vec3_normalize(right);
    out->share = spectrum_all(1);
    out->row_count = eye->with_stokes ? POLARISED_ROWS : 1;
    out->row[0] = analyser(1, 0, 1, 1);
    for (int i = 1; i < out->row_count; i++) {
        out->row[i] = analyser(1, 0, 1, 1);
        out->row[i].q[i - 1] = spectrum_all(1);
    }
    if (eye->has_glasses) put_on_glasses(eye, direction, out);
}

void polarised_turn(Polarised *light, const Surface *surface, Vec3 wo, const BsdfSample *way) {
    BsdfPolarisation matrix;
    Vec3 axis, wi = frame_to_world(&surface->frame, way->wi);
    if (!bsdf_polarise(&surface->bsdf, surface->local_wo, way, &matrix)) {
        forget(light);
        light->axis = frame_from_z(wi).x;
        return;
    }
    if (axis_across(wo, wi, &axis) || axis_across(wo, surface->frame.z, &axis))
        turn_axis(light, axis, wo);
    else light->axis = vec3_normalize(vec3_along(light->axis, wi, -vec3_dot(light->axis, wi)));
    apply(light, &matrix);
}

/* Holes leave light as it is. */
static void mix_with_holes(BsdfPolarisation *matrix, Spectrum through, float alpha) {
    Spectrum hole = spectrum_all(1 - alpha), pane = through * spectrum_all(alpha);
    Spectrum all = spectrum_max(hole + pane, spectrum_all(LEAST));
    matrix->difference *= pane / all;
    matrix->kept = (hole + matrix->kept * pane) / all;
    matrix->along = (hole + matrix->along * pane) / all;
    matrix->turned *= pane / all;
}

void polarised_pass(Polarised *light, const Surface *surface, Vec3 wo) {
    BsdfPolarisation matrix;
    Vec3 axis, local_wo = surface->local_wo;
    BsdfSample way = {.wi = vec3_neg(local_wo), .is_delta = true, .passes = true};
    if (!(surface->alpha > 0) || !axis_across(wo, surface->frame.z, &axis)) return;
    Spectrum through = bsdf_pass(&surface->bsdf, local_wo);
    if (spectrum_is_zero(through) || !bsdf_polarise(&surface->bsdf, local_wo, &way, &matrix))
        return;
    turn_axis(light, axis, wo);
    mix_with_holes(&matrix, through, surface->alpha);
    apply(light, &matrix);
}

Spectrum polarised_take(Polarised *light) {
    Spectrum share = light->share;
    light->share = spectrum_all(1);
    return share;
}

Spectrum polarised_seen(const Polarised *light, int row, Vec3 way, const PolarisedLight *from) {
    const PolarisedRow *r = &light->row[row];
    float cosine2, sine2;
    if (!from) return r->scale;
    twice_between(light->axis, from->axis, way, &cosine2, &sine2);
    Spectrum along = r->q[0] * spectrum_all(cosine2) + r->q[1] * spectrum_all(sine2);
    return r->scale * spectrum_max(spectrum_all(1) + from->degree * along, spectrum_all(0));
}
