/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/vertex_code.h"

#include <stdlib.h>
#include <string.h>

#define SIZES 3 /* classes of what was coded before */
#define MAGNITUDE_BITS 16
#define NUMBER_BYTES 8 /* at most, on average */

/* ---- the coder --------------------------------------------------------------------------- */

/* How likely a bit is 0, of 65536, after `seen` bits. */
typedef struct Chance {
    uint16_t zero;
    uint8_t seen;
} Chance;

/* Carries ripple back into the bytes; reading, `low` is the code less the interval's start. */
typedef struct BitCoder {
    bool reads;
    uint8_t *bytes;
    size_t at, size;
    uint64_t low;
    uint32_t range;
} BitCoder;

static uint32_t next_byte(BitCoder *c) {
    return c->at < c->size ? c->bytes[c->at++] : 0;
}

static void put_byte(BitCoder *c) {
    if (c->low >> 32)
        for (size_t i = c->at; i > 0 && ++c->bytes[i - 1] == 0;) i--;
    if (c->at == c->size) abort(); /* NUMBER_BYTES is too small */
    c->bytes[c->at++] = (uint8_t)(c->low >> 24);
    c->low = (c->low << 8) & 0xffffffffu;
}

static BitCoder coder_start(bool reads, uint8_t *bytes, size_t size) {
    BitCoder c = {reads, bytes, 0, size, 0, 0xffffffffu};
    for (int i = 0; i < 4 && reads; i++) c.low = c.low << 8 | next_byte(&c);
    return c;
}

/* The chance moves by 1 / (seen + 1.5) of what it missed by, at least by 2 / 61. */
static void learn(Chance *chance, int bit) {
    int target = bit ? 0 : 65536, zero = chance->zero;
    zero += (target - zero) * 2 / (2 * chance->seen + 3);
    chance->zero = (uint16_t)(zero < 256 ? 256 : zero > 65280 ? 65280 : zero);
    if (chance->seen < 29) chance->seen++;
}

