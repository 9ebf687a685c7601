/* SPDX-License-Identifier: Apache-2.0 */
/* identity.h -- what decides the light of a scene, as text: two that are equal give the same
 * samples, so that what was traced for one may stand for the other.
 *
 * One line for each thing, "name<TAB>value\n", always in the same order. Files stand with their
 * name and the hash of their bytes, without their folder, so that a folder may move. Numbers
 * are exact (all digits that distinguish a float or a double from its neighbours).
 *
 * Memory   the text's arena.  Threads  no shared state.  Fails  never.
 */
#pragma once
#include "kernel/kernel.h"
#include "text/text.h"

/* Control characters of the value become '?', so that a line stays a line. */
void identity_line(Text *text, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void identity_number(Text *text, const char *name, double value);
void identity_float(Text *text, const char *name, float value);
void identity_vector(Text *text, const char *name, Vec3 v);

/* Version, sources, instruction set, ray tracer. */
void identity_add_program(Text *text, const Kernel *kernel);

/* Files, decoded pictures, what displays show and how bright, luminaires. options: those by
 * which it was loaded. */
void identity_add_scene(Text *text, const SceneOptions *options, const Scene *scene);

/* The scene's surroundings as they are now. */
void identity_add_environment(Text *text, const Scene *scene);

void identity_add_camera(Text *text, const SceneCamera *camera);

/* The first line that differs, as a phrase for an error ("seed: 1 there, 2 here", "none" where
 * one of them has no such line; "layers: uv there, not here"); NULL when the texts are
 * the same. */
const char *identity_difference(const char *there, const char *here, Arena *arena);

/* Whether both are of one program, on one instruction set (identity_add_program). */
bool identity_same_program(const char *there, const char *here);
