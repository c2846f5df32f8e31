#include "bench/replay/made_program.h"

#include "kernels/primitives/rotation.h"
#include "scenes/sampling/poses.h"
#include "scenes/sampling/random.h"
#include "scenes/scene.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace boxwood::bench {
namespace {

using recording::Call;

RecordedProgram::State state_of(std::uint32_t object, const Aabb<float>& box,
                                const Rotation& turn) {
    RecordedProgram::State state;
    state.object = object;
    for (int axis = 0; axis < 3; ++axis) {
        state.bounds[static_cast<std::size_t>(axis)] = double{box.min[axis]};
        state.bounds[static_cast<std::size_t>(3 + axis)] = double{box.max[axis]};
    }
    const Vec3<double> middle = .5 * (Vec3<double>(box.min) + Vec3<double>(box.max));
    for (std::size_t row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            state.pose[3 * row + static_cast<std::size_t>(column)] = turn[row][column];
    state.pose[9] = middle.x;
    state.pose[10] = middle.y;
    state.pose[11] = middle.z;
    return state;
}

void add_call(RecordedProgram& program, Call what, std::span<const std::uint32_t> objects,
              std::size_t first_state) {
    RecordedProgram::Call call;
    call.what = what;
    call.first_object = program.call_objects.size();
    call.n_objects = objects.size();
    call.first_state = first_state;
    call.n_states = program.states.size() - first_state;
    program.call_objects.insert(program.call_objects.end(), objects.begin(), objects.end());
    program.calls.push_back(call);
}

/// One geometry for each box.
void add_boxes(RecordedProgram& program, const std::vector<Aabb<float>>& boxes) {
    for (const Aabb<float>& of : boxes) {
        program.geometry_of.push_back(static_cast<std::uint32_t>(program.geometries.size()));
        RecordedProgram::Geometry& box = program.geometries.emplace_back();
        const Vec3<float> sides = of.max - of.min;
        box.shape = recording::Shape::box;
        box.numbers = {double{sides.x}, double{sides.y}, double{sides.z}};
        box.hash = program.geometry_of.back();
    }
}

/// One mesh, which fits turned into cubes of the boxes' mean side; they become such cubes.
void add_meshes(RecordedProgram& program, std::vector<Aabb<float>>& boxes,
                const MadeProgramOptions& options) {
    float half = 0;
    for (const Aabb<float>& box : boxes)
        half += (box.max.x - box.min.x + box.max.y - box.min.y + box.max.z - box.min.z) /
                (6 * static_cast<float>(boxes.size()));
    const TriangleMesh mesh =
        make_scene({.generator = "sphere_mesh", .n = options.triangles, .seed = options.seed}).mesh;
    Aabb<double> bounds;
    for (const Vec3<float>& v : mesh.vertices)
        bounds.extend(Vec3<double>(v));
    const Vec3<double> centre = .5 * (bounds.min + bounds.max);
    double radius = 0;
    for (const Vec3<float>& v : mesh.vertices)
        radius = std::max(radius, length(Vec3<double>(v) - centre));
    const double scale = double{half} / (radius * (1 + 0x1p-10)); // floats on the way are rounded
    for (const Vec3<float>& v : mesh.vertices)
        program.vertices.emplace_back( // as floats, which ours holds
            static_cast<Vec3<float>>(scale * (Vec3<double>(v) - centre)));
    program.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    RecordedProgram::Geometry& geometry = program.geometries.emplace_back();
    geometry.shape = recording::Shape::mesh;
    geometry.n_vertices = program.vertices.size();
    geometry.n_triangles = program.triangles.size();
    program.geometry_of.assign(boxes.size(), 0);
    for (Aabb<float>& box : boxes) {
        const Vec3<float> middle = .5f * (box.min + box.max), side{half, half, half};
        box = {middle - side, middle + side};
    }
}

} // namespace

RecordedProgram made_program(const MadeProgramOptions& options) {
    std::vector<Aabb<float>> boxes =
        make_scene({.generator = "uniform", .n = options.bodies, .seed = options.seed}).boxes;
    RecordedProgram program;
    std::vector<std::uint32_t> objects(boxes.size());
    std::iota(objects.begin(), objects.end(), 0u);
    const Rotation straight = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::vector<Rotation> turns(boxes.size(), straight);
    if (options.triangles == 0) {
        add_boxes(program, boxes);
    } else {
        add_meshes(program, boxes, options);
        const Random numbers(options.seed, "made program, turns");
        for (const std::uint32_t object : objects) {
            Draws draws = numbers.item(object);
            turns[object] = rotation_of(draws);
        }
    }
    for (const std::uint32_t object : objects)
        program.states.push_back(state_of(object, boxes[object], turns[object]));
    add_call(program, Call::add, objects, 0);
    add_call(program, Call::setup, {}, program.states.size());
    const Random numbers(options.seed, "made program");
    for (unsigned frame = 0; frame < options.frames; ++frame) {
        const std::size_t first_state = program.states.size();
        std::vector<std::uint32_t> moved;
        for (const std::uint32_t object : objects) {
            Draws draws = numbers.item(std::size_t{frame} * boxes.size() + object);
            if (draws.uniform() >= options.moved)
                continue;
            Aabb<float>& box = boxes[object];
            const Vec3<float> sides = box.max - box.min;
            for (int axis = 0; axis < 3; ++axis) {
                const auto shift = static_cast<float>((2 * draws.uniform() - 1) * .1) * sides[axis];
                box.min[axis] += shift;
                box.max[axis] += shift;
            }
            program.states.push_back(state_of(object, box, turns[object]));
            moved.push_back(object);
        }
        if (options.moved < 1)
            add_call(program, Call::update_some, moved, first_state);
        else
            add_call(program, Call::update_all, {}, first_state);
        add_call(program, Call::collide_self, {}, program.states.size());
        for (std::size_t i = 0; i < options.distances; ++i) {
            const std::uint32_t object = // they take turns
                objects[(frame * options.distances + i) % objects.size()];
            add_call(program, Call::distance_object, std::span(&object, 1), program.states.size());
        }
    }
    return program;
}

} // namespace boxwood::bench
