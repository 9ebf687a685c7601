/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/state_print.h"

#include <string.h>

#include "base/count.h"
#include "print/print.h"

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static void print_cone(const json_t *list)
{
    static const char *const side[] = {"right", "up", "left", "down"};
    for (size_t i = 0; i < COUNT_OF(side); i++) {
        const json_t *angle = json_array_get(list, i);
        print("%s%s ", i ? ", " : "; half of it at ", side[i]);
        if (json_is_number(angle)) print("%.1f", json_number_value(angle));
        else print("-");
    }
    print(" degrees");
}

/* Reasons of the state that the report is of stand in it. */
static void print_one(const json_t *one, const char *shown)
{
    const json_t *display = json_object_get(one, "display"), *reason;
    const json_t *total = json_object_get(one, "total");
    const char   *verdict = json_string_value(json_object_get(one, "verdict"));
    const char   *name = json_string_value(json_object_get(one, "state"));
    size_t        i;
    print("state      %s: white %.4g cd/m2", name, number(display, "white_cd_m2"));
    if (json_is_number(json_object_get(display, "contrast")))
        print(", contrast %.4g : 1", number(display, "contrast"));
    print_cone(json_object_get(display, "half_luminance_deg"));
    print("; errors at most %.3g %%, rms %.3g %%; %s\n", 100 * number(total, "max_error"),
          100 * number(total, "rms_error"), verdict ? verdict : "no verdict");
    if (shown && !strcmp(name, shown)) return;
    json_array_foreach(json_object_get(one, "reasons"), i, reason)
        print("           %s: %s\n", name, json_string_value(reason));
}

void state_print(const json_t *report)
{
    size_t        i;
    const json_t *one, *display = json_object_get(report, "display");
    const char   *shown = json_string_value(json_object_get(display, "state"));
    json_array_foreach(json_object_get(report, "states"), i, one) print_one(one, shown);
}
