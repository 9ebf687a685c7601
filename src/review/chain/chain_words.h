/* SPDX-License-Identifier: Apache-2.0 */
/* chain_words.h -- what a chain of objects is called: nodes and materials by their names.
 *
 * Memory   texts and lists live in the arena.  Threads  pure functions.
 */
#pragma once
#include "review/chain/chains.h"

/* A chain in words, in the order in which the eye's ray meets it: "display cluster: reflects",
 * "Window_FL (glass): through", "sky". Texts and list live in the arena. */
const char *const *chain_words(const Scene *scene, const ChainKey *key, int *links,
                               Arena *arena);

/* "FrontSeat_L (leather)" */
const char *chain_part_words(const Scene *scene, int part_id, Arena *arena);

/* "sky", "sun", "lamp NAME", or a part's words. */
const char *chain_source_words(const Scene *scene, int source, int source_id, Arena *arena);
