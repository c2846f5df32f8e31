/// Programs that use FCL, recorded and run again.

#include "bench/replay/made_program.h"
#include "bench/replay/replay.h"

#if __has_include(<fcl/config.h>)

#include "bench/replay/replayer.h"
#include "trees/adapters/apis/fcl_api.h"
#include "trees/adapters/fcl_recorder.h"
#include "trees/adapters/recording_file.h"
#include "trees/adapters/testing/shown_pairs.h"

#include <fcl/broadphase/default_broadphase_callbacks.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <random>
#include <vector>

#include <unistd.h>

namespace boxwood::bench {
namespace {

using recording::Call;
using testing::Each;
using testing::Field;
using testing::HasSubstr;

/// A file that is gone with the test.
class Replays : public testing::Test {
  protected:
    Replays()
        : file_(std::filesystem::temp_directory_path() /
                ("boxwood_replay_" + std::to_string(::getpid()) + ".h5")) {}
    ~Replays() override { std::filesystem::remove(file_); }

    RecordedProgram read() const { return read_program(file_); }
    static ReplayReport run(const RecordedProgram& program, const std::vector<ReplayEntry>& entries,
                            double max_tests = 1e9) {
        return replay(program, entries, 2, max_tests, [](const std::string&) { return true; });
    }
    static ReplayReport run(const RecordedProgram& program) { return run(program, fcl_entries()); }
    static std::vector<ReplayEntry> fcl_entries() {
        std::vector<ReplayEntry> all = replay_entries();
        std::erase_if(all, [](const ReplayEntry& e) {
            return e.name.find("coal") != e.name.npos ||
                   e.in_floats; // a test's FCL is slow in them
        });
        return all;
    }

