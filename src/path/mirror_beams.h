/* SPDX-License-Identifier: Apache-2.0 */
/* mirror_beams.h -- which mirrors send the sun, or lamps, to which part of the scene, and how
 * much.
 *
 * Before the first path some rays of the sun, and of lamps without a surface, are followed to
 * every mirror, and by it to what they light. A part samples those mirrors whose rays came to
 * it. The sun by other mirrors is left to chance; lamps, which chance never finds, are sampled
 * there, too, but rarely. Where these rays bring a place little light beside the lights
 * themselves, mirrors are sampled less often there, and count more when they are.
 *
 * Memory   from the arena. Threads: const after mirror_beams_build.
 */
#pragma once
#include "mirror/mirrors.h"
#include "path/glint_map.h"
#include "path/light_selection.h"
#include "path/surface.h"

/* Sets of lights that are sampled in mirrors. */
typedef enum BeamSet { BEAMS_OF_SUN, BEAMS_OF_LAMPS, BEAM_SETS } BeamSet;

/* How often one side of a part samples its mirrors. */
typedef struct BeamSide {
    uint32_t row; /* in the glint map */
    float edge_m;
    float least;   /* probability of sampling where no ray came; 0: it has no mirrors */
    float by_root; /* more of it by the root of what the rays bring, lx */
} BeamSide;

/* A lamp whose rays came to a row by mirrors. */
typedef struct BeamLamp {
    int light_id;
    float prob; /* of its choice among the row's */
} BeamLamp;

typedef struct MirrorBeams {
    BeamSet set;
    const Mirrors *mirrors; /* NULL: none sends light of the set anywhere. Those of lamps have all
                               there are at NO_ID */
    const BeamSide *sides;  /* rows as LightSelection's */
    GlintMap map;           /* where the rays came */
    const BeamLamp *lamps;  /* of lamps: a row's are [first_lamp[row], first_lamp[row + 1]), by */
    const uint32_t *first_lamp; /* light_id */
} MirrorBeams;

typedef struct BeamTools {
    const Scene *scene;
    const Bvh *bvh;
    const Lights *lights;
    const SurfaceTables *tables;
} BeamTools;

/* The same for any number of threads and on every machine whose rays hit the same. */
MirrorBeams mirror_beams_build(const BeamTools *tools, BeamSet set, const LightSelection *selection,
                               Arena *arena);

/* HOT. Probability of sampling a part's mirrors, in [0, 1]; is_back: as of
 * light_selection_of_side; 0: it has none. */
float mirror_beams_prob(const MirrorBeams *beams, int part_id, bool is_back, Vec3 position);

/* HOT. The id of a lamp that a side of a part, or NO_ID, samples in mirrors; pick in [0, 1).
 * *prob: of the choice, above 0. */
int mirror_beams_lamp(const MirrorBeams *beams, const Lights *lights, int part_id, bool is_back,
                      float pick, float *prob);
