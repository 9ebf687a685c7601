/* SPDX-License-Identifier: Apache-2.0 */
/* explain_answer.h -- what `parhelion explain` prints: text, or one JSON document.
 *
 * Fails    where stdout cannot be written.
 */
#pragma once
#include "cli/options/cli.h"
#include "light/light_groups.h"
#include "review/run/explain.h"

/* What was found, and the names of what was asked. */
typedef struct ExplainAnswer {
    Explained found;
    LightGroups lights; /* of a scene: by which lights are named */
    int pixel[2], size[2];
} ExplainAnswer;

extern const Answer explain_answers[];

bool explain_answer(const Cli *cli, const ExplainAnswer *answer, Arena *arena, Error *err);
