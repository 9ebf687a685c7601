/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/version.h"

#include <stdio.h>

#include "bvh/bvh.h"
#include "render/render.h"

void version_print(void)
{
    const Kernel *kernel;
    Error         err;
    bool          chosen = kernel_choose(NULL, &kernel, &err);
    printf("parhelion %s\nsources: %s\ninstruction set: %s\nlibraries: %s, %s\n",
           PARHELION_VERSION, SOURCES_HASH, chosen ? kernel->isa : "none", bvh_library(),
           LIBRARY_VERSIONS);
}
