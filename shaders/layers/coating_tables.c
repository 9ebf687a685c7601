/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/coating_tables.h"

#include <string.h>

/* A stack and the body behind it: a metal or, where that is NULL, clear glass. */
typedef struct CoatedBody {
    const LayerStack *stack;
    const OpticalConstants *metal;
    double ior;
    bool is_p; /* of a pane: which polarisation */
} CoatedBody;

static ThinMedia media_at(const CoatedBody *body, const LayerStack *stack, int nm) {
    ThinMedia media;
    ThinMedium behind = {body->ior, 0, 0};
    int at = nm - CURVE_FIRST_NM;
    if (body->metal) {
        behind.n = (double)body->metal->n.value[at];
        behind.k = (double)body->metal->k.value[at];
    }
    thin_film_media(stack, behind, nm, &media);
    return media;
}

static double unpolarised(double s, double p) {
    return 0.5 * (s + p);
}

/* The cosine behind a boundary into an index `ratio` times that in front; below 0: none. */
static double cosine_behind(double cosine, double ratio) {
    double square = 1 - (1 - cosine * cosine) / (ratio * ratio);
    return square > 0 ? sqrt(square) : -1;
}

static double outside_of(const CoatedBody *body) {
    return body->stack ? body->stack->outside : 1;
}

static double cosine_of_row(int row, int count) {
    double t = (double)row / (count - 1);
    return t * t;
}

/* ---- one wavelength of each kind of table ----------------------------------------------- */

/* One value for each table of a kind. */
typedef struct CoatingRow {
    double front, back, through;
} CoatingRow;

typedef CoatingRow RowMaker(const CoatedBody *body, int nm, double cosine);

static ThinShares shares_at(const CoatedBody *body, const LayerStack *stack, int nm,
                            double cosine) {
    ThinMedia media = media_at(body, stack, nm);
    return thin_film_at(&media, cosine);
}

static CoatingRow front_row(const CoatedBody *body, int nm, double cosine) {
    ThinShares at = shares_at(body, body->stack, nm, cosine);
    return (CoatingRow){.front = unpolarised(at.reflect_s, at.reflect_p)};
}

static CoatingRow wave_row(const CoatedBody *body, int nm, double cosine) {
    ThinShares at = shares_at(body, body->stack, nm, cosine);
    return (CoatingRow){at.reflect_s, at.reflect_p, at.reflect_along};
}

static CoatingRow turned_row(const CoatedBody *body, int nm, double cosine) {
    return (CoatingRow){.front = shares_at(body, body->stack, nm, cosine).reflect_turned};
}

static CoatingRow cover_row(const CoatedBody *body, int nm, double cosine) {
    ThinShares bare = shares_at(body, NULL, nm, cosine);
    return (CoatingRow){.front = front_row(body, nm, cosine).front /
                                 fmax(unpolarised(bare.reflect_s, bare.reflect_p), 1e-9)};
}

/* Beyond the critical angle the wave behind the boundary falls off as e^(-kz). With k and the
 * wave's own part c along z in front, k^2 + c^2 is the same for all angles; over k / (k + c)
 * the reflectance has no kink, neither at the critical angle nor at grazing incidence. */
static double total_reflectance(const ThinMedia *from_denser, double ratio, double share) {
    double c2 = (1 - share) * (1 - share) / (share * share + (1 - share) * (1 - share));
    double cosine = sqrt(c2 * (1 - 1 / (ratio * ratio)));
    ThinShares at = thin_film_at(from_denser, cosine);
    return unpolarised(at.reflect_s, at.reflect_p);
}

static CoatingRow total_row(const CoatedBody *body, int nm, double share) {
    double ratio = body->ior / outside_of(body);
    ThinMedia media = media_at(body, body->stack, nm);
    if (ratio >= 1) thin_film_reverse(&media);
    return (CoatingRow){.front = total_reflectance(&media, ratio >= 1 ? ratio : 1 / ratio, share)};
}

