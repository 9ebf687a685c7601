/* SPDX-License-Identifier: Apache-2.0 */
/* path_options.h -- `--polarised` and `--sunglasses`: how the eye takes polarised light.
 *
 * Memory   the eye comes from the arena.
 * Fails    ERROR_USAGE with the option.
 */
#pragma once
#include "cli/options/cli.h"
#include "path/polarised.h"

typedef struct PolarisedWords {
    bool is_polarised;
    const char *sunglasses; /* as typed; NULL: none */
} PolarisedWords;

#define POLARISED_OPTIONS(words) \
    {"--polarised", OPTION_FLAG, NULL, \
     "follow how light is polarised, by glass, displays and the sky; adds the layer stokes", \
     &(words)->is_polarised}, \
    { \
        "--sunglasses", OPTION_TEXT, "DEG[:EXTINCTION]", \
            "the eye wears a polariser, its axis so far from the vertical, clockwise as its wearer " \
            "sees it; ideal, or with this extinction ratio (implies --polarised)", \
            &(words)->sunglasses \
    }

/* *out: NULL where neither option is there; directions are set with the camera. *layers: has
 * LAYER_STOKES afterwards if it may and `wants_all` or it had. */
bool polarised_options_read(const PolarisedWords *words, bool wants_all, unsigned *layers,
                            Arena *arena, const PolarisedEye **out, Error *err);
