/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/brushed_loss.h"

#include "base/mathf.h"
#include "spectrum/spectrum.h"

/* Between neighbours of the axes of alpha and ratio, in fourth roots, at most. */
#define ALPHA_STEP 0.07f
#define RATIO_STEP 0.092f
/* Directions of a mean, over the fourth root of the cosine and over a quarter of a turn. */
#define MEAN_COSINES 48
#define MEAN_TURNS 16

/* A node: what is lost, what single facets send across, then LostFacets. */
#define BARE_WIDTH 2
#define MOST_WIDTH (BARE_WIDTH + 2 * LOBE_FACETS)

/* Directions, and points over the unit square of visible facets, of each pair of alphas. */
typedef struct BrushedDetail {
    int azimuths, cosines, points;
} BrushedDetail;

/* Fourth roots; one node where first is last. */
typedef struct BrushedAxis {
    float first, last;
    int count;
} BrushedAxis;

typedef struct BrushedSide {
    float *node; /* [alphas][ratios][azimuths][cosines][width] */
    float *mean; /* [alphas][ratios][width] of the means' axes */
} BrushedSide;

struct BrushedLoss {
    BrushedAxis alpha, ratio, mean_alpha, mean_ratio;
    BrushedDetail detail;
    int width;
    float *flux;         /* on the means' axes */
    BrushedSide side[2]; /* outside, inside */
};

/* ---- what single facets send on --------------------------------------------------------- */

/* Directions of 16 facets. */
typedef struct Ways {
    Spectrum x, y, z;
} Ways;

typedef struct FacetSum {
    Spectrum value[MOST_WIDTH];
} FacetSum;

/* Light from wo; length: of wo stretched by alpha. */
typedef struct BrushedEye {
    Vec3 wo;
    Vec2 alpha;
    float length, eta;
    int width;
} BrushedEye;

static Spectrum root_of(Spectrum a) {
    for (int i = 0; i < SPECTRUM_LANES; i++) a[i] = sqrtf(a[i]);
    return a;
}

static Spectrum stretched_length(Ways w, Vec2 alpha) {
    Spectrum x = spectrum_all(alpha.x) * w.x, y = spectrum_all(alpha.y) * w.y;
    return root_of(x * x + y * y + w.z * w.z);
}

/* 16 points of a lattice by the golden ratio. */
typedef struct LatticePoints {
    Spectrum rest; /* 1 - u1 is its square: they crowd where the steepest facets are, which lose
                      most */
    Spectrum x, y; /* of a circle */
} LatticePoints;

static const LatticePoints *lattice_of(int points, Arena *arena) {
    LatticePoints *out = ARENA_NEW(arena, LatticePoints, points / SPECTRUM_LANES);
    for (int i = 0; i < points; i++) {
        double turn = i * 0.6180339887498949;
        float sine, cosine;
        LatticePoints *to = &out[i / SPECTRUM_LANES];
        int lane = i % SPECTRUM_LANES;
        sincos_turns((float)(turn - (int)turn), &sine, &cosine);
        to->x[lane] = cosine;
        to->y[lane] = sine;
        to->rest[lane] = ((float)i + 0.5f) / (float)points;
    }
    return out;
}

/* As brushed_sample_visible. */
static Ways visible_facets(const BrushedEye *eye, const LatticePoints *u) {
    Vec2 a = eye->alpha;
    Vec3 wo = vec3_scale(vec3(a.x * eye->wo.x, a.y * eye->wo.y, eye->wo.z), 1 / eye->length);
    Spectrum z = u->rest * u->rest * spectrum_all(1 + wo.z) - spectrum_all(wo.z);
    Spectrum radius = root_of(spectrum_max(spectrum_all(1) - z * z, spectrum_all(0)));
    Ways h = {spectrum_all(a.x) * (spectrum_all(wo.x) + radius * u->x),
              spectrum_all(a.y) * (spectrum_all(wo.y) + radius * u->y),
              spectrum_max(z + spectrum_all(wo.z), spectrum_all(0))};
    Spectrum size = root_of(spectrum_max(h.x * h.x + h.y * h.y + h.z * h.z, spectrum_all(1e-30f)));
    return (Ways){h.x / size, h.y / size, h.z / size};
}

/* G2 / G1 of light that visible facets send towards wi; z: of wi to its side, none where it is
 * not above 0. */
static Spectrum passed_on(const BrushedEye *eye, Ways wi, Spectrum z) {
    Spectrum above = spectrum_max(z, spectrum_all(0));
    Spectrum masked = spectrum_all(eye->wo.z) * stretched_length(wi, eye->alpha) +
                      above * spectrum_all(eye->length);
    return above * spectrum_all(eye->wo.z + eye->length) / masked;
}

