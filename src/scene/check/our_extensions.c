/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/our_extensions.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "scene/check/check_document.h"
#include "scene/check/check_material.h"
#include "scene/check/check_optics.h"
#include "scene/check/material_layers.h"
#include "spectrum/curve.h"
#include "spectrum/glazing.h"
#include "spectrum/thin_film.h"

/* Nothing is kept of it. */
static bool leave(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    (void)view, (void)row, (void)item, (void)err;
    return true;
}

#define MUST RECORD_REQUIRED
#define ROW(key, kind, flag, words, ...) {key, kind, flag, .read = leave, .doc = words, __VA_ARGS__}
#define NUMBER(key, flag, bottom, top, words) \
    ROW(key, RECORD_NUMBER, flag, words, RECORD_RANGE(bottom, top))
#define WHOLE(key, bottom, top, words) ROW(key, RECORD_INTEGER, 0, words, RECORD_RANGE(bottom, top))
#define NUMBERS(key, fewest, greatest, bottom, words) \
    ROW(key, RECORD_NUMBERS, 0, words, RECORD_RANGE(bottom, HUGE_VAL), \
        RECORD_COUNT(fewest, greatest))
#define FLAG(key, words) ROW(key, RECORD_FLAG, 0, words, .of = NULL)
#define TEXT(key, words) ROW(key, RECORD_TEXT, 0, words, .of = NULL)
#define A_FILE(key, words) ROW(key, RECORD_FILE, 0, words, .of = NULL)
#define CHOICE(key, flag, list, meaning) ROW(key, RECORD_CHOICE, flag, meaning, .words = list)
#define EITHER(key, flag, list, words) ROW(key, RECORD_EITHER, flag, words, .forms = list)
#define OBJECT(key, format, words) ROW(key, RECORD_OBJECT, 0, words, .of = &format)
#define LIST(key, flag, fewest, greatest, format, words) \
    ROW(key, RECORD_LIST, flag, words, .of = &format, RECORD_COUNT(fewest, greatest))
/* Of every object of glTF. */
#define COMMON \
    ROW("extensions", RECORD_OWN, 0, NULL, .schema = "{'type': 'object'}"), \
        ROW("extras", RECORD_OWN, 0, NULL, .schema = "{}"), {0}

/* ---- displays ---------------------------------------------------------------------------- */

static const RecordRow TEXTURE_INFO[] = {
    ROW("index", RECORD_INTEGER, MUST, "Of the texture.", RECORD_RANGE(0, HUGE_VAL)),
    WHOLE("texCoord", 0, HUGE_VAL, "Which TEXCOORD; 0 unless given."), COMMON};
static const RecordFormat texture_info = {"textureInfo", 1, TEXTURE_INFO, .doc = NULL};

static const RecordRow DISPLAY[] = {
    A_FILE("panel", "The fitted panel file, relative to the glTF. Required unless the command "
                    "line names one."),
    OBJECT("content", texture_info,
           "What the display shows: code values as the panel receives them, looked up nearest, "
           "alpha ignored. Without it the display shows full white."),
    NUMBER("level", 0, 0, HUGE_VAL,
           "Backlight or dimming factor; multiplies all emission, black included. 1, unless "
           "given, is as measured; above it only up to max_level."),
    NUMBER("max_level", 0, 1, 100,
           "How far the panel can be driven, in times of what was measured: a level above 1 "
           "has to say so."),
    FLAG("any_size",
         "A width or height outside 5 mm to 1.5 m, or a shape that is not its content's, is "
         "meant."),
    COMMON};
const RecordFormat display_extension = {
    "PARHELION_display", 1, DISPLAY,
    .rules = "{'allOf': [{'properties': {'level': {'maximum': 100}}}], "
             "'if': {'not': {'required': ['max_level']}}, "
             "'then': {'properties': {'level': {'maximum': 1}}}}",
    .doc = "The material is a measured display: it emits and reflects on its front only, as "
           "its panel file says; its back is black, whatever doubleSided says. Replaces the "
           "material's scattering and emission; the core properties beside it are what other "
           "viewers show."};

