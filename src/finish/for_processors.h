// Loops over all pixels are compiled for several processors; none contracts products and sums, so all give the same bits. Not under
// ThreadSanitizer, as the loader chooses among them before that has begun.
#pragma once

#ifdef __SANITIZE_THREAD__
#define FOR_PROCESSORS
#else
#define FOR_PROCESSORS [[gnu::target_clones("default,avx2")]]
#endif
