/* SPDX-License-Identifier: Apache-2.0 */
/* rows.h -- the usual rows of a format, short enough for a line: only for files of rows.
 *
 * OWNER is the struct that the rows fill; flags are those of record.h, 0: none. words: one
 * sentence on the key, or NULL.
 */
#pragma once
#include "record/record.h"

#define MUST RECORD_REQUIRED

#define NUMBER(key, flag, member, bottom, top, words) \
    {key, RECORD_NUMBER, flag, RECORD_AT(OWNER, member), RECORD_RANGE(bottom, top), .doc = words}
#define WHOLE(key, flag, member, bottom, top, words) \
    {key, RECORD_INTEGER, flag, RECORD_AT(OWNER, member), RECORD_RANGE(bottom, top), .doc = words}

/* So many numbers in place; up to so many, and how many; a list in the arena. */
#define VECTOR(key, flag, member, size, bottom, top, words) \
    {key, \
     RECORD_NUMBERS, \
     flag, \
     RECORD_AT(OWNER, member), \
     RECORD_RANGE(bottom, top), \
     .least = size, \
     .most = size, \
     .doc = words}
#define WHOLES(key, flag, member, size, bottom, top, words) \
    { \
        key, \
        RECORD_WHOLES, \
        flag, \
        RECORD_AT(OWNER, member), \
        RECORD_RANGE(bottom, top), \
        .least = size, \
        .most = size, \
        .doc = words}
#define NUMBERS(key, flag, member, counted, size, bottom, top, words) \
    {key, \
     RECORD_NUMBERS, \
     flag, \
     RECORD_AT(OWNER, member), \
     RECORD_RANGE(bottom, top), \
     .least = 1, \
     .most = size, \
     .count = offsetof(OWNER, counted), \
     .doc = words}
#define FIGURES(key, flag, member, counted, fewest, size, bottom, top, words) \
    {key, \
     RECORD_FIGURES, \
     flag, \
     RECORD_AT(OWNER, member), \
     RECORD_RANGE(bottom, top), \
     .least = fewest, \
     .most = size, \
     .count = offsetof(OWNER, counted), \
     .doc = words}

#define FLAG(key, flag, member, words) \
    {key, RECORD_FLAG, flag, RECORD_AT(OWNER, member), .doc = words}
#define TEXT(key, flag, member, words) \
    {key, RECORD_TEXT, flag, RECORD_AT(OWNER, member), .doc = words}
#define PATH(key, flag, member, words) \
    {key, RECORD_PATH, flag, RECORD_AT(OWNER, member), .doc = words}
#define NOTE(key, flag, words) {key, RECORD_NOTE, flag, .doc = words}
#define CHOICE(key, flag, member, list, words_doc) \
    {key, RECORD_CHOICE, flag, RECORD_AT(OWNER, member), .words = list, .doc = words_doc}

/* One object; one that may be absent, and whether it is there; a list of them. */
#define OBJECT(key, flag, member, format, words) \
    {key, RECORD_OBJECT, flag, RECORD_AT(OWNER, member), .of = &format, .doc = words}
#define PART(key, member, is_there, format, words) \
    {key, \
     RECORD_OBJECT, \
     RECORD_AT(OWNER, member), \
     .of = &format, \
     .count = offsetof(OWNER, is_there), \
     .doc = words}
#define LIST(key, flag, member, counted, fewest, size, format, words) \
    {key, \
     RECORD_LIST, \
     flag, \
     RECORD_AT(OWNER, member), \
     .least = fewest, \
     .most = size, \
     .of = &format, \
     .count = offsetof(OWNER, counted), \
     .doc = words}
#define MAP(key, flag, member, counted, size, format, words) \
    {key,         RECORD_MAP,   flag,          RECORD_AT(OWNER, member), \
     .least = 1,  .most = size, .of = &format, .count = offsetof(OWNER, counted), \
     .doc = words}

/* A readable file; a list of some. */
#define A_FILE(key, flag, member, words) \
    {key, RECORD_FILE, flag, RECORD_AT(OWNER, member), .doc = words}
#define FILES(key, flag, member, counted, size, words) \
    LIST(key, flag, member, counted, 1, size, record_files, words)
