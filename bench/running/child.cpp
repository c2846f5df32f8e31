#include "bench/running/child.h"

#include "bench/io/bad_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

namespace boxwood::bench {
namespace {

constexpr const char* padding_variable = "BOXWOOD_PADDING";

/// libgomp's threads spin for milliseconds after a region unless set not to; google-benchmark
/// reads BENCHMARK_* variables as if they were options.
std::vector<std::string> child_environment(unsigned max_threads, std::size_t padding) {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable) {
        const std::string_view text = *variable;
        if (!text.starts_with("OMP_") && !text.starts_with("GOMP_") &&
            !text.starts_with("BENCHMARK_") && !text.starts_with("GLIBC_TUNABLES="))
            variables.emplace_back(text);
    }
    variables.push_back("OMP_WAIT_POLICY=passive");
    variables.push_back("OMP_DYNAMIC=false");
    variables.push_back(fmt::format("OMP_NUM_THREADS={}", max_threads));
    variables.push_back("GLIBC_TUNABLES=glibc.malloc.hugetlb=1");
    variables.push_back(fmt::format("{}={}", padding_variable, std::string(padding, 'x')));
    return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    pointers.reserve(texts.size() + 1);
    for (std::string& text : texts)
        pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// Lines that a ChildReport wrote.
class Conversation {
  public:
    Conversation(const Report& report, ChildEnd& end) : report_(report), end_(end) {}

    void take(std::string_view bytes) {
        pending_ += bytes;
        for (std::size_t line; (line = pending_.find('\n')) != std::string::npos;) {
            read_line(pending_.substr(0, line));
            pending_.erase(0, line + 1);
        }
    }

  private:
    void read_line(const std::string& line) {
        std::istringstream words(line);
        std::string word, text;
        words >> word;
        if (word == "at") {
            std::size_t done = 0, total = 0;
            words >> done >> total >> end_.cell;
            report_(done, total, end_.cell);
            return;
        }
        words.ignore(1);
        std::getline(words, text);
        if (word == "finishing")
            end_.cell.clear();
        else
            end_.cause = text;
        if (word == "failed")
            end_.kind = ChildEnd::Kind::failed;
        if (word == "threw")
            end_.kind = ChildEnd::Kind::crashed;
    }

    const Report& report_;
    ChildEnd& end_;
    std::string pending_;
};

enum class Heard : std::uint8_t { all, interrupt, silence };

/// Until the child closes its end of the pipe, by exit at the latest.
Heard listen(int pipe, Interrupt& interrupt, Conversation& conversation, double silence_s) {
    using Clock = std::chrono::steady_clock;
    const std::chrono::duration<double> silence(silence_s);
    Clock::time_point last = Clock::now();
    std::array<char, 4096> bytes;
    std::array<pollfd, 2> waiting{pollfd{pipe, POLLIN, 0},
                                  pollfd{interrupt.descriptor(), POLLIN, 0}};
    while (true) {
        const std::chrono::duration<double, std::milli> left = silence - (Clock::now() - last);
        const int ready = poll(waiting.data(), waiting.size(),
                               static_cast<int>(std::clamp(left.count() + 1, 0., 1e9)));
        if (ready < 0 && errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "poll");
        if (interrupt.requested())
            return Heard::interrupt;
        if (ready == 0 && left.count() <= 0)
            return Heard::silence;
        if (waiting[0].revents == 0)
            continue;
        last = Clock::now();
        const ssize_t got = read(pipe, bytes.data(), bytes.size());
        if (got > 0)
            conversation.take({bytes.data(), static_cast<std::size_t>(got)});
        else if (got == 0 || errno != EINTR)
            return Heard::all;
    }
}

/// Only the parent answers Ctrl-C, which goes to the whole group.
void ignore_ctrl_c() { signal(SIGINT, SIG_IGN); }

/// `at_end_of_parent`: the signal that the child then gets.
[[noreturn]] void become_child(pid_t parent, int at_end_of_parent, const sigset_t& mask,
                               const char* program, char* const* arguments,
                               char* const* variables) {
    prctl(PR_SET_PDEATHSIG, at_end_of_parent);
    if (getppid() != parent) // it died before the line above
        _exit(127);
    pthread_sigmask(SIG_SETMASK, &mask, nullptr);
    execvpe(program, arguments, variables);
    _exit(127);
}

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

/// Empty for an exit with 0.
std::string cause_of(int status) {
    if (WIFSIGNALED(status))
        return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit code {}", WEXITSTATUS(status));
}

} // namespace

ChildEnd run_child(std::vector<std::string> arguments, unsigned max_threads, std::size_t padding,
                   Interrupt& interrupt, const Report& report, double silence_s,
                   const char* program) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    arguments.insert(arguments.end(), {"--report-fd", std::to_string(ends[1])});
    std::vector<std::string> variables = child_environment(max_threads, padding);
    const std::vector<char*> argument_pointers = pointers_to(arguments);
    const std::vector<char*> variable_pointers = pointers_to(variables);

    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        fcntl(ends[1], F_SETFD, 0); // the one descriptor that outlives exec
        ignore_ctrl_c();
        become_child(parent, SIGKILL, interrupt.mask_before(), program, argument_pointers.data(),
                     variable_pointers.data());
    }
    close(ends[1]);

    ChildEnd end;
    Conversation conversation(report, end);
    const Heard heard = listen(ends[0], interrupt, conversation, silence_s);
    if (heard != Heard::all)
        kill(child, SIGKILL);
    close(ends[0]);
    const int status = wait_for(child);
    const std::string cause = cause_of(status);
    if (heard == Heard::interrupt || interrupt.requested()) {
        end.kind = ChildEnd::Kind::interrupted;
    } else if (heard == Heard::silence) {
        end.kind = ChildEnd::Kind::hung;
        end.cause = fmt::format("no sign of life for {:g} s", silence_s);
    } else if (WIFSIGNALED(status) || (!cause.empty() && end.kind == ChildEnd::Kind::done)) {
        end.kind = ChildEnd::Kind::crashed;
        end.cause = cause;
    }
    return end;
}

