/* SPDX-License-Identifier: Apache-2.0 */
/* load_progress.h -- shows how far the loading of a large scene has come, step by step.
 *
 * Nothing is shown of a step that ends soon, nor at all where load->progress_mode is
 * PROGRESS_NONE; what was shown is blanked out when its step ends.
 */
#pragma once
#include "scene/gltf/loader.h"

/* A step begins; both texts must outlive the loader. */
void load_progress_begin(Loader *load, const char *what, const char *unit, double total);

/* So much more of it is done; outside of steps nothing happens. */
void load_progress_add(Loader *load, double more);

void load_progress_end(Loader *load);
