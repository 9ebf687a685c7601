/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/seat.h"

#include <math.h>

/* About the eye, m. The shipped occupant's chest is 0.18 m behind the eye at most, the headrest
 * 0.42 m; `equip` proposes an eye 0.25 m before a headrest. */
#define CHEST_M 0.2f /* what is farther behind the eye is no chest */
#define BACK_M 0.9f  /* nor is what is farther a seat's back */
#define HALF_WIDE_M 0.35f
#define OVER_M 0.15f /* above the eye: a headrest's top */
#define UNDER_M 1.0f /* below it: a cushion's edge */
#define TURNED 0.5f  /* cosine of 60 degrees: no display is so far from straight ahead */

ChainSeat seat_of_eye(Vec3 eye, Vec3 middle, const double *forward) {
    Vec3 gaze = vec3_sub(middle, eye);
    Vec3 ahead = vec3_from_doubles(forward);
    gaze = vec3_normalize(vec3(gaze.x, 0, gaze.z));
    ahead = vec3_normalize(vec3(ahead.x, 0, ahead.z));
    bool is_turned = vec3_dot(gaze, gaze) > 0 && vec3_dot(gaze, ahead) < TURNED;
    return (ChainSeat){eye, is_turned ? gaze : ahead};
}

bool seat_is_back(const ChainSeat *seat, Vec3 p) {
    Vec3 d = vec3_sub(p, seat->eye);
    Vec3 across = vec3_cross(vec3(0, 1, 0), seat->ahead);
    float ahead = vec3_dot(d, seat->ahead), aside = fabsf(vec3_dot(d, across));
    return ahead < -CHEST_M && ahead > -BACK_M && aside < HALF_WIDE_M && d.y < OVER_M &&
           d.y > -UNDER_M;
}
