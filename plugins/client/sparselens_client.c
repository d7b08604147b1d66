#define _GNU_SOURCE
#include "sparselens_client.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

enum { longest_line = 64 << 20, seconds_to_start = 60, pixel_file = 3 };

struct sparselens_client {
    pthread_mutex_t mutex; /* for everything below */
    char *program;
    pid_t owner;   /* the process that started the gatherer: after a fork the child starts its own */
    pid_t process; /* 0: there is no gatherer */
    int socket;    /* its standard input and output */
    int memory;    /* the pixels */
    char *line;    /* what was received of an answer */
    size_t filled, room;
};

/* How an attempt to get an answer ended. */
typedef enum { got_answer, gatherer_gone, no_answer } outcome;

static void say(sparselens_answer *answer, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    free(answer->text);
    answer->text = strdup(text);
    answer->status = 0;
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

sparselens_client *sparselens_client_new(const char *program) {
    sparselens_client *client = calloc(1, sizeof *client);
    if (!client) return NULL;
    client->socket = client->memory = -1;
    client->program = strdup(program);
    if (!client->program || pthread_mutex_init(&client->mutex, NULL) != 0) {
        free(client->program);
        free(client);
        return NULL;
    }
    return client;
}

/* Ends the gatherer if it is ours, and forgets it. */
static void drop(sparselens_client *client) {
    if (client->socket >= 0) close(client->socket);
    if (client->memory >= 0) close(client->memory);
    client->socket = client->memory = -1;
    /* A process that the program has waited for itself may have a successor of the same number. */
    if (client->process > 0 && client->owner == getpid() && waitpid(client->process, NULL, WNOHANG) == 0) {
        kill(client->process, SIGKILL);
        while (waitpid(client->process, NULL, 0) < 0 && errno == EINTR) {
        }
    }
    client->process = 0;
    client->filled = 0;
}

void sparselens_client_free(sparselens_client *client) {
    if (!client) return;
    drop(client);
    pthread_mutex_destroy(&client->mutex);
    free(client->line);
    free(client->program);
    free(client);
}

/* Starts the program with `theirs` as its standard input and output. Returns an error number. */
static int spawn(sparselens_client *client, int theirs) {
    char pipe_word[] = "--pipe";
    char *words[] = {client->program, pipe_word, NULL};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int failed;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    /* The signals of a program of its own, whatever this one ignores or blocks. */
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    posix_spawn_file_actions_adddup2(&files, theirs, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, theirs, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, client->memory, pixel_file);
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 34)
    posix_spawn_file_actions_addclosefrom_np(
        &files, pixel_file + 1); /* files of the program that it forgot to close */
#endif
    failed = posix_spawnp(&client->process, client->program, &files, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (failed) client->process = 0;
    return failed;
}

/* A descriptor above those that spawn() gives to the gatherer, which would otherwise be overwritten. */
static int above(int file) {
    if (file < 0 || file > pixel_file) return file;
    const int moved = fcntl(file, F_DUPFD_CLOEXEC, pixel_file + 1);
    close(file);
    return moved;
}

/* Waits until the socket can be read or written. Returns whether it can before the deadline. */
static int ready(int socket, short events, double deadline) {
    for (;;) {
        struct pollfd file = {socket, events, 0};
        const double left = deadline - now();
        if (left <= 0) return 0;
        const int found = poll(&file, 1, left > 1e6 ? 1000000000 : (int)(left * 1000) + 1);
        if (found > 0) return 1;
        if (found < 0 && errno != EINTR) return 0;
    }
}

static outcome send_line(sparselens_client *client, const char *request, double deadline,
                         sparselens_answer *answer) {
    const size_t length = strlen(request);
    for (size_t sent = 0; sent <= length;) {
        const char *from = sent < length ? request + sent : "\n";
        const size_t count = sent < length ? length - sent : 1;
        /* A signal for a closed socket would end the program. */
        const ssize_t n = send(client->socket, from, count, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) {
            sent += (size_t)n;
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            if (!ready(client->socket, POLLOUT, deadline)) {
                say(answer, "%s: does not take the request in time", client->program);
                return no_answer;
            }
        } else if (errno != EINTR) {
            return gatherer_gone;
        }
    }
    return got_answer;
}

/* Receives a line, without its end, into client->line. */
static outcome receive_line(sparselens_client *client, double deadline, sparselens_answer *answer) {
    client->filled = 0;
    for (;;) {
        if (client->filled + 1 >= client->room) {
            const size_t room = client->room ? 2 * client->room : 4096;
            char *more = room <= longest_line ? realloc(client->line, room) : NULL;
            if (!more) {
                say(answer, "%s: its answer is too long", client->program);
                return no_answer;
            }
            client->line = more;
            client->room = room;
        }
        if (!ready(client->socket, POLLIN, deadline)) {
            say(answer, "%s: does not answer in time", client->program);
            return no_answer;
        }
        const ssize_t n = recv(client->socket, client->line + client->filled,
                               client->room - client->filled - 1, MSG_DONTWAIT);
        if (n == 0) return gatherer_gone;
        if (n < 0) {
            if (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK) continue;
            return gatherer_gone;
        }
        client->filled += (size_t)n;
        client->line[client->filled] = '\0';
        char *end = memchr(client->line + client->filled - n, '\n', (size_t)n);
        if (end) {
            *end = '\0';
            return got_answer;
        }
    }
}

/* Takes "STATUS BYTES TEXT" apart. Returns whether it is that. */
static int parse(const char *line, sparselens_answer *answer) {
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

/* Reads the pixels out of the shared file, by copies: a file that the other side cuts off cannot raise a signal. Then
 * empties it. */
static outcome take_pixels(sparselens_client *client, sparselens_answer *answer) {
    struct stat info;
    if (answer->pixel_bytes == 0) return got_answer;
    if (fstat(client->memory, &info) != 0 || (size_t)info.st_size < answer->pixel_bytes) return gatherer_gone;
    answer->pixels = malloc(answer->pixel_bytes);
    for (size_t done = 0; answer->pixels && done < answer->pixel_bytes;) {
        const ssize_t n =
            pread(client->memory, (char *)answer->pixels + done, answer->pixel_bytes - done, (off_t)done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return gatherer_gone;
        done += (size_t)n;
    }
    if (ftruncate(client->memory, 0) != 0) return gatherer_gone;
    if (answer->pixels) return got_answer;
    say(answer, "there is not enough memory for %zu bytes of pixels", answer->pixel_bytes);
    answer->pixel_bytes = 0;
    return no_answer;
}

static void clear(sparselens_answer *answer) {
    free(answer->text);
    free(answer->pixels);
    memset(answer, 0, sizeof *answer);
}

/* Whether the greeting is that of a gatherer of this version. */
static int is_known(const char *text) {
    const char *version = strstr(text, "\"pipe\":");
    return version && strtol(version + strlen("\"pipe\":"), NULL, 10) == SPARSELENS_PIPE_VERSION;
}

static outcome start(sparselens_client *client, sparselens_answer *answer) {
    int ends[2] = {-1, -1};
    client->owner = getpid();
    client->memory = above(memfd_create("sparselens", MFD_CLOEXEC));
    if (client->memory < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        say(answer, "cannot make memory to share or a socket: %s", strerror(errno));
        return no_answer;
    }
    client->socket = above(ends[0]);
    const int theirs = above(ends[1]);
    const int failed = client->socket < 0 || theirs < 0 ? EMFILE : spawn(client, theirs);
    if (theirs >= 0) close(theirs);
    if (failed) {
        say(answer, "cannot start %s: %s", client->program, strerror(failed));
        return no_answer;
    }
    const outcome greeted = receive_line(client, now() + seconds_to_start, answer);
    if (greeted == gatherer_gone) {
        say(answer, "%s: ends at once; it must be the dof-view of this version of sparselens",
            client->program);
        return no_answer;
    }
    if (greeted == got_answer && (!parse(client->line, answer) || !is_known(answer->text))) {
        say(answer, "%s: is not of the version that this program knows; install both from one sparselens",
            client->program);
        return no_answer;
    }
    return greeted;
}

static outcome ask(sparselens_client *client, const char *request, double deadline,
                   sparselens_answer *answer) {
    clear(answer);
    if (client->process > 0 && client->owner != getpid()) drop(client);
    if (client->process == 0) {
        const outcome started = start(client, answer);
        if (started != got_answer) return started;
        clear(answer);
    }
    outcome done = send_line(client, request, deadline, answer);
    if (done == got_answer) done = receive_line(client, deadline, answer);
    if (done == got_answer && !parse(client->line, answer)) done = gatherer_gone;
    return done == got_answer ? take_pixels(client, answer) : done;
}

int sparselens_ask(sparselens_client *client, const char *request, double seconds,
                   sparselens_answer *answer) {
    const double deadline = now() + seconds;
    memset(answer, 0, sizeof *answer);
    if (strchr(request, '\n')) {
        say(answer, "a request is one line");
        return 0;
    }
    pthread_mutex_lock(&client->mutex);
    outcome done = gatherer_gone;
    for (int attempt = 0; attempt < 2 && done == gatherer_gone; ++attempt) {
        done = ask(client, request, deadline, answer);
        if (done != got_answer) drop(client);
    }
    pthread_mutex_unlock(&client->mutex);
    if (done == gatherer_gone) {
        clear(answer);
        say(answer, "%s: ended twice before it answered", client->program);
    }
    return answer->status;
}

void sparselens_answer_free(sparselens_answer *answer) { clear(answer); }

int sparselens_gatherer(sparselens_client *client) {
    pthread_mutex_lock(&client->mutex);
    const int process = client->process;
    pthread_mutex_unlock(&client->mutex);
    return process;
}