/* ---- environments ------------------------------------------------------------------------ */

static const RecordRow SUN[] = {
    NUMBER("azimuth_deg", MUST, -360, 360, "From north over east, degrees."),
    NUMBER("elevation_deg", MUST, -90, 90, "Above the horizon, degrees."),
    NUMBER("illuminance_lx", MUST, 0, SCENE_MOST_LX, "Direct normal illuminance, lux."),
    NUMBER("angular_radius_deg", RECORD_ABOVE, 0, 45,
           "Angular radius of the disc, degrees; 0.26645 unless given."),
    COMMON};
static const RecordFormat sun = {"sun", 1, SUN, .doc = NULL};

static const char *const TYPES[] = {"constant", "hdri", "cie", "perez", "sky", NULL};
static const char *const GROUNDS[] = {"land", "sea", "cloud", NULL};
static const RecordRow ENVIRONMENT[] = {
    CHOICE("type", MUST, TYPES, NULL),
    NUMBER("heading_deg", 0, -360, 360,
           "Compass heading of the vehicle, degrees; the sky turns, the scene stays."),
    NUMBERS("forward", 3, 3, -HUGE_VAL,
            "The scene direction that the vehicle points to; 0, 0, -1 unless given."),
    OBJECT("sun", sun, "May stand beside any type of environment."),
    NUMBER("luminance", 0, 0, SCENE_MOST_CD_M2, "constant: cd/m2."),
    NUMBERS("color", 3, 3, 0,
            "constant: linear Rec.709 hue, white unless given; its luminance is divided out."),
    A_FILE("uri", "hdri: equirectangular picture of floats (EXR, HDR) relative to the glTF; "
                  "cd/m2 times scale (Radiance HDR: W/m2/sr, times 179 lm/W; OpenEXR: times "
                  "its whiteLuminance). Its centre is +Z with +X to its left."),
    NUMBER("rotation_deg", 0, -360, 360, "hdri: added to the azimuth, degrees."),
    NUMBER("scale", 0, 0, SCENE_MOST_CD_M2, "hdri: multiplies the picture's cd/m2."),
    NUMBER("horizontal_illuminance_lx", RECORD_ABOVE, 0, SCENE_MOST_LX,
           "hdri: instead of scale: the illuminance wanted on a horizontal plane, lux."),
    WHOLE("sky", 1, 15, "cie: number of the CIE standard general sky (ISO 15469)."),
    NUMBER("diffuse_horizontal_lx", 0, 0, SCENE_MOST_LX,
           "cie: illuminance by the sky alone on a horizontal plane, lux."),
    NUMBER("direct_normal_w_m2", 0, 0, SCENE_MOST_W_M2,
           "perez: direct normal irradiance, W/m2; of the sun's light where `sun` gives it no "
           "illuminance_lx of its own, and of the sky's shape."),
    NUMBER("diffuse_horizontal_w_m2", 0, 0, SCENE_MOST_W_M2,
           "perez: diffuse horizontal irradiance, W/m2."),
    TEXT("when", "perez, sky: ISO 8601 date and time with its offset from UTC."),
    NUMBERS("where", 2, 3, -HUGE_VAL,
            "perez, sky: latitude (degrees north), longitude (degrees east), altitude (m)."),
    NUMBER("turbidity", 0, 1, 30, "sky."),
    NUMBER("visibility_km", RECORD_ABOVE, 0, HUGE_VAL,
           "sky: meteorological visibility, km; instead of turbidity."),
    NUMBER("ozone_atm_cm", 0, 0, 2, "sky: ozone column, atm cm."),
    NUMBER("water_cm", 0, 0, 20,
           "sky, perez: precipitable water, cm; without it 1.4 for the sky, 2 for the luminous "
           "efficacies of perez."),
    NUMBER("albedo", 0, 0, 1, "sky: albedo of the ground."),
    CHOICE("ground", 0, GROUNDS, NULL),
    NUMBER("cloud_top_m", 0, 0, HUGE_VAL, "sky: height of the cloud deck below, m."),
    NUMBER("cloud_relief_m", 0, 0, 1000,
           "sky over cloud: height of the deck's billows from hollows to tops, m; 0, an even "
           "deck, unless given. It is synthetic and for pictures, no measured weather; the "
           "deck's mean light stays."),
    FLAG("moon", "sky: whether its nights have a moon; true unless given."),
    COMMON};

