/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/equip/equip_model.h"

#include <stdint.h>
#include <string.h>

#define FILE_BYTES_MAX ((size_t)4 << 30)

/* A .glb's frame (glTF 2.0, section 4): header, then chunks of a size, a type and bytes. */
enum { GLB_HEADER = 12, CHUNK_HEADER = 8, CHUNK_JSON = 0x4E4F534A, CHUNK_BIN = 0x004E4942 };

static uint32_t u32_at(const unsigned char *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static void take_chunks(const FileBytes *bytes, FileBytes *json, FileBytes *bin)
{
    size_t at = GLB_HEADER;
    while (at + CHUNK_HEADER <= bytes->size) {
        size_t   size = u32_at(bytes->data + at);
        uint32_t type = u32_at(bytes->data + at + 4);
        at += CHUNK_HEADER;
        if (size > bytes->size - at) return;
        FileBytes chunk = {bytes->data + at, size};
        if (type == CHUNK_JSON) *json = chunk;
        if (type == CHUNK_BIN && !bin->data) *bin = chunk;
        at += size;
    }
}

bool equip_model_read(const char *path, Arena *arena, EquipModel *out, Error *err)
{
    FileBytes    bytes, json;
    json_error_t fault;
    EquipModel   model = {.path = path};
    if (!file_read(path, FILE_BYTES_MAX, arena, &bytes, err)) return false;
    json = bytes;
    if (bytes.size >= GLB_HEADER && !memcmp(bytes.data, "glTF", 4))
        take_chunks(&bytes, &json, &model.bin);
    model.document = json_loadb((const char *)json.data, json.size, JSON_REJECT_DUPLICATES,
                                &fault);
    if (!json_is_object(model.document)) {
        json_decref(model.document);
        return error_at(err, ERROR_INPUT, path, "", "cannot be written again: %s",
                        model.document ? "the document is no JSON object" : fault.text);
    }
    *out = model;
    return true;
}

void equip_model_close(EquipModel *model)
{
    json_decref(model->document);
    model->document = NULL;
}
