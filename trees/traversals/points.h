#pragma once

#include "trees/layout.h"

#include <stdexcept>

/// Queries of points and regions, over any layout; AnyLayout says what each answers.
namespace boxwood {

template <class L>
void points(const L&, std::span<const Vec3<float>>, const Executor&, PairSink&, Work*) {
    throw std::logic_error("points: not there yet");
}
template <class L, class Region>
void regions(const L&, std::span<const Region>, const Executor&, PairSink&, Work*) {
    throw std::logic_error("regions: not there yet");
}
template <class L>
void nearest(const L&, std::span<const Vec3<float>>, std::size_t, const Executor&,
             std::span<Neighbour>, Work*) {
    throw std::logic_error("nearest: not there yet");
}
template <class L>
void closest_points(const L&, std::span<const Vec3<float>>, const TriangleMesh&, const Executor&,
                    std::span<SurfacePoint>, Work*) {
    throw std::logic_error("closest_points: not there yet");
}

} // namespace boxwood
