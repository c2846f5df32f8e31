#pragma once

#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::detail {

/// The parts of a mesh that hang together at their vertices, those at one place taken for one.
class MeshParts {
  public:
    /// The vertices of its triangles are there, finite and below 2^60.
    explicit MeshParts(const TriangleMesh& mesh = {});

    std::size_t size() const { return begin_.size() - 1; }
    /// The vertices of a part, ascending; of several at one place one.
    std::span<const std::uint32_t> vertices_of(std::size_t part) const {
        return std::span(vertices_).subspan(begin_[part], begin_[part + 1] - begin_[part]);
    }

  private:
    std::vector<std::uint32_t> vertices_; ///< by part
    std::vector<std::size_t> begin_;
};

} // namespace boxwood::detail