    std::filesystem::path file_;
};

/// A program of balls and boxes that come, move and go, and makes every kind of query.
template <class S> class Program {
  public:
    using Manager = fcl::BroadPhaseCollisionManager<S>;
    using Object = fcl::CollisionObject<S>;

    void run(Manager& manager, Manager& others) {
        for (int i = 0; i < 60; ++i)
            manager.registerObject(made(i));
        std::vector<Object*> more;
        for (int i = 0; i < 40; ++i)
            more.push_back(made(i));
        others.registerObjects(more);
        manager.setup();
        others.setup();
        for (int step = 0; step < 20; ++step) {
            for (int i = 0; i < 10; ++i)
                move(*objects_[random_() % 60]);
            manager.update();
            move(*objects_[5]);
            manager.update(objects_[5].get());
            for (auto* object : {objects_[6].get(), objects_[7].get()})
                move(*object);
            manager.update({objects_[6].get(), objects_[7].get()});
            query(manager, others, step);
        }
        manager.unregisterObject(objects_[0].get());
        query(manager, others, 0);
        manager.clear();
        query(manager, others, 0);
    }
    std::size_t collisions = 0;
    S distance = 0;

  private:
    void query(Manager& manager, Manager& others, int step) {
        fcl::DefaultCollisionData<S> self, one, two, first;
        self.request.num_max_contacts = one.request.num_max_contacts =
            two.request.num_max_contacts = 100'000;
        manager.collide(&self, fcl::DefaultCollisionFunction<S>);
        manager.collide(objects_[static_cast<std::size_t>(step)].get(), &one,
                        fcl::DefaultCollisionFunction<S>);
        manager.collide(&others, &two, fcl::DefaultCollisionFunction<S>);
        manager.collide(&first, fcl::DefaultCollisionFunction<S>); // ends at the first contact
        fcl::DefaultDistanceData<S> a, b, c;
        manager.distance(&a, fcl::DefaultDistanceFunction<S>);
        manager.distance(objects_[61].get(), &b, fcl::DefaultDistanceFunction<S>);
        manager.distance(&others, &c, fcl::DefaultDistanceFunction<S>);
        collisions += self.result.numContacts() + one.result.numContacts() +
                      two.result.numContacts() + first.result.numContacts();
        distance += b.result.min_distance;
    }
    Object* made(int i) {
        if (i % 2 == 0)
            objects_.push_back(std::make_unique<Object>(ball_));
        else
            objects_.push_back(std::make_unique<Object>(std::make_shared<fcl::Box<S>>(1, 1, 1)));
        move(*objects_.back());
        return objects_.back().get();
    }
    void move(Object& object) {
        std::uniform_real_distribution<S> place(0, 6);
        object.setTranslation(fcl::Vector3<S>(place(random_), place(random_), place(random_)));
        object.computeAABB();
    }

    std::mt19937_64 random_{3};
    std::shared_ptr<fcl::Sphere<S>> ball_ = std::make_shared<fcl::Sphere<S>>(S(.5));
    std::vector<std::unique_ptr<Object>> objects_;
};

template <class S> void record_program(const std::filesystem::path& file) {
    Program<S> plain, recorded;
    fcl::DynamicAABBTreeCollisionManager<S> a, b, c, d;
    plain.run(a, b);
    {
        FclRecorder<S> recorder(c, file);
        recorded.run(recorder, d);
    }
    EXPECT_EQ(recorded.collisions, plain.collisions); // it changes nothing
    EXPECT_EQ(recorded.distance, plain.distance);
    EXPECT_GT(plain.collisions, 100u);
}

TEST_F(Replays, AProgramRunsAgainWithEveryManager) {
    for (const unsigned bits : {32u, 64u}) {
        bits == 32 ? record_program<float>(file_) : record_program<double>(file_);
        const RecordedProgram program = read();
        EXPECT_EQ(program.bits, bits);
        EXPECT_EQ(program.n_objects(), 100u);
        EXPECT_EQ(program.geometries.size(), 2u); // a ball; boxes of one size
        const ReplayReport report = run(program);
        EXPECT_EQ(report.n_queries, 22u * 7u);
        EXPECT_EQ(report.n_checked + report.n_of_chance, report.n_queries);
        EXPECT_LE(report.n_of_chance, 22u * 3u); // distances alone
        EXPECT_EQ(report.n_missed, 0u);
        ASSERT_EQ(report.outcomes.size(), 9u); // not SSaP, as there are distance queries
        EXPECT_TRUE(report.outcomes.back().has_shapes);
        EXPECT_EQ(report.outcomes[0].name, "boxwood.fcl_manager");
        EXPECT_THAT(report.outcomes, Each(Field(&ReplayOutcome::wrong, 0u)));
        for (const ReplayOutcome& outcome : report.outcomes)
            EXPECT_THAT(outcome.total_ns, testing::ElementsAre(testing::Gt(0), testing::Gt(0)));
    }
}

TEST_F(Replays, ARecordingHoldsWhatWasAsked) {
    fcl::DynamicAABBTreeCollisionManager<double> manager;
    FclBody<double> a(bounds_of<FclApi<double>>(0, 0, 0)), b(bounds_of<FclApi<double>>(.5, 0, 0));
    FclRecorder<double> recorder(manager, file_);
    recorder.registerObjects({&a, &b});
    recorder.setup();
    ShownPairs<FclApi<double>> shown;
    FclApi<double>::collide(recorder, shown);
    b.move(bounds_of<FclApi<double>>(5, 0, 0));
    recorder.update(&b);
    FclApi<double>::collide(recorder, shown);
    recorder.close();
    recorder.update(&a); // not in it any more
    const RecordedProgram program = read();
    ASSERT_EQ(program.calls.size(), 5u);
    EXPECT_EQ(program.calls[0].what, Call::add);
    EXPECT_THAT(program.objects_of(program.calls[0]), testing::ElementsAre(0u, 1u));
    EXPECT_EQ(program.states_of(program.calls[0]).size(), 2u);
    EXPECT_EQ(program.calls[2].what, Call::collide_self);
    EXPECT_EQ(program.calls[2].shown, 1u);
    EXPECT_EQ(program.calls[2].keys, recording::key(1, 0));
    EXPECT_FALSE(program.calls[2].ended);
    EXPECT_EQ(program.calls[3].what, Call::update_some);
    ASSERT_EQ(program.states_of(program.calls[3]).size(), 1u);
    EXPECT_EQ(program.states_of(program.calls[3])[0].bounds[0], 5);
    EXPECT_EQ(program.calls[4].shown, 0u);
}

/// Two meshes of the same content are one geometry.
TEST_F(Replays, GeometriesAreKnownByTheirContent) {
    const auto mesh = [](double height) {
        auto made = std::make_shared<fcl::BVHModel<fcl::OBBRSS<double>>>();
        made->beginModel();
        made->addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, height});
        made->endModel();
        return made;
    };
    {
        fcl::DynamicAABBTreeCollisionManager<double> manager;
        FclRecorder<double> recorder(manager, file_);
        std::vector<std::unique_ptr<fcl::CollisionObject<double>>> objects;
        const auto shared = mesh(1);
        for (const auto& shape : {shared, shared, mesh(1), mesh(2)}) {
            objects.push_back(std::make_unique<fcl::CollisionObject<double>>(shape));
            recorder.registerObject(objects.back().get());
        }
    }
    const RecordedProgram program = read();
    EXPECT_THAT(program.geometry_of, testing::ElementsAre(0u, 0u, 0u, 1u));
    ASSERT_EQ(program.geometries.size(), 2u);
    for (const auto& geometry : program.geometries) {
        EXPECT_EQ(geometry.shape, recording::Shape::mesh);
        EXPECT_EQ(geometry.n_triangles, 1u);
    }
    EXPECT_NE(program.geometries[0].hash, program.geometries[1].hash);
}

