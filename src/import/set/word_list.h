/* SPDX-License-Identifier: Apache-2.0 */
/* word_list.h -- which word of a list somebody wrote, in any case.
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once

/* Its place in a list that ends with NULL, or -1. */
int word_list_find(const char *const *list, const char *word);
