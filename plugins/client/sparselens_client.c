#define _GNU_SOURCE
#include "sparselens_client.h"

#include "conversation.h"
#include "gatherer_process.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { seconds_to_start = 60 };

struct sparselens_client {
    pthread_mutex_t mutex; /* for everything below */
    char *program;
    gatherer_process gatherer;
    line_buffer line;
};

sparselens_client *sparselens_client_new(const char *program) {
    sparselens_client *client = calloc(1, sizeof *client);
    if (!client) return NULL;
    client->gatherer.socket = client->gatherer.memory = -1;
    client->program = strdup(program);
    if (!client->program || pthread_mutex_init(&client->mutex, NULL) != 0) {
        free(client->program);
        free(client);
        return NULL;
    }
    return client;
}

void sparselens_client_free(sparselens_client *client) {
    if (!client) return;
    sparselens_gatherer_end(&client->gatherer);
    pthread_mutex_destroy(&client->mutex);
    free(client->line.text);
    free(client->program);
    free(client);
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

static outcome receive(sparselens_client *client, double deadline, sparselens_answer *answer) {
    return sparselens_receive_line(client->gatherer.socket, client->program, deadline, &client->line, answer);
}

/* Starts the gatherer and takes its greeting. */
static outcome start(sparselens_client *client, sparselens_answer *answer) {
    const int failed = sparselens_gatherer_start(&client->gatherer, client->program);
    if (failed) return sparselens_say(answer, "cannot start %s: %s", client->program, strerror(failed));
    const outcome greeted = receive(client, sparselens_seconds_now() + seconds_to_start, answer);
    if (greeted == gatherer_gone)
        return sparselens_say(answer,
                              "%s: ends at once; it must be the dof-view of this version of sparselens",
                              client->program);
    if (greeted == got_answer &&
        (!sparselens_parse_answer(client->line.text, answer) || !is_known(answer->text)))
        return sparselens_say(
            answer, "%s: is not of the version that this program knows; install both from one sparselens",
            client->program);
    return greeted;
}

typedef struct {
    const char *line;
    const void *pixels; /* null if there are none */
    size_t bytes;
} request_with_pixels;

static outcome ask(sparselens_client *client, const request_with_pixels *request, double deadline,
                   sparselens_answer *answer) {
    gatherer_process *gatherer = &client->gatherer;
    clear(answer);
    if (gatherer->process > 0 && gatherer->owner != getpid()) sparselens_gatherer_end(gatherer);
    if (gatherer->process == 0) {
        const outcome started = start(client, answer);
        if (started != got_answer) return started;
        clear(answer);
    }
    outcome done = got_answer;
    if (request->pixels)
        done = sparselens_put_pixels(gatherer->memory, request->pixels, request->bytes, answer);
    if (done == got_answer)
        done = sparselens_send_line(gatherer->socket, client->program, request->line, deadline, answer);
    if (done == got_answer) done = receive(client, deadline, answer);
    if (done == got_answer && !sparselens_parse_answer(client->line.text, answer)) done = gatherer_gone;
    return done == got_answer ? sparselens_take_pixels(gatherer->memory, answer) : done;
}

int sparselens_ask(sparselens_client *client, const char *request, double seconds,
                   sparselens_answer *answer) {
    return sparselens_ask_with_pixels(client, request, NULL, 0, seconds, answer);
}

int sparselens_ask_with_pixels(sparselens_client *client, const char *request, const void *pixels,
                               size_t bytes, double seconds, sparselens_answer *answer) {
    const request_with_pixels all = {request, pixels, bytes};
    const double deadline = sparselens_seconds_now() + seconds;
    memset(answer, 0, sizeof *answer);
    if (strchr(request, '\n')) {
        sparselens_say(answer, "a request is one line");
        return 0;
    }
    pthread_mutex_lock(&client->mutex);
    outcome done = gatherer_gone;
    for (int attempt = 0; attempt < 2 && done == gatherer_gone; ++attempt) {
        done = ask(client, &all, deadline, answer);
        if (done != got_answer) sparselens_gatherer_end(&client->gatherer);
    }
    pthread_mutex_unlock(&client->mutex);
    if (done == gatherer_gone) {
        clear(answer);
        sparselens_say(answer, "%s: ended twice before it answered", client->program);
    }
    return answer->status;
}

void sparselens_answer_free(sparselens_answer *answer) { clear(answer); }

int sparselens_gatherer(sparselens_client *client) {
    pthread_mutex_lock(&client->mutex);
    const int process = client->gatherer.process;
    pthread_mutex_unlock(&client->mutex);
    return process;
}
