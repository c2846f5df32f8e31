#pragma once

#include "kernels/primitives/aabb.h"
#include "scenes/sampling/random.h"
#include "scenes/scene.h"

#include <array>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

/// How one box is drawn: its centre is uniform in the box from `low` to `low + side`, and its half
/// size is `half` times a factor that is the same for the whole scene.
struct Placement {
    Vec3<double> low{0, 0, 0}, side{1, 1, 1}, half;
};

/// Two independent boxes, standing for `weight` of all pairs; the weights of a sample sum to 1.
struct PlacementPair {
    Placement a, b;
    double weight;
};

/// The factor at which a random pair overlaps with the given probability, 0 < probability < 1.
/// The probability of each pair of the sample is exact, the cube's faces included: the distance of
/// two uniform centres has a piecewise quadratic distribution. Only + - * /, hence the same bits on
/// every machine; relative error 2^-16.
double scale_of(std::span<const PlacementPair> sample, double probability);

/// The probability for which each of n boxes overlaps spec.overlaps others in the mean, at most one
/// half (then it is (n - 1) / 2 others). Throws std::invalid_argument unless n > 0 and overlaps >
/// 0.
double overlap_probability(const SceneSpec& spec);

/// Draws the box of a placement: its centre, then its corners, rounded to float. Valid always.
Aabb<float> draw_box(const Placement& placement, double scale, Draws& draws);

/// spec.n boxes, each at the placement that is drawn for it. `name` is the stream of random
/// numbers.
std::vector<Aabb<float>> draw_boxes(const SceneSpec& spec, std::string_view name, double scale,
                                    const std::function<Placement(std::size_t i, Draws&)>& place);

/// The half size of a box before scaling, drawn.
using HalfSize = std::function<Vec3<double>(Draws&)>;

/// The corners of a triangle before scaling, drawn.
using Corners = std::array<Vec3<double>, 3>;
using DrawCorners = Corners (*)(Draws&);

/// spec.n boxes with centres uniform in the unit cube (they may stick out of it), as many to
/// overlap as spec.overlaps says. `name` is the stream of random numbers.
Scene scattered_boxes(const SceneSpec& spec, std::string_view name, const HalfSize& half_size);

/// spec.n boxes with the sides that `sides` draws and centres uniform in a cube of spec.n / density
/// units of volume. The same bits on every machine. `name` is the stream of random numbers.
Scene boxes_at_density(const SceneSpec& spec, std::string_view name, double density,
                       const HalfSize& sides);

/// A mesh of spec.n unconnected triangles whose boxes are scattered and overlap likewise.
Scene scattered_triangles(const SceneSpec& spec, std::string_view name, DrawCorners draw);

} // namespace boxwood
