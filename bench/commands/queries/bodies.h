#pragma once

#include "bench/io/bad_input.h"
#include "kernels/primitives/triangle.h"
#include "trees/world/pose.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace boxwood::bench {

/// The triangles of a mesh file, or of a box: "box:1,1,1", its full side lengths. Throws BadInput,
/// and as load_mesh.
TriangleMesh read_body(const std::string& body);

/// 16 numbers, row by row, parted by spaces or commas; the identity if empty. Throws BadInput,
/// which names the option.
Pose read_pose(const std::string& text, const std::string& option);

/// make(), with the name of the body before what is wrong with it.
template <class Make> auto named(const std::string& body, const Make& make) {
    try {
        return make();
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", body, error.what()));
    }
}

} // namespace boxwood::bench
