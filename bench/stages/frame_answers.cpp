#include "bench/stages/frame_answers.h"

#include <bit>
#include <span>

namespace boxwood::bench {
namespace {

/// One number of two, so that neither makes up for the other.
std::uint64_t mixed(std::uint64_t sum, std::uint64_t x) {
    sum = (sum ^ x) * 0x9e3779b97f4a7c15u;
    return sum ^ sum >> 32;
}

/// Whatever their order: of a splitmix64 of each.
std::uint64_t unordered(std::span<const Pair> pairs) {
    std::uint64_t sum = pairs.size();
    for (const Pair p : pairs) {
        std::uint64_t x = (std::uint64_t{p.a} << 32 | p.b) + 0x9e3779b97f4a7c15u;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
        x = (x ^ x >> 27) * 0x94d049bb133111ebu;
        sum += x ^ x >> 31;
    }
    return sum;
}

} // namespace

std::uint64_t answers_hash(const FrameAnswers& answers) {
    std::uint64_t sum = unordered(answers.pairs);
    std::uint64_t touching = answers.triangle_pairs.size(); // in any order, too
    for (const TouchingTriangles& t : answers.triangle_pairs)
        touching += mixed(mixed(mixed(t.body_a, t.body_b), t.triangle_a), t.triangle_b);
    sum = mixed(sum, touching);
    for (const SurfaceHit& hit : answers.rays)
        sum = mixed(mixed(sum, std::uint64_t{hit.body} << 32 | hit.triangle),
                    std::bit_cast<std::uint32_t>(hit.t));
    sum = mixed(sum, unordered(answers.points));
    sum = mixed(sum, unordered(answers.regions));
    for (const Neighbour& near : answers.nearest)
        sum = mixed(mixed(sum, near.item), std::bit_cast<std::uint64_t>(near.squared_distance));
    return sum;
}

} // namespace boxwood::bench
