// Compiles loops over all pixels for several processors. No version contracts products and sums, so all give the same
// bits. It is off under ThreadSanitizer, because the loader chooses among them before ThreadSanitizer has started.
#pragma once

#ifdef __SANITIZE_THREAD__
#define FOR_PROCESSORS
#else
#define FOR_PROCESSORS [[gnu::target_clones("default,avx2")]]
#endif
