/* load.h -- what the parts of the loader share; private to src/scene.
 *
 * One Loader makes one Scene of several GltfFiles, each of them in four steps: read the
 * document (document.c), check it completely (schema.c, check_*.c), load what it refers to
 * (document.c, image.c), and build world-space arrays (graph.c, primitive.c, material.c ...).
 * A file with errors is not built, but the next one is still checked.
 *
 * Memory   what the Scene keeps lies in `arena`; everything else in `scratch`.
 */
#pragma once
#include "base/file.h"
#include "scene/list.h"
#include "scene/scene.h"
#include "scene/tree.h"

/* Limits: more than these is refused with a clear line. */
#define LOAD_MAX_FILE_BYTES ((size_t)4 << 30)
#define LOAD_MAX_JSON_BYTES ((size_t)1 << 30)
#define LOAD_MAX_ELEMENTS ((size_t)1 << 27)       /* of one accessor, and vertices in all */
#define LOAD_SCRATCH_BYTES ((size_t)64 << 30)     /* address space; pages come when touched */
#define LOAD_MAX_EMPTY_ELEMENTS ((size_t)1 << 22) /* of an accessor without bytes behind it */

/* A part before all triangles stand in one array. Indices count from the part's vertices. */
typedef struct PartDraft {
    Part part;
    Vertex *vertices;
    uint32_t *indices; /* three a triangle */
    uint32_t vertex_count, triangle_count;
    struct GltfFile *file; /* where it came from, for messages */
    const GltfValue *primitive;
} PartDraft;

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
    List parts;            /* PartDraft */
    List materials;        /* Material */
    List material_uv_sets; /* int[2] a material: which TEXCOORD_n its Vertex.uv slots hold */
    List textures, displays, lights, cameras, curves;
    List display_places; /* DisplayPlace, one a display */
    List inputs;         /* const char * */
    List input_hashes;   /* uint64_t */
    List extensions;     /* const char * */
    size_t vertex_total;
    int ignored_occlusion_count;
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
    Transform *world_from_node;
    int material_base, texture_base;     /* first id of this file's */
    int default_material_id;             /* NO_ID until it is needed */
    int skipped_count, degenerate_count; /* primitives; triangles */
} GltfFile;

/* ---- problems (document.c) ------------------------------------------------------------- */

/* A fault or warning at a place of the document (NULL: the file as a whole). */
void file_error(GltfFile *file, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void file_warning(GltfFile *file, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* ---- files (document.c) ---------------------------------------------------------------- */

/* Reads a file, hashes it and notes it among the scene's inputs. */
bool load_read(Loader *load, const char *path, Arena *arena, FileBytes *out, Error *err);

/* Reads and parses a .gltf or .glb. False when there is no document to check. */
bool document_read(GltfFile *file);

/* Fills file->buffers; what is missing or short is reported. */
void document_load_buffers(GltfFile *file);

/* The path a URI names, from the scene's folder. False, and reported, when it is not allowed:
 * another scheme, an absolute path, or a place where the scene may not look
 * (base/reference.h). */
bool document_resolve(GltfFile *file, const GltfValue *uri, const char **path);

/* The bytes of a buffer view; data NULL when there are none. */
FileBytes document_view(const GltfFile *file, int view);

/* ---- accessors (accessor.c), only of documents that passed the check ------------------- */

const GltfAccessor *accessor_get(const GltfFile *file, int accessor);

/* Bytes of one element, columns of matrices padded to four bytes. */
size_t accessor_element_size(const GltfAccessor *accessor);
/* The same without the padding behind the last column, which a buffer need not have. */
size_t accessor_element_extent(const GltfAccessor *accessor);
size_t component_size(int component_type); /* 0: no such type */

/* count x component_count numbers in scratch; normalised integers become [0,1] or [-1,1].
 * Matrices lose their padding. */
float *accessor_floats(GltfFile *file, int accessor);
/* The same for integers that are not normalised: indices, joints. */
uint32_t *accessor_integers(GltfFile *file, int accessor);
/* As accessor_floats, but normalised integers stay what they are: min and max count these. */
float *accessor_raw_floats(GltfFile *file, int accessor);
/* Where the sparse values go; NULL when the bytes are missing. */
uint32_t *accessor_sparse_indices(GltfFile *file, const GltfAccessor *accessor);

/* ---- building -------------------------------------------------------------------------- */

void images_load(GltfFile *file);     /* image.c: the file's textures */
void materials_build(GltfFile *file); /* material.c */
int material_default(GltfFile *file); /* glTF's default material */
int texture_add(Loader *load, Texture texture);

/* Reads {"index", "texCoord", KHR_texture_transform}; NO_ID where `info` is NULL. The uv_set is
 * still the file's TEXCOORD number. */
TextureSlot texture_slot(GltfFile *file, const GltfValue *info);

/* display.c: the material's PARHELION_display, the command line's overrides, and what can be
 * checked only when all files are read: panels that open, coordinates that are not mirrored. */
void display_build(GltfFile *file, const GltfValue *extension, int material_id);
void displays_override(Loader *load);
void displays_finish(Loader *load);

/* material.c: what follows from the other members. */
void material_derive_flags(Material *material);

void environment_build(GltfFile *file, const GltfValue *extension); /* environment.c */

/* graph.c: walks the scene's nodes, in order; adds parts, lights and cameras. */
void graph_build(GltfFile *file);

/* primitive.c: one primitive of one node into a part. */
void primitive_build(GltfFile *file, const GltfValue *node, const Transform *world,
                     const GltfValue *mesh, const GltfValue *primitive);

/* tangent.c: fills normals (flat) and tangents of a draft, whose vertices may be split. */
void draft_flat_normals(PartDraft *draft, Arena *scratch);
void draft_tangents(PartDraft *draft, const TextureSlot *slot, Arena *scratch);
void draft_any_tangents(PartDraft *draft);

/* The unit direction of growing u; returns 0 where the coordinates span no area, 1 where the
 * picture is seen as it is, 2 where it is mirrored. */
int triangle_tangent(const TextureSlot *slot, const Vertex *const v[3], Vec3 *tangent);

/* Reads an image file or bytes, decoded into the scene's memory. */
bool load_image(Loader *load, const char *path, Image *out, Error *err);
