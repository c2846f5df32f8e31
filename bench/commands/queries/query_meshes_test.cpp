#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <utility>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using Question = MeshesQuery::Question;

/// Files in a folder of their own.
class QueryMeshes : public ::testing::Test {
  protected:
    QueryMeshes()
        : folder_(std::filesystem::temp_directory_path() /
                  ("boxwood_meshes_" + std::to_string(std::random_device{}()))) {
        std::filesystem::create_directories(folder_);
    }
    ~QueryMeshes() override { std::filesystem::remove_all(folder_); }

    std::string put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    static std::string answer(const MeshesQuery& query) {
        std::ostringstream out;
        run(query, out);
        return out.str();
    }
    /// Of an answer of one line.
    template <class Query> static std::array<double, 3> numbers(const Query& query) {
        std::ostringstream out;
        run(query, out);
        std::array<double, 3> three{};
        EXPECT_EQ(std::sscanf(out.str().c_str(), "%lf,%lf,%lf", &three[0], &three[1], &three[2]),
                  3);
        return three;
    }
    static std::string complaint(const MeshesQuery& query) {
        try {
            return "answered: " + answer(query);
        } catch (const BadInput& e) {
            return e.what();
        }
    }
    static MeshesQuery cubes(Question question, const std::string& pose_b = "") {
        MeshesQuery query;
        query.question = question;
        query.a = "box:2,2,2";
        query.b = "box:2,2,2";
        query.pose_b = pose_b;
        return query;
    }
    static std::string at(const std::string& x) {
        return "1 0 0 " + x + " 0 1 0 0 0 0 1 0 0 0 0 1";
    }

    std::filesystem::path folder_;
};

TEST_F(QueryMeshes, CubesTouchOrDoNot) {
    EXPECT_EQ(answer(cubes(Question::collide, at("2"))), "1\n");
    EXPECT_EQ(answer(cubes(Question::collide, at("2.0000000000000004"))), "0\n");
    MeshesQuery query = cubes(Question::collide, at("3"));
    query.format.json = true;
    EXPECT_EQ(answer(query), "{\"collide\":false,\"triangle_pairs\":[],\"kernel\":"
                             "\"guigue_devillers_exact_batch\"}\n");
    query.pose_b = at("2");
    EXPECT_THAT(answer(query), HasSubstr("{\"collide\":true,\"triangle_pairs\":[["));
}

TEST_F(QueryMeshes, DistancesAreCertifiedAndInWorldCoordinates) {
    MeshesQuery query = cubes(Question::distance, at("5"));
    EXPECT_THAT(answer(query), ::testing::StartsWith("3,"));
    query.pose_a = at("10");
    query.pose_b = at("15");
    query.format.json = true;
    const std::string text = answer(query);
    EXPECT_THAT(text, HasSubstr("{\"distance\":3,\"lo\":"));
    EXPECT_THAT(text, HasSubstr("\"point_a\":[11,"));
    EXPECT_THAT(text, HasSubstr("\"point_b\":[14,"));
    EXPECT_THAT(text, HasSubstr("\"kernel\":\"certified\""));
    query.pose_b = at("11");
    EXPECT_THAT(answer(query), HasSubstr("{\"distance\":0,\"lo\":0,\"hi\":0,"));
}

