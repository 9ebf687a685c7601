/* SPDX-License-Identifier: Apache-2.0 */
/* panel_section.h -- the sections of a panel file while it is opened. Private to src/panel.
 *
 * Every function that fails reports it in bytes->err, naming the file and the place.
 */
#pragma once
#include <stdbool.h>

#include "base/error.h"
#include "panel/query/panel_file.h"

/* A piece of the file, or the whole. */
typedef struct PanelBytes {
    const unsigned char *data;
    size_t size;
    const char *name; /* of the file */
    Error *err;
} PanelBytes;

/* "the panel file is damaged"; always false. */
bool panel_refuse(const PanelBytes *bytes, const char *place, const char *what);

/* Magic, version, size, checksum; *header is filled. */
bool panel_check_header(const PanelBytes *bytes, PanelHeader *header);

/* The section of a kind and index, inside the file; true with *found false when absent. */
bool panel_find_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out, bool *found);

/* The same; absent is an error. */
bool panel_need_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out);

/* Numbers that a query may use: finite and below 1e30. */
bool panel_all_finite(const float *value, size_t count);

bool panel_rising(const float *value, uint32_t count);
