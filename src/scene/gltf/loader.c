/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/loader.h"

bool load_is_within_reach(const Loader *load, Vec3 p, double world_m[3]) {
    bool is_near = true;
    world_from_scene(load->origin, p, world_m);
    for (int i = 0; i < 3; i++) is_near &= fabs(world_m[i]) <= (double)SCENE_MOST_M;
    return is_near;
}

void load_progress_begin(Loader *load, const char *what, const char *unit, double total) {
    load->progress = progress_start(load->progress_mode, what, unit, total);
    load->progress_done = 0;
    load->has_step = true;
}

void load_progress_add(Loader *load, double more) {
    if (!load->has_step) return;
    load->progress_done += more;
    progress_update(&load->progress, load->progress_done);
}

void load_progress_end(Loader *load) {
    if (load->has_step && load->progress.shown_columns) progress_clear(&load->progress);
    load->has_step = false;
}
