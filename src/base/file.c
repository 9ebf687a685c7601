#include "base/file.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

static bool read_all(int file, unsigned char *bytes, size_t size, size_t *got)
{
    *got = 0;
    while (*got < size) {
        ssize_t n = read(file, bytes + *got, size - *got);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        if (n == 0) break;
        *got += (size_t)n;
    }
    return true;
}

static bool check_size(const char *path, const struct stat *info, size_t max_bytes, Error *err)
{
    if (!S_ISREG(info->st_mode))
        return error_at(err, ERROR_INPUT, path, "", "is %s, a file is wanted",
                        S_ISDIR(info->st_mode) ? "a folder" : "not a regular file");
    if ((unsigned long long)info->st_size > max_bytes)
        return error_at(err, ERROR_INPUT, path, "", "has %lld bytes, at most %zu are read",
                        (long long)info->st_size, max_bytes);
    return true;
}

/* Opens a regular file of at most max_bytes; -1 after an error. */
static int open_regular(const char *path, size_t max_bytes, size_t *size, Error *err)
{
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat info;
    if (file < 0 || fstat(file, &info) != 0) {
        int reason = errno;
        if (file >= 0) close(file);
        error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(reason));
        return -1;
    }
    if (!check_size(path, &info, max_bytes, err)) {
        close(file);
        return -1;
    }
    *size = (size_t)info.st_size;
    return file;
}

/* `size` bytes, or what there is; closes the file. */
static bool read_and_close(int file, const char *path, size_t size, Arena *arena,
                           FileBytes *out, Error *err)
{
    size_t         got = 0;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, size + 1);
    bool           done = read_all(file, bytes, size, &got);
    int            reason = errno;
    close(file);
    if (!done)
        return error_at(err, ERROR_INPUT, path, "", "cannot be read: %s", strerror(reason));
    bytes[got] = 0;
    *out = (FileBytes){bytes, got};
    return true;
}

bool file_read(const char *path, size_t max_bytes, Arena *arena, FileBytes *out, Error *err)
{
    size_t size;
    int    file = open_regular(path, max_bytes, &size, err);
    return file >= 0 && read_and_close(file, path, size, arena, out, err);
}

bool file_read_start(const char *path, size_t max_bytes, Arena *arena, FileBytes *out,
                     Error *err)
{
    size_t size;
    int    file = open_regular(path, SIZE_MAX, &size, err);
    return file >= 0 && read_and_close(file, path, size < max_bytes ? size : max_bytes, arena,
                                       out, err);
}

bool file_exists(const char *path)
{
    return access(path, R_OK) == 0;
}

/* ---- names ----------------------------------------------------------------------------- */

const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *path_ending(const char *path)
{
    const char *name = path_name(path), *dot = strrchr(name, '.');
    return dot && dot != name ? dot : name + strlen(name);
}

char *path_beside(const char *beside, const char *relative, Arena *arena)
{
    int folder = (int)(path_name(beside) - beside);
    if (relative[0] == '/') folder = 0;
    return arena_format(arena, "%.*s%s", folder, beside, relative);
}

int path_climb(const char *relative)
{
    int depth = 0, lowest = 0;
    for (const char *at = relative; *at;) {
        size_t length = strcspn(at, "/");
        if (length == 2 && at[0] == '.' && at[1] == '.')
            depth--;
        else if (length && !(length == 1 && at[0] == '.'))
            depth++;
        if (depth < lowest) lowest = depth;
        at += length + (at[length] == '/');
    }
    return -lowest;
}

/* ---- URIs ------------------------------------------------------------------------------ */

size_t uri_scheme_length(const char *uri)
{
    size_t length = 0;
    if (!isalpha((unsigned char)uri[0])) return 0;
    while (isalnum((unsigned char)uri[length]) ||
           strchr("+-.", uri[length] ? uri[length] : ' '))
        length++;
    return uri[length] == ':' ? length : 0;
}

bool uri_is_data(const char *uri)
{
    return strncasecmp(uri, "data:", 5) == 0;
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/* `length` characters of `text` to `out`, which holds as many; *size is what came out. */
static bool percent_decode(const char *text, size_t length, char *out, size_t *size, Error *err)
{
    *size = 0;
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        if (c == '%') {
            int high = length - i > 2 ? hex_digit(text[i + 1]) : -1;
            int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
            if (low < 0)
                return error_set(err, ERROR_INPUT,
                                 "broken escape \"%.3s\" in a URI, %% and two hexadecimal "
                                 "digits are wanted",
                                 text + i);
            c = (char)(high * 16 + low);
            i += 2;
        }
        out[(*size)++] = c;
    }
    return true;
}

bool uri_decode(const char *uri, Arena *arena, char **out, Error *err)
{
    size_t length = strlen(uri), size;
    char *text = ARENA_NEW(arena, char, length + 1);
    if (!percent_decode(uri, length, text, &size, err)) return false;
    if (memchr(text, 0, size))
        return error_set(err, ERROR_INPUT, "a URI holds an encoded zero byte");
    *out = text;
    return true;
}

static int base64_digit(unsigned char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

/* RFC 4648, the padding optional. `out` holds 3/4 of the length. */
static bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *size,
                          Error *err)
{
    while (length && text[length - 1] == '=') length--;
    unsigned bits = 0;
    int count = 0;
    *size = 0;
    for (size_t i = 0; i < length; i++) {
        int digit = base64_digit((unsigned char)text[i]);
        if (digit < 0)
            return error_set(err, ERROR_INPUT,
                             "character %zu of the base64 data is \"%.1s\", which is none of "
                             "its digits",
                             i + 1, text + i);
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

/* type/subtype;name=value;...;base64: no part between semicolons may be empty. */
static bool check_media_type(const char *head, size_t length, Error *err)
{
    for (size_t i = 0; i < length; i++)
        if (head[i] == ';' && (i + 1 == length || head[i + 1] == ';'))
            return error_set(err, ERROR_INPUT, "the data: URI has an empty part in \"%.*s\"",
                             (int)(length < 80 ? length : 80), head);
    return true;
}

bool data_uri_decode(const char *uri, Arena *arena, FileBytes *out, const char **media_type,
                     Error *err)
{
    const char *comma = uri_is_data(uri) ? strchr(uri, ',') : NULL;
    if (!comma)
        return error_set(err, ERROR_INPUT, "the data: URI has no comma before its data");
    size_t head = (size_t)(comma - uri), length = strlen(comma + 1), size;
    if (!check_media_type(uri, head, err)) return false;
    bool is_base64 = head >= 12 && strncasecmp(comma - 7, ";base64", 7) == 0;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, length + 1);
    if (is_base64) {
        if (!base64_decode(comma + 1, length, bytes, &size, err)) return false;
    } else if (!percent_decode(comma + 1, length, (char *)bytes, &size, err)) {
        return false;
    }
    bytes[size] = 0;
    if (media_type) *media_type = arena_string(arena, uri + 5, strcspn(uri + 5, ";,"));
    *out = (FileBytes){bytes, size};
    return true;
}
