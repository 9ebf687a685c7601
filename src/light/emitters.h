/* emitters.h -- emissive triangles and displays as lights, chosen by what they send where.
 *
 * Every emissive triangle is cut into cells, as many as its texture or content deserves. Cells
 * are gathered into a few tiles, pieces of one display or lamp. From a point that is lit a tile
 * is chosen by the luminous intensity that it sends there over the squared distance (a
 * display's directions as its panel emits them), a cell inside it by area and content, and the
 * position is uniform on the cell.
 *
 * Units    pdf_area in m^-2. Threads: const after emitters_build.
 */
#pragma once
#include "base/alias.h"
#include "light/emission.h"

#define EMITTER_TILES_MAX 32
#define EMITTER_PROFILE_SIDE 33

/* Luminous intensity over directions, relative to (mean luminance) x area: cos theta for
 * Lambert's. Nodes over the octahedral map of the hemisphere, turned by 45 degrees. */
typedef struct EmitterProfile {
    float value[EMITTER_PROFILE_SIDE * EMITTER_PROFILE_SIDE];
} EmitterProfile;

typedef struct EmitterTile {
    Vec3  centre;  /* of its cells, by power; m, world */
    float spread2; /* mean square distance of the cells from it, m^2 */
    float power;   /* luminance x area, cd */
    float share;   /* of the power of all tiles */
    Vec3  normal;  /* mean, by power: shorter than 1 where cells face different ways */
    float looseness; /* 1 - its length */
    bool  both_sides;
    Frame frame;   /* of the display's directions */
    const EmitterProfile *profile; /* NULL: Lambert's */
    AliasTable      choice; /* among its cells */
    const uint32_t *cells;
} EmitterTile;

/* A triangle cut along its barycentric axes into side^2 cells of the same area. */
typedef struct Emitter {
    uint32_t triangle, first_cell;
    int      side;
} Emitter;

typedef struct Emitters {
    int          count;      /* of emissive triangles; 0: nothing emits */
    Emitter     *emitters;
    int         *first_of_part; /* emitter of a part's first triangle; NO_ID: part is dark */
    uint32_t     cell_count;
    uint32_t    *cell_emitter;
    uint8_t     *cell_tile;
    float       *cell_pdf_area; /* of a point on the cell once its tile is chosen */
    EmitterTile *tiles;
    int          tile_count;
} Emitters;

Emitters emitters_build(const Scene *scene, Arena *arena);

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
