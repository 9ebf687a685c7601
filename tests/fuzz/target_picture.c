/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures and frames in memory. */
#include <string.h>

#include "harness.h"
#include "image/frame.h"
#include "image/image.h"
#include "image/light/picture_tags.h"
#include "measure/measure.h"

/* A small file may announce a large picture: this much memory and no more. */
#define IMAGE_BYTES ((size_t)1 << 18)
#define SHOWN_PIXELS ((size_t)1 << 20)
#define FRAME_BYTES ((size_t)5 << 18) /* reading keeps a megabyte for names */

static Arena small_arena(const Arena *arena, size_t bytes) {
    Arena small = *arena;
    small.end = small.next + bytes;
    return small;
}

void fuzz_image(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Image image;
    Arena small = small_arena(arena, IMAGE_BYTES), tags = *arena;
    picture_tags_read(data, size, &tags);
    if (!image_read_memory(data, size, size % 2 ? "picture.tga" : "picture", &small, &image,
                           &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    size_t count = (size_t)image.width * (size_t)image.height * 4, sum = 0;
    size_t value = image.format == IMAGE_RGBA8 ? 1 : image.format == IMAGE_RGBA16 ? 2 : 4;
    for (size_t i = 0; i < count * value; i++) sum += ((const uint8_t *)image.pixels)[i];
    fuzz_claim(image.width > 0 && image.height > 0 && sum <= count * value * 255,
               "a picture has pixels");
}

void fuzz_frame(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    FrameImage frame;
    Arena small = small_arena(arena, FRAME_BYTES);
    const float *rgb[3];
    if (!frame_read_memory(data, size, "frame.exr", &small, &frame, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    double sum = 0;
    for (int c = 0; c < frame.channel_count; c++)
        for (size_t i = 0; i < frame_pixel_count(&frame); i++)
            sum += (double)frame.channels[c].values[i];
    fuzz_claim(sum < 0 || !(sum < 0), "pixels can be read");
    frame_id_of(&frame, "display", "cluster");
    const ExrWindow shown = frame.display; /* figures are taken over all of it */
    size_t shown_pixels = (size_t)(shown.x1 - shown.x0) * (size_t)(shown.y1 - shown.y0);
    if (shown_pixels > SHOWN_PIXELS || !frame_rgb(&frame, "", rgb)) return;
    FrameMeasurement figures;
    MeasureRequest request = {.frame_name = "frame.exr"};
    small.end = arena->end;
    if (!measure_frame(&frame, &request, small, &figures, &err)) fuzz_claim_refusal(&err);
}
