/* SPDX-License-Identifier: Apache-2.0 */
#include "live/viewer_socket.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <netdb.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/progress.h"

/* ---- addresses --------------------------------------------------------------------------- */

bool viewer_socket_is_ipv4(const char *text)
{
    struct in_addr address;
    return inet_pton(AF_INET, text, &address) == 1;
}

bool viewer_socket_is_ipv6(const char *text)
{
    struct in6_addr address;
    return inet_pton(AF_INET6, text, &address) == 1;
}

/* ---- waiting ----------------------------------------------------------------------------- */

/* False: the patience was at its end before. */
static bool wait_for(int handle, short events, double *patience_s)
{
    struct pollfd what = {.fd = handle, .events = events};
    double        until_s = monotonic_seconds() + *patience_s;
    int           ready;
    do {
        *patience_s = fmax(0, until_s - monotonic_seconds());
        ready = poll(&what, 1, (int)ceil(1000 * *patience_s));
    } while (ready < 0 && errno == EINTR);
    *patience_s = fmax(0, until_s - monotonic_seconds());
    return ready > 0;
}

void viewer_socket_wait(int handle, double *patience_s)
{
    wait_for(handle, POLLOUT, patience_s);
}

/* ---- names ------------------------------------------------------------------------------- */

/* The look-up of a name in a thread of its own; on the heap, since it may outlive
 * everything. */
typedef struct NameLookup {
    char  host[256], port[8];
    int   ready[2];          /* a pipe whose other end is closed when the rest is there */
    int   status;            /* getaddrinfo's */
    struct addrinfo *found;
} NameLookup;

static void *look_up(void *argument)
{
    NameLookup           *lookup = argument;
    const struct addrinfo wanted = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    lookup->status = getaddrinfo(lookup->host, lookup->port, &wanted, &lookup->found);
    close(lookup->ready[1]);
    return NULL;
}

static void end_lookup(NameLookup *lookup)
{
    if (lookup->found) freeaddrinfo(lookup->found);
    close(lookup->ready[0]);
    free(lookup);
}

static bool start_lookup(const char *host, const char *port, NameLookup **out,
                         pthread_t *thread, bool *has_thread)
{
    NameLookup *lookup = calloc(1, sizeof *lookup);
    if (!lookup) return false;
    strncpy(lookup->host, host, sizeof lookup->host - 1);
    strncpy(lookup->port, port, sizeof lookup->port - 1);
    if (pipe2(lookup->ready, O_CLOEXEC)) {
        free(lookup);
        return false;
    }
    *has_thread = !pthread_create(thread, NULL, look_up, lookup);
    if (!*has_thread) look_up(lookup); /* the system refuses one (ulimit -u, pids.max) */
    *out = lookup;
    return true;
}

/* A resolver may take minutes: it runs beside, and is left when the patience ends. */
static bool find_host(const char *host, const char *port, double *patience_s,
                      NameLookup **out, Error *err)
{
    NameLookup *lookup = NULL;
    pthread_t   thread;
    bool        has_thread;
    if (!start_lookup(host, port, &lookup, &thread, &has_thread))
        return error_set(err, ERROR_OUTPUT, "its name cannot be looked up: %s",
                         strerror(errno));
    if (has_thread && !wait_for(lookup->ready[0], POLLIN, patience_s)) {
        pthread_detach(thread);
        return error_set(err, ERROR_OUTPUT, "nobody knows its name in time");
    }
    if (has_thread) pthread_join(thread, NULL);
    int status = lookup->status;
    if (status) {
        end_lookup(lookup);
        return error_set(err, ERROR_OUTPUT, "%s", gai_strerror(status));
    }
    *out = lookup;
    return true;
}

/* ---- connecting -------------------------------------------------------------------------- */

/* 0, or errno. */
static int finish_connecting(int handle, double *patience_s)
{
    int       reason = 0;
    socklen_t size = sizeof reason;
    if (!wait_for(handle, POLLOUT, patience_s)) return ETIMEDOUT;
    return getsockopt(handle, SOL_SOCKET, SO_ERROR, &reason, &size) ? errno : reason;
}

/* 0, or errno. */
static int connect_to(const struct addrinfo *to, double *patience_s, int *out)
{
    int handle = socket(to->ai_family, to->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                        to->ai_protocol);
    if (handle < 0) return errno;
    int reason = connect(handle, to->ai_addr, to->ai_addrlen) ? errno : 0;
    if (reason == EINPROGRESS) reason = finish_connecting(handle, patience_s);
    if (reason) close(handle);
    else *out = handle;
    return reason;
}

bool viewer_socket_open(const char *host, const char *port, double *patience_s, int *out,
                        Error *err)
{
    NameLookup *lookup = NULL;
    int         reason = EADDRNOTAVAIL;
    if (!find_host(host, port, patience_s, &lookup, err)) return false;
    for (const struct addrinfo *to = lookup->found; to && reason; to = to->ai_next)
        reason = connect_to(to, patience_s, out);
    end_lookup(lookup);
    return !reason || error_set(err, ERROR_OUTPUT, "%s", strerror(reason));
}

/* ---- sending ----------------------------------------------------------------------------- */

bool viewer_socket_send(int handle, const void *bytes, size_t size, size_t *taken, Error *err)
{
    ssize_t sent = send(handle, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    bool    is_full = sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
    if (sent < 0 && !is_full) return error_set(err, ERROR_OUTPUT, "%s", strerror(errno));
    *taken = is_full ? 0 : (size_t)sent;
    return true;
}

void viewer_socket_close(int handle)
{
    close(handle);
}
