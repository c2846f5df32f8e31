#include "scenes/scene.h"

#include "scenes/atom.h"
#include "scenes/moving/frames.h"
#include "scenes/registry.h"
#include "scenes/robots/robot_scene.h"
#include "scenes/sampling/poses.h"
#include "scenes/sampling/queries.h"
#include "scenes/sampling/rays.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace boxwood {
namespace {

static_assert(std::endian::native == std::endian::little, "content_hash is of little-endian bytes");

template <class T> void add(XXH3_state_t& state, const std::vector<T>& elements) {
    static_assert(sizeof(T) % 4 == 0 &&
                  std::is_trivially_copyable_v<T>); // floats or 32-bit integers
    if (!elements.empty())
        XXH3_64bits_update(&state, elements.data(), elements.size() * sizeof(T));
}

/// The numbers of a case without the padding between its members.
class CaseHash {
  public:
    explicit CaseHash(XXH3_state_t& state) : state_(state) {}

    void operator()(std::monostate) {}
    template <class Case> void operator()(const std::vector<Case>& cases) {
        for (const Case& c : cases)
            one(c);
    }
    void operator()(const RayCases& cases) {
        boxwood::add(state_, cases.triangles);
        (*this)(cases.rays);
    }
    void operator()(const MotionCases& cases) {
        add(cases.kind);
        (*this)(cases.motions);
    }
    void operator()(const BoxCases& cases) { add(cases.n_pairs); } // the boxes are the scene's

  private:
    void one(const TrianglePairCase& c) { add(c.a, c.b, c.touch); }
    void one(const RayCase& c) { add(c.ray, c.first, c.count, c.hit); }
    void one(const RayBoxCase& c) { add(c.ray, c.box, c.hit); }
    void one(const MotionCase& c) { add(c.motion, c.touch); }
    void one(const ObbPairCase& c) { add(c.a, c.b, c.touch); }
    void one(const ShapePairCase& c) {
        for (const ShapeOfPair* side : {&c.a, &c.b}) {
            add(side->shape.kind());
            boxwood::add(state_, lengths_of(side->shape));
            add(side->pose);
        }
        add(c.lo, c.hi);
    }
    void one(const FitCase& c) { add(c.transform, c.box); }
    template <class... Part> void add(const Part&... parts) {
        static_assert((std::is_trivially_copyable_v<Part> && ...));
        (XXH3_64bits_update(&state_, &parts, sizeof(Part)), ...); // no part has padding
    }

    XXH3_state_t& state_;
};

std::uint64_t hash_of(const Scene& scene) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                         &XXH3_freeState);
    if (!state)
        throw std::bad_alloc();
    XXH3_64bits_reset(state.get());
    add(*state, scene.boxes);
    add(*state, scene.mesh.vertices);
    add(*state, scene.mesh.triangles);
    add(*state, scene.rays);
    add(*state, scene.points);
    add(*state, scene.regions);
    add(*state, scene.spheres);
    add(*state, scene.poses);
    add(*state, scene.other_copy.vertices);
    if (scene.robot) {
        for (const TriangleMesh& mesh : scene.robot->robot.meshes) {
            add(*state, mesh.vertices);
            add(*state, mesh.triangles);
        }
        for (const std::vector<double>& values : scene.robot->states)
            add(*state, values);
        for (const AllowedPair& pair : scene.robot->allowed.value_or(std::vector<AllowedPair>()))
            add(*state, std::vector{pair.a, pair.b});
    }
    std::visit(CaseHash(*state), scene.cases);
    return XXH3_64bits_digest(state.get());
}

/// The spec of the family's cases. Throws std::invalid_argument for what does not go together.
HardCaseSpec checked(const HardCaseFamily& family, const SceneSpec& spec) {
    if (!spec.rays.empty())
        throw std::invalid_argument(fmt::format(
            "family {} has no mesh to aim {} rays at; leave rays out", family.name, spec.rays));
    if (spec.n_points != 0 || !spec.regions.empty())
        throw std::invalid_argument(
            fmt::format("family {} takes no points or regions; leave them out", family.name));
    if (spec.n >= no_triangle)
        throw std::invalid_argument(fmt::format(
            "family {}: n = {} is too large; cases are numbered by 32 bits", family.name, spec.n));
    const HardCaseSpec wanted{spec.n, spec.seed, spec.k, spec.scale, spec.file};
    check_hard_case_spec(family, wanted);
    return wanted;
}

