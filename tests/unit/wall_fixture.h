/* SPDX-License-Identifier: Apache-2.0 */
/* wall_fixture.h -- a display of 0.3 x 0.1 m that hangs in the air, upright, its face to +Z, an
 * eye before it, and a request about them: a whole review of some seconds. */
#pragma once
#include "fixture.h"

#include "text/base64.h"

/* ' stands for ". */
static const char wall_scene[] =
    "{'asset':{'version':'2.0'},'extensionsUsed':['PARHELION_display'],'scene':0,"
    "'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0},{'name':'eye','camera':0,"
    "'translation':[0.05,0.02,0.7]}],"
    "'cameras':[{'name':'eye','type':'perspective','perspective':{'yfov':0.5,'znear':0.01}}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'indices':2,"
    "'material':0}]}],"
    "'materials':[{'name':'cluster','extensions':{'PARHELION_display':{'panel':'p.panel'}}}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3',"
    "'min':[-0.15,-0.05,0],'max':[0.15,0.05,0]},"
    "{'bufferView':1,'componentType':5126,'count':4,'type':'VEC2'},"
    "{'bufferView':2,'componentType':5123,'count':6,'type':'SCALAR'}],"
    "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':32},"
    "{'buffer':0,'byteOffset':80,'byteLength':12}],"
    "'buffers':[{'byteLength':92,'uri':'data:application/octet-stream;base64,%s'}]}";

static inline void wall_copy(const char *from, const char *name, Arena arena) {
    FileBytes bytes;
    assert_done(file_read(from, 1 << 24, &arena, &bytes, &err));
    write_bytes(in_folder(name), bytes.data, bytes.size);
}

static inline void wall_write(const char *name, const char *text, Arena arena) {
    char *quoted = arena_string(&arena, text, strlen(text));
    for (char *c = quoted; *c; c++)
        if (*c == '\'') *c = '"';
    write_text(in_folder(name), quoted);
}

/* request: ' stands for ". */
static inline void wall_write_files(const char *request, Arena arena) {
    static const struct {
        float at[12], uv[8];
        uint16_t corners[6];
    } quad = {{-0.15f, -0.05f, 0, 0.15f, -0.05f, 0, 0.15f, 0.05f, 0, -0.15f, 0.05f, 0},
              {0, 1, 1, 1, 1, 0, 0, 0},
              {0, 1, 2, 0, 2, 3}};
    Text digits = {.arena = &arena};
    base64_encode(&digits, &quad, sizeof quad);
    size_t room = sizeof wall_scene + digits.size;
    char *scene = ARENA_NEW(&arena, char, room);
    snprintf(scene, room, wall_scene, digits.data);
    wall_write("a.gltf", scene, arena);
    wall_write("r.json", request, arena);
    wall_copy(PROJECT_DIR "/assets/panels/ips_cluster.panel", "p.panel", arena);
    wall_copy(PROJECT_DIR "/assets/content/cluster.png", "c.png", arena);
}
