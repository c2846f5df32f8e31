#include "bench/io/write_file.h"

#include "bench/io/bad_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class WriteFile : public testing::Test {
  protected:
    WriteFile() { fs::create_directories(folder_); }
    ~WriteFile() override { fs::remove_all(folder_); }

    std::string in_folder(const char* name) const { return (folder_ / name).string(); }
    static std::string read(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string complaint(const std::string& name) {
        try {
            write_file(name, "new content", "--out " + name);
        } catch (const BadInput& error) {
            return error.what();
        }
        return "no error";
    }

    fs::path folder_ = fs::temp_directory_path() / fmt::format("boxwood-write-{}", ::getpid());
};

TEST_F(WriteFile, ReplacesTheContentAndNothingElse) {
    const std::string file = in_folder("plain");
    write_file(file, "old", "it");
    EXPECT_EQ(read(file), "old");
    const fs::perms mine = fs::perms::owner_read | fs::perms::owner_write;
    fs::permissions(file, mine);
    fs::create_hard_link(file, in_folder("same"));
    for (const char* text : {"longer than it was", "new"}) {
        write_file(file, text, "it");
        EXPECT_EQ(read(file), text);
        EXPECT_EQ(read(in_folder("same")), text);
    }
    EXPECT_EQ(fs::status(file).permissions(), mine);
    EXPECT_EQ(files(), 2u);
}

TEST_F(WriteFile, GoesWhereALinkLeads) {
    fs::create_directory(folder_ / "deep");
    fs::create_symlink("deep/there", in_folder("link"));
    fs::create_symlink("link", in_folder("second"));
    for (const char* text : {"made", "replaced"}) {
        write_file(in_folder("second"), text, "it");
        EXPECT_EQ(read(folder_ / "deep" / "there"), text);
    }
    EXPECT_TRUE(fs::is_symlink(in_folder("link")) && fs::is_symlink(in_folder("second")));
    EXPECT_FALSE(fs::is_symlink(folder_ / "deep" / "there"));
}

TEST_F(WriteFile, WritesIntoAPipe) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    write_file(fmt::format("/proc/self/fd/{}", ends[1]), "through", "it");
    std::array<char, 16> got{};
    EXPECT_EQ(::read(ends[0], got.data(), got.size()), 7);
    EXPECT_STREQ(got.data(), "through");
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_F(WriteFile, SaysWhyItCannotAndLosesNothing) {
    EXPECT_THAT(complaint(in_folder("none/file")), HasSubstr("cannot be written: No such file"));
    fs::create_symlink("/dev/full", in_folder("full"));
    EXPECT_THAT(complaint(in_folder("full")),
                HasSubstr("--out " + in_folder("full") + ": cannot be written: No space left"));
    EXPECT_TRUE(fs::is_symlink(in_folder("full")));
    fs::create_symlink("circle", in_folder("circle"));
    EXPECT_THAT(complaint(in_folder("circle")), HasSubstr("symbolic links"));
    EXPECT_THAT(complaint(folder_.string()), HasSubstr("Is a directory"));
    EXPECT_EQ(files(), 2u);
}

TEST_F(WriteFile, AFullDiskLeavesWhatWasThere) {
    const std::string file = in_folder("kept");
    write_file(file, "old", "it");
    fs::create_symlink("none", in_folder("link"));
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit few{4, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &few), 0);
    const std::string of_old = complaint(file), of_none = complaint(in_folder("link"));
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, ignored);
    EXPECT_THAT(of_old, HasSubstr("cannot be written: File too large"));
    EXPECT_THAT(of_none, HasSubstr("cannot be written: File too large"));
    EXPECT_EQ(read(file), "old");
    EXPECT_EQ(files(), 2u); // and the link
}

/// A file that is opened then has the number of the output.
TEST_F(WriteFile, TakesNoFileForAnOutputThatIsClosed) {
    const std::string file = in_folder("file");
    for (const int output : {STDOUT_FILENO, STDERR_FILENO}) {
        write_file(file, "longer than it will be", "it");
        std::cout << std::flush;
        const int kept = ::dup(output);
        ::close(output);
        std::cout << "printed";
        write_file(file, "content", "it");
        EXPECT_EQ(::fcntl(output, F_GETFD), -1);
        ::dup2(kept, output);
        ::close(kept);
        EXPECT_EQ(read(file), "content");
    }
    std::cout << std::endl;
}

TEST_F(WriteFile, FollowsWhatWasPrintedWhereItIsTheOutput) {
    const std::string file = in_folder("output");
    const int kept = ::dup(STDOUT_FILENO);
    const int out = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    std::cout.flush();
    ::dup2(out, STDOUT_FILENO);
    std::cout << "before, ";
    write_file("/dev/stdout", "content", "it");
    std::cout << ", after" << std::flush;
    ::dup2(kept, STDOUT_FILENO);
    ::close(kept);
    ::close(out);
    EXPECT_EQ(read(file), "before, content, after");
}

} // namespace
} // namespace boxwood::bench