/// "k12", "km3" for -3.
std::string signed_atom(std::string_view key, int value) {
    return fmt::format("_{}{}{}", key, value < 0 ? "m" : "", std::abs(value));
}

std::string family_scene_name(const HardCaseFamily& family, const SceneSpec& spec) {
    std::string name(family.name);
    if (family.reads_file) {
        const auto& file = spec.file;
        name += '_' + atom((file.has_filename() ? file : file.parent_path()).stem().string());
    }
    if (spec.k && *spec.k != family.k_default)
        name += signed_atom("k", *spec.k);
    if (spec.scale != 0)
        name += signed_atom("scale", spec.scale);
    return name;
}

Scene family_scene(const HardCaseFamily& family, const SceneSpec& spec) {
    Scene scene;
    scene.cases = make_cases(family, checked(family, spec));
    if (const auto* boxes = std::get_if<BoxCases>(&scene.cases))
        scene.boxes = boxes->boxes;
    const std::string k = family.k_meaning.empty()
                              ? ""
                              : fmt::format(R"(,"k":{})", spec.k.value_or(family.k_default));
    scene.params_json =
        fmt::format(R"({{"family":"{}"{},"scale":{}}})", family.name, k, spec.scale);
    scene.name = family_scene_name(family, spec);
    scene.spec = spec;
    scene.content_hash = hash_of(scene);
    return scene;
}

/// The row of the spec's generator. Throws std::invalid_argument for what does not go together.
const SceneEntry& checked(const SceneSpec& spec) {
    const SceneEntry& entry = scene_generator(spec.generator);
    if (entry.reads_file && spec.file.empty())
        throw std::invalid_argument(
            fmt::format("scene {}: no file is given; name {}", entry.name,
                        entry.has_mesh ? "an OBJ, PLY or STL file" : "a CSV file of boxes"));
    if (!entry.reads_file && !spec.file.empty())
        throw std::invalid_argument(
            fmt::format("scene {} reads no file, but {} is given", entry.name, spec.file.string()));
    const bool has_points = spec.n_points != 0 && spec.regions.empty();
    if ((spec.k && !has_points) || spec.scale != 0)
        throw std::invalid_argument(
            fmt::format("scene {} has no parameter {}; hard-case families have", entry.name,
                        spec.k && !has_points ? "k" : "scale"));
    if (spec.k && *spec.k < 1)
        throw std::invalid_argument(fmt::format(
            "scene {}: k = {}, but at least one neighbour must be wanted", entry.name, *spec.k));
    if (!spec.regions.empty()) {
        check_region_kind(spec.regions);
        if (spec.n_points == 0)
            throw std::invalid_argument(
                fmt::format("scene {}: regions are wanted, but n_points is 0", entry.name));
    }
    if (spec.n >= no_triangle)
        throw std::invalid_argument(fmt::format(
            "scene {}: n = {} is too large; items are numbered by 32 bits", entry.name, spec.n));
    if (!spec.rays.empty()) {
        if (spec.rays_file.empty())
            check_ray_kind(spec.rays);
        if (!entry.has_mesh)
            throw std::invalid_argument(
                fmt::format("scene {} has no triangles to aim {} rays at; use a mesh scene such as "
                            "sphere_mesh, or leave rays out",
                            entry.name, spec.rays));
    }
    if (!spec.poses.empty()) {
        check_pose_kind(spec.poses);
        if (!entry.has_mesh)
            throw std::invalid_argument(fmt::format(
                "scene {} has no triangles to place a copy of; use a mesh scene such as "
                "sphere_mesh, or leave poses out",
                entry.name));
        if (spec.n_poses == 0)
            throw std::invalid_argument(
                fmt::format("scene {}: poses are wanted, but n_poses is 0", entry.name));
    }
    if (!spec.motion.empty()) {
        check_motion_path(spec.motion);
        if (spec.poses.empty() || spec.n_poses < 2)
            throw std::invalid_argument(fmt::format(
                "scene {}: a {} motion is from pose to pose; give poses, and n_poses of at least 2",
                entry.name, spec.motion));
    }
    return entry;
}

} // namespace

