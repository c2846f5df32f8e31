#include "trees/pairs.h"

namespace boxwood {

void AppendPairs::begin(std::size_t chunks, bool in_order) {
    used_ = in_order ? 0 : chunks;
    if (parts_.size() < used_)
        parts_.resize(used_);
    for (std::size_t i = 0; i < used_; ++i)
        parts_[i].clear();
}

bool AppendPairs::take(std::size_t chunk, std::span<const Pair> pairs) {
    std::vector<Pair>& to = used_ ? parts_[chunk] : out_;
    to.insert(to.end(), pairs.begin(), pairs.end());
    return true;
}

void AppendPairs::end() {
    std::size_t total = out_.size();
    for (std::size_t i = 0; i < used_; ++i)
        total += parts_[i].size();
    out_.reserve(total);
    for (std::size_t i = 0; i < used_; ++i)
        out_.insert(out_.end(), parts_[i].begin(), parts_[i].end());
}

} // namespace boxwood
