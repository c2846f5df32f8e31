#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

namespace boxwood {
namespace {

/// Any motion between integers of at most k: small enough that the roots of the coplanarity cubic
/// are rational, double, irrational, at the ends or everywhere, each often.
template <MotionKind kind> Cases small_integers(const HardCaseSpec& spec, const Random& random) {
    MotionCases cases{kind, std::vector<MotionCase>(spec.n)};
    const std::int64_t k = *spec.k;
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        for (auto* points : {&cases.motions[i].motion.start, &cases.motions[i].motion.end})
            for (Vec3<double>& p : *points)
                p = to_scene(draw_point(draws, {-k, -k, -k}, {k, k, k}), spec.scale);
    }
    return cases;
}

/// Scales: integers of up to 4 bits.
template <MotionKind kind> HardCaseFamily small_family(std::string_view name) {
    HardCaseFamily family =
        with_k(rounded_family(name, "any motion between small integers: every kind of root",
                              Panel::touching, small_integers<kind>),
               "integers from -k to k", 2, 1, 8);
    family.scale_min = -1074;
    family.scale_max = 1000;
    return family;
}

} // namespace

HardCaseFamily small_integers_vertex_face_family() {
    return small_family<MotionKind::vertex_face>("small_integers_vertex_face");
}

HardCaseFamily small_integers_edge_edge_family() {
    return small_family<MotionKind::edge_edge>("small_integers_edge_edge");
}

} // namespace boxwood
