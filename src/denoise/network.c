/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/network.h"

#include <string.h>

#include "base/parallel.h"
#include "denoise/convolution.h"

/* ---- its nodes --------------------------------------------------------------------------- */

typedef enum NodeKind {
    NODE_INPUT,
    NODE_CONVOLVE, /* 3x3, nothing around the picture, negative results 0 */
    NODE_POOL,     /* the largest of 2 x 2 */
    NODE_JOIN      /* each pixel of `from` four times, then the channels of `beside` */
} NodeKind;

typedef struct Node {
    const char *name; /* of a convolution's weights */
    NodeKind kind;
    int from, beside;
    int channels; /* of the trained network */
} Node;

enum {
    INPUT,
    CONV0,
    CONV1,
    POOL1,
    CONV2,
    POOL2,
    CONV3,
    POOL3,
    CONV4,
    POOL4,
    CONV5A,
    CONV5B,
    JOIN4,
    DEC4A,
    DEC4B,
    JOIN3,
    DEC3A,
    DEC3B,
    JOIN2,
    DEC2A,
    DEC2B,
    JOIN1,
    DEC1A,
    DEC1B,
    DEC0,
    NODES
};

static const Node nodes[NODES] = {
    [INPUT] = {"", NODE_INPUT, 0, 0, NETWORK_INPUTS},
    [CONV0] = {"enc_conv0", NODE_CONVOLVE, INPUT, 0, 32},
    [CONV1] = {"enc_conv1", NODE_CONVOLVE, CONV0, 0, 32},
    [POOL1] = {"", NODE_POOL, CONV1, 0, 32},
    [CONV2] = {"enc_conv2", NODE_CONVOLVE, POOL1, 0, 48},
    [POOL2] = {"", NODE_POOL, CONV2, 0, 48},
    [CONV3] = {"enc_conv3", NODE_CONVOLVE, POOL2, 0, 64},
    [POOL3] = {"", NODE_POOL, CONV3, 0, 64},
    [CONV4] = {"enc_conv4", NODE_CONVOLVE, POOL3, 0, 80},
    [POOL4] = {"", NODE_POOL, CONV4, 0, 80},
    [CONV5A] = {"enc_conv5a", NODE_CONVOLVE, POOL4, 0, 96},
    [CONV5B] = {"enc_conv5b", NODE_CONVOLVE, CONV5A, 0, 96},
    [JOIN4] = {"", NODE_JOIN, CONV5B, POOL3, 160},
    [DEC4A] = {"dec_conv4a", NODE_CONVOLVE, JOIN4, 0, 112},
    [DEC4B] = {"dec_conv4b", NODE_CONVOLVE, DEC4A, 0, 112},
    [JOIN3] = {"", NODE_JOIN, DEC4B, POOL2, 160},
    [DEC3A] = {"dec_conv3a", NODE_CONVOLVE, JOIN3, 0, 96},
    [DEC3B] = {"dec_conv3b", NODE_CONVOLVE, DEC3A, 0, 96},
    [JOIN2] = {"", NODE_JOIN, DEC3B, POOL1, 128},
    [DEC2A] = {"dec_conv2a", NODE_CONVOLVE, JOIN2, 0, 64},
    [DEC2B] = {"dec_conv2b", NODE_CONVOLVE, DEC2A, 0, 64},
    [JOIN1] = {"", NODE_JOIN, DEC2B, INPUT, 73},
    [DEC1A] = {"dec_conv1a", NODE_CONVOLVE, JOIN1, 0, 64},
    [DEC1B] = {"dec_conv1b", NODE_CONVOLVE, DEC1A, 0, 32},
    [DEC0] = {"dec_conv0", NODE_CONVOLVE, DEC1B, 0, NETWORK_OUTPUTS},
};

/* Halvings between the picture and the smallest of its copies: sides are filled up to whole
 * multiples of COARSEST. */
enum { LEVELS = 4, COARSEST = 1 << LEVELS };

bool network_read(const WeightFile *file, Arena *arena, Network *out, Error *err) {
    WeightShape shapes[NETWORK_CONVOLUTIONS];
    int count = 0;
    for (int n = 0; n < NODES; n++)
        if (nodes[n].kind == NODE_CONVOLVE)
            shapes[count++] =
                (WeightShape){nodes[n].name, nodes[nodes[n].from].channels, nodes[n].channels};
    return weights_read(file, shapes, count, arena, out->layers, err);
}

/* ---- the rows of a node ------------------------------------------------------------------ */

