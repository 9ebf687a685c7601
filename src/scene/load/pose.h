/* SPDX-License-Identifier: Apache-2.0 */
/* pose.h -- where the nodes of a file stand at a time: its animations, played.
 *
 * At rest (SceneState without a time) nothing is played. With one, the animations that are
 * named are played, or all where none is; two of them must not move the same thing. Before its
 * first key frame and after its last a channel keeps that frame's value (glTF 2.0, 3.11).
 *
 * Units    seconds since the animations' start.
 * Memory   poses lie in the loader's scratch.
 * Fails    into the loader's problems, with the channel.
 * Threads  one at a time.
 */
#pragma once
#include "scene/gltf/loader.h"

/* The values that animations give a node; NULL: the node's own. */
typedef struct NodePose {
    const float *translation;   /* 3, m */
    const float *rotation;      /* 4: x, y, z, w; a unit quaternion to within rounding */
    const float *scale;         /* 3 */
    const float *weights;       /* one a morph target of its mesh */
    const float *visible;       /* 1: not 0 where the node and what is below it is shown */
    const GltfValue *movers[5]; /* the channel of each of these; NULL: none */
} NodePose;

/* Notes the file's animations and sets file->poses. The document has passed the check. */
void pose_build(GltfFile *file);

/* Reports what the options request and no file has: names of variants and animations, or any
 * animation at all. After the last file. */
void pose_report_missing(Loader *load);
