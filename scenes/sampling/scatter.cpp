#include "scenes/sampling/scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood {
namespace {

/// By Newton's iteration from above, so that every machine gets the same bits; x > 0.
double cube_root(double x) {
    double root = x > 1 ? x : 1;
    for (;;) {
        const double next = (2 * root + x / (root * root)) / 3;
        if (next >= root)
            return root;
        root = next;
    }
}

/// P(|x - y| <= t) for x uniform in [a, a + p] and y uniform in [b, b + q]: the share of the
/// rectangle p by q that lies within a diagonal band, by second antiderivatives of a step.
double near_probability(double a, double p, double b, double q, double t) {
    const auto g = [](double u) { return u > 0 ? u * u / 2 : 0; };
    const auto below = [&](double u) { // P((x - a) - (y - b) <= u)
        return (g(u + q) - g(u) - g(u + q - p) + g(u - p)) / (p * q);
    };
    return std::clamp(below(b - a + t) - below(b - a - t), 0.0, 1.0);
}

double expected_overlap(std::span<const PlacementPair> sample, double scale) {
    double sum = 0;
    for (const auto& [a, b, weight] : sample) {
        double probability = weight;
        for (int axis = 0; axis < 3 && probability > 0; ++axis)
            probability *= near_probability(a.low[axis], a.side[axis], b.low[axis], b.side[axis],
                                            scale * (a.half[axis] + b.half[axis]));
        sum += probability;
    }
    return sum;
}

Placement scattered(const HalfSize& half_size, Draws& draws) { return {.half = half_size(draws)}; }

} // namespace

double scale_of(std::span<const PlacementPair> sample, double probability) {
    double high = 1;
    while (expected_overlap(sample, high) < probability)
        high *= 2;
    while (expected_overlap(sample, high / 2) >= probability)
        high /= 2;
    double low = high / 2;
    for (int bit = 0; bit < 16; ++bit) {
        const double middle = (low + high) / 2;
        (expected_overlap(sample, middle) < probability ? low : high) = middle;
    }
    return high;
}

double overlap_probability(const SceneSpec& spec) {
    if (spec.n == 0)
        throw std::invalid_argument(
            fmt::format("scene {}: n is 0, but there must be at least one item", spec.generator));
    if (!(spec.overlaps > 0 && spec.overlaps <= 1e9))
        throw std::invalid_argument(
            fmt::format("scene {}: overlaps = {} must lie in (0, 1e9]: it is the mean number of "
                        "boxes that overlap a box",
                        spec.generator, spec.overlaps));
    const double others = static_cast<double>(spec.n) - 1;
    return spec.overlaps < others / 2 ? spec.overlaps / others : 0.5;
}

Aabb<float> draw_box(const Placement& placement, double scale, Draws& draws) {
    const Vec3<double> u = draws.in_cube();
    Aabb<float> box;
    for (int axis = 0; axis < 3; ++axis) {
        const double centre = placement.low[axis] + placement.side[axis] * u[axis];
        const double half = scale * placement.half[axis];
        box.min[axis] = static_cast<float>(centre - half);
        box.max[axis] = static_cast<float>(centre + half);
    }
    return box;
}

std::vector<Aabb<float>> draw_boxes(const SceneSpec& spec, std::string_view name, double scale,
                                    const std::function<Placement(std::size_t i, Draws&)>& place) {
    const Random random(spec.seed, name);
    std::vector<Aabb<float>> boxes;
    boxes.reserve(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const Placement placement = place(i, draws);
        boxes.push_back(draw_box(placement, scale, draws));
    }
    return boxes;
}

namespace {

/// The factor at which as many overlap as spec.overlaps says.
double scattered_scale(const SceneSpec& spec, std::string_view name, const HalfSize& half_size) {
    // The sizes vary within one and a half decades of volume: 8192 pairs leave about 1 %.
    constexpr std::size_t n_pairs = 8192;
    const double probability = overlap_probability(spec);
    const Random random(spec.seed, name);
    std::vector<PlacementPair> sample(n_pairs);
    for (std::size_t k = 0; k < n_pairs; ++k) {
        Draws a = random.item(2 * k), b = random.item(2 * k + 1);
        sample[k] = {scattered(half_size, a), scattered(half_size, b), 1.0 / n_pairs};
    }
    return scale_of(sample, probability);
}

std::string scattered_params(const SceneSpec& spec, double scale) {
    return fmt::format(R"({{"overlaps":{},"scale":{}}})", spec.overlaps, scale);
}

/// Drawn corners, moved so that their box is centred at 0, and half of its size.
struct CentredTriangle {
    Corners corners;
    Vec3<double> half;

    CentredTriangle(DrawCorners draw, Draws& draws) : corners(draw(draws)), half() {
        Aabb<double> box;
        for (const Vec3<double>& p : corners)
            box.extend(p);
        for (Vec3<double>& p : corners)
            p = p - 0.5 * (box.min + box.max);
        half = 0.5 * (box.max - box.min);
    }
};

} // namespace

Scene scattered_boxes(const SceneSpec& spec, std::string_view name, const HalfSize& half_size) {
    const double scale = scattered_scale(spec, name, half_size);
    Scene scene;
    scene.boxes = draw_boxes(
        spec, name, scale, [&](std::size_t, Draws& draws) { return scattered(half_size, draws); });
    scene.params_json = scattered_params(spec, scale);
    return scene;
}

Scene scattered_triangles(const SceneSpec& spec, std::string_view name, DrawCorners draw) {
    const double scale = scattered_scale(
        spec, name, [draw](Draws& draws) { return CentredTriangle(draw, draws).half; });
    const Random random(spec.seed, name);
    Scene scene;
    TriangleMesh& mesh = scene.mesh;
    mesh.vertices.reserve(3 * spec.n);
    mesh.triangles.reserve(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const CentredTriangle triangle(draw, draws);
        const Vec3<double> centre = draws.in_cube();
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.triangles.push_back({first, first + 1, first + 2});
        for (const Vec3<double>& p : triangle.corners)
            mesh.vertices.push_back(static_cast<Vec3<float>>(centre + scale * p));
    }
    scene.params_json = scattered_params(spec, scale);
    return scene;
}

Scene boxes_at_density(const SceneSpec& spec, std::string_view name, double density,
                       const HalfSize& sides) {
    const Random random(spec.seed, name);
    const double side = cube_root(static_cast<double>(spec.n) / density);
    Scene scene;
    scene.boxes.reserve(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const Vec3<double> centre = side * draws.in_cube(), half = .5 * sides(draws);
        scene.boxes.push_back(
            {static_cast<Vec3<float>>(centre - half), static_cast<Vec3<float>>(centre + half)});
    }
    scene.params_json = fmt::format(R"({{"density":{},"side":{}}})", density, side);
    return scene;
}

} // namespace boxwood
