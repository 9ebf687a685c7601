/* SPDX-License-Identifier: Apache-2.0 */
/* Workbooks of spreadsheet programs, by their first bytes: an OLE compound file (.xls) or a
 * zip archive (.xlsx). Only a laboratory's template defines their cells, so they are refused,
 * with what can be given instead. */
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "import/set/import.h"

static bool is_compound(const char *head, size_t head_size) {
    static const char magic[] = "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1";
    return head_size >= 8 && !memcmp(head, magic, 8);
}

static bool is_spreadsheet(const char *file, const char *head, size_t head_size) {
    const char *ending = path_ending(file);
    bool is_archive = head_size >= 4 && !memcmp(head, "PK\3\4", 4);
    return is_compound(head, head_size) ||
           (is_archive && (!strcasecmp(ending, ".xlsx") || !strcasecmp(ending, ".ods")));
}

static bool refuse_spreadsheet(const char *file, const ImportOptions *options, ImportSet *set,
                               Error *err) {
    (void)options;
    (void)set;
    return error_at(err, ERROR_INPUT, file, "",
                    "is a workbook of a spreadsheet program — "
                    "export its tables as CSV; of a scatterometer (RT-300S) give the .bsdf "
                    "that was made from it");
}

const Importer importer_spreadsheet = {
    "spreadsheet", "workbooks (.xls, .xlsx): refused, with what to give instead", is_spreadsheet,
    refuse_spreadsheet};
