/* SPDX-License-Identifier: Apache-2.0 */
/* harness.h -- what a fuzz target is, and what it may use: memory, files, claims.
 *
 * A target takes any bytes and hands them to one reader of the program. Nothing may crash, no
 * sanitizer may report, and the claims that the target makes must hold: what is refused is
 * refused in one line, what is taken is what the reader's header promises.
 *
 * Memory   one arena that every run starts anew; running out of it is a failed claim, since no
 *          input of a few kilobytes needs so much.
 * Files    one folder, in memory where the system has such a place; removed at the end.
 * Threads  one.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"

#define FUZZ_ARENA_BYTES ((size_t)1 << 29)

/* data: `size` bytes in a block of exactly that size. */
typedef void FuzzRun(const uint8_t *data, size_t size, Arena *arena);

/* Changes data in place; the new size is at most max_size. */
typedef size_t FuzzMutate(uint8_t *data, size_t size, size_t max_size, unsigned seed);

/* Writes valid input `number`; 0: there are no more. */
typedef size_t FuzzMake(uint8_t *data, size_t max_size, unsigned number, Arena *arena);

typedef struct FuzzTarget {
    const char *name; /* of its folders in corpus/ and found/, and of its dictionary */
    FuzzRun *run;
    FuzzMutate *mutate; /* NULL: libFuzzer's own */
    size_t max_size;
    const char *more; /* for the run function: which importer */
    FuzzMake *make;   /* NULL: corpus/ has all there are */
} FuzzTarget;

/* All of them; the last one's name is NULL. */
extern const FuzzTarget fuzz_targets[];

const FuzzTarget *fuzz_target_named(const char *name); /* NULL: there is none */

/* One run of a target. */
void fuzz_run(const FuzzTarget *target, const uint8_t *data, size_t size);

/* The same of a target's `make`. */
size_t fuzz_make(const FuzzTarget *target, uint8_t *data, unsigned number);

/* The `more` of the target that runs. */
const char *fuzz_more(void);

/* Writes a file into the folder and returns its path. */
const char *fuzz_file(const char *name, const void *data, size_t size, Arena *arena);

/* The path of a name in the folder. */
const char *fuzz_path(const char *name, Arena *arena);

/* A copy with a zero byte behind it. */
char *fuzz_text(const uint8_t *data, size_t size, Arena *arena);

/* Ends the process with the text when it does not hold. */
void fuzz_claim(bool holds, const char *what);

/* A refusal has a code that fits and one line of text that says something. */
void fuzz_claim_refusal(const Error *err);

/* How many there were so far. */
long fuzz_refusals(void);

/* ---- mutation ---------------------------------------------------------------------------- */

/* libFuzzer's own mutation; the replay program has one that changes nothing. */
size_t fuzz_mutate_bytes(uint8_t *data, size_t size, size_t max_size);

/* Changes a few bytes here and there; the size stays. */
void fuzz_mutate_places(uint8_t *data, size_t size, unsigned seed);

/* A steady sequence of 32-bit numbers (Steele and Vigna: splitmix). */
uint32_t fuzz_random(uint64_t *state);

FuzzMutate fuzz_mutate_json, fuzz_mutate_glb, fuzz_mutate_png, fuzz_mutate_panel,
    fuzz_mutate_checkpoint, fuzz_mutate_field, fuzz_mutate_response;

FuzzMake fuzz_make_field, fuzz_make_response, fuzz_make_condition, fuzz_make_part;

/* ---- targets ----------------------------------------------------------------------------- */

FuzzRun fuzz_scene, fuzz_panel, fuzz_import, fuzz_import_any, fuzz_import_text, fuzz_declaration,
    fuzz_image, fuzz_frame, fuzz_manifest, fuzz_recipe, fuzz_table, fuzz_weather, fuzz_curve,
    fuzz_primaries, fuzz_environment, fuzz_cli, fuzz_uri, fuzz_part, fuzz_checkpoint, fuzz_review,
    fuzz_field, fuzz_response, fuzz_condition;
