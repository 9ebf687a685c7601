/* SPDX-License-Identifier: Apache-2.0 */
/* accessor.h -- the numbers behind a glTF accessor, of documents that passed the check.
 *
 * Memory   arrays lie in the loader's scratch.
 */
#pragma once
#include "scene/gltf/loader.h"

/* NULL: there is no such accessor. */
const GltfAccessor *accessor_get(const GltfFile *file, int accessor);

/* False: its buffer, or that of its sparse values, is not there; its numbers are zeros then. An
 * accessor without a buffer view needs no bytes. */
bool accessor_has_bytes(const GltfFile *file, const GltfAccessor *accessor);
/* The same, and reported at `at` as the bytes of `what` where they are not; true where there is
 * no such accessor. */
bool accessor_claim_bytes(GltfFile *file, int accessor, const GltfValue *at, const char *what);

/* Bytes of one element, columns of matrices padded to four bytes. */
size_t accessor_element_size(const GltfAccessor *accessor);
/* The same without the padding behind the last column, which a buffer need not have. */
size_t accessor_element_extent(const GltfAccessor *accessor);
size_t component_size(int component_type); /* 0: no such type */

/* For messages: "FLOAT (5126)"; "unknown" where glTF and its extensions have no such type. */
const char *component_name(int component_type);
double accessor_numbers(const GltfAccessor *accessor); /* how many it has */
bool accessor_is_float(const GltfAccessor *accessor);  /* else its numbers are integers */

/* count x component_count numbers; normalised integers become [0,1] or [-1,1]. Matrices lose
 * their padding. */
float *accessor_floats(GltfFile *file, int accessor);
/* The same for integers that are not normalised: indices, joints. */
uint32_t *accessor_integers(GltfFile *file, int accessor);
/* As accessor_floats, but normalised integers stay what they are: min and max count these. */
float *accessor_raw_floats(GltfFile *file, int accessor);
/* Where the sparse values go; NULL when the bytes are missing. */
uint32_t *accessor_sparse_indices(GltfFile *file, const GltfAccessor *accessor);
