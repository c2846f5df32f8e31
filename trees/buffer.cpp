#include "trees/buffer.h"

#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

#if defined(__linux__)
#include <malloc.h>
#include <sys/mman.h>
#endif

namespace boxwood {
namespace {

constexpr std::size_t line = 64, huge_page = std::size_t{1} << 21;

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)

/// Large blocks that were freed, for the next that ask: fresh ones are cleared page by page in the
/// middle of a build, by one thread while others wait, which took a fifth of the fastest. The
/// system may take the pages back at any time (MADV_FREE).
class KeptBlocks {
  public:
    /// One of at least this size and not much larger, or nullptr.
    void* take(std::size_t size) {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = blocks_.size(); i-- > 0;)
            if (blocks_[i].size >= size && blocks_[i].size <= size + size / 4) {
                void* const memory = blocks_[i].memory;
                forget(i);
                return memory;
            }
        return nullptr;
    }

    /// False if the block is to be freed.
    bool keep(void* memory) {
        if (reinterpret_cast<std::uintptr_t>(memory) % huge_page != 0)
            return false;
        const std::size_t size = malloc_usable_size(memory) / huge_page * huge_page;
        if (size < 2 * huge_page || size > most_bytes)
            return false;
        madvise(memory, size, MADV_FREE);
        const std::lock_guard lock(mutex_);
        while (blocks_.size() == most_blocks || bytes_ + size > most_bytes) {
            std::free(blocks_.front().memory); // the oldest
            forget(0);
        }
        blocks_.push_back({memory, size});
        bytes_ += size;
        return true;
    }

  private:
    struct Block {
        void* memory;
        std::size_t size;
    };
    static constexpr std::size_t most_blocks = 16, most_bytes = std::size_t{1} << 28;

    void forget(std::size_t i) {
        bytes_ -= blocks_[i].size;
        blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(i));
    }

    std::mutex mutex_;
    std::vector<Block> blocks_ = [] {
        std::vector<Block> none;
        none.reserve(most_blocks); // so that nothing throws where memory is freed
        return none;
    }();
    std::size_t bytes_ = 0;
};

/// Never destroyed: buffers may outlive any other static.
KeptBlocks& kept_blocks() {
    static KeptBlocks& blocks = *new KeptBlocks;
    return blocks;
}
void* take_kept(std::size_t size) { return kept_blocks().take(size); }
bool keep(void* memory) { return kept_blocks().keep(memory); }

#else
// Where the address sanitizer watches, freed memory must not be used again.
void* take_kept(std::size_t) { return nullptr; }
bool keep(void*) { return false; }
#endif

} // namespace

void* allocate_lines(std::size_t bytes) {
    const std::size_t alignment = bytes >= 2 * huge_page ? huge_page : line;
    const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
    if (size < bytes)
        throw std::bad_alloc();
    if (alignment == huge_page)
        if (void* const kept = take_kept(size))
            return kept;
    void* memory = std::aligned_alloc(alignment, size);
    if (!memory)
        throw std::bad_alloc();
#if defined(__linux__)
    // Only advice: without it walks through a large tree miss the TLB at every step.
    if (alignment == huge_page)
        madvise(memory, size, MADV_HUGEPAGE);
#endif
    return memory;
}

void free_lines(void* memory) {
    if (!keep(memory))
        std::free(memory);
}

} // namespace boxwood
