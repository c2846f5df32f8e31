#include "bench/io/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

TEST(Eta, CorrectsWhatWasExpectedByWhatItTook) {
    Eta eta(10);
    EXPECT_EQ(eta.fraction(), 0);
    EXPECT_EQ(eta.left_s(0), 10);
    eta.done(2);
    EXPECT_DOUBLE_EQ(eta.fraction(), 0.2);
    EXPECT_DOUBLE_EQ(eta.left_s(4), 16); // twice as slow as expected
    eta.done(100);                       // a round that was run again
    EXPECT_EQ(eta.fraction(), 1);
    EXPECT_EQ(eta.left_s(50), 0);
    EXPECT_EQ(Eta(0).fraction(), 0);
}

TEST(Duration, IsWrittenForPeople) {
    EXPECT_EQ(duration_text(-1), "0 s");
    EXPECT_EQ(duration_text(44.2), "45 s");
    EXPECT_EQ(duration_text(200), "3 min 20 s");
    EXPECT_EQ(duration_text(7500), "2 h 5 min");
}

TEST(Bar, ShowsStageTimeLeftAndCellWithinTheWidth) {
    const Moment moment{"round 3/9", 0.5, 61, "uniform/n10-s1/pairs/a/f32/serial-1"};
    EXPECT_EQ(bar_line(moment, 200), "[##########..........]  50 %  round 3/9  1 min 1 s left  "
                                     "uniform/n10-s1/pairs/a/f32/serial-1");
    EXPECT_EQ(bar_line(moment, 30).size(), 30u);
    EXPECT_THAT(bar_line({"preparing", 2, -1, "c"}, 200),
                testing::HasSubstr("[####################] 100 %  preparing  c"));
}

TEST(Progress, SaysNowAndThenInALogHowFarItIs) {
    EXPECT_EQ(log_line({"checking", 0.256, 61, "slivers"}),
              "checking: 26 %, 1 min 1 s left, slivers");
    EXPECT_EQ(log_line({"checking", 1.5, -1, ""}), "checking: 100 %");
    std::FILE* file = std::tmpfile();
    ASSERT_TRUE(file);
    Progress(file, std::chrono::seconds(0)).show({"checking", 0.5, 2, "slivers"});
    Progress(file).show({"checking", 0.6, 2, "slivers"}); // not yet
    std::rewind(file);
    char text[100] = {};
    EXPECT_GT(std::fread(text, 1, sizeof text - 1, file), 0u);
    EXPECT_STREQ(text, "checking: 50 %, 2 s left, slivers\n");
    std::fclose(file);
}

TEST(Progress, WritesOnlyWholeLinesToAFile) {
    std::FILE* file = std::tmpfile();
    ASSERT_TRUE(file);
    {
        Progress progress(file);
        EXPECT_FALSE(progress.is_terminal());
        progress.show({"round 1/9", 0.1, 5, "c"});
        progress.say("round 1 of 9 done");
        progress.show({"round 2/9", 0.2, 4, "c"});
    }
    std::rewind(file);
    char text[100] = {};
    EXPECT_EQ(std::fread(text, 1, sizeof text, file), 18u);
    EXPECT_STREQ(text, "round 1 of 9 done\n");
    std::fclose(file);
}

} // namespace
} // namespace boxwood::bench
