/* SPDX-License-Identifier: Apache-2.0 */
/* check_document.h -- rules that tables cannot express, on a document's small objects. */
#pragma once
#include "scene/check/check.h"

void check_asset(const DocumentCheck *check, const GltfValue *asset);
void check_source(const DocumentCheck *check, const GltfValue *object); /* of bytes */
void check_camera(const DocumentCheck *check, const GltfValue *camera);
void check_light(const DocumentCheck *check, const GltfValue *light);
void check_display(const DocumentCheck *check, const GltfValue *display);
void check_environment(const DocumentCheck *check, const GltfValue *environment);
void check_variant_names(const DocumentCheck *check, const GltfValue *extension);
void check_variants(const DocumentCheck *check, const GltfValue *extension);
