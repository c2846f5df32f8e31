#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/peers/brute_force.cpp"
#include <hwy/foreach_target.h> // compiles this file once per instruction set

#include "bench/peers/answering.h"
#include "bench/peers/brute_force.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace boxwood::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// `bounds` are six arrays, `stride` apart, readable for a whole vector past `end`.
void append_row(const float* bounds, std::size_t stride, std::size_t row, std::size_t begin,
                std::size_t end, std::vector<Pair>& out) {
    const hn::ScalableTag<float> d;
    const std::size_t lanes = hn::Lanes(d);
    const float* const min_x = bounds;
    const float* const min_y = bounds + stride;
    const float* const min_z = bounds + 2 * stride;
    const float* const max_x = bounds + 3 * stride;
    const float* const max_y = bounds + 4 * stride;
    const float* const max_z = bounds + 5 * stride;
    const auto row_min_x = hn::Set(d, min_x[row]), row_max_x = hn::Set(d, max_x[row]);
    const auto row_min_y = hn::Set(d, min_y[row]), row_max_y = hn::Set(d, max_y[row]);
    const auto row_min_z = hn::Set(d, min_z[row]), row_max_z = hn::Set(d, max_z[row]);
    for (std::size_t j = begin; j < end; j += lanes) {
        const auto x = hn::And(hn::Le(hn::LoadU(d, min_x + j), row_max_x),
                               hn::Le(row_min_x, hn::LoadU(d, max_x + j)));
        const auto y = hn::And(hn::Le(hn::LoadU(d, min_y + j), row_max_y),
                               hn::Le(row_min_y, hn::LoadU(d, max_y + j)));
        const auto z = hn::And(hn::Le(hn::LoadU(d, min_z + j), row_max_z),
                               hn::Le(row_min_z, hn::LoadU(d, max_z + j)));
        const auto overlap = hn::And(hn::And(x, y), z);
        if (HWY_LIKELY(hn::AllFalse(d, overlap)))
            continue;
        HWY_ALIGN std::uint8_t bits[HWY_MAX_BYTES / sizeof(float) / 8 + 8];
        hn::StoreMaskBits(d, overlap, bits);
        const std::size_t in_range = std::min(lanes, end - j);
        for (std::size_t k = 0; k < in_range; ++k)
            if (bits[k / 8] >> (k % 8) & 1)
                out.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(j + k)});
    }
}

} // namespace boxwood::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::bench {

HWY_EXPORT(append_row);

/// Floats that a vector may reach past the last box: 2048 bits, the most that Highway drives.
/// (HWY_MAX_BYTES is that of the target compiled last, not of the one that runs.)
constexpr std::size_t longest_vector = 64;

BruteForce::BruteForce(std::span<const Aabb<float>> boxes)
    : size_(boxes.size()), stride_(boxes.size() + longest_vector) {
    bounds_.resize(6 * stride_);
    for (std::size_t i = 0; i < size_; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds_[axis * stride_ + i] = boxes[i].min[static_cast<int>(axis)];
            bounds_[(3 + axis) * stride_ + i] = boxes[i].max[static_cast<int>(axis)];
        }
}

void BruteForce::append_row(std::size_t row, std::size_t begin, std::size_t end,
                            std::vector<Pair>& out) const {
    HWY_DYNAMIC_DISPATCH(append_row)(bounds_.data(), stride_, row, begin, end, out);
}

void BruteForce::append_columns(std::size_t begin, std::size_t end, std::size_t row_end,
                                std::vector<Pair>& out) const {
    const auto row_kernel = HWY_DYNAMIC_DISPATCH(append_row);
    for (std::size_t first = begin; first < end; first += tile) {
        const std::size_t last = std::min(end, first + tile);
        for (std::size_t row = 0; row < std::min(last, row_end); ++row)
            row_kernel(bounds_.data(), stride_, row, std::max(first, row + 1), last, out);
    }
}

namespace {

class BruteForceContender final : public Contender {
  public:
    BruteForceContender(const Job& job, Sides sides)
        : scene_(*job.scene), between_halves_(sides == Sides::two_halves) {}

    void build() override { boxes_.emplace(scene_.boxes); }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        const std::size_t n = boxes_->size();
        const std::size_t split = tree_pairs_split(n);
        if (between_halves_)
            boxes_->append_columns(split, n, split, pairs);
        else
            boxes_->append_columns(0, n, n, pairs);
    }

    std::optional<Work> counted_query(Answers& answers) override {
        query(answers);
        const std::uint64_t n = boxes_->size(), split = tree_pairs_split(n);
        Work work;
        work.box_tests = between_halves_ ? split * (n - split) : n * (n - 1) / 2;
        work.answers = answers.size();
        return work;
    }

  private:
    const Scene& scene_;
    bool between_halves_;
    std::optional<BruteForce> boxes_;
};

} // namespace

Peer brute_force_peer() {
    ContenderEntry entry;
    entry.name = entry.library = "brute_force";
    entry.summary = "every box against every other, SIMD over six arrays of floats";
    entry.notes = "no structure: build only turns the boxes into arrays; columns in tiles of 1024 "
                  "that stay in the first-level cache; one thread";
    entry.precision = "f32";
    entry.keeps_structure = false;
    entry.runs_on = RunsOn::one_thread;
    entry.answers = answering_pairs<BruteForceContender>();

    Peer peer;
    peer.name = "brute_force";
    peer.title = "brute force";
    peer.summary = "all pairs with SIMD, the oracle of pairs";
    peer.version = fmt::format("Highway {}.{}.{}", HWY_MAJOR, HWY_MINOR, HWY_PATCH);
    peer.build = "ours: instruction set chosen at run time";
    peer.contenders.push_back(std::move(entry));
    return peer;
}

} // namespace boxwood::bench
#endif
