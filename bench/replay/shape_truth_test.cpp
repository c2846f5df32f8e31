#include "bench/replay/shape_truth.h"

#include "bench/replay/made_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

using recording::Call;
using testing::HasSubstr;

/// A program by hand.
class Written {
  public:
    std::uint32_t add(recording::Shape shape, std::array<double, 4> numbers, Vec3<double> at) {
        program_.geometry_of.push_back(static_cast<std::uint32_t>(program_.geometries.size()));
        RecordedProgram::Geometry& geometry = program_.geometries.emplace_back();
        geometry.shape = shape;
        geometry.numbers = numbers;
        const auto object = static_cast<std::uint32_t>(program_.n_objects() - 1);
        move(object, at);
        call(Call::add, {object});
        return object;
    }
    /// One triangle.
    std::uint32_t add_mesh(const Triangle<double>& t, Vec3<double> at) {
        const std::uint32_t object = add(recording::Shape::mesh, {}, at);
        RecordedProgram::Geometry& geometry = program_.geometries.back();
        geometry.first_vertex = program_.vertices.size();
        geometry.first_triangle = program_.triangles.size();
        geometry.n_vertices = 3;
        geometry.n_triangles = 1;
        program_.vertices.insert(program_.vertices.end(), {t.a, t.b, t.c});
        program_.triangles.push_back({0, 1, 2});
        return object;
    }
    /// From the next call on.
    void move(std::uint32_t object, Vec3<double> at) {
        RecordedProgram::State& state = program_.states.emplace_back();
        state.object = object;
        state.pose = {1, 0, 0, 0, 1, 0, 0, 0, 1, at.x, at.y, at.z};
    }
    std::size_t call(Call what, const std::vector<std::uint32_t>& objects = {},
                     bool ended = false) {
        RecordedProgram::Call& made = program_.calls.emplace_back();
        made.what = what;
        made.first_object = program_.call_objects.size();
        made.n_objects = objects.size();
        made.first_state = n_states_;
        made.n_states = program_.states.size() - n_states_;
        made.ended = ended;
        n_states_ = program_.states.size();
        program_.call_objects.insert(program_.call_objects.end(), objects.begin(), objects.end());
        return program_.calls.size() - 1;
    }
    ShapeTruth truth(double max_tests = 1e9) const {
        return ShapeTruth(program_, max_tests, [] { return true; });
    }

  private:
    RecordedProgram program_;
    std::size_t n_states_ = 0;
};

ReplayedCall with(std::vector<Pair> touching) {
    ReplayedCall call;
    call.touching = std::move(touching);
    return call;
}
ReplayedCall apart(double distance) {
    ReplayedCall call;
    call.min_distance = distance;
    return call;
}

constexpr Triangle<double> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
constexpr Triangle<double> upright{{.25, .25, -1}, {.25, .25, 1}, {.25, .5, 1}};

TEST(ShapeTruth, KnowsWhichMeshesTouch) {
    Written program;
    program.add_mesh(flat, {});
    program.add_mesh(flat, {0, 0, .5});
    program.add_mesh(upright, {});
    const std::size_t all = program.call(Call::collide_self);
    const std::size_t any = program.call(Call::collide_self, {}, true);
    const std::size_t one = program.call(Call::collide_object, {1});
    const ShapeTruth truth = program.truth();
    EXPECT_EQ(truth.n_checked(), 3u);
    EXPECT_EQ(truth.fault(all, with({{1, 2}, {0, 2}}), false), "");
    EXPECT_EQ(truth.fault(all, with({{0, 2}}), false), "objects 1 and 2 touch");
    EXPECT_THAT(truth.fault(all, with({{0, 1}, {0, 2}, {1, 2}}), false),
                HasSubstr("objects 0 and 1 do not touch"));
    EXPECT_THAT(truth.fault(all, with({{0, 2}, {0, 2}, {1, 2}}), false), HasSubstr("twice"));
    program.call(Call::remove, {2}); // but it is where it was
    const std::size_t without = program.call(Call::collide_self);
    EXPECT_EQ(program.truth().fault(without, with({}), false), "");
    EXPECT_NE(program.truth().fault(without, with({{0, 2}}), false), "");
    EXPECT_EQ(truth.fault(any, with({{0, 2}}), false), "");
    EXPECT_EQ(truth.fault(any, with({}), false), "objects 0 and 2 touch");
    EXPECT_EQ(truth.fault(one, with({{1, 2}}), false), "");
    EXPECT_EQ(truth.fault(one, with({{0, 2}}), false).empty(), false);
}

