/// What recorders of FCL's managers do when a program does not go by the book.

#if __has_include(<fcl/config.h>)

#include "bench/replay/recorded_program.h"
#include "trees/adapters/fcl_recorder.h"
#include "trees/adapters/recording_file.h"

#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using recording::Call;
using Object = fcl::CollisionObjectd;
using Recorder = FclRecorder<double>;

class Recorders : public testing::Test {
  protected:
    ~Recorders() override { std::filesystem::remove(file_); }

    RecordedProgram read() const { return read_program(file_); }
    std::string bytes() const {
        std::ifstream file(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    Object& add(Recorder& to, const std::shared_ptr<fcl::CollisionGeometryd>& shape, double x) {
        Object& made = *objects_.emplace_back(std::make_unique<Object>(shape));
        made.setTranslation({x, 0, 0});
        made.computeAABB();
        to.registerObject(&made);
        return made;
    }
    void add_balls(Recorder& to) {
        for (int i = 0; i < 6; ++i)
            add(to, ball_, i);
        to.setup();
    }

    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("boxwood_recorder_" + std::to_string(::getpid()) + ".h5");
    std::shared_ptr<fcl::Sphered> ball_ = std::make_shared<fcl::Sphered>(.6);
    std::vector<std::unique_ptr<Object>> objects_;
    fcl::DynamicAABBTreeCollisionManagerd manager_;
};

/// A callback of one's own for each pair.
using OfPair = std::function<bool(Object*, Object*)>;
bool hand_on(Object* a, Object* b, void* each) { return (*static_cast<OfPair*>(each))(a, b); }

TEST_F(Recorders, ACallbackMayThrow) {
    {
        Recorder recorder(manager_, file_);
        add_balls(recorder);
        int shown = 0;
        OfPair throwing = [&](Object*, Object*) -> bool {
            if (++shown == 3)
                throw std::runtime_error("enough");
            return false;
        };
        EXPECT_THROW(recorder.collide(&throwing, hand_on), std::runtime_error);
        OfPair all = [](Object*, Object*) { return false; };
        recorder.collide(&all, hand_on);
    }
    const RecordedProgram program = read();
    const auto& thrown = program.calls[program.calls.size() - 2];
    EXPECT_EQ(thrown.what, Call::collide_self);
    EXPECT_EQ(thrown.shown, 3u);
    EXPECT_TRUE(thrown.ended);
    EXPECT_FALSE(program.calls.back().ended);
    EXPECT_EQ(program.calls.back().shown, 5u);
}

TEST_F(Recorders, MayBeClosedWithinAQuery) {
    Recorder recorder(manager_, file_);
    add_balls(recorder);
    OfPair closing = [&](Object*, Object*) {
        recorder.close();
        return false;
    };
    recorder.collide(&closing, hand_on);
    const RecordedProgram program = read();
    EXPECT_EQ(program.calls.back().what, Call::collide_self);
    EXPECT_TRUE(program.calls.back().ended);
    recorder.collide(&closing, hand_on); // handed on
    EXPECT_EQ(read().calls.size(), program.calls.size());
}

TEST_F(Recorders, ACallThatIsNotDoneHoldsNothingBackForEver) {
    constexpr std::size_t many = 70'000;
    std::size_t behind = 0;
    {
        Recorder recorder(manager_, file_);
        add_balls(recorder);
        OfPair none = [](Object*, Object*) { return true; };
        bool is_first = true;
        OfPair querying = [&](Object*, Object*) {
            if (std::exchange(is_first, false)) {
                for (std::size_t i = 0; i < many; ++i)
                    recorder.collide(objects_[0].get(), &none, hand_on);
                const std::filesystem::path copy = file_.string() + ".copy"; // file_ is locked
                std::filesystem::copy_file(file_, copy);
                behind = read_program(copy).calls.size(); // while this query goes on
                std::filesystem::remove(copy);
            }
            return false;
        };
        recorder.collide(&querying, hand_on);
    }
    EXPECT_GT(behind, many / 2);
    const RecordedProgram program = read();
    EXPECT_EQ(program.calls.size(), 7u + 1u + many);
    EXPECT_EQ(program.calls[7].what, Call::collide_self);
    EXPECT_TRUE(program.calls[7].ended); // as far as was known when it was written
}

TEST_F(Recorders, AForkedChildWritesNothing) {
    {
        Recorder recorder(manager_, file_);
        add_balls(recorder);
        OfPair forking = [&](Object*, Object*) {
            const std::string before = bytes();
            const pid_t child = fork();
            if (child == 0) {
                OfPair all = [](Object*, Object*) { return false; };
                recorder.collide(&all, hand_on);
                recorder.close();
                FclRecorder<double> own(manager_, file_.string() + ".child");
                own.collide(&all, hand_on);
                own.close();
                _exit(std::filesystem::remove(file_.string() + ".child") ? 0 : 1);
            }
            int status = 0;
            EXPECT_EQ(waitpid(child, &status, 0), child);
            EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
            EXPECT_TRUE(bytes() == before);
            return true;
        };
        recorder.collide(&forking, hand_on);
    }
    const RecordedProgram program = read();
    EXPECT_EQ(program.calls.size(), 7u + 1u);
    EXPECT_EQ(program.calls.back().shown, 1u);
}

TEST_F(Recorders, AGeometryInThePlaceOfAnotherIsAnother) {
    {
        Recorder recorder(manager_, file_);
        alignas(Object) std::byte place[sizeof(Object)];
        for (const double side : {1., 2.}) {
            auto shape = std::make_shared<fcl::Boxd>(side, 1, 1);
            const std::weak_ptr<fcl::CollisionGeometryd> box = shape;
            auto* const object = new (place) Object(std::move(shape));
            recorder.registerObject(object);
            recorder.unregisterObject(object);
            object->~CollisionObject();
            EXPECT_TRUE(box.expired()); // the recorder keeps none
        }
    }
    const RecordedProgram program = read();
    ASSERT_EQ(program.n_objects(), 2u);
    ASSERT_EQ(program.geometries.size(), 2u);
    EXPECT_EQ(program.geometries[program.geometry_of[0]].numbers[0], 1);
    EXPECT_EQ(program.geometries[program.geometry_of[1]].numbers[0], 2);
}

TEST_F(Recorders, WriteDownQueriesOfShapes) {
    std::size_t touching = 0;
    {
        Recorder recorder(manager_, file_);
        add_balls(recorder);
        OfPair querying = [&](Object* a, Object* b) {
            fcl::CollisionResultd touch;
            touching += Recorder::collide(a, b, fcl::CollisionRequestd(3, true), touch) > 0;
            fcl::DistanceResultd far;
            Recorder::distance(a, b, fcl::DistanceRequestd(true), far);
            return false;
        };
        recorder.collide(&querying, hand_on);
        querying(objects_[0].get(), objects_[1].get()); // in no call
    }
    EXPECT_EQ(touching, 6u);
    const RecordedProgram program = read();
    EXPECT_THAT(program.requests, testing::ElementsAre(recording::Request{0, 3, 1, 0, 0},
                                                       recording::Request{1, 0, 0, 1, 0}));
    ASSERT_EQ(program.request_counts.size(), 2u);
    for (const RecordedProgram::RequestCount& row : program.request_counts) {
        EXPECT_EQ(row.call, 7u);
        EXPECT_EQ(row.n, 5);
        EXPECT_GT(row.ns, 0);
    }
    EXPECT_TRUE(program.touch.contacts);
    EXPECT_EQ(program.touch.max_contacts, 3u);
}

TEST_F(Recorders, AllContactsAreAskedForByTheGreatestNumber) {
    {
        Recorder recorder(manager_, file_);
        add_balls(recorder);
        OfPair querying = [&](Object* a, Object* b) {
            fcl::CollisionResultd touch;
            constexpr auto all = std::numeric_limits<std::size_t>::max();
            Recorder::collide(a, b, fcl::CollisionRequestd(all, true), touch);
            return false;
        };
        recorder.collide(&querying, hand_on);
    }
    const RecordedProgram program = read();
    EXPECT_THAT(program.requests, testing::ElementsAre(recording::Request{0, 0x1p64, 1, 0, 0}));
    EXPECT_TRUE(program.touch.contacts);
    EXPECT_GE(program.touch.max_contacts, 1'000'000u);
}

/// As most managers permit: nothing of it is looked at any more.
TEST_F(Recorders, WhatIsRemovedMayBeGone) {
    fcl::NaiveCollisionManagerd manager;
    {
        Recorder recorder(manager, file_);
        add_balls(recorder);
        const Object* const gone = objects_.front().get();
        const Object unknown(ball_);
        objects_.front().reset();
        recorder.unregisterObject(const_cast<Object*>(gone));
        recorder.unregisterObject(const_cast<Object*>(&unknown));
    }
    const RecordedProgram program = read();
    EXPECT_EQ(program.n_objects(), 6u);
    ASSERT_EQ(program.calls.size(), 9u);
    EXPECT_EQ(program.calls[7].what, Call::remove);
    EXPECT_THAT(program.objects_of(program.calls[7]), testing::ElementsAre(0u));
    EXPECT_THAT(program.objects_of(program.calls[8]), testing::IsEmpty());
}

TEST_F(Recorders, AYesOrNoIsReplayedWhereMostRequestsHaveNoContacts) {
    RecordedProgram program;
    EXPECT_FALSE(most_frequent_touch(program).contacts);
    program.requests = {{0, 1, 0, 0, 0}, {0, 4, 1, 0, 0}, {0, 9, 1, 0, 0}, {1, 0, 0, 0, 0}};
    program.request_counts = {{0, 0, 10, 1}, {0, 1, 4, 1}, {1, 2, 5, 1}, {1, 3, 100, 1}};
    EXPECT_FALSE(most_frequent_touch(program).contacts);
    EXPECT_EQ(most_frequent_touch(program).max_contacts, 1u);
    program.request_counts.push_back({2, 1, 3, 1});
    EXPECT_TRUE(most_frequent_touch(program).contacts);
    EXPECT_EQ(most_frequent_touch(program).max_contacts, 4u);
}

TEST_F(Recorders, RecordingsOfVersion1AreRead) {
    {
        RecordingFile file(file_);
        std::vector<std::unique_ptr<RecordingFile::Table>> tables;
        const auto table = [&](const char* name, auto& columns) -> RecordingFile::Table& {
            return *tables.emplace_back(
                std::make_unique<RecordingFile::Table>(file, name, columns));
        };
        table("format", recording::format).add({1, 64});
        table("geometries", recording::geometries);
        table("vertices", recording::vertices);
        table("triangles", recording::triangles);
        table("objects", recording::objects);
        table("states", recording::states);
        table("call_objects", recording::call_objects);
        table("calls", recording::calls)
            .add({static_cast<double>(Call::collide_self), 0, 0, 0, 0, 0, 0, 5});
        for (const auto& made : tables)
            made->write();
    }
    const RecordedProgram program = read();
    EXPECT_EQ(program.calls.size(), 1u);
    EXPECT_TRUE(program.requests.empty());
    EXPECT_FALSE(program.touch.contacts);
}

} // namespace
} // namespace boxwood::bench

#endif
