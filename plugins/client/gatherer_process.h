/* The process of a gatherer, and what it shares with this one: a socket, and a file in memory for pixels. */
#ifndef SPARSELENS_GATHERER_PROCESS_H
#define SPARSELENS_GATHERER_PROCESS_H

#include <sys/types.h>

typedef struct {
    pid_t owner;   /* the process that started the gatherer: after a fork the child starts its own */
    pid_t process; /* 0: there is no gatherer */
    int socket;    /* its standard input and output; -1 if there is none */
    int memory;    /* the pixels; -1 if there are none */
} gatherer_process;

/* Starts `program --pipe`. Returns an error number; then nothing is left but what sparselens_gatherer_end() ends. */
int sparselens_gatherer_start(gatherer_process *gatherer, const char *program);

/* Ends the gatherer if it is ours, and forgets it. */
void sparselens_gatherer_end(gatherer_process *gatherer);

#endif
