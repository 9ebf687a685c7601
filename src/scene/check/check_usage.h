/* SPDX-License-Identifier: Apache-2.0 */
/* check_usage.h -- accessors and buffer views serve one purpose each: that of their target. */
#pragma once
#include "scene/check/check.h"

/* The whole document, after its objects. */
void check_usage(const DocumentCheck *check, const GltfValue *root);
