#pragma once

#include "trees/adapters/recording.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace boxwood::detail {

/// What a geometry is made of, as recordings hold it.
struct RecordedGeometry {
    recording::Shape shape = recording::Shape::other;
    std::array<double, 4> numbers{};
    std::vector<std::array<double, 3>> vertices, triangles; ///< triangles: rows of vertices

    void take(recording::Shape as, const std::array<double, 4>& its_numbers) {
        shape = as;
        numbers = its_numbers;
    }
    /// A plane or a half-space.
    template <class Of> void take_flat(recording::Shape as, const Of& of) {
        take(as, {of.n[0], of.n[1], of.n[2], of.d});
    }
    template <class Point> void add_vertex(const Point& p) {
        vertices.push_back({p[0], p[1], p[2]});
    }
    template <class Corners> void add_triangle(const Corners& c) {
        triangles.push_back(
            {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])});
    }
    std::uint64_t hash() const {
        std::uint64_t all = 0xcbf29ce484222325; // FNV-1a, of numbers
        const auto add = [&](double number) {
            all = (all ^ std::bit_cast<std::uint64_t>(number + 0.)) * 0x100000001b3; // 0, not -0
            all ^= all >> 32;
        };
        add(static_cast<double>(shape));
        for (const double number : numbers)
            add(number);
        for (const auto* rows : {&vertices, &triangles})
            for (const auto& row : *rows)
                for (const double number : row)
                    add(number);
        return all;
    }
};

} // namespace boxwood::detail
