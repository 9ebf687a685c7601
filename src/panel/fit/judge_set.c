/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/judge_set.h"

#include <math.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/judge_reason.h"
#include "panel/set/primary_spectra.h"

/* ---- along the normal -------------------------------------------------------------------- */

/* Luminance on the innermost ring, the mean of it. */
static double inner_luminance(const AngleTable *table) {
    int end = table_ring_end(table, 0);
    double sum = 0;
    for (int i = 0; i < end; i++) sum += (double)table->value[3 * i + 1];
    return sum / end;
}

/* Luminance that a level adds to black. */
static double added(const Measurement *set, int p, int level) {
    double black = set->has_black ? inner_luminance(&set->black) : 0;
    return inner_luminance(&set->primary[p].table[level]) - black;
}

static void judge_step(Judge *judge, const Measurement *set, int p, int level) {
    const MeasuredPrimary *m = &set->primary[p];
    double low = added(set, p, level), high = added(set, p, level + 1);
    double black = set->has_black ? inner_luminance(&set->black) : 0;
    double power =
        low > 0 && high > 0 ? log_d(high / low) / log_d(m->level[level + 1] / m->level[level]) : 0;
    if (high + black < JUDGE_FALLING * (low + black))
        judge_reason_add(judge, JUDGE_CARE,
                         "%s %g shows %.3g cd/m2, less than %s %g with "
                         "%.3g: check the unit and the level of these tables",
                         primary_names[p], m->level[level + 1], high + black, primary_names[p],
                         m->level[level], low + black);
    else if (power > JUDGE_POWER_MOST && high > JUDGE_BLACK_MOST * black)
        judge_reason_add(judge, JUDGE_CARE,
                         "from %s %g to %g luminance rises with the power "
                         "%.3g of the level, required: at most %g: check the unit and the "
                         "level of these tables",
                         primary_names[p], m->level[level], m->level[level + 1], power,
                         JUDGE_POWER_MOST);
}

static void judge_white(Judge *judge, const Measurement *set, double white) {
    if (white < JUDGE_WHITE_LEAST || white > JUDGE_WHITE_MOST)
        judge_reason_add(judge, JUDGE_CARE,
                         "white shows %.4g cd/m2 along the normal, "
                         "displays %g to %g: check the unit (panel import --unit) unless it "
                         "is %s",
                         white, JUDGE_WHITE_LEAST, JUDGE_WHITE_MOST,
                         white < JUDGE_WHITE_LEAST ? "dimmed" : "a lamp");
    for (int p = 0; p < 3 && !set->is_white_only; p++) {
        double one = added(set, p, set->primary[p].level_count - 1);
        if (one < JUDGE_PRIMARY_LEAST * white)
            judge_reason_add(judge, JUDGE_CARE,
                             "%s has %.2g %% of white's luminance, "
                             "required: at least %g %%: check the units of the primaries' "
                             "tables",
                             primary_names[p], 100 * one / white, 100 * JUDGE_PRIMARY_LEAST);
    }
}

/* ---- measured twice ---------------------------------------------------------------------- */

/* A spectrum that has not the colour of its table: light behind a pane or on a wall is by the
 * one, what an eye sees by the other. */
static void judge_spectra(Judge *judge, const Measurement *set) {
    Arena arena = *judge->arena;
    Twice worst;
    if (primary_twice(set, &worst) && twice_differ(&worst))
        judge_reason_add(judge, JUDGE_CARE,
                         "%s: measure both on the same day, or check the columns of the spectra "
                         "(primaries) and the unit of their wavelengths",
                         twice_text(&worst, &arena));
}

/* The panel shows the sum. */
static void judge_white_sum(Judge *judge, const Measurement *set) {
    Arena arena = *judge->arena;
    const Twice twice[2] = {{"white",
                             {"its table", "the sum of its primaries' tables"},
                             100 * set->white_apart[0],
                             100 * JUDGE_WHITE_APART,
                             " %"},
                            {"white",
                             {"its table", "the sum of its primaries' tables"},
                             set->white_apart[1],
                             PRIMARY_APART_UV,
                             " in u'v'"}};
    for (int i = 0; i < 2; i++)
        if (twice_differ(&twice[i]))
            judge_reason_add(judge, JUDGE_CARE,
                             "%s: the panel will show the sum: measure all with one brightness, "
                             "warmed up, and without what dims a bright picture",
                             twice_text(&twice[i], &arena));
}

/* A level whose colour is another primary's: tables under each other's name. A dark level's is
 * black's. */
