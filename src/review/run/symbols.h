/* SPDX-License-Identifier: Apache-2.0 */
/* symbols.h -- the symbols of a request on the displays of a scene, ready to be looked at.
 *
 * A symbol that is to be found becomes one for every line of text in it, "NAME 1" with the
 * tallest characters first.
 *
 * Memory   from the arena; the setup must outlive them.
 * Threads  const once made.
 */
#pragma once
#include "review/light/setup.h"
#include "review/symbol/symbol_sight.h"
#include "review/verdict.h"

#define SYMBOLS_FOUND_MOST 6 /* of one rectangle */
#define SYMBOL_POINTS 256

typedef struct SetupSymbol {
    const char   *name, *display_name;
    int           symbol_id;  /* of the request */
    CasePanel     panel;
    ReviewDisplay display;
    SymbolSurface surface;
    SymbolSplit   split;
} SetupSymbol;

/* What its panel says, with texts of the arena: a case outlives its setup. */
CasePanel symbol_panel(const SetupSymbol *symbol, Arena *arena);

/* The middle of its rectangle; where no triangle shows that, the surface's first point. */
SymbolPoint symbol_middle(const SetupSymbol *symbol);

/* Aims a probe, whose context and eye are set, at what is visible (symbol_visibility): targets
 * and patches, from the arena. */
void symbol_aim(const SymbolSurface *surface, const bool *is_visible, Arena *arena,
                ProbeAim *aim);

/* Fails with the request's file and the symbol's place in it. */
bool setup_symbols(const Setup *setup, Arena *arena, SetupSymbol **out, int *count, Error *err);
