/* SPDX-License-Identifier: Apache-2.0 */
/* schema_core.h -- the members of glTF 2.0's own objects. */
#pragma once
#include "scene/check/rule.h"

extern const Schema SCHEMA_ROOT; /* of the whole document */
