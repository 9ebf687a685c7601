/* SPDX-License-Identifier: Apache-2.0 */
/* mirror_beams.h -- which mirrors send the sun, or lamps, to which part of the scene, and how
 * much.
 *
 * Before the first path some rays of the sun, of lamps without a surface and of compact emitters
 * are followed to every mirror, and by it to what they light. A part samples those mirrors whose
 * rays came to it. Other mirrors are left to chance; readings sample lamps, which chance never
 * finds, there, too, but rarely. A frame does without: that would take a third of its time. Where
 * these rays bring a place little light beside the lights themselves, mirrors are sampled less
 * often there, and count more when they are.
 *
 * Memory   from the arena. Threads: const after mirror_beams_build.
 */
#pragma once
#include "mirror/mirrors.h"
#include "light/compact_emitters.h"
#include "mirror/glint_map.h"
#include "path/light_selection.h"
#include "surface/surface.h"

/* Sets of lights that are sampled in mirrors. */
typedef enum BeamSet { BEAMS_OF_SUN, BEAMS_OF_LAMPS, BEAMS_OF_EMITTERS, BEAM_SETS } BeamSet;

/* How often one side of a part samples its mirrors. */
typedef struct BeamSide {
    uint32_t row; /* in the glint map */
    float edge_m;
    float least;   /* probability of sampling where no ray came; 0: it has no mirrors */
    float by_root; /* more of it by the root of what the rays bring, lx */
    float most;    /* of the probability, wherever on the side */
} BeamSide;

/* A lamp, or a compact emitter, whose rays came to a row by mirrors. */
typedef struct BeamSource {
    int id;     /* of the scene's light, or which compact emitter */
    float prob; /* of its choice among the row's */
} BeamSource;

typedef struct MirrorBeams {
    BeamSet set;
    const Mirrors *mirrors; /* NULL: none sends light of the set anywhere. Of all but the sun's all
                               there are stand at NO_ID */
    const BeamSide *sides;  /* rows as LightSelection's */
    const float *most_lx;   /* that they bring anywhere on each */
    GlintMap map;           /* where the rays came */
    float of_all;           /* probability with which a point of no part searches all at NO_ID, */
    uint32_t all_count;     /* so many; of the sun's all that its beams came by */
    const BeamSource *sources; /* but of the sun: a row's are [first[row], first[row + 1]), by id */
    const uint32_t *first;
    CompactEmitters emitters; /* of BEAMS_OF_EMITTERS */
} MirrorBeams;

typedef struct BeamTools {
    const Scene *scene;
    const Bvh *bvh;
    const Lights *lights;
    const SurfaceTables *tables;
    bool is_of_frame; /* nothing stands at NO_ID but what beams of the sun showed */
} BeamTools;

/* The same for any number of threads and on every machine whose rays hit the same. No side
 * samples its mirrors until they are weighed. */
MirrorBeams mirror_beams_build(const BeamTools *tools, BeamSet set, Arena *arena);

/* The same beams beside all other light as it is now. What they hold stays in its arena. */
MirrorBeams mirror_beams_weighed(const MirrorBeams *beams, const BeamTools *tools,
                                 const LightSelection *selection, Arena *arena);

/* HOT. Has the side of a part mirrors at all? */
static inline bool mirror_beams_has(const MirrorBeams *beams, int part_id, bool is_back) {
    return part_id == NO_ID || beams->sides[2 * part_id + is_back].least > 0;
}

/* HOT. What mirror_beams_prob is at most on a side of a part: it takes no look at the map. */
float mirror_beams_most(const MirrorBeams *beams, int part_id, bool is_back);

/* HOT. Probability of sampling a part's mirrors, in [0, 1]; is_back: as of
 * light_selection_of_side; 0: it has none. */
float mirror_beams_prob(const MirrorBeams *beams, int part_id, bool is_back, Vec3 position);

/* HOT. The id of a source that a side of a part, or NO_ID, samples in mirrors; pick in [0, 1).
 * *prob: of the choice, above 0. */
int mirror_beams_source(const MirrorBeams *beams, const Lights *lights, int part_id, bool is_back,
                        float pick, float *prob);

/* HOT. Probability of that choice of BEAMS_OF_EMITTERS. */
float mirror_beams_source_prob(const MirrorBeams *beams, int part_id, bool is_back, int id);
