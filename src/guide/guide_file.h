/* guide_file.h -- a guide as a file, and as a number that tells it from others.
 *
 * The file: a head (magic, version, counts, hash), the tree's nodes, then every cell's bins and
 * probabilities; numbers little-endian as they lie. A reader takes nothing on trust: a tree
 * that does not part its box, or a number out of its range, is refused.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "guide/guide.h"

#define GUIDE_VERSION 2u

/* All that decides where a guide leads; never 0. */
uint64_t guide_hash(const LightGuide *guide);

bool guide_write(const char *path, const LightGuide *guide, Arena scratch, Error *err);

/* has[set]: the scene has lights of the set, so that a cell must ask for them now and then. */
bool guide_read(const char *path, const bool has[GUIDE_LIGHTS], Arena *arena,
                const LightGuide **out, Error *err);
