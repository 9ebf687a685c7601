/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_pack.h"

#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex/vertex_open.h"
#include "hemisphere/vertex/vertex_tree_write.h"

#define SIZES 3 /* classes of what was coded before */
#define MAGNITUDE_BITS 16
#define LEAST_BYTES 56 /* no reader takes it for less than a header */

/* ---- the coder --------------------------------------------------------------------------- */

/* How likely a bit is 0, of 65536, after `seen` bits. */
typedef struct PackChance {
    uint16_t zero;
    uint8_t seen;
} PackChance;

/* Carries ripple back into the bytes; reading, `low` is the code less the interval's start. */
typedef struct PackCoder {
    bool reads;
    uint8_t *bytes;
    size_t at, size;
    uint64_t low;
    uint32_t range;
} PackCoder;

static uint32_t next_byte(PackCoder *c) {
    return c->at < c->size ? c->bytes[c->at++] : 0;
}

static void put_byte(PackCoder *c) {
    if (c->low >> 32)
        for (size_t i = c->at; i > 0 && ++c->bytes[i - 1] == 0;) i--;
    if (c->at < c->size) c->bytes[c->at++] = (uint8_t)(c->low >> 24);
    c->low = (c->low << 8) & 0xffffffffu;
}

static PackCoder coder_start(bool reads, uint8_t *bytes, size_t size) {
    PackCoder c = {reads, bytes, 0, size, 0, 0xffffffffu};
    for (int i = 0; i < 4 && reads; i++) c.low = c.low << 8 | next_byte(&c);
    return c;
}

/* The chance moves by 1 / (seen + 1.5) of what it missed by, at least by 2 / 61. */
static void learn(PackChance *chance, int bit) {
    int target = bit ? 0 : 65536, zero = chance->zero;
    zero += (target - zero) * 2 / (2 * chance->seen + 3);
    chance->zero = (uint16_t)(zero < 256 ? 256 : zero > 65280 ? 65280 : zero);
    if (chance->seen < 29) chance->seen++;
}

static int code_bit(PackCoder *c, PackChance *chance, int bit) {
    if (chance->seen == 0) chance->zero = 32768;
    uint32_t bound = (c->range >> 16) * chance->zero;
    if (c->reads) bit = c->low >= bound;
    if (bit && c->reads) c->low -= bound;
    if (bit && !c->reads) c->low += bound;
    c->range = bit ? c->range - bound : bound;
    while (c->range < 1u << 24) {
        if (c->reads) c->low = c->low << 8 | next_byte(c);
        else put_byte(c);
        c->range <<= 8;
    }
    learn(chance, bit);
    return bit;
}

/* ---- numbers ----------------------------------------------------------------------------- */

/* Chances of one kind of number: is it 0, its sign, how many bits it has, the bits below the
 * highest. */
typedef struct PackNumber {
    PackChance is_more[SIZES][2], sign[3], longer[SIZES][MAGNITUDE_BITS];
    PackChance below[MAGNITUDE_BITS][2];
} PackNumber;

static int size_class(int value) {
    int size = abs(value);
    return size > 2 ? 2 : size > 0;
}

/* near: what the number is like. others: is another component of its row not 0? */
static int code_number(PackCoder *c, PackNumber *of, int near, bool others, int value) {
    int class = size_class(near), bits = 1, size = abs(value), out = 1;
    if (!code_bit(c, &of->is_more[class][others], size > 0)) return 0;
    while (bits < MAGNITUDE_BITS && code_bit(c, &of->longer[class][bits - 1], size >> bits > 0))
        bits++;
    for (int b = bits - 2; b >= 0; b--)
        out = out << 1 | code_bit(c, &of->below[b][b == bits - 2], size >> b & 1);
    return code_bit(c, &of->sign[(near > 0) + 2 * (near < 0)], value < 0) ? -out : out;
}

/* ---- the walk, the same for both ways ---------------------------------------------------- */

typedef struct PackWalk {
    PackCoder coder;
    VertexCode *code;
    PackNumber (*base)[1], (*detail)[VERTEX_PACKED_COMPONENTS]; /* per component; per level */
    int before[VERTEX_PACKED_COMPONENTS];
} PackWalk;

static int16_t *row_of(const VertexCode *code, uint32_t vertex) {
    return code->integers + vertex * (size_t)code->components;
}

/* Damaged bits may give any integer: it is held in a blob's range. */
static void code_row(PackWalk *w, PackNumber *kinds, uint32_t vertex, bool is_base) {
    int16_t *row = row_of(w->code, vertex);
    bool others = false;
    for (int k = 0; k < w->code->components; k++) {
        int offset = is_base ? w->before[k] : 0;
        int found =
            code_number(&w->coder, &kinds[k], is_base ? 0 : w->before[k], others, row[k] - offset);
        others |= found != 0;
        found += offset;
        found = found < VERTEX_LEAST ? VERTEX_LEAST : found > VERTEX_MOST ? VERTEX_MOST : found;
        row[k] = (int16_t)found;
        w->before[k] = found;
    }
    w->code->stored[vertex] = true;
}