std::string scene_name(const SceneSpec& spec) {
    if (spec.moving)
        return atom(spec.moving->name);
    if (const HardCaseFamily* family = find_hard_case_family(spec.generator)) {
        checked(*family, spec);
        return family_scene_name(*family, spec);
    }
    if (spec.generator == robot_scene)
        return "robot_" + atom(spec.file.stem().string()) +
               (spec.poses.empty() ? "" : "_" + spec.poses);
    const SceneEntry& entry = checked(spec);
    std::string name(entry.name);
    if (!spec.file.empty())
        name += '_' + atom(spec.file.stem().string());
    if (entry.uses_overlaps && spec.overlaps != SceneSpec{}.overlaps)
        name += "_overlaps" + atom(spec.overlaps);
    if (!spec.rays.empty())
        name += '_' + (spec.rays_file.empty() ? spec.rays
                                              : "rays_" + atom(spec.rays_file.stem().string()));
    if (spec.n_points != 0)
        name += spec.regions.empty() ? "_points" : '_' + spec.regions;
    if (!spec.poses.empty())
        name += '_' + spec.poses;
    if (!spec.motion.empty())
        name += '_' + spec.motion;
    if (spec.k && *spec.k != 1)
        name += signed_atom("k", *spec.k);
    return name;
}

namespace {

void add_params(Scene& scene, const std::string& params) {
    std::string& json = scene.params_json;
    json.pop_back();
    json += (json.size() > 1 ? "," : "") + params + "}";
}

/// Adds the points or regions of the spec, and says so among the parameters.
void lay_queries(Scene& scene, const SceneSpec& spec) {
    if (spec.n_points == 0)
        return;
    std::string params = fmt::format(R"("n_points":{})", spec.n_points);
    if (spec.regions.empty()) {
        scene.points = make_points(scene.boxes, spec.n_points, spec.seed);
        params += fmt::format(R"(,"k":{})", spec.k.value_or(1));
    } else {
        if (spec.regions == "boxes")
            scene.regions = make_box_regions(scene.boxes, spec.n_points, spec.seed);
        else
            scene.spheres = make_sphere_regions(scene.boxes, spec.n_points, spec.seed);
        params += fmt::format(R"(,"regions":"{}")", spec.regions);
    }
    add_params(scene, params);
}

Scene start_of(const SceneSpec& spec) {
    Scene scene;
    scene.name = scene_name(spec);
    scene.spec = spec;
    scene.boxes = boxes_at_start(*spec.moving);
    scene.params_json = params_json(*spec.moving);
    scene.content_hash = hash_of(scene);
    return scene;
}

Scene robot_of(const SceneSpec& spec) {
    if (spec.file.empty())
        throw std::invalid_argument("scene robot: no file is given; name a URDF file");
    Scene scene;
    scene.name = scene_name(spec);
    scene.spec = spec;
    const std::string_view kind = spec.poses.empty() ? random_states : std::string_view(spec.poses);
    scene.robot = std::make_shared<const RobotStates>(
        read_robot_states(spec.file, spec.n_poses, spec.seed, kind));
    scene.boxes = link_boxes(scene.robot->robot);
    scene.params_json = fmt::format(R"({{"n_states":{},"states":"{}","srdf":{}}})", spec.n_poses,
                                    kind, scene.robot->allowed.has_value());
    scene.content_hash = hash_of(scene);
    return scene;
}

} // namespace

Scene make_scene(const SceneSpec& spec) {
    if (spec.moving)
        return start_of(spec);
    if (spec.generator == robot_scene)
        return robot_of(spec);
    if (const HardCaseFamily* family = find_hard_case_family(spec.generator))
        return family_scene(*family, spec);
    const SceneEntry& entry = checked(spec);
    if (!spec.rays.empty() && spec.n_rays == 0)
        throw std::invalid_argument(
            fmt::format("scene {}: {} rays are wanted, but n_rays is 0", entry.name, spec.rays));
    Scene scene = entry.generate(spec);
    scene.name = scene_name(spec);
    scene.spec = spec;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
        scene.boxes.push_back(scene.mesh.triangle(i).bounds());
    if (!spec.rays.empty())
        scene.rays = spec.rays_file.empty()
                         ? make_rays(spec.rays, scene.mesh, spec.n_rays, spec.seed)
                         : read_rays(spec.rays_file);
    if (!spec.poses.empty()) {
        scene.poses = make_poses(spec.poses, scene.mesh, spec.n_poses, spec.seed);
        scene.other_copy = make_copy(spec.poses, scene.mesh);
        add_params(scene, fmt::format(R"("poses":"{}","n_poses":{})", spec.poses, spec.n_poses));
    }
    if (!spec.motion.empty())
        add_params(scene, fmt::format(R"("motion":"{}")", spec.motion));
    lay_queries(scene, spec);
    scene.content_hash = hash_of(scene);
    return scene;
}

} // namespace boxwood