/// It is another object from the next report on.
TEST_F(Replays, ARegisteredObjectMayTakeAnotherGeometry) {
    const auto ball = [](double radius) {
        return fcl::CollisionObject<double>(std::make_shared<fcl::Sphere<double>>(radius));
    };
    {
        fcl::DynamicAABBTreeCollisionManager<double> manager;
        FclRecorder<double> recorder(manager, file_);
        fcl::CollisionObject<double> one = ball(1), other = ball(2);
        recorder.registerObjects({&one, &other});
        recorder.setup();
        other.setTranslation(fcl::Vector3<double>(5, 0, 0));
        other.computeAABB();
        one = ball(4);
        one.computeAABB();
        ShownPairs<FclApi<double>> shown;
        FclApi<double>::collide(recorder, shown); // of what the manager had
        recorder.update();
        FclApi<double>::collide(recorder, shown);
    }
    const RecordedProgram program = read();
    EXPECT_THAT(program.geometry_of, testing::ElementsAre(0u, 1u, 2u));
    std::vector<Call> calls;
    for (const RecordedProgram::Call& call : program.calls)
        calls.push_back(call.what);
    EXPECT_THAT(calls,
                testing::ElementsAre(Call::add, Call::setup, Call::collide_self, Call::remove,
                                     Call::add, Call::update_all, Call::collide_self));
    EXPECT_THAT(program.objects_of(program.calls[3]), testing::ElementsAre(0u));
    EXPECT_THAT(program.objects_of(program.calls[4]), testing::ElementsAre(2u));
    EXPECT_EQ(program.calls.back().shown, 1u);
    EXPECT_EQ(program.calls.back().keys, recording::key(1, 2));
    const ReplayReport report = run(program);
    EXPECT_EQ(report.n_missed, 0u);
    EXPECT_THAT(report.outcomes, Each(Field(&ReplayOutcome::wrong, 0u)));
}

/// Shows every other pair.
template <class S> class Forgetful final : public fcl::NaiveCollisionManager<S> {
  public:
    using fcl::NaiveCollisionManager<S>::collide;
    void collide(void* data, fcl::CollisionCallBack<S> callback) const override {
        struct Filter {
            void* data;
            fcl::CollisionCallBack<S> callback;
            int n = 0;
        } filter{data, callback};
        fcl::NaiveCollisionManager<S>::collide(&filter, [](auto* a, auto* b, void* to) {
            auto& self = *static_cast<Filter*>(to);
            return self.n++ % 2 == 0 && self.callback(a, b, self.data);
        });
    }
};

