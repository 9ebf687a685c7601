/* HOT: choosing a point of an emitter. No allocation, no lock, no libm. */
#include "light/emitter_tiles.h"

#define BELOW_ONE 0x1.fffffep-1f
#define BLIND_SHARE 0.1f /* of the samples that do not look where the lit point is */
#define LOOSE 0.25f      /* intensity over power of what faces all ways: a sphere's */

/* Bilinear in the turned octahedral map: along the diagonals x + y and x - y of the diamond
 * that the upper half of an octahedron is seen from above. */
static float profile_value(const EmitterProfile *profile, Vec3 d)
{
    if (!(d.z > 0)) return 0;
    float scale = 0.5f * (EMITTER_PROFILE_SIDE - 1) / (fabsf(d.x) + fabsf(d.y) + d.z);
    float middle = 0.5f * (EMITTER_PROFILE_SIDE - 1);
    float s = middle + (d.x + d.y) * scale, t = middle + (d.x - d.y) * scale;
    int   i = (int)s, j = (int)t;
    if (i > EMITTER_PROFILE_SIDE - 2) i = EMITTER_PROFILE_SIDE - 2;
    if (j > EMITTER_PROFILE_SIDE - 2) j = EMITTER_PROFILE_SIDE - 2;
    const float *row = profile->value + j * EMITTER_PROFILE_SIDE + i;
    const float *next = row + EMITTER_PROFILE_SIDE;
    s -= (float)i;
    t -= (float)j;
    return lerpf(lerpf(row[0], row[1], s), lerpf(next[0], next[1], s), t);
}

/* About the illuminance that a tile gives a plane that faces it. From near, where its cells are
 * seen under all angles, and for cells that face different ways, directions count less. */
static float importance(const EmitterTile *tile, Vec3 from)
{
    Vec3  d = vec3_sub(from, tile->centre);
    float d2 = vec3_dot(d, d) + 1e-12f, sum2 = d2 + tile->spread2;
    Vec3  w = vec3_scale(d, 1 / sqrtf(d2));
    float facing = vec3_dot(tile->normal, w), near = tile->spread2 / sum2;
    if (tile->profile) facing = profile_value(tile->profile, frame_to_local(&tile->frame, w));
    else facing = tile->both_sides ? fabsf(facing) : fmaxf(facing, 0);
    return tile->power * (facing * (1 - near) + LOOSE * (near + tile->looseness)) / sum2;
}

/* The probability of every tile. */
static void weigh_tiles(const Emitters *emitters, Vec3 from, float *prob)
{
    float sum = 0;
    int   count = emitters->tile_count;
    for (int i = 0; i < count; i++) sum += prob[i] = importance(&emitters->tiles[i], from);
    float scale = sum > 0 && sum < 1e30f ? (1 - BLIND_SHARE) / sum : 0;
    for (int i = 0; i < count; i++)
        prob[i] = prob[i] * scale +
                  (scale > 0 ? BLIND_SHARE : 1) * emitters->tiles[i].share;
}

/* Takes the choice of a tile off *u. */
static int choose_tile(const float *prob, int count, float *u)
{
    float below = 0;
    int   i = 0;
    while (i + 1 < count && *u >= below + prob[i]) below += prob[i++];
    *u = clampf((*u - below) / prob[i], 0, BELOW_ONE);
    return i;
}

static uint32_t cell_at(const Emitter *emitter, float u, float v)
{
    int side = emitter->side, i = (int)(u * (float)side), j = (int)(v * (float)side);
    i = i > side - 1 ? side - 1 : i < 0 ? 0 : i;
    j = j > side - 1 - i ? side - 1 - i : j < 0 ? 0 : j;
    float over = u * (float)side - (float)i + v * (float)side - (float)j;
    bool  is_turned = over > 1 && i + j < side - 1;
    return emitter->first_cell + (uint32_t)(2 * side * i - i * i + 2 * j + is_turned);
}

static EmitterPoint point_of_cell(const Emitter *emitter, uint32_t cell, float u0, float u1)
{
    EmitterCell at = emitter_cell(emitter, cell);
    float root = sqrtf(u0), a = root * (1 - u1), b = root * u1; /* uniform on the triangle */
    float step = 1 / (float)at.side;
    if (at.is_turned) {
        a = 1 - a;
        b = 1 - b;
    }
    return (EmitterPoint){emitter->triangle, ((float)at.i + a) * step,
                          ((float)at.j + b) * step};
}

EmitterPoint emitters_sample(const Emitters *emitters, Vec3 from, const float u[3],
                             float *pdf_area)
{
    float prob[EMITTER_TILES_MAX], u0 = u[0];
    weigh_tiles(emitters, from, prob);
    int                t = choose_tile(prob, emitters->tile_count, &u0);
    const EmitterTile *tile = &emitters->tiles[t];
    uint32_t           cell = tile->cells[alias_sample(&tile->choice, u[2])];
    *pdf_area = prob[t] * emitters->cell_pdf_area[cell];
    return point_of_cell(&emitters->emitters[emitters->cell_emitter[cell]], cell, u0, u[1]);
}

float emitters_pdf_area(const Emitters *emitters, const Scene *scene, Vec3 from,
                        EmitterPoint point)
{
    const Part *part = &scene->parts[scene->triangles[point.triangle].part_id];
    int first = emitters->count ? emitters->first_of_part[part - scene->parts] : NO_ID;
    if (first == NO_ID) return 0;
    float    prob[EMITTER_TILES_MAX];
    int      i = first + (int)(point.triangle - part->first_triangle);
    uint32_t cell = cell_at(&emitters->emitters[i], point.u, point.v);
    weigh_tiles(emitters, from, prob);
    return prob[emitters->cell_tile[cell]] * emitters->cell_pdf_area[cell];
}
