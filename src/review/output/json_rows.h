/* SPDX-License-Identifier: Apache-2.0 */
/* json_rows.h -- short names for the rows (record/record.h) of review.json; who uses
 * them includes case_json.h. */
#pragma once
#include <limits.h>
#include <math.h>
#include <stddef.h>

#include "record/record_write.h"

#define MUST RECORD_REQUIRED /* else older reviews may lack it */

/* A member under a key, and under its own name; one that older reviews may lack. */
#define AS_FIGURE(key, flag, Type, member) \
    {key, RECORD_NUMBER, RECORD_NULL | (flag), RECORD_AT(Type, member), \
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL)}
#define AS_TEXT(key, flag, Type, member) \
    {key, RECORD_TEXT, RECORD_NULL | (flag), RECORD_AT(Type, member)}
#define AS_RANGE(key, flag, Type, member) \
    {key, \
     RECORD_NUMBERS, \
     RECORD_NULL | (flag), \
     RECORD_AT(Type, member), \
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL), \
     RECORD_COUNT(2, 2)}
#define AS_FLAG(key, flag, Type, member) {key, RECORD_FLAG, flag, RECORD_AT(Type, member)}
#define AS_COUNT(key, flag, Type, member) \
    {key, RECORD_INTEGER, RECORD_LONG | (flag), RECORD_AT(Type, member), RECORD_RANGE(0, 1e18)}
#define AS_WORD(key, flag, Type, member, list) \
    {key, RECORD_CHOICE, flag, RECORD_AT(Type, member), .words = list}
#define AS_AMBIENT(key, flag, Type, member) AS_WORD(key, flag, Type, member, ambient_names)
#define AS_REASON(key, flag, Type, member) \
    AS_WORD(key, RECORD_NULL | (flag), Type, member, unjudged_names + 1)
#define AS_OPEN(key, flag, Type, member) \
    AS_WORD(key, RECORD_NULL | (flag), Type, member, open_names + 1)
#define AS_VERDICT(key, flag, Type, member) \
    {key, \
     RECORD_CHOICE, \
     flag, \
     RECORD_AT(Type, member), \
     .words = verdict_names, \
     .read = case_read_verdict}
#define AS(key, KIND, Type, member) AS_##KIND(key, MUST, Type, member)
#define LATER(key, KIND, Type, member) AS_##KIND(key, 0, Type, member)
#define OWN(KIND, Type, member) AS(#member, KIND, Type, member)
#define LIST(key, flag, Type, member, number, table) \
    {key, RECORD_LIST, flag, RECORD_MANY(Type, member, number), .of = &table}
#define PART(key, flag, Type, member, table) \
    {key, RECORD_OBJECT, flag, RECORD_AT(Type, member), .of = &table}
/* Of a document that is kept (record_keep). */
#define KEPT(key, KIND, ...) AS_##KIND(key, RECORD_KEPT | RECORD_NULL, __VA_ARGS__)
#define KEPT_LIST(key, Type, member, number, table) \
    LIST(key, RECORD_KEPT | RECORD_BRIEF, Type, member, number, table)
#define AS_INT(key, flag, Type, member) \
    {key, RECORD_INTEGER, flag, RECORD_AT(Type, member), RECORD_RANGE(-1, INT_MAX)}
#define AS_POINT(key, flag, Type, member) \
    {key, \
     RECORD_NUMBERS, \
     flag, \
     RECORD_AT(Type, member), \
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL), \
     RECORD_COUNT(3, 3)}
#define AS_POINTS(key, flag, Type, member, number) \
    {key, RECORD_FLOATS, flag, RECORD_MANY(Type, member, number), RECORD_COUNT(3, 3)}
#define TOLD(key, flag, function) {key, RECORD_OWN, RECORD_WRITTEN | (flag), .write = function}

/* The rows of a struct, and what reads and writes them; PUBLIC_TABLE: of case_json.h. */
#define PUBLIC_TABLE(name, Type, ...) \
    static const RecordRow name##_rows[] = {__VA_ARGS__, {0}}; \
    const RecordFormat name = {#name, sizeof(Type), name##_rows, .takes_more = true}
#define TABLE(name, Type, ...) \
    static const RecordRow name##_rows[] = {__VA_ARGS__, {0}}; \
    static const RecordFormat name = {#name, sizeof(Type), name##_rows, .takes_more = true}

/* A range is read and written as two numbers, one behind the other. */
#define FOLLOWS(Type, second, first) \
    _Static_assert(offsetof(Type, second) == offsetof(Type, first) + sizeof(double), "a pair")
