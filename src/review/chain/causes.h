/* SPDX-License-Identifier: Apache-2.0 */
/* causes.h -- by which chains of objects light comes to a symbol, and what hides it.
 *
 * The chains are those of review/chain. Light that the display itself emits straight to the eye
 * is none of it.
 *
 * Units    cd m^-2.
 * Memory   texts and lists live in the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/chain/chains.h"
#include "review/profile.h"
#include "review/symbol/symbol_sight.h"
#include "review/verdict.h"

#define CAUSES_MOST 10
#define CAUSE_PATHS 8192
#define CAUSE_RAYS 4

typedef struct CauseArgs {
    const ProbeTools *tools;
    const ProbeAim *aim;
    long paths;
    int rays;              /* of each cause, at most CHAIN_RAYS */
    const ChainSeat *seat; /* that should not be empty; NULL: it is not */
} CauseArgs;

/* Sets the case's causes: the greatest CAUSES_MOST, and "all other ways", which add up to the
 * reflected light by these paths, and the groups; its own light that is reflected; and whether
 * much of the light comes off the back of the empty seat. */
void case_causes(const CauseArgs *args, ReviewCase *c, Arena *arena);

/* The same of all chains that were found already. */
void case_causes_of(const Chains *chains, int rays, ReviewCase *c, Arena *arena);

/* The share of that light that comes via materials without data, alone: as the causes have it,
 * by the aim, tools and paths of the question. */
double case_data_share(const CauseArgs *args, Arena scratch);

/* Sets the case's hiders, by the names of nodes and materials; what has the same name counts as
 * one. */
void case_hiders(const SymbolSurface *surface, const PathContext *context, Vec3 eye, ReviewCase *c,
                 Arena *arena);

/* The light that an aim's paths bring to the eye: tristimulus values and
 * spectrum.
 *
 * A path carries 16 wavelengths, drawn by a density that follows the observer. Of each lane the
 * radiance over that density is a sample of the integral over the band in which it lies, so
 * that a band's mean is without bias; bands that eyes hardly see get few lanes, and larger
 * errors. Displays count by their panels' spectra, here too where frames take their measured
 * tristimulus values as they are.
 *
 * Standard errors come from batches of paths, as those of chains do (chains.h), and all
 * estimates' (estimate/estimate.h). How many paths there are is given, and hangs on none.
 *
 * Units    cd m^-2; W m^-2 sr^-1 nm^-1; nm.
 * Memory   scratch only.
 * Threads  starts its own; the same numbers for any count. */

#define PIXEL_BAND_NM 10
#define PIXEL_FIRST_NM 360 /* where the first band begins */
#define PIXEL_BANDS 47     /* to 830 nm */

typedef struct PixelFigure {
    double mean, sigma; /* and its standard error */
} PixelFigure;

typedef struct PixelLight {
    PixelFigure xyz[3];
    PixelFigure radiance[PIXEL_BANDS]; /* means over the bands */
} PixelLight;

#define PIXEL_FIGURES (3 + PIXEL_BANDS)

/* Zeros at first. */
typedef struct PixelLightSums {
    double batch[PIXEL_FIGURES][CHAIN_BATCHES]; /* XYZ, then the bands */
    int chunks;
} PixelLightSums;

/* Beside the chains of a pixel (ProbeAim.pixel, ChainArgs.beside): by the same paths. */
ProbeFold pixel_light_fold(PixelLightSums *to);
PixelLight pixel_light_of(const PixelLightSums *sums);
