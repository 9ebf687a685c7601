/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_choices.h -- how often each part of metallic_roughness is sampled.
 *
 * Probabilities follow the lanes' mean albedo of each part, so that none is ever starved.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_view.h"

/* The view's layers must be known. */
MetallicChoices metallic_choose(const MetallicView *view);