/* What a type must have. */
#define TYPE(name, rules) \
    "{'if': {'properties': {'type': {'const': '" name "'}}}, 'then': " rules "}"
#define SUN_OR_TIME "'anyOf': [{'required': ['when', 'where']}, {'required': ['sun']}]"
const RecordFormat environment_extension = {
    "PARHELION_environment", 1, ENVIRONMENT,
    .rules = "{'not': {'required': ['scale', 'horizontal_illuminance_lx']}, 'allOf': [" TYPE("constant", "{'required': ['luminance']}") ", " TYPE(
        "hdri",
        "{'required': ['uri']}") ", " TYPE("cie",
                                           "{'required': ['sky', 'diffuse_horizontal_lx']}") ", " TYPE("perez",
                                                                                                       "{'required': ['direct_normal_w_m2', 'diffuse_horizontal_w_m2'], " SUN_OR_TIME
                                                                                                       "}") ", " TYPE("sky",
                                                                                                                      "{" SUN_OR_TIME
                                                                                                                      "}") "]}",
    .doc = "The light from outside: a uniform, pictured, standard or modelled sky, and the "
           "sun."};

/* ---- spectra ----------------------------------------------------------------------------- */

static const RecordRow SPECTRUM[] = {
    A_FILE("baseColor", "Reflectance, 0 to 1; replaces the colour of baseColorFactor and its "
                        "texture."),
    A_FILE("transmission", "Transmittance, 0 to 1."),
    A_FILE("specular", "Replaces specularColorFactor."),
    A_FILE("conductor", "Rows nm,n,k: the metal share reflects by them at every angle, in "
                        "place of its base colour."),
    A_FILE("emission", "Relative spectral radiance: the colour of the light; emissiveFactor "
                       "times emissiveStrength tells how much, cd/m2."),
    COMMON};
const RecordFormat spectrum_extension = {
    "PARHELION_spectrum", 1, SPECTRUM,
    .doc = "Measured spectra instead of RGB. Each is a CSV file of nm,value rows (conductor: "
           "nm,n,k) relative to the glTF."};

/* ---- thin layers ------------------------------------------------------------------------- */

static const RecordRow INDEX_FORMS[] = {
    ROW("a number", RECORD_NUMBER, 0, NULL, RECORD_RANGE(0, INDEX_MAX)),
    A_FILE("a file", "A CSV file of rows nm,n,k relative to the glTF."),
    {0}};
static const RecordRow THIN_LAYER[] = {
    EITHER("n", MUST, INDEX_FORMS, "Index of refraction."),
    EITHER("k", 0, INDEX_FORMS, "Absorption; without it that of n's file, or 0."),
    NUMBER("thickness_nm", MUST, 0, 1e6, NULL), COMMON};
static const RecordFormat thin_layer = {"layer", 1, THIN_LAYER, .doc = NULL};

static const char *const FACES[] = {"both", "front", "back", NULL};
static const RecordRow COATING[] = {
    LIST("layers", 0, 0, 0, thin_layer, "From outside inwards."),
    TEXT("stack", "A stack that the program carries (assets/coatings): bare, mgf2, "
                  "broadband_ar, ir_windscreen."),
    NUMBER("outside", 0, 1, 10, "Index of the medium in front; 1 unless given."),
    CHOICE("faces", 0, FACES,
           "Of a thin sheet: which carry it, both unless given; the front "
           "is where its normals point."),
    COMMON};
