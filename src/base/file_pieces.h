/* SPDX-License-Identifier: Apache-2.0 */
/* file_pieces.h -- reads a file piece by piece, and tells how far it has come.
 *
 * Memory, failures and threads are those of base/file.h, whose readers this serves.
 */
#pragma once
#include "base/file.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FilePieces {
    size_t max_bytes; /* of a file that is read */
    bool   is_start;  /* that many bytes at most, of a file of any length */
    void (*told)(void *user, size_t done, size_t size); /* after each piece; NULL: nobody */
    void  *user;
} FilePieces;

bool file_pieces_read(const char *path, const FilePieces *how, Arena *arena, FileBytes *out,
                      Error *err);

#ifdef __cplusplus
}
#endif
