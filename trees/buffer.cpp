#include "trees/buffer.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace boxwood {
namespace {

constexpr std::size_t line = 64, huge_page = std::size_t{1} << 21;

/// From this size on malloc gives freed memory back to the system each time, and to have it cleared
/// again, page by page in the middle of a build, takes as long as to fill it.
constexpr std::size_t given_back = std::size_t{24} << 20;

/// Stands just before the memory that is handed out.
struct Header {
    void* whole; ///< what malloc gave
    std::size_t bytes;
};
Header header_of(void* memory) {
    Header header;
    std::memcpy(&header, static_cast<char*>(memory) - sizeof(Header), sizeof(Header));
    return header;
}

/// Large blocks that were freed, for the next that ask. The system may take their pages back at any
/// time (MADV_FREE).
class KeptBlocks {
  public:
    KeptBlocks() { blocks_.reserve(max_blocks); } // so that to keep one never throws

    /// One of at least this size and not much larger, or nullptr.
    void* take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = blocks_.size(); i-- > 0;) {
            void* const memory = blocks_[i];
            const std::size_t size = header_of(memory).bytes;
            if (size >= bytes && size <= bytes + bytes / 4) {
                forget(i);
                return memory;
            }
        }
        return nullptr;
    }

    /// False if the block is to be freed.
    bool keep(void* memory) {
        const std::size_t bytes = header_of(memory).bytes;
        if (bytes > max_bytes)
            return false;
#if defined(__linux__)
        madvise(memory, bytes / huge_page * huge_page, MADV_FREE);
#endif
        const std::lock_guard lock(mutex_);
        while (blocks_.size() == max_blocks || bytes_ + bytes > max_bytes) {
            void* const oldest = header_of(blocks_.front()).whole;
            forget(0);
            std::free(oldest);
        }
        blocks_.push_back(memory);
        bytes_ += bytes;
        return true;
    }

  private:
    static constexpr std::size_t max_blocks = 16, max_bytes = std::size_t{1} << 28;

    void forget(std::size_t i) {
        bytes_ -= header_of(blocks_[i]).bytes;
        blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(i));
    }

    std::mutex mutex_;
    std::vector<void*> blocks_;
    std::size_t bytes_ = 0;
};

/// Never destroyed: buffers may outlive any other static.
KeptBlocks& kept_blocks() {
    static KeptBlocks& blocks = *new KeptBlocks;
    return blocks;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps = false; // where freed memory is watched it must not be used again
#else
constexpr bool keeps = true;
#endif

} // namespace

/// Aligned by hand: of what std::aligned_alloc hands out glibc gives all large blocks back to the
/// system each time, not just those from `given_back` on.
void* allocate_lines(std::size_t bytes) {
    if (keeps && bytes >= given_back)
        if (void* const kept = kept_blocks().take(bytes))
            return kept;
    const std::size_t alignment = bytes >= 2 * huge_page ? huge_page : line;
    const std::size_t size = bytes + sizeof(Header) + alignment - 1;
    void* const whole = size < bytes ? nullptr : std::malloc(size);
    if (!whole)
        throw std::bad_alloc();
    char* const earliest = static_cast<char*>(whole) + sizeof(Header);
    char* const memory =
        earliest + (alignment - reinterpret_cast<std::uintptr_t>(earliest) % alignment) % alignment;
    const Header header{whole, bytes};
    std::memcpy(memory - sizeof(Header), &header, sizeof(Header));
#if defined(__linux__)
    // Only advice: without it traversals of a large tree miss the TLB at every step.
    if (alignment == huge_page)
        madvise(memory, bytes / huge_page * huge_page, MADV_HUGEPAGE);
#endif
    return memory;
}

void free_lines(void* memory) {
    if (!memory)
        return;
    const Header header = header_of(memory);
    if (!(keeps && header.bytes >= given_back && kept_blocks().keep(memory)))
        std::free(header.whole);
}

} // namespace boxwood
