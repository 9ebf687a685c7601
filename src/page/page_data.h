/* SPDX-License-Identifier: Apache-2.0 */
/* page_data.h -- numbers for a page's script, packed.
 *
 * Whole numbers of 1 to 4 bytes, as base64 of a zlib stream (RFC 1950) of their bytes in
 * planes: the lowest byte of all numbers, then the next of all, ...; of each plane the first
 * byte, then every byte less the one before it, modulo 256. What changes little from number to
 * number is short so. A script unpacks it by DecompressionStream('deflate').
 *
 * Memory   the text's; scratch: twice the numbers' bytes.
 * Threads  pure. The same numbers give the same text (of one version of zlib).
 * Fails    when memory is out.
 */
#pragma once
#include <stdint.h>

#include "base/error.h"
#include "text/text.h"

/* values: the lowest `bytes` (1 to 4) of each go in. */
bool page_data_add(Text *page, const uint32_t *values, size_t count, int bytes, Arena scratch,
                   Error *err);
