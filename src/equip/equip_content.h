/* SPDX-License-Identifier: Apache-2.0 */
/* equip_content.h -- the shipped contents for the page of `parhelion equip`: small pictures of
 * them, and of the texts that a review would find there.
 *
 * Memory   scratch in the arena; the JSON value is jansson's. Threads: any.
 * Fails    never: what is not installed is not offered.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"

/* [{"name", "picture", "width", "height", "texts": [{"uv", "polarity", "crop", "name"}]}]; a
 * text's name is what it says, where the content's list of words (NAME.words) states it. */
json_t *equip_contents_json(Arena *arena);