/* facet_polynomials, of 16 facets. */
static void add_lost(FacetSum *sum, Spectrum cosine, Spectrum reflected, Spectrum through) {
    for (int k = 0; k < LOBE_FACETS; k++) {
        Spectrum at = spectrum_all(1);
        for (int j = 0; j < LOBE_FACETS; j++)
            if (j != k)
                at *= (cosine - spectrum_all(facet_cosine[j])) /
                      spectrum_all(facet_cosine[k] - facet_cosine[j]);
        sum->value[BARE_WIDTH + k] += at * reflected;
        sum->value[BARE_WIDTH + LOBE_FACETS + k] += at * through;
    }
}

static void add_facets(const BrushedEye *eye, Ways h, Spectrum share, FacetSum *sum) {
    const Spectrum one = spectrum_all(1), none = spectrum_all(0), two = spectrum_all(2);
    Spectrum ox = spectrum_all(eye->wo.x), oy = spectrum_all(eye->wo.y);
    Spectrum oz = spectrum_all(eye->wo.z), eta = spectrum_all(eye->eta);
    Spectrum cosine = spectrum_clamp(ox * h.x + oy * h.y + oz * h.z, 1e-7f, 1);
    Spectrum over = spectrum_all(eye->eta > 0 ? 1 / eye->eta : 1e18f), to = two * cosine;
    Spectrum upward = one - (one - cosine * cosine) * over * over;
    Spectrum behind = root_of(spectrum_max(upward, none));
    SpectrumMask bends = spectrum_above(upward, none);
    Spectrum s = (cosine - eta * behind) / (cosine + eta * behind);
    Spectrum p = (eta * cosine - behind) / (eta * cosine + behind);
    Spectrum mirror = spectrum_select(bends, spectrum_all(0.5f) * (s * s + p * p), one);
    Ways back = {to * h.x - ox, to * h.y - oy, to * h.z - oz};
    Spectrum along = cosine * over - behind;
    Ways on = {along * h.x - over * ox, along * h.y - over * oy, along * h.z - over * oz};
    Spectrum is_sent = passed_on(eye, back, back.z), passes = passed_on(eye, on, none - on.z);
    Spectrum through = spectrum_select(bends, (one - mirror) * passes, none);
    sum->value[0] += share * (one - mirror * is_sent - through);
    sum->value[1] += share * through;
    if (eye->width > BARE_WIDTH)
        add_lost(sum, eye->eta >= 1 ? cosine : behind,
                 spectrum_select(bends, share * (one - is_sent), none),
                 spectrum_select(bends, share * (one - passes), none));
}

/* For light from a direction in the medium against which the other's index is eta. */
static void fill_node(const BrushedEye *eye, const LatticePoints *lattice, int points,
                      float *node) {
    FacetSum sum = {{{0}}};
    for (int i = 0; i < points / SPECTRUM_LANES; i++)
        add_facets(eye, visible_facets(eye, &lattice[i]),
                   lattice[i].rest * spectrum_all(2 / (float)points), &sum);
    for (int k = 0; k < eye->width; k++) node[k] = spectrum_sum(sum.value[k]);
}

/* ---- axes ------------------------------------------------------------------------------- */

static float fourth_root(float a) {
    return sqrtf(sqrtf(a));
}

static BrushedAxis axis_of(float least, float most, float step) {
    float first = fourth_root(least), last = fourth_root(most);
    if (!(last - first > 1e-6f)) return (BrushedAxis){first, first, 1};
    int count = (int)((last - first) / step) + 2;
    return (BrushedAxis){first, last, count < 4 ? 4 : count};
}

/* The same axis with nodes half-way between. */
static BrushedAxis finer(BrushedAxis axis) {
    axis.count = 2 * axis.count - 1;
    return axis;
}

static float axis_value(BrushedAxis axis, int node) {
    if (axis.count == 1) return axis.first * axis.first * axis.first * axis.first;
    float root = lerpf(axis.first, axis.last, (float)node / (float)(axis.count - 1));
    return min_f(root * root * root * root, 1);
}

static FacetKnot axis_knot(BrushedAxis axis, float value) {
    if (axis.count == 1) return (FacetKnot){0, 1, {1, 0, 0, 0}};
    return facet_knot((fourth_root(value) - axis.first) / (axis.last - axis.first), axis.count);
}

/* ---- looking up ------------------------------------------------------------------------- */

static void add_node(float *sum, const float *node, int count, float share) {
    for (int k = 0; k < count; k++) sum[k] += share * node[k];
}

/* The neighbours of a direction in a table of one pair. */
typedef struct DirectionKnots {
    FacetKnot turn, cosine;
} DirectionKnots;

