// Preloaded into the program: the allocation number NSMA_FAILING_ALLOCATION after its first call of signal() finds no
// memory, or with 0 none does and the number of all is written to the file NSMA_COUNTED_ALLOCATIONS.
#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> counted{-1};  // -1: main() has not begun
long failing = 0;

bool fails() { return counted >= 0 && ++counted == failing; }

// The next definition of a function; its search may allocate, which the buffer below serves.
template <class Function>
Function* next(Function*& found, const char* name) {
    if (found == nullptr) found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
    return found;
}

decltype(std::malloc)* next_malloc = nullptr;
decltype(std::calloc)* next_calloc = nullptr;
decltype(std::realloc)* next_realloc = nullptr;
decltype(posix_memalign)* next_memalign = nullptr;

__attribute__((destructor)) void write_count() {
    const char* file = std::getenv("NSMA_COUNTED_ALLOCATIONS");
    if (failing != 0 || file == nullptr || counted < 0) return;
    if (std::FILE* stream = std::fopen(file, "w")) {
        std::fprintf(stream, "%ld\n", counted.load());
        std::fclose(stream);
    }
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
    if (fails()) return errno = ENOMEM, nullptr;
    return next(next_malloc, "malloc")(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
    if (fails()) return errno = ENOMEM, nullptr;
    return next(next_calloc, "calloc")(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
    if (fails()) return errno = ENOMEM, nullptr;
    return next(next_realloc, "realloc")(block, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
    if (fails()) return ENOMEM;
    return next(next_memalign, "posix_memalign")(block, alignment, size);
}

using Handler = void (*)(int);

Handler signal(int number, Handler handler) noexcept {
    static Handler (*next_signal)(int, Handler) = nullptr;
    if (counted < 0) {
        const char* const value = std::getenv("NSMA_FAILING_ALLOCATION");
        failing = value == nullptr ? 0 : std::atol(value);
        unsetenv("LD_PRELOAD");  // what the program starts has memory
        counted = 0;
    }
    return next(next_signal, "signal")(number, handler);
}

}  // extern "C"
