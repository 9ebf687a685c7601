/* SPDX-License-Identifier: Apache-2.0 */
/* panel_bytes.h -- panel files that are changed byte by byte. */
#pragma once
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "panel/query/panel_file.h"

/* As if the file had been written so; of fewer bytes than a header nothing. */
static inline void repair_checksum(unsigned char *bytes, size_t size) {
    size_t from = offsetof(PanelHeader, size);
    if (size <= sizeof(PanelHeader)) return;
    uint64_t checksum = XXH3_64bits(bytes + from, size - from);
    memcpy(bytes + offsetof(PanelHeader, checksum), &checksum, sizeof checksum);
}
