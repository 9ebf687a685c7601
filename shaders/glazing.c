/* SPDX-License-Identifier: Apache-2.0 */
/* glazed_window -- windscreens and other panes of several layers (PARHELION_glazing).
 *
 * Modelled as one sheet; what the pane's thickness does to light is worked out here:
 *
 *   image   of the face that is met: Fresnel's share of the light
 *   ghost   of the far face: light that went through the pane twice. It stands beside the
 *           image, by 2 d tan t' along the pane (t' the angle in the glass), and is turned by
 *           the wedge and by the pane's curvature, which is that of the vertex normals; so are
 *           the weaker ones of light that went to and fro more often
 *   pass    straight through; seen through the pane the world stands a little aside
 *   haze    what dirt and scratches scatter forward: a lobe about the straight way
 *
 *   layers       thickness (m), index of refraction, share of the light that a layer lets
 *                through along the normal. Float glass 1.52, PVB 1.485; 2.1 + 0.76 + 2.1 mm is
 *                usual
 *   wedge        radians, towards +u, -u, +v or -v: the pane grows thicker that way.
 *                Windscreens for head-up displays have 0.2 to 0.7 mrad towards their upper edge
 *   haze share   clean 0.001 to 0.005, dusty 0.02, dirty 0.05; width 1 to 30 degrees
 *   coatings     stacks of thin layers (coating.h) on the outside, the first layer's face and
 *                the triangles' front, and on the inside, the last layer's face and their back:
 *                a film against heat or reflections, a reflecting one for a head-up display
 *
 * Exact for both polarisations, whose means are taken at the end: two faces and one absorbing
 * body (layers/pane.h, as every thin pane). A ghost of order k has
 * (1 - r1)^2 t^2k r2^k r1^(k-1); orders below 1e-4 in all come with the last one above it; of a
 * coated pane it has c1^2 t^2k r2'^k r1'^(k-1), for each polarisation and wavelength.
 * The haze is a function of how far the direction's part along the pane moves, b:
 * share min(T(in), T(out)) w^2 / (pi (w^2 + b^2)^2), w the width's sine: half of the lobe lies
 * within w, the same both ways; what would leave below the pane's plane is lost.
 *
 * The faces of a curved pane are parallel but for the wedge. The images of its far face are
 * right to the first order in d over the radius: at 1 m, off by 1 to 2 % of their shift.
 *
 * Not modelled: what the layers reflect to each other (0.01 %), images by dirt, the ghost of
 * what is seen through the pane; its haze sends unpolarised light on. Light samples
 * pass straight; only what the eye sees through a pane is moved aside.
 *
 * Sources  Born and Wolf, "Principles of Optics", 1.5.2 (faces); Harvey 1976 and Stover,
 *          "Optical Scattering", for lobes that keep their shape over direction cosines.
 */
#include "shaders/glazing.h"

#include "base/mathf.h"
#include "base/units.h"
#include "shaders/polarisation.h"

#define ORDERS_MAX 16
#define LEFT_OVER 1e-4f    /* of the light: weaker images are merged */
#define LEAST_COSINE 1e-4f /* met flatter, a pane is a mirror */

/* One polarisation: what the near and the far face reflect. */
typedef struct Faces {
    float near_one, far_one;
} Faces;

/* The pane as one direction meets it. */
typedef struct Meeting {
    Faces s, p;                 /* where it is bare */
    Spectrum through;           /* the body, once */
    Spectrum reflected, passed; /* by all of it */
    bool is_coated;
    PaneImages coated[2]; /* s, p; undefined where it is bare */
} Meeting;

static Spectrum faces_reflect(Faces f, Spectrum t) {
    return pane_reflects(spectrum_all(f.near_one), spectrum_all(f.far_one), t);
}

static Spectrum faces_pass(Faces f, Spectrum t) {
    return pane_passes(spectrum_all(f.near_one), spectrum_all(f.far_one), t);
}

