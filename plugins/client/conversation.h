/* Lines and pixels that go to a gatherer and come back. `name` stands for the gatherer in messages. */
#ifndef SPARSELENS_CONVERSATION_H
#define SPARSELENS_CONVERSATION_H

#include "gatherer_process.h"
#include "sparselens_client.h"

/* How an attempt to get an answer ended; after no_answer the reason is the text of the answer. */
typedef enum { got_answer, gatherer_gone, no_answer } outcome;

/* The part of a line that has been received, with a zero byte at its end. The next line uses the same memory. */
typedef struct {
    char *text;
    size_t filled, room;
} line_buffer;

/* Seconds of a clock that only goes forward; deadlines are given by it. */
double sparselens_seconds_now(void);

/* Makes the text of the answer, with the status 0. Returns no_answer. */
outcome sparselens_say(sparselens_answer *answer, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Sends a request and its end of line. */
outcome sparselens_send_line(int socket, const char *name, const char *request, double deadline,
                             sparselens_answer *answer);

/* Receives a line, without its end. */
outcome sparselens_receive_line(int socket, const char *name, double deadline, line_buffer *line,
                                sparselens_answer *answer);

/* Takes "STATUS BYTES TEXT" apart. Returns whether it is that. */
int sparselens_parse_answer(const char *line, sparselens_answer *answer);

/* Makes the shared file hold these bytes alone. */
outcome sparselens_put_pixels(int memory, const void *pixels, size_t bytes, sparselens_answer *answer);

/* Takes the pixels of the answer out of the shared file, and empties it. */
outcome sparselens_take_pixels(int memory, sparselens_answer *answer);

#endif
