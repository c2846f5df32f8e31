#include "trees/triangle_boxes.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

constexpr std::size_t chunk = 4096;

/// Of a triangle with a NaN bounds may be finite.
bool is_good(const TriangleMesh& mesh, std::size_t i) {
    for (const std::uint32_t vertex : mesh.triangles[i])
        if (vertex >= mesh.vertices.size() || !is_finite(mesh.vertices[vertex]))
            return false;
    return true;
}

[[noreturn]] void refuse(const TriangleMesh& mesh, std::size_t i) {
    for (const std::uint32_t vertex : mesh.triangles[i])
        if (vertex >= mesh.vertices.size())
            throw std::invalid_argument("triangle " + std::to_string(i) + " has the corner " +
                                        std::to_string(vertex) + ", but there are " +
                                        std::to_string(mesh.vertices.size()) + " vertices");
    throw InvalidBox(i, "a corner of the triangle is not finite");
}

} // namespace

Buffer<Box> triangle_boxes(const TriangleMesh& mesh, const Executor& executor) {
    const std::size_t n = mesh.triangles.size(), chunks = (n + chunk - 1) / chunk;
    Buffer<Box> boxes(n);
    Buffer<std::size_t> bad(chunks); // the first bad one of each chunk, or n
    executor.for_each(chunks, [&](std::size_t c) {
        bad[c] = n;
        const std::size_t end = std::min(n, (c + 1) * chunk);
        for (std::size_t i = c * chunk; i < end; ++i) {
            if (!is_good(mesh, i)) [[unlikely]] {
                bad[c] = i;
                return;
            }
            boxes[i] = mesh.triangle(i).bounds();
        }
    });
    for (std::size_t c = 0; c < chunks; ++c)
        if (bad[c] != n)
            refuse(mesh, bad[c]);
    return boxes;
}

} // namespace boxwood
