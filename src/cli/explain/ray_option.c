/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/ray_option.h"

#include "base/file.h"
#include "base/file_write.h"
#include "review/output/ray_file.h"

bool ray_option_check(const char *path, const Cli *cli, Error *err)
{
    if (!path) return true;
    for (int i = 0; i < cli->argument_count; i++)
        if (file_is_same(path, cli->arguments[i]))
            return error_set(err, ERROR_USAGE,
                             "%s: is read, wanted another name for the file of rays", path);
    return ray_file_check(path, err) && file_check_writable(path, err);
}
