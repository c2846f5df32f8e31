/// The registry of what a scene may query. To add a query: its row here, and the file
/// bench/stages/queries/NAME.cpp that answers it.

#include "scenes/moving/query.h"

#include "scenes/effects/effect.h"
#include "scenes/moving/moving_scene.h"

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

/// The name of a query's stream of random numbers, on which the bits of all scenes depend.
std::string stream(const std::string& query) { return "asks." + query; }

/// The eye of the camera goes to and fro, along x from one end of the bounds to the other in about
/// three seconds, along y and z at other rates; it looks to where it will be.
struct Camera {
    explicit Camera(const MovingScene& scene) : bounds(scene.bodies().bounds) {
        const double time = static_cast<double>(scene.frame()) / scene.file().frames_per_second;
        eye = place(time);
        const Vec ahead = place(time + 1) - eye;
        const double far = length(ahead);
        if (far > 0)
            forward = ahead * (1 / far);
        const Vec side = cross(forward, std::abs(forward.z) < .9 ? Vec{0, 0, 1} : Vec{1, 0, 0});
        right = side * (1 / length(side));
        up = cross(right, forward);
    }
    Vec place(double time) const {
        const Vec half = .45 * (bounds.max - bounds.min);
        return .5 * (bounds.min + bounds.max) + Vec{half.x * wave(.6 * time - 1),
                                                    half.y * wave(.41 * time),
                                                    half.z * wave(.27 * time)};
    }

    Aabb<double> bounds;
    Vec eye, forward{1, 0, 0}, right, up;
};

/// The numbers of one query in this frame alone.
Draws draws_of(const Random& random, const MovingScene& scene, std::size_t i) {
    return random.item(scene.frame() << 32 | i);
}

Vec in_box(const Aabb<double>& box, Draws& draws) {
    const Vec u = draws.in_cube();
    Vec p = box.min;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] += u[axis] * (box.max[axis] - box.min[axis]);
    return p;
}

bool follows_camera(const SceneQuery& query) {
    const auto kind = std::ranges::find(query_kinds(), query.kind, &QueryKindEntry::name);
    return kind != query_kinds().end() && kind->follows_camera;
}

/// Where points are laid: within a tenth of the bounds around the eye, or all of the bounds.
Aabb<double> around(const MovingScene& scene, const SceneQuery& query) {
    if (!follows_camera(query))
        return scene.bodies().bounds;
    const Camera camera(scene);
    const Vec half = .1 * (camera.bounds.max - camera.bounds.min);
    return {camera.eye - half, camera.eye + half};
}

} // namespace

std::span<const SceneQueryEntry> scene_queries() {
    static const SceneQueryEntry entries[] = {
        {"pairs", "pairs of bodies whose boxes overlap, without those that are ignored", {}, {}},
        {"triangle_pairs", "pairs of triangles of two such bodies that share a point", {}, {}},
        {"rays",
         "the nearest hit of each ray on the surface of the bodies",
         {"kind", "n"},
         {.kind = "flying", .n = 1000},
         Probes::rays},
        {"points",
         "the bodies whose boxes contain each point",
         {"kind", "n"},
         {.kind = "flying", .n = 1000},
         Probes::points},
        {"regions",
         "the bodies whose boxes share a point with each box",
         {"kind", "n", "size"},
         {.kind = "flying", .n = 1000, .size = 4},
         Probes::regions},
        {"nearest",
         "the bodies whose boxes are nearest to each point",
         {"kind", "n", "k"},
         {.kind = "flying", .n = 1000, .k = 8},
         Probes::points},
    };
    return entries;
}

Probes probes_of(std::string_view query) {
    const auto entry = std::ranges::find(scene_queries(), query, &SceneQueryEntry::name);
    return entry == scene_queries().end() ? Probes::none : entry->probes;
}

std::span<const QueryKindEntry> query_kinds() {
    static constexpr QueryKindEntry entries[] = {
        {"flying", "around a camera that flies through the bounds; rays are its own", true},
        {"scattered", "anywhere in the bounds, elsewhere in each frame"},
    };
    return entries;
}

void rays_of_frame(const MovingScene& scene, const SceneQuery& query,
                   std::vector<Ray<float>>& out) {
    out.clear();
    if (follows_camera(query)) {
        const Camera camera(scene);
        const auto side =
            static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(query.n))));
        const double step = 1.2 / static_cast<double>(side);
        for (std::size_t i = 0; i < query.n; ++i) {
            const double x = (static_cast<double>(i % side) + .5) * step - .6;
            const double y = .6 - (static_cast<double>(i / side) + .5) * step;
            out.push_back(
                {static_cast<Vec3<float>>(camera.eye),
                 static_cast<Vec3<float>>(camera.forward + x * camera.right + y * camera.up)});
        }
        return;
    }
    const Random random(scene.file().seed, stream("rays"));
    for (std::size_t i = 0; i < query.n; ++i) {
        Draws draws = draws_of(random, scene, i);
        const Vec from = in_box(scene.bodies().bounds, draws);
        out.push_back(
            {static_cast<Vec3<float>>(from), static_cast<Vec3<float>>(draws.unit_vector())});
    }
}

void points_of_frame(const MovingScene& scene, const SceneQuery& query,
                     std::vector<Vec3<float>>& out) {
    out.clear();
    const Aabb<double> box = around(scene, query);
    const Random random(scene.file().seed, stream(query.name));
    for (std::size_t i = 0; i < query.n; ++i) {
        Draws draws = draws_of(random, scene, i);
        out.push_back(static_cast<Vec3<float>>(in_box(box, draws)));
    }
}

void regions_of_frame(const MovingScene& scene, const SceneQuery& query,
                      std::vector<Aabb<float>>& out) {
    out.clear();
    const Aabb<double> box = around(scene, query);
    const double size = query.size * scene.bodies().side;
    const Random random(scene.file().seed, stream("regions"));
    for (std::size_t i = 0; i < query.n; ++i) {
        Draws draws = draws_of(random, scene, i);
        const Vec middle = in_box(box, draws);
        const Vec u = draws.in_cube();
        const Vec half = (.5 * size) * (u + Vec{.5, .5, .5});
        out.push_back(
            {static_cast<Vec3<float>>(middle - half), static_cast<Vec3<float>>(middle + half)});
    }
}

} // namespace boxwood
