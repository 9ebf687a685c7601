/* SPDX-License-Identifier: Apache-2.0 */
/* outlook_picture.h -- what a surface sees, as a picture and in words.
 *
 * Memory   from the arena.  Threads  pure functions.
 */
#pragma once
#include "image/picture.h"
#include "review/chain/outlook.h"

/* In false colour with its scale; the mirror direction is ringed, the sun a disc with rays. */
Picture outlook_picture(const Outlook *outlook, Arena *arena);

/* "41 % sky through Windscreen (glass), 22 % sun ...; the mirror image is FrontSeat_L ..." */
const char *outlook_words(const Outlook *outlook, Arena *arena);
