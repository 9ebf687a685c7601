/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <string.h>

#include "record/rows.h"
#include "review/request/request_format.h"

#define WITHIN_DEG 20 /* about a gaze */
#define CONTRAST_DOC "Of the image over all else that is seen there: at most. Your own limit."

/* ---- areas ------------------------------------------------------------------------------- */

#define OWNER ReviewPaneArea

static const RecordRow AREA[] = {
    TEXT("name", MUST | RECORD_FILLED, name, "What the report calls it: left mirror."),
    VECTOR("direction", MUST | RECORD_UNIT, direction, 3, -1e6, 1e6,
           "From the eye to its middle, in the scene; of any length but 0."),
    NUMBER("within_deg", RECORD_OPEN | RECORD_ABOVE, within_deg, 0, 180,
           "Half the width of its cone. Default: that of pane_images."),
    NUMBER("contrast_max", RECORD_OPEN | RECORD_ABOVE, contrast_most, 0, 1e6,
           CONTRAST_DOC " Default: that of pane_images."),
    {0}};

static void start_area(void *item) {
    *(ReviewPaneArea *)item = (ReviewPaneArea){.within_deg = NAN, .contrast_most = NAN};
}

static const RecordFormat area_format = {"pane_area", sizeof(OWNER), AREA, .start = start_area};

#undef OWNER

/* ---- all of it --------------------------------------------------------------------------- */

#define OWNER ReviewPaneImages

static const RecordRow PANES[] = {
    NUMBER("within_deg", RECORD_ABOVE, within_deg, 0, 180,
           "Half the width of the cone about each gaze that has a direction; without such "
           "gazes and areas about 'forward'."),
    NUMBER("contrast_max", RECORD_OPEN | RECORD_ABOVE, contrast_most, 0, 1e6, CONTRAST_DOC),
    NUMBER("against_cd_m2", 0, against_cd_m2, 0, 1e9,
           "As it comes to the eye: what images are seen against has at least this, such as a "
           "road that the scene does not have."),
    LIST("areas", 0, areas, area_count, 1, 64, area_format,
         "More parts of the view to be kept free: mirrors, lamps."),
    {0}};

static void start_panes(void *item) {
    *(ReviewPaneImages *)item = (ReviewPaneImages){.within_deg = WITHIN_DEG, .contrast_most = NAN};
}

static bool check_panes(const JsonView *view, void *item, Error *err) {
    ReviewPaneImages *panes = item;
    for (int i = 0; i < panes->area_count; i++) {
        ReviewPaneArea *area = &panes->areas[i];
        if (isnan(area->within_deg)) area->within_deg = panes->within_deg;
        if (isnan(area->contrast_most)) area->contrast_most = panes->contrast_most;
        for (int k = 0; k < i; k++)
            if (!strcmp(panes->areas[k].name, area->name))
                return record_fails(view, "areas", err,
                                    "has a second one named '%.60s', required: another name",
                                    area->name);
    }
    return true;
}

const RecordFormat review_panes_format = {"pane_images", sizeof(OWNER), PANES, .start = start_panes,
                                          .check = check_panes};
