#include "scenes/hard_cases/lattice.h"

namespace boxwood {
namespace {

constexpr int steepness = 3;

LatticeMap product(const LatticeMap& a, const LatticeMap& b) {
    LatticeMap result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            result.rows[i] = result.rows[i] + a.rows[i][k] * b.rows[static_cast<std::size_t>(k)];
    return result;
}

LatticeMap draw_signed_permutation(Draws& draws) {
    LatticeMap map{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    shuffle(map.rows, draws);
    for (LatticePoint& row : map.rows)
        if (draw_coin(draws))
            row = -row;
    return map;
}

/// Integer coordinates that `lattice_pairs` and `lattice_motions` make: |x| < 2^(k + 9), as
/// (4 + 2 + 2) 2^k grows by at most 3 s^2 + 2 s + 1 = 34 < 2^6. They are multiples of 2^(scale -
/// k).
/// From about k = 18 a determinant of differences is rounded in double, and at 30 nearly always.
constexpr int growth_bits = 9, k_min = 6, k_max = 53 - growth_bits, k_default = 30;
static_assert(24 - growth_bits == 15, "see k_meaning");

LatticePoint draw_shift(Draws& draws, std::int64_t size) {
    return draw_point(draws, {-2 * size, -2 * size, -2 * size}, {2 * size, 2 * size, 2 * size});
}

} // namespace

std::int64_t draw_integer(Draws& draws, std::int64_t low, std::int64_t high) {
    const std::uint64_t upper = draws.word();
    const std::uint64_t bits = upper << 32 | draws.word();
    return low + static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(high - low + 1));
}

LatticePoint draw_point(Draws& draws, LatticePoint low, LatticePoint high) {
    LatticePoint p;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = draw_integer(draws, low[axis], high[axis]);
    return p;
}

LatticeMap draw_tilt(Draws& draws, int max_tilt) {
    const auto entry = [&] { return draw_integer(draws, -max_tilt, max_tilt); };
    LatticeMap lower{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}, upper = lower;
    lower.rows[1].x = entry();
    lower.rows[2].x = entry();
    lower.rows[2].y = entry();
    upper.rows[0].y = entry();
    upper.rows[0].z = entry();
    upper.rows[1].z = entry();
    const LatticeMap first = draw_signed_permutation(draws), last = draw_signed_permutation(draws);
    return product(first, product(product(lower, upper), last));
}

LatticeTriangle draw_around_origin(Draws& draws, std::int64_t size) {
    const std::int64_t quarter = size / 4;
    const LatticePoint a = draw_point(draws, {1, 0, 0}, {quarter, quarter, 0});
    const LatticePoint b = draw_point(draws, {-quarter, 1, 0}, {0, quarter, 0});
    const std::int64_t i = draw_integer(draws, 1, 2), j = draw_integer(draws, 1, 2);
    return {a, b, -(i * a + j * b)}; // a x b > 0, and the origin is (i a + j b + c) / (i + j + 1)
}

LatticeTriangle draw_hanging(Draws& draws, std::int64_t size) {
    const LatticePoint b = draw_point(draws, {-size, -size, 0}, {-1, -1, 0});
    const LatticePoint c = draw_point(draws, {0, -size, 0}, {size, -1, 0});
    return {LatticePoint{}, b, c}; // b x c > 0
}

LatticeTriangle draw_below_edge(Draws& draws, std::int64_t left, std::int64_t right,
                                std::int64_t size) {
    return {LatticePoint{left, 0, 0}, LatticePoint{right, 0, 0},
            draw_point(draws, {-size, -size, 0}, {size, -1, 0})};
}

LatticeTriangle mirrored(LatticeTriangle t) {
    for (LatticePoint& p : t)
        p.y = -p.y;
    return t;
}

Cases lattice_pairs(const HardCaseSpec& spec, const Random& random, DrawLatticePair draw) {
    const int k = *spec.k, exponent = spec.scale - k;
    const std::int64_t size = std::int64_t{1} << k;
    std::vector<TrianglePairCase> cases(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        LatticePair pair = draw(draws, size);
        const LatticeMap tilt = draw_tilt(draws, steepness);
        const LatticePoint shift = draw_shift(draws, size);
        const auto placed = [&](LatticeTriangle t) {
            shuffle(t, draws);
            const auto at = [&](std::size_t corner) {
                return to_scene(tilt(t[corner] + shift), exponent);
            };
            return Triangle<double>{at(0), at(1), at(2)};
        };
        if (draw_coin(draws))
            std::swap(pair.a, pair.b);
        cases[i].a = placed(pair.a);
        cases[i].b = placed(pair.b);
        cases[i].touch = pair.touch;
    }
    return cases;
}

Cases lattice_motions(const HardCaseSpec& spec, const Random& random, MotionKind kind,
                      DrawLatticeMotion draw) {
    const int k = *spec.k, exponent = spec.scale - k;
    const std::int64_t size = std::int64_t{1} << k;
    MotionCases cases{kind, std::vector<MotionCase>(spec.n)};
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        LatticeMotion motion = draw(draws, size);
        const LatticeMap tilt = draw_tilt(draws, steepness);
        if (draw_coin(draws))
            std::swap(motion.start, motion.end);
        const LatticePoint start_shift = draw_shift(draws, size);
        const LatticePoint end_shift = draw_shift(draws, size);

        std::array<std::size_t, 4> order{0, 1, 2, 3};
        if (kind == MotionKind::vertex_face) {
            std::array<std::size_t, 3> corners{1, 2, 3};
            shuffle(corners, draws);
            order = {0, corners[0], corners[1], corners[2]};
        } else {
            if (draw_coin(draws))
                std::swap(order[0], order[1]);
            if (draw_coin(draws))
                std::swap(order[2], order[3]);
            if (draw_coin(draws))
                order = {order[2], order[3], order[0], order[1]};
        }
        for (std::size_t p = 0; p < 4; ++p) {
            LinearMotion& placed = cases.motions[i].motion;
            placed.start[p] = to_scene(tilt(motion.start[order[p]] + start_shift), exponent);
            placed.end[p] = to_scene(tilt(motion.end[order[p]] + end_shift), exponent);
        }
        cases.motions[i].touch = motion.touch;
    }
    return cases;
}

HardCaseFamily lattice_family(std::string_view name, std::string_view summary, Panel panel,
                              decltype(HardCaseFamily::generate) generate) {
    return {.name = name,
            .summary = summary,
            .panel = panel,
            .k_meaning = "the least gap is 2^-k of the size; exact in floats up to k = 15",
            .k_default = k_default,
            .k_min = k_min,
            .k_max = k_max,
            .scale_min = -1074 + k_max,
            .scale_max = 1023 - growth_bits,
            .generate = generate};
}

} // namespace boxwood
