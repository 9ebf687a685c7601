/* lz4_block.h -- undoes one LZ4 block (the block format of lz4.org; no frame).
 *
 * Memory   writes into `out` alone. Threads: no shared state.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* True when the block is sound and yields exactly out_size bytes. */
bool lz4_block_decode(const unsigned char *block, size_t block_size, unsigned char *out,
                      size_t out_size);