static void meet_coated_faces(const GlazedWindow *window, float cosine, bool is_front, Meeting *m) {
    PaneMeeting meeting = {window->coating, window->wavelengths, cosine, is_front, m->through};
    Spectrum half = spectrum_all(0.5f);
    m->is_coated = true;
    m->reflected = half * pane_coated_images(&meeting, false, &m->coated[0]);
    m->reflected += half * pane_coated_images(&meeting, true, &m->coated[1]);
    m->passed = half * (m->coated[0].passed + m->coated[1].passed);
}

static Meeting meet(const GlazedWindow *window, Vec3 wo) {
    const Glazing *pane = window->pane;
    Meeting m;
    float cosine = clampf(fabsf(wo.z), LEAST_COSINE, 1);
    bool is_front = (wo.z > 0) == window->front_is_up;
    float slant = pane_cosine_inside(cosine, pane->absorbing_ior);
    m.through = spectrum_exp(window->absorbance * spectrum_all(-1 / slant));
    if (window->coating) {
        meet_coated_faces(window, cosine, is_front, &m);
        return m;
    }
    float first = pane->layers[0].ior, last = pane->layers[pane->layer_count - 1].ior;
    Fresnel near = fresnel_dielectric(cosine, is_front ? first : last, NULL);
    Fresnel far = fresnel_dielectric(cosine, is_front ? last : first, NULL);
    Spectrum t = m.through, half = spectrum_all(0.5f);
    m.is_coated = false;
    m.s = (Faces){near.s, far.s};
    m.p = (Faces){near.p, far.p};
    m.reflected = half * (faces_reflect(m.s, t) + faces_reflect(m.p, t));
    m.passed = half * (faces_pass(m.s, t) + faces_pass(m.p, t));
    return m;
}

/* An image's share without absorption; each order has r1 r2 of the one before. */
static float order_of_faces(Faces f, int order) {
    if (!order) return f.near_one;
    float share = (1 - f.near_one) * (1 - f.near_one) * f.far_one;
    for (int i = 1; i < order; i++) share *= f.near_one * f.far_one;
    return share;
}

static Spectrum coated_order(const PaneImages *images, int order) {
    if (!order) return images->first;
    Spectrum share = images->ghost;
    for (int i = 1; i < order; i++) share *= images->next;
    return share;
}

static Spectrum order_share(const Meeting *m, int order) {
    if (m->is_coated)
        return spectrum_all(0.5f) *
               (coated_order(&m->coated[0], order) + coated_order(&m->coated[1], order));
    Spectrum t2 = spectrum_all(1);
    for (int i = 0; i < order; i++) t2 *= m->through * m->through;
    return t2 * spectrum_all(0.5f * (order_of_faces(m->s, order) + order_of_faces(m->p, order)));
}

/* ---- images ------------------------------------------------------------------------------ */

/* 2 d tan t' of all layers: shift along the pane, m, of light that went to and fro once. */
static float ghost_shift(const Glazing *pane, float cosine) {
    float sine = safe_sqrtf(1 - cosine * cosine), sum = 0;
    for (int i = 0; i < pane->layer_count; i++) {
        const GlazingLayer *layer = &pane->layers[i];
        float inside = pane_cosine_inside(cosine, layer->ior);
        sum += layer->thickness_m * sine / (layer->ior * inside);
    }
    return 2 * sum;
}

static float window_shift(const void *parameters, float cosine) {
    const Glazing *pane = ((const GlazedWindow *)parameters)->pane;
    float thickness = 0;
    for (int i = 0; i < pane->layer_count; i++) thickness += pane->layers[i].thickness_m;
    cosine = max_f(cosine, LEAST_COSINE);
    float straight = thickness * safe_sqrtf(1 - cosine * cosine) / cosine;
    return 0.5f * ghost_shift(pane, cosine) - straight;
}

/* Turns v as the least turn does that takes the unit vector a to b. */
static Vec3 turned(Vec3 v, Vec3 a, Vec3 b) {
    Vec3 sum = vec3_add(a, b), to_a = vec3_scale(b, 2 * vec3_dot(v, a));
    return vec3_along(vec3_add(v, to_a), sum, -vec3_dot(v, sum) / (1 + vec3_dot(a, b)));
}

/* The direction of an image in a pane whose faces are flat about its place: in the wedge's
 * layer the light meets the far face, leaning by the slope, `order` times. wo.z > 0. False: it
 * does not come out again. */
