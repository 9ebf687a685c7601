/* SPDX-License-Identifier: Apache-2.0 */
/* request_eyes.h -- who looks, and where to: "eyes", "forward", "observer" and "gaze".
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_reading.h"

bool request_eyes_read(RequestReading *reading, Error *err);
