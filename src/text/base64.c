/* SPDX-License-Identifier: Apache-2.0 */
#include "text/base64.h"

void base64_encode(Text *text, const void *bytes, size_t size) {
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *from = bytes;
    char *to = text_extend(text, (size + 2) / 3 * 4);
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        unsigned three = (unsigned)from[i] << 16 | (left > 1 ? (unsigned)from[i + 1] << 8 : 0) |
                         (left > 2 ? from[i + 2] : 0);
        *to++ = DIGITS[three >> 18];
        *to++ = DIGITS[three >> 12 & 63];
        *to++ = left > 1 ? DIGITS[three >> 6 & 63] : '=';
        *to++ = left > 2 ? DIGITS[three & 63] : '=';
    }
}

static int base64_digit(unsigned char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

bool base64_decode(const char *digits, size_t length, unsigned char *out, size_t *size,
                   Error *err) {
    while (length && digits[length - 1] == '=') length--;
    unsigned bits = 0;
    int count = 0;
    *size = 0;
    for (size_t i = 0; i < length; i++) {
        int digit = base64_digit((unsigned char)digits[i]);
        if (digit < 0)
            return error_set(err, ERROR_INPUT,
                             "character %zu of the base64 data is \"%.1s\", which is none of "
                             "its digits",
                             i + 1, digits + i);
        bits = bits << 6 | (unsigned)digit;
        count += 6;
        if (count >= 8) {
            count -= 8;
            out[(*size)++] = (unsigned char)(bits >> count & 255);
        }
    }
    if (count >= 6)
        return error_set(err, ERROR_INPUT,
                         "the base64 data has a length of %zu digits, which "
                         "none has",
                         length);
    return true;
}
