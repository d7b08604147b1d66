// The memory that the process holds.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sparselens {

// Returns freed memory to the system. Otherwise it stays with the threads that allocated it, and other threads cannot
// use it. This is worth it between steps that need much memory.
inline void give_back_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace sparselens