TEST_F(Replays, PairsThatWereMissedAreFound) {
    Program<double> program;
    Forgetful<double> forgetful;
    fcl::NaiveCollisionManager<double> others;
    {
        FclRecorder<double> recorder(forgetful, file_);
        program.run(recorder, others);
    }
    const RecordedProgram recorded = read();
    const ReplayReport report = run(recorded);
    EXPECT_GE(report.n_missed, 20u);
    EXPECT_EQ(recorded.calls[report.first_missed].what, Call::collide_self);
    EXPECT_THAT(report.outcomes, Each(Field(&ReplayOutcome::wrong, 0u)));

    record_program<double>(file_);
    std::vector<ReplayEntry> entries = fcl_entries();
    ReplayEntry& wrong = entries.emplace_back();
    wrong.name = "forgetful";
    wrong.library = "fcl";
    wrong.make = [](const RecordedProgram& of) -> std::unique_ptr<Replay> {
        return std::make_unique<Replayer<FclApi<double>>>(
            of, [] { return std::make_unique<Forgetful<double>>(); });
    };
    const RecordedProgram again = read();
    const ReplayReport with_it = run(again, entries);
    EXPECT_EQ(with_it.n_missed, 0u);
    const auto it = std::ranges::find(with_it.outcomes, "forgetful", &ReplayOutcome::name);
    ASSERT_NE(it, with_it.outcomes.end());
    EXPECT_GE(it->wrong, 20u);
    EXPECT_EQ(again.calls[it->first_wrong].what, Call::collide_self);
    EXPECT_THAT(with_it.outcomes, Each(Field(&ReplayOutcome::differ, 0u)));
    const ReplayReport unchecked = run(again, entries, 0);
    for (const ReplayOutcome& outcome : unchecked.outcomes)
        EXPECT_TRUE(outcome.has_shapes || (outcome.differ > 0) == (outcome.name == "forgetful"))
            << outcome.name;
}

/// What FclBroadPhase permits, and FCL's managers do not stand.
TEST_F(Replays, AnObjectMayComeTwiceAndGoTwice) {
    FclBroadPhase<double> manager;
    FclBody<double> a(bounds_of<FclApi<double>>(0, 0, 0)), b(bounds_of<FclApi<double>>(.5, 0, 0)),
        c(bounds_of<FclApi<double>>(.5, .5, 0));
    manager.registerObject(&c); // before the recording
    {
        FclRecorder<double> recorder(manager, file_);
        ShownPairs<FclApi<double>> shown;
        recorder.registerObjects({&a, &b});
        recorder.registerObject(&a);
        FclApi<double>::collide(recorder, shown);
        b.move(bounds_of<FclApi<double>>(7, 0, 0)); // and is not updated
        FclApi<double>::collide(recorder, shown, static_cast<fcl::CollisionObject<double>*>(&b));
        FclApi<double>::collide(recorder, shown);
        recorder.unregisterObject(&b);
        recorder.unregisterObject(&b);
        FclApi<double>::collide(recorder, shown);
    }
    const ReplayReport report = run(read());
    EXPECT_EQ(report.n_missed, 0u);
    EXPECT_EQ(report.n_checked, 4u);
    EXPECT_THAT(report.outcomes, Each(Field(&ReplayOutcome::wrong, 0u)));
}

TEST_F(Replays, AMadeProgramNeedsNoRecording) {
    for (const double moved : {.05, 1.}) {
        const RecordedProgram program = made_program({.bodies = 800, .moved = moved, .frames = 4});
        EXPECT_EQ(program.calls.size(), 2u + 4u * 2u);
        EXPECT_EQ(program.calls[2].what, moved < 1 ? Call::update_some : Call::update_all);
        EXPECT_NEAR(static_cast<double>(program.calls[2].n_states), 800 * moved, 25);
        const ReplayReport report = run(program);
        EXPECT_EQ(report.n_checked, 4u);
        EXPECT_EQ(report.n_missed, 0u); // there was no manager yet
        EXPECT_THAT(report.outcomes, Each(Field(&ReplayOutcome::wrong, 0u)));
    }
}