typedef struct Rows {
    int width, height; /* of the whole node */
    int channels;      /* of a pixel in memory: filled up to whole groups */
    int room;          /* rows that are kept: row y lies at y % room */
    int begin, end;    /* begin: the next row that is made; end: where this step stops */
    size_t row_floats;
    float *values;
} Rows;

typedef struct NetworkRun {
    const NetworkPicture *picture;
    Convolve *convolve;
    Rows rows[NODES];
    const float *nothing;   /* a row of zeros, as long as the longest */
    int node;               /* that is being computed */
    const Weights *weights; /* its weights */
} NetworkRun;

/* A row from its pixel of zeros on. */
static float *row_at(const Rows *rows, int y) {
    return rows->values + (size_t)(y % rows->room) * rows->row_floats;
}

/* Its first pixel. */
static float *pixels_at(const Rows *rows, int y) {
    return row_at(rows, y) + rows->channels;
}

/* How many rows of a node can be made of what its inputs have up to now. */
static int makeable(const Rows rows[NODES], int n) {
    const Node *node = &nodes[n];
    const Rows *from = &rows[node->from], *beside = &rows[node->beside];
    int end;
    switch (node->kind) {
    case NODE_CONVOLVE:
        return from->end == from->height || from->end == 0 ? from->end : from->end - 1;
    case NODE_POOL: return from->end / 2;
    case NODE_JOIN: end = 2 * from->end; return end < beside->end ? end : beside->end;
    default: return rows[n].end;
    }
}

/* The first row of an input that a node needs, when its next row is y. */
static int oldest_needed(const Node *node, int input, int y) {
    if (node->kind == NODE_POOL) return 2 * y;
    if (node->kind == NODE_JOIN) return input == node->from ? y / 2 : y;
    return y > 0 ? y - 1 : 0;
}

enum { STEP = 32 }; /* rows of the picture that are taken in at once */

/* Every node's next rows: false when all of them are made. */
static bool plan_step(Rows rows[NODES]) {
    if (rows[NODES - 1].end == rows[NODES - 1].height) return false;
    for (int n = 0; n < NODES; n++) rows[n].begin = rows[n].end;
    int end = rows[INPUT].end + STEP;
    rows[INPUT].end = end < rows[INPUT].height ? end : rows[INPUT].height;
    for (int n = INPUT + 1; n < NODES; n++) rows[n].end = makeable(rows, n);
    return true;
}

/* Keeps as many rows of an input as lie between what is made and what is still needed. */
static void make_room(Rows rows[NODES], int n, int input) {
    int needed = rows[input].end - oldest_needed(&nodes[n], input, rows[n].begin);
    if (needed > rows[input].room) rows[input].room = needed;
}

/* Runs through the picture without a number. */
static void find_room(Rows rows[NODES]) {
    while (plan_step(rows))
        for (int n = 0; n < NODES; n++) {
            if (rows[n].end - rows[n].begin > rows[n].room)
                rows[n].room = rows[n].end - rows[n].begin;
            if (nodes[n].kind != NODE_INPUT) make_room(rows, n, nodes[n].from);
            if (nodes[n].kind == NODE_JOIN) make_room(rows, n, nodes[n].beside);
        }
    for (int n = 0; n < NODES; n++) rows[n].begin = rows[n].end = 0;
}

static int halvings(int n) {
    if (nodes[n].kind == NODE_INPUT) return 0;
    if (nodes[n].kind == NODE_JOIN) return halvings(nodes[n].from) - 1;
    return halvings(nodes[n].from) + (nodes[n].kind == NODE_POOL);
}

static int filled_up(int size, int unit) {
    return (size + unit - 1) / unit * unit;
}

static void allocate(NetworkRun *run, Arena *arena) {
    size_t longest = 0;
    for (int n = 0; n < NODES; n++) {
        Rows *rows = &run->rows[n];
        rows->width = filled_up(run->picture->width, COARSEST) >> halvings(n);
        rows->height = filled_up(run->picture->height, COARSEST) >> halvings(n);
        rows->channels = filled_up(nodes[n].channels, CONVOLUTION_GROUP);
        rows->row_floats = (size_t)(rows->width + 2 + CONVOLUTION_SLACK) * (size_t)rows->channels;
        if (rows->row_floats > longest) longest = rows->row_floats;
    }
    find_room(run->rows);
    for (int n = 0; n < NODES; n++) {
        Rows *rows = &run->rows[n];
        /* threads touch their rows */
        rows->values =
            arena_untouched(arena, sizeof(float), 64, (size_t)rows->room * rows->row_floats);
    }
    run->nothing = arena_alloc(arena, sizeof(float), 64, longest);
}

/* ---- making them ------------------------------------------------------------------------- */

