/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_light.h"

#include "base/units.h"
#include "scene/load/environment.h"

/* `forward` stands once at the top of the file, a heading once in the condition. */
static bool check_directions(const JsonView *view, const JsonView *environment,
                             const ReviewCondition *condition, Error *err)
{
    bool has_heading = json_object_get(environment->object, "heading_deg") != NULL;
    if (json_object_get(environment->object, "forward"))
        return field_fails(environment, "forward", err,
                           "stands in a condition, wanted it at the top of the file");
    if (has_heading && condition->has_heading)
        return field_fails(view, "heading_deg", err,
                           "stands in 'environment' as well, wanted it once");
    if (has_heading &&
        (condition->kind == CONDITION_ROUTE || condition->kind == CONDITION_YEAR_SWEEP))
        return field_fails(environment, "heading_deg", err,
                           "stands in a condition that has headings of its own, wanted none");
    return true;
}

/* Beside a route or a sweep the environment gives a clear sky's air. */
static bool check_kind(const JsonView *environment, const ReviewCondition *condition,
                       Error *err)
{
    if (condition->kind == CONDITION_MOMENT) return true;
    if (condition->weather_id != NO_ID)
        return error_at(err, ERROR_INPUT, environment->file, environment->path,
                        "stands beside a weather file, wanted one of them");
    return condition->environment.kind == ENVIRONMENT_SKY ||
           field_fails(environment, "type", err,
                       "is another one than 'sky', wanted that: a route and a sweep move the "
                       "sun of a clear sky");
}

static void set_directions(const ReviewRequest *request, ReviewCondition *condition)
{
    const double *forward = request->forward;
    condition->environment.forward = vec3((float)forward[0], (float)forward[1],
                                          (float)forward[2]);
    condition->environment.heading = (float)radians_from_degrees(condition->heading_deg);
}

bool request_light_read(RequestReading *reading, const JsonView *view, int i,
                        ReviewCondition *condition, Error *err)
{
    EnvironmentFound found;
    JsonView         environment;
    if (!json_view_child(view, "environment", false, &environment, err)) return false;
    if (!environment.object) return true;
    const GltfValue *item = tree_item(tree_member(reading->tree, "conditions"), i);
    EnvironmentText  text = {view->file, tree_member(item, "environment"), view->root};
    if (!check_directions(view, &environment, condition, err) ||
        !environment_text_read(&text, view->arena, reading->problems, &found, err))
        return false;
    condition->has_environment = true;
    condition->environment = found.environment;
    if (json_object_get(environment.object, "heading_deg")) {
        condition->has_heading = true;
        condition->heading_deg = json_number_value(json_object_get(environment.object,
                                                                   "heading_deg"));
    }
    set_directions(reading->request, condition);
    if (found.picture) request_note_input(reading, found.picture, found.picture_hash);
    return check_kind(&environment, condition, err);
}
