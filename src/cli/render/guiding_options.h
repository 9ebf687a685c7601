/* SPDX-License-Identifier: Apache-2.0 */
/* guiding_options.h -- `--no-guiding` and `--field`: where paths learn that light comes from.
 *
 * Fails    ERROR_USAGE with the option.
 */
#pragma once
#include "cli/options/cli.h"
#include "render/render.h"

/* Rows of an option table: RenderOptions *. */
#define GUIDING_OPTIONS(render)                                                                \
    {"--no-guiding", OPTION_FLAG, NULL,                                                        \
     "do not learn first where light comes from: the plain estimator, of more noise",          \
     &(render)->no_guiding},                                                                   \
    {"--field", OPTION_TEXT, "FILE",                                                           \
     "what is learnt: taken from this file if it is there, else kept there",                   \
     &(render)->field}

bool guiding_options_check(const RenderOptions *render, Error *err);
