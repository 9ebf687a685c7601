/* SPDX-License-Identifier: Apache-2.0 */
/* ask_panel.c PANEL -- another renderer's program: linked by pkg-config against an installed
 * tree, it opens a panel and prints what it says; and makes wrong calls, which must be
 * refused. */
#include <math.h>
#include <parhelion_panel.h>
#include <stdio.h>
#include <string.h>

#define COUNT 3

static int refused(const char *what, int holds) {
    if (!holds) fprintf(stderr, "not refused: %s\n", what);
    return !holds;
}

static int ask_wrongly(const ParhelionPanel *panel) {
    char error[300], two[2] = "";
    ParhelionPanel *none = NULL;
    ParhelionPanelInfo info;
    ParhelionPanelQuestions q;
    float out[3];
    int faults = 0;
    memset(&q, 0, sizeof q);
    memset(&info, 0, sizeof info);
    faults += refused("a file that is not there",
                      parhelion_panel_open("gone.panel", &none, error, sizeof error) ==
                              PARHELION_PANEL_REFUSED &&
                          !none && strstr(error, "gone.panel"));
    faults += refused("bytes that are no panel",
                      parhelion_panel_open_memory("text", 4, &none, two, sizeof two) ==
                              PARHELION_PANEL_REFUSED &&
                          !none && strlen(two) == 1);
    faults += refused("no bytes", parhelion_panel_open_memory("", 0, &none, NULL, 0) ==
                                          PARHELION_PANEL_REFUSED &&
                                      !none);
    faults += refused("a struct without size",
                      parhelion_panel_info(panel, &info) == PARHELION_PANEL_WRONG_SIZE);
    q.count = 1;
    faults +=
        refused("questions without size",
                parhelion_panel_emission_xyz(panel, &q, out, NULL) == PARHELION_PANEL_WRONG_SIZE);
    q.size = sizeof q;
    faults +=
        refused("questions without directions",
                parhelion_panel_emission_xyz(panel, &q, out, NULL) == PARHELION_PANEL_MISSING);
    q.count = 0;
    faults += refused("no questions are fine",
                      parhelion_panel_emission_xyz(panel, &q, out, NULL) == PARHELION_PANEL_OK);
    return faults;
}

/* A caller that was compiled with a later version, whose struct is longer. */
static int ask_from_later(const ParhelionPanel *panel) {
    struct {
        ParhelionPanelInfo info;
        unsigned more[4];
    } later;
    int faults, i;
    memset(&later, 7, sizeof later);
    later.info.size = sizeof later;
    faults = refused("a longer struct", parhelion_panel_info(panel, &later.info) == 0);
    faults += refused("its size", later.info.size == sizeof later);
    for (i = 0; i < 4; i++) faults += refused("what is behind", later.more[i] == 0x07070707u);
    return faults;
}

/* Numbers that are no directions, codes or places: zeros or held, never worse. */
static int ask_nonsense(const ParhelionPanel *panel) {
    float viewer[12] = {0, 0, -1, 0, 0, 0, 0, 0, 1, 3e30f, 0, 3e30f};
    float code[12] = {255, 255, 255, 255, 255, 255, 1e9f, -5, 300, 255, 255, 255};
    float place[8] = {0, 0, 0, 0, -1e9f, 7, 0.5f, 0.5f}, xyz[12];
    int faults = 0, i;
    ParhelionPanelQuestions q;
    memset(&q, 0, sizeof q);
    q.size = sizeof q, q.count = 4, q.place = place, q.viewer = viewer, q.code = code;
    place[0] = NAN, code[3] = NAN, viewer[4] = INFINITY;
    faults += refused("nonsense", parhelion_panel_emission_xyz(panel, &q, xyz, NULL) == 0);
    for (i = 0; i < 6; i++) faults += refused("light from nowhere", xyz[i] == 0);
    for (i = 6; i < 12; i++) faults += refused("held numbers", xyz[i] > 0 && xyz[i] < 1e6f);
    return faults;
}

int main(int count, char **arguments) {
    static const float viewer[3 * COUNT] = {0, 0, 1, 0.6f, 0, 0.8f, 0, -0.28f, 0.96f};
    static const float light[3 * COUNT] = {0.28f, 0, 0.96f, -0.6f, 0, 0.8f, 0.48f, 0.6f, 0.64f};
    static const float code[3 * COUNT] = {255, 255, 255, 10, 200.5f, 0, 0, 0, 0};
    static const float nm[2] = {450, 633};
    char error[1200];
    float xyz[3 * COUNT], brdf[2 * COUNT], mirror[2 * COUNT];
    unsigned char measured[COUNT];
    ParhelionPanelInfo info;
    ParhelionPanelQuestions q;
    ParhelionPanel *panel;
    int i, faults;
    if (parhelion_panel_open(count > 1 ? arguments[1] : "", &panel, error, sizeof error)) {
        fprintf(stderr, "%s\n", error);
        return 3;
    }
    memset(&info, 0, sizeof info);
    info.size = sizeof info;
    faults = parhelion_panel_info(panel, &info) != PARHELION_PANEL_OK;
    printf("%u\n", info.flags);
    memset(&q, 0, sizeof q);
    q.size = sizeof q, q.count = COUNT, q.viewer = viewer, q.light = light, q.code = code;
    q.wavelengths = 2, q.nm = nm;
    faults += parhelion_panel_emission_xyz(panel, &q, xyz, measured) != PARHELION_PANEL_OK;
    faults += parhelion_panel_brdf(panel, &q, brdf, NULL) != PARHELION_PANEL_OK;
    faults += parhelion_panel_mirror(panel, &q, mirror) != PARHELION_PANEL_OK;
    for (i = 0; i < COUNT; i++)
        printf("%.9g %.9g %.9g %d %.9g %.9g %.9g %.9g\n", (double)xyz[3 * i],
               (double)xyz[3 * i + 1], (double)xyz[3 * i + 2], measured[i], (double)brdf[2 * i],
               (double)brdf[2 * i + 1], (double)mirror[2 * i], (double)mirror[2 * i + 1]);
    faults += ask_wrongly(panel) + ask_nonsense(panel) + ask_from_later(panel);
    parhelion_panel_close(panel);
    parhelion_panel_close(NULL);
    return faults ? 1 : 0;
}
