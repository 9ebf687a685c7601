/* SPDX-License-Identifier: Apache-2.0 */
/* emission_beam.h -- narrow beams of an emission, each with profiles of its own
 * (panel_beam.h). */
#pragma once
#include "panel/fit/emission/emission_model.h"

/* A narrow beam on or near a row, into the model, if there is one. reach: degrees from its
 * centre to where it ends. Scores change: they need no longer be near a variance of 1. */
bool emission_beam_find(EmissionModel *model, int row, double reach, Arena *arena);

void emission_beam_note(const EmissionModel *model, FitNotes *notes);
