/* figures.h -- computes what a comparison asks for; private to compare.c. */
#pragma once
#include "compare/compare.h"

/* Fills light, mask, developed codes, maps, values, contrasts and the statistic of `out`, whose
 * sides have the same pixels; adds notes. groups: GROUP_... bits. */
bool figures_measure(const CompareOptions *options, unsigned groups, Arena *arena,
                     Comparison *out, Error *err);
