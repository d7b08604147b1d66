#define _GNU_SOURCE
#include "gatherer_process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { pixel_file = 3 };

/* Starts the program with `theirs` as its standard input and output. */
static int spawn(gatherer_process *gatherer, const char *program, int theirs) {
    char pipe_word[] = "--pipe";
    char *name = strdup(program);
    char *words[] = {name, pipe_word, NULL};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int failed;
    if (!name) return ENOMEM;
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
    posix_spawn_file_actions_adddup2(&files, gatherer->memory, pixel_file);
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 34)
    /* Files of the program that it forgot to close. */
    posix_spawn_file_actions_addclosefrom_np(&files, pixel_file + 1);
#endif
    failed = posix_spawnp(&gatherer->process, program, &files, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    free(name);
    if (failed) gatherer->process = 0;
    return failed;
}

/* A descriptor above those that spawn() gives to the gatherer, which would otherwise be overwritten. */
static int above(int file) {
    if (file < 0 || file > pixel_file) return file;
    const int moved = fcntl(file, F_DUPFD_CLOEXEC, pixel_file + 1);
    close(file);
    return moved;
}

int sparselens_gatherer_start(gatherer_process *gatherer, const char *program) {
    int ends[2] = {-1, -1};
    gatherer->owner = getpid();
    gatherer->memory = above(memfd_create("sparselens", MFD_CLOEXEC));
    if (gatherer->memory < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return errno;
    gatherer->socket = above(ends[0]);
    const int theirs = above(ends[1]);
    const int failed = gatherer->socket < 0 || theirs < 0 ? EMFILE : spawn(gatherer, program, theirs);
    if (theirs >= 0) close(theirs);
    return failed;
}

void sparselens_gatherer_end(gatherer_process *gatherer) {
    if (gatherer->socket >= 0) close(gatherer->socket);
    if (gatherer->memory >= 0) close(gatherer->memory);
    gatherer->socket = gatherer->memory = -1;
    /* A process that the program has waited for itself may have a successor of the same number. */
    if (gatherer->process > 0 && gatherer->owner == getpid() &&
        waitpid(gatherer->process, NULL, WNOHANG) == 0) {
        kill(gatherer->process, SIGKILL);
        while (waitpid(gatherer->process, NULL, 0) < 0 && errno == EINTR) {
        }
    }
    gatherer->process = 0;
}
