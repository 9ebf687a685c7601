/* SPDX-License-Identifier: Apache-2.0 */
/* equip_page.h -- a model as one HTML page in which it is equipped by clicking.
 *
 * The page loads nothing from anywhere: three.js (Debian's libjs-three) draws the model,
 * whose corners stand in the page to a 16-millionth of its size, packed (page/page.h).
 * It is a picture to click in, not a frame: base colours and their textures, made small.
 *
 * Memory   scratch in the arena. Threads: one at a time.
 * Fails    ERROR_INPUT for a model without triangles, or with more than a page takes.
 */
#pragma once
#include "scene/scene.h"

#define EQUIP_TRIANGLES_MAX 4000000 /* some 60 MB of page, and a browser's patience */

/* model: as the user named it. command: what makes the page. */
bool equip_page_write(const Scene *scene, const char *model, const char *command, const char *path,
                      Arena *arena, Error *err);