TEST(ShapeTruth, KnowsHowFarApartMeshesAre) {
    Written program;
    program.add_mesh(flat, {});
    program.add_mesh(flat, {0, 0, .5});
    program.add_mesh(flat, {0, 0, 100});
    const std::size_t self = program.call(Call::distance_self);
    const std::size_t one = program.call(Call::distance_object, {2});
    const ShapeTruth truth = program.truth();
    EXPECT_EQ(truth.n_checked(), 2u);
    EXPECT_EQ(truth.fault(self, apart(.5), false), "");
    EXPECT_EQ(truth.fault(self, apart(.50001), false), "said to be 0.50001 apart, and it is 0.5");
    EXPECT_NE(truth.fault(self, apart(.49999), false), "");
    EXPECT_NE(truth.fault(self, apart(.500002), false), "");
    EXPECT_EQ(truth.fault(self, apart(.500002), true), ""); // floats
    EXPECT_NE(truth.fault(self, apart(.50001), true), "");
    EXPECT_EQ(truth.fault(one, apart(99.5), false), "");
    EXPECT_NE(truth.fault(one, apart(100), false), "");
    EXPECT_NE(truth.fault(one, apart(0), false), "");
    EXPECT_NE(truth.fault(one, apart(std::numeric_limits<double>::quiet_NaN()), false), "");
}

TEST(ShapeTruth, HoldsRoundSolidsBetweenPolyhedra) {
    Written program;
    program.add(recording::Shape::sphere, {1}, {});
    program.add(recording::Shape::sphere, {1}, {3, 0, 0});
    program.add(recording::Shape::box, {.1, .1, .1}, {0, .1, 0}); // in the first
    const std::size_t touch = program.call(Call::collide_self);
    const std::size_t distance = program.call(Call::distance_object, {1});
    constexpr double between = std::numbers::pi / 32; // of corners of the polyhedra
    program.move(1, {1.999 * std::cos(between), 1.999 * std::sin(between), 0});
    program.call(Call::update_all);
    const std::size_t barely = program.call(Call::collide_self);
    const ShapeTruth truth = program.truth();
    EXPECT_EQ(truth.n_checked(), 3u);
    EXPECT_EQ(truth.fault(touch, with({{0, 2}}), false), "");
    EXPECT_NE(truth.fault(touch, with({}), false), "");
    EXPECT_NE(truth.fault(touch, with({{0, 1}, {0, 2}}), false), "");
    EXPECT_EQ(truth.fault(distance, apart(1), false), "");
    EXPECT_NE(truth.fault(distance, apart(1.05), false), "");
    EXPECT_NE(truth.fault(distance, apart(.95), false), "");
    for (const std::vector<Pair>& either : {std::vector<Pair>{{0, 2}}, {{0, 1}, {0, 2}}})
        EXPECT_EQ(truth.fault(barely, with(either), false), "");
}

/// A mesh that doubles and floats have in two places.
TEST(ShapeTruth, RoundedMeshesMayTouchEitherWay) {
    const double third = 1. / 3; // the float is above
    Written program;
    program.add_mesh({{0, 0, third}, {1, 0, third}, {0, 1, third}}, {});
    program.add_mesh(flat, {0, 0, third});
    const std::size_t call = program.call(Call::collide_self);
    const ShapeTruth truth = program.truth();
    EXPECT_TRUE(truth.is_checked(call));
    EXPECT_EQ(truth.fault(call, with({{0, 1}}), false), "");
    EXPECT_EQ(truth.fault(call, with({}), false), "");
}

