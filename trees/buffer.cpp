#include "trees/buffer.h"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace boxwood {

void* allocate_lines(std::size_t bytes) {
    constexpr std::size_t line = 64, huge_page = std::size_t{1} << 21;
    const std::size_t alignment = bytes >= 2 * huge_page ? huge_page : line;
    const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
    void* memory = size < bytes ? nullptr : std::aligned_alloc(alignment, size);
    if (!memory)
        throw std::bad_alloc();
#if defined(__linux__)
    // Only advice: without it walks through a large tree miss the TLB at every step.
    if (alignment == huge_page)
        madvise(memory, size, MADV_HUGEPAGE);
#endif
    return memory;
}

void free_lines(void* memory) { std::free(memory); }

} // namespace boxwood
