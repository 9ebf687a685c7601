/* SPDX-License-Identifier: Apache-2.0 */
/* check_usage.h -- accessors and buffer views serve one purpose each, as their target says. */
#pragma once
#include "scene/check/check.h"

/* Of the whole document, after its objects. */
void check_usage(const DocumentCheck *check, const GltfValue *root);
