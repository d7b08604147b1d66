// Memory of the process.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sparselens {

// Returns freed memory to the system. Else it stays with the threads that allocated it, and other threads cannot use
// it. To be called between steps that need much.
inline void give_back_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace sparselens
