/* SPDX-License-Identifier: Apache-2.0 */
/* tree.h -- reads values out of a glTF document, each with its default.
 *
 * The readers take a missing value or one of a wrong kind for the default: what is wrong
 * has been reported before by the check (schema.h), and a document with errors is not built.
 *
 * Threads  const data.
 */
#pragma once
#include "base/vec.h"
#include "tinygltf/gltf_json.h"

/* NULL where there is none; `object` may be NULL or no object. */
const GltfValue *tree_member(const GltfValue *object, const char *name);

/* Item of an array, NULL when it is out of range or `array` is none. */
const GltfValue *tree_item(const GltfValue *array, int index);

/* The item with this index in a collection of the document's root ("nodes", "meshes" ...). */
const GltfValue *tree_element(const GltfValue *root, const char *collection, int index);
/* The same of a value of the document that is the index; NULL of any other, or none. */
const GltfValue *tree_referred(const GltfValue *index, const char *collection);

#define TREE_OURS "PARHELION_" /* what the names of our own extensions begin with */

/* `object`'s extension, NULL where it has none. One of ours is also found in its extras
 * (gltf/extras.h). */
const GltfValue *tree_extension(const GltfValue *object, const char *name);

/* The first item of an array or object that `object` has by this name, and the item behind one;
 * NULL: none. */
const GltfValue *tree_items(const GltfValue *object, const char *name);
const GltfValue *tree_next(const GltfValue *item);

/* Whether a text stands in an array. */
bool tree_lists(const GltfValue *array, const char *text);

/* How many items the member has; 0 unless it is an array or object. */
int tree_count(const GltfValue *object, const char *name);

bool tree_is_integer(const GltfValue *value); /* a number without fraction, |n| < 2^53 */
/* The same as an int; fallback where it is none. */
int tree_whole(const GltfValue *value, int fallback);

double tree_number(const GltfValue *object, const char *name, double fallback);
float tree_float(const GltfValue *object, const char *name, float fallback);
int tree_int(const GltfValue *object, const char *name, int fallback);
bool tree_boolean(const GltfValue *object, const char *name, bool fallback);
const char *tree_text(const GltfValue *object, const char *name, const char *fallback);

/* Exactly `count` numbers into `out`; false (and out as it was) unless they are there. */
bool tree_floats(const GltfValue *object, const char *name, int count, float *out);
bool tree_numbers(const GltfValue *object, const char *name, int count, double *out);

/* The value's JSON pointer (RFC 6901), "" of the whole document. */
void tree_pointer(const GltfValue *value, char *buffer, size_t size);
