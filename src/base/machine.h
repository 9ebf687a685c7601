/* SPDX-License-Identifier: Apache-2.0 */
/* machine.h -- what this process may use of the machine.
 *
 * Threads  no shared state.  Fails  machine_check_stack alone.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"

/* Bytes: the machine's memory, or what the process's control group (a container's, a batch
 * system's) may have of it. */
size_t machine_installed_bytes(void);

/* The same, or half of the address space that a batch system grants (ulimit -v; the libraries'
 * share is the other half). */
size_t machine_memory_bytes(void);

/* The least limit of the control groups that own_groups (/proc/self/cgroup) names and of those
 * that hold them, mounted at root; version 1 and 2 (cgroups(7)). SIZE_MAX: none. */
size_t machine_group_bytes(const char *own_groups, const char *root);

/* The most bytes of memory that the process has held at once so far. */
double machine_peak_bytes(void);

/* False, an ERROR_MACHINE, where a limit (ulimit -s) leaves threads too little of a stack: one
 * that is used up ends the process without a line. */
bool machine_check_stack(Error *err);

/* Bytes of machine_installed_bytes that this process does not hold yet. */
size_t machine_memory_left(void);

/* Bytes of address space that the process may still map; SIZE_MAX where nothing limits it. */
size_t machine_address_space_left(void);
