#include "bench/running/isolated.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>

namespace boxwood::bench {
namespace {

/// Everything of an outcome, list by list: a length, then the elements' bytes.
template <class Body> void for_each_list(Outcome& outcome, const Body& body) {
    body(outcome.answers.pairs);
    body(outcome.answers.hits);
    body(outcome.answers.verdicts);
    body(outcome.answers.distances);
    body(outcome.answers.impacts);
    body(outcome.answers.boxes);
    body(outcome.failure);
}

std::string bytes_of(Outcome& outcome) {
    std::string bytes(reinterpret_cast<const char*>(&outcome.ns), sizeof outcome.ns);
    for_each_list(outcome, [&]<class List>(List& list) {
        static_assert(std::is_trivially_copyable_v<typename List::value_type>);
        const std::size_t n = list.size();
        bytes.append(reinterpret_cast<const char*>(&n), sizeof n);
        bytes.append(reinterpret_cast<const char*>(list.data()),
                     n * sizeof(typename List::value_type));
    });
    return bytes;
}

/// The inverse; false if bytes are missing.
bool read_bytes(std::string_view bytes, Outcome& outcome) {
    const auto take = [&](void* to, std::size_t n) {
        if (n > bytes.size())
            return false;
        if (n > 0)
            std::memcpy(to, bytes.data(), n);
        bytes.remove_prefix(n);
        return true;
    };
    bool good = take(&outcome.ns, sizeof outcome.ns);
    for_each_list(outcome, [&]<class List>(List& list) {
        std::size_t n = 0;
        good = good && take(&n, sizeof n) && n <= bytes.size();
        if (good)
            list.resize(n);
        good = good && take(list.data(), n * sizeof(typename List::value_type));
    });
    return good;
}

[[noreturn]] void be_child(int pipe, const std::function<void(Outcome&)>& work) {
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    for (const int fatal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL})
        std::signal(fatal, SIG_DFL);
    Outcome outcome;
    try {
        work(outcome);
    } catch (const std::exception& error) {
        outcome = {};
        outcome.failure = fmt::format("threw: {:.500}", error.what());
    }
    const std::string bytes = bytes_of(outcome);
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t written = write(pipe, bytes.data() + done, bytes.size() - done);
        if (written < 0 && errno != EINTR)
            _exit(1);
        done += static_cast<std::size_t>(std::max<ssize_t>(0, written));
    }
    _exit(0);
}

/// All that comes until the other end is closed; false if that takes too long.
bool read_all(int pipe, int timeout_s, std::string& bytes) {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::seconds(timeout_s);
    std::array<char, 1 << 16> block;
    while (true) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        pollfd waiting{pipe, POLLIN, 0};
        const int ready = left > 0 ? poll(&waiting, 1, static_cast<int>(left)) : 0;
        if (ready == 0)
            return false;
        if (ready < 0 && errno == EINTR)
            continue;
        const ssize_t got = read(pipe, block.data(), block.size());
        if (got == 0)
            return true;
        if (got > 0)
            bytes.append(block.data(), static_cast<std::size_t>(got));
    }
}

} // namespace

Outcome isolated(const std::function<void(Outcome&)>& work, int timeout_s) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    const pid_t child = fork();
    if (child < 0) {
        const int why = errno;
        close(ends[0]);
        close(ends[1]);
        throw std::system_error(why, std::generic_category(), "fork");
    }
    if (child == 0) {
        close(ends[0]);
        be_child(ends[1], work);
    }
    close(ends[1]);
    std::string bytes;
    const bool in_time = read_all(ends[0], timeout_s, bytes);
    close(ends[0]);
    if (!in_time)
        kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    Outcome outcome;
    if (!in_time)
        outcome.failure = fmt::format("hung: no answer within {} s", timeout_s);
    else if (WIFSIGNALED(status))
        outcome.failure =
            fmt::format("crashed: signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    else if (WEXITSTATUS(status) != 0 || !read_bytes(bytes, outcome))
        outcome.failure = fmt::format("crashed: exit code {}", WEXITSTATUS(status));
    return outcome;
}

} // namespace boxwood::bench
