/* SPDX-License-Identifier: Apache-2.0 */
/* list.h -- an array that grows while the scene is being read.
 *
 * Memory   items lie in the arena that is passed in; a growing list leaves its older, shorter
 *          arrays behind there, so it belongs into scratch memory.
 */
#pragma once
#include <string.h>

#include "base/arena.h"

typedef struct ItemList {
    void *items;
    size_t item_size;
    int count, capacity;
} ItemList;

static inline ItemList list_of(size_t item_size) {
    return (ItemList){.item_size = item_size};
}

/* A new item, all zero. The pointer holds until the next list_add. */
static inline void *list_add(ItemList *list, Arena *arena) {
    if (list->count == list->capacity) {
        int capacity = list->capacity ? 2 * list->capacity : 16;
        void *items = arena_alloc(arena, list->item_size, 64, (size_t)capacity);
        if (list->count) memcpy(items, list->items, list->item_size * (size_t)list->count);
        list->items = items;
        list->capacity = capacity;
    }
    return (char *)list->items + list->item_size * (size_t)list->count++;
}

static inline void *list_item(const ItemList *list, int index) {
    return (char *)list->items + list->item_size * (size_t)index;
}

/* The items as an array of exactly their number. */
static inline void *list_copy(const ItemList *list, Arena *arena) {
    void *items = arena_alloc(arena, list->item_size, 64, (size_t)list->count);
    if (list->count) memcpy(items, list->items, list->item_size * (size_t)list->count);
    return items;
}
