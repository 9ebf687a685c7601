/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_picture.h"

#include "image/picture.h"
#include "text/base64.h"

static void mean_codes(const Image *image, PixelBox box, float out[3]) {
    const uint8_t *codes = image->pixels;
    double sum[3] = {0};
    for (int y = box.top; y < box.bottom; y++)
        for (int x = box.left; x < box.right; x++)
            for (int c = 0; c < 3; c++)
                sum[c] += codes[4 * ((size_t)y * (size_t)image->width + (size_t)x) + (size_t)c];
    double count = (double)(box.right - box.left) * (box.bottom - box.top);
    for (int c = 0; c < 3; c++) out[c] = (float)(sum[c] / (255 * count));
}

/* Every pixel of the small one is the mean of those it covers. */
static Picture shrink(const Image *image, PixelBox part, PixelSize size, Arena *arena) {
    Picture small = picture_create(size.width, size.height, arena);
    long wide = part.right - part.left, high = part.bottom - part.top;
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            const PixelBox box = {part.left + (int)(x * wide / size.width),
                                  part.top + (int)(y * high / size.height),
                                  part.left + (int)((x + 1) * wide / size.width),
                                  part.top + (int)((y + 1) * high / size.height)};
            mean_codes(image, box, picture_pixel(&small, x, y));
        }
    return small;
}

PixelBox equip_picture_box(const Image *image) {
    return (PixelBox){0, 0, image->width, image->height};
}

json_t *equip_picture_json(const Image *image, PixelBox part, PixelSize size, Arena scratch) {
    FileBytes bytes;
    const char *kind;
    Error none;
    if (image->format != IMAGE_RGBA8) return NULL;
    Picture small = shrink(image, part, size, &scratch);
    if (!picture_encode_small(&small, &scratch, &bytes, &kind, &none)) return NULL;
    Text text = {.arena = &scratch};
    text_format(&text, "data:image/%s;base64,", kind);
    base64_encode(&text, bytes.data, bytes.size);
    return json_string(text.data);
}
