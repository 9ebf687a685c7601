/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_share.h"

#include "cli/options/answer.h"

bool render_share(const RenderRequest *request, const char *identity, const char *isa,
                  Arena *arena, Error *err)
{
    static const char *const splits[] = {[JOB_SPLIT_SAMPLES] = "samples",
                                         [JOB_SPLIT_ROWS] = "rows"};
    const RenderOptions *options = &request->render;
    const JobPart whole = {options->crop, options->first_sample, options->end_sample};
    ShareRequest  share = request->share;
    json_t       *answer = NULL;
    SharedJob     job = {.kind = JOB_FRAME, .line = request->command_line,
                         .output = request->output, .identity = identity, .isa = isa,
                         .width = options->width, .height = options->height,
                         .keeps_sums = request->is_part};
    share.split_name = splits[request->split];
    return job_split(&whole, (JobSplit)request->split, (int)share.parts, arena, &job.parts,
                     err) &&
           job_share(&share, &job, arena, request->cli.json ? &answer : NULL, err) &&
           (!answer || cli_print_json(answer, err));
}
