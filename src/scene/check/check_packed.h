/* SPDX-License-Identifier: Apache-2.0 */
/* check_packed.h -- the extensions that pack bytes: what they hold, and that it fits. */
#pragma once
#include "scene/check/rule.h"

extern const Schema SCHEMA_MESHOPT, SCHEMA_MESHOPT_BUFFER; /* EXT_meshopt_compression */
extern const Schema SCHEMA_DRACO; /* KHR_draco_mesh_compression */
