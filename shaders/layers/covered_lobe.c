/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/covered_lobe.h"

#include <string.h>

#include "base/mathf.h"
#include "shaders/facets/microfacet.h"
#include "spectrum/spectrum.h"

/* Points of a lobe, and of all lobes; they are followed a vector of 16 at a time, in a Spectrum
 * whose lanes are points. */
#define LANES SPECTRUM_LANES
#define LOBE_BATCHES 16
#define MEAN_BATCHES 32

/* 16 directions. */
typedef struct Directions {
    Spectrum x, y, z;
} Directions;

/* From where light comes, and what coat and overlay let pass of it. */
typedef struct Origins {
    Directions w;
    Spectrum open, kept;
} Origins;

/* For all points: cosines to their facets, the share of the light and what gets out of it; the
 * light that a white mirror must send, and what it does send. */
typedef struct LobePoints {
    int batches;
    Spectrum facet[MEAN_BATCHES], light[MEAN_BATCHES];
    Spectrum out[MEAN_BATCHES], white[MEAN_BATCHES], mirror[MEAN_BATCHES];
} LobePoints;

/* Unit vectors, each turned by the same angle from the one before. */
typedef struct Turns {
    Spectrum cosine, sine;
    float step[2]; /* from one batch to the next: cosine, sine */
} Turns;

static Spectrum root_of(Spectrum a) {
    float v[LANES];
    memcpy(v, &a, sizeof v);
    for (int i = 0; i < LANES; i++) v[i] = safe_sqrtf(v[i]);
    memcpy(&a, v, sizeof v);
    return a;
}

static Spectrum length_of(Directions a) {
    return root_of(a.x * a.x + a.y * a.y + a.z * a.z);
}

static Directions stretched(Directions w, Vec2 alpha) {
    return (Directions){w.x * spectrum_all(alpha.x), w.y * spectrum_all(alpha.y), w.z};
}

static Turns turns_from(float step) {
    Turns turns = {.step = {1, 0}};
    for (int i = 0; i < LANES; i++) {
        float sine, cosine;
        sincos_turns(step * (float)(i + 1), &sine, &cosine);
        turns.cosine[i] = cosine;
        turns.sine[i] = sine;
    }
    sincos_turns(step * LANES, &turns.step[1], &turns.step[0]);
    return turns;
}

static void turn_on(Turns *turns) {
    Spectrum c = spectrum_all(turns->step[0]), s = spectrum_all(turns->step[1]);
    Spectrum cosine = turns->cosine * c - turns->sine * s;
    turns->sine = turns->cosine * s + turns->sine * c;
    turns->cosine = cosine;
}

/* microfacet.h's sampling with u1 = 1 - rest^2; the light's share is lobe cos / pdf. */
static Directions reflected(const Cover *cover, const Directions *wo, const Turns *turns,
                            Spectrum rest, LobePoints *p) {
    Spectrum one = spectrum_all(1), two = spectrum_all(2), rest2 = rest * rest, facet;
    float a = min_f(cover->alpha.x, cover->alpha.y), a2 = a * a;
    Directions eye = stretched(*wo, cover->alpha), wi, in;
    Spectrum out = length_of(eye), side = one + root_of(wo->x * wo->x + wo->y * wo->y);
    Spectrum cap =
        spectrum_all(1 - a2) * side * side / (side * side + spectrum_all(a2) * wo->z * wo->z);
    Spectrum bound = cap * eye.z / out, z = rest2 * (one + bound) - bound;
    Spectrum radius = root_of(one - z * z);
    Directions half = {eye.x / out + radius * turns->cosine, eye.y / out + radius * turns->sine,
                       spectrum_max(eye.z / out + z, spectrum_all(0))};
    half = stretched(half, cover->alpha);
    Spectrum scale = one / spectrum_max(length_of(half), spectrum_all(1e-20f));
    facet = spectrum_clamp((wo->x * half.x + wo->y * half.y + wo->z * half.z) * scale, 0, 1);
    scale *= two * facet;
    wi = (Directions){half.x * scale - wo->x, half.y * scale - wo->y, half.z * scale - wo->z};
    wi.z = spectrum_max(wi.z, spectrum_all(0));
    in = stretched(wi, cover->alpha);
    p->facet[p->batches] = facet;
    p->light[p->batches] = wi.z * (cap * wo->z + out) /
                           spectrum_max(wo->z * length_of(in) + wi.z * out, spectrum_all(1e-20f));
    return wi;
}

static Spectrum by_cosine(const float table[ENERGY_COSINES], Spectrum cosine) {
    Spectrum place = root_of(cosine) * spectrum_all(ENERGY_COSINES - 1), low, high;
    place = spectrum_min(place, spectrum_all(ENERGY_COSINES - 1.0001f));
    SpectrumMask at = __builtin_convertvector(place, SpectrumMask);
    spectrum_neighbours(table, at, &low, &high);
    return low + (high - low) * (place - __builtin_convertvector(at, Spectrum));
}

static Spectrum opened(const Cover *cover, const Directions *w) {
    const Vec3 n = cover->normal;
    Spectrum cosine =
        w->x * spectrum_all(n.x) + w->y * spectrum_all(n.y) + w->z * spectrum_all(n.z);
    return by_cosine(cover->open, spectrum_min(spectrum_max(cosine, -cosine), spectrum_all(1)));
}

static Spectrum kept(const Cover *cover, Spectrum cosine) {
    return cover->has_overlay ? by_cosine(cover->kept, cosine) : spectrum_all(1);
}

