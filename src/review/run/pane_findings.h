/* SPDX-License-Identifier: Apache-2.0 */
/* pane_findings.h -- displays as glass shows them to each eye, in a setup that is lit, held
 * against what the request allows where the eye must see past them.
 *
 * An eye of several points counts by its middle.
 *
 * Memory   texts and lists lie in the arena. Threads: starts its own; the same figures for any
 *          count.
 */
#pragma once
#include "review/light/setup.h"
#include "review/pane_verdict.h"
#include "review/profile.h"

/* Adds to the review's list. Fails where an eye's camera is missing. */
bool setup_pane_images(const Setup *setup, const Profile *profile, Arena *arena, Review *review,
                       Error *err);