static DirectionKnots direction_knots(const BrushedLoss *t, Vec3 w, Vec2 alpha) {
    float own = facet_own(w, alpha);
    return (DirectionKnots){facet_knot(facet_turn(own, alpha), t->detail.azimuths),
                            facet_knot(facet_axis(w.z, own), t->detail.cosines)};
}

/* Adds the first `count` numbers of the nodes of one pair. */
static void add_direction(const BrushedLoss *t, const float *pair, const DirectionKnots *at,
                          float share, float *sum, int count) {
    for (int i = 0; i < 16; i++) {
        int row = at->turn.first + (i >> 2), column = at->cosine.first + (i & 3);
        int place = row * t->detail.cosines + column;
        add_node(sum, pair + place * t->width, count,
                 share * at->turn.share[i >> 2] * at->cosine.share[i & 3]);
    }
}

/* The neighbours of a pair of alphas. */
typedef struct PairKnots {
    FacetKnot alpha, ratio;
    int ratios;
} PairKnots;

static PairKnots pair_knots(BrushedAxis alphas, BrushedAxis ratios, Vec2 alpha) {
    float high = max_f(alpha.x, alpha.y), low = min_f(alpha.x, alpha.y);
    return (PairKnots){axis_knot(alphas, high), axis_knot(ratios, low / high), ratios.count};
}

static int pair_count(const PairKnots *pairs) {
    return pairs->alpha.count * pairs->ratio.count;
}

/* Its place among all, and its share. */
static int pair_at(const PairKnots *pairs, int i, float *share) {
    int a = i / pairs->ratio.count, r = i % pairs->ratio.count;
    *share = pairs->alpha.share[a] * pairs->ratio.share[r];
    return (pairs->alpha.first + a) * pairs->ratios + pairs->ratio.first + r;
}

static int pair_size(const BrushedLoss *t) {
    return t->detail.azimuths * t->detail.cosines * t->width;
}

static void read_lost(const BrushedLoss *t, bool is_inside, Vec3 w, Vec2 alpha, float *sum,
                      int count) {
    PairKnots pairs = pair_knots(t->alpha, t->ratio, alpha);
    DirectionKnots at = direction_knots(t, w, alpha);
    float share;
    for (int i = 0; i < pair_count(&pairs); i++) {
        int place = pair_at(&pairs, i, &share) * pair_size(t);
        add_direction(t, t->side[is_inside].node + place, &at, share, sum, count);
    }
}

/* Reads a table on the means' axes: the first `count` of each node's `width` numbers. */
static void read_mean(const BrushedLoss *t, const float *table, int width, Vec2 alpha, float *sum,
                      int count) {
    PairKnots pairs = pair_knots(t->mean_alpha, t->mean_ratio, alpha);
    float share;
    for (int i = 0; i < pair_count(&pairs); i++) {
        int place = pair_at(&pairs, i, &share);
        add_node(sum, table + place * width, count, share);
    }
}

SolidLost brushed_lost(const BrushedLoss *table, bool is_inside, Vec3 w, Vec2 alpha) {
    float lost = 0, mean = 0, flux = 0;
    read_lost(table, is_inside, w, alpha, &lost, 1);
    read_mean(table, table->side[is_inside].mean, table->width, alpha, &mean, 1);
    read_mean(table, table->flux, 1, alpha, &flux, 1);
    return (SolidLost){clampf(lost, 0, 1), max_f(mean, 0), max_f(flux, 0)};
}

static LostFacets facets_of(const float node[MOST_WIDTH]) {
    LostFacets out;
    for (int k = 0; k < LOBE_FACETS; k++) {
        out.reflected[k] = node[BARE_WIDTH + k];
        out.through[k] = node[BARE_WIDTH + LOBE_FACETS + k];
    }
    return out;
}

LostFacets brushed_lost_facets(const BrushedLoss *table, bool is_inside, Vec3 w, Vec2 alpha) {
    float node[MOST_WIDTH] = {0};
    read_lost(table, is_inside, w, alpha, node, table->width);
    return facets_of(node);
}

LostFacets brushed_mean_facets(const BrushedLoss *table, bool is_inside, Vec2 alpha) {
    float node[MOST_WIDTH] = {0};
    read_mean(table, table->side[is_inside].mean, table->width, alpha, node, table->width);
    return facets_of(node);
}

/* ---- tables ----------------------------------------------------------------------------- */

static Vec2 pair_of(BrushedAxis alphas, BrushedAxis ratios, int place) {
    float high = axis_value(alphas, place / ratios.count);
    float low = high * axis_value(ratios, place % ratios.count);
    return (Vec2){high, low};
}