/// What rests on another touches it, or not, as each library rounds.
TEST(ShapeTruth, WithinRoundingBothAreRight) {
    Written program;
    program.add_mesh({{0, 0, .5}, {1, 0, .5}, {0, 1, .5}}, {0, 0, .1});     // at 0.6
    program.add_mesh({{0, 0, -.5}, {1, 0, -.5}, {0, 1, -.5}}, {0, 0, 1.1}); // at 0.6000000000000001
    program.add_mesh(flat, {0, 0, .6 - 1e-7});
    const std::size_t call = program.call(Call::collide_self);
    const ShapeTruth truth = program.truth();
    for (const std::vector<Pair>& either : {std::vector<Pair>{}, {{0, 1}}})
        EXPECT_EQ(truth.fault(call, with(either), false), "");
    EXPECT_NE(truth.fault(call, with({{0, 2}}), false), "");
    EXPECT_EQ(truth.fault(call, with({{0, 2}}), true), ""); // of floats
    Written touching;
    touching.add_mesh(flat, {});
    touching.add_mesh(flat, {});
    touching.add_mesh(upright, {});
    const std::size_t all = touching.call(Call::collide_self);
    EXPECT_EQ(touching.truth().fault(all, with({{0, 2}, {1, 2}}), false), ""); // two in one plane
    EXPECT_NE(touching.truth().fault(all, with({{0, 1}, {0, 2}}), true), "");
}

TEST(ShapeTruth, LeavesOutWhatItDoesNotKnow) {
    Written program;
    const std::uint32_t a = program.add_mesh(flat, {});
    const std::uint32_t b = program.add_mesh(upright, {});
    program.move(b, {5, 0, 0}); // and is not reported
    const std::size_t stale = program.call(Call::collide_object, {b});
    const std::size_t still_stale = program.call(Call::collide_self);
    program.call(Call::update_some, {b});
    const std::size_t known = program.call(Call::collide_self);
    const std::size_t others = program.call(Call::collide_others, {a});
    const std::size_t of_none = program.call(Call::collide_object);
    program.add_mesh(flat, {std::numeric_limits<double>::infinity(), 0, 0});
    const std::size_t nowhere = program.call(Call::distance_self);
    program.move(2, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    program.call(Call::update_all);
    const std::size_t nan = program.call(Call::distance_self);
    program.call(Call::remove, {2});
    const std::size_t again = program.call(Call::collide_self);
    program.add(recording::Shape::cone, {1, 1}, {});
    const std::size_t cone = program.call(Call::collide_self);
    program.call(Call::remove, {3});
    program.add(recording::Shape::mesh, {}, {}); // of nothing
    const std::size_t empty = program.call(Call::distance_self);
    program.call(Call::clear);
    const std::size_t none = program.call(Call::distance_self);
    const ShapeTruth truth = program.truth();
    for (const std::size_t call : {stale, still_stale, others, of_none, nowhere, nan, cone, empty})
        EXPECT_FALSE(truth.is_checked(call)) << call;
    for (const std::size_t call : {known, again, none})
        EXPECT_TRUE(truth.is_checked(call)) << call;
    EXPECT_EQ(truth.n_checked(), 3u);
    EXPECT_EQ(truth.fault(stale, with({{0, 1}}), false), "");
    EXPECT_EQ(truth.fault(none, apart(std::numeric_limits<double>::infinity()), false), "");
    EXPECT_NE(truth.fault(none, apart(1), false), "");
}

TEST(ShapeTruth, EndsAfterSoManyTests) {
    const RecordedProgram program =
        made_program({.bodies = 300, .triangles = 100, .frames = 3, .distances = 2});
    const auto n_checked = [&](double max_tests) {
        return ShapeTruth(program, max_tests, [] { return true; }).n_checked();
    };
    EXPECT_EQ(n_checked(1e9), 9u);
    EXPECT_EQ(n_checked(0), 0u);
    const std::size_t some = n_checked(3e7);
    EXPECT_GT(some, 0u);
    EXPECT_LT(some, 9u);
    EXPECT_EQ(ShapeTruth(program, 1e9, [] { return false; }).n_checked(), 0u);
}

} // namespace
} // namespace boxwood::bench
