/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/image.h"

#include <string.h>
#include <strings.h>

#include "scene/gltf/document.h"
#include "image/light/picture_tags.h"
#include "scene/gltf/variant.h"
#include "text/uri.h"

/* ---- which images do the materials show? ----------------------------------------------- */

int texture_source(const GltfValue *texture) {
    const GltfValue *webp = tree_extension(texture, "EXT_texture_webp");
    return tree_int(webp, "source", tree_int(texture, "source", NO_ID));
}

/* Marks the textures that any textureInfo below `value` names. */
static void mark_textures(const GltfValue *value, bool *is_used, int count) {
    int index = value->kind == GLTF_OBJECT ? tree_int(value, "index", NO_ID) : NO_ID;
    if (index >= 0 && index < count) is_used[index] = true;
    for (int i = 0; i < value->count; i++) mark_textures(&value->items[i], is_used, count);
}

/* Textures of the materials that some primitive wears: no other one is ever looked at. */
static void mark_shown(const GltfFile *file, bool *is_used, int count, Arena scratch) {
    const GltfValue *materials = tree_member(file->root, "materials");
    bool *is_marked = ARENA_NEW(&scratch, bool, tree_count(file->root, "materials"));
    for (const GltfValue *m = tree_items(file->root, "meshes"); m; m = tree_next(m))
        for (const GltfValue *p = tree_items(m, "primitives"); p; p = tree_next(p)) {
            int id = variant_material(file, p);
            const GltfValue *material = tree_item(materials, id);
            if (!material || is_marked[id]) continue;
            is_marked[id] = true;
            mark_textures(material, is_used, count);
        }
}

/* How an image is used. */
typedef struct ImageUse {
    bool is_shown; /* by a material that something wears */
    bool is_webp;  /* by EXT_texture_webp */
} ImageUse;

static ImageUse *image_uses(GltfFile *file, const GltfValue *textures, int image_count) {
    Arena *scratch = &file->load->scratch;
    int count = textures ? textures->count : 0;
    bool *is_shown = ARENA_NEW(scratch, bool, count);
    ImageUse *uses = ARENA_NEW(scratch, ImageUse, image_count);
    mark_shown(file, is_shown, count, *scratch);
    for (int i = 0; i < count; i++) {
        const GltfValue *texture = &textures->items[i];
        int source = texture_source(texture);
        if (source < 0 || source >= image_count) continue;
        uses[source].is_shown |= is_shown[i];
        uses[source].is_webp |= tree_extension(texture, "EXT_texture_webp") != NULL;
    }
    return uses;
}

/* ---- bytes ----------------------------------------------------------------------------- */

