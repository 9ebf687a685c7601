/* SPDX-License-Identifier: Apache-2.0 */
#include "render/signals.h"

#include <signal.h>
#include <stddef.h>
#include <stdatomic.h>
#include <unistd.h>

static atomic_int stop_signal;
static atomic_bool snapshot_wanted;

static void request_stop(int signal_number) {
    int none = 0;
    if (!atomic_compare_exchange_strong(&stop_signal, &none, signal_number))
        _exit(128 + signal_number);
}

static void request_snapshot(int signal_number) {
    (void)signal_number;
    atomic_store(&snapshot_wanted, true);
}

void signals_watch(void) {
    struct sigaction stop = {.sa_handler = request_stop, .sa_flags = SA_RESTART};
    struct sigaction hang_up;
    struct sigaction snapshot = {.sa_handler = request_snapshot, .sa_flags = SA_RESTART};
    atomic_store(&stop_signal, 0);
    atomic_store(&snapshot_wanted, false);
    sigaction(SIGINT, &stop, NULL);
    sigaction(SIGTERM, &stop, NULL);
    if (!sigaction(SIGHUP, NULL, &hang_up) && hang_up.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &stop, NULL);
    sigaction(SIGUSR1, &snapshot, NULL);
}

int signals_stop_requested(void) {
    return atomic_load(&stop_signal);
}

bool signals_stopped(Error *err) {
    *err = (Error){.code = ERROR_NONE};
    return false;
}

bool signals_take_snapshot(void) {
    return atomic_exchange(&snapshot_wanted, false);
}

const char *signals_name(int signal) {
    return signal == SIGINT ? "INT" : signal == SIGHUP ? "HUP" : "TERM";
}
