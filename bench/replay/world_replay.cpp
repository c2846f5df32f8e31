#include "bench/io/say.h"
#include "bench/replay/replayer.h"
#include "trees/world/bodies/world.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

BodyShape shape_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
    const auto [a, b, c, d] = of.numbers;
    switch (of.shape) {
    case recording::Shape::box:
        return convex::Box{{a / 2, b / 2, c / 2}};
    case recording::Shape::sphere:
        return convex::Sphere{a};
    case recording::Shape::ellipsoid:
        return convex::Ellipsoid{{a, b, c}};
    case recording::Shape::capsule:
        return convex::Capsule{a, b / 2};
    case recording::Shape::cone:
        return convex::Cone{a, b / 2};
    case recording::Shape::cylinder:
        return convex::Cylinder{a, b / 2};
    case recording::Shape::plane:
        return convex::Plane{{a, b, c}, d};
    case recording::Shape::half_space:
        return convex::HalfSpace{{a, b, c}, d};
    case recording::Shape::convex: {
        const auto points = program.vertices_of(of);
        return BodyShape::hull({points.begin(), points.end()});
    }
    default:
        break;
    }
    TriangleMesh mesh;
    for (const Vec3<double>& vertex : program.vertices_of(of))
        mesh.vertices.push_back(static_cast<Vec3<float>>(vertex));
    const auto triangles = program.triangles_of(of);
    mesh.triangles.assign(triangles.begin(), triangles.end());
    return BodyShape::surface(std::move(mesh));
}

class WorldReplay final : public Replay {
  public:
    explicit WorldReplay(const RecordedProgram& program)
        : program_(program), touch_(program.touch), poses_(program.n_objects()),
          body_of_(program.n_objects()) {
        for (const RecordedProgram::Geometry& geometry : program.geometries)
            shapes_.push_back(shape_of(program, geometry));
        for (const BodyShape& shape : shapes_)
            shape.build(); // as the program's models were built before
        for (const RecordedProgram::State& state : program.states)
            checked_pose(pose_of(state));
    }

    void run(const std::function<bool(std::size_t)>& includes,
             std::vector<ReplayedCall>& calls) override {
        calls.assign(program_.calls.size(), {});
        world_.clear();
        body_of_.assign(program_.n_objects(), std::nullopt);
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            const bool is_made = is_replayed(call, i, includes);
            const auto begun = std::chrono::steady_clock::now();
            move(program_.states_of(call));
            if (is_made)
                answer(call, calls[i]);
            const std::chrono::duration<double, std::nano> taken =
                std::chrono::steady_clock::now() - begun;
            calls[i].ns = taken.count();
        }
    }

  private:
    static Pose pose_of(const RecordedProgram::State& state) {
        Pose pose;
        for (std::size_t row = 0; row < 3; ++row) {
            pose.rotation[row] = {state.pose[3 * row], state.pose[3 * row + 1],
                                  state.pose[3 * row + 2]};
            pose.translation[static_cast<int>(row)] = state.pose[9 + row];
        }
        return pose;
    }
    void move(std::span<const RecordedProgram::State> states) {
        bodies_.clear();
        new_poses_.clear();
        for (const RecordedProgram::State& state : states) {
            const Pose pose = poses_[state.object] = pose_of(state);
            if (body_of_[state.object]) {
                bodies_.push_back(*body_of_[state.object]);
                new_poses_.push_back(pose);
            }
        }
        world_.set_poses(bodies_, new_poses_);
    }
    void insert(std::uint32_t object) {
        if (body_of_[object])
            return;
        const std::uint32_t body =
            world_.insert(shapes_[program_.geometry_of[object]], poses_[object]);
        body_of_[object] = body;
        if (body >= object_of_.size())
            object_of_.resize(std::size_t{body} + 1);
        object_of_[body] = object;
    }
    void remove(std::uint32_t object) {
        if (body_of_[object])
            world_.remove(*std::exchange(body_of_[object], std::nullopt));
    }
    /// Two that touch, with their contacts if the program wants them.
    void note(ReplayedCall& to, std::uint32_t a, std::uint32_t b) const {
        if (touch_.contacts)
            world_.contacts(a, b, {.max_contacts = touch_.max_contacts});
        note_touching(to, object_of_[a], object_of_[b]);
    }

    void answer(const RecordedProgram::Call& call, ReplayedCall& to) {
        using enum recording::Call;
        switch (call.what) {
        case add:
            for (const std::uint32_t object : program_.objects_of(call))
                insert(object);
            break;
        case recording::Call::remove:
            for (const std::uint32_t object : program_.objects_of(call))
                this->remove(object);
            break;
        case clear:
            world_.clear();
            body_of_.assign(program_.n_objects(), std::nullopt);
            break;
        case setup:
        case update_all:
        case update_some:
            world_.update();
            break;
        case collide_self:
            if (call.ended) {
                if (const auto pair = world_.any_collision())
                    note(to, pair->a, pair->b);
            } else {
                for (const Pair pair : world_.collisions())
                    note(to, pair.a, pair.b);
            }
            break;
        case distance_self:
            if (const auto nearest = world_.least_distance())
                to.min_distance = std::max(nearest->distance, 0.);
            break;
        default:
            query_one(call, to);
        }
    }
    /// One that is not in the world is put there for the query.
    void query_one(const RecordedProgram::Call& call, ReplayedCall& to) {
        const std::uint32_t object = program_.objects_of(call)[0];
        const bool is_guest = !body_of_[object];
        insert(object);
        const std::uint32_t body = *body_of_[object];
        if (call.what == recording::Call::collide_object && call.ended) {
            for (const std::uint32_t other : world_.candidates_of(body))
                if (world_.collide(body, other) != Answer::no) {
                    note(to, body, other);
                    break;
                }
        } else if (call.what == recording::Call::collide_object) {
            for (const std::uint32_t other : world_.collisions_of(body))
                note(to, body, other);
        } else if (const auto nearest = world_.least_distance_of(body))
            to.min_distance = std::max(nearest->distance, 0.);
        if (is_guest)
            remove(object);
    }

    const RecordedProgram& program_;
    RecordedProgram::Touch touch_;
    std::vector<BodyShape> shapes_;                     ///< by geometry
    std::vector<Pose> poses_;                           ///< by object
    std::vector<std::optional<std::uint32_t>> body_of_; ///< by object
    std::vector<std::uint32_t> object_of_;              ///< by body
    World world_;
    std::vector<std::uint32_t> bodies_;
    std::vector<Pose> new_poses_;
};

} // namespace

ReplayEntry world_replay() {
    const auto make = [](const RecordedProgram& program) -> std::unique_ptr<Replay> {
        if (!program.knows_shapes())
            return nullptr;
        try {
            return std::make_unique<WorldReplay>(program);
        } catch (const std::invalid_argument& refused) { // a shape or a pose
            say(std::string("boxwood.world is left out: ") + refused.what() + "\n");
            return nullptr;
        }
    };
    return {.name = "boxwood.world",
            .library = "boxwood",
            .summary = "boxwood::World: pairs and shapes",
            .make = make,
            .has_shapes = true};
}

} // namespace boxwood::bench
