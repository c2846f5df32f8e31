#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::detail {

/// The numbers of items that changed since some time, each once, or that so many did that nobody
/// lists them.
class ChangedItems {
  public:
    /// Of n items in all.
    void add(std::uint32_t item, std::size_t n) {
        if (are_many_)
            return;
        if (item >= marks_.size())
            marks_.resize(n);
        if (marks_[item])
            return;
        marks_[item] = 1;
        items_.push_back(item);
        are_many_ = items_.size() > n / 16 + 16;
    }
    void add_all() { are_many_ = true; }
    void clear() {
        for (const std::uint32_t item : items_)
            marks_[item] = 0;
        items_.clear();
        are_many_ = false;
    }

    bool are_many() const { return are_many_; }
    bool empty() const { return !are_many_ && items_.empty(); }
    /// By item, of n in all: 1 for those listed, else 0.
    const std::uint8_t* marks(std::size_t n) {
        marks_.resize(std::max(n, marks_.size()));
        return marks_.data();
    }
    /// Those listed: all of them unless they are many.
    std::span<const std::uint32_t> items() const { return items_; }

  private:
    bool are_many_ = false;
    std::vector<std::uint32_t> items_;
    std::vector<std::uint8_t> marks_; ///< by item
};

} // namespace boxwood::detail
