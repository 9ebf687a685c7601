/* SPDX-License-Identifier: Apache-2.0 */
/* removed.h -- words that a release of before had and this one refuses: options, commands,
 * keys and values, each with what to do instead. One table, removed after one release.
 *
 * Threads  the table is constant. Fails: never.
 */
#pragma once

typedef struct RemovedWord {
    const char *where; /* of an option its command ("render", "panel fit"); of a command
                          "parhelion" or the group that had it ("panel"); of a key the name of
                          the format that had it (RecordFormat.name), of our extensions of
                          glTF theirs; of a value the option or
                          key that took it ("--layers") */
    const char *word;
    const char *instead; /* what to do, one clause */
} RemovedWord;

extern const RemovedWord removed_words[]; /* word NULL ends them */

/* What to do instead of `word` at `where`; NULL when it was never there. */
const char *removed_instead(const char *where, const char *word);
