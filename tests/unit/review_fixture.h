/* SPDX-License-Identifier: Apache-2.0 */
/* review_fixture.h -- a REVIEW.json that says all that one can say, and the files it names. */
#pragma once
#include "fixture.h"
#include "review/request/request_read.h"

/* ' stands for ". */
static const char review_good[] =
    "{'title':'All of it','scene':['a.gltf','b%20c.gltf'],'forward':[0,0,-2],"
    "'eyes':{'driver':{'camera':'eye'},'second':{'camera':1},'tall':{'position_m':[-1,2,3]},"
    "'box':{'centre_m':[1,2,3],'half_size_m':[0.1,0.2,0],'grid':[2,3,1]}},"
    "'observer':{'age_years':60,'pigment':1},"
    "'gaze':[{'at':'symbols'},{'name':'road','direction':[0,0,-4],'eyes':['tall','driver']}],"
    "'with':{'somebody':['a.gltf']},"
    "'symbols':{'speed':{'display':'cluster','content':'p.png','uv':[0.1,0.2,0.3,0.4],"
    "'polarity':'light-on-dark'},'text':{'display':'node:screen','find':'text'},"
    "'drawn':{'display':'cluster','mask':'p.png'}},"
    "'profile':'iso-15008',"
    "'levels':{'night':{'*':0.04,'cluster':0.1},'auto':{'sensor':{'position_m':[0,1,2],"
    "'normal':[0,3,4]},'table_lx':[[0,0.02],[100,0.1],[10000,1]]}},"
    "'precision':{'contrast':0.02,'paths':10000,'seed':7},"
    "'frames':{'size':[640,360],'noise':0.1,'worst':2},"
    "'conditions':[{'name':'noon','environment':{'type':'sky',"
    "'when':'2026-06-21T12:00+02:00','where':[48.14,11.58,520],'heading_deg':30},"
    "'level':'auto','with':'somebody','polarity':'dark-on-light',"
    "'contents':{'cluster':'p.png'}},"
    "{'name':'night','lights':['b%20c.gltf'],'level':'night','heading_deg':-20,"
    "'polarity':{'text':'dark-on-light'}},"
    "{'name':'any sun','sweep':{'sun':{'azimuth_deg':[0,360,90],'elevation_deg':[5,5,1]},"
    "'sky':'sky'}},"
    "{'name':'a year','environment':{'type':'sky','turbidity':4,"
    "'sun':{'azimuth_deg':0,'elevation_deg':9,'illuminance_lx':1}},"
    "'sweep':{'year':2026,'where':[48,11],'step_minutes':30,'headings_deg':[0,90],"
    "'weather':'clear','night':true}}]}";

static inline void review_files(void) {
    static const char *const empty[] = {"a.gltf", "b c.gltf", "p.png"};
    for (int i = 0; i < 3; i++) write_text(in_folder(empty[i]), "");
}

/* The text with its first `from` (NULL: none) replaced. */
static inline char *review_changed(const char *text, const char *from, const char *to,
                                   Arena *arena) {
    size_t length = strlen(text), room = length + (to ? strlen(to) : 0) + 1;
    char *out = ARENA_NEW(arena, char, room);
    const char *at = from ? strstr(text, from) : text + length;
    if (!at) fail_msg("the document has no %s", from);
    memcpy(out, text, (size_t)(at - text));
    strcat(out, to ? to : "");
    strcat(out, at + (from ? strlen(from) : 0));
    for (char *c = out; *c; c++)
        if (*c == '\'') *c = '"';
    return out;
}

/* Writes a document and reads it. */
static inline bool review_read(const char *text, Arena *arena, ReviewRequest *out, Error *err) {
    const char *file = in_folder("t.review.json");
    Problems problems = problems_start(arena);
    write_text(file, text);
    return review_request_read(file, NULL, arena, &problems, out, err);
}
