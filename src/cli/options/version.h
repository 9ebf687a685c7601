/* SPDX-License-Identifier: Apache-2.0 */
/* version.h -- what `parhelion --version`, and -V behind any command, print. */
#pragma once

/* The program's version, its sources, the instruction set in use and the libraries. */
void version_print(void);
