/* SPDX-License-Identifier: Apache-2.0 */
/* sun_parts.h -- the sun straight on the parts of what an eye looks at: a shadow's edge and the
 * sun's image lie on some of them alone.
 *
 * Units    shares: response.h's.
 * Memory   from the arena.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/light/light_parts.h"
#include "review/light/response_suns.h"

/* response_suns of the part that a sun, as even white, gives most, each sun's own; it has the
 * spectrum of all parts together. parts: aimed as `aim` is; NULL: of all of that. */
const float *sun_parts_worst(const ProbeAim *aim, const LightParts *parts,
                             const ResponseOptions *options, const ProbeSuns *suns,
                             Arena *arena);

/* What each target sends of one sun of these bands, lx, by scattering and by the display's
 * mirror, cd m^-2: added to of[target]. *mirror: of it, by the mirror, mean over targets. */
void sun_parts_light(const LightParts *parts, const ResponseOptions *options,
                     const ProbeSuns *sun, const float bands[RESPONSE_BANDS], double *of,
                     double *mirror, Arena scratch);
