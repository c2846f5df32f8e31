#pragma once

#include "arrays.h"

#include "trees/world/mesh_tree.h"
#include "trees/world/motion.h"
#include "trees/world/pose.h"

#include <memory>
#include <string>
#include <vector>

namespace boxwood::python {

/// A 4 x 4 matrix, or None for no motion; several, of shape (n, 4, 4).
Pose pose_of(const py::object& given, const std::string& name);
std::vector<Pose> poses_of(const py::object& given, const std::string& name);
MotionPath path_of(const std::string& name); ///< linear or screw

inline py::array point_of(const Vec3<double>& p) {
    return array_of<double>(std::vector<double>{p.x, p.y, p.z});
}

/// bw.Mesh: its tree, which shapes of a world may share.
class PyMesh {
  public:
    PyMesh(const py::object& vertices, const py::object& faces, const std::string& builder);
    const MeshTree& tree() const { return *tree_; }
    const std::shared_ptr<const MeshTree>& shared_tree() const { return tree_; }

  private:
    std::shared_ptr<const MeshTree> tree_;
};

} // namespace boxwood::python