static bool flat_direction(const GlazedWindow *window, Vec3 wo, int order, Vec3 *wi) {
    *wi = vec3(-wo.x, -wo.y, wo.z);
    if (!order || (window->slope[0] == 0 && window->slope[1] == 0)) return true;
    float n = window->pane->wedge_ior;
    Vec3 far = vec3_normalize(vec3(window->slope[0], window->slope[1], 1));
    Vec3 way = vec3(-wo.x / n, -wo.y / n, -pane_cosine_inside(wo.z, n));
    for (int i = 0; i < order; i++) {
        if (i) way.z = -way.z;
        way = vec3_along(way, far, -2 * vec3_dot(way, far));
    }
    float x = n * way.x, y = n * way.y, z2 = 1 - x * x - y * y;
    if (!(z2 > 0 && way.z > 0)) return false;
    *wi = vec3(x, y, sqrtf(z2));
    return true;
}

/* The direction of an image; wo.z > 0, z the normal if `is_up`, else against it.
 *
 * A curved pane of normal z + K a at a, where light comes in at 0 and moves by h = s / 2 from
 * face to face (s the shift along the pane). An image of order k is mirrored k times by the far
 * face, at (2j - 1) h, and k - 1 times by the near one, at 2 j h, from within; each turns the
 * part along the pane by 2 c' times the normal's lean, one way or the other (c' and c the
 * cosines inside and outside). It goes out at 2 k h, where a lean of K 2 k h takes (n c' - c)
 * times itself away (Snell's law). To the first order in the leans and in d K that is
 *   2 n c' K h (k^2 - k (k - 1)) - (n c' - c) K 2 k h = 2 c K (k s / 2),
 * what a flat pane does that leans by K k s / 2: as the pane does half-way to where the image
 * comes out. So it is turned to there, with its wedge, and taken as flat. Faces between layers
 * are met in pairs, as far before half-way as behind it, and change nothing of this. */
static bool image_direction(const GlazedWindow *window, Vec3 wo, bool is_up, int order, Vec3 *wi) {
    const float(*bend)[2] = window->bend;
    bool is_flat = bend[0][0] == 0 && bend[0][1] == 0 && bend[1][0] == 0 && bend[1][1] == 0;
    float sine = sqrtf(wo.x * wo.x + wo.y * wo.y);
    if (!order || is_flat || !(sine > 0)) return flat_direction(window, wo, order, wi);
    float way = (is_up ? -0.5f : 0.5f) * (float)order * ghost_shift(window->pane, wo.z) / sine;
    float x = way * wo.x, y = way * wo.y;
    Vec3 z = vec3(0, 0, 1), there = vec3_normalize(vec3(bend[0][0] * x + bend[1][0] * y,
                                                        bend[0][1] * x + bend[1][1] * y, 1));
    Vec3 eye = turned(wo, there, z), flat;
    if (!(eye.z > 0) || !flat_direction(window, eye, order, &flat)) return false;
    *wi = turned(flat, z, there);
    return wi->z > 0;
}

/* u: in [0, the mean of all images' light); sum: of what may be chosen. */
static bool sample_image(const GlazedWindow *window, const Meeting *m, Vec3 wo, float u, float sum,
                         BsdfSample *sample) {
    int order = 0;
    Spectrum share = order_share(m, 0), rest = m->reflected - share;
    while (u >= spectrum_mean(share) && spectrum_mean(rest) > LEFT_OVER && order < ORDERS_MAX) {
        u -= spectrum_mean(share);
        share = order_share(m, ++order);
        rest -= share;
    }
    if (!(spectrum_mean(rest) > LEFT_OVER) || order == ORDERS_MAX) share += rest;
    float prob = spectrum_mean(share) / sum;
    Vec3 up = vec3(wo.x, wo.y, fabsf(wo.z)), wi;
    if (!(prob > 0) || !image_direction(window, up, wo.z > 0, order, &wi)) return false;
    if (wo.z < 0) wi.z = -wi.z;
    *sample = (BsdfSample){.wi = wi,
                           .pdf = prob,
                           .is_delta = true,
                           .weight = share / spectrum_all(prob),
                           .along = (float)order * ghost_shift(window->pane, up.z)};
    return true;
}

