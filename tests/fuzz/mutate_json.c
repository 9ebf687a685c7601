/* SPDX-License-Identifier: Apache-2.0 */
/* Mutations of JSON text that leave it JSON: values replaced, removed, doubled and exchanged,
 * numbers made extreme, names taken from elsewhere, and the bytes inside data URIs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness.h"

enum { VALUES_MAX = 2048, DEPTH_MAX = 100, TEXT_MAX = 1 << 15 };

typedef struct Span {
    int begin, end;
    int name; /* where the member's name begins, -1 in an array */
} Span;

typedef struct Json {
    char text[TEXT_MAX + 1];
    int size, room; /* the text may grow up to room */
    Span value[VALUES_MAX];
    int count;
    uint64_t state;
} Json;

/* ---- where the values are ---------------------------------------------------------------- */

static int skip_blanks(const Json *json, int at) {
    while (at < json->size && strchr(" \t\r\n", json->text[at]) && json->text[at]) at++;
    return at;
}

/* Behind a text; -1 when it does not end. */
static int skip_text(const Json *json, int at) {
    for (at++; at < json->size && json->text[at] != '"'; at++)
        if (json->text[at] == '\\') at++;
    return at < json->size ? at + 1 : -1;
}

static int find_values(Json *json, int at, int name, int depth);

/* Members or items up to the closing bracket. */
static int find_items(Json *json, int at, int depth) {
    bool is_object = json->text[at] == '{';
    char close = is_object ? '}' : ']';
    at = skip_blanks(json, at + 1);
    while (at >= 0 && at < json->size && json->text[at] != close) {
        int name = -1;
        if (is_object) {
            if (json->text[at] != '"') return -1;
            name = at;
            at = skip_text(json, at);
            at = at < 0 ? -1 : skip_blanks(json, at);
            if (at < 0 || at >= json->size || json->text[at] != ':') return -1;
            at = skip_blanks(json, at + 1);
        }
        at = find_values(json, at, name, depth + 1);
        if (at < 0) return -1;
        at = skip_blanks(json, at);
        if (at < json->size && json->text[at] == ',') at = skip_blanks(json, at + 1);
    }
    return at >= 0 && at < json->size ? at + 1 : -1;
}

/* Notes the value at a place and those inside it; returns the place behind it, -1 where the
 * text is not JSON. */
static int find_values(Json *json, int at, int name, int depth) {
    if (depth > DEPTH_MAX || json->count == VALUES_MAX || at >= json->size) return -1;
    int index = json->count++, end = at;
    if (json->text[at] == '{' || json->text[at] == '[') end = find_items(json, at, depth);
    else if (json->text[at] == '"') end = skip_text(json, at);
    else
        while (end < json->size && !strchr(",]} \t\r\n\"", json->text[end])) end++;
    if (end <= at) return -1;
    json->value[index] = (Span){at, end, name};
    return end;
}

static bool find_all(Json *json) {
    json->count = 0;
    return find_values(json, skip_blanks(json, 0), -1, 0) >= 0;
}

/* ---- changes ----------------------------------------------------------------------------- */

static int below(Json *json, int count) {
    return (int)(fuzz_random(&json->state) % (unsigned)count);
}

/* Puts a text in place of [begin, end); nothing happens when it does not fit. */
static void splice(Json *json, int begin, int end, const char *with, int length) {
    static char kept[TEXT_MAX];
    int rest = json->size - end;
    if (begin + length + rest > json->room || length > TEXT_MAX) return;
    memcpy(kept, with, (size_t)length);
    memmove(json->text + begin + length, json->text + end, (size_t)rest);
    memcpy(json->text + begin, kept, (size_t)length);
    json->size = begin + length + rest;
    json->text[json->size] = 0;
}

static const char *const strange[] = {
    "-1",
    "0",
    "1",
    "2",
    "3",
    "7",
    "16",
    "255",
    "256",
    "5120",
    "5121",
    "5123",
    "5125",
    "5126",
    "65535",
    "65536",
    "16777216",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "-9223372036854775808",
    "18446744073709551616",
    "1e300",
    "-1e300",
    "1e39",
    "3.5e38",
    "1e-40",
    "1e-320",
    "-0.0",
    "0.5",
    "-0.5",
    "1.0000001",
    "90",
    "360",
    "1e999",
    "\"\"",
    "\"x\"",
    "\"\\u0000\"",
    "\"\\ud800\"",
    "\"SCALAR\"",
    "\"VEC3\"",
    "\"MAT4\"",
    "null",
    "true",
    "false",
    "[]",
    "{}",
    "[[]]",
    "[0]",
    "[0,0,0]",
    "[1,0,0,0]",
    "[0,0,0,0]",
    "\"data:;base64,\"",
    "\"data:application/octet-stream;base64,AAAA\"",
    "\"../x\"",
    "\"NaN\"",
    "\"MASK\"",
    "\"BLEND\"",
    "\"red.csv\"",
    "\"i{incidence}.csv\"",
    "[[[[[[[[[[[[]]]]]]]]]]]]",
};

