/* panel_figures.h -- the report's table of figures in a few bytes a number. Private to
 * src/panel.
 *
 * Stored     uint16 rows, uint8 columns | per column: uint8 kind, uint8 length, its key | per
 *            row: uint8 length, its name | numbers row by row: kind 'i' uint32, 'f' float32,
 *            'h' the upper half of a float32, rounded away from 0 (so that a stated error is
 *            never too small). A number that is absent is NaN, an absent integer UINT32_MAX.
 *            "ratio" and "ratio_text" follow from the bytes and are not stored.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"

/* tables: objects of a "name" and numbers. Returns the size of *bytes in the arena. */
size_t panel_figures_pack(const json_t *tables, Arena *arena, const void **bytes);

/* A new array of such objects; NULL: the bytes are damaged. */
json_t *panel_figures_open(const void *bytes, size_t size);
