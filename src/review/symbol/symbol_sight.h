/* SPDX-License-Identifier: Apache-2.0 */
/* symbol_sight.h -- a symbol as an eye sees it: how large, how much of it, how bright.
 *
 * Frames   metres, scene.  Units  arc minutes, cd m^-2.
 * Threads  pure functions; symbol_emission starts its own.
 */
#pragma once
#include "path/path_context.h"
#include "review/symbol/symbol.h"
#include "review/symbol/symbol_surface.h"

/* The angle between the top and the bottom of a box of uv (a split's `box`, or one of a
 * character's height) as seen from `eye`: mean over 9 columns of true angles, so that slant and
 * curvature are in it. NaN where the surface does not reach. */
double symbol_height_arcmin(const SymbolSurface *surface, const double box[4], Vec3 eye);

typedef struct SymbolVisibility {
    double visible_share; /* of the surface's area, 0..1: what shows its front and is not
                             hidden. Windows and holes hide nothing, unless less than a
                             hundredth of the light passes them */
    double transmittance; /* of what lies between, mean over what is visible, 0..1, for light of
                             equal energy by V(lambda); NaN where nothing is visible */
    bool is_tinted;       /* it takes more of one wavelength than of another */
    Curve way;            /* then the same at each wavelength */
} SymbolVisibility;

/* is_visible: [surface->point_count], filled; NULL: not requested. */
SymbolVisibility symbol_visibility(const SymbolSurface *surface, const PathContext *context,
                                   Vec3 eye, bool *is_visible);

/* The share of light of equal energy that comes from the point to the eye, by V(lambda); 0: it
 * is hidden, or seen from behind. by_lane: the same of each wavelength; or NULL. */
float symbol_point_passed(const SymbolPoint *point, const PathContext *context,
                          const Wavelengths *wavelengths, Vec3 eye, Spectrum *by_lane);

/* The hidden shares of the surface's area, by the first thing on the look from the eye that
 * lets too little through: with the visible share they add up to 1. */
typedef struct SymbolHiding {
    double *by_part;    /* [scene->part_count], from the arena */
    double turned_away; /* shows its back, covered or not */
} SymbolHiding;

SymbolHiding symbol_hiding(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                           Arena *arena);

/* A visible point's patch, when the eye sees its corners, too; else the point by itself: paths
 * to a patch that something covers in part would measure what covers it. */
SymbolPatch symbol_patch_seen(const SymbolSurface *surface, int point, const PathContext *context,
                              Vec3 eye);

/* The same of any rectangle of it; false: its middle is hidden, or not shown. */
bool symbol_box_seen(const SymbolSurface *surface, const double uv[4], const PathContext *context,
                     Vec3 eye, SymbolPatch *out);

/* The share, 0..1, of the surface with is_visible[point] to which light comes straight from
 * `towards` (unit, world), or through windows that pass a hundredth of it and more: towards the
 * middle of the sun, what at least about half of it lights. NaN: nothing is visible. */
double symbol_lit_share(const SymbolSurface *surface, const bool *is_visible,
                        const PathContext *context, Vec3 towards);

/* XYZ of a display's light, cd m^-2: means of light (not of codes) over the pixels of a class;
 * edges are in neither. Pixels that turn their back to the eye are left out; NaN: all of them
 * do. */
typedef struct SymbolEmission {
    double xyz[2][3]; /* [SymbolClass] */
} SymbolEmission;

typedef struct SymbolLook {
    const SymbolSurface *surface;
    const SymbolSplit *split;
    Vec3 eye;
    int threads;
    const SymbolVisibility *through; /* what stands between the two; NULL: nothing */
} SymbolLook;

/* As it comes to the eye. What is tinted takes from it by the spectra of the panel's primaries.
 * level: of the display; 1: as measured. Of more than 20,000 pixels of a class so many, evenly
 * chosen, stand for all. The same for any number of threads. */
SymbolEmission symbol_emission(const SymbolLook *look, double level);

/* The same behind glass of that colour, which is worn. */
void symbol_emission_behind(const SymbolLook *look, const Curve *colour, SymbolEmission *emission);

/* What a polariser before the eye lets through of the display's light, beside unpolarised light
 * by the same ways: mean over the points that are visible. */
double symbol_polarised_share(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                              const PolarisedEye *polariser);
