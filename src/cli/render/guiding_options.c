/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/guiding_options.h"

bool guiding_options_check(const RenderOptions *render, Error *err)
{
    return !(render->field && render->no_guiding) ||
           error_set(err, ERROR_USAGE, "--field %s keeps what is learnt — leave out "
                                       "--no-guiding", render->field);
}
