#include "trees/world/detail/mesh_parts.h"

#include "trees/detail/places.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace boxwood::detail {
namespace {

/// Which vertices hang together: sets that are joined.
class Joined {
  public:
    explicit Joined(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t top_of(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t i, std::uint32_t j) { parent_[top_of(i)] = top_of(j); }

  private:
    std::vector<std::uint32_t> parent_;
};

} // namespace

MeshParts::MeshParts(const TriangleMesh& mesh) {
    // Of no triangle, and to be ordered: at a place where no triangle is.
    constexpr float beyond = std::numeric_limits<float>::max();
    std::vector<Vec3<float>> vertices = mesh.vertices;
    for (Vec3<float>& vertex : vertices)
        if (!is_finite(vertex))
            vertex = {beyond, beyond, beyond};
    const std::vector<std::uint32_t> first = places_of(vertices);
    Joined joined(mesh.vertices.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        joined.join(first[a], first[b]);
        joined.join(first[a], first[c]);
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            parts[joined.top_of(first[vertex])].push_back(first[vertex]);
    begin_.push_back(0);
    for (auto& [top, of_part] : parts) {
        std::ranges::sort(of_part);
        const auto repeated = std::ranges::unique(of_part);
        vertices_.insert(vertices_.end(), of_part.begin(), repeated.begin());
        begin_.push_back(vertices_.size());
    }
}

} // namespace boxwood::detail
