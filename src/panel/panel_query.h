/* panel_query.h -- the pieces of an emission query that the fit shares. Private to src/panel.
 *
 * Threads  pure functions of a constant Panel. HOT: no allocation, no libm.
 */
#pragma once
#include "panel/panel_file.h"

typedef enum LevelKind {
    LEVEL_DARK,    /* code 0: the primary adds nothing */
    LEVEL_EXACT,   /* a measured level */
    LEVEL_BETWEEN, /* monotone cubic of ln E over ln code */
    LEVEL_BELOW,   /* power law through the two lowest levels */
    LEVEL_ABOVE,   /* power law through the two highest */
    LEVEL_POWER    /* only one level is known: the panel's level_power */
} LevelKind;

/* Where a code lies among a primary's measured levels. */
typedef struct LevelPosition {
    LevelKind kind;
    int       first;   /* level at or below the code (0 when below all) */
    float     x;       /* ln code */
    float     node[4]; /* ln of levels first - 1 .. first + 2, ends repeated */
} LevelPosition;

LevelPosition panel_level_position(const Panel *panel, int primary, float code);

/* y: ln E at levels first - 1 .. first + 2 (EXACT and POWER read y[1] only). */
float panel_level_interpolate(const Panel *panel, const LevelPosition *at, const float y[4]);

/* c0, c1, c2 of a source of 1 cd m^-2 for ln XYZ (only the ratios count). */
void panel_bend_lookup(const PanelBend *bend, const float logs[3], float coefficient[3]);
