/* SPDX-License-Identifier: Apache-2.0 */
#include "live/viewer_address.h"

#include <stdlib.h>
#include <string.h>

#include "live/viewer_socket.h"

#define HOST_LONGEST 253 /* of a name, RFC 1035 */
#define NAME_BYTES "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_"

/* A text inside another. */
typedef struct AddressWord {
    const char *begin;
    size_t      length;
} AddressWord;

static bool parse_port(const char *text, ViewerAddress *out, Error *err)
{
    size_t length = strlen(text);
    long   port = length <= 5 && strspn(text, "0123456789") == length ? atol(text) : 0;
    if (port < 1 || port > 65535)
        return error_set(err, ERROR_USAGE, "'%.64s' is no port, wanted 1 to 65535",
                         text);
    memcpy(out->port, text, length + 1);
    return true;
}

static bool set_host(AddressWord word, ViewerAddress *out, Error *err)
{
    if (word.length < 1 || word.length > HOST_LONGEST)
        return error_set(err, ERROR_USAGE, "the host has %zu letters, wanted 1 to %d",
                         word.length, HOST_LONGEST);
    memcpy(out->host, word.begin, word.length);
    out->host[word.length] = '\0';
    return true;
}

static bool check_host(const char *host, bool is_bracketed, Error *err)
{
    if (is_bracketed)
        return viewer_socket_is_ipv6(host) ||
               error_set(err, ERROR_USAGE, "'%.64s' is no IPv6 address, which brackets hold",
                         host);
    if (host[strspn(host, NAME_BYTES)])
        return error_set(err, ERROR_USAGE, "'%.64s' is no host's name: letters, digits, '-' "
                                           "and '.' are wanted", host);
    if (!host[strspn(host, "0123456789.")] && !viewer_socket_is_ipv4(host))
        return error_set(err, ERROR_USAGE, "'%.64s' is no IPv4 address", host);
    return true;
}

static bool split(const char *text, ViewerAddress *out, Error *err)
{
    bool        is_bracketed = text[0] == '[';
    const char *end = is_bracketed ? strchr(text, ']') : text + strcspn(text, ":");
    if (!end) return error_set(err, ERROR_USAGE, "the bracket is never closed");
    const char *port = end + is_bracketed;
    if (!is_bracketed && *port && strchr(port + 1, ':'))
        return error_set(err, ERROR_USAGE, "an IPv6 address stands in brackets: [::1]:%s",
                         VIEWER_PORT);
    if (*port && *port != ':')
        return error_set(err, ERROR_USAGE, "'%.64s' follows the bracket, wanted :PORT", port);
    const AddressWord host = {text + is_bracketed, (size_t)(end - text) - is_bracketed};
    return set_host(host, out, err) && check_host(out->host, is_bracketed, err) &&
           parse_port(*port ? port + 1 : VIEWER_PORT, out, err);
}

bool viewer_address_parse(const char *text, ViewerAddress *out, Error *err)
{
    ViewerAddress address;
    if (!split(text, &address, err)) return false;
    *out = address;
    return true;
}
