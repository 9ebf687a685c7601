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
    SymbolSplit   split;
    SymbolSurface surface;    /* of the box about its foreground: a margin is not read */
    double        uv[4];      /* its rectangle */
} SetupSymbol;

/* What its panel says, with texts of the arena: a case outlives its setup. */
CasePanel symbol_panel(const SetupSymbol *symbol, Arena *arena);

/* The middle of that box; where no triangle shows that, the surface's first point. */
SymbolPoint symbol_middle(const SetupSymbol *symbol);

/* Aims a probe, whose context and eye are set, at what is visible (symbol_visibility): targets
 * and patches, from the arena. */
void symbol_aim(const SymbolSurface *surface, const bool *is_visible, Arena *arena,
                ProbeAim *aim);

/* The parts of a symbol by which it is judged (light/light_parts.h), for an aim whose context,
 * eye and seed are set: as wide as one of its strokes and one character high, within the box
 * about its foreground. A stroke is the least that carries a symbol's form: an 8 without one
 * reads as a 3. `most` cells: where that many are not enough parts slide in coarser steps, and
 * of a very long symbol they are larger. No target: nothing of it is seen. */
LightParts symbol_parts(const SetupSymbol *symbol, const ProbeAim *aim, int most, Arena *arena);

/* Left, top, right and bottom of one of them, uv. */
void symbol_part_box(const SetupSymbol *symbol, const LightParts *parts, int part,
                     double uv[4]);

/* Fails with the request's file and the symbol's place in it. */
bool setup_symbols(const Setup *setup, Arena *arena, SetupSymbol **out, int *count, Error *err);