/* Sides are filled up by the picture's last row and column. */
static void fill_row(const NetworkRun *run, int y) {
    const NetworkPicture *picture = run->picture;
    const int last = picture->height - 1;
    float *row = pixels_at(&run->rows[INPUT], y);
    picture->fill(picture->user, y < last ? y : last, row);
    for (int x = picture->width; x < run->rows[INPUT].width; x++)
        memcpy(row + (size_t)x * NETWORK_STRIDE, row + (size_t)(x - 1) * NETWORK_STRIDE,
               NETWORK_STRIDE * sizeof *row);
}

static void convolve_row(const NetworkRun *run, int y, int group) {
    const Rows *in = &run->rows[nodes[run->node].from], *out = &run->rows[run->node];
    const size_t first = (size_t)group * CONVOLUTION_GROUP;
    run->convolve(
        &(ConvolutionRow){.above = y > 0 ? row_at(in, y - 1) : run->nothing,
                          .here = row_at(in, y),
                          .below = y + 1 < in->height ? row_at(in, y + 1) : run->nothing,
                          .weights = run->weights->weights + first * 9 * (size_t)in->channels,
                          .biases = run->weights->biases + first,
                          .out = pixels_at(out, y) + first,
                          .width = out->width,
                          .inputs = in->channels,
                          .outputs = out->channels});
}

static void pool_row(const NetworkRun *run, int y) {
    const Rows *in = &run->rows[nodes[run->node].from], *out = &run->rows[run->node];
    const float *upper = pixels_at(in, 2 * y), *lower = pixels_at(in, 2 * y + 1);
    float *to = pixels_at(out, y);
    const int channels = out->channels;
    for (int x = 0; x < out->width; x++, upper += 2 * channels, lower += 2 * channels)
        for (int c = 0; c < channels; c++) {
            float a = upper[c] > upper[c + channels] ? upper[c] : upper[c + channels];
            float b = lower[c] > lower[c + channels] ? lower[c] : lower[c + channels];
            *to++ = a > b ? a : b;
        }
}

static void join_row(const NetworkRun *run, int y) {
    const Rows *coarse = &run->rows[nodes[run->node].from], *out = &run->rows[run->node];
    const Rows *beside = &run->rows[nodes[run->node].beside];
    const float *above = pixels_at(coarse, y / 2), *skipped = pixels_at(beside, y);
    float *to = pixels_at(out, y);
    for (int x = 0; x < out->width; x++, to += out->channels) {
        size_t at = (size_t)(x / 2) * (size_t)coarse->channels;
        memcpy(to, above + at, (size_t)coarse->channels * sizeof *to);
        memcpy(to + coarse->channels, skipped + (size_t)x * (size_t)beside->channels,
               (size_t)beside->channels * sizeof *to);
    }
}

/* Items are the rows of a step; of a convolution, a row for each group of outputs. */
static int groups_of(const NetworkRun *run) {
    return nodes[run->node].kind == NODE_CONVOLVE
               ? run->rows[run->node].channels / CONVOLUTION_GROUP
               : 1;
}

static void make_item(void *context, int item, int worker) {
    const NetworkRun *run = context;
    const int groups = groups_of(run), y = run->rows[run->node].begin + item / groups;
    (void)worker;
    switch (nodes[run->node].kind) {
    case NODE_INPUT: fill_row(run, y); break;
    case NODE_CONVOLVE: convolve_row(run, y, item % groups); break;
    case NODE_POOL: pool_row(run, y); break;
    case NODE_JOIN: join_row(run, y); break;
    }
}

static void take_item(void *context, int item, int worker) {
    const NetworkRun *run = context;
    const int y = run->rows[DEC0].begin + item;
    (void)worker;
    if (y < run->picture->height)
        run->picture->take(run->picture->user, y, pixels_at(&run->rows[DEC0], y));
}

void network_run(const Network *network, const NetworkPicture *picture, int threads,
                 Arena scratch) {
    Convolve *builds[CONVOLUTION_BUILDS];
    NetworkRun run = {.picture = picture};
    convolution_builds(builds);
    run.convolve = builds[0];
    allocate(&run, &scratch);
    while (plan_step(run.rows)) {
        run.weights = network->layers;
        for (run.node = 0; run.node < NODES; run.node++) {
            const Rows *rows = &run.rows[run.node];
            parallel_for(threads, (rows->end - rows->begin) * groups_of(&run), make_item, &run);
            run.weights += nodes[run.node].kind == NODE_CONVOLVE;
        }
        parallel_for(threads, run.rows[DEC0].end - run.rows[DEC0].begin, take_item, &run);
    }
}
