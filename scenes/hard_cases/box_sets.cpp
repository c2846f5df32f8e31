#include "scenes/hard_cases/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace boxwood {
namespace {

/// Sets with integer corners below 2^14. Boxes of a lattice are numbered row by row, and a box's
/// earlier neighbours are counted as it is added: those pairs are all there are.
constexpr int scale_max = 127 - 14;

constexpr std::string_view order_meaning =
    "order of the boxes: 0 as built (sorted), 1 reversed, 2 Morton, 3 shuffled";

/// The bits of three 14-bit numbers interleaved: x 0, y 1, z 2 modulo 3.
std::uint64_t morton_code(Vec3<float> corner) {
    std::uint64_t code = 0;
    for (int bit = 0; bit < 15; ++bit)
        for (int axis = 0; axis < 3; ++axis) {
            const auto number = static_cast<std::uint64_t>(corner[axis] + 0x1p13f);
            code |= (number >> bit & 1) << (3 * bit + axis);
        }
    return code;
}

void put_in_order(std::vector<Aabb<float>>& boxes, int order, const Random& random) {
    if (order == 1)
        std::ranges::reverse(boxes);
    if (order == 2)
        std::ranges::stable_sort(boxes, {}, [](const auto& box) { return morton_code(box.min); });
    if (order == 3)
        for (std::size_t i = boxes.size(); i > 1; --i) {
            Draws draws = random.item(i);
            std::swap(boxes[i - 1], boxes[static_cast<std::size_t>(
                                        draw_integer(draws, 0, static_cast<std::int64_t>(i) - 1))]);
        }
}

Cases finished(BoxCases cases, const HardCaseSpec& spec, int order, const Random& random) {
    put_in_order(cases.boxes, order, random);
    for (Aabb<float>& box : cases.boxes)
        for (Vec3<float>* p : {&box.min, &box.max})
            for (int axis = 0; axis < 3; ++axis)
                (*p)[axis] = std::ldexp((*p)[axis], spec.scale);
    return cases;
}

std::uint64_t all_pairs(std::size_t n) {
    return n < 2 ? 0 : std::uint64_t{n} * (std::uint64_t{n} - 1) / 2;
}

/// The least s with s^3 >= n.
std::int64_t cube_side(std::size_t n) {
    std::size_t s = 1;
    while (s * s * s < n)
        ++s;
    return static_cast<std::int64_t>(s);
}

Aabb<float> box_at(LatticePoint low, LatticePoint high) {
    return {Vec3<float>(low), Vec3<float>(high)};
}

/// Unit cubes side by side: each touches up to 26 others.
Cases touching_grid(const HardCaseSpec& spec, const Random& random) {
    const std::int64_t side = cube_side(spec.n);
    BoxCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        const auto number = static_cast<std::int64_t>(i);
        const LatticePoint p{number % side, number / side % side, number / (side * side)};
        cases.boxes.push_back(box_at(p, p + LatticePoint{1, 1, 1}));
        for (int neighbour = 0; neighbour < 13; ++neighbour) { // the 13 of 27 that come earlier
            const LatticePoint q =
                p + LatticePoint{neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1};
            cases.n_pairs += q.x >= 0 && q.x < side && q.y >= 0 && q.y < side && q.z >= 0;
        }
    }
    return finished(std::move(cases), spec, *spec.k, random);
}

/// Squares, segments and points: layer z of a lattice holds one kind, and fills [2 z, 2 z + 1] at
/// most, so that only neighbours of a layer touch.
Cases flat(const HardCaseSpec& spec, const Random& random) {
    constexpr LatticePoint shapes[7] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 0, 0},
                                        {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    const std::int64_t side = cube_side(spec.n);
    BoxCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        const auto number = static_cast<std::int64_t>(i);
        const LatticePoint p{number % side, number / side % side, 2 * (number / (side * side))};
        const LatticePoint shape = shapes[p.z / 2 % 7];
        cases.boxes.push_back(box_at(p, p + shape));
        const bool left = shape.x && p.x > 0, above = shape.y && p.y > 0;
        cases.n_pairs += left;
        cases.n_pairs += above;
        cases.n_pairs += left && above;
        cases.n_pairs += above && shape.x && p.x + 1 < side;
    }
    return finished(std::move(cases), spec, *spec.k, random);
}

/// Around the origin with half sides i (1, 1, 1), i = 0, 1, ...: all pairs.
Cases nested(const HardCaseSpec& spec, const Random& random) {
    if (spec.n > 1 << 13)
        throw std::invalid_argument(
            fmt::format("family nested_boxes: n = {} is more than 8192; n (n - 1) / 2 pairs "
                        "overlap",
                        spec.n));
    BoxCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        const auto half = static_cast<std::int64_t>(i);
        cases.boxes.push_back(box_at({-half, -half, -half}, {half, half, half}));
    }
    cases.n_pairs = all_pairs(spec.n);
    return finished(std::move(cases), spec, *spec.k, random);
}

Cases all_identical(const HardCaseSpec& spec, const Random& random) {
    const std::size_t n = std::size_t{1} << *spec.k;
    BoxCases cases{std::vector<Aabb<float>>(n, Aabb<float>{{-1, -2, -3}, {1, 2, 3}}), all_pairs(n)};
    return finished(std::move(cases), spec, 0, random);
}

HardCaseFamily box_family(std::string_view name, std::string_view summary,
                          decltype(HardCaseFamily::generate) generate) {
    return {.name = name,
            .summary = summary,
            .panel = Panel::degenerate,
            .k_meaning = order_meaning,
            .k_default = 0,
            .k_min = 0,
            .k_max = 3,
            .scale_min = -149,
            .scale_max = scale_max,
            .generate = generate};
}

} // namespace

HardCaseFamily touching_grid_family() {
    return box_family("touching_grid", "unit cubes side by side; those that touch count as pairs",
                      touching_grid);
}

HardCaseFamily flat_boxes_family() {
    return box_family("flat_boxes", "squares, segments and points of a lattice, touching", flat);
}

HardCaseFamily nested_boxes_family() {
    return box_family("nested_boxes", "concentric boxes, n (n - 1) / 2 pairs; n is at most 8192",
                      nested);
}

HardCaseFamily identical_boxes_family() {
    HardCaseFamily row =
        box_family("identical_boxes", "2^k times the same box, all pairs overlap (n is not used)",
                   all_identical);
    row.k_meaning = "2^k boxes";
    row.k_default = 8;
    row.k_max = 13;
    return row;
}

} // namespace boxwood
