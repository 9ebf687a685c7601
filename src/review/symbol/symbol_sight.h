/* symbol_sight.h -- a symbol as an eye sees it: how large, how much of it, how bright.
 *
 * Frames   metres, world.  Units  arc minutes, cd m^-2.
 * Threads  pure functions; each needs scratch of its own thread.
 */
#pragma once
#include "path/path_context.h"
#include "review/symbol/symbol.h"
#include "review/symbol/symbol_surface.h"

/* The angle between the top and the bottom of a box of uv (a split's `box`, or a character's
 * height) as seen from `eye`: mean over SYMBOL_COLUMNS columns, true angles, so that slant and
 * curvature are in it. NaN where the surface does not reach. */
#define SYMBOL_COLUMNS 9
double symbol_height_arcmin(const SymbolSurface *surface, const double box[4], Vec3 eye);

typedef struct SymbolVisibility {
    double visible_share; /* of the rectangle's area, 0..1: what is seen from the front and not
                             hidden. Windows and holes hide nothing, unless less than a
                             hundredth of the light passes them */
    double transmittance; /* mean over what is visible of the light that passes those, 0..1, of
                             equal-energy light with the eye's V(lambda); NaN: nothing is
                             visible */
} SymbolVisibility;

/* is_visible: [surface->point_count], filled; NULL: not wanted. */
SymbolVisibility symbol_visibility(const SymbolSurface *surface, const PathContext *context,
                                   Vec3 eye, bool *is_visible);

/* XYZ that the display sends to the eye, mean of light (not of codes) over the pixels of a
 * class; pixels that turn their back to the eye are left out, what hides or dims them on the way
 * is not asked (transmittance, above). */
typedef struct SymbolEmission {
    double foreground_xyz[3], background_xyz[3];
} SymbolEmission;

/* level: of the display, 1 as measured. Of more than SYMBOL_PIXELS_MOST pixels of a class that
 * many, evenly chosen, stand for all. NaN: no pixel of a class faces the eye. */
#define SYMBOL_PIXELS_MOST 20000
SymbolEmission symbol_emission(const SymbolSurface *surface, const SymbolSplit *split,
                               double level, Vec3 eye, Arena scratch);