/* Names that this program's files have. */
static const char *const names[] = {
    "scene",
    "scenes",
    "nodes",
    "meshes",
    "primitives",
    "attributes",
    "POSITION",
    "NORMAL",
    "TANGENT",
    "TEXCOORD_0",
    "TEXCOORD_1",
    "COLOR_0",
    "JOINTS_0",
    "WEIGHTS_0",
    "indices",
    "mode",
    "material",
    "targets",
    "weights",
    "mesh",
    "skin",
    "skins",
    "joints",
    "inverseBindMatrices",
    "skeleton",
    "camera",
    "cameras",
    "perspective",
    "orthographic",
    "yfov",
    "znear",
    "zfar",
    "xmag",
    "ymag",
    "aspectRatio",
    "children",
    "matrix",
    "rotation",
    "scale",
    "translation",
    "buffers",
    "bufferViews",
    "buffer",
    "byteOffset",
    "byteLength",
    "byteStride",
    "target",
    "uri",
    "accessors",
    "bufferView",
    "componentType",
    "count",
    "type",
    "normalized",
    "min",
    "max",
    "sparse",
    "values",
    "images",
    "mimeType",
    "textures",
    "source",
    "sampler",
    "samplers",
    "wrapS",
    "wrapT",
    "magFilter",
    "minFilter",
    "materials",
    "index",
    "texCoord",
    "pbrMetallicRoughness",
    "baseColorFactor",
    "baseColorTexture",
    "metallicFactor",
    "roughnessFactor",
    "metallicRoughnessTexture",
    "normalTexture",
    "emissiveFactor",
    "emissiveTexture",
    "occlusionTexture",
    "alphaMode",
    "alphaCutoff",
    "doubleSided",
    "name",
    "extensions",
    "extras",
    "extensionsUsed",
    "extensionsRequired",
    "asset",
    "version",
    "animations",
    "channels",
    "path",
    "node",
    "input",
    "output",
    "interpolation",
    "KHR_materials_clearcoat",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_specular",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "EXT_lights_ies",
    "KHR_mesh_quantization",
    "PARHELION_display",
    "PARHELION_environment",
    "PARHELION_spectral",
    "light",
    "lights",
    "intensity",
    "color",
    "range",
    "spot",
    "innerConeAngle",
    "outerConeAngle",
    "panel",
    "content",
    "level",
    "sun",
    "luminance",
    "azimuth_deg",
    "elevation_deg",
    "illuminance_lx",
    "kind",
    "heading_deg",
    "forward",
    "when",
    "where",
    "emission",
    "reflection",
    "red",
    "green",
    "blue",
    "black",
    "white",
    "levels",
    "files",
    "spectra",
    "incidence_deg",
    "incidence_phi_deg",
    "wavelengths_nm",
    "instrument",
    "fwhm_deg",
    "pixels",
    "size_mm",
    "note",
    "peaks_nm",
    "fwhm_nm",
    "luminance_cd_m2",
    "shift",
    "gamma",
    "leak",
    "lobe",
    "coating",
    "haze_share",
    "haze_width",
    "haze_power",
    "floor_albedo",
    "theta_step_deg",
    "phi_step_deg",
    "noise_relative",
    "roles",
    "skip",
    "format",
    "area_mm",
    "primaries",
    "isotropic",
    "symmetry",
    "no_black",
    "accept",
    "backlight",
    "peaks_nm",
    "columns",
    "layout",
    "unit",
    "mask",
    "comment",
    "azimuth_zero",
    "azimuth_sense",
    "angles",
    "quantity",
};

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

static void put_strange(Json *json, Span at) {
    const char *text = strange[below(json, COUNT(strange))];
    splice(json, at.begin, at.end, text, (int)strlen(text));
}

static void put_other(Json *json, Span at) {
    Span other = json->value[below(json, json->count)];
    splice(json, at.begin, at.end, json->text + other.begin, other.end - other.begin);
}

/* With one comma, before it or behind it. */
static void take_out(Json *json, Span at) {
    int begin = at.name >= 0 ? at.name : at.begin, end = skip_blanks(json, at.end);
    if (end < json->size && json->text[end] == ',') end++;
    else {
        while (begin > 0 && strchr(" \t\r\n", json->text[begin - 1])) begin--;
        if (begin > 0 && json->text[begin - 1] == ',') begin--;
    }
    splice(json, begin, end, "", 0);
}

static void double_it(Json *json, Span at) {
    static char twice[TEXT_MAX];
    int begin = at.name >= 0 ? at.name : at.begin, length = at.end - begin;
    if (2 * length + 1 > TEXT_MAX) return;
    memcpy(twice, json->text + begin, (size_t)length);
    twice[length] = ',';
    memcpy(twice + length + 1, json->text + begin, (size_t)length);
    splice(json, begin, at.end, twice, 2 * length + 1);
}

