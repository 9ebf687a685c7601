/* SPDX-License-Identifier: Apache-2.0 */
/* review_members.h -- tables of which JSON keys hold which members of a struct; private to the
 * output.
 *
 * Threads  plain data.
 */
#pragma once
#include <stddef.h>

typedef enum MemberKind {
    MEMBER_FIGURE,  /* double; NaN is null */
    MEMBER_TEXT,    /* NULL is null */
    MEMBER_RANGE,   /* two doubles, one behind the other */
    MEMBER_FLAG,
    MEMBER_COUNT,   /* long, 0 or more */
    MEMBER_VERDICT,
    MEMBER_AMBIENT,
    MEMBER_WORD,    /* an enum's, of `size` words at `words` */
    MEMBER_OBJECT,  /* members of the same struct, or of one in it */
    MEMBER_IF,      /* the same; null where the bool at `count` is false */
    MEMBER_TEXTS,   /* a pointer, and an int at `count` */
    MEMBER_LIST,    /* likewise */
    MEMBER_LIMIT,   /* of a case: the limit that limit_id means, or null */
    MEMBER_JUDGED,  /* of a case: the limit that made its verdict (case_worst_limit), or null */
    MEMBER_REASON,  /* Unjudged; null: it can be judged */
    MEMBER_OPEN     /* OpenBy; null: it is not open */
} MemberKind;

/* Older reviews may lack it; it is written and not read back. */
typedef enum MemberUse { ALWAYS, SINCE, WRITTEN } MemberUse;

/* A table of them ends with a key that is NULL. */
typedef struct Member {
    const char   *key;
    MemberKind    kind;
    size_t        offset;
    MemberUse     use;
    const struct Member *of; /* what is in an object, or in a list's items, */
    size_t        count;     /* offset, */
    size_t        size;      /* bytes of an item */
    const char *const *words;
} Member;

/* A member under a key; and under its own name. */
#define AS(key, KIND, Type, member) {key, MEMBER_##KIND, .offset = offsetof(Type, member)}
#define LATER(key, KIND, Type, member)                                                         \
    {key, MEMBER_##KIND, .offset = offsetof(Type, member), .use = SINCE}
#define OWN(KIND, Type, member) AS(#member, KIND, Type, member)
#define LIST_OF_USE(use, key, Type, member, number, table, Item)                               \
    {key, MEMBER_LIST, offsetof(Type, member), use, table, offsetof(Type, number),             \
     sizeof(Item), NULL}
#define LIST(key, Type, member, number, table, Item)                                           \
    LIST_OF_USE(ALWAYS, key, Type, member, number, table, Item)
#define LIST_SINCE(key, Type, member, number, table, Item)                                     \
    LIST_OF_USE(SINCE, key, Type, member, number, table, Item)

/* What is read back of a whole review (review_json.c). */
extern const Member review_members[];
