/* SPDX-License-Identifier: Apache-2.0 */
/* schema_extensions.h -- glTF's extensions: where they may stand and what they hold. */
#pragma once
#include "scene/check/rule.h"

/* The rule for an extension on this host; *is_known: it may stand on some object. */
const ExtensionRule *extension_rule(const char *name, const char *host, bool *is_known);

/* Whether the program honours it, so that it may be required. */
bool extension_is_supported(const char *name);

/* extensionsUsed and extensionsRequired of the document. */
void check_extensions(const DocumentCheck *check, const GltfValue *root);