static const char *sniffed_type(FileBytes bytes) {
    static const unsigned char PNG[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    if (bytes.size >= 8 && memcmp(bytes.data, PNG, 8) == 0) return "image/png";
    if (bytes.size >= 3 && memcmp(bytes.data, "\xFF\xD8\xFF", 3) == 0) return "image/jpeg";
    if (bytes.size >= 12 && memcmp(bytes.data, "RIFF", 4) == 0 &&
        memcmp(bytes.data + 8, "WEBP", 4) == 0)
        return "image/webp";
    if (bytes.size >= 12 && memcmp(bytes.data + 1, "KTX 20", 6) == 0) return "image/ktx2";
    return "";
}

/* Compares the type of the bytes with the declared one. Only PNG and JPEG are core glTF. */
static void check_type(GltfFile *file, const GltfValue *image, const char *declared,
                       FileBytes bytes, bool is_webp) {
    const char *found = sniffed_type(bytes);
    if (declared[0] && found[0] && strcasecmp(declared, found) != 0)
        file_warning(file, image, "the bytes are %s, the file says %.60s", found, declared);
    if (is_webp && found[0] && strcmp(found, "image/webp") != 0)
        file_warning(file, image, "the bytes are %s, EXT_texture_webp wants image/webp", found);
    if (is_webp && strcmp(found, "image/webp") == 0) return;
    if (found[0] && strcmp(found, "image/png") != 0 && strcmp(found, "image/jpeg") != 0)
        file_warning(file, image, "%s needs an extension; image/png or image/jpeg is required",
                     found);
}

/* The encoded bytes, a name for messages and the media type that is declared. */
static bool image_bytes(GltfFile *file, const GltfValue *image, FileBytes *bytes, const char **name,
                        const char **declared, bool is_used) {
    Severity severity = is_used ? SEVERITY_ERROR : SEVERITY_WARNING;
    Error err;
    Arena *scratch = &file->load->scratch;
    const GltfValue *uri = tree_member(image, "uri");
    char pointer[64];
    tree_pointer(image, pointer, sizeof pointer);
    *name = arena_string(scratch, pointer, strlen(pointer));
    *declared = tree_text(image, "mimeType", "");
    if (!uri) {
        int view = tree_int(image, "bufferView", NO_ID);
        *bytes =
            view >= 0 && view < file->data.view_count ? document_view(file, view) : (FileBytes){0};
        if (!bytes->data && is_used) file_error(file, image, "its bytes are missing");
        return bytes->data != NULL;
    }
    if (uri_is_data(uri->text))
        return data_uri_decode(uri->text, scratch, bytes, declared, &err) ||
               file_error(file, uri, "%s", err.text);
    if (document_is_elsewhere(file, uri, severity)) return false;
    if (!document_resolve(file, uri, name)) return false;
    bool is_read = load_read(file->load, *name, scratch, bytes, &err);
    if (!is_read) file_problem(file, severity, uri, "%s: %s", *name, err.text);
    return is_read;
}

/* What a file of codes says that they mean, and which way up; "" when that is usual. */
static const char *words_of(FileBytes bytes, const Image *image, Arena *scratch) {
    PictureTags tags = picture_tags_read(bytes.data, bytes.size, scratch);
    if (image->format == IMAGE_RGBA32F) return "linear light";
    return picture_tags_text(&tags, scratch);
}

static void load_one_image(GltfFile *file, const GltfValue *image, ImageUse use,
                           DecodedImage *out) {
    Error err;
    FileBytes bytes;
    const char *name, *declared;
    bool is_used = use.is_shown;
    if (!image_bytes(file, image, &bytes, &name, &declared, is_used)) return;
    check_type(file, image, declared, bytes, use.is_webp);
    if (image_read_memory(bytes.data, bytes.size, name, file->load->arena, &out->image, &err)) {
        out->words = words_of(bytes, &out->image, &file->load->scratch);
        return;
    }
    out->image = (Image){0};
    load_note(file->load, &file->load->undecoded, name);
    if (is_used) file_error(file, image, "cannot be decoded: %s", err.text);
    else file_warning(file, image, "cannot be decoded (no material shows it): %s", err.text);
}

/* ---- textures -------------------------------------------------------------------------- */

static TextureWrap wrap_from_gl(int code) {
    return code == 33071 ? WRAP_CLAMP : code == 33648 ? WRAP_MIRROR : WRAP_REPEAT;
}

int texture_add(Loader *load, Texture texture, const char *words) {
    *(Texture *)list_add(&load->textures, &load->scratch) = texture;
    *(const char **)list_add(&load->texture_words, &load->scratch) = words;
    return load->textures.count - 1;
}

void images_load(GltfFile *file) {
    static const DecodedImage none = {.words = ""};
    const GltfValue *images = tree_member(file->root, "images");
    const GltfValue *textures = tree_member(file->root, "textures");
    int image_count = images ? images->count : 0;
    DecodedImage *decoded = ARENA_NEW(&file->load->scratch, DecodedImage, image_count);
    const ImageUse *uses = image_uses(file, textures, image_count);
    load_progress_begin(file->load, "decode", "pictures", image_count);
    for (int i = 0; i < image_count; i++) {
        load_one_image(file, &images->items[i], uses[i], &decoded[i]);
        load_progress_add(file->load, 1);
    }
    load_progress_end(file->load);
    file->texture_base = file->load->textures.count;
    for (int i = 0; textures && i < textures->count; i++) {
        const GltfValue *texture = &textures->items[i];
        const GltfValue *sampler = tree_referred(tree_member(texture, "sampler"), "samplers");
        int source = texture_source(texture);
        bool is_there = source >= 0 && source < image_count;
        const DecodedImage *from = is_there ? &decoded[source] : &none;
        texture_add(file->load,
                    (Texture){.image = from->image,
                              .wrap_u = wrap_from_gl(tree_int(sampler, "wrapS", 10497)),
                              .wrap_v = wrap_from_gl(tree_int(sampler, "wrapT", 10497)),
                              .nearest = tree_int(sampler, "magFilter", 9729) == 9728},
                    from->words);
    }
}

bool load_image(Loader *load, const char *path, DecodedImage *out, Error *err) {
    FileBytes bytes;
    if (!load_read(load, path, &load->scratch, &bytes, err)) return false;
    if (!image_read_memory(bytes.data, bytes.size, path, load->arena, &out->image, err))
        return error_in_file(err, path);
    out->words = words_of(bytes, &out->image, &load->scratch);
    return true;
}

bool load_light_picture(Loader *load, const char *path, LightPicture *out, Error *err) {
    FileBytes bytes;
    return load_read(load, path, &load->scratch, &bytes, err) &&
           light_picture_read(bytes, path, load->arena, load->problems, out, err);
}
