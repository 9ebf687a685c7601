/* SPDX-License-Identifier: Apache-2.0 */
/* signals.h -- what the user or the batch system requests of a running render.
 *
 * The first INT, TERM or HUP stops it after the pass in hand (a review: at once); a
 * second one ends the
 * process at once with status 130, 143 or 129. A HUP that was ignored when the process began
 * (nohup) stays ignored. USR1 requests a snapshot.
 *
 * Threads  a handler may run in any thread: it only stores numbers. These are the only mutable
 *          variables of the program that are not on a stack or in an arena: a signal handler
 *          is handed nothing else.
 */
#pragma once
#include "base/error.h"

/* From now on; earlier requests are forgotten. */
void signals_watch(void);

/* 0, or the number of the signal (SIGINT, SIGTERM, SIGHUP) that requests a stop. */
int signals_stop_requested(void);

/* For `return signals_stopped(err)`, where one did: false without an error. */
bool signals_stopped(Error *err);

/* "INT", "TERM" or "HUP", for messages. */
const char *signals_name(int signal);

/* True once for every USR1 (several that come together count as one). */
bool signals_take_snapshot(void);
