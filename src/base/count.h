/* SPDX-License-Identifier: Apache-2.0 */
/* count.h -- how many elements an array has, as an int. Not for pointers. */
#pragma once
#include <stddef.h>

#define COUNT_OF(array) ((int)(sizeof(array) / sizeof *(array)))
