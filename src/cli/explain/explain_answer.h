/* SPDX-License-Identifier: Apache-2.0 */
/* explain_answer.h -- the answer of `parhelion explain`, in words or as JSON. */
#pragma once
#include "cli/options/cli.h"
#include "review/run/explain.h"

bool explain_answer(const Cli *cli, const Explained *explained, Arena *arena, Error *err);
