#pragma once

#include "bench/machine/machine.h"
#include "kernels/primitives/triangle.h"

#include <string>
#include <vector>

namespace boxwood::bench {

enum class Level { ok, note, warn };

/// One thing that was looked at: what it is, and what to do about it if it spoils timings.
struct Finding {
    Level level;
    std::string name, value;
    std::string advice; ///< empty where nothing is to be done
};

/// What of the machine spoils timings.
std::vector<Finding> examine(const Machine& machine);

/// The same of this program and the place where results would go.
std::vector<Finding> examine_program();
std::vector<Finding> examine_disk(const std::filesystem::path& folder);

/// What `boxwood doctor` prints; measures the memory bandwidth (about 0.3 s).
std::string doctor(bool json);

/// What `boxwood doctor MESH` prints of a mesh, whose coordinates may be no numbers.
std::string doctor_of_mesh(const TriangleMesh& mesh, const std::string& file, bool json);

/// What its option --out does: an OBJ file of the mesh without its bad triangles. Throws BadInput
/// for a file that is there already or cannot be written.
void write_good_triangles(const TriangleMesh& mesh, const std::string& out);

} // namespace boxwood::bench