/* cosine: in the medium of the smaller index. */
static CoatingRow solid_row(const CoatedBody *body, int nm, double cosine) {
    double ratio = body->ior / outside_of(body); /* inside over outside */
    double denser = ratio >= 1 ? ratio : 1 / ratio, other = cosine_behind(cosine, denser);
    ThinMedia outer = media_at(body, body->stack, nm), inner = outer;
    thin_film_reverse(&inner);
    ThinShares front = thin_film_at(&outer, ratio >= 1 ? cosine : other);
    ThinShares back = thin_film_at(&inner, ratio >= 1 ? other : cosine);
    return (CoatingRow){.front = unpolarised(front.reflect_s, front.reflect_p),
                        .back = unpolarised(back.reflect_s, back.reflect_p),
                        .through = unpolarised(front.through_s, front.through_p)};
}

/* A face of a sheet as both sides find it, for one polarisation. */
typedef struct SheetFace {
    double outer, inner, through;
} SheetFace;

static void sheet_face(const ThinMedia *media, double cosine, double inside, SheetFace *s,
                       SheetFace *p) {
    ThinMedia turned = *media;
    thin_film_reverse(&turned);
    ThinShares outer = thin_film_at(media, cosine), inner = thin_film_at(&turned, inside);
    *s = (SheetFace){outer.reflect_s, inner.reflect_s, outer.through_s};
    *p = (SheetFace){outer.reflect_p, inner.reflect_p, outer.through_p};
}

/* A face of a pane for one polarisation. At grazing incidence, and where nothing enters a
 * thinner body, nothing gets in or out. */
static CoatingRow pane_row(const CoatedBody *body, int nm, double cosine) {
    SheetFace s, p;
    ThinMedia media = media_at(body, body->stack, nm);
    double inside = cosine_behind(cosine, body->ior / outside_of(body));
    if (!(cosine > 0 && inside > 0)) return (CoatingRow){.front = 1, .back = 1};
    sheet_face(&media, cosine, inside, &s, &p);
    SheetFace one = body->is_p ? p : s;
    return (CoatingRow){one.outer, one.inner, one.through};
}

/* ---- tables ----------------------------------------------------------------------------- */

/* 2 * integral over dcos of (piecewise linear in t) cos with cos = t^2: exact, by the integrals
 * of 4 t^3 and 4 t^4 over each interval. */
static void mean_weights(int count, double *weight) {
    for (int i = 0; i < count; i++) weight[i] = 0;
    for (int i = 0; i + 1 < count; i++) {
        double a = (double)i / (count - 1), b = (double)(i + 1) / (count - 1);
        double a4 = a * a * a * a, b4 = b * b * b * b, all = b4 - a4;
        double high = (0.8 * (b4 * b - a4 * a) - a * all) / (b - a);
        weight[i] += all - high;
        weight[i + 1] += high;
    }
}

static void mean_of(const Curve *row, int count, Curve *out) {
    double weight[COATING_COSINES_MAX];
    mean_weights(count, weight);
    for (int w = 0; w < CURVE_COUNT; w++) {
        double sum = 0;
        for (int i = 0; i < count; i++) sum += weight[i] * (double)row[i].value[w];
        out->value[w] = (float)sum;
    }
}

enum { KINDS = 3 }; /* front, back, through */

/* A row of each table; NULL: not requested. */
static void make_row(Curve *const out[KINDS], const CoatedBody *body, RowMaker *make,
                     double cosine) {
    for (int w = 0; w < CURVE_COUNT; w++) {
        CoatingRow row = make(body, CURVE_FIRST_NM + w, cosine);
        const double value[KINDS] = {row.front, row.back, row.through};
        for (int i = 0; i < KINDS; i++)
            if (out[i]) out[i]->value[w] = (float)value[i];
    }
}

static double bend_of(const Curve *row) {
    double worst = 0;
    for (int w = 0; w < CURVE_COUNT; w++) {
        double between = 0.5 * ((double)row[0].value[w] + (double)row[2].value[w]);
        worst = fmax(worst, fabs((double)row[1].value[w] - between));
    }
    return worst;
}

