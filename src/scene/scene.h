/* SPDX-License-Identifier: Apache-2.0 */
/* scene.h -- what the user described, as plain arrays with ids.
 *
 * Filled by scene_load (load/scene_load.h), checked once, then const. Elements refer to each
 * other by id; NO_ID is "none". Node trees are flattened, skins, morph targets and animations
 * as in SceneState, at rest without it.
 *
 * Frame    scene coordinates: the world's (metres, +Y up) minus Scene.origin, with the world's
 *          axes. All positions of the program are such ("world" in names of transforms means
 *          these axes); those that come in or go out as the user's are the world's, via
 *          scene_from_world and world_from_scene below, and nothing else converts.
 *
 * Memory   everything lives in the arena given to scene_load, and dies with it; the panels are
 *          closed by scene_close.
 * Threads  const after loading.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "image/fisheye.h"
#include "base/problems.h"
#include "base/vec.h"
#include "image/texture.h"
#include "panel/query/panel.h"
#include "panel/zones/backlight.h"
#include "sky/daylight.h"
#include "sky/weather_clock.h"
#include "spectrum/curve.h"
#include "spectrum/glazing.h"
#include "spectrum/intensity_web.h"
#include "spectrum/luminous_opening.h"
#include "spectrum/thin_film.h"

#define NO_ID (-1)
#define SCENE_UV_SETS 2 /* of a part; those that its material uses are mapped to these */

typedef struct Tangent {
    Vec3 along; /* unit, world */
    float side; /* +-1: bitangent = side * cross(normal, along) */
} Tangent;

typedef struct VertexColor {
    uint16_t linear[4]; /* COLOR_0, 65535 = 1 */
} VertexColor;

typedef struct Triangle {
    uint32_t vertex[3]; /* counter-clockwise seen from the front (mirrored nodes included) */
    uint32_t part_id;
} Triangle;

/* One glTF primitive of one node. */
typedef struct Part {
    const char *name;                  /* the node's name, else the mesh's, else "node N" */
    const char *node_name, *mesh_name; /* "" where the file has none */
    int material_id;                   /* always valid: glTF's default material has an id too */
    uint32_t first_triangle, triangle_count;
    uint32_t first_vertex;
    /* Per vertex, from first_vertex on; arrays that nothing would read are NULL. */
    Vec3 *normals;           /* unit, world; outside kept outside under mirroring. NULL: flat */
    Tangent *tangents;       /* of the file, or of a texture's coordinates */
    Vec2 *uv[SCENE_UV_SETS]; /* NULL: all zero */
    VertexColor *colors;     /* NULL: white */
} Part;

/* A texture of a material: which one, with which coordinates. */
typedef struct TextureSlot {
    int texture_id;      /* NO_ID: none */
    int uv_set;          /* index into Part.uv: 0 or 1 */
    float uv_from_uv[6]; /* KHR_texture_transform: u' = a u + b v + c, v' = d u + e v + f */
} TextureSlot;