static void change_number(Json *json, Span at) {
    static const double steps[] = {1, -1, 0.5, 1e-3, 4, -4, 100};
    char text[64], *end;
    double number = strtod(json->text + at.begin, &end);
    if (end == json->text + at.begin) {
        put_strange(json, at);
        return;
    }
    switch (below(json, 4)) {
    case 0: number += steps[below(json, COUNT(steps))]; break;
    case 1: number *= steps[below(json, COUNT(steps))] * 2; break;
    case 2: number = below(json, 8); break;
    default: number = -number; break;
    }
    splice(json, at.begin, at.end, text, snprintf(text, sizeof text, "%.9g", number));
}

static void change_name(Json *json, Span at) {
    char text[80];
    const char *name = names[below(json, COUNT(names))];
    int length = snprintf(text, sizeof text, "\"%s\"", name);
    if (at.name >= 0) splice(json, at.name, skip_text(json, at.name), text, length);
    else splice(json, at.begin, at.end, text, length);
}

/* A member or an item that was not there, at the beginning of an object or array. */
static void put_in(Json *json, Span at) {
    char text[256];
    const char *name = names[below(json, COUNT(names))];
    const char *value = strange[below(json, COUNT(strange))];
    bool is_object = json->text[at.begin] == '{';
    if (!is_object && json->text[at.begin] != '[') {
        put_strange(json, at);
        return;
    }
    int next = skip_blanks(json, at.begin + 1);
    const char *comma = json->text[next] == '}' || json->text[next] == ']' ? "" : ",";
    int length = is_object ? snprintf(text, sizeof text, "\"%s\":%s%s", name, value, comma)
                           : snprintf(text, sizeof text, "%s%s", value, comma);
    splice(json, at.begin + 1, at.begin + 1, text, length);
}

/* ---- texts and the bytes of data URIs ---------------------------------------------------- */

static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static int bytes_of_base64(const char *text, int length, uint8_t *bytes) {
    uint32_t word = 0;
    int count = 0, have = 0;
    for (int i = 0; i < length && text[i] != '='; i++) {
        const char *digit = strchr(digits, text[i]);
        if (!digit || !text[i]) break;
        word = word << 6 | (uint32_t)(digit - digits);
        if (++have % 4 == 0)
            for (int k = 16; k >= 0; k -= 8) bytes[count++] = (uint8_t)(word >> k);
    }
    return count;
}

static int base64_of_bytes(const uint8_t *bytes, int count, char *text) {
    int length = 0;
    for (int i = 0; i < count; i += 3) {
        uint32_t word = 0;
        for (int k = 0; k < 3; k++) word = word << 8 | (i + k < count ? bytes[i + k] : 0);
        for (int k = 0; k < 4; k++) text[length++] = digits[word >> (18 - 6 * k) & 63];
        for (int k = count - i; k < 3; k++) text[length - 3 + k] = '=';
    }
    return length;
}

static void change_data_uri(Json *json, int begin, int end) {
    static uint8_t bytes[TEXT_MAX];
    static char text[2 * TEXT_MAX];
    int count = bytes_of_base64(json->text + begin, end - begin, bytes);
    if (below(json, 4)) {
        fuzz_mutate_places(bytes, (size_t)count, fuzz_random(&json->state));
    } else {
        int room = (json->room - json->size) * 3 / 4 + count - 4;
        if (room > count) count = (int)fuzz_mutate_bytes(bytes, (size_t)count, (size_t)room);
    }
    splice(json, begin, end, text, base64_of_bytes(bytes, count, text));
}

static void change_text(Json *json, Span at) {
    static uint8_t text[TEXT_MAX];
    int begin = at.begin + 1, end = at.end - 1, room = json->room - json->size + end - begin;
    if (json->text[at.begin] != '"' || room <= 0) {
        change_number(json, at);
        return;
    }
    for (int i = begin; i + 7 < end; i++)
        if (!memcmp(json->text + i, "base64,", 7)) {
            change_data_uri(json, i + 7, end);
            return;
        }
    memcpy(text, json->text + begin, (size_t)(end - begin));
    int length = (int)fuzz_mutate_bytes(text, (size_t)(end - begin), (size_t)room);
    for (int i = 0; i < length; i++)
        if (text[i] == '"' || text[i] < ' ') text[i] = '_';
    splice(json, begin, end, (const char *)text, length);
}

/* ---- one mutation ------------------------------------------------------------------------ */

static void change_once(Json *json) {
    static void (*const changes[])(Json *, Span) = {
        put_strange,   put_strange,   put_other,   put_other, take_out, double_it,   change_number,
        change_number, change_number, change_name, put_in,    put_in,   change_text, change_text};
    Span at = json->value[below(json, json->count)];
    changes[below(json, COUNT(changes))](json, at);
}

size_t fuzz_mutate_json(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    static Json json;
    json.state = seed;
    json.size = (int)size;
    json.room = (int)max_size;
    if (max_size > TEXT_MAX || below(&json, 20) == 0)
        return fuzz_mutate_bytes(data, size, max_size);
    memcpy(json.text, data, size);
    json.text[size] = 0;
    for (int i = 1 + below(&json, 3); i > 0; i--) {
        if (!find_all(&json)) return fuzz_mutate_bytes(data, size, max_size);
        change_once(&json);
    }
    memcpy(data, json.text, (size_t)json.size);
    return (size_t)json.size;
}
