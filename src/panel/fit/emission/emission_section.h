/* SPDX-License-Identifier: Apache-2.0 */
/* emission_section.h -- the emission's section of a panel file (layout: panel_file.h). */
#pragma once
#include "panel/fit/emission/emission_model.h"

/* Rounds means and loadings to what the section holds. */
void emission_section_round(EmissionModel *model);

/* The section's bytes. */
const void *emission_section_write(const EmissionModel *model, Arena *arena, size_t *size);
