/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/lobe_facets.h"

#include "base/mathf.h"
#include "shaders/facets/microfacet.h"

const float facet_cosine[LOBE_FACETS] = {0.00960736f, 0.08426519f, 0.22221488f, 0.40245484f,
                                         0.59754516f, 0.77778512f, 0.91573481f, 0.99039264f};

typedef struct FacetPlace {
    FacetKnot alpha, ratio, azimuth, cosine;
} FacetPlace;

static FacetKnot root_knot(float value, int count) {
    return facet_knot((sqrtf(sqrtf(value)) - FACET_LEAST) / (1 - FACET_LEAST), count);
}

static FacetPlace place_of(Vec3 w, Vec2 alpha) {
    FacetPlace place;
    float high = max_f(alpha.x, alpha.y), low = min_f(alpha.x, alpha.y);
    float own = facet_own(w, alpha);
    place.alpha = root_knot(high, FACET_ALPHAS);
    place.ratio = root_knot(low / high, FACET_RATIOS);
    place.azimuth = facet_knot(facet_turn(own, alpha), FACET_AZIMUTHS);
    place.cosine = facet_knot(facet_axis(w.z, own), FACET_COSINES);
    return place;
}

/* ---- looking up ------------------------------------------------------------------------- */

static void add_facets(LobeFacets *sum, const LobeFacets *row, float share) {
    for (int i = 0; i < LOBE_FACETS; i++) sum->weight[i] += share * row->weight[i];
}

LobeFacets lobe_facets(const FacetTable *table, Vec3 w, Vec2 alpha) {
    FacetPlace p = place_of(w, alpha);
    LobeFacets sum = {{0}};
    for (int i = 0; i < 64; i++) {
        int a = i & 3, r = i >> 2 & 3, t = i >> 4;
        float share = p.alpha.share[a] * p.ratio.share[r] * p.azimuth.share[t];
        const LobeFacets *row =
            &table->lobe[p.alpha.first + a][p.ratio.first + r][p.azimuth.first + t][p.cosine.first];
        for (int c = 0; c < 4; c++) add_facets(&sum, &row[c], share * p.cosine.share[c]);
    }
    return sum;
}

LobeFacets mean_facets(const FacetTable *table, Vec2 alpha) {
    LobeFacets sum = {{0}};
    float high = max_f(alpha.x, alpha.y), low = min_f(alpha.x, alpha.y);
    FacetKnot a = root_knot(high, MEAN_ALPHAS), r = root_knot(low / high, MEAN_RATIOS);
    for (int i = 0; i < 16; i++)
        add_facets(&sum, &table->mean[a.first + (i & 3)][r.first + (i >> 2)],
                   a.share[i & 3] * r.share[i >> 2]);
    return sum;
}
