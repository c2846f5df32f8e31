#include "trees/queries/sides.h"

#include "kernels/features/upward_crossing.h"
#include "trees/detail/places.h"
#include "trees/queries/sinks.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <vector>

namespace boxwood {
using detail::places_of;
namespace {

/// Counts the triangles above each point. The pairs of a point come one after another.
class CountAbove final : public PairSink {
  public:
    CountAbove(const TriangleMesh& mesh, std::span<const Vec3<float>> points, std::span<Side> out)
        : mesh_(mesh), points_(points), out_(out) {}

    void begin(std::size_t, bool) override {}
    bool take(std::size_t, std::span<const Pair> pairs) override {
        for (const Pair pair : pairs) {
            Side& side = out_[pair.a];
            if (side == Side::on_surface)
                continue;
            const Triangle<float> t = mesh_.triangle(pair.b);
            const Triangle<double> exact{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)};
            switch (upward_crossing(Vec3<double>(points_[pair.a]), exact)) {
            case Crossing::touches:
                side = Side::on_surface;
                break;
            case Crossing::crosses:
                side = side == Side::inside ? Side::outside : Side::inside;
                break;
            case Crossing::none:
                break;
            }
        }
        return true;
    }
    void end() override {}

  private:
    const TriangleMesh& mesh_;
    std::span<const Vec3<float>> points_;
    std::span<Side> out_;
};

} // namespace

std::size_t open_edges(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> places = places_of(mesh.vertices);
    std::vector<std::array<std::uint32_t, 2>> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = places[t[i]], b = places[t[(i + 1) % 3]];
            if (a != b)
                edges.push_back({std::min(a, b), std::max(a, b)});
        }
    std::ranges::sort(edges);
    std::size_t open = 0;
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next =
            std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
        open += static_cast<std::size_t>((next - edge) % 2);
        edge = next;
    }
    return open;
}

void sides(const AnyLayout& layout, const TriangleMesh& mesh, std::span<const Vec3<float>> points,
           const Executor& executor, std::span<Side> out) {
    if (out.size() != points.size())
        throw std::invalid_argument("sides: one answer per point is wanted");
    std::ranges::fill(out, Side::outside);
    std::vector<Box> above(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_finite(points[i])) {
            above[i] = {points[i], points[i]};
            above[i].max.z = std::numeric_limits<float>::max();
        }
    CountAbove count(mesh, points, out);
    layout.regions(above, executor, count);
}

} // namespace boxwood
