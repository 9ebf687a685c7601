/* noise_goal.h -- what --noise asks for: a relative error, and the pixels whose error it is.
 *
 *     R                 of the whole frame (or crop)
 *     display:R         of the pixels that show a display
 *     display:NAME:R    of those that show this one
 *     X0,Y0,X1,Y1:R     of a rectangle of the frame, half-open as --crop's
 */
#pragma once
#include "cli/render/render_request.h"

/* Fills noise and noise_area of the request's options, and its noise_display; crop and size
 * stand there already. */
bool noise_goal_parse(const char *text, Arena *arena, RenderRequest *request, Error *err);

/* Finds the display of that name in the loaded scene. */
bool noise_goal_find(const Scene *scene, Arena scratch, RenderRequest *request, Error *err);

/* The pixels that counted, as the user named them: "the frame", "the displays". */
const char *noise_goal_words(const RenderRequest *request, Arena *arena);
