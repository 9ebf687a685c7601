/* SPDX-License-Identifier: Apache-2.0 */
/* image.h -- a file's images and textures. */
#pragma once
#include "image/light/light_picture.h"
#include "scene/gltf/loader.h"

/* The textures of the file, in its order; an image that no material shows may be broken. */
void images_load(GltfFile *file);

/* The image that a texture of the document shows: EXT_texture_webp's before its own, which is
 * for readers without the extension; NO_ID: none that is read. */
int texture_source(const GltfValue *texture);

typedef struct DecodedImage {
    Image image;
    const char *words; /* what its file states of its codes that is not applied, "" or NULL:
                          nothing (image/light/picture_tags.h) */
} DecodedImage;

/* The texture's id. words: of its image. */
int texture_add(Loader *load, Texture texture, const char *words);

/* Reads an image file, decoded into the scene's memory. */
bool load_image(Loader *load, const char *path, DecodedImage *out, Error *err);

/* The same of a picture of surroundings: cd/m2. */
bool load_light_picture(Loader *load, const char *path, LightPicture *out, Error *err);
