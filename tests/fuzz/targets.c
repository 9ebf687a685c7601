/* SPDX-License-Identifier: Apache-2.0 */
/* The targets: one row a reader of the program. */
#include <string.h>

#include "harness.h"

#define FORMAT(name, size) {"import-" name, fuzz_import, NULL, size, name}

const FuzzTarget fuzz_targets[] = {
    {"gltf", fuzz_scene, fuzz_mutate_json, 8192, NULL},
    {"glb", fuzz_scene, fuzz_mutate_glb, 8192, NULL},
    {"panel", fuzz_panel, fuzz_mutate_panel, 32768, NULL},
    {"manifest", fuzz_manifest, fuzz_mutate_json, 2048, NULL},
    {"recipe", fuzz_recipe, fuzz_mutate_json, 2048, NULL},
    {"declaration", fuzz_declaration, fuzz_mutate_json, 2048, NULL},
    {"review", fuzz_review, fuzz_mutate_json, 4096, NULL},
    {"table", fuzz_table, NULL, 1024, NULL},
    {"primaries", fuzz_primaries, NULL, 1024, NULL},
    {"curve", fuzz_curve, NULL, 1024, NULL},
    {"weather", fuzz_weather, NULL, 2048, NULL},
    {"environment", fuzz_environment, NULL, 256, NULL},
    {"cli", fuzz_cli, NULL, 256, NULL},
    {"uri", fuzz_uri, NULL, 256, NULL},
    {"exr", fuzz_frame, NULL, 4096, NULL},
    {"part", fuzz_part, NULL, 16384, NULL, fuzz_make_part},
    {"image", fuzz_image, NULL, 4096, NULL},
    {"png", fuzz_image, fuzz_mutate_png, 2048, NULL},
    {"checkpoint", fuzz_checkpoint, fuzz_mutate_checkpoint, 8192, NULL},
    {"field", fuzz_field, fuzz_mutate_field, 16384, NULL, fuzz_make_field},
    {"response", fuzz_response, fuzz_mutate_response, 16384, NULL, fuzz_make_response},
    {"condition", fuzz_condition, fuzz_mutate_json, 8192, NULL, fuzz_make_condition},
    {"import-any", fuzz_import_any, NULL, 2048, NULL},
    {"import-text", fuzz_import_text, NULL, 2048, NULL},
    FORMAT("eulumdat", 2048),
    FORMAT("ies", 2048),
    FORMAT("zemax", 2048),
    FORMAT("speos", 2048),
    FORMAT("astm", 2048),
    FORMAT("rgl", 8192),
    FORMAT("merl", 2048),
    {NULL, NULL, NULL, 0, NULL},
};
