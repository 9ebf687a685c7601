/* SPDX-License-Identifier: Apache-2.0 */
/* worst_part.h -- the part of a symbol that an eye sees worst: the window, as wide as a stroke
 * and one character high (symbols.h), from which most light is reflected.
 *
 * It is found by the direct sun, which is known for every place, and by paths to all of the
 * symbol, whose mean is the symbol's. That is a selection: who judges the part reads it by
 * paths of other seeds, as of the aim that is set here. Where light is even within what the
 * paths show, chance may select a part that reflects less than the mean: worst_part_is_better
 * says so of a reading, and all of the symbol is judged then.
 *
 * Units    cd m^-2; uv of the content.
 * Memory   from the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/run/symbols.h"
#include "review/verdict.h"

typedef struct PartAsk {
    const SetupSymbol *symbol;
    const ProbeAim    *aim;  /* without targets; all of the symbol is read by a seed of its
                                own */
    bool     is_coarse;      /* by the direct sun alone: no mean */
} PartAsk;

typedef struct WorstPart {
    ProbeAim  aim;    /* at what is seen of it; no targets: nothing of the symbol is */
    CaseWhole whole;  /* without its contrast */
} WorstPart;

WorstPart worst_part_find(const Setup *setup, const PartAsk *ask, Arena *arena);

/* Does a part of that reading reflect less than the mean, beyond both intervals? */
bool worst_part_is_better(const CaseWhole *whole, MeanInterval reading);

/* From now on all of the symbol that is seen is the part. */
void worst_part_take_all(const SetupSymbol *symbol, WorstPart *part, Arena *arena);