static void judge_level_colours(Judge *judge, const Measurement *set) {
    double full[3][3], one[3];
    if (set->is_white_only) return;
    for (int p = 0; p < 3; p++) primary_colour(set, p, set->primary[p].level_count - 1, full[p]);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i + 1 < set->primary[p].level_count; i++) {
            if (added(set, p, i) < JUDGE_LEVEL_LEAST * full[p][1]) continue;
            primary_colour(set, p, i, one);
            for (int q = 0; q < 3; q++)
                if (q != p && twice_colour(one, full[q]) < twice_colour(one, full[p]) &&
                    twice_colour(one, full[p]) > PRIMARY_APART_UV)
                    judge_reason_add(judge, JUDGE_CARE,
                                     "%s %g is %.2g in u'v' from %s and %.2g from %s at full "
                                     "level, required: nearest to its own: are tables exchanged?",
                                     primary_names[p], set->primary[p].level[i],
                                     twice_colour(one, full[q]), primary_names[q],
                                     twice_colour(one, full[p]), primary_names[p]);
        }
}

void judge_set_levels(Judge *judge, const Measurement *set) {
    double black = set->has_black ? inner_luminance(&set->black) : 0, white = black;
    for (int p = 0; p < 3; p++) {
        for (int i = 0; i + 1 < set->primary[p].level_count; i++) judge_step(judge, set, p, i);
        white += added(set, p, set->primary[p].level_count - 1);
    }
    judge_white(judge, set, white);
    judge_spectra(judge, set);
    judge_white_sum(judge, set);
    judge_level_colours(judge, set);
    if (black > JUDGE_BLACK_MOST * white)
        judge_reason_add(judge, JUDGE_CARE,
                         "black shows %.3g cd/m2 and white %.3g: is it the "
                         "black pattern, and in the same unit?",
                         black, white);
}

/* ---- azimuths ---------------------------------------------------------------------------- */

/* Azimuths of a table, rising, radians. */
typedef struct Azimuths {
    int count;
    float *phi;
    bool is_mirrored; /* phi and -phi are the same */
} Azimuths;

#define SAME_AZIMUTH 1e-3f

static Azimuths azimuths_of(const AngleTable *table, bool is_mirrored, Arena *arena) {
    Azimuths out = {0, ARENA_NEW(arena, float, table->rows), is_mirrored};
    int rows = 0;
    for (int i = 0; i < table->rows; i++)
        if (table->theta[i] > 0) out.phi[rows++] = direction_grid_fold(table->phi[i], is_mirrored);
    sort_floats(out.phi, rows);
    for (int i = 0; i < rows; i++)
        if (!out.count || out.phi[i] - out.phi[out.count - 1] > SAME_AZIMUTH)
            out.phi[out.count++] = out.phi[i];
    return out;
}

/* Two neighbours and how far they are apart, radians. */
typedef struct AzimuthGap {
    float from, to, width;
} AzimuthGap;

/* Behind azimuth i; of the last one around the circle, or to the other end of a half. */
static AzimuthGap gap_behind(const Azimuths *a, int i) {
    bool is_last = i + 1 == a->count;
    float to = is_last ? a->phi[0] : a->phi[i + 1];
    float width = is_last ? (a->is_mirrored ? 0 : to + 2 * PI_F - a->phi[i]) : to - a->phi[i];
    return (AzimuthGap){a->phi[i], to, width};
}

/* The largest difference that rings show, of values that matter. */
typedef struct RingSpread {
    double ratio; /* of the brighter to the dimmer, less 1; INFINITY: to darkness */
    double theta;
} RingSpread;

#define SEEN 0.05 /* of a table's largest value: dimmer ones are nobody's cost */

static double row_value(const AngleTable *table, int row) {
    return (double)table->value[(size_t)row * (size_t)table->channels +
                                (size_t)(table->channels == 3 ? 1 : table->channels / 2)];
}

static double largest(const AngleTable *table) {
    double most = 0;
    for (int i = 0; i < table->rows; i++) most = fmax(most, row_value(table, i));
    return most;
}

static void widen(RingSpread *spread, double low, double high, double theta, double least) {
    if (!(high > least)) return;
    double ratio = high / fmax(low, 1e-3 * high) - 1;
    if (ratio > spread->ratio) *spread = (RingSpread){ratio, theta};
}

static bool is_at(const Azimuths *a, const AngleTable *table, int row, float phi) {
    return fabsf(direction_grid_fold(table->phi[row], a->is_mirrored) - phi) <= SAME_AZIMUTH;
}

/* Over rings that hold both ends of a gap; NULL: over all azimuths. */
static RingSpread spread_of(const AngleTable *table, const Azimuths *a, const AzimuthGap *gap) {
    RingSpread spread = {0, 0};
    double least = SEEN * largest(table);
    for (int i = 0; i < table->rows;) {
        int end = table_ring_end(table, i), ends = 0;
        double low = INFINITY, high = 0;
        for (int k = i; k < end; k++) {
            bool is_end = gap && (is_at(a, table, k, gap->from) || is_at(a, table, k, gap->to));
            if (gap && !is_end) continue;
            ends++;
            low = fmin(low, row_value(table, k)), high = fmax(high, row_value(table, k));
        }
        if (ends > 1) widen(&spread, fmax(0, low), high, (double)table->theta[i], least);
        i = end;
    }
    return spread;
}