std::string output_of_child(std::vector<std::string> arguments) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    const std::vector<char*> pointers = pointers_to(arguments);
    sigset_t mask;
    pthread_sigmask(SIG_SETMASK, nullptr, &mask);
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        ignore_ctrl_c();
        become_child(parent, SIGKILL, mask, own_program, pointers.data(), environ);
    }
    close(ends[1]);
    std::string output;
    std::array<char, 4096> bytes;
    for (ssize_t got; (got = read(ends[0], bytes.data(), bytes.size())) != 0;) {
        if (got < 0 && errno != EINTR)
            break;
        output.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    }
    close(ends[0]);
    const std::string cause = cause_of(wait_for(child));
    if (!cause.empty())
        throw std::runtime_error(
            fmt::format("a process of its own ended by {}: {}", cause, output));
    return output;
}

int run_logged(const std::filesystem::path& program, std::vector<std::string> arguments,
               const std::filesystem::path& log, Interrupt& interrupt) {
    const std::vector<char*> pointers = pointers_to(arguments);
    const std::filesystem::path executable = std::filesystem::absolute(program); // not of the PATH
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        become_child(parent, SIGTERM, interrupt.mask_before(), executable.c_str(), pointers.data(),
                     environ);
    }
    const int end_of_child = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
    std::array<pollfd, 2> waiting{pollfd{end_of_child, POLLIN, 0},
                                  pollfd{interrupt.descriptor(), POLLIN, 0}};
    while (poll(waiting.data(), waiting.size(), -1) < 0 && errno == EINTR) {
    }
    if (interrupt.requested())
        kill(child, SIGTERM);
    close(end_of_child);
    const int status = wait_for(child);
    if (interrupt.requested())
        return exit_interrupted;
    if (WIFEXITED(status))
        return WEXITSTATUS(status);
    throw BadInput(fmt::format("{} ended by signal {}; its words are in {}", program.string(),
                               WTERMSIG(status), log.string()));
}

std::size_t own_padding() {
    const char* const padding = std::getenv(padding_variable);
    return padding ? std::strlen(padding) : 0;
}

void ChildReport::at(std::size_t done, std::size_t total, const std::string& cell) {
    send("at", fmt::format("{} {} {}", done, total, cell));
}

/// A line is shorter than PIPE_BUF, so it arrives whole. If nobody listens the process ends by
/// SIGPIPE, as it should.
void ChildReport::send(const char* word, std::string text) {
    std::ranges::replace(text, '\n', ' ');
    const std::string line = fmt::format("{} {:.500}\n", word, text);
    while (write(descriptor_, line.data(), line.size()) < 0 && errno == EINTR) {
    }
}

} // namespace boxwood::bench
