/* SPDX-License-Identifier: Apache-2.0 */
/* response_suns.h -- what the first vertex of a probe's paths sends of suns: exact for each,
 * and by the parts of what an eye looks at: a shadow's edge and the sun's image lie on some of
 * them alone.
 *
 * Units    shares: response.h's.
 * Memory   from the arena.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/light/light_parts.h"
#include "review/light/response.h"

/* Paths that find what an aim's mirror sends of a sun of that radius (radians) within 1 %,
 * wherever in its patches the sun's image lies; of patches that fill more than 0.3 sr, and of a
 * convex display, less closely. A target without a patch is in the image or not. */
#define RESPONSE_MIRROR_ERROR 0.01
int response_mirror_paths(const ProbeAim *aim, float radius);

/* Shares of the first vertex for suns, exact but for the mean over options' paths: [sun][band],
 * from the arena. */
const float *response_suns(const ProbeAim *aim, const ResponseOptions *options,
                           const ProbeSuns *suns, Arena *arena);

/* response_suns of the part that a sun, as even white, gives most, each sun's own; it has the
 * spectrum of all parts together. parts: aimed as `aim` is; NULL: of all of that. */
const float *sun_parts_worst(const ProbeAim *aim, const LightParts *parts,
                             const ResponseOptions *options, const ProbeSuns *suns, Arena *arena);

/* What each target sends of one sun of these bands, lx, by scattering and by the display's
 * mirror, cd m^-2: added to of[target]. Returns that of the mirror, mean over targets. */
double sun_parts_light(const LightParts *parts, const ResponseOptions *options,
                       const ProbeSuns *sun, const float bands[RESPONSE_BANDS], double *of,
                       Arena scratch);
