#include "bench/replay/made_program.h"

#include "scenes/sampling/random.h"
#include "scenes/scene.h"

#include <numeric>
#include <span>
#include <vector>

namespace boxwood::bench {
namespace {

using recording::Call;

RecordedProgram::State state_of(std::uint32_t object, const Aabb<float>& box) {
    RecordedProgram::State state;
    state.object = object;
    for (int axis = 0; axis < 3; ++axis) {
        state.bounds[static_cast<std::size_t>(axis)] = double{box.min[axis]};
        state.bounds[static_cast<std::size_t>(3 + axis)] = double{box.max[axis]};
    }
    const Vec3<double> middle = .5 * (Vec3<double>(box.min) + Vec3<double>(box.max));
    state.pose = {1, 0, 0, 0, 1, 0, 0, 0, 1, middle.x, middle.y, middle.z};
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

} // namespace

RecordedProgram made_program(const MadeProgramOptions& options) {
    std::vector<Aabb<float>> boxes =
        make_scene({.generator = "uniform", .n = options.bodies, .seed = options.seed}).boxes;
    RecordedProgram program;
    std::vector<std::uint32_t> objects(boxes.size());
    std::iota(objects.begin(), objects.end(), 0u);
    program.geometry_of = objects;
    for (const std::uint32_t object : objects) {
        RecordedProgram::Geometry& box = program.geometries.emplace_back();
        const Vec3<float> sides = boxes[object].max - boxes[object].min;
        box.shape = recording::Shape::box;
        box.numbers = {double{sides.x}, double{sides.y}, double{sides.z}};
        box.hash = object;
    }
    for (const std::uint32_t object : objects)
        program.states.push_back(state_of(object, boxes[object]));
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
            program.states.push_back(state_of(object, box));
            moved.push_back(object);
        }
        if (options.moved < 1)
            add_call(program, Call::update_some, moved, first_state);
        else
            add_call(program, Call::update_all, {}, first_state);
        add_call(program, Call::collide_self, {}, program.states.size());
    }
    return program;
}

} // namespace boxwood::bench
