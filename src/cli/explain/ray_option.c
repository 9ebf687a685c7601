/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/ray_option.h"

#include "base/file_write.h"
#include "review/output/ray_file.h"

bool ray_option_check(const char *path, Error *err)
{
    return !path || (ray_file_check(path, err) && file_check_writable(path, err));
}