static inline Vec2 slot_from_uv(const TextureSlot *slot, Vec2 uv) {
    const float *m = slot->uv_from_uv;
    return (Vec2){m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
}

/* The largest coordinate, in metres, of all that is shown, sees or shines: beyond 4e9 squares
 * of triangles' areas overflow, and light is silently lost; beyond 1.8e18 Embree takes no
 * ray. */
#define SCENE_MOST_M 1e9f

/* The most that a scene may have shine on it: above it samples would overflow. */
#define SCENE_MOST_CD_M2 1e12
#define SCENE_MOST_LX 1e9
#define SCENE_MOST_W_M2 1e7

typedef enum AlphaMode { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND } AlphaMode;

/* KHR_materials_anisotropy: rougher along a direction of the tangent frame than across it. */
typedef struct Brushing {
    float strength;      /* (0, 1] */
    float turn;          /* radians, of the direction from the tangent */
    float cosine, sine;  /* of that */
    TextureSlot texture; /* RG direction, B strength */
} Brushing;

/* KHR_materials_iridescence: a thin clear film. */
typedef struct MaterialFilm {
    float share;                   /* (0, 1] */
    float ior;                     /* 1 or more */
    float least_nm, most_nm;       /* most_nm where there is no texture of the thickness */
    TextureSlot texture;           /* R: share */
    TextureSlot thickness_texture; /* G: from least_nm to most_nm */
} MaterialFilm;

/* KHR_materials_sheen: fibres of cloth, which scatter light over the base. */
typedef struct MaterialOverlay {
    float color[3];                               /* linear Rec.709, [0, 1], not all 0 */
    float roughness;                              /* [0, 1] */
    TextureSlot color_texture, roughness_texture; /* RGB; A */
} MaterialOverlay;

typedef struct Material {
    const char *name;       /* "material N" where the file has none */
    const char *guessed_as; /* the usual material that `equip` put here; NULL: the file's own */
    float base_color[4];
    TextureSlot base_color_texture;
    float metallic, roughness;              /* roughness: glTF's; GGX alpha is its square */
    TextureSlot metallic_roughness_texture; /* G roughness, B metallic */
    TextureSlot normal_texture;
    Vec2 normal_scale;       /* along the tangent and the bitangent */
    float emissive_cd_m2[3]; /* factor * KHR_materials_emissive_strength, linear Rec.709 */
    TextureSlot emissive_texture;
    AlphaMode alpha_mode; /* OPAQUE also where the file states another but alpha is always 1 */
    float alpha_cutoff;
    bool double_sided; /* decides only whether the back emits */
    bool unlit;        /* shows base colour as cd/m2, scatters nothing */
    float ior;
    float specular;
    TextureSlot specular_texture; /* A */
    float specular_color[3];
    TextureSlot specular_color_texture;
    float transmission;
    TextureSlot transmission_texture; /* R */
    float diffuse_transmission;
    TextureSlot diffuse_transmission_texture; /* A */
    float diffuse_transmission_color[3];
    TextureSlot diffuse_transmission_color_texture;
    float clearcoat;
    TextureSlot clearcoat_texture; /* R */
    float clearcoat_roughness;
    TextureSlot clearcoat_roughness_texture; /* G */
    TextureSlot clearcoat_normal_texture;
    Vec2 clearcoat_normal_scale;
    bool is_solid;              /* KHR_materials_volume with thickness > 0: refracts where there
                                   is transmission, or light goes in and out diffusely */
    float attenuation_color[3]; /* after attenuation_distance_m (infinite: none) */
    float attenuation_distance_m;
    Brushing *brushing;       /* NULL: none */
    MaterialFilm *film;       /* NULL: none */
    MaterialOverlay *overlay; /* NULL: none */
    int display_id;           /* NO_ID unless PARHELION_display */
    const Glazing *glazing;   /* NULL unless PARHELION_glazing */
    int base_color_curve_id, specular_curve_id, transmission_curve_id, emission_curve_id;
    const LayerStack *coating;         /* PARHELION_coating; NULL: none */
    const OpticalConstants *conductor; /* of the metal share; NULL: by its base colour */
    const Curve *index;      /* of a solid, in place of ior; NULL: ior at all wavelengths */
    bool is_emitter;         /* some of its surface may emit */
    bool lets_light_through; /* alpha below 1 or a thin window: shadow rays must test it */
} Material;

/* A rough surface in place of a display's clear one, modelled (shaders/display.c). */
typedef struct DisplayFinish {
    float matte; /* share of the mirror that it scatters, [0, 1]; 0: none */
    float alpha; /* GGX, of its facets */
} DisplayFinish;

typedef struct Display {
    const char *name;       /* the material's */
    const char *panel_path; /* resolved path */
    const Panel *panel;
    int material_id;
    TextureSlot content; /* NO_ID: full white is shown, with a warning */
    float level;         /* multiplies all emission, >= 0 */
    bool any_size;       /* however large it is: it is meant (check/display_frame.h) */
    DisplayFinish finish;
    float place_from_uv[4];     /* of a panel that varies or has zones: a place of its active area
                                   (panel_place.h) is {u [0] + [1], v [2] + [3]} of the content's */
    const Backlight *backlight; /* of a panel with local dimming, for the content (places as
                                   above); NULL: it is full everywhere */
} Display;

typedef enum LightKind { LIGHT_POINT, LIGHT_SPOT, LIGHT_DIRECTIONAL, LIGHT_LUMINAIRE } LightKind;

/* KHR_lights_punctual, and luminaires of photometric files (--light, EXT_lights_ies). */
typedef struct PunctualLight {
    const char *name;
    LightKind kind;
    Vec3 position;              /* m */
    Vec3 direction;             /* unit: where the light goes to (the node's -Z) */
    float intensity[3];         /* linear Rec.709: cd (point, spot) or lx facing it (directional) */
    float cos_inner, cos_outer; /* spot */
    const IntensityWeb *web;    /* luminaire: `intensity` is its largest */
    Vec3 axis_x, axis_y, axis_z;  /* luminaire: its frame, unit, world; mirrored as its node */
    LuminousOpening opening;      /* luminaire: about `position`, in that frame */
    const char *node_name, *file; /* luminaire */
    float level;                  /* luminaire: multiplies all intensities */
    bool has_tilt;                /* luminaire: its file has factors for tilted lamps */
    float tilt_factor, tilt_deg;  /* luminaire: multiplies too; the tilt that it is for */
    float color[3];               /* luminaire: linear Rec.709, multiplies too */
    float cct_k;                  /* luminaire: 0: white (D65) */
    const char *cct_text;         /* luminaire: its file's text about cct_k, understood if > 0;
                                     "": it has none; NULL: from --light-cct */
    const Curve *white;           /* of cct_k, 1 cd m^-2; NULL: D65 */
} PunctualLight;

typedef struct SceneCamera {
    const char *node_name, *camera_name; /* "" where the file has none */
    bool is_perspective;                 /* rays from one point */
    Fisheye fisheye;             /* not a file's, but a command's: half the space instead of yfov */
    float yfov;                  /* radians, full vertical angle (perspective) */
    float ymag;                  /* m, half the height (orthographic) */
    float aspect;                /* width / height, 0 where the file has none */
    float znear, zfar;           /* m; zfar may be infinite; recorded, not used for clipping */
    Transform world_from_camera; /* unit axes; looks along -Z, +Y up */
} SceneCamera;

typedef enum EnvironmentKind {
    ENVIRONMENT_NONE,
    ENVIRONMENT_CONSTANT,
    ENVIRONMENT_HDRI,
    ENVIRONMENT_CIE,
    ENVIRONMENT_PEREZ,
    ENVIRONMENT_SKY
} EnvironmentKind;

/* A row of a weather file and how it was found; line 0: no weather file. */
typedef struct EnvironmentWeather {
    const char *file;
    int line, month, day;
    double label_h;     /* end of the row's hour, hours after midnight */
    double apart_min;   /* from the moment requested to the row's instant */
    double file_lux[2]; /* the file's own direct and diffuse columns; negative: missing */
    WeatherClock clock;
} EnvironmentWeather;

/* An animation of a file, whether it is played or not. */
typedef struct SceneAnimation {
    const char *name; /* "animation N" where the file has none */
    double end_s;     /* of its last key frame */
} SceneAnimation;

#define SUN_MEAN_RADIUS_DEG 0.26645 /* half the sun's mean angular diameter */

/* PARHELION_environment. Angles in radians here. */
typedef struct Environment {
    EnvironmentKind kind;
    float luminance_cd_m2; /* constant */
    float color[3];        /* constant: linear Rec.709, its luminance scaled to 1 */
    const char *hdri_path; /* hdri: resolved path */
    Image hdri;            /* RGBA32F; cd/m2 after scale (image/light/light_picture.h) */
    float hdri_rotation;
    double hdri_unit_cd_m2; /* luminance of a white whose stored values are 1 */
    float hdri_scale;
    float horizontal_illuminance_lx; /* hdri: required instead of scale; 0 = use scale */
    DaylightInput daylight;          /* cie, perez, sky: all but the sun below */
    EnvironmentWeather weather;      /* perez: where its irradiances came from */
    bool has_sun;
    float sun_azimuth; /* from north over east */
    float sun_elevation;
    float sun_illuminance_lx; /* direct normal */
    float sun_angular_radius; /* radians; default SUN_MEAN_RADIUS_DEG */
    float heading;            /* compass heading of `forward` */
    Vec3 forward;             /* scene vector, default (0,0,-1) */
} Environment;

typedef struct Scene {
    double origin[3]; /* m: where the scene's coordinates begin in the world: 0 unless the
                         scene stands far off (load/scene_origin.h) */
    Vec3 *positions;  /* m; of all vertices. Shared with the ray tracer, which reads
                         past the last: there is room for one more */
    uint32_t vertex_count;
    Triangle *triangles; /* opaque ones first: [0, opaque_count) need no test */
    uint32_t triangle_count, opaque_count;
    Part *parts;
    int part_count;
    Material *materials;
    int material_count;
    Texture *textures;
    int texture_count;
    Display *displays;
    int display_count;
    PunctualLight *lights;
    int light_count;
    SceneCamera *cameras; /* in scene order of their nodes */
    int camera_count;
    Curve *curves;
    int curve_count;
    Environment environment;
    Vec3 bounds_min, bounds_max; /* of all triangles; min > max when there are none */
    float longest_edge_m;        /* of all triangles */
    const char **inputs;         /* every file that was read, for hashes in the frame */
    uint64_t *input_hashes;      /* XXH3 64 of each */
    int input_count;
    const char **undecoded; /* those that are no picture, although named as one */
    int undecoded_count;
    const char **extensions; /* every extensionsUsed, sorted, once each */
    int extension_count;
    const char **variants; /* names of KHR_materials_variants, of all files, in their order */
    int variant_count;
    SceneAnimation *animations;
    int animation_count;
    int ignored_occlusion_count; /* materials whose occlusion texture is ignored, since
                                    occlusion is what tracing itself finds */
} Scene;

typedef struct SceneOverride {
    const char *material; /* a material's name */
    const char *value;    /* a path, or a number's text */
    const char *said;     /* what messages call it; NULL: by its option */
} SceneOverride;

/* Which of the things that its files can be a scene is. */
typedef struct SceneState {
    const char *const *variants; /* --variant NAME: at most one of a file */
    int variant_count;
    bool has_time;                 /* --time; without it nothing is animated: the pose at rest */
    double time_s;                 /* since the animations' start */
    const char *const *animations; /* --animation NAME; none: all there are */
    int animation_count;
} SceneState;

/* Kinds of change that are tried out on a scene whose files stay as they are. */
typedef enum SceneChangeKind {
    CHANGE_NODES,
    CHANGE_MATERIAL,
    CHANGE_HOOD,
    CHANGE_MIRROR,
    CHANGE_FINISH
} SceneChangeKind;

/* An axis that nodes turn about, as a door about its hinges. */
typedef struct SceneHinge {
    float axis[3];       /* unit, world; none: all 0 */
    double through_m[3]; /* a point of it, world */
    bool is_own;         /* it goes through the named node's origin instead */
    float angle;         /* radians, anticlockwise as seen against the axis */
} SceneHinge;

typedef struct SceneChange {
    const char *name; /* of a node, a material; hood, finish: of a display (its material
                         or node:NAME) */
    SceneChangeKind kind;
    const char *const *with; /* nodes: more of the same file, which move along */
    int with_count;
    float tilt, turn, roll;   /* nodes: radians, about the middle of the named one's surface
                                 (change/node_change.h) */
    SceneHinge hinge;         /* nodes: after those turns */
    float move_m[3];          /* nodes: world, after all turns */
    float ahead[3];           /* nodes, mirror: where the vehicle points, world, not vertical */
    float middle_m;           /* mirror: its plane, along the vehicle's right from the origin;
                                 after all other changes, all files (change/mirror_change.h) */
    const char *patch;        /* material: JSON, merged into it (change/material_change.h) */
    DisplayFinish finish;     /* finish */
    float depth_m;            /* hood: how far it reaches out (load/hood.h); above 0 */
    const char *file, *place; /* where it stands, for messages */
} SceneChange;

/* Which files make the scene, and what the command line overrides. */
typedef struct SceneOptions {
    const char *const *paths; /* .gltf or .glb; the first holds the dashboard */
    int path_count;
    const char *written; /* the first one's JSON, where the program wrote it; else NULL */
    const char *root;    /* --root: a folder whose files they may name besides those of their own
                            folder's parent; NULL: none */
    bool own_folder;     /* somebody else's: not the parent, the folder alone */
    const SceneOverride *contents; /* --content MATERIAL=IMAGE */
    int content_count;
    const SceneOverride *panels; /* --panel MATERIAL=FILE.panel */
    int panel_count;
    const SceneOverride *levels; /* --display-level MATERIAL=PERCENT, * for all */
    int level_count;
    const SceneOverride *lights; /* --light NODE=FILE.ies; `material` is a node's name */
    int light_count;
    const SceneOverride *light_levels; /* --light-level NODE=PERCENT, * for all */
    int light_level_count;
    const SceneOverride *light_ccts; /* --light-cct NODE=KELVIN, * for all */
    int light_cct_count;
    const SceneChange *changes;
    int change_count;
    SceneState state;
} SceneOptions;

/* A position of the world's, m; origin_m: the scene's. */
static inline Vec3 scene_from_world(const double origin_m[3], const double world_m[3]) {
    return vec3((float)(world_m[0] - origin_m[0]), (float)(world_m[1] - origin_m[1]),
                (float)(world_m[2] - origin_m[2]));
}

/* Where it is in the world, m. */
static inline void world_from_scene(const double origin_m[3], Vec3 p, double world_m[3]) {
    world_m[0] = origin_m[0] + (double)p.x;
    world_m[1] = origin_m[1] + (double)p.y;
    world_m[2] = origin_m[2] + (double)p.z;
}

/* Light on one side is seen from the other. */
static inline bool material_sends_through(const Material *m) {
    return m->transmission > 0 || m->diffuse_transmission > 0;
}

/* A solid that light enters diffusely. */
static inline bool material_is_translucent_solid(const Material *m) {
    return m->is_solid && m->diffuse_transmission > 0 && !(m->transmission > 0);
}

/* The clear coat counts: solids that refract, panes and what is unlit have none, and a panel
 * was measured with all that lies on it. */
static inline bool material_shows_coat(const Material *m) {
    bool is_other = m->unlit || m->glazing || m->display_id != NO_ID;
    return m->clearcoat > 0 && !is_other && !(m->is_solid && m->transmission > 0);
}

/* Corner 0..2 of a triangle, m. */
static inline Vec3 scene_corner(const Scene *scene, uint32_t triangle, int corner) {
    return scene->positions[scene->triangles[triangle].vertex[corner]];
}

static inline double scene_triangle_m2(const Scene *scene, uint32_t triangle) {
    Vec3 a = scene_corner(scene, triangle, 0);
    Vec3 twice = vec3_cross(vec3_sub(scene_corner(scene, triangle, 1), a),
                            vec3_sub(scene_corner(scene, triangle, 2), a));
    return 0.5 * (double)vec3_length(twice);
}

/* The box about a part. */
static inline void scene_part_box(const Scene *scene, const Part *part, Vec3 *low, Vec3 *high) {
    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec3_neg(*low);
    for (uint32_t i = 0; i < 3 * part->triangle_count; i++) {
        Vec3 p = scene_corner(scene, part->first_triangle + i / 3, (int)(i % 3));
        *low = vec3(fminf(low->x, p.x), fminf(low->y, p.y), fminf(low->z, p.z));
        *high = vec3(fmaxf(high->x, p.x), fmaxf(high->y, p.y), fmaxf(high->z, p.z));
    }
}

/* The longest edge of that box, m. */
static inline float scene_part_longest_m(const Scene *scene, const Part *part) {
    Vec3 low, high;
    scene_part_box(scene, part, &low, &high);
    Vec3 size = vec3_sub(high, low);
    return fmaxf(fmaxf(size.x, size.y), size.z);
}

static inline const Part *scene_part(const Scene *scene, uint32_t triangle) {
    return &scene->parts[scene->triangles[triangle].part_id];
}

/* Place of a triangle's corner in its part's arrays. */
static inline uint32_t scene_corner_place(const Scene *scene, uint32_t triangle, int corner) {
    const Triangle *t = &scene->triangles[triangle];
    return t->vertex[corner] - scene->parts[t->part_id].first_vertex;
}

/* Texture coordinates of a corner. */
static inline Vec2 scene_corner_uv(const Scene *scene, uint32_t triangle, int corner, int set) {
    const Vec2 *uv = scene_part(scene, triangle)->uv[set];
    return uv ? uv[scene_corner_place(scene, triangle, corner)] : (Vec2){0, 0};
}
