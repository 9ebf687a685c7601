/* SPDX-License-Identifier: Apache-2.0 */
/* check_bytes.h -- buffer views and accessors: everything lies inside its buffer. */
#pragma once
#include "scene/check/check.h"

/* The bytes that a buffer view, or a packed one, takes of its buffer. */
void check_place_in_buffer(const DocumentCheck *check, const GltfValue *view);

void check_buffer_view(const DocumentCheck *check, const GltfValue *view);
void check_accessor(const DocumentCheck *check, const GltfValue *accessor);
