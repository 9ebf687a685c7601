/* HOT: choosing a point of an emitter. No allocation, no lock, no libm. */
#include "light/emitters.h"

#define BELOW_ONE 0x1.fffffep-1f
#define BLIND_SHARE 0.1f /* of the samples that do not look where the lit point is */
#define LOOSE 0.25f      /* intensity over power of what faces all ways: a sphere's */

static Spectrum spectrum_load(const float from[SPECTRUM_LANES])
{
    Spectrum value;
    memcpy(&value, from, sizeof value);
    return value;
}

static void spectrum_store(Spectrum value, float to[SPECTRUM_LANES])
{
    memcpy(to, &value, sizeof value);
}

/* Bilinear at column s, row t. */
static float profile_at(const EmitterProfile *profile, float s, float t)
{
    unsigned i = (unsigned)(int)s, j = (unsigned)(int)t;
    i = i < EMITTER_PROFILE_SIDE - 2 ? i : EMITTER_PROFILE_SIDE - 2;
    j = j < EMITTER_PROFILE_SIDE - 2 ? j : EMITTER_PROFILE_SIDE - 2;
    const float *row = profile->value + j * EMITTER_PROFILE_SIDE + i;
    const float *next = row + EMITTER_PROFILE_SIDE;
    float a = s - (float)(int)i, b = t - (float)(int)j;
    float near = row[0] + a * (row[1] - row[0]), far = next[0] + a * (next[1] - next[0]);
    return near + b * (far - near);
}

/* Every tile's profile in the direction (x, y, z) of its frame, of any length. Bilinear in the
 * turned octahedral map: along the diagonals x + y and x - y of the diamond that the upper half
 * of an octahedron is, seen from above. Behind a tile: 0. */
static Spectrum profile_values(const EmitterTiles *tiles, Spectrum x, Spectrum y, Spectrum z)
{
    const float  middle = 0.5f * (EMITTER_PROFILE_SIDE - 1);
    SpectrumMask front = spectrum_above(z, spectrum_all(0));
    Spectrum sum = spectrum_max(x, -x) + spectrum_max(y, -y) + spectrum_max(z, spectrum_all(0));
    Spectrum scale = spectrum_all(middle) / (sum + spectrum_all(1e-30f));
    float s[EMITTER_TILES_MAX], t[EMITTER_TILES_MAX], value[EMITTER_TILES_MAX] = {0};
    spectrum_store(spectrum_all(middle) + (x + y) * scale, s);
    spectrum_store(spectrum_all(middle) + (x - y) * scale, t);
    for (int k = 0; k < tiles->count; k++)
        value[k] = profile_at(tiles->profile[k], s[k], t[k]);
    return spectrum_select(front, spectrum_load(value), spectrum_all(0));
}

static Spectrum along_axis(const Spectrum axis[3], const Spectrum d[3])
{
    return axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2];
}

/* The probability of every tile. It follows about the illuminance that the tile gives a plane
 * that faces it. From near, where its cells are seen under all angles, and for cells that face
 * different ways, directions count less. */
static Spectrum weigh_tiles(const EmitterTiles *tiles, Vec3 from)
{
    const Spectrum one = spectrum_all(1);
    const Spectrum d[3] = {spectrum_all(from.x) - tiles->centre[0],
                           spectrum_all(from.y) - tiles->centre[1],
                           spectrum_all(from.z) - tiles->centre[2]};
    Spectrum inverse = one / (along_axis(d, d) + tiles->spread2 + spectrum_all(1e-12f));
    Spectrum near = tiles->spread2 * inverse, z = along_axis(tiles->axis[2], d);
    z = spectrum_select(tiles->both_sides, spectrum_max(z, -z), z);
    Spectrum facing = profile_values(tiles, along_axis(tiles->axis[0], d),
                                     along_axis(tiles->axis[1], d), z);
    Spectrum weight = tiles->power * inverse *
                      (facing * tiles->focus * (one - near) +
                       spectrum_all(LOOSE) * (near + one - tiles->focus));
    float sum = spectrum_sum(weight);
    if (!(sum > 0 && sum < 1e30f)) return tiles->share;
    return weight * spectrum_all((1 - BLIND_SHARE) / sum) +
           tiles->share * spectrum_all(BLIND_SHARE);
}

/* Takes the choice of a tile off *u. */
static int choose_tile(Spectrum prob, int count, float *u)
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
    const EmitterTiles *tiles = emitters->tiles;
    Spectrum      prob = weigh_tiles(tiles, from);
    float         u0 = u[0];
    int           t = choose_tile(prob, tiles->count, &u0);
    EmitterChoice chosen = tiles->cells[t][alias_sample(&tiles->choice[t], u[2])];
    *pdf_area = prob[t] * chosen.pdf_area;
    return point_of_cell(&emitters->emitters[chosen.emitter], chosen.cell, u0, u[1]);
}

float emitters_pdf_area(const Emitters *emitters, const Scene *scene, Vec3 from,
                        EmitterPoint point)
{
    const Part *part = &scene->parts[scene->triangles[point.triangle].part_id];
    int first = emitters->count ? emitters->first_of_part[part - scene->parts] : NO_ID;
    if (first == NO_ID) return 0;
    int      i = first + (int)(point.triangle - part->first_triangle);
    uint32_t cell = cell_at(&emitters->emitters[i], point.u, point.v);
    Spectrum prob = weigh_tiles(emitters->tiles, from);
    return prob[emitters->cell_tile[cell]] * emitters->cell_pdf_area[cell];
}
