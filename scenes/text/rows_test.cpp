#include "scenes/text/rows.h"

#include "kernels/testing/complaint.h"
#include "scenes/scene.h"
#include "scenes/text/read_file.h"
#include "scenes/text/testing/file_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood {
namespace {

using ::testing::HasSubstr;

std::vector<Aabb<float>> boxes_of(const std::string& text) {
    const FileOf file(text);
    SceneSpec spec;
    spec.generator = "boxes";
    spec.file = file.path();
    return make_scene(spec).boxes;
}

std::string complaint(const std::string& text) {
    return complaint_of<BadInput>([&] { boxes_of(text); });
}

TEST(Rows, BoxesOfASceneAreWrittenAsThoseOfQueries) {
    EXPECT_EQ(boxes_of("\xef\xbb\xbf# a mark\r\n+1,0x1p-1,1e-400, 2,3,4\r\n"),
              (std::vector<Aabb<float>>{{{1, 0.5f, 0}, {2, 3, 4}}}));
}

TEST(Rows, BadBoxesAreNamedByLineAndColumn) {
    EXPECT_THAT(complaint("0,0,0,1,1,1\n0,0,zero,1,1,1\n"),
                HasSubstr(":2: column 3 is 'zero', not a number"));
    EXPECT_THAT(complaint("0,0,0,1,1\n"), HasSubstr(":1: 5 columns, expected 6: min_x,min_y,"));
    EXPECT_THAT(complaint("0,0,0,1,1,inf\n"), HasSubstr(":1: coordinates must be numbers"));
    EXPECT_THAT(complaint("0,2,0,1,1,1\n"), HasSubstr(":1: min 2 is above max 1"));
    EXPECT_THAT(complaint("# nothing\n"), HasSubstr("it holds no rows of min_x,"));
}

TEST(ReadFile, GivesAllBytesOrSaysWhyNot) {
    std::string bytes(3'000'001, 'x');
    bytes.push_back('\0');
    bytes += "\r\n";
    std::filesystem::path gone;
    {
        const FileOf file(bytes);
        EXPECT_EQ(read_file(file.path()), bytes);
        gone = file.path();
    }
    const auto why = [](const std::filesystem::path& file) {
        return complaint_of<BadInput>([&] { read_file(file, "URDF"); });
    };
    EXPECT_EQ(why(gone), "URDF " + gone.string() + ": no such file");
    EXPECT_THAT(why(gone.parent_path()), HasSubstr(": is a folder"));
    EXPECT_THAT(why("/proc/self/mem"), HasSubstr(": cannot be read: "));
}

} // namespace
} // namespace boxwood