static Origins origins_of(const Cover *cover, Directions w) {
    return (Origins){w, opened(cover, &w), kept(cover, w.z)};
}

static void add_batch(const Cover *cover, const Origins *from, const Turns *turns, Spectrum rest,
                      LobePoints *p) {
    Directions wi = reflected(cover, &from->w, turns, rest, p);
    Spectrum open = opened(cover, &wi);
    Spectrum both = spectrum_min(from->kept, kept(cover, wi.z));
    p->out[p->batches] = both * open;
    p->white[p->batches] = from->kept * from->open;
    p->mirror[p->batches++] = both * spectrum_min(from->open, open);
}

static float weighted_mean(const LobePoints *p, const Spectrum value[MEAN_BATCHES]) {
    Spectrum all = spectrum_all(0), sum = spectrum_all(0);
    for (int i = 0; i < p->batches; i++) {
        all += p->light[i];
        sum += p->light[i] * value[i];
    }
    float light = spectrum_sum(all);
    return light > 0 ? spectrum_sum(sum) / light : 0;
}

/* Weights of the polynomial through the values at facet_cosine, by Chebyshev's polynomials, of
 * all points' light times the difference of `out` from its mean. */
static void add_differences(const LobePoints *p, float mean, LobeFacets *facets) {
    Spectrum moment[LOBE_FACETS] = {{0}};
    for (int i = 0; i < p->batches; i++) {
        Spectrum light = p->light[i] * (p->out[i] - spectrum_all(mean));
        Spectrum x = p->facet[i] + p->facet[i] - spectrum_all(1), last = spectrum_all(1);
        Spectrum now = x;
        moment[0] += light * spectrum_all(0.5f);
        for (int k = 1; k < LOBE_FACETS; k++) {
            Spectrum next = x * now * spectrum_all(2) - last;
            moment[k] += light * now;
            last = now;
            now = next;
        }
    }
    for (int k = 0; k < LOBE_FACETS; k++) {
        float x = 2 * facet_cosine[k] - 1, last = 1, now = x;
        float sum = spectrum_sum(moment[0]);
        for (int j = 1; j < LOBE_FACETS; j++) {
            float next = 2 * x * now - last;
            sum += spectrum_sum(moment[j]) * now;
            last = now;
            now = next;
        }
        facets->weight[k] += sum * 2 / (LOBE_FACETS * LANES * (float)p->batches);
    }
}

/* facets: without a cover. `white` and `mirror` are of the same points: for a narrow lobe,
 * which loses little, they differ little. */
static CoveredLobe cover_facets(const LobePoints *p, LobeFacets facets) {
    float all = 0, mean = weighted_mean(p, p->out);
    Spectrum white = spectrum_all(0);
    CoveredLobe lobe;
    for (int k = 0; k < LOBE_FACETS; k++) {
        all += facets.weight[k];
        lobe.facets.weight[k] = facets.weight[k] * mean;
    }
    add_differences(p, mean, &lobe.facets);
    for (int i = 0; i < p->batches; i++) white += p->white[i];
    lobe.lost =
        spectrum_mean(white) / (float)p->batches - min_f(all, 1) * weighted_mean(p, p->mirror);
    lobe.lost = max_f(lobe.lost, 0);
    return lobe;
}

/* From first on, evenly. */
static Spectrum steps(float first, float step) {
    Spectrum s;
    for (int i = 0; i < LANES; i++) s[i] = first + step * (float)i;
    return s;
}

/* By Fibonacci's lattice: the golden section turns. Facets that graze or lose their light crowd
 * where `rest` nears 0. */
CoveredLobe covered_lobe(const Cover *cover, Vec3 w) {
    const float step = 1.0f / (LANES * LOBE_BATCHES);
    LobePoints points = {.batches = 0};
    Turns turns = turns_from(0.6180340f);
    Directions wo = {spectrum_all(w.x), spectrum_all(w.y), spectrum_all(w.z)};
    Origins from = origins_of(cover, wo);
    for (int i = 0; i < LOBE_BATCHES; i++, turn_on(&turns)) {
        Spectrum rest = steps(((float)(i * LANES) + 0.5f) * step, step);
        add_batch(cover, &from, &turns, rest, &points);
        points.light[i] *= rest + rest;
    }
    return cover_facets(&points, lobe_facets(&common_facet_table, w, cover->alpha));
}

/* A lane is a direction, evenly in the root of the cosine: what is lost is lost at grazing. */
CoveredLobe covered_mean(const Cover *cover) {
    const float golden = 0.6180340f;
    LobePoints points = {.batches = 0};
    Turns turns = turns_from(golden), azimuths = turns_from(golden);
    Spectrum root = steps(0.5f / LANES, 1.0f / LANES), z = root * root;
    Spectrum side = root_of(spectrum_all(1) - z * z), weight = root * z;
    Directions wo = {side * azimuths.cosine, side * azimuths.sine, z};
    Origins from = origins_of(cover, wo);
    weight /= spectrum_all(spectrum_mean(weight));
    sincos_turns(golden, &turns.step[1], &turns.step[0]);
    for (int i = 0; i < MEAN_BATCHES; i++, turn_on(&turns)) {
        float rest = ((float)i + 0.5f) / MEAN_BATCHES;
        Spectrum share = weight * spectrum_all(2 * rest);
        add_batch(cover, &from, &turns, spectrum_all(rest), &points);
        points.out[i] *= from.open;
        points.light[i] *= share;
        points.white[i] *= share;
    }
    return cover_facets(&points, mean_facets(&common_facet_table, cover->alpha));
}
