#include "scenes/motions.h"

#include "scenes/random.h"
#include "scenes/suggest.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace boxwood {
namespace {

using Boxes = std::span<const Aabb<float>>;

Vec3<double> centre(const Aabb<float>& box) {
    return .5 * (static_cast<Vec3<double>>(box.min) + static_cast<Vec3<double>>(box.max));
}

Aabb<double> centres_of(Boxes boxes) {
    Aabb<double> bounds;
    for (const Aabb<float>& box : boxes)
        bounds.extend(centre(box));
    return bounds;
}

/// The mean of all sides of all boxes: what a small step is measured by.
double mean_side(Boxes boxes) {
    double sum = 0;
    for (const Aabb<float>& box : boxes) {
        const auto side = static_cast<Vec3<double>>(box.max) - static_cast<Vec3<double>>(box.min);
        sum += side.x + side.y + side.z;
    }
    return boxes.empty() ? 0 : sum / (3 * static_cast<double>(boxes.size()));
}

/// The box as it was in frame 0, its centre moved by d. Rounding keeps min <= max.
Aabb<float> moved_by(const Aabb<float>& box, Vec3<double> d) {
    return {static_cast<Vec3<float>>(static_cast<Vec3<double>>(box.min) + d),
            static_cast<Vec3<float>>(static_cast<Vec3<double>>(box.max) + d)};
}

/// Gives an item its box in the new frame and lists it if the box is another.
void place(Frame& frame, std::uint32_t item, const Aabb<float>& box) {
    if (box == frame.boxes[item])
        return;
    frame.boxes[item] = box;
    frame.moved.push_back(item);
}

/// Each of the items goes straight on at a speed of its own, a tenth of the mean side of a box per
/// frame at most, and bounces off the bounds of all centres.
std::vector<Frame> drift(std::string_view stream, Boxes boxes,
                         const std::vector<std::uint32_t>& items, std::size_t n_frames,
                         std::uint64_t seed) {
    const Random random(seed, stream);
    const Aabb<double> bounds = centres_of(boxes);
    const double fastest = .1 * mean_side(boxes);
    std::vector<Vec3<double>> at(items.size()), step(items.size());
    for (std::size_t k = 0; k < items.size(); ++k) {
        Draws draws = random.item(items[k]);
        const Vec3<double> direction = draws.unit_vector();
        step[k] = fastest * draws.uniform() * direction;
        at[k] = centre(boxes[items[k]]);
    }
    std::vector<Frame> frames;
    Frame frame{{boxes.begin(), boxes.end()}, {}};
    for (std::size_t f = 0; f < n_frames; ++f) {
        frame.moved.clear();
        for (std::size_t k = 0; k < items.size(); ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                double x = at[k][axis] + step[k][axis];
                if (x < bounds.min[axis] || x > bounds.max[axis]) {
                    step[k][axis] = -step[k][axis];
                    x = std::clamp(at[k][axis] + step[k][axis], bounds.min[axis], bounds.max[axis]);
                }
                at[k][axis] = x;
            }
            const Aabb<float>& first = boxes[items[k]];
            place(frame, items[k], moved_by(first, at[k] - centre(first)));
        }
        frames.push_back(frame);
    }
    return frames;
}

std::vector<Frame> all_drift(Boxes boxes, std::size_t n_frames, std::uint64_t seed) {
    std::vector<std::uint32_t> all(boxes.size());
    std::iota(all.begin(), all.end(), 0u);
    return drift("all_drift", boxes, all, n_frames, seed);
}

/// The same items throughout: those with the lowest of one number drawn for each.
std::vector<Frame> one_percent(Boxes boxes, std::size_t n_frames, std::uint64_t seed) {
    const Random random(seed, "one_percent.items");
    std::vector<std::pair<double, std::uint32_t>> drawn(boxes.size());
    for (std::uint32_t i = 0; i < drawn.size(); ++i)
        drawn[i] = {random.item(i).uniform(), i};
    const std::size_t wanted = (boxes.size() + 99) / 100;
    std::nth_element(drawn.begin(), drawn.begin() + static_cast<std::ptrdiff_t>(wanted),
                     drawn.end());
    std::vector<std::uint32_t> items(wanted);
    for (std::size_t k = 0; k < wanted; ++k)
        items[k] = drawn[k].second;
    std::ranges::sort(items);
    return drift("one_percent", boxes, items, n_frames, seed);
}

/// In each frame every tenth item, by lot, jumps to anywhere within the bounds of all centres.
std::vector<Frame> teleport(Boxes boxes, std::size_t n_frames, std::uint64_t seed) {
    const Random random(seed, "teleport");
    const Aabb<double> bounds = centres_of(boxes);
    std::vector<Frame> frames;
    Frame frame{{boxes.begin(), boxes.end()}, {}};
    for (std::size_t f = 0; f < n_frames; ++f) {
        frame.moved.clear();
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            Draws draws = random.item(std::uint64_t{f} << 32 | i);
            if (draws.uniform() >= .1)
                continue;
            const Vec3<double> u = draws.in_cube();
            const Vec3<double> extent = bounds.max - bounds.min;
            const Vec3<double> to{bounds.min.x + u.x * extent.x, bounds.min.y + u.y * extent.y,
                                  bounds.min.z + u.z * extent.z};
            place(frame, i, moved_by(boxes[i], to - centre(boxes[i])));
        }
        frames.push_back(frame);
    }
    return frames;
}

/// To add a motion: a function as those above and its line here.
struct Motion {
    MotionEntry entry;
    std::vector<Frame> (*frames)(Boxes, std::size_t, std::uint64_t);
};
constexpr std::array known{
    Motion{{"all_drift", "every box goes straight on by up to a tenth of a box, and bounces"},
           all_drift},
    Motion{{"one_percent", "the same 1 % of the boxes drift, the others rest"}, one_percent},
    Motion{{"teleport", "10 % of the boxes, others in each frame, jump to anywhere"}, teleport},
};

const Motion& motion_of(std::string_view word) {
    const auto found =
        std::ranges::find_if(known, [&](const Motion& m) { return m.entry.name == word; });
    if (found != known.end())
        return *found;
    std::vector<std::string_view> names;
    for (const Motion& m : known)
        names.push_back(m.entry.name);
    throw std::invalid_argument(unknown_word("motion", word, names));
}

} // namespace

std::span<const MotionEntry> motions() {
    static const std::array entries = [] {
        std::array<MotionEntry, known.size()> all{};
        std::ranges::transform(known, all.begin(), &Motion::entry);
        return all;
    }();
    return entries;
}

void check_motion(std::string_view motion) { motion_of(motion); }

std::vector<Frame> make_frames(std::string_view motion, std::span<const Aabb<float>> boxes,
                               std::size_t n_frames, std::uint64_t seed) {
    return motion_of(motion).frames(boxes, n_frames, seed);
}

} // namespace boxwood