/* Doubles the rows; returns how much new ones differ from straight lines between the old. */
static double refine(Curve *table[KINDS], int *count, const CoatedBody *body, RowMaker *make,
                     Arena *arena) {
    double worst = 0;
    int old = *count;
    Curve *finer[KINDS] = {NULL};
    *count = 2 * old - 1;
    for (int i = 0; i < KINDS; i++) {
        if (!table[i]) continue;
        finer[i] = ARENA_NEW(arena, Curve, *count);
        for (int c = 0; c < old; c++) finer[i][2 * c] = table[i][c];
    }
    for (int c = 1; c < *count; c += 2) {
        Curve *row[KINDS];
        for (int i = 0; i < KINDS; i++) row[i] = finer[i] ? &finer[i][c] : NULL;
        make_row(row, body, make, cosine_of_row(c, *count));
        for (int i = 0; i < KINDS; i++)
            if (row[i]) worst = fmax(worst, bend_of(row[i] - 1));
    }
    for (int i = 0; i < KINDS; i++) table[i] = finer[i];
    return worst;
}

/* Between the old rows; the straight lines between the finer ones are four times nearer. */
static const double BEND_ALLOWED = 1e-3;

static const CoatingTable *table_of(const Curve *row, int count, Arena *arena) {
    if (!row) return NULL;
    CoatingTable *table = ARENA_NEW(arena, CoatingTable, 1);
    *table = (CoatingTable){count, row};
    return table;
}

/* kinds: how many of front, back, through are requested. */
static CoatingTables *tables_of(const CoatedBody *body, RowMaker *make, int kinds, Arena *arena) {
    int count = 2;
    Curve *row[KINDS] = {NULL};
    CoatingTables *out = ARENA_NEW(arena, CoatingTables, 1);
    for (int i = 0; i < kinds; i++) row[i] = ARENA_NEW(arena, Curve, count);
    for (int c = 0; c < count; c++) {
        Curve *ends[KINDS] = {NULL};
        for (int i = 0; i < kinds; i++) ends[i] = &row[i][c];
        make_row(ends, body, make, cosine_of_row(c, count));
    }
    while (count < COATING_COSINES_MAX)
        if (refine(row, &count, body, make, arena) <= BEND_ALLOWED && count >= 65) break;
    out->front = table_of(row[0], count, arena);
    out->back = table_of(row[1], count, arena);
    out->through = table_of(row[2], count, arena);
    mean_of(row[0], count, &out->front_mean);
    if (row[1]) mean_of(row[1], count, &out->back_mean);
    if (row[2]) mean_of(row[2], count, &out->through_mean);
    return out;
}

const CoatingTables *coating_of_solid(const LayerStack *stack, double ior, Arena *arena) {
    CoatedBody body = {.stack = stack, .ior = ior};
    CoatingTables *out = tables_of(&body, solid_row, 3, arena);
    out->total = tables_of(&body, total_row, 1, arena)->front;
    return out;
}

const CoatingTables *coating_of_metal(const LayerStack *stack, const OpticalConstants *metal,
                                      Arena *arena) {
    return tables_of(&(CoatedBody){.stack = stack, .metal = metal}, front_row, 1, arena);
}

const CoatingTables *coating_of_cover(const LayerStack *stack, double ior, Arena *arena) {
    return tables_of(&(CoatedBody){.stack = stack, .ior = ior}, cover_row, 1, arena);
}

const CoatingWaves *coating_waves(const LayerStack *stack, double ior,
                                  const OpticalConstants *metal, Arena *arena) {
    CoatedBody body = {.stack = stack, .metal = metal, .ior = ior};
    CoatingWaves *out = ARENA_NEW(arena, CoatingWaves, 1);
    const CoatingTables *tables = tables_of(&body, wave_row, KINDS, arena);
    *out = (CoatingWaves){tables->front, tables->back, tables->through,
                          tables_of(&body, turned_row, 1, arena)->front};
    return out;
}

static void set_face(const LayerStack *stack, double ior, PaneCoating *pane, int side,
                     Arena *arena) {
    CoatedBody body = {.stack = stack, .ior = ior};
    pane->face[side][0] = tables_of(&body, pane_row, KINDS, arena);
    body.is_p = true;
    pane->face[side][1] = tables_of(&body, pane_row, KINDS, arena);
}

