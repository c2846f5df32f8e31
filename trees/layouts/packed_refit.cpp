#include "trees/layouts/packed.h"

namespace boxwood {
namespace {

constexpr std::size_t width = PackedLayout::width;

/// Unused lanes are the empty box, which adds nothing. In loops over lanes without branches.
Box bounds_of(const PackedBlock& block) {
    float plane[6];
    for (int axis = 0; axis < 3; ++axis) {
        float low = block.plane[axis][0], high = block.plane[3 + axis][0];
        for (std::size_t lane = 1; lane < width; ++lane) {
            const float l = block.plane[axis][lane], h = block.plane[3 + axis][lane];
            low = l < low ? l : low;
            high = h > high ? h : high;
        }
        plane[axis] = low;
        plane[3 + axis] = high;
    }
    return {{plane[0], plane[1], plane[2]}, {plane[3], plane[4], plane[5]}};
}

void set_lane(PackedBlock& block, std::size_t lane, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        block.plane[axis][lane] = box.min[axis];
        block.plane[3 + axis][lane] = box.max[axis];
    }
}

} // namespace

void PackedLayout::refit(Boxes boxes, std::span<const std::uint32_t> slots) {
    for (const std::uint32_t slot : slots) {
        Box box = boxes[items_[slot]];
        std::size_t at = slot;
        for (std::size_t l = 0;; ++l, at /= width) {
            if (l == depth_) {
                bounds_ = box;
                break;
            }
            PackedBlock& block = blocks_[first_[l] + at / width];
            const std::size_t lane = at % width;
            if (block.lane(lane) == box)
                break;
            set_lane(block, lane, box);
            box = bounds_of(block);
        }
    }
}

double PackedLayout::surface() const {
    const double root = bounds_.half_area();
    double sum = 0;
    for (std::size_t l = 1; l < depth_; ++l)
        for (const PackedBlock& block : level(l)) {
            float areas[width]; // of the extents as floats: a measure, not a bound
            for (std::size_t lane = 0; lane < width; ++lane) {
                const float x = block.plane[3][lane] - block.plane[0][lane],
                            y = block.plane[4][lane] - block.plane[1][lane],
                            z = block.plane[5][lane] - block.plane[2][lane];
                areas[lane] = x * y + y * z + z * x;
            }
            for (std::size_t lane = 0; lane < width; ++lane)
                sum += block.plane[0][lane] <= block.plane[3][lane]
                           ? static_cast<double>(areas[lane])
                           : 0;
        }
    return root > 0 && sum <= root * 1e30 ? sum / root : 0;
}

std::string PackedLayout::fault() const {
    for (std::size_t l = 0; l < depth_; ++l) {
        const std::size_t lanes = l == 0 ? size_ : level(l - 1).size();
        for (std::size_t b = 0; b < level(l).size(); ++b) {
            const PackedBlock& block = level(l)[b];
            Box bounds;
            for (std::size_t lane = 0; lane < width; ++lane) {
                const bool used = b * width + lane < lanes;
                const Box& box = block.lane(lane);
                if (!(box == Box{}) && (!used || !box.is_valid())) // an item may be absent
                    return "level " + std::to_string(l) + ", block " + std::to_string(b) +
                           ": lane " + std::to_string(lane) + (used ? " is no box" : " is in use");
                bounds.extend(block.lane(lane));
            }
            const Box& noted = l + 1 == depth_ ? bounds_ : level(l + 1)[b / width].lane(b % width);
            if (!(noted == bounds))
                return "level " + std::to_string(l) + ", block " + std::to_string(b) +
                       ": the bounds above are not those of its lanes";
        }
    }
    return "";
}

} // namespace boxwood
