/* Asks dof-view --pipe through the client of plugins/client, for scripts.
 *
 *   ask PROGRAM SECONDS REQUEST...   prints "STATUS BYTES TEXT" for each request; the pixels of the last one go to
 *                                    the file `pixels`
 *   ask PROGRAM kill TIMES REQUEST   kills the gatherer at random moments of a request, which must succeed all the same
 *   ask PROGRAM fork REQUEST         a forked child and its parent ask at the same time
 *   ask PROGRAM die REQUEST          ends by SIGKILL in the middle of the request, after it has printed the gatherer's
 *                                    process
 *   ask PROGRAM files REQUEST        no descriptor is left open, and none of ours is open in the gatherer */
#define _GNU_SOURCE
#include "sparselens_client.h"

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void pause_for(double seconds) {
    const struct timespec time = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&time, NULL);
}

static void fail(const char *what, const sparselens_answer *answer) {
    fprintf(stderr, "ask: %s (%d %s)\n", what, answer->status, answer->text ? answer->text : "");
    exit(1);
}

static void require(int holds, const char *what, const sparselens_answer *answer) {
    if (!holds) fail(what, answer);
}

static int ask_all(sparselens_client *client, double seconds, char **requests) {
    for (; *requests; ++requests) {
        sparselens_answer answer;
        sparselens_ask(client, *requests, seconds, &answer);
        printf("%d %zu %s\n", answer.status, answer.pixel_bytes, answer.text ? answer.text : "");
        FILE *file = fopen("pixels", "wb");
        if (!file || fwrite(answer.pixels, 1, answer.pixel_bytes, file) != answer.pixel_bytes ||
            fclose(file) != 0)
            fail("cannot write pixels", &answer);
        sparselens_answer_free(&answer);
    }
    return 0;
}

struct killer {
    pid_t process;
    double after;
};

static void *kill_later(void *argument) {
    const struct killer *killer = argument;
    pause_for(killer->after);
    kill(killer->process, SIGKILL);
    return NULL;
}

static int is_same(const sparselens_answer *a, const sparselens_answer *b) {
    return a->status == 200 && a->pixel_bytes == b->pixel_bytes &&
           memcmp(a->pixels, b->pixels, a->pixel_bytes) == 0;
}

static int kill_often(sparselens_client *client, int times, const char *request) {
    sparselens_answer expected, answer;
    unsigned random = 1;
    require(sparselens_ask(client, request, 60, &expected) == 200, "the first request", &expected);
    kill(sparselens_gatherer(client), SIGKILL); /* the next request finds nothing kept */
    pause_for(0.5);                             /* and a socket that nobody reads */
    double begun = now();
    require(sparselens_ask(client, request, 60, &answer) == 200, "the request after a kill", &answer);
    const double usual = now() - begun;
    sparselens_answer_free(&answer);
    for (int i = 0; i < times; ++i) {
        random = random * 1664525u + 1013904223u;
        struct killer killer = {sparselens_gatherer(client),
                                usual * (double)(random >> 8) / (double)(1 << 24)};
        pthread_t thread;
        if (pthread_create(&thread, NULL, kill_later, &killer) != 0) return 1;
        do { /* until the kill has come, whatever it met */
            sparselens_ask(client, request, 60, &answer);
            require(is_same(&answer, &expected), "a killed request", &answer);
            sparselens_answer_free(&answer);
        } while (pthread_tryjoin_np(thread, NULL) != 0);
        sparselens_ask(client, request, 60, &answer);
        require(is_same(&answer, &expected), "the request after it", &answer);
        sparselens_answer_free(&answer);
    }
    sparselens_answer_free(&expected);
    return 0;
}

static int fork_and_ask(sparselens_client *client, const char *request) {
    sparselens_answer expected, answer;
    require(sparselens_ask(client, request, 60, &expected) == 200, "the first request", &expected);
    const int before = sparselens_gatherer(client);
    const pid_t child = fork();
    for (int i = 0; i < 5; ++i) {
        sparselens_ask(client, request, 60, &answer);
        require(is_same(&answer, &expected), child ? "the parent's request" : "the child's request", &answer);
        sparselens_answer_free(&answer);
    }
    if (child == 0) {
        require(sparselens_gatherer(client) != before, "the child uses the parent's gatherer", &expected);
        _exit(0);
    }
    int status = 1;
    waitpid(child, &status, 0);
    require(sparselens_gatherer(client) == before, "the parent has lost its gatherer", &expected);
    sparselens_answer_free(&expected);
    return status;
}

static void *die_soon(void *unused) {
    (void)unused;
    pause_for(0.3);
    kill(getpid(), SIGKILL);
    return NULL;
}

static _Noreturn void die(sparselens_client *client, const char *request) {
    sparselens_answer answer;
    pthread_t thread;
    sparselens_ask(client, "{}", 60, &answer);
    printf("%d\n", sparselens_gatherer(client));
    fflush(stdout);
    pthread_create(&thread, NULL, die_soon, NULL);
    for (;;) sparselens_ask(client, request, 60, &answer);
}

static int count_files(int process) {
    char folder[64];
    int count = 0;
    snprintf(folder, sizeof folder, "/proc/%d/fd", process);
    DIR *files = opendir(folder);
    while (files && readdir(files)) ++count;
    if (files) closedir(files);
    return count;
}

static int check_files(sparselens_client *client, const char *request) {
    sparselens_answer answer;
    const int before = count_files(getpid());
    const int ours = open("/dev/null", O_RDONLY); /* without O_CLOEXEC */
    require(sparselens_ask(client, request, 60, &answer) == 200, "the request", &answer);
    char link[64], target[64] = "";
    snprintf(link, sizeof link, "/proc/%d/fd/%d", sparselens_gatherer(client), ours);
    if (readlink(link, target, sizeof target - 1) > 0)
        require(strcmp(target, "/dev/null") != 0, "ours is open there", &answer);
    close(ours);
    sparselens_answer_free(&answer);
    kill(sparselens_gatherer(client), SIGKILL);
    require(sparselens_ask(client, request, 60, &answer) == 200, "the request after a kill", &answer);
    sparselens_answer_free(&answer);
    sparselens_client_free(client);
    require(count_files(getpid()) == before, "a descriptor is left open", &answer);
    return 0;
}

int main(int count, char **words) {
    if (count < 4) return 2;
    sparselens_client *client = sparselens_client_new(words[1]);
    if (!client) return 1;
    const char *what = words[2];
    int code;
    if (strcmp(what, "kill") == 0)
        code = kill_often(client, atoi(words[3]), words[4]);
    else if (strcmp(what, "fork") == 0)
        code = fork_and_ask(client, words[3]);
    else if (strcmp(what, "die") == 0)
        die(client, words[3]);
    else if (strcmp(what, "files") == 0)
        return check_files(client, words[3]);
    else
        code = ask_all(client, atof(what), words + 3);
    sparselens_client_free(client);
    return code;
}
