/* A client of dof-view --pipe in C: asks a gatherer for pictures. Needs nothing but POSIX and Linux's memfd_create().
 *
 * The gatherer is a process of its own, which begins with the first request. If it crashes or is killed, the request is
 * asked again of a new one, once. It ends when the client is freed, or with the program. The pixels come through a file
 * in memory that has no name, so nothing is left behind, however either side ends.
 *
 * tools/viewing/pipe_request.h describes the requests. */
#ifndef SPARSELENS_CLIENT_H
#define SPARSELENS_CLIENT_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the requests and answers; a gatherer of another version is an error. */
#define SPARSELENS_PIPE_VERSION 2

typedef struct sparselens_client sparselens_client;

/* The answer to a request. Free it with sparselens_answer_free(), whatever its status is. */
typedef struct {
    int status;         /* 200; 400: the request is impossible; 500: it failed; 0: there is no answer */
    char *text;         /* JSON; the reason, in one line, if the status is another than 200 */
    void *pixels;       /* or the bytes of a header; null if there are none */
    size_t pixel_bytes; /* number of bytes */
} sparselens_answer;

/* `program` is the path of dof-view, or its name, which is then searched in PATH. Returns null if there is no memory.
 * Starts nothing. */
sparselens_client *sparselens_client_new(const char *program);

/* Where dof-view is: in the folder that $SPARSELENS_BIN names; else in `folder`, a path that begins at the folder of the
 * program or library that holds `function`, if it is there; else its name alone. Returns null if there is no memory. */
char *sparselens_find_program(const void *function, const char *folder);

/* Ends the gatherer. No other thread may use the client. */
void sparselens_client_free(sparselens_client *client);

/* Sends a request, one line of JSON without its end, and waits for the answer, at most `seconds`; a gatherer that takes
 * longer is killed. Any number of threads may call it: they take turns. Returns the status of the answer. */
int sparselens_ask(sparselens_client *client, const char *request, double seconds, sparselens_answer *answer);

/* The same, with a picture that the request describes: `bytes` of pixels, which are copied. */
int sparselens_ask_with_pixels(sparselens_client *client, const char *request, const void *pixels,
                               size_t bytes, double seconds, sparselens_answer *answer);

void sparselens_answer_free(sparselens_answer *answer);

/* The process of the gatherer; 0 if there is none. For tests. */
int sparselens_gatherer(sparselens_client *client);

#ifdef __cplusplus
}
#endif
#endif