static void code_base(PackWalk *w) {
    VertexLattice all = w->code->lattice;
    int n = 1 << w->code->base_level, scale = 1 << (all.level - w->code->base_level);
    for (int y = all.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++)
            code_row(w, *w->base, vertex_index(all, x * scale, y * scale), true);
}

/* Of each level's edges: has it a detail? More often where its ends have, and the edges
 * before it. */
static void code_level(PackWalk *w, int l, Arena scratch) {
    int level = w->code->base_level + l, before = 0;
    PackChance is_stored[3][3][4] = {0};
    uint32_t count = vertex_edges(w->code->lattice, level, NULL);
    VertexEdge *edge = ARENA_NEW(&scratch, VertexEdge, count);
    vertex_edges(w->code->lattice, level, edge);
    memset(w->before, 0, sizeof w->before);
    for (uint32_t i = 0; i < count; i++) {
        const bool *stored = w->code->stored;
        int ends = stored[edge[i].end[0]] + stored[edge[i].end[1]];
        PackChance *chance = &is_stored[edge[i].cell_edge][ends][before];
        int bit = code_bit(&w->coder, chance, stored[edge[i].vertex]);
        if (bit) code_row(w, w->detail[l], edge[i].vertex, false);
        before = (before << 1 | bit) & 3;
    }
}

static void walk(PackWalk *w, Arena scratch) {
    int levels = w->code->lattice.level - w->code->base_level;
    w->base = arena_alloc(&scratch, VERTEX_PACKED_COMPONENTS, 8, sizeof **w->base);
    w->detail = arena_alloc(&scratch, (size_t)levels + 1, 8, sizeof *w->detail);
    memset(w->base, 0, VERTEX_PACKED_COMPONENTS * sizeof **w->base);
    memset(w->detail, 0, ((size_t)levels + 1) * sizeof *w->detail);
    code_base(w);
    for (int l = 0; l < levels; l++) code_level(w, l, scratch);
}

/* ---- from a blob, and back --------------------------------------------------------------- */

static VertexCode code_start(const VertexHeader *h, Arena *arena) {
    VertexCode code = {.lattice = {h->level, h->octants},
                       .components = h->components,
                       .base_level = h->base_level,
                       .base_exponent = h->base_exponent};
    uint32_t count = vertex_count(code.lattice);
    code.scale = ARENA_NEW(arena, float, h->components);
    code.integers = ARENA_NEW(arena, int16_t, (size_t)count * h->components);
    code.stored = ARENA_NEW(arena, bool, count);
    return code;
}

/* Views into a blob. */
typedef struct PackSource {
    const VertexLevel *level;
    const uint32_t *words;
    const uint16_t *ranks;
    const VertexFormat *formats;
    const uint8_t *block_formats, *rows;
    const uint64_t *blocks;
} PackSource;

static PackSource source_of(const VertexHeader *h) {
    const uint8_t *blob = (const void *)h;
    VertexParts p = vertex_parts(h);
    return (PackSource){(const void *)(blob + p.levels), (const void *)(blob + p.words),
                        (const void *)(blob + p.ranks),  (const void *)(blob + p.formats),
                        blob + p.block_formats,          blob + p.rows,
                        (const void *)(blob + p.blocks)};
}

static void read_row(VertexCode *code, VertexFormat format, const uint8_t *from, uint32_t vertex) {
    int16_t *row = row_of(code, vertex);
    code->stored[vertex] = true;
    for (int p = 0; p < VERTEX_PLANES; from += format.pairs[p++])
        for (int k = 0; k < code->components && k / 2 < format.pairs[p]; k++) {
            int digit = from[k / 2] >> k % 2 * 4 & 15;
            row[k] = (int16_t)(row[k] + (((digit ^ 8) - 8) * (1 << 4 * p)));
        }
}

/* A detail's row and format; NULL: there is none. */
static const uint8_t *find_row(const PackSource *s, const VertexLevel *level, int x, int y,
                               uint32_t cell_edge, VertexFormat *format) {
    int bx = (x - level->x) / VERTEX_BLOCK_SIDE, by = (y - level->y) / VERTEX_BLOCK_SIDE;
    if (x < level->x || y < level->y || bx >= level->width || by >= level->height) return NULL;
    uint32_t block = (uint32_t)(by * level->width + bx), word = level->first_word + block / 32;
    if (!(s->words[word] >> block % 32 & 1)) return NULL;
    uint32_t at = level->first_block + s->ranks[word] +
                  vertex_count_bits(s->words[word] & ((1u << block % 32) - 1));
    uint32_t bit = (uint32_t)(y - level->y) % 4 * 12 + (uint32_t)(x - level->x) % 4 * 3 + cell_edge;
    uint64_t bits = s->blocks[at];
    if (!(bits >> bit & 1)) return NULL;
    *format = s->formats[s->block_formats[at]];
    return s->rows + level->first_byte + ((bits >> VERTEX_BLOCK_BITS) << level->shift) +
           vertex_count_bits(bits & ((1ull << bit) - 1)) * vertex_format_bytes(*format);
}

