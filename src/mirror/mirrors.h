/* mirrors.h -- the smooth surfaces of a scene, in order, to find what they reflect.
 *
 * A mirror is a triangle whose material sends part of the light on by a smooth boundary about
 * the interpolated normal: glass, lacquer, polished metal, the glass of displays. What is bent
 * by a normal map, or smooth only where a texture says so, is none. Which mirrors are asked for
 * which part of the scene is the caller's choice.
 *
 * Memory   from the arena.  Threads  const after mirrors_build.  Fails  never.
 */
#pragma once
#include "mirror/reflection_point.h"
#include "scene/scene.h"

/* Can the material's triangles be mirrors? */
bool mirrors_can_be(const Scene *scene, const Material *material);

/* A mirror that is asked for by points of a part; part_id may be NO_ID: by points of none. */
typedef struct MirrorPair {
    int      part_id;
    uint32_t triangle;
} MirrorPair;

typedef struct Mirrors Mirrors;

/* pairs: sorted by part, then triangle, each once; NULL for none of them. */
const Mirrors *mirrors_build(const Scene *scene, const MirrorPair *pairs, uint32_t count,
                             Arena *arena);

bool mirrors_have(const Mirrors *mirrors, MirrorPair pair);

/* Told of a reflection: which triangle of the scene, and where on it. */
typedef void MirrorFound(void *user, uint32_t triangle, const ReflectionPoint *point);

/* All points of the part's mirrors that turn light from direction `towards` (unit) to the point
 * `from`, in an order that the scene alone decides. What stands between is not asked. */
void mirrors_find(const Mirrors *mirrors, int part_id, Vec3 from, Vec3 towards,
                  MirrorFound *found, void *user);
