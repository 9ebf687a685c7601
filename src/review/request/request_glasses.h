/* SPDX-License-Identifier: Apache-2.0 */
/* request_glasses.h -- a condition's "sunglasses" (request.h: memory and errors).
 *
 * A category of ISO 12312-1 stands for the middle of its range of luminous transmittance: 0: 80
 * to 100 %, 1: 43 to 80, 2: 18 to 43, 3: 8 to 18, 4: 3 to 8 (ISO 12312-1:2013, table 1, as it
 * is commonly quoted).
 */
#pragma once
#include "review/request/request_fields.h"

/* Absent: NULL. *condition's kind is known. */
bool request_glasses_read(RequestReading *reading, const JsonView *view,
                          ReviewCondition *condition, Error *err);