static void fill_pair(const BrushedLoss *t, Vec2 alpha, float eta, const LatticePoints *lattice,
                      float *node) {
    BrushedEye eye = {.alpha = alpha, .eta = eta, .width = t->width};
    for (int i = 0; i < t->detail.azimuths * t->detail.cosines; i++) {
        float turn = (float)(i / t->detail.cosines) / (float)(t->detail.azimuths - 1);
        float own = lerpf(alpha.y, alpha.x, turn * turn);
        float place = (float)(i % t->detail.cosines) / (float)(t->detail.cosines - 1);
        Vec3 wo = facet_direction(facet_axis_cosine(place, own), own, alpha);
        eye.wo = wo;
        eye.length = vec3_length(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
        fill_node(&eye, lattice, t->detail.points, node + i * t->width);
    }
}

/* Fills the means of one pair on the means' axes. pair: memory for a table of one pair. Evenly
 * in the cosine's fourth root: what narrow lobes lose they lose at grazing. */
static void fill_mean(const BrushedLoss *t, const float *node, Vec2 alpha, float *pair,
                      float *mean) {
    float all = 0, share;
    PairKnots pairs = pair_knots(t->alpha, t->ratio, alpha);
    for (int k = 0; k < pair_size(t); k++) pair[k] = 0;
    for (int i = 0; i < pair_count(&pairs); i++) {
        int place = pair_at(&pairs, i, &share) * pair_size(t);
        add_node(pair, node + place, pair_size(t), share);
    }
    for (int i = 0; i < MEAN_COSINES * MEAN_TURNS; i++) {
        float root = ((float)(i % MEAN_COSINES) + 0.5f) / MEAN_COSINES, sine, cosine;
        float root3 = root * root * root, z = root3 * root, side = safe_sqrtf(1 - z * z);
        all += root3 * z;
        sincos_turns(((float)(i / MEAN_COSINES) + 0.5f) / (4 * MEAN_TURNS), &sine, &cosine);
        DirectionKnots at = direction_knots(t, vec3(side * cosine, side * sine, z), alpha);
        add_direction(t, pair, &at, root3 * z, mean, t->width);
    }
    for (int k = 0; k < t->width; k++) mean[k] /= all;
}

static void fill_side(const BrushedLoss *t, float eta, BrushedSide *side, Arena *arena) {
    int pairs = t->alpha.count * t->ratio.count, size = pair_size(t);
    int means = t->mean_alpha.count * t->mean_ratio.count;
    const LatticePoints *lattice = lattice_of(t->detail.points, arena);
    float *room = ARENA_NEW(arena, float, size);
    side->node = ARENA_NEW(arena, float, pairs *size);
    side->mean = ARENA_NEW(arena, float, means * t->width);
    for (int i = 0; i < pairs; i++)
        fill_pair(t, pair_of(t->alpha, t->ratio, i), eta, lattice, side->node + i * size);
    for (int i = 0; i < means; i++)
        fill_mean(t, side->node, pair_of(t->mean_alpha, t->mean_ratio, i), room,
                  side->mean + i * t->width);
}

/* As in solid_energy.c: as single facets let it across, as much as both sides allow. */
static float flux_of(const float *outside, const float *inside, float ior) {
    return min_f(outside[1] / (1 - outside[0]) * outside[0],
                 inside[1] / (1 - inside[0]) * inside[0] * ior * ior);
}

/* As fine as half a second allows. */
static BrushedDetail detail_of(int pairs) {
    return pairs == 1    ? (BrushedDetail){49, 97, 1536}
           : pairs <= 60 ? (BrushedDetail){19, 49, 512}
                         : (BrushedDetail){17, 37, 320};
}

const BrushedLoss *brushed_loss_build(float ior, BrushedRange range, bool has_facets,
                                      Arena *arena) {
    BrushedLoss *t = ARENA_NEW(arena, BrushedLoss, 1);
    t->alpha = axis_of(range.least, range.most, ALPHA_STEP);
    t->ratio = axis_of(range.least_ratio, range.most_ratio, RATIO_STEP);
    t->mean_alpha = finer(t->alpha);
    t->mean_ratio = finer(t->ratio);
    t->detail = detail_of(t->alpha.count * t->ratio.count);
    t->width = has_facets ? MOST_WIDTH : BARE_WIDTH;
    fill_side(t, ior, &t->side[0], arena);
    fill_side(t, ior > 0 ? 1 / ior : 0, &t->side[1], arena);
    int means = t->mean_alpha.count * t->mean_ratio.count;
    t->flux = ARENA_NEW(arena, float, means);
    for (int i = 0; i < means; i++)
        t->flux[i] = flux_of(t->side[0].mean + i * t->width, t->side[1].mean + i * t->width, ior);
    return t;
}