static int code_bit(BitCoder *c, Chance *chance, int bit) {
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
typedef struct NumberKind {
    Chance is_more[SIZES][2], sign[3], longer[SIZES][MAGNITUDE_BITS];
    Chance below[MAGNITUDE_BITS][2];
} NumberKind;

static int size_class(int value) {
    int size = abs(value);
    return size > 2 ? 2 : size > 0;
}

/* near: what the number is like. others: is another component of its row not 0? */
static int code_number(BitCoder *c, NumberKind *of, int near, bool others, int value) {
    int class = size_class(near), bits = 1, size = abs(value), out = 1;
    if (!code_bit(c, &of->is_more[class][others], size > 0)) return 0;
    while (bits < MAGNITUDE_BITS && code_bit(c, &of->longer[class][bits - 1], size >> bits > 0))
        bits++;
    for (int b = bits - 2; b >= 0; b--)
        out = out << 1 | code_bit(c, &of->below[b][b == bits - 2], size >> b & 1);
    return code_bit(c, &of->sign[(near > 0) + 2 * (near < 0)], value < 0) ? -out : out;
}

/* ---- the walk, the same for both ways ---------------------------------------------------- */

typedef struct CodeWalk {
    BitCoder coder;
    VertexLattice lattice;
    int components, base_level, levels;
    bool *stored;
    int16_t *integers; /* writing: of each vertex; reading: the next row */
    size_t stride;
    uint32_t rows, most; /* reading: so far, and at most */
    NumberKind *kinds;   /* of the base's components, then of each level's */
    int16_t *before;     /* the row before */
} CodeWalk;

/* Damaged bits may give any integer: it is held in a blob's range. */
static void code_row(CodeWalk *w, NumberKind *kinds, uint32_t vertex, bool is_base) {
    bool others = false, reads = w->coder.reads;
    w->rows++;
    if (w->rows > w->most) return;
    int16_t *row = w->integers + (reads ? w->rows - 1 : vertex) * w->stride;
    for (int k = 0; k < w->components; k++) {
        int offset = is_base ? w->before[k] : 0;
        int found =
            code_number(&w->coder, &kinds[k], is_base ? 0 : w->before[k], others, row[k] - offset);
        others |= found != 0;
        found += offset;
        found = found < VERTEX_LEAST ? VERTEX_LEAST : found > VERTEX_MOST ? VERTEX_MOST : found;
        if (reads) row[k] = (int16_t)found;
        w->before[k] = (int16_t)found;
    }
    w->stored[vertex] = true;
}

static void code_base(CodeWalk *w) {
    int n = 1 << w->base_level, scale = 1 << (w->lattice.level - w->base_level);
    for (int y = w->lattice.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++)
            code_row(w, w->kinds, vertex_index(w->lattice, x * scale, y * scale), true);
}

/* Of each level's edges: has it a detail? More often where its ends have, and the edges
 * before it. */
static void code_level(CodeWalk *w, int l, Arena scratch) {
    int level = w->base_level + l, before = 0;
    Chance is_stored[3][3][4] = {0};
    NumberKind *kinds = w->kinds + (size_t)(l + 1) * (size_t)w->components;
    uint32_t count = vertex_edges(w->lattice, level, NULL);
    VertexEdge *edge = ARENA_NEW(&scratch, VertexEdge, count);
    vertex_edges(w->lattice, level, edge);
    memset(w->before, 0, sizeof *w->before * (size_t)w->components);
    for (uint32_t i = 0; i < count && w->rows <= w->most; i++) {
        int ends = w->stored[edge[i].end[0]] + w->stored[edge[i].end[1]];
        Chance *chance = &is_stored[edge[i].cell_edge][ends][before];
        int bit = code_bit(&w->coder, chance, w->stored[edge[i].vertex]);
        if (bit) code_row(w, kinds, edge[i].vertex, false);
        before = (before << 1 | bit) & 3;
    }
}

static void walk(CodeWalk *w, Arena scratch) {
    w->kinds = ARENA_NEW(&scratch, NumberKind, (w->levels + 1) * w->components);
    w->before = ARENA_NEW(&scratch, int16_t, w->components);
    code_base(w);
    for (int l = 0; l < w->levels; l++) code_level(w, l, scratch);
}

/* ---- both ways --------------------------------------------------------------------------- */

/* Rows of all levels; *levels: up to the last one with a detail. */
static uint32_t count_rows(const VertexCode *code, Arena scratch, uint32_t *levels) {
    uint32_t rows = vertex_count((VertexLattice){code->base_level, code->lattice.octants});
    *levels = 0;
    for (int level = code->base_level; level < code->lattice.level; level++) {
        Arena inner = scratch;
        uint32_t count = vertex_edges(code->lattice, level, NULL), stored = 0;
        VertexEdge *edge = ARENA_NEW(&inner, VertexEdge, count);
        vertex_edges(code->lattice, level, edge);
        for (uint32_t i = 0; i < count; i++) stored += code->stored[edge[i].vertex];
        if (stored) *levels = (uint32_t)(level - code->base_level + 1);
        rows += stored;
    }
    return rows;
}

const void *vertex_encode(const VertexCode *code, Arena *arena, size_t *size) {
    uint32_t levels, rows = count_rows(code, *arena, &levels);
    VertexHeader head = {.magic = VERTEX_MAGIC,
                         .version = VERTEX_VERSION,
                         .components = (uint16_t)code->components,
                         .level = (uint8_t)code->lattice.level,
                         .octants = (uint8_t)code->lattice.octants,
                         .base_level = (uint8_t)code->base_level,
                         .level_count = (uint8_t)levels,
                         .row_count = rows,
                         .base_exponent = (int8_t)code->base_exponent};
    size_t scales = sizeof(float) * (size_t)code->components;
    size_t front = vertex_front_bytes(&head), bits = vertex_count(code->lattice) / 4 + 64;
    size_t room = front + bits + (size_t)rows * (size_t)code->components * NUMBER_BYTES;
    uint8_t *out = arena_alloc(arena, 1, 8, room);
    CodeWalk w = {.coder = coder_start(false, out + front, room - front - 8),
                  .lattice = code->lattice,
                  .components = code->components,
                  .base_level = code->base_level,
                  .levels = (int)levels,
                  .stored = code->stored,
                  .integers = code->integers,
                  .stride = (size_t)code->components,
                  .most = rows};
    walk(&w, *arena);
    for (int i = 0; i < 4; i++) put_byte(&w.coder);
    *size = (front + w.coder.at + 7) / 8 * 8;
    head.size = *size;
    memset(out + front + w.coder.at, 0, *size - front - w.coder.at);
    memcpy(out, &head, sizeof head);
    memcpy(out + sizeof head, code->scale, scales);
    for (uint32_t l = 0; l < levels; l++)
        out[sizeof head + scales + l] = (uint8_t)code->exponent[l];
    return out;
}

bool vertex_decode(const VertexHeader *h, Arena *arena, VertexRows *out) {
    size_t front = vertex_front_bytes(h);
    VertexLattice lattice = {h->level, h->octants};
    uint8_t *bits = (uint8_t *)h + front; /* only read */
    *out = (VertexRows){.stride = (h->components + 7) / 8 * 8};
    out->numbers = arena_alloc(arena, sizeof *out->numbers, VERTEX_LINE_BYTES,
                               (size_t)h->row_count * (size_t)out->stride);
    out->stored = ARENA_NEW(arena, bool, vertex_count(lattice));
    CodeWalk w = {.coder = coder_start(true, bits, h->size - front),
                  .lattice = lattice,
                  .components = h->components,
                  .base_level = h->base_level,
                  .levels = h->level_count,
                  .stored = out->stored,
                  .integers = out->numbers,
                  .stride = (size_t)out->stride,
                  .most = h->row_count};
    walk(&w, *arena);
    return w.rows == w.most;
}
