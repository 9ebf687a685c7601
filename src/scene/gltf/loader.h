/* SPDX-License-Identifier: Apache-2.0 */
/* loader.h -- a scene on its way from its files to its arrays.
 *
 * One Loader makes one Scene of several GltfFiles, each of them in four steps: read the
 * document (gltf/document.c), check it completely (check/), load what it refers to
 * (load/image.c) and place its nodes; and when all have come so far, from where coordinates
 * count (load/scene_origin.c), build arrays (load/graph.c, load/primitive.c ...).
 * A file with errors is not built, but the next one is still checked.
 *
 * Memory   what the Scene keeps lies in `arena`; everything else in `scratch`.
 */
#pragma once
#include "base/file.h"
#include "base/progress.h"
#include "scene/gltf/list.h"
#include "scene/gltf/node_place.h"
#include "scene/gltf/tree.h"
#include "scene/scene.h"

/* Limits: more than these is refused with a clear line. */
#define LOAD_MAX_FILE_BYTES ((size_t)4 << 30)
#define LOAD_MAX_JSON_BYTES ((size_t)1 << 30)
#define LOAD_MAX_ELEMENTS ((size_t)1 << 27)       /* of one accessor, and vertices in all */
#define LOAD_SCRATCH_BYTES ((size_t)64 << 30)     /* address space; pages come when touched */
#define LOAD_MAX_INSTANCES (1 << 20)              /* of one node */
#define LOAD_MAX_EMPTY_ELEMENTS ((size_t)1 << 22) /* of an accessor without bytes behind it */

/* Where a display was described, and where its panel's name stands ("--panel" for the command
 * line's). */
typedef struct DisplayPlace {
    const char *file, *pointer;
} DisplayPlace;

typedef struct Loader {
    Arena *arena;
    Arena scratch;
    Problems *problems;
    const SceneOptions *options;
    Environment environment;
    ItemList parts;            /* PartDraft */
    ItemList materials;        /* Material */
    ItemList material_uv_sets; /* int[2] a material: the TEXCOORD_n of Part.uv */
    ItemList textures, texture_words, displays, lights, cameras, curves;
    ItemList display_places;           /* DisplayPlace, one a display */
    ItemList inputs;                   /* const char * */
    ItemList input_hashes;             /* uint64_t */
    ItemList undecoded;                /* const char *, of the inputs */
    ItemList extensions;               /* const char * */
    ItemList node_names;               /* const char *, of nodes that are shown */
    ItemList variants;                 /* const char *, of all files */
    ItemList animations;               /* SceneAnimation, of all files */
    int *change_uses;                  /* one a change: how often its name was found */
    struct LuminaireDraft *luminaires; /* one a --light (load/luminaire.c) */
    ProgressMode progress_mode;        /* of load_progress_begin, which has the three below */
    Progress progress;
    double progress_done;
    bool has_step;
    size_t vertex_total;
    int ignored_occlusion_count;
    double origin[3]; /* Scene.origin; 0 until scene_origin_find */
} Loader;

typedef struct GltfFile {
    Loader *load;
    const char *path; /* as the user named it */
    const GltfValue *root;
    const char *json;
    size_t json_size;
    bool is_binary;     /* a .glb */
    FileBytes bin;      /* its BIN chunk; data NULL without one */
    FileBytes *buffers; /* data NULL: could not be had */
    GltfData data;
    FileBytes *views;                /* of each of data's, unpacked; data NULL: could not be had */
    int variant_id;                  /* of KHR_materials_variants, that is worn; NO_ID: none */
    struct NodePose *poses;          /* one a node (load/pose.h); NULL: at rest */
    int *parents;                    /* one a node; NO_ID: a root */
    NodePlace *places;               /* one a node; in the world until nodes_enter_scene */
    Transform *world_from_node;      /* the same in floats, from nodes_enter_scene on */
    int *shown, shown_count;         /* the nodes that are shown, in order */
    struct NodeInstances *instances; /* one a node (load/nodes.h) */
    struct LightProfile *profiles;   /* of EXT_lights_ies, one a list item (load/profiles.c) */
    int material_base, texture_base; /* first id of this file's */
    int default_material_id;         /* NO_ID until it is needed */
    int skipped_count, degenerate_count; /* primitives; triangles */
} GltfFile;

/* Where p, of the scene, is in the world, and whether that is within SCENE_MOST_M. */
bool load_is_within_reach(const Loader *load, Vec3 p, double world_m[3]);

/* ---- progress ---------------------------------------------------------------------------- */

/* Shows how far the loading of a large scene has come, step by step. Nothing is shown of a step
 * that ends soon, nor at all where load->progress_mode is PROGRESS_NONE; what was shown is
 * blanked out when its step ends.
 *
 * A step begins; both texts must outlive the loader. */
void load_progress_begin(Loader *load, const char *what, const char *unit, double total);

/* So much more of it is done; outside of steps nothing happens. */
void load_progress_add(Loader *load, double more);

void load_progress_end(Loader *load);