static bool is_even(const AngleTable *table, const Azimuths *a, Arena scratch) {
    int channel = table->channels == 3 ? 1 : table->channels / 2;
    double noise = table_noise_relative(table, channel, scratch);
    return a->count > 1 && spread_of(table, a, NULL).ratio <= JUDGE_GAP_ISOTROPIC + 6 * noise;
}

static void name_gap(Judge *judge, const char *what, const AzimuthGap *gap,
                     const RingSpread *spread) {
    judge_reason_add(judge, JUDGE_CARE,
                     "%s: nothing is measured between the azimuths %.0f "
                     "and %.0f degrees, whose values differ by %s%.0f %% at theta %.0f: "
                     "between them a value may be wrong by so much, or by more where the "
                     "pattern has corners: measure every %.0f degrees or closer",
                     what, degrees_from_radians((double)gap->from),
                     degrees_from_radians((double)gap->to), spread->ratio > 9 ? "more than " : "",
                     100 * fmin(9, spread->ratio), degrees_from_radians(spread->theta),
                     JUDGE_GAP_DEG);
    json_object_set_new(judge->figures, "azimuth_gap_deg",
                        json_real(degrees_from_radians((double)gap->width)));
    json_object_set_new(judge->figures, "azimuth_gap_error", json_real(spread->ratio));
}

/* Four azimuths agree also where a pattern of four domains swings between them. */
static void judge_even(Judge *judge, const char *what, const Azimuths *a) {
    double least = INFINITY;
    for (int i = 0; i < a->count; i++) least = fmin(least, (double)gap_behind(a, i).width);
    if (degrees_from_radians(least) <= JUDGE_REPEAT_DEG) return;
    judge_reason_add(judge, JUDGE_CARE,
                     "%s: the %d azimuths agree, but %.0f degrees lie "
                     "between them: what repeats from azimuth to azimuth, such as the light of "
                     "pixels of four domains, cannot be seen: measure every %.0f degrees or "
                     "closer",
                     what, a->count, degrees_from_radians(least), JUDGE_GAP_DEG);
}

/* The gap that costs most. */
static void judge_table_azimuths(Judge *judge, const char *what, const AngleTable *table,
                                 bool is_mirrored) {
    Arena scratch = *judge->arena;
    Azimuths a = azimuths_of(table, is_mirrored, &scratch);
    AzimuthGap worst = {0};
    RingSpread cost = {-1, 0};
    if (a.count == 1 && table->theta_max > 0)
        judge_reason_add(judge, JUDGE_CARE,
                         "%s: measured at azimuth %.0f degrees only and "
                         "taken as the same all round, which these tables cannot tell: "
                         "measure every %.0f degrees or closer",
                         what, degrees_from_radians((double)a.phi[0]), JUDGE_GAP_DEG);
    if (a.count < 2) return;
    if (is_even(table, &a, scratch)) {
        if (!is_mirrored) judge_even(judge, what, &a);
        return;
    }
    for (int i = 0; i < a.count; i++) {
        AzimuthGap gap = gap_behind(&a, i);
        if (degrees_from_radians((double)gap.width) <= JUDGE_GAP_DEG + 0.5) continue;
        RingSpread spread = spread_of(table, &a, &gap);
        if (spread.ratio > cost.ratio) worst = gap, cost = spread;
    }
    if (worst.width > 0) name_gap(judge, what, &worst, &cost);
}

/* The light's azimuths: the largest value of the tables on both sides of a gap. */
static void judge_light_azimuths(Judge *judge, const Measurement *set) {
    AzimuthGap worst = {0};
    RingSpread cost = {-1, 0};
    for (int a = 0; a < set->azimuth_count; a++) {
        int b = (a + 1) % set->azimuth_count;
        double width = set->azimuth[b] - set->azimuth[a] + (b ? 0 : 2 * PI);
        if (degrees_from_radians(width) <= JUDGE_GAP_DEG + 0.5) continue;
        for (int i = 0; i < set->incidence_count; i++) {
            double x = largest(&set->brdf[a * set->incidence_count + i]);
            double y = largest(&set->brdf[b * set->incidence_count + i]), before = cost.ratio;
            widen(&cost, fmin(x, y), fmax(x, y), set->incidence[i], 0);
            if (cost.ratio > before)
                worst = (AzimuthGap){(float)set->azimuth[a], (float)set->azimuth[b], (float)width};
        }
    }
    if (cost.ratio > JUDGE_GAP_ISOTROPIC)
        name_gap(judge, "reflection, light's azimuth", &worst, &cost);
}

void judge_set_azimuths(Judge *judge, const Measurement *set) {
    const MeasuredPrimary *green = &set->primary[1];
    if (green->level_count)
        judge_table_azimuths(judge, "emission", &green->table[green->level_count - 1], false);
    if (!set->incidence_count) return;
    judge_table_azimuths(judge, "reflection", &set->brdf[set->incidence_count - 1],
                         set->azimuth_count < 2);
    if (set->azimuth_count > 1) judge_light_azimuths(judge, set);
}
