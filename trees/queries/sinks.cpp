#include "trees/queries/sinks.h"

#include <utility>

namespace boxwood {

void AppendPairs::begin(std::size_t chunks, bool in_order) {
    in_order_ = in_order;
    first_ = 0;
    parts_.clear();
    if (!in_order)
        parts_.resize(chunks, {{}, false});
}

bool AppendPairs::take(std::size_t chunk, std::span<const Pair> pairs) {
    if (in_order_ || first_.load(std::memory_order_acquire) == chunk) {
        if (!in_order_ && !parts_[chunk].pairs.empty()) // it came first only now
            append(chunk);
        out_.insert(out_.end(), pairs.begin(), pairs.end());
        return true;
    }
    std::vector<Pair>& part = parts_[chunk].pairs;
    if (part.capacity() == 0) {
        const std::lock_guard lock(moving_);
        if (!spare_.empty()) {
            part = std::move(spare_.back());
            spare_.pop_back();
        }
    }
    part.insert(part.end(), pairs.begin(), pairs.end());
    return true;
}

/// Moves a part to the end of out_.
void AppendPairs::append(std::size_t chunk) {
    std::vector<Pair>& part = parts_[chunk].pairs;
    out_.insert(out_.end(), part.begin(), part.end());
    part.clear();
}

void AppendPairs::finish(std::size_t chunk) {
    if (in_order_)
        return;
    const std::lock_guard lock(moving_);
    parts_[chunk].finished = true;
    std::size_t first = first_.load(std::memory_order_relaxed);
    if (chunk != first)
        return;
    for (; first < parts_.size() && parts_[first].finished; ++first) {
        append(first);
        if (parts_[first].pairs.capacity() != 0)
            spare_.push_back(std::move(parts_[first].pairs));
    }
    first_.store(first, std::memory_order_release);
}

void AppendPairs::end() {
    for (std::size_t chunk = first_; chunk < parts_.size(); ++chunk) {
        append(chunk);
        if (parts_[chunk].pairs.capacity() != 0)
            spare_.push_back(std::move(parts_[chunk].pairs));
    }
    parts_.clear();
}

} // namespace boxwood
