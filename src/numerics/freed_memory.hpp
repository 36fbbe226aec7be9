#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace nsma {

/// Has the process keep memory that was freed (up to 64 MB, with glibc): Ipopt's linear solver takes and gives back its
/// own in every iteration, NLopt's L-BFGS in every call, and fresh pages take longer than their work. For the start of
/// a program.
inline void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int kept = 64 << 20;  // bytes
    mallopt(M_TRIM_THRESHOLD, kept);
    mallopt(M_TOP_PAD, kept / 4);
    mallopt(M_MMAP_THRESHOLD, kept / 2);  // a block of its own would go back when freed
#endif
}

}  // namespace nsma