TEST_F(QueryMeshes, SignedDistancesGoBelowZero) {
    MeshesQuery query = cubes(Question::distance, at("1.5"));
    query.is_signed = true;
    for (const char* b : {"box:2,2,2", "sphere:1"}) {
        query.b = b;
        EXPECT_NEAR(numbers(query)[0], -.5, 1e-12);
    }
    query.b = put("cube.obj", "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\n"
                              "v -1 1 1\nv 1 1 1\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\n"
                              "f 1 5 7 3\nf 2 4 8 6\n");
    const auto [distance, lo, hi] = numbers(query);
    EXPECT_NEAR(distance, -.5, .02);
    EXPECT_TRUE(lo <= -.5 && hi >= -.5);
    query.a = "box:.2,.2,.2"; // .1 is no float: 1.5e-9 off
    query.pose_b = at("2");
    const auto [apart, from, to] = numbers(query);
    EXPECT_NEAR(apart, .9, 1e-8);
    EXPECT_TRUE(from <= .9 && to >= .9 && to - from < 1e-8);
    query.a = "sphere:1.5"; // from -1.5 to 1.5, and the cube from 1 on
    const auto [deep, deep_lo, deep_hi] = numbers(query);
    EXPECT_TRUE(deep_lo <= -.5 && -.5 <= deep_hi) << deep;
    EXPECT_LE(deep_hi - deep_lo, .035); // a hundredth of the cube
    query.a = put("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(complaint(query), HasSubstr("the mesh is no solid"));
    query.a = "height_field:1,1," + put("flat.csv", "0,0\n0,0\n");
    EXPECT_THAT(complaint(query), HasSubstr("--signed: a signed distance is that of"));
}

TEST_F(QueryMeshes, ToleranceIsAYesOrNo) {
    MeshesQuery query = cubes(Question::tolerance, at("5"));
    EXPECT_THAT(complaint(query), HasSubstr("--tolerance T"));
    query.tolerance = 3;
    EXPECT_EQ(answer(query), "1\n");
    query.tolerance = 2.999999;
    EXPECT_EQ(answer(query), "0\n");
    query.tolerance = std::nan("");
    EXPECT_THAT(complaint(query), HasSubstr("finite number"));
}

TEST_F(QueryMeshes, SolidsHoldWhatIsInside) {
    for (const Question question : {Question::collide, Question::tolerance, Question::distance}) {
        MeshesQuery query = cubes(question);
        query.b = "box:.2,.2,.2";
        query.tolerance = .1;
        const std::string surfaces = answer(query);
        query.solid = true;
        const std::string solids = answer(query);
        if (question == Question::distance) {
            EXPECT_THAT(surfaces, ::testing::StartsWith("0.8999"));
            EXPECT_EQ(solids, "0,0,0\n");
        } else {
            EXPECT_EQ(surfaces, "0\n");
            EXPECT_EQ(solids, "1\n");
        }
        std::swap(query.a, query.b);
        EXPECT_EQ(answer(query), solids);
        query.pose_b = at("1.5");
        EXPECT_EQ(answer(query).substr(0, 2), question == Question::distance ? "0." : "0\n");
    }
    MeshesQuery inner = cubes(Question::contacts);
    inner.b = "box:.2,.2,.2";
    inner.pose_b = at(".75");
    EXPECT_EQ(answer(inner), "");
    inner.solid = true;
    EXPECT_THAT(answer(inner), HasSubstr(",1,0,0,0.1499")); // out by the nearest face
    MeshesQuery query = cubes(Question::collide);
    query.a = put("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    query.solid = true;
    EXPECT_THAT(complaint(query), HasSubstr("open.obj: the mesh is no solid: 3 of its edges"));
}

TEST_F(QueryMeshes, ContactsSayWhereAndHowDeep) {
    MeshesQuery query;
    query.question = Question::contacts;
    query.a = put("a.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    query.b = put("b.obj", "v 0 0 -0.001\nv 10 0 10\nv -10 0 10\nf 1 2 3\n");
    query.format.json = true;
    const std::string text = answer(query);
    EXPECT_THAT(text, HasSubstr("{\"contacts\":[{\"point\":["));
    EXPECT_THAT(text, HasSubstr("\"normal\":[0,0,1],\"depth\":0.001"));
    query.a = put("turned.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 2 1 3\n"); // FCL says depth 1
    EXPECT_THAT(answer(query), HasSubstr("\"normal\":[0,0,1],\"depth\":0.001"));
    MeshesQuery deep = cubes(Question::contacts, at("1.9"));
    const std::string all = answer(deep);
    deep.reduce = true;
    const std::string few = answer(deep);
    EXPECT_GT(std::ranges::count(all, '\n'), 4);
    EXPECT_EQ(std::ranges::count(few, '\n'), 4);
}

TEST_F(QueryMeshes, BadInputIsSaidWhereItIs) {
    MeshesQuery query = cubes(Question::collide, "1 2 3");
    EXPECT_THAT(complaint(query), HasSubstr("--pose-b"));
    query.pose_b = "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1";
    EXPECT_THAT(complaint(query), HasSubstr("no rigid transform"));
    query.pose_b = "1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1";
    EXPECT_THAT(complaint(query), HasSubstr("the last row"));
    query.pose_b = " ";
    EXPECT_THAT(complaint(query), HasSubstr("--pose-b"));
    query.pose_b = "";
    query.a = "sphere:1,2";
    EXPECT_THAT(complaint(query), HasSubstr("sphere:radius"));
    query.a = "spere:1";
    EXPECT_THAT(complaint(query), HasSubstr("no such file, and unknown shape 'spere'; did you mean "
                                            "'sphere'?"));
    query.a = "capsule:1,-2";
    EXPECT_THAT(complaint(query), HasSubstr("at least 0"));
    query.a = "cylinder:1,nan";
    EXPECT_THAT(complaint(query), HasSubstr("cylinder:1,nan"));
    query.a = "box:1,2";
    EXPECT_THAT(complaint(query), HasSubstr("box:1,2"));
    query.a = "box:";
    EXPECT_THAT(complaint(query), HasSubstr("full side lengths"));
    query.a = "box:-1,2,3";
    EXPECT_THAT(complaint(query), HasSubstr("at least 0"));
    query.a = "box:1,2,3";
    query.kernel = "moller";
    EXPECT_THAT(complaint(query), HasSubstr("moller"));
}

/// A square at z = 0 and solids above it, in either order.
TEST_F(QueryMeshes, PrimitivesAreSolidBesideMeshes) {
    const std::string square =
        put("square.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n");
    const auto above = [](const std::string& z) {
        return "1 0 0 .25 0 1 0 0 0 0 1 " + z + " 0 0 0 1";
    };
    for (const char* shape : {"sphere:.5", "capsule:.25,.5", "cylinder:.25,1"}) {
        MeshesQuery query;
        query.a = square;
        query.b = shape;
        query.pose_b = above("2");
        query.tolerance = 1.6;
        query.question = Question::collide;
        EXPECT_EQ(answer(query), "0\n") << shape;
        query.question = Question::tolerance;
        EXPECT_EQ(answer(query), "1\n") << shape;
        query.question = Question::distance;
        query.format.json = true;
        double distance = 0, lo = 0, hi = 0;
        const std::string text = answer(query);
        ASSERT_EQ(std::sscanf(text.c_str(), "{\"distance\":%lf,\"lo\":%lf,\"hi\":%lf", &distance,
                              &lo, &hi),
                  3)
            << text;
        EXPECT_NEAR(distance, 1.5, 1e-9) << shape;
        EXPECT_LE(lo, 1.5);
        EXPECT_GE(hi, 1.5);
        EXPECT_THAT(text, HasSubstr("\"triangle_b\":null,\"kernel\":\"gjk_epa\""));
        std::swap(query.a, query.b);
        std::swap(query.pose_a, query.pose_b);
        EXPECT_THAT(answer(query), HasSubstr("\"triangle_a\":null,\"triangle_b\":"));
        query.pose_a = above(".375");
        EXPECT_THAT(answer(query), HasSubstr("{\"distance\":0,\"lo\":0,\"hi\":0,")) << shape;
        query.question = Question::collide;
        EXPECT_THAT(answer(query), HasSubstr("{\"collide\":true,\"triangle_pairs\":[[null,"));
        query.question = Question::contacts;
        query.format.json = false;
        double x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0, depth = 0;
        const std::string contact = answer(query);
        ASSERT_EQ(std::sscanf(contact.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &nx, &ny,
                              &nz, &depth),
                  7)
            << contact;
        EXPECT_NEAR(nz, -1, 1e-3) << shape; // the square has to go down
        EXPECT_NEAR(depth, .125, 1e-5) << shape;
    }
}

TEST_F(QueryMeshes, PrimitivesBesidePrimitives) {
    MeshesQuery query;
    query.question = Question::distance;
    query.a = "sphere:.1";
    query.b = "sphere:.3";
    query.pose_b = at("1");
    double distance = 0, lo = 0, hi = 0;
    ASSERT_EQ(std::sscanf(answer(query).c_str(), "%lf,%lf,%lf", &distance, &lo, &hi), 3);
    EXPECT_NEAR(distance, .6, 1e-15);
    EXPECT_LE(lo, .6);
    EXPECT_GE(hi, .6);
    query.b = "box:.2,.2,.2"; // in doubles: a tenth is no float
    ASSERT_EQ(std::sscanf(answer(query).c_str(), "%lf,%lf,%lf", &distance, &lo, &hi), 3);
    EXPECT_NEAR(distance, .8, 1e-15);
    query.format.json = true;
    EXPECT_THAT(answer(query), HasSubstr("\"kernel\":\"closed_form\""));
    query.b = "box:9,9,9";
    query.question = Question::collide;
    EXPECT_EQ(answer(query),
              "{\"collide\":true,\"triangle_pairs\":[],\"kernel\":\"closed_form\"}\n");
    query.question = Question::contacts;
    EXPECT_THAT(answer(query), HasSubstr("{\"contacts\":[{\"point\":["));
    query.question = Question::tolerance;
    query.b = "cylinder:.1,1";
    query.format.json = false;
    for (const auto& [tolerance, expected] : {std::pair{.81, "1\n"}, {.79, "0\n"}}) {
        query.tolerance = tolerance;
        EXPECT_EQ(answer(query), expected);
    }
}

/// A ball inside a closed mesh touches it only as a solid.
TEST_F(QueryMeshes, SolidsHoldPrimitives) {
    MeshesQuery query;
    query.a = put("big.obj", "v -9 -9 -9\nv 30 -9 -9\nv -9 30 -9\nv -9 -9 30\n"
                             "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    query.b = "sphere:1";
    for (const bool swapped : {false, true}) {
        query.solid = false;
        EXPECT_EQ(answer(query), "0\n");
        query.solid = true;
        EXPECT_EQ(answer(query), "1\n");
        query.question = Question::distance;
        EXPECT_EQ(answer(query), "0,0,0\n");
        query.question = Question::collide;
        if (!swapped)
            std::swap(query.a, query.b);
    }
    query.pose_a = at("-11");
    EXPECT_EQ(answer(query), "0\n");
}

/// Half of .1, .2 or .7 is no float: answers are of the box all the same.
TEST_F(QueryMeshes, BoxesThatAreApartDoNotTouchAsTheirFloatsDo) {
    MeshesQuery query = cubes(Question::collide);
    query.a = query.b = "box:.2,.2,.2";
    query.pose_b = at("0.200000002"); // less than what rounding the corners adds
    EXPECT_EQ(answer(query), "0\n");
    query.format.json = true;
    EXPECT_THAT(answer(query), HasSubstr("\"triangle_pairs\":[]"));
    query = cubes(Question::contacts);
    query.a = query.b = "box:.2,.2,.2";
    query.pose_b = at("0.200000002");
    EXPECT_EQ(answer(query), "");
    query.pose_b = at("0.1999999");
    EXPECT_NE(answer(query), "");
}

TEST_F(QueryMeshes, BoxesOfAnySidesAreAnsweredAsTheyAre) {
    MeshesQuery query;
    // The second one is no box of floats, the first one is, or a mesh, or none either.
    const std::string cube = put("cube.obj", "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                                             "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                                             "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\n"
                                             "f 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\n"
                                             "f 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
    for (const auto& [first, half] :
         {std::pair{std::string("box:2,2,2"), 1.}, {cube, 1.}, {"box:.7,.7,.7", .35}})
        for (const bool swapped : {false, true}) {
            SCOPED_TRACE(first + (swapped ? " swapped" : ""));
            query = {};
            query.a = swapped ? "box:.7,.7,.7" : first;
            query.b = swapped ? first : "box:.7,.7,.7";
            query.question = Question::distance;
            query.pose_b = at("3.1");
            const double truth = 3.1 - half - .35;
            const auto [d, lo, hi] = numbers(query);
            EXPECT_LE(lo, d);
            EXPECT_LE(d, hi);
            EXPECT_LE(lo, truth + 1e-15);
            EXPECT_GE(hi, truth - 1e-15);
            EXPECT_LE(hi - lo, 1e-12);
            // Side by side they touch, and a little beyond that they do not.
            query.question = Question::collide;
            std::ostringstream touching, apart;
            touching.precision(17);
            touching << half + .35;
            query.pose_b = at(touching.str());
            EXPECT_EQ(answer(query), "1\n");
            apart.precision(17);
            apart << half + .35 + 1e-11;
            query.pose_b = at(apart.str());
            EXPECT_EQ(answer(query), "0\n");
            query.question = Question::tolerance;
            query.tolerance = 2e-11;
            EXPECT_EQ(answer(query), "1\n");
            query.tolerance = 5e-12;
            EXPECT_EQ(answer(query), "0\n");
        }
    ContinuousQuery motion;
    motion.a = "box:.7,.7,.7";
    motion.b = "box:.2,.2,.2";
    motion.from_a = at("-2");
    motion.to_a = at("2");
    const auto [hit, t_free, t_hit] = numbers(motion);
    EXPECT_EQ(hit, 1);
    EXPECT_LE(t_free, (2 - .45) / 4);
    EXPECT_GE(t_hit, (2 - .45) / 4 - 1e-15);
    EXPECT_LE(t_hit - t_free, 1e-9);
}

/// Pure translation: whichever motion is named, FCL's screw motion says .225, .11875 and .02475.
TEST_F(QueryMeshes, ContinuousPassesThroughNothingThin) {
    for (const auto& [length, time] : {std::pair{1.0, .45}, {2.0, .475}, {10.0, .495}})
        for (const char* motion : {"linear", "screw"}) {
            ContinuousQuery query;
            query.a = "box:.1,.1,.1";
            query.b = "box:.1,1,1";
            query.from_a = at(std::to_string(-length));
            query.to_a = at(std::to_string(length));
            query.motion = motion;
            const auto [hit, t_free, t_hit] = numbers(query);
            EXPECT_EQ(hit, 1);
            EXPECT_NEAR(t_free, time, 1e-6); // sides are rounded to floats
            EXPECT_NEAR(t_hit, time, 1e-6);
        }
    for (const auto& [a, b] : {std::pair{"sphere:.05", "box:.1,1,1"},
                               {"sphere:.05", "cylinder:.05,1"},
                               {"box:.1,.1,.1", "cylinder:.05,1"}}) {
        ContinuousQuery query;
        query.a = a;
        query.b = b;
        query.from_a = at("-1");
        query.to_a = at("1");
        const auto [hit, t_free, t_hit] = numbers(query);
        EXPECT_EQ(hit, 1) << a << " " << b;
        EXPECT_NEAR(t_free, .45, 1e-6) << a << " " << b;
        EXPECT_NEAR(t_hit, .45, 1e-6) << a << " " << b;
    }
    ContinuousQuery query;
    query.a = query.b = "box:1,1,1";
    query.from_a = at("5");
    query.format.json = true;
    std::ostringstream out;
    run(query, out);
    EXPECT_EQ(out.str(), "{\"hit\":false,\"t_free\":1,\"t_hit\":1}\n");
}

} // namespace
} // namespace boxwood::bench
