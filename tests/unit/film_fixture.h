/* SPDX-License-Identifier: Apache-2.0 */
/* film_fixture.h -- for tests of what films are kept in: one file in a temporary folder, and
 * numbers of a seed. */
#pragma once
#include "fixture.h"

#include "base/sampler.h"

static char path[2 * FOLDER_BYTES]; /* of the file */

static inline int make_path(void **state, const char *name) {
    if (make_folder(state)) return -1;
    snprintf(path, sizeof path, "%s", in_folder(name));
    return 0;
}

static inline int remove_path(void **state) {
    unlink(path);
    return remove_folder(state);
}

static inline float random_unit(uint32_t *state) {
    *state = hash_u32(*state + 0x9e3779b9u);
    return unit_float(*state);
}
