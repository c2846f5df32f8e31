#include "scenes/moving/recording.h"

#include "kernels/testing/complaint.h"
#include "scenes/moving/frames.h"
#include "scenes/text/testing/file_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood {
namespace {

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
    const auto of = [](const std::string& text) {
        const FileOf file(text);
        return complaint_of<std::runtime_error>([&] { read_recording(file.path()); });
    };
    using ::testing::HasSubstr;
    EXPECT_THAT(of(two_bodies), HasSubstr("one frame"));
    EXPECT_THAT(of(two_bodies + "1,2,0,0,0,1,1,1\n"), HasSubstr(":4: frame 0 has no body 2"));
    EXPECT_THAT(of("0,1,0,0,0,1,1,1\n1,1,0,0,0,1,1,1\n"),
                HasSubstr(":2: frame 0 has no box of body 0"));
    EXPECT_THAT(of(two_bodies + "2,0,0,0,0,1,1,1\n1,0,0,0,0,1,1,1\n"),
                HasSubstr(":5: frame 1 comes after"));
    EXPECT_THAT(of(two_bodies + "1,0,0,0,0,1,1\n"),
                HasSubstr(":4: 7 columns, expected 8: frame,body,"));
    EXPECT_THAT(of(two_bodies + "1.5,0,0,0,0,1,1,1\n"), HasSubstr("whole numbers"));
    EXPECT_THAT(of(two_bodies + "1,0,2,0,0,1,1,1\n"), HasSubstr("min 2 is above max 1"));
    EXPECT_THAT(of(two_bodies + "1,0,0,0,0,nan,1,1\n"), HasSubstr("a float holds"));
    EXPECT_THAT(of(""), HasSubstr("it holds no rows of frame,body,"));
    EXPECT_THAT(of(two_bodies + "1,0,x,0,0,0,1,1\n"), HasSubstr(":4: column 3 is 'x'"));
    EXPECT_THAT(of("# nothing\n"), HasSubstr("no rows"));
}

} // namespace
} // namespace boxwood