const RecordFormat coating_extension = {
    "PARHELION_coating", 1, COATING,
    .rules = "{'oneOf': [{'required': ['layers']}, {'required': ['stack']}], "
             "'allOf': [{'properties': {'layers': {'maxItems': 64}}}]}",
    .doc = "Thin layers on glass, metal, plastic or a display's cover, by their own "
           "interference."};
_Static_assert(THIN_LAYERS_MAX == 64, "as in the rules");

/* ---- panes ------------------------------------------------------------------------------- */

static const RecordRow TRANSMISSIONS[] = {
    ROW("a number", RECORD_NUMBER, 0, NULL, RECORD_RANGE(0, 1)),
    A_FILE("a file", "A CSV file of nm,value rows."),
    {0}};
static const char *const SIDES[] = {"+u", "-u", "+v", "-v", NULL};
static const RecordRow LAYER[] = {
    NUMBER("thickness_m", MUST | RECORD_ABOVE, 0, 0.1, NULL),
    NUMBER("ior", MUST, 1, 4, "Index of refraction."),
    EITHER("transmission", 0, TRANSMISSIONS,
           "Share of the light that the layer lets through along its normal, without faces; 1 "
           "unless given."),
    NUMBER("wedge_rad", 0, 0, 0.01, "Growth of the thickness per length."),
    CHOICE("wedge_toward", 0, SIDES, "Where it grows, by TEXCOORD_0; with wedge_rad."),
    COMMON};
static const RecordFormat layer = {
    "layer", 1, LAYER,
    .rules = "{'if': {'properties': {'wedge_rad': {'exclusiveMinimum': 0}}, 'required': "
             "['wedge_rad']}, 'then': {'required': ['wedge_toward']}}"};

static const RecordRow HAZE[] = {
    NUMBER("share", MUST, 0, 1, "Of the light that passes."),
    NUMBER("width_deg", MUST, 0.1, 60, "Half of it goes within this angle of the straight way."),
    COMMON};
static const RecordFormat haze = {"haze", 1, HAZE, .doc = NULL};

static const RecordRow GLAZING[] = {
    LIST("layers", MUST, 1, GLAZING_LAYERS_MAX, layer,
         "The first lies on the triangles' front. At most one has a wedge."),
    OBJECT("haze", haze, "What dirt and scratches scatter forward."),
    OBJECT("coating_outside", coating_extension,
           "Thin layers on the face of the first of layers: the triangles' front."),
    OBJECT("coating_inside", coating_extension,
           "Thin layers on the face of the last of layers: the triangles' back."),
    COMMON};
#define IN_AIR "{'properties': {'outside': {'const': 1}, 'faces': false}}"
const RecordFormat glazing_extension = {"PARHELION_glazing", 1, GLAZING,
                                        .rules =
                                            "{'allOf': [{'properties': {'coating_outside': " IN_AIR
                                            ", 'coating_inside': " IN_AIR "}}]}",
                                        .doc = "A laminated pane on a mesh that is one sheet."};

/* ---- for the check ----------------------------------------------------------------------- */

const Schema our_schemas[] = {
    [OUR_DISPLAY] = {"PARHELION_display", true, check_display, .format = &display_extension},
    [OUR_ENVIRONMENT] = {"PARHELION_environment", true, check_environment,
                         .format = &environment_extension},
    [OUR_SPECTRUM] = {"PARHELION_spectrum", true, .format = &spectrum_extension},
    [OUR_COATING] = {"PARHELION_coating", true, check_coating, .format = &coating_extension},
    [OUR_GLAZING] = {"PARHELION_glazing", true, check_glazing, .format = &glazing_extension},
    {"sun", true, .format = &sun},
    {"layer", true, check_layer, .format = &thin_layer},
    {"layer", true, check_glazing_layer, .format = &layer},
    {"haze", true, .format = &haze},
};

const Schema *our_schema(const RecordFormat *format) {
    for (int i = 0; i < COUNT_OF(our_schemas); i++)
        if (our_schemas[i].format == format) return &our_schemas[i];
    return &SCHEMA_TEXTURE_INFO;
}
