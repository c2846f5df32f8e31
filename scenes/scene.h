#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/ray.h"
#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/sphere.h"
#include "kernels/primitives/triangle.h"
#include "scenes/hard_cases/hard_cases.h"

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

struct SceneFile;   // scenes/moving/scene_file.h
struct RobotStates; // scenes/robots/robot_scene.h

/// What a generator makes. The same spec gives the same bits on every machine.
struct SceneSpec {
    std::string generator{}; ///< a name of `scene_generators()` or `hard_case_families()`
    std::size_t n = 1000;    ///< wanted number of items (boxes, or triangles of a mesh)
    std::uint64_t seed = 1;  ///< key of the counter-based random numbers
    double overlaps = 10;    ///< wanted mean number of boxes that overlap a box (box scenes)
    std::string rays{};      ///< a name of `ray_kinds()`, or empty for no rays (mesh scenes)
    std::size_t n_rays = 0;  ///< number of rays
    std::filesystem::path rays_file{}; ///< of the user's own rays, whose kind is own_rays
    std::filesystem::path file{};      ///< of `mesh` and `boxes`, or a family's cases
    std::size_t n_points = 0;          ///< number of points or regions
    std::string regions{};             ///< a name of `region_kinds()`, or empty for no regions
    /// A name of `pose_kinds()`, or empty for no poses (mesh scenes); of a robot's states
    /// `states_along`, or empty if they are at random.
    std::string poses{};
    std::size_t n_poses = 0; ///< number of poses, or of a robot's states
    std::string motion{};    ///< a name of `motion_paths()` from pose to pose, or empty for none
    /// A scene that moves, instead of a generator's: its n and seed are those of the spec, and
    /// what is made is its frame 0.
    std::shared_ptr<const SceneFile> moving{};
    std::optional<int> k{}; ///< of a hard-case family: its parameter
    int scale = 0;          ///< of a hard-case family: power of two on every coordinate
};

/// One frame of things to test: boxes always; a mesh when they are boxes of its triangles.
struct Scene {
    std::string name; ///< generator or family, what differs from its defaults, rays: `[a-z0-9_]+`
    SceneSpec spec;
    /// Scene units; box i bounds triangle i when there is a mesh. In a moving scene box i is that
    /// of body i in frame 0, empty if the body is not present.
    std::vector<Aabb<float>> boxes;
    TriangleMesh mesh; ///< empty in box scenes
    std::vector<Ray<float>> rays;
    std::vector<Vec3<float>> points;
    std::vector<Aabb<float>> regions; ///< boxes or spheres, not both
    std::vector<Sphere<float>> spheres;
    /// Of a copy of the mesh, in the mesh's frame.
    std::vector<RigidTransform<double>> poses;
    TriangleMesh
        other_copy; ///< what stands in the poses if it is not the mesh as it is, else empty
    /// Of a robot: itself. Box i is that of link i in the link's frame.
    std::shared_ptr<const RobotStates> robot;
    Cases cases;             ///< of a hard-case family, else none
    std::string params_json; ///< the generator's parameters as one JSON object
    /// XXH3 of boxes, vertices, indices and rays, then of each case number by number, little-endian
    std::uint64_t content_hash = 0;

    bool has_other_copy() const { return !other_copy.triangles.empty(); }
    /// What stands in the poses.
    const TriangleMesh& copy() const { return has_other_copy() ? other_copy : mesh; }
};

/// A generator: name, human_name, summary and generate(spec) -> Scene with boxes or a mesh, and
/// params_json;
/// `make_scene` fills in the rest, the boxes of a mesh too.
template <class G>
concept SceneGenerator = requires(const SceneSpec& spec) {
    { G::name } -> std::convertible_to<std::string_view>;
    { G::human_name } -> std::convertible_to<std::string_view>;
    { G::summary } -> std::convertible_to<std::string_view>;
    { G::has_mesh } -> std::convertible_to<bool>;
    { G::uses_overlaps } -> std::convertible_to<bool>;
    { G::generate(spec) } -> std::same_as<Scene>;
};

/// A registry row.
struct SceneEntry {
    std::string_view name;
    std::string_view human_name; ///< "{n} uniform boxes"; {file}: the file's name
    std::string_view summary;
    Scene (*generate)(const SceneSpec&);
    bool has_mesh;           ///< boxes of triangles, at which rays can be aimed
    bool uses_overlaps;      ///< spec.overlaps steers the sizes
    bool reads_file = false; ///< spec.file holds it: n, seed and overlaps are unused
};

std::span<const SceneEntry> scene_generators();

/// A kind of rays aimed at a mesh scene.
struct RayKindEntry {
    std::string_view name, summary;
};
std::span<const RayKindEntry> ray_kinds();

/// Makes the scene: of a generator, the cases of a family (the boxes are a scene's boxes then),
/// frame 0 of a moving scene, or of "robot" the robot of a URDF file in random states.
/// Throws std::invalid_argument for a bad spec and std::runtime_error, naming file and place, for a
/// mesh file that is missing, empty, or holds NaN or indices out of range, or a bad query file.
Scene make_scene(const SceneSpec& spec);

/// The name that `make_scene` would give, without making it.
std::string scene_name(const SceneSpec& spec);

} // namespace boxwood
