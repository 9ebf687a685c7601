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
#include "review/light/glasses.h"
#include "review/light/setup.h"
#include "review/symbol/symbol_sight.h"
#include "review/verdict.h"

#define SYMBOLS_FOUND_MOST 6 /* of one rectangle */
#define SYMBOL_POINTS 256

typedef struct SetupSymbol {
    const char *name, *display_name;
    int symbol_id; /* of the request */
    CasePanel panel;
    ReviewDisplay display;
    SymbolSplit split;
    ReviewInput mask;      /* the file that was read; path NULL: none */
    SymbolSurface surface; /* of the box about its foreground: a margin is not read */
    double uv[4];          /* its rectangle */
} SetupSymbol;

/* What its panel says, with texts of the arena: a case outlives its setup. */
CasePanel symbol_panel(const SetupSymbol *symbol, Arena *arena);

/* Its strokes' width over a character's height; NaN: it is not made of strokes. */
double symbol_stroke_ratio(const SetupSymbol *symbol);

/* The middle of that box; where no triangle shows that, the surface's first point. */
SymbolPoint symbol_middle(const SetupSymbol *symbol);

/* Aims a probe, whose context and eye are set, at what is visible: targets and patches, from the
 * arena. Returns symbol_visibility. */
SymbolVisibility symbol_aim(const SymbolSurface *surface, Arena *arena, ProbeAim *aim);

/* The parts of a symbol by which it is judged (light/light_parts.h), for an aim whose context,
 * eye and seed are set: as wide as one of its strokes and one character high, within the box
 * about its foreground. A stroke is the least that carries a symbol's form: an 8 without one
 * reads as a 3. `most` cells: where that many are not enough parts slide in coarser steps, and
 * of a very long symbol they are larger. No target: nothing of it is seen. */
LightParts symbol_parts(const SetupSymbol *symbol, const ProbeAim *aim, int most, Arena *arena);

/* Fails with the request's file and the symbol's place in it. */
bool setup_symbols(const Setup *setup, Arena *arena, SetupSymbol **out, int *count, Error *err);

/* A case seen through sunglasses: how the aim counts light, and what the display shows, as they
 * weigh it, but for the one factor by which they darken all, which goes to
 * c->glasses_transmittance. */
void symbol_put_on_glasses(const Glasses *glasses, const SymbolLook *look, ProbeAim *aim,
                           SymbolEmission *shown, ReviewCase *c, Arena *arena);

/* The light of which a case's colour is made; judging makes the colour (review/ask_colour.h).
 * What is emitted, of a case whose luminances are as they arrive: it has one colour then. */
void symbol_colour_start(const SetupSymbol *symbol, const SymbolEmission *shown, ReviewCase *c,
                         Arena *arena);

/* What is reflected. */
void symbol_colour_read(const Reading *reading, ReviewCase *c);

/* The same, as the review's same case has it. */
void symbol_colour_alike(const ColourLight *like, ReviewCase *c);

/* The part of a symbol that an eye sees worst: the window, as wide as a stroke
 * and one character high (symbols.h), from which most light is reflected; of what must not be
 * read the one from which least is.
 *
 * It is found by the direct sun, which is known for every place, and by paths to all of the
 * symbol, the same whatever the review's seed. That is a selection: who judges the part, and who
 * reads the mean, does so by paths of other seeds, as of the aim that is set here. The interval
 * of such a reading is that of the part which is named; it knows nothing of a part that is
 * worse by less than what the paths that chose show. Where light is even within what the
 * paths show, chance may select a part that reflects less than the mean: worst_part_is_better
 * says so of a reading, and all of the symbol is judged then.
 *
 * Units    cd m^-2; uv of the content.
 * Memory   from the arena.
 * Threads  starts its own; the same figures for any count. */

typedef struct PartArgs {
    const SetupSymbol *symbol;
    const ProbeAim *aim; /* without targets; all of the symbol is read by a seed of its
                            own */
    bool is_coarse;      /* by the direct sun alone: no mean */
    bool is_private;     /* it must not be read: the part from which least is reflected */
} PartArgs;

typedef struct WorstPart {
    ProbeAim aim;    /* at what is seen of it; no targets: nothing of the symbol is */
    CaseWhole whole; /* without its contrast */
    bool is_all;     /* no part stands out: it is all of the symbol */
} WorstPart;

WorstPart worst_part_find(const Setup *setup, const PartArgs *args, Arena *arena);

/* That part of it, or all of it where the box is all. No target: nothing of it is seen. */
ProbeAim worst_part_aim(const SetupSymbol *symbol, const ProbeAim *aim, const CaseBox *part,
                        Arena *arena);

/* The mean is that reading of all of the symbol. */
void worst_part_set_mean(CaseWhole *whole, const Reading *reading);

/* Does a part of that reading reflect less than the mean, beyond both intervals? Or more, where
 * the least was sought? */
bool worst_part_is_better(const CaseWhole *whole, MeanInterval reading, bool is_private);

/* From now on all of the symbol that is seen is the part. */
void worst_part_take_all(const SetupSymbol *symbol, WorstPart *part, Arena *arena);

/* Trains the setup's guide, once it is lit, on where light comes from to what the first eye
 * sees of the symbols: lamps that few of them would find otherwise, at night above all. The
 * guide comes from the arena, or from the setup's folder of guides, where it is kept; one that
 * is damaged is trained again. Fails where an eye's camera is missing. */
bool setup_learn(Setup *setup, const SetupSymbol *symbols, int count, Arena *arena, Error *err);