/* ---- haze -------------------------------------------------------------------------------- */

/* sr^-1 of a solid angle's part along the pane: its integral over all b is 1. */
static float haze_lobe(float width, float b2) {
    float w2 = width * width, sum = w2 + b2;
    return w2 / (PI_F * sum * sum);
}

static float haze_at(const GlazedWindow *window, Vec3 wo, Vec3 wi) {
    float x = wo.x + wi.x, y = wo.y + wi.y;
    return haze_lobe(window->pane->haze_width, x * x + y * y);
}

/* The light that each choice stands for, mean over the lanes. */
typedef struct PaneChoices {
    float image, haze, pass, sum;
} PaneChoices;

static PaneChoices choices_of(const GlazedWindow *window, const Meeting *m) {
    float through = spectrum_mean(m->passed), share = window->pane->haze_share;
    PaneChoices c = {.image = spectrum_mean(m->reflected), .haze = share * through};
    c.pass = window->shows_itself ? 0 : through - c.haze;
    c.sum = c.image + c.haze + c.pass;
    return c;
}

static bool window_reaches(const void *parameters, Vec3 wo, Vec3 wi) {
    const GlazedWindow *window = parameters;
    return window->pane->haze_share > 0 && wo.z * wi.z < 0;
}

static Spectrum window_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf) {
    const GlazedWindow *window = parameters;
    *pdf = 0;
    if (!window_reaches(parameters, wo, wi)) return spectrum_all(0);
    Meeting out = meet(window, wo), in = meet(window, wi);
    PaneChoices c = choices_of(window, &out);
    float lobe = haze_at(window, wo, wi);
    if (c.sum > 0) *pdf = c.haze / c.sum * lobe * fabsf(wi.z);
    return spectrum_min(out.passed, in.passed) * spectrum_all(window->pane->haze_share * lobe);
}

static bool sample_haze(const GlazedWindow *window, Vec3 wo, const float u[3], BsdfSample *sample) {
    float sine, cosine;
    sincos_turns(u[1], &sine, &cosine);
    float b = window->pane->haze_width * sqrtf(u[0] / (1 - u[0]));
    float x = b * cosine - wo.x, y = b * sine - wo.y, z2 = 1 - x * x - y * y;
    if (!(z2 > 0)) return false;
    Vec3 wi = vec3(x, y, wo.z > 0 ? -sqrtf(z2) : sqrtf(z2));
    float pdf;
    Spectrum f = window_eval(window, wo, wi, &pdf);
    if (!(pdf > 0)) return false;
    *sample = (BsdfSample){.wi = wi, .pdf = pdf, .weight = f * spectrum_all(fabsf(wi.z) / pdf)};
    return true;
}

/* ---- the model --------------------------------------------------------------------------- */

static bool window_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    const GlazedWindow *window = parameters;
    Meeting m = meet(window, wo);
    PaneChoices c = choices_of(window, &m);
    float place = u[2] * c.sum;
    if (!(c.sum > 0)) return false;
    if (place < c.image) return sample_image(window, &m, wo, place, c.sum, sample);
    if (place < c.image + c.haze || !(c.pass > 0)) return sample_haze(window, wo, u, sample);
    Spectrum clear = m.passed * spectrum_all(1 - window->pane->haze_share);
    *sample = (BsdfSample){.wi = vec3_neg(wo),
                           .pdf = c.pass / c.sum,
                           .is_delta = true,
                           .passes = true,
                           .weight = clear * spectrum_all(c.sum / c.pass)};
    return true;
}

static Spectrum window_pass(const void *parameters, Vec3 wo) {
    const GlazedWindow *window = parameters;
    Meeting m = meet(window, wo);
    return m.passed * spectrum_all(1 - window->pane->haze_share);
}

static Spectrum window_mirror(const void *parameters, Vec3 wo) {
    Meeting m = meet(parameters, wo);
    return m.reflected;
}

static void window_facts(const void *parameters, BsdfFacts *facts) {
    const GlazedWindow *window = parameters;
    facts->scatters = window->pane->haze_share > 0;
}

