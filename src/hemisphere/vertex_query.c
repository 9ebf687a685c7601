#include "base/mathf.h"
#include "hemisphere/vertex_view.h"

/* Where a place lies on one level: its unit cell, and which half of it. The corner c of the
 * triangle is the cell's corner (0, 0), of the upper half (1, 1); u and v are the barycentric
 * coordinates of the corners that lie along x and along y from it. */
typedef struct Cell {
    int   x, y;
    int   upper; /* 0 or 1 */
    float u, v;
} Cell;

static inline Cell cell_at(VertexPlace place, int level)
{
    int   n = 1 << level;
    float x = place.x * (float)n, y = place.y * (float)n;
    Cell  cell = {.x = (int)x, .y = (int)y};
    float u = x - (float)cell.x, v = y - (float)cell.y;
    cell.upper = u + v > 1;
    cell.u = cell.upper ? 1 - u : u;
    cell.v = cell.upper ? 1 - v : v;
    return cell;
}

/* The base level's three rows. */
static void put_base(const Tree *tree, VertexPlace place, TreeTaps *taps)
{
    VertexLattice lattice = {tree->base_level, tree->octants};
    VertexPoint   point = vertex_point(lattice, place);
    for (int i = 0; i < 3; i++) {
        taps->row[i] = point.vertex[i] * tree->base_bytes;
        taps->weight[i] = point.weight[i] * tree->base_factor;
        taps->level[i] = 0;
    }
    taps->count = 3;
}

/* Writes a tap for the new vertex (x, y) of a level, and counts it if there is such a detail:
 * that cannot be predicted, so there is no branch. */
static inline void put_detail(const Tree *tree, const VertexLevel *level, int x, int y,
                              uint32_t edge, float weight, TreeTaps *taps)
{
    uint32_t cx = (uint32_t)((x >> 1) - level->x), cy = (uint32_t)((y >> 1) - level->y);
    uint32_t bx = cx / VERTEX_BLOCK_SIDE, by = cy / VERTEX_BLOCK_SIDE;
    uint32_t inside = (uint32_t)(bx < level->width) & (uint32_t)(by < level->height);
    uint32_t place = inside ? by * level->width + bx : 0;
    uint32_t word = tree->words[level->first_word + place / 32], below = 1u << place % 32;
    uint32_t block = level->first_block + tree->ranks[level->first_word + place / 32] +
                     vertex_count_bits(word & (below - 1));
    uint64_t bits = tree->blocks[block];
    uint32_t bit = cy % VERTEX_BLOCK_SIDE * 12 + cx % VERTEX_BLOCK_SIDE * 3 + edge;
    uint32_t start = (uint32_t)(bits >> VERTEX_BLOCK_BITS) << level->shift;
    uint8_t  format = tree->block_formats[block];
    uint32_t row = vertex_count_bits(bits & ((1ull << bit) - 1));
    int      at = taps->count;
    taps->row[at] =
        level->first_byte + start + row * vertex_format_bytes(tree->formats[format]);
    taps->weight[at] = weight;
    taps->level[at] = format;
    taps->count += (int)(inside & (uint32_t)((word & below) != 0) & (uint32_t)(bits >> bit) &
                         (uint32_t)(weight > 0));
}

static inline float least(float a, float b)
{
    return a < b ? a : b;
}

/* A new vertex's hat function in a triangle whose corners have the coordinates a and b at the
 * edge's ends and c opposite: 2 b at a's end, 2 a at b's end, 1 - 2 c in the middle. */
static inline float hat(float a, float b, float c)
{
    return 2 * least(least(a, b), 0.5f - c);
}

static inline void put_level(const Tree *tree, const VertexLevel *level, VertexPlace place,
                             int number, TreeTaps *taps)
{
    Cell  cell = cell_at(place, number);
    float u = cell.u, v = cell.v, w = 1 - u - v;
    float factor = float_from_bits((uint32_t)(127 + level->exponent) << 23);
    int   sx = place.octant & 1 ? -1 : 1, sy = place.octant & 2 ? -1 : 1;
    int   x = sx * (2 * cell.x + 1), y = sy * (2 * cell.y + 1);
    put_detail(tree, level, x, sy * 2 * (cell.y + cell.upper), 0, hat(u, w, v) * factor, taps);
    put_detail(tree, level, sx * 2 * (cell.x + cell.upper), y, 1, hat(v, w, u) * factor, taps);
    put_detail(tree, level, x, y, 2, hat(u, v, w) * factor, taps);
}

/* How many levels have details around a place. */
static inline int depth_at(const Tree *tree, VertexPlace place)
{
    int      side = 1 << VERTEX_DEPTH_LEVEL;
    int      x = (int)(place.x * (float)side), y = (int)(place.y * (float)side);
    x = x < side ? x : side - 1;
    y = y < side ? y : side - 1;
    int      cx = place.octant & 1 ? -1 - x : x, cy = place.octant & 2 ? -1 - y : y;
    uint32_t at = (uint32_t)((cy + (tree->octants == 2 ? 0 : side)) * 2 * side + cx + side);
    return tree->depths[at / 2] >> at % 2 * 4 & 15;
}

void vertex_tree_walk_place(const Tree *tree, int level, VertexPlace place, TreeTaps *taps)
{
    put_base(tree, place, taps);
    for (int q = 0; q < 4; q++) taps->mean_weight[q] = 0;
    int depth = depth_at(tree, place);
    if (depth > level - tree->base_level) depth = level - tree->base_level;
    for (int l = 0; l < depth; l++)
        put_level(tree, &tree->levels[l], place, tree->base_level + l, taps);
}

void vertex_tree_walk(const Tree *tree, int level, Vec3 direction, TreeTaps *taps)
{
    VertexPlace place = vertex_place(tree->geodesic, tree->plane_level, direction);
    place.octant &= (uint32_t)tree->octants - 1; /* 2 octants: y is folded */
    vertex_tree_walk_place(tree, level, place, taps);
}
