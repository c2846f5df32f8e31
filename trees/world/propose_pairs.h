#pragma once

#include "trees/function_ref.h"
#include "trees/world/allowed_pairs.h"
#include "trees/world/robot.h"

#include <cstdint>
#include <span>

/// An allowed collision matrix for a robot that comes without one.
namespace boxwood {

/// Nothing allowed; the items are the links.
AllowedPairs no_allowed_pairs(const Robot& robot);

/// Allows each link with geometry and the next one above it that has some: their joint, and links
/// without geometry between them, hold them together. Pairs that are allowed keep their reasons.
/// Returns how many pairs it allowed.
std::size_t allow_adjacent(const Robot& robot, AllowedPairs& allowed);

/// States of a robot to look at, which are the same on every machine.
struct SampledStates {
    std::uint64_t n = 10000;
    std::uint64_t seed = 1; ///< for the notes alone
    /// Writes the values of state i, i < n.
    FunctionRef<void(std::uint64_t i, std::span<double> values)> state;
};

/// Whether the geometries of two links share a point; poses: of all links.
using LinksCollide = FunctionRef<bool(std::uint32_t a, std::uint32_t b,
                                      std::span<const RigidTransform<double>> poses)>;

/// How many pairs were allowed, and for which reason; how often `collide` was called.
struct PairsBySampling {
    std::size_t always = 0, never = 0, sampled = 0;
    std::uint64_t tests = 0;
};

/// Looks at the pairs of links with geometry that are not allowed yet, and allows
/// - two that fixed joints hold together: `always` or `never`, by one state, which proves it;
/// - those that collide in every state: `always`;
/// - those that collide in no state: `sampled`, which proves nothing, as the note says, with n and
///   the seed.
/// `collide` is called where the boxes of two links overlap, until a pair is known to do both.
/// Throws std::invalid_argument if n = 0.
PairsBySampling allow_by_samples(const Robot& robot, const LinkBoxes& boxes,
                                 const SampledStates& states, LinksCollide collide,
                                 AllowedPairs& allowed);

} // namespace boxwood
