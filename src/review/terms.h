/* SPDX-License-Identifier: Apache-2.0 */
/* terms.h -- what a review says of a failure and what to do about it: every sentence once, so
 * that somebody can read them aloud. Labels, terms of art first; figures come with their units.
 *
 * Units    as the texts say; levels in per cent of what a panel was measured with.
 */
#pragma once

/* ---- what was found ---------------------------------------------------------------------- */

#define TERM_MINIMUM "minimum %s"
#define TERM_MAXIMUM "maximum %s"
#define TERM_BELOW "%s %% below the %s" /* minimum, maximum */
#define TERM_ABOVE "%s %% above the %s"
#define TERM_TIMES "%s times the %s"
#define TERM_FAR_ABOVE "far above the %s"
#define TERM_FAR_BELOW "far below the %s"
#define TERM_ON "on the %s"
#define TERM_FOUND "%s %s%s%s (%s)" /* contrast 1.59 : 1 in direct sun (minimum 2 : 1) */
#define TERM_OPEN "%s %s%s%s, 95 %% interval %s to %s (%s)"
#define TERM_NO_LIMIT "no limit %s in this profile"
#define TERM_KNOWN_WITHIN "; known within %s, %s required"
#define TERM_HIDDEN_BY "; hidden by "
#define TERM_SEEN "visible: %s (more than %s needed)"
#define TERM_UNSEEN "nothing of it is seen"
#define TERM_UNSEEN_BY_MIDDLE \
    "nothing of it is seen from the middle of the eye's box, by which " \
    "a sweep counts; from other places it is"
#define TERM_PANEL_UNUSABLE "panel not usable, by its own file"
#define TERM_WITHOUT_DATA \
    "%s of the reflected light via materials without optical data " \
    "(maximum %s)"
#define TERM_UNKNOWN "%s could not be found out"
#define TERM_MUST_NOT "must not be read"
#define TERM_OTHER_PART \
    "judged at another part of the symbol: %.0f to %.0f %% across its content, %.0f to %.0f %% down"

#define TERM_COLOUR_AT_WORST "; colour judged at their worst alone"

/* ---- what to do -------------------------------------------------------------------------- */

#define TERM_RAISE "raise the brightness level from %s to %s"
#define TERM_DIM "dim from %s to %s"
#define TERM_DIM_DISPLAY "dim %s from %s to %s"
#define TERM_DIM_ALL "dim all displays to %s of their present brightness levels"
#define TERM_DIM_IMAGE "dim %s to %s of its present brightness level"
#define TERM_TOWARDS " towards this eye"
#define TERM_THEN "; then %s (%s) %s: %s %s (%s)%s" /* what the level breaks */
#define TERM_REFLECT_LESS \
    "no brightness level up to %s is enough; reflected light: %s cd/m² at most " \
    "(now %s): hood, tilt or coating"
#define TERM_LESS_LIGHT \
    "no brightness level up to %s is surely enough: less reflected light: hood, tilt or coating"
#define TERM_PURER "larger or bolder characters, purer colours, or less reflected light"
#define TERM_SOFTER "softer colours of the content"
#define TERM_CONTENT "no light or level matters: the content itself has %s : 1"
#define TERM_NO_LEVEL_HIDES "no level hides it: a privacy state or film"
#define TERM_NO_LEVEL_DIMS "no level is enough: move, tilt or shade %s"
#define TERM_NOTHING_HERE "no display helps: all other light makes %s (%s)"
#define TERM_DARKER "a darker or matt finish of %s, which %s mirrors"
#define TERM_SHADE "shade what lies bright in view"
#define TERM_MATT "matt, tilt or shade %s"
#define TERM_NO_LEVEL_DOES_BOTH "no level of %s does both: the road allows %s, %s needs %s"
#define TERM_TALLER "characters %s times as high"
#define TERM_SMALLER "characters %s times as high at most"
#define TERM_STROKES "strokes %s times as wide"
#define TERM_MORE_PATHS \
    "more paths decide it: a lower \"contrast\" and more \"paths\" of " \
    "\"precision\""
#define TERM_NO_PATHS "no number of paths decides it: the limit lies within %s"
#define TERM_MOVE_HIDER \
    "move what hides it, the display or the eye; or \"visible\": " \
    "\"optional\" of the symbol, if this eye need not see it"
#define TERM_USABLE_PANEL \
    "a usable panel file: measured or fitted anew from finer data " \
    "(`parhelion panel info` says what this one lacks)"
#define TERM_GIVE_DATA \
    "colours or spectra for these materials, in the model or by `equip`; " \
    "`parhelion check` names them"
#define TERM_GIVE_LIMIT "a profile with a limit for this light"
#define TERM_GIVE_BACKGROUND "a rectangle of the content that holds the symbol and its background"
#define TERM_GIVE_AGE "an observer of an age for which the visibility level is published"
#define TERM_EMPTY_SEAT \
    "its back, %s: %s of the reflected light; add an occupant: `equip`, or " \
    "\"with\" in the request"
