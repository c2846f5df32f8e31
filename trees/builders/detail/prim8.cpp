#include "trees/builders/detail/prim8.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <vector>

namespace boxwood::detail {
namespace {

constexpr std::size_t chunk = 1 << 13;

/// The bits of the largest coordinate, sign aside: their order is that of the
/// numbers, and NaN and infinities come last.
std::uint32_t largest_bits(Boxes boxes) {
    std::uint32_t largest = 0;
    for (const Box& box : boxes)
        for (const Vec3<float>& p : {box.min, box.max})
            for (const float x : {p.x, p.y, p.z})
                largest = std::max(largest, std::bit_cast<std::uint32_t>(x) & 0x7fffffff);
    return largest;
}

/// Less than any coordinate of a Prim8.
constexpr float lowest = -0x1p62f;

void add_centre(const Prim8& prim, float (&centres)[8]) {
    for (int axis = 0; axis < 3; ++axis) {
        const float centre = prim.doubled_centre(axis);
        centres[axis] = std::max(centres[axis], centre);
        centres[4 + axis] = std::max(centres[4 + axis], -centre);
    }
}

} // namespace

Prims8::Prims8(Boxes boxes, const Executor& executor) {
    if (boxes.size() > max_items)
        require_valid(boxes);
    const std::size_t n = boxes.size(), chunks = (n + chunk - 1) / chunk;
    const auto part = [&](std::size_t c) {
        return boxes.subspan(c * chunk, std::min(chunk, n - c * chunk));
    };
    prims = Buffer<Prim8>(n);
    std::vector<std::uint32_t> largest(chunks);
    executor.for_each(chunks, [&](std::size_t c) { largest[c] = largest_bits(part(c)); });
    std::uint32_t bits = 0;
    for (const std::uint32_t each : largest)
        bits = std::max(bits, each);
    if (bits >= 0x7f800000)
        require_valid(boxes);
    const auto size = std::bit_cast<float>(bits);
    if (size > 0 && !(size > 0x1p-40f && size < 0x1p40f))
        scale = std::ldexp(1.f, std::clamp(-std::ilogb(size), -126, 126));

    struct alignas(32) Bounds {
        float v[8];
    };
    std::vector<Bounds> bounds(chunks);
    std::atomic<bool> inverted = false;
    executor.for_each(chunks, [&](std::size_t c) {
        float largest_centres[8];
        std::fill_n(largest_centres, 8, lowest);
        bool bad = false;
        std::size_t i = c * chunk;
        for (const Box& box : part(c)) {
            bad |= box.is_empty();
            const Vec3<float> a = box.max * scale, b = box.min * -scale;
            Prim8& p = prims[i];
            p = {{a.x, a.y, a.z, Prim8::lane_of_item(i), b.x, b.y, b.z, 0}};
            ++i;
            add_centre(p, largest_centres);
        }
        if (bad)
            inverted = true;
        std::copy_n(largest_centres, 8, bounds[c].v);
    });
    if (inverted)
        require_valid(boxes);
    std::fill_n(centres, 8, lowest);
    for (const Bounds& each : bounds)
        for (int i = 0; i < 8; ++i)
            centres[i] = std::max(centres[i], each.v[i]);
}

std::size_t halve(std::span<Prim8> prims, const float (&centres)[8]) {
    const float x = centres[0] + centres[4], y = centres[1] + centres[5],
                z = centres[2] + centres[6];
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const auto middle = static_cast<std::ptrdiff_t>(prims.size() / 2);
    std::nth_element(prims.begin(), prims.begin() + middle, prims.end(),
                     [axis](const Prim8& a, const Prim8& b) {
                         const float at = a.doubled_centre(axis), bt = b.doubled_centre(axis);
                         return at < bt || (at == bt && a.item() < b.item());
                     });
    return static_cast<std::size_t>(middle);
}

std::size_t halve(std::span<Prim8> prims) {
    float centres[8];
    std::fill_n(centres, 8, lowest);
    for (const Prim8& prim : prims)
        add_centre(prim, centres);
    return halve(prims, centres);
}

void sort_by_centre(std::span<const Prim8> prims, int axis, std::span<Prim8> sorted) {
    // Upper half: bits in the order of the numbers, negative ones below; lower
    // half: place.
    std::vector<std::uint64_t> keys(prims.size()), other(prims.size());
    constexpr int digit = 11, digits = 3;
    std::array<std::array<std::uint32_t, 1 << digit>, digits> starts{};
    const auto digit_of = [](std::uint64_t key, int d) {
        return static_cast<std::size_t>(key >> (32 + d * digit) & ((1 << digit) - 1));
    };
    for (std::size_t i = 0; i < prims.size(); ++i) {
        // + 0: no negative zero.
        const auto bits = std::bit_cast<std::uint32_t>(prims[i].doubled_centre(axis) + 0.f);
        keys[i] = std::uint64_t{bits >> 31 ? ~bits : bits | 0x80000000} << 32 | i;
        for (int d = 0; d < digits; ++d)
            ++starts[static_cast<std::size_t>(d)][digit_of(keys[i], d)];
    }
    for (int d = 0; d < digits; ++d) {
        auto& start = starts[static_cast<std::size_t>(d)];
        std::exclusive_scan(start.begin(), start.end(), start.begin(), 0u);
        for (const std::uint64_t key : keys)
            other[start[digit_of(key, d)]++] = key;
        keys.swap(other);
    }
    for (std::size_t i = 0; i < prims.size(); ++i)
        sorted[i] = prims[static_cast<std::uint32_t>(keys[i])];
}

} // namespace boxwood::detail
