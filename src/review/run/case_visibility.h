/* SPDX-License-Identifier: Apache-2.0 */
/* case_visibility.h -- for whom a case has visibility levels, how large its target is, and the
 * veil in each of their eyes. Judging makes the levels of that (review/ask_visibility_level.h).
 *
 * The observer comes first, then the request's other ages. The target is a stroke, its size the
 * median of the strokes' widths: what carries the symbol's form, not its height. Of a shape
 * without strokes, such as a filled sign, it is how thick that is.
 *
 * Memory   lists come from the arena.
 * Threads  case_visibility_veils starts its own; the others are pure.
 * Fails    never.
 */
#pragma once
#include "review/eye/eye_reading.h"
#include "review/symbol/symbol.h"
#include "review/verdict.h"

/* The width of a symbol's strokes where its foreground is so high. */
double symbol_stroke_deg(const SymbolSplit *split, double height_arcmin);

/* Levels that nobody knows yet, of a symbol whose height the case has. */
void case_visibility_start(const ReviewRequest *request, const SymbolSplit *split, ReviewCase *c,
                           Arena *arena);

/* A level hangs on the veil, so that it is read by so many rounds, close (EyeLook). */
#define VISIBILITY_ROUNDS 8

/* Sets veil_times and veil_doubt of each, from the observer's reading: for other ages by a
 * second one of the same paths (eye_spread_aging). None is taken where all have the observer's
 * age. */
void case_visibility_veils(const Setup *lit, const EyeLook *look, const EyeReading *observers,
                           ReviewCase *c, Arena *arena);
