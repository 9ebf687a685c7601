/* SPDX-License-Identifier: Apache-2.0 */
#include "import/luminaire/luminaire_doubts.h"

#include <math.h>

#include "spectrum/twice.h"

#define ANGLE_SLACK 1e-6
/* Two intensities of one direction are one if they differ by less of the larger, or by less of
 * the luminaire's largest. */
#define ALIKE_OF_ITSELF 0.05
#define ALIKE_OF_LARGEST 0.005
#define GAP_MOST 1.5 /* between the last plane and the first, of the widest between planes */

typedef struct Doubting {
    Luminaire *of;
    Arena *arena;
    double largest_cd;
} Doubting;

static double intensity(const Luminaire *in, int plane, int gamma) {
    return in->intensity_cd[(size_t)plane * (size_t)in->gammas + (size_t)gamma];
}

static bool is_at(double angle_deg, double a, double b) {
    return fabs(angle_deg - a) < ANGLE_SLACK || fabs(angle_deg - b) < ANGLE_SLACK;
}

static bool is_alike(const Doubting *doubting, double a, double b) {
    return fabs(a - b) <= ALIKE_OF_ITSELF * fmax(a, b) ||
           fabs(a - b) <= ALIKE_OF_LARGEST * doubting->largest_cd;
}

/* ---- directions that are left out -------------------------------------------------------- */

/* The largest intensity of the planes at one gamma, of the gammas in one plane. */
static double most_at_gamma(const Luminaire *in, int gamma) {
    double most = 0;
    for (int i = 0; i < in->planes; i++) most = fmax(most, intensity(in, i, gamma));
    return most;
}

static double most_in_plane(const Luminaire *in, int plane) {
    double most = 0;
    for (int k = 0; k < in->gammas; k++) most = fmax(most, intensity(in, plane, k));
    return most;
}

/* CIE 121 and LM-63: from 0 or 90 to 90 or 180 degrees. */
static void check_gammas(const Doubting *doubting) {
    const Luminaire *in = doubting->of;
    double first = in->gamma_deg[0], last = in->gamma_deg[in->gammas - 1];
    if (!is_at(first, 0, 90))
        luminaire_doubt(doubting->of, doubting->arena,
                        "its vertical angles begin at %g "
                        "degrees, required: 0 or 90: dark is assumed below, and so %s",
                        first, first < 90 ? "along its axis" : "at the horizon");
    double most = most_at_gamma(in, in->gammas - 1);
    if (!is_at(last, 90, 180) && most > 0)
        luminaire_doubt(doubting->of, doubting->arena,
                        "its vertical angles end at %g degrees "
                        "with %g cd, required: 90 or 180: dark is assumed beyond",
                        last, most);
}

/* The planes of a whole turn: the step from the last to the first is no wider than others. */
static void check_turn(const Doubting *doubting) {
    const Luminaire *in = doubting->of;
    double widest = 0, gap = in->c_deg[0] + 360 - in->c_deg[in->planes - 1];
    if (in->is_round || in->mirror_deg[0] >= 0) return;
    for (int i = 1; i < in->planes; i++) widest = fmax(widest, in->c_deg[i] - in->c_deg[i - 1]);
    if (gap > GAP_MOST * widest)
        luminaire_doubt(doubting->of, doubting->arena,
                        "its planes go from %g to %g degrees, "
                        "required a whole turn: between %g and %g they are interpolated",
                        in->c_deg[0], in->c_deg[in->planes - 1], in->c_deg[in->planes - 1],
                        in->c_deg[0] + 360);
}