static void read_blob(const VertexHeader *h, VertexCode *code, Arena scratch) {
    PackSource s = source_of(h);
    int n = 1 << h->base_level, scale = 1 << (h->level - h->base_level);
    const uint8_t *row = s.rows;
    memcpy(code->scale, (const uint8_t *)h + sizeof *h, sizeof(float) * h->components);
    for (int y = h->octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++, row += vertex_format_bytes(s.formats[0]))
            read_row(code, s.formats[0], row, vertex_index(code->lattice, x * scale, y * scale));
    for (int l = 0; l < h->level_count; l++) {
        Arena inner = scratch;
        int level = h->base_level + l, shift = h->level - level;
        uint32_t count = vertex_edges(code->lattice, level, NULL);
        VertexEdge *edge = ARENA_NEW(&inner, VertexEdge, count);
        VertexFormat format;
        vertex_edges(code->lattice, level, edge);
        code->exponent[l] = s.level[l].exponent;
        for (uint32_t i = 0; i < count; i++)
            if ((row = find_row(&s, &s.level[l], edge[i].x >> shift, edge[i].y >> shift,
                                edge[i].cell_edge, &format)))
                read_row(code, format, row, edge[i].vertex);
    }
}

const void *vertex_pack(const void *blob, Arena *arena, size_t *size) {
    const VertexHeader *from = blob;
    VertexHeader head = {.magic = VERTEX_PACKED,
                         .version = VERTEX_VERSION,
                         .components = from->components,
                         .level = from->level,
                         .octants = from->octants,
                         .base_level = from->base_level,
                         .base_exponent = from->base_exponent,
                         .level_count = (uint8_t)(from->level - from->base_level)};
    size_t scales = sizeof(float) * from->components;
    size_t front = sizeof head + scales + head.level_count;
    size_t room = front + from->size * 2 + 4096;
    uint8_t *out = arena_alloc(arena, 1, 8, room);
    Arena scratch = *arena;
    VertexCode code = code_start(from, &scratch);
    read_blob(from, &code, scratch);
    PackWalk w = {.code = &code, .coder = coder_start(false, out + front, room - front)};
    walk(&w, scratch);
    for (int i = 0; i < 4; i++) put_byte(&w.coder);
    *size = (front + w.coder.at + 7) / 8 * 8;
    *size = *size < LEAST_BYTES ? LEAST_BYTES : *size;
    head.size = *size;
    memset(out + front + w.coder.at, 0, *size - front - w.coder.at);
    memcpy(out, &head, sizeof head);
    memcpy(out + sizeof head, code.scale, scales);
    for (int l = 0; l < head.level_count; l++)
        out[sizeof head + scales + (size_t)l] = (uint8_t)code.exponent[l];
    return out;
}

static bool check_head(const VertexHeader *h, size_t size) {
    return h->magic == VERTEX_PACKED && h->version == VERTEX_VERSION && h->size == size &&
           h->level >= 1 && h->level <= VERTEX_PACKED_LEVEL &&
           (h->octants == 2 || h->octants == 4) && h->components >= 1 &&
           h->components <= VERTEX_PACKED_COMPONENTS && h->base_level <= VERTEX_MAX_BASE_LEVEL &&
           h->base_level <= h->level && h->level_count == h->level - h->base_level &&
           size >= sizeof *h + sizeof(float) * h->components + h->level_count;
}

const void *vertex_unpack_blob(const void *bytes, size_t size, Arena *arena, size_t *blob_size,
                               Error *err) {
    const VertexHeader *h = bytes;
    if (size < sizeof *h || !check_head(h, size)) {
        error_set(err, ERROR_INPUT, "a packed tree's header is damaged");
        return NULL;
    }
    VertexCode code = code_start(h, arena);
    size_t scales = sizeof(float) * h->components;
    size_t front = sizeof *h + scales + h->level_count;
    uint8_t *from = (uint8_t *)bytes; /* only read */
    memcpy(code.scale, h + 1, scales);
    for (int l = 0; l < h->level_count; l++)
        code.exponent[l] = (int8_t)from[sizeof *h + scales + (size_t)l];
    PackWalk w = {.code = &code, .coder = coder_start(true, from + front, size - front)};
    walk(&w, *arena);
    return vertex_code_write(&code, arena, blob_size);
}
