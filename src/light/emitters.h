/* SPDX-License-Identifier: Apache-2.0 */
/* emitters.h -- emissive triangles and displays as lights, chosen by what they send where.
 *
 * Every emissive triangle is cut into cells, as many as its texture or content deserves. Cells
 * are gathered into a tree whose nodes have up to 16 branches. From a point that is lit a
 * branch is chosen by the luminous intensity that it sends there (a display's directions as its
 * panel emits them) over the squared distance, times the cosine at the point; then one of that
 * branch's, until what is left looks small from there: then a cell by area and content. The
 * position is uniform on the cell, or, where the cell itself looks large, in its solid angle.
 *
 * Importance after Conty Estevez and Kulla 2018, with means instead of bounds, a share for what
 * they underrate, and bounds only for what cannot be seen at all.
 *
 * Threads: const after emitters_build (emitters_build.h).
 */
#pragma once
#include "light/alias.h"
#include "light/emission.h"
#include "light/lit_point.h"
#include "spectrum/spectrum.h"

#define EMITTER_PROFILE_SIDE 33

/* Luminous intensity over directions, relative to (mean luminance) x area: cos theta for
 * Lambert's. Nodes over the octahedral map of the hemisphere, turned by 45 degrees. */
typedef struct EmitterProfile {
    float value[EMITTER_PROFILE_SIDE * EMITTER_PROFILE_SIDE];
} EmitterProfile;

/* A cell's area over its squared distance, from where on it looks large: about how much of the
 * sphere it fills, sr. */
#define EMITTER_LARGE 0.1f

/* A cell as the choice among a branch's cells gives it. */
typedef struct EmitterChoice {
    uint32_t cell, emitter;
} EmitterChoice;

/* Branches lie in the lanes of a Spectrum: all of them are weighed at once. */
#define EMITTER_BRANCHES SPECTRUM_LANES
typedef struct EmitterNode EmitterNode;
struct EmitterNode {
    int count;
    Spectrum centre[3];  /* of their cells, by power; m, scene */
    Spectrum spread2;    /* mean square distance of their points from it, m^2 */
    Spectrum radius;     /* m: no cell reaches farther from it */
    Spectrum power;      /* luminance x area, cd; 0 in lanes that are not used */
    Spectrum share;      /* of the power of all branches */
    Spectrum axis[3][3]; /* of the directions' frames, world: x, y, z */
    Spectrum focus;      /* length of the mean normal: below 1 where cells differ */
    Spectrum normal[3];  /* of flat branches: all cells have it, and */
    Spectrum behind;     /* none is lit from farther behind the centre, m */
    Spectrum large2;     /* m^2: nearer, a branch that is one cell looks large; else 0 */
    SpectrumMask both_sides;
    bool has_displays;
    const EmitterProfile *profile[EMITTER_BRANCHES]; /* NULL: Lambert */
    AliasTable choice[EMITTER_BRANCHES];             /* among a branch's cells, by rank */
    uint32_t first[EMITTER_BRANCHES];                /* rank of its first cell; these grow */
    float far2[EMITTER_BRANCHES];                    /* m^2: beyond, cells are chosen at once */
    EmitterNode *child[EMITTER_BRANCHES];            /* NULL: none */
};

/* A triangle cut along its barycentric axes into side^2 cells of the same area. */
typedef struct Emitter {
    uint32_t triangle, first_cell;
    int side;
    float cell_area; /* m^2 */
} Emitter;

/* A cell's place in its triangle. Cells stand in columns along u: column i holds
 * 2 (side - i) - 1 of them, upright ones and those turned over in turns. */
typedef struct EmitterCell {
    int side, i, j;
    bool is_turned;
} EmitterCell;

static inline EmitterCell emitter_cell(const Emitter *emitter, uint32_t cell) {
    int side = emitter->side, index = (int)(cell - emitter->first_cell);
    int i = side - (int)sqrtf((float)(side * side - index));
    while (i > 0 && 2 * side * i - i * i > index) i--;
    while (2 * side * (i + 1) - (i + 1) * (i + 1) <= index) i++;
    int in_column = index - (2 * side * i - i * i);
    return (EmitterCell){side, i, in_column / 2, in_column % 2};
}

typedef struct Emitters {
    int count; /* of emissive triangles; 0: nothing emits */
    Emitter *emitters;
    int *first_of_part; /* emitter of a part's first triangle; NO_ID: part is dark */
    uint32_t cell_count;
    uint32_t *cell_emitter;
    uint32_t *cell_rank;
    EmitterChoice *by_rank; /* cells in the tree's order */
    EmitterNode *root;
} Emitters;

/* A point of an emitter. */
typedef struct EmitterPoint {
    uint32_t triangle;
    float u, v; /* barycentric weights of vertices 1 and 2 */
} EmitterPoint;

/* The density with which a point was chosen: one of the two; the other is 0. */
typedef struct EmitterDensity {
    float on_area;   /* m^-2 */
    float on_sphere; /* sr^-1, of directions from the lit point */
} EmitterDensity;

/* A point as seen from `from`; u in [0,1)^3. */
EmitterPoint emitters_sample(const Emitters *emitters, const Scene *scene, const LitPoint *from,
                             const float u[3], EmitterDensity *density);

/* The density with which emitters_sample chooses this point from there; 0 when the triangle is
 * no emitter. */
EmitterDensity emitters_density(const Emitters *emitters, const Scene *scene, const LitPoint *from,
                                EmitterPoint point);
