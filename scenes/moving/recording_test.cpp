#include "scenes/moving/recording.h"

#include "scenes/moving/frames.h"
#include "scenes/sampling/rays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace boxwood {
namespace {

/// A file with this text, gone with the test.
class FileOf {
  public:
    explicit FileOf(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                ("boxwood_rows_" + std::to_string(getpid()) + ".csv")) {
        std::ofstream(path_) << text;
    }
    ~FileOf() { std::filesystem::remove(path_); }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

template <class Read> std::string refusal(const std::string& text, const Read& read) {
    const FileOf file(text);
    try {
        read(file.path());
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "none";
}

const std::string two_bodies = "# two bodies\n0,0, 0,0,0,1,1,1\n0,1, 5,5,5,6,6,6\n";

TEST(Recording, BodiesWithoutARowStay) {
    const FileOf file(two_bodies + "1,1,0.5,0,0,2,1,1\r\n\n3,0,9,9,9,10,10,10\n");
    const Recording recording = read_recording(file.path());
    const Aabb<float> a{{0, 0, 0}, {1, 1, 1}}, b{{5, 5, 5}, {6, 6, 6}}, c{{0.5f, 0, 0}, {2, 1, 1}},
        d{{9, 9, 9}, {10, 10, 10}};
    EXPECT_EQ(recording, (Recording{{a, b}, {a, c}, {a, c}, {d, c}}));
}

TEST(Recording, IsPlayedFrameByFrame) {
    const FileOf file(two_bodies + "1,1,0.5,0,0,2,1,1\n3,0,9,9,9,10,10,10\n");
    auto scene = std::make_shared<SceneFile>();
    scene->recording = std::make_shared<const Recording>(read_recording(file.path()));
    scene->frames = 3;
    Frames frames(scene);
    for (int pass = 0; pass < 2; ++pass) {
        EXPECT_TRUE(std::ranges::equal(frames.start(), scene->recording->front()));
        const std::vector<std::vector<std::uint32_t>> moved{{1}, {}, {0}};
        for (std::size_t i = 0; i < 3; ++i) {
            const Frame* frame = frames.next();
            ASSERT_NE(frame, nullptr);
            EXPECT_EQ(frame->boxes, (*scene->recording)[i + 1]);
            EXPECT_EQ(frame->moved, moved[i]);
        }
        EXPECT_EQ(frames.next(), nullptr);
        frames.rewind();
    }
}

TEST(Recording, RefusesWhatIsNoMotionAndNamesTheLine) {
    const auto of = [](const std::string& text) { return refusal(text, read_recording); };
    using ::testing::HasSubstr;
    EXPECT_THAT(of(two_bodies), HasSubstr("one frame"));
    EXPECT_THAT(of(two_bodies + "1,2,0,0,0,1,1,1\n"), HasSubstr(":4: frame 0 has no body 2"));
    EXPECT_THAT(of("0,1,0,0,0,1,1,1\n1,1,0,0,0,1,1,1\n"),
                HasSubstr(":2: frame 0 has no box of body 0"));
    EXPECT_THAT(of(two_bodies + "2,0,0,0,0,1,1,1\n1,0,0,0,0,1,1,1\n"),
                HasSubstr(":5: frame 1 comes after"));
    EXPECT_THAT(of(two_bodies + "1,0,0,0,0,1,1\n"), HasSubstr(":4: a row is frame,body,"));
    EXPECT_THAT(of(two_bodies + "1.5,0,0,0,0,1,1,1\n"), HasSubstr("whole numbers"));
    EXPECT_THAT(of(two_bodies + "1,0,2,0,0,1,1,1\n"), HasSubstr("min 2 is above max 1"));
    EXPECT_THAT(of(two_bodies + "1,0,0,0,0,nan,1,1\n"), HasSubstr("a float holds"));
    EXPECT_THAT(of(""), HasSubstr("cannot read it"));
    EXPECT_THAT(of("# nothing\n"), HasSubstr("no rows"));
}

TEST(OwnRays, AreReadAndRefused) {
    const FileOf file("0,0,0,1,0,0\n1,2,3,0,0,-2,7.5\n");
    const std::vector<Ray<float>> rays = read_rays(file.path());
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_EQ(rays[0].t_max, std::numeric_limits<float>::infinity());
    EXPECT_EQ(rays[1].origin, (Vec3<float>{1, 2, 3}));
    EXPECT_EQ(rays[1].direction, (Vec3<float>{0, 0, -2}));
    EXPECT_EQ(rays[1].t_max, 7.5f);
    const auto of = [](const std::string& text) { return refusal(text, read_rays); };
    using ::testing::HasSubstr;
    EXPECT_THAT(of("0,0,0,0,0,0\n"), HasSubstr(":1: the direction is zero"));
    EXPECT_THAT(of("0,0,0,1,0\n"), HasSubstr(":1: a row is ox,oy,oz,dx,dy,dz[,t_max]"));
    EXPECT_THAT(of("0,0,1e38,1,0,0\n"), HasSubstr("2^126"));
    EXPECT_THAT(of("0,0,1,1,0,0,-1\n"), HasSubstr("t_max is below 0"));
}

} // namespace
} // namespace boxwood
