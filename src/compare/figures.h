/* figures.h -- computes what a comparison asks for; private to compare.c. */
#pragma once
#include "compare/compare.h"

/* Codes of both frames, developed with one exposure: for those who look at them. Pictures have
 * theirs. */
bool figures_develop(const CompareOptions *options, Arena *arena, Comparison *out, Error *err);

/* Fills light, mask, maps, values, contrasts and the statistic of `out`, whose sides have the
 * same pixels; adds notes. groups: GROUP_... bits. */
bool figures_measure(const CompareOptions *options, unsigned groups, Arena *arena,
                     Comparison *out, Error *err);
