#define _GNU_SOURCE
#include "conversation.h"

#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { longest_line = 64 << 20 };

double sparselens_seconds_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

outcome sparselens_say(sparselens_answer *answer, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    free(answer->text);
    answer->text = strdup(text);
    answer->status = 0;
    return no_answer;
}

/* Waits until the socket can be read or written. Returns whether it can before the deadline. */
static int ready(int socket, short events, double deadline) {
    for (;;) {
        struct pollfd file = {socket, events, 0};
        const double left = deadline - sparselens_seconds_now();
        if (left <= 0) return 0;
        const int found = poll(&file, 1, left > 1e6 ? 1000000000 : (int)(left * 1000) + 1);
        if (found > 0) return 1;
        if (found < 0 && errno != EINTR) return 0;
    }
}

outcome sparselens_send_line(int socket, const char *name, const char *request, double deadline,
                             sparselens_answer *answer) {
    const size_t length = strlen(request);
    for (size_t sent = 0; sent <= length;) {
        const char *from = sent < length ? request + sent : "\n";
        const size_t count = sent < length ? length - sent : 1;
        /* A signal for a closed socket would end the program. */
        const ssize_t n = send(socket, from, count, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) {
            sent += (size_t)n;
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            if (!ready(socket, POLLOUT, deadline))
                return sparselens_say(answer, "%s: does not take the request in time", name);
        } else if (errno != EINTR) {
            return gatherer_gone;
        }
    }
    return got_answer;
}

/* Makes room for more of the line and its zero byte. Returns whether there is. */
static int make_room(line_buffer *line) {
    if (line->filled + 1 < line->room) return 1;
    const size_t room = line->room ? 2 * line->room : 4096;
    char *more = room <= longest_line ? realloc(line->text, room) : NULL;
    if (!more) return 0;
    line->text = more;
    line->room = room;
    return 1;
}

outcome sparselens_receive_line(int socket, const char *name, double deadline, line_buffer *line,
                                sparselens_answer *answer) {
    line->filled = 0;
    for (;;) {
        if (!make_room(line)) return sparselens_say(answer, "%s: its answer is too long", name);
        if (!ready(socket, POLLIN, deadline))
            return sparselens_say(answer, "%s: does not answer in time", name);
        char *to = line->text + line->filled;
        const ssize_t n = recv(socket, to, line->room - line->filled - 1, MSG_DONTWAIT);
        if (n == 0) return gatherer_gone;
        if (n < 0) {
            if (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK) continue;
            return gatherer_gone;
        }
        line->filled += (size_t)n;
        line->text[line->filled] = '\0';
        char *end = memchr(to, '\n', (size_t)n);
        if (end) {
            *end = '\0';
            return got_answer;
        }
    }
}

int sparselens_parse_answer(const char *line, sparselens_answer *answer) {
    char *end;
    const long status = strtol(line, &end, 10);
    if (*end != ' ' || (status != 200 && status != 400 && status != 500)) return 0;
    const char *number = end + 1;
    const unsigned long long bytes = strtoull(number, &end, 10);
    if (end == number || *end != ' ' || bytes > (size_t)-1 / 2) return 0;
    free(answer->text);
    answer->text = strdup(end + 1);
    answer->status = answer->text ? (int)status : 0;
    answer->pixel_bytes = (size_t)bytes;
    return answer->text != NULL;
}

outcome sparselens_put_pixels(int memory, const void *pixels, size_t bytes, sparselens_answer *answer) {
    int failed = ftruncate(memory, 0) != 0;
    for (size_t done = 0; !failed && done < bytes;) {
        const ssize_t n = pwrite(memory, (const char *)pixels + done, bytes - done, (off_t)done);
        if (n > 0)
            done += (size_t)n;
        else
            failed = errno != EINTR;
    }
    if (!failed) return got_answer;
    return sparselens_say(answer, "cannot share %zu bytes of pixels: %s", bytes, strerror(errno));
}

/* By copies: a file that the other side cuts off cannot raise a signal. */
outcome sparselens_take_pixels(int memory, sparselens_answer *answer) {
    struct stat info;
    if (answer->pixel_bytes == 0) return got_answer;
    if (fstat(memory, &info) != 0 || (size_t)info.st_size < answer->pixel_bytes) return gatherer_gone;
    answer->pixels = malloc(answer->pixel_bytes);
    for (size_t done = 0; answer->pixels && done < answer->pixel_bytes;) {
        const ssize_t n =
            pread(memory, (char *)answer->pixels + done, answer->pixel_bytes - done, (off_t)done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return gatherer_gone;
        done += (size_t)n;
    }
    if (ftruncate(memory, 0) != 0) return gatherer_gone;
    if (answer->pixels) return got_answer;
    sparselens_say(answer, "there is not enough memory for %zu bytes of pixels", answer->pixel_bytes);
    answer->pixel_bytes = 0;
    return no_answer;
}
