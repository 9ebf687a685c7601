/* SPDX-License-Identifier: Apache-2.0 */
/* viewer_address.h -- where a viewer waits: HOST or HOST:PORT as a user types it.
 *
 * HOST is a name, an IPv4 address or an IPv6 address in brackets; PORT is 1 to 65535.
 *
 * Memory   plain data.  Threads  no shared state.
 * Fails    ERROR_USAGE with what is wrong in the text and what is wanted. Whether a name is one
 *          of a machine is not asked here.
 */
#pragma once
#include "base/error.h"

#define VIEWER_PORT "14158" /* tev's, where none is given */

typedef struct ViewerAddress {
    char host[256]; /* without brackets */
    char port[8];
} ViewerAddress;

bool viewer_address_parse(const char *text, ViewerAddress *out, Error *err);
