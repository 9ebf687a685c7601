/* SPDX-License-Identifier: Apache-2.0 */
/* equip_file.h -- what a model is equipped with: the file that `parhelion equip`'s page saves
 * (`parhelion schema equip`).
 *
 * Units    metres, degrees; positions and directions in the model's world (glTF's axes).
 * Memory   everything lies in the arena.
 * Threads  const after reading.
 * Fails    ERROR_INPUT with file, JSON path, what was found and what was required.
 */
#pragma once
#include "record/record.h"
#include "review/request/request_start.h"

#define EQUIP_VERSION 1
#define EQUIP_DISPLAYS_MAX 64
#define EQUIP_EYES_MAX 64
#define EQUIP_HEADINGS_MAX 360
#define EQUIP_SYMBOLS_MAX 100
#define EQUIP_VERTICES_MAX 100000

/* What is read of a display: a rectangle of its content. */
typedef struct EquipSymbol {
    const char *name, *polarity; /* polarity NULL: found from the rectangle itself */
    double uv[4];                /* left, top, right, bottom */
} EquipSymbol;

/* A face of the model that is a display itself: curved, or cut out. */
typedef struct EquipMesh {
    const double *positions_m, *uv;   /* three and two a vertex; v down */
    const double *triangles;          /* whole numbers, three a triangle, fronts outside */
    int vertex_count, triangle_count; /* 0: a rectangle */
    int uv_count;                     /* pairs: as many as vertices */
} EquipMesh;

/* A rectangle before a face of the model, or such a face. */
typedef struct EquipDisplay {
    const char *name, *place;            /* place: its JSON path, for messages */
    double centre_m[3], right[3], up[3]; /* unit, at right angles; on the face */
    double width_m, height_m;
    double before_m; /* so far before the face */
    EquipMesh mesh;  /* world, as far before the face as it is to be */
    const EquipSymbol *symbols;
    int symbol_count;
    bool has_symbols;        /* false: a review looks for text itself */
    const char *panel;       /* a shipped one's name, or a path beside the model */
    const char *content;     /* likewise; NULL: full white */
    double level, max_level; /* level multiplies its light; 1: as measured */
    bool any_size;           /* however large: it is meant */
} EquipDisplay;

typedef struct EquipEye {
    const char *name, *place;
    double position_m[3];
    double target_m[3];        /* elsewhere */
    int display_id;            /* that is there, or NO_ID */
    const char *proposed_from; /* by the page, which nobody corrected; NULL: it was given */
} EquipEye;

/* A material of the model is replaced. */
typedef struct EquipMaterial {
    const char *name, *place; /* name: as the model has it, "" none */
    int index;                /* in the model's list; its length: glTF's default material */
    const char *as;           /* which usual one it is; NULL: figures of its own */
    double base_color[3], roughness, metallic, transmission, ior;
} EquipMaterial;

/* Somebody sits where an eye is. */
typedef struct EquipOccupant {
    int eye_id;        /* NO_ID: nobody does */
    int shirt_id;      /* white, grey, black */
    const char *scene; /* the shipped scene that it is */
    const char *name;  /* in the review */
} EquipOccupant;

typedef struct Equip {
    const char *file;
    const EquipDisplay *displays;
    const EquipEye *eyes;
    const EquipMaterial *materials;
    int display_count, eye_count, material_count;
    const char *profile;      /* a shipped one's name */
    double forward[3];        /* where the vehicle points */
    bool forward_is_proposed; /* from the first eye: the file says none */
    EquipOccupant occupant;
    bool has_place;
    ReviewPlace place;
} Equip;

extern const RecordFormat equip_format;

bool equip_file_read(const char *file, Arena *arena, Equip *out, Error *err);