TEST_F(Replays, AMadeProgramMayBeOfMeshes) {
    const RecordedProgram program =
        made_program({.bodies = 60, .triangles = 200, .frames = 2, .distances = 5});
    EXPECT_EQ(program.calls.size(), 2u + 2u * (2u + 5u));
    EXPECT_NEAR(static_cast<double>(program.triangles.size()), 200, 40);
    // Bounds hold the mesh wherever it is turned to.
    for (const RecordedProgram::State& state : program.states)
        for (const Vec3<double>& vertex : program.vertices)
            for (std::size_t row = 0; row < 3; ++row) {
                const double x = state.pose[3 * row] * vertex.x +
                                 state.pose[3 * row + 1] * vertex.y +
                                 state.pose[3 * row + 2] * vertex.z + state.pose[9 + row];
                ASSERT_GE(x, state.bounds[row]);
                ASSERT_LE(x, state.bounds[3 + row]);
            }
    const ReplayReport report = run(program);
    EXPECT_EQ(report.n_checked, 2u * (1u + 5u));
    EXPECT_EQ(report.n_shapes_checked, 2u * (1u + 5u));
    EXPECT_THAT(report.outcomes, Each(Field(&ReplayOutcome::wrong, 0u)));
    EXPECT_TRUE(report.outcomes.back().has_shapes);
    const ReplayReport unchecked = run(program, fcl_entries(), 0);
    EXPECT_EQ(unchecked.n_shapes_checked, 0u);
    EXPECT_THAT(unchecked.outcomes, Each(Field(&ReplayOutcome::differ, 0u)));
}

TEST_F(Replays, CoalAnswersAsFclDoes) {
    std::vector<ReplayEntry> coal = replay_entries();
    std::erase_if(coal, [](const ReplayEntry& e) {
        return !e.is_truth && e.name != "boxwood.world" && e.library != "coal" &&
               e.name.find("coal") == e.name.npos;
    });
    const auto n_coal = std::ranges::count(coal, std::string("coal"), &ReplayEntry::library);
    if (n_coal == 0)
        GTEST_SKIP() << "Coal is not installed: scripts/setup --with-coal";
    record_program<double>(file_);
    for (const RecordedProgram& program :
         {read(), made_program({.bodies = 60, .triangles = 200, .frames = 2, .distances = 5})}) {
        const ReplayReport report = run(program, coal);
        EXPECT_GT(report.outcomes.size(), 3u);
        EXPECT_GE(std::ranges::count(report.outcomes, true, &ReplayOutcome::has_shapes), 3);
        for (const ReplayOutcome& outcome : report.outcomes)
            EXPECT_EQ(outcome.wrong, 0u) << outcome.name;
    }
}

TEST_F(Replays, ChecksUntilSoManyPairsWereTested) {
    record_program<double>(file_);
    const ReplayReport report = run(read(), fcl_entries(), 60. * 60 / 2 + 60);
    EXPECT_EQ(report.n_checked, 2u);
    EXPECT_EQ(report.n_queries, 22u * 7u);
}

TEST_F(Replays, AreEndedBetweenRuns) {
    record_program<double>(file_);
    const RecordedProgram program = read();
    int calls = 0;
    const auto n = static_cast<int>(fcl_entries().size());
    const ReplayReport report =
        replay(program, fcl_entries(), 5, 0, [&](const std::string&) { return ++calls < n + 3; });
    EXPECT_THAT(report.outcomes,
                Each(Field(&ReplayOutcome::total_ns, testing::SizeIs(1)))); // a complete round
}

TEST_F(Replays, WhatIsNoRecordingIsRefused) {
    const auto message = [&] {
        try {
            read();
        } catch (const std::runtime_error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(message(), HasSubstr(file_.string()));
    { // the calls speak of more objects than there are
        RecordingFile file(file_);
        RecordingFile::Table format(file, "format", recording::format),
            vertices(file, "vertices", recording::vertices),
            triangles(file, "triangles", recording::triangles),
            geometries(file, "geometries", recording::geometries),
            objects(file, "objects", recording::objects), states(file, "states", recording::states),
            of_calls(file, "call_objects", recording::call_objects),
            calls(file, "calls", recording::calls);
        format.add({recording::version, 64});
        calls.add({0, 1, 0, 0, 0, 0, 0, 0});
        for (auto* table :
             {&format, &vertices, &triangles, &geometries, &objects, &states, &of_calls, &calls})
            table->write();
    }
    EXPECT_THAT(message(), HasSubstr("more rows of call_objects"));
    EXPECT_THROW(FclRecorder<double>(*std::make_unique<fcl::NaiveCollisionManager<double>>(),
                                     "/nowhere/at/all.h5"),
                 std::runtime_error);
}

} // namespace
} // namespace boxwood::bench

#endif
