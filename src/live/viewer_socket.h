/* SPDX-License-Identifier: Apache-2.0 */
/* viewer_socket.h -- the only part of the program that talks to another one: bytes go out to a
 * viewer that waits somewhere, and none are ever read.
 *
 * Nothing here waits for longer than its caller allows; a viewer that is gone is an error, no
 * signal. What opening takes, the look-up of a name included, is taken off *patience_s.
 *
 * Memory   a handle each, to be closed. A look-up that outlasts the patience is left behind
 *          with its thread: the system's resolver cannot be interrupted.
 * Threads  one handle belongs to one thread at a time.
 * Fails    ERROR_OUTPUT with the system's reason.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"

/* Whether a text is an address of four numbers, or one of eight. */
bool viewer_socket_is_ipv4(const char *text);
bool viewer_socket_is_ipv6(const char *text);

/* Connects to the first of the host's addresses that answers. *patience_s: seconds that all of
 * it may take; what is left of them. */
bool viewer_socket_open(const char *host, const char *port, double *patience_s, int *out,
                        Error *err);

/* As many of the bytes as are taken at once, maybe none. */
bool viewer_socket_send(int handle, const void *bytes, size_t size, size_t *taken, Error *err);

/* Waits until bytes are taken again, or the patience is at its end. */
void viewer_socket_wait(int handle, double *patience_s);

void viewer_socket_close(int handle);
