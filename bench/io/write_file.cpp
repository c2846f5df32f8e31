#include "bench/io/write_file.h"

#include "bench/io/bad_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <iostream>
#include <system_error>
#include <utility>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

void check(bool is_done, int why = errno) {
    if (!is_done)
        throw std::system_error(why, std::generic_category());
}

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) { check(fd >= 0); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0)
            ::close(fd_);
    }
    operator int() const { return fd_; }
    /// May tell what the disk did not take.
    void close() { check(::close(std::exchange(fd_, -1)) == 0); }

  private:
    int fd_;
};

/// An output of the program; before another file is opened, which gets the number of a closed one.
struct Output {
    int fd;
    struct stat status {};
    bool is_open;

    explicit Output(int number) : fd(number), is_open(::fstat(fd, &status) == 0) {}
    bool is(const struct stat& file) const {
        return is_open && status.st_dev == file.st_dev && status.st_ino == file.st_ino;
    }
};

void write_all(int fd, std::string_view content) {
    while (!content.empty()) {
        const ssize_t n = ::write(fd, content.data(), content.size());
        if (n < 0 && errno == EINTR)
            continue;
        check(n >= 0);
        content.remove_prefix(static_cast<std::size_t>(n));
    }
}

/// The room for it comes first, where the file system can say that there is some.
void replace_content(int fd, const struct stat& before, std::string_view content) {
    const auto size = static_cast<off_t>(content.size());
    int why = 0;
    do
        why = size == 0 || ::fallocate(fd, 0, 0, size) == 0 ? 0 : errno;
    while (why == EINTR);
    if (why != 0 && why != EOPNOTSUPP && why != ENOSYS) {
        check(::ftruncate(fd, before.st_size) == 0);
        check(false, why);
    }
    write_all(fd, content);
    check(::ftruncate(fd, size) == 0);
}

} // namespace

void write_file(const fs::path& name, std::string_view content, std::string_view what) try {
    const std::array outputs{Output(STDOUT_FILENO), Output(STDERR_FILENO)};
    const bool is_new = !fs::exists(name);
    try {
        Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
        struct stat found {};
        check(::fstat(file, &found) == 0);
        for (const Output& output : outputs)
            if (output.is(found)) {
                std::cout.flush();
                return write_all(output.fd, content);
            }
        if (S_ISREG(found.st_mode))
            replace_content(file, found, content);
        else
            write_all(file, content);
        file.close();
    } catch (const std::system_error&) {
        std::error_code ignored;
        if (is_new) // and where a link leads
            fs::remove(fs::canonical(name, ignored), ignored);
        throw;
    }
} catch (const std::system_error& error) {
    throw BadInput(fmt::format("{}: cannot be written: {}", what, error.code().message()));
}

} // namespace boxwood::bench
