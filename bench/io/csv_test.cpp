#include "bench/io/csv.h"

#include "scenes/text/testing/file_of.h"

#include <gtest/gtest.h>

#include <string>

namespace boxwood::bench {
namespace {

TEST(CsvInput, AFileWithoutRowsIsAWarning) {
    const auto warning_of = [](const FileOf& file) {
        ::testing::internal::CaptureStderr();
        read_csv_input(file.path().string(), {"a,b", 2, 2},
                       [](std::span<const double>, std::size_t) {});
        return ::testing::internal::GetCapturedStderr();
    };
    const FileOf comment("# only a comment\n"), row("1,2\n");
    EXPECT_EQ(warning_of(comment),
              "boxwood: warning: " + comment.path().string() + " holds no rows of a,b\n");
    EXPECT_EQ(warning_of(row), "");
}

} // namespace
} // namespace boxwood::bench
