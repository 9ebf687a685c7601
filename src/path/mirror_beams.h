/* mirror_beams.h -- which mirrors send the sun to which part of the scene, and how much.
 *
 * Before the first path some rays of the sun are followed to every mirror, and by it to what
 * they light. A part asks those mirrors alone whose rays came to it: any other light by way of
 * a mirror is rare, and left to chance. Where they give little of a part's light they are asked
 * less often, and count more when they are, as the sets of lights are (light_selection.h).
 *
 * Memory   from the arena. Threads: const after mirror_beams_build.
 */
#pragma once
#include "mirror/mirrors.h"
#include "path/light_selection.h"
#include "path/surface.h"

typedef struct MirrorBeams {
    const Mirrors *mirrors; /* NULL: none sends the sun anywhere */
    const float   *prob;    /* of asking them, rows as LightSelection's */
} MirrorBeams;

/* What a scene's rays and lights are asked with. */
typedef struct BeamTools {
    const Scene         *scene;
    const Bvh           *bvh;
    const Lights        *lights;
    const SurfaceTables *tables;
} BeamTools;

/* The same for any number of threads and on every machine whose rays hit the same. */
MirrorBeams mirror_beams_build(const BeamTools *tools, const LightSelection *selection,
                               Arena *arena);

/* Seen from the side, as of light_selection_of_side. */
static inline float mirror_beams_prob(const MirrorBeams *beams, int part_id, bool is_back)
{
    return part_id == NO_ID ? 1 : beams->prob[2 * part_id + is_back];
}
