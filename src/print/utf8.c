/* SPDX-License-Identifier: Apache-2.0 */
#include "print/utf8.h"

int utf8_decode(const char *at, size_t left, unsigned *code) {
    static const unsigned LEAST[] = {0, 0, 0x80, 0x800, 0x10000};
    unsigned first = left ? (unsigned char)*at : 0xff;
    int length = first < 0x80       ? 1
                 : first >> 5 == 6  ? 2
                 : first >> 4 == 14 ? 3
                 : first >> 3 == 30 ? 4
                                    : 0;
    if (!length || (size_t)length > left) return 0;
    *code = length == 1 ? first : first & (0xffu >> (length + 1));
    for (int i = 1; i < length; i++) {
        if (!utf8_continues(at[i])) return 0;
        *code = *code << 6 | ((unsigned char)at[i] & 0x3fu);
    }
    bool is_surrogate = *code >> 11 == 0x1b;
    return *code >= LEAST[length] && *code < 0x110000 && !is_surrogate ? length : 0;
}

int utf8_encode(unsigned code, char to[UTF8_BYTES_MAX]) {
    static const unsigned char MARK[] = {0, 0, 0xc0, 0xe0, 0xf0};
    int length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (int i = length - 1; i > 0; i--, code >>= 6) to[i] = (char)(0x80 | (code & 0x3f));
    to[0] = (char)(MARK[length] | code);
    return length;
}
