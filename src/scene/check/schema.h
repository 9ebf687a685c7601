/* SPDX-License-Identifier: Apache-2.0 */
/* schema.h -- checks a glTF document against the tables of what it must look like (rule.h). */
#pragma once
#include "scene/check/rule.h"

/* Checks a value and everything below it. */
void schema_check(const DocumentCheck *check, const GltfValue *value, const Schema *described);