const PaneCoating *coating_of_pane(const Glazing *pane, Arena *arena) {
    PaneCoating *out = ARENA_NEW(arena, PaneCoating, 1);
    out->ior = pane->absorbing_ior;
    for (int i = 0; i < 2; i++) {
        const GlazingLayer *layer = &pane->layers[i ? pane->layer_count - 1 : 0];
        set_face(pane->coating[i], (double)layer->ior, out, i, arena);
    }
    return out;
}

const PaneCoating *coating_of_sheet(const LayerStack *stack, double ior, Arena *arena) {
    PaneCoating *out = ARENA_NEW(arena, PaneCoating, 1);
    double outside = stack ? stack->outside : 1;
    LayerStack *none = ARENA_NEW(arena, LayerStack, 1);
    none->outside = outside;
    out->ior = (float)(ior / outside);
    for (int i = 0; i < 2; i++) {
        bool is_bare = stack && stack->faces == (i ? COATED_FRONT : COATED_BACK);
        if (i && stack && stack->faces == COATED_BOTH)
            memcpy(out->face[1], out->face[0], sizeof out->face[1]);
        else set_face(is_bare ? none : stack, ior, out, i, arena);
    }
    return out;
}

/* ---- energies --------------------------------------------------------------------------- */

/* How much of the light along a direction meets facets at the cosine of each row of a table. */
static void facet_weights(float cosine, float alpha, int count, double *weight) {
    EnergyLobe lobe;
    for (int i = 0; i < count; i++) weight[i] = 0;
    for (int i = 0; i < ENERGY_LOBE_POINTS; i++) {
        if (!energy_lobe_point(1, cosine, alpha, i, &lobe)) continue;
        double place = sqrt((double)lobe.facet) * (count - 1);
        int low = place < count - 2 ? (int)place : count - 2;
        weight[low] += (double)lobe.weight * (low + 1 - place) / ENERGY_LOBE_POINTS;
        weight[low + 1] += (double)lobe.weight * (place - low) / ENERGY_LOBE_POINTS;
    }
}

static void energy_row(const CoatingTable *front, const double *weight, Curve *out) {
    double sum[CURVE_COUNT] = {0};
    for (int i = 0; i < front->count; i++)
        for (int w = 0; w < CURVE_COUNT && weight[i] > 0; w++)
            sum[w] += weight[i] * (double)front->row[i].value[w];
    for (int w = 0; w < CURVE_COUNT; w++) out->value[w] = (float)fmin(sum[w], 1);
}

/* One alpha's rows; row 0 of alpha stands for every smooth boundary. */
static void energy_rows(const CoatingTable *front, int alpha_row, int count, Curve *row) {
    double weight[COATING_COSINES_MAX];
    for (int c = 0; c < count; c++) {
        double cosine = c > 0 ? cosine_of_row(c, count) : 1e-5;
        if (alpha_row == 0) {
            row[c] = front->row[c * (front->count - 1) / (count - 1)];
            continue;
        }
        float alpha = energy_alpha_of_row(alpha_row, COATING_PER_OCTAVE);
        facet_weights((float)cosine, alpha, front->count, weight);
        energy_row(front, weight, &row[c]);
    }
}

static const CoatingEnergy *energy_of(const CoatingTable *front, AlphaSpan alphas, Arena *arena) {
    int first = energy_alpha_knot(alphas.least, COATING_PER_OCTAVE).low;
    int last = energy_alpha_knot(alphas.most, COATING_PER_OCTAVE).low + 1;
    int count =
        front->count < COATING_ENERGY_COSINES_MAX ? front->count : COATING_ENERGY_COSINES_MAX;
    CoatingEnergy *energy = ARENA_NEW(arena, CoatingEnergy, 1);
    Curve *row = ARENA_NEW(arena, Curve, COATING_ALPHAS * count);
    for (int a = first; a <= last; a++) {
        energy_rows(front, a, count, row + a * count);
        mean_of(row + a * count, count, &energy->average[a]);
    }
    energy->count = count;
    energy->directional = row;
    return energy;
}

const CoatingTables *coating_of_face(const LayerStack *stack, double ior, AlphaSpan alphas,
                                     Arena *arena) {
    CoatingTables *out = tables_of(&(CoatedBody){.stack = stack, .ior = ior}, front_row, 1, arena);
    out->energy = energy_of(out->front, alphas, arena);
    return out;
}