/* Types A and B: V and H, of which one is the longitude and the other the latitude. */
static void check_tipped(const Doubting *doubting) {
    const Luminaire *in = doubting->of;
    int planes = in->planes - 1, gammas = in->gammas - 1;
    double c[2] = {in->c_deg[0], in->c_deg[planes]}, most = 0;
    double g[2] = {in->gamma_deg[0] - 90, in->gamma_deg[gammas] - 90};
    if (c[0] > ANGLE_SLACK - 90) most = fmax(most, most_in_plane(in, 0));
    if (c[1] < 90 - ANGLE_SLACK) most = fmax(most, most_in_plane(in, planes));
    if (g[0] > ANGLE_SLACK - 90) most = fmax(most, most_at_gamma(in, 0));
    if (g[1] < 90 - ANGLE_SLACK) most = fmax(most, most_at_gamma(in, gammas));
    bool has_axis = c[0] <= 0 && c[1] >= 0 && g[0] <= 0 && g[1] >= 0, is_a = in->type == WEB_A;
    if (most > 0 || !has_axis)
        luminaire_doubt(doubting->of, doubting->arena,
                        "its angles go from V %g to %g and H %g "
                        "to %g degrees, with up to %g cd at their border, required: -90 to 90: "
                        "dark is assumed beyond%s",
                        is_a ? g[0] : c[0], is_a ? g[1] : c[1], is_a ? c[0] : g[0],
                        is_a ? c[1] : g[1], most, has_axis ? "" : ", and so along its axis");
}

/* ---- directions that stand there twice --------------------------------------------------- */

/* All planes meet at gamma 0 and 180. */
static void check_pole(const Doubting *doubting, int gamma) {
    const Luminaire *in = doubting->of;
    double low = INFINITY, high = 0, angle = in->gamma_deg[gamma];
    if (!is_at(angle, 0, 180)) return;
    for (int i = 0; i < in->planes; i++) {
        low = fmin(low, intensity(in, i, gamma));
        high = fmax(high, intensity(in, i, gamma));
    }
    if (!is_alike(doubting, low, high))
        luminaire_doubt(doubting->of, doubting->arena,
                        "its planes have %g to %g cd at %g "
                        "degrees, which is one direction, required: one intensity: each plane "
                        "keeps its own",
                        low, high, in->type == WEB_C ? angle : angle - 90);
}

/* A plane at 360 is the one at 0. */
static void check_seam(const Doubting *doubting) {
    const Luminaire *in = doubting->of;
    int last = in->planes - 1;
    if (in->c_deg[last] - in->c_deg[0] < 360 - ANGLE_SLACK) return;
    for (int k = 0; k < in->gammas; k++) {
        double a = intensity(in, 0, k), b = intensity(in, last, k);
        if (is_alike(doubting, a, b)) continue;
        luminaire_doubt(doubting->of, doubting->arena,
                        "its planes at %g and %g degrees are "
                        "one, but have %g and %g cd at %g degrees: the first is taken",
                        in->c_deg[0], in->c_deg[last], a, b, in->gamma_deg[k]);
        return;
    }
}

/* ---- light ------------------------------------------------------------------------------- */

static void check_flux(const Doubting *doubting) {
    const Luminaire *in = doubting->of;
    double flux = luminaire_flux(in, *doubting->arena);
    if (in->stated_lm > 0 && flux > LUMINAIRE_FLUX_MOST * in->stated_lm)
        luminaire_doubt(doubting->of, doubting->arena,
                        "its intensities add up to %.6g lm, "
                        "%.3g times the %.6g lm that the file states (%s), required: at most "
                        "%g times: the intensities are taken",
                        flux, flux / in->stated_lm, in->stated_lm, in->stated_as,
                        LUMINAIRE_FLUX_MOST);
    Twice twice = {
        "its light",
        {arena_format(doubting->arena, "the %.6g lm that its intensities add up to", flux),
         arena_format(doubting->arena, "the %.6g lm that the file states (%s)", in->stated_lm,
                      in->stated_as)},
        100 * twice_share(flux, in->stated_lm),
        100 * LUMINAIRE_TAKES_MOST,
        " %"};
    if (in->stated_lm > 0 && flux < in->stated_lm && twice_differ(&twice))
        luminaire_doubt(doubting->of, doubting->arena,
                        "%s: are they in cd, or cd per 1000 lm? They are taken",
                        twice_text(&twice, doubting->arena));
}

void luminaire_doubts_find(Luminaire *luminaire, Arena *arena) {
    Doubting doubting = {luminaire, arena, 0};
    for (int i = 0; i < luminaire->planes; i++)
        doubting.largest_cd = fmax(doubting.largest_cd, most_in_plane(luminaire, i));
    if (luminaire->type != WEB_C) {
        check_tipped(&doubting);
    } else {
        check_gammas(&doubting);
        check_turn(&doubting);
        check_seam(&doubting);
    }
    check_pole(&doubting, 0);
    check_pole(&doubting, luminaire->gammas - 1);
    check_flux(&doubting);
}
