#include "import/scatter/lz4_block.h"

#include <string.h>

#define MATCH_LEAST 4 /* bytes that every match has */

typedef struct Lz4 {
    const unsigned char *next, *end;
    unsigned char       *out, *out_begin, *out_end;
} Lz4;

/* A length of 15 goes on in bytes, up to one that is not 255. */
static bool read_length(Lz4 *in, size_t *length)
{
    if (*length != 15) return true;
    unsigned char more;
    do {
        if (in->next == in->end) return false;
        more = *in->next++;
        *length += more;
    } while (more == 255);
    return true;
}

static bool copy_literals(Lz4 *in, size_t length)
{
    if (length > (size_t)(in->end - in->next) || length > (size_t)(in->out_end - in->out))
        return false;
    memcpy(in->out, in->next, length);
    in->next += length;
    in->out += length;
    return true;
}

/* The match may overlap what it writes: byte by byte. */
static bool copy_match(Lz4 *in, size_t length)
{
    if (in->end - in->next < 2) return false;
    size_t offset = (size_t)in->next[0] | (size_t)in->next[1] << 8;
    in->next += 2;
    if (!read_length(in, &length)) return false;
    length += MATCH_LEAST;
    if (!offset || offset > (size_t)(in->out - in->out_begin) ||
        length > (size_t)(in->out_end - in->out))
        return false;
    for (size_t i = 0; i < length; i++, in->out++) *in->out = in->out[-(ptrdiff_t)offset];
    return true;
}

bool lz4_block_decode(const unsigned char *block, size_t block_size, unsigned char *out,
                      size_t out_size)
{
    Lz4 in = {block, block + block_size, out, out, out + out_size};
    while (in.next < in.end) {
        unsigned char token = *in.next++;
        size_t        literals = token >> 4;
        if (!read_length(&in, &literals) || !copy_literals(&in, literals)) return false;
        if (in.next == in.end) return in.out == in.out_end; /* the last sequence has no match */
        if (!copy_match(&in, token & 15)) return false;
    }
    return false;
}
