/* SPDX-License-Identifier: Apache-2.0 */
/* mirror_beams.h -- which mirrors send the sun to which part of the scene, and how much.
 *
 * Before the first path some rays of the sun are followed to every mirror, and by it to what
 * they light. A part samples those mirrors alone whose rays came to it: any other light via
 * a mirror is rare, and left to chance. Where these rays bring a place little light beside the
 * lights themselves, mirrors are sampled less often there, and count more when they are.
 *
 * Memory   from the arena. Threads: const after mirror_beams_build.
 */
#pragma once
#include "mirror/mirrors.h"
#include "path/glint_map.h"
#include "path/light_selection.h"
#include "path/surface.h"

/* How often one side of a part samples its mirrors. */
typedef struct BeamSide {
    uint32_t row; /* in the glint map */
    float edge_m;
    float least;   /* probability of sampling where no ray came; 0: it has no mirrors */
    float by_root; /* more of it by the root of what the rays bring, lx */
} BeamSide;

typedef struct MirrorBeams {
    const Mirrors *mirrors; /* NULL: none sends the sun anywhere */
    const BeamSide *sides;  /* rows as LightSelection's */
    GlintMap map;           /* where the rays came */
} MirrorBeams;

typedef struct BeamTools {
    const Scene *scene;
    const Bvh *bvh;
    const Lights *lights;
    const SurfaceTables *tables;
} BeamTools;

/* The same for any number of threads and on every machine whose rays hit the same. */
MirrorBeams mirror_beams_build(const BeamTools *tools, const LightSelection *selection,
                               Arena *arena);

/* HOT. Probability of sampling a part's mirrors, in [0, 1]; is_back: as of
 * light_selection_of_side; 0: it has none. */
float mirror_beams_prob(const MirrorBeams *beams, int part_id, bool is_back, Vec3 position);
