/* SPDX-License-Identifier: Apache-2.0 */
/* Mutations that leave the frame of a file alone. */
#include <stdlib.h>
#include <string.h>

#include "harness.h"

#define HEAD_BYTES 1500 /* half of the changes: headers, counts and offsets */

uint32_t fuzz_random(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

/* Numbers as they stand in headers: extremes, off by one, those of another place. */
static void change_word(uint8_t *data, size_t size, size_t at, uint64_t *state) {
    static const uint32_t extremes[] = {0,          1,          2,          0x7f,
                                        0xff,       0x7fff,     0xffff,     0x7fffffff,
                                        0xffffffff, 0x80000000, 0x7f800000, 0x7fc00000,
                                        0xff800000, 0x5f000000, 0x00000100, 0x00010000};
    uint32_t word, choice = fuzz_random(state) % 8;
    memcpy(&word, data + at, 4);
    if (choice < 4) word = extremes[fuzz_random(state) % 16];
    else if (choice < 6) word += choice == 4 ? 1u : 0xffffffffu;
    else memcpy(&word, data + fuzz_random(state) % (size - 3), 4);
    memcpy(data + at, &word, choice % 2 ? 4 : 2);
}

void fuzz_mutate_places(uint8_t *data, size_t size, unsigned seed) {
    uint64_t state = seed;
    int changes = 1 + (int)(fuzz_random(&state) % 4);
    for (int i = 0; i < changes && size; i++) {
        size_t range = fuzz_random(&state) % 2 && size > HEAD_BYTES ? HEAD_BYTES : size;
        size_t at = fuzz_random(&state) % range;
        size_t even = at / 2 * 2;
        if (fuzz_random(&state) % 2 && even + 4 <= size) change_word(data, size, even, &state);
        else data[at] = (uint8_t)fuzz_random(&state);
    }
}

/* ---- a file of chunks whose lengths must fit --------------------------------------------- */

static uint32_t little_u32(const uint8_t *at) {
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void put_little_u32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> 8 * i);
}

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

/* What stands in the two chunks of a .glb; false when its frame is broken already. */
static bool split_glb(const uint8_t *data, size_t size, size_t length[2]) {
    if (size < GLB_HEADER + CHUNK_HEADER || memcmp(data, "glTF", 4) != 0) return false;
    length[0] = little_u32(data + GLB_HEADER);
    if (length[0] > size - GLB_HEADER - CHUNK_HEADER) return false;
    size_t rest = size - GLB_HEADER - CHUNK_HEADER - length[0];
    length[1] = 0;
    if (rest < CHUNK_HEADER) return rest == 0;
    length[1] = rest - CHUNK_HEADER;
    return true;
}

static size_t pad(uint8_t *data, size_t size, uint8_t with) {
    while (size % 4) data[size++] = with;
    return size;
}

/* Both chunks again behind a header that fits. */
static size_t join_glb(uint8_t *out, const uint8_t *json, size_t json_size, const uint8_t *bin,
                       size_t bin_size) {
    size_t at = GLB_HEADER + CHUNK_HEADER;
    memmove(out + at, json, json_size);
    at = pad(out, at + json_size, ' ');
    put_little_u32(out + GLB_HEADER, (uint32_t)(at - GLB_HEADER - CHUNK_HEADER));
    memcpy(out + GLB_HEADER + 4, "JSON", 4);
    if (bin_size) {
        size_t head = at;
        memcpy(out + head + CHUNK_HEADER, bin, bin_size);
        at = pad(out, head + CHUNK_HEADER + bin_size, 0);
        put_little_u32(out + head, (uint32_t)(at - head - CHUNK_HEADER));
        memcpy(out + head + 4, "BIN\0", 4);
    }
    memcpy(out, "glTF\2\0\0\0", 8);
    put_little_u32(out + 8, (uint32_t)at);
    return at;
}

size_t fuzz_mutate_glb(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    static uint8_t json[1 << 15], bin[1 << 15];
    uint64_t state = seed;
    size_t length[2], frame = GLB_HEADER + 2 * CHUNK_HEADER + 8;
    uint32_t choice = fuzz_random(&state) % 16;
    bool fits = max_size <= sizeof json && size + frame < max_size;
    if (choice == 0 || !fits || !split_glb(data, size, length))
        return fuzz_mutate_bytes(data, size, max_size);
    memcpy(json, data + GLB_HEADER + CHUNK_HEADER, length[0]);
    memcpy(bin, data + size - length[1], length[1]);
    size_t room = max_size - frame;
    if (choice < 5 && length[1]) length[1] = fuzz_mutate_bytes(bin, length[1], room - length[0]);
    else length[0] = fuzz_mutate_json(json, length[0], room - length[1], fuzz_random(&state));
    return join_glb(data, json, length[0], bin, length[1]);
}

/* ---- PNG --------------------------------------------------------------------------------- */

static uint32_t big_u32(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* CRC-32 of ISO 3309 (PNG 1.2, annex D). */
static uint32_t crc_of(const uint8_t *bytes, size_t size) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

static void repair_png(uint8_t *data, size_t size) {
    for (size_t at = 8; at + 12 <= size;) {
        size_t length = big_u32(data + at);
        if (length > size - at - 12) return;
        uint32_t crc = crc_of(data + at + 4, length + 4);
        for (int i = 0; i < 4; i++)
            data[at + 8 + length + (size_t)i] = (uint8_t)(crc >> (24 - 8 * i));
        at += 12 + length;
    }
}

size_t fuzz_mutate_png(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    uint64_t state = seed;
    if (fuzz_random(&state) % 4) fuzz_mutate_places(data, size, fuzz_random(&state));
    else size = fuzz_mutate_bytes(data, size, max_size);
    if (size < 20 || fuzz_random(&state) % 16 == 0) return size;
    memcpy(data, "\x89PNG\r\n\x1a\n", 8);
    repair_png(data, size);
    return size;
}
