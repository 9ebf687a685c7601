/* emitters.h -- emissive triangles and displays as lights, chosen by what they send where.
 *
 * Every emissive triangle is cut into cells, as many as its texture or content deserves. Cells
 * are gathered into a few tiles, pieces of one display or lamp. From a point that is lit a tile
 * is chosen by the luminous intensity that it sends there over the squared distance (a
 * display's directions as its panel emits them), a cell inside it by area and content, and the
 * position is uniform on the cell.
 *
 * Units    pdf_area in m^-2. Threads: const after emitters_build (emitters_build.h).
 */
#pragma once
#include "base/alias.h"
#include "light/emission.h"
#include "spectrum/spectrum.h"

#define EMITTER_PROFILE_SIDE 33

/* Luminous intensity over directions, relative to (mean luminance) x area: cos theta for
 * Lambert's. Nodes over the octahedral map of the hemisphere, turned by 45 degrees. */
typedef struct EmitterProfile {
    float value[EMITTER_PROFILE_SIDE * EMITTER_PROFILE_SIDE];
} EmitterProfile;

/* What is known of a cell that a tile chose. */
typedef struct EmitterChoice {
    uint32_t cell, emitter;
    float    pdf_area; /* of a point on the cell once the tile is chosen */
} EmitterChoice;

/* Tiles lie in the lanes of a Spectrum: all of them are weighed at once. */
#define EMITTER_TILES_MAX SPECTRUM_LANES
typedef struct EmitterTiles {
    int          count;
    Spectrum     centre[3]; /* of their cells, by power; m, world */
    Spectrum     spread2;   /* mean square distance of the cells from it, m^2 */
    Spectrum     power;     /* luminance x area, cd; 0 in lanes that are not used */
    Spectrum     share;     /* of the power of all tiles */
    Spectrum     axis[3][3]; /* of the directions' frames, world: x, y, z */
    Spectrum     focus;     /* length of the mean normal: below 1 where cells differ */
    SpectrumMask both_sides;
    const EmitterProfile *profile[EMITTER_TILES_MAX];
    AliasTable            choice[EMITTER_TILES_MAX]; /* among a tile's cells */
    const EmitterChoice  *cells[EMITTER_TILES_MAX];
} EmitterTiles;

/* A triangle cut along its barycentric axes into side^2 cells of the same area. */
typedef struct Emitter {
    uint32_t triangle, first_cell;
    int      side;
} Emitter;

/* A cell's place in its triangle. Cells stand in columns along u: column i holds
 * 2 (side - i) - 1 of them, upright ones and those turned over in turns. */
typedef struct EmitterCell {
    int  side, i, j;
    bool is_turned;
} EmitterCell;

static inline EmitterCell emitter_cell(const Emitter *emitter, uint32_t cell)
{
    int side = emitter->side, index = (int)(cell - emitter->first_cell);
    int i = side - (int)sqrtf((float)(side * side - index));
    while (i > 0 && 2 * side * i - i * i > index) i--;
    while (2 * side * (i + 1) - (i + 1) * (i + 1) <= index) i++;
    int in_column = index - (2 * side * i - i * i);
    return (EmitterCell){side, i, in_column / 2, in_column % 2};
}

typedef struct Emitters {
    int          count;      /* of emissive triangles; 0: nothing emits */
    Emitter     *emitters;
    int         *first_of_part; /* emitter of a part's first triangle; NO_ID: part is dark */
    uint32_t     cell_count;
    uint32_t    *cell_emitter;
    uint8_t     *cell_tile;
    float       *cell_pdf_area; /* as in EmitterChoice */
    EmitterTiles *tiles;
} Emitters;

/* A point of an emitter. */
typedef struct EmitterPoint {
    uint32_t triangle;
    float    u, v; /* barycentric weights of vertices 1 and 2 */
} EmitterPoint;

/* A point as seen from `from`; u in [0,1)^3. */
EmitterPoint emitters_sample(const Emitters *emitters, Vec3 from, const float u[3],
                             float *pdf_area);

/* pdf_area with which emitters_sample chooses this point from there; 0 when the triangle is no
 * emitter. */
float emitters_pdf_area(const Emitters *emitters, const Scene *scene, Vec3 from,
                        EmitterPoint point);