static Spectrum window_albedo(const void *parameters, Vec3 wo) {
    Meeting m = meet(parameters, wo);
    return m.reflected + m.passed;
}

/* ---- polarisation ------------------------------------------------------------------------ */

/* The order of the image with this shift along the pane. */
static int order_at(const GlazedWindow *window, float cosine, float along) {
    float shift = ghost_shift(window->pane, cosine);
    return shift > 0 ? (int)(along / shift + 0.5f) : 0;
}

/* Both faces as one direction meets them: near, far. */
static void face_waves(const GlazedWindow *window, Vec3 wo, Waves face[2]) {
    const Glazing *pane = window->pane;
    float cosine = clampf(fabsf(wo.z), LEAST_COSINE, 1);
    bool is_front = (wo.z > 0) == window->front_is_up;
    float ior[2] = {pane->layers[0].ior, pane->layers[pane->layer_count - 1].ior};
    for (int i = 0; i < 2; i++) face[i] = waves_reflected(cosine, ior[i != !is_front]);
}

static Waves image_waves(const Waves face[2], int order) {
    Waves near = face[0], far = face[1];
    if (!order) return near;
    float lets_s = 1 - near.s, lets_p = 1 - near.p;
    Waves w = {lets_s * lets_s * far.s, lets_p * lets_p * far.p, lets_s * lets_p * far.along, 0};
    for (int i = 1; i < order; i++) {
        w.s *= near.s * far.s;
        w.p *= near.p * far.p;
        w.along *= near.along * far.along;
    }
    return w;
}

/* Coated faces are exact in s and p; out of step by as much as bare ones. */
static BsdfPolarisation coated_polarisation(Spectrum s, Spectrum p, Waves bare) {
    float size = sqrtf(bare.s * bare.p), step = size > 0 ? bare.along / size : 0;
    Spectrum along = spectrum_all(0);
    for (int i = 0; i < SPECTRUM_LANES; i++) along[i] = 2 * step * sqrtf(s[i] * p[i]);
    PolarisedParts parts = {s + p, s - p, along, spectrum_all(0)};
    return polarised_of(&parts, s + p);
}

static BsdfPolarisation pass_polarisation(const Meeting *m, const Waves face[2]) {
    Spectrum t = m->through, s = faces_pass(m->s, t), p = faces_pass(m->p, t);
    float lets = (1 - face[0].s) * (1 - face[0].p) * (1 - face[1].s) * (1 - face[1].p);
    Spectrum along = t * spectrum_all(sqrtf(lets)) /
                     (spectrum_all(1) - t * t * spectrum_all(face[0].along * face[1].along));
    PolarisedParts parts = {s + p, s - p, along + along, spectrum_all(0)};
    return polarised_of(&parts, s + p);
}

static bool window_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                            BsdfPolarisation *out) {
    const GlazedWindow *window = parameters;
    Waves face[2];
    if (!way->is_delta) return false;
    Meeting m = meet(window, wo);
    int order = order_at(window, fabsf(wo.z), way->along);
    face_waves(window, wo, face);
    Waves image = image_waves(face, order);
    if (!m.is_coated) *out = way->passes ? pass_polarisation(&m, face) : polarised_by(image);
    else if (way->passes)
        *out = coated_polarisation(m.coated[0].passed, m.coated[1].passed, (Waves){1, 1, 1, 0});
    else
        *out = coated_polarisation(coated_order(&m.coated[0], order),
                                   coated_order(&m.coated[1], order), image);
    return true;
}

static void window_set(void *parameters, const BsdfSetting *setting) {
    if (setting->shows_itself) ((GlazedWindow *)parameters)->shows_itself = true;
}

const BsdfModel glazed_window_model = {
    .traits = BSDF_IS_SHEET | BSDF_SHOWS_ITSELF,
    .scatter = {.eval = window_eval,
                .sample = window_sample,
                .reaches = window_reaches,
                .albedo = window_albedo},
    .boundary = {window_mirror, window_pass, window_shift},
    .facts = window_facts,
    .set = window_set,
    .polarise = window_polarise,
};
