#include "bench/running/isolated.h"

#include "bench/truth/crash.h"

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

/// What the child says: 'd' and the time and the answers, or 't' and why it threw.
std::string message_of(Answers& answers, const std::function<double(Answers&)>& work) {
    try {
        const double ns = work(answers);
        return "d" + std::string(reinterpret_cast<const char*>(&ns), sizeof ns) + answers.bytes();
    } catch (const std::exception& error) {
        return fmt::format("tthrew: {:.500}", error.what());
    }
}

/// The inverse; false if bytes are missing.
bool read_message(std::string_view message, Answers& answers, Outcome& outcome) {
    if (message.starts_with('t')) {
        outcome.failure = message.substr(1);
        return true;
    }
    if (!message.starts_with('d') || message.size() < 1 + sizeof outcome.ns)
        return false;
    std::memcpy(&outcome.ns, message.data() + 1, sizeof outcome.ns);
    answers.assign_bytes(message.substr(1 + sizeof outcome.ns));
    return true;
}

[[noreturn]] void be_child(int pipe, Answers& answers,
                           const std::function<double(Answers&)>& work) {
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    for (const int fatal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL})
        std::signal(fatal, SIG_DFL);
    const std::string bytes = message_of(answers, work);
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

Outcome isolated(Answers& answers, const std::function<double(Answers&)>& work, int timeout_s) {
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
        be_child(ends[1], answers, work);
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
        outcome.failure = crash_text(
            fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
    else if (WEXITSTATUS(status) != 0 || !read_message(bytes, answers, outcome))
        outcome.failure = crash_text(fmt::format("exit code {}", WEXITSTATUS(status)));
    return outcome;
}

} // namespace boxwood::bench
