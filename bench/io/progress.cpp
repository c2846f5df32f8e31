#include "bench/io/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {

double Eta::fraction() const { return total_s_ > 0 ? std::min(1.0, done_s_ / total_s_) : 0; }

double Eta::left_s(double elapsed_s) const {
    const double left = std::max(0.0, total_s_ - done_s_);
    return done_s_ > 0 ? left * elapsed_s / done_s_ : left;
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long long>(std::ceil(std::max(0.0, seconds)));
    if (whole < 60)
        return fmt::format("{} s", whole);
    if (whole < 3600)
        return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string bar_line(const Moment& moment, std::size_t width) {
    constexpr std::size_t cells = 20;
    const double fraction = std::clamp(moment.fraction, 0.0, 1.0);
    const auto full = static_cast<std::size_t>(fraction * cells);
    std::string line = fmt::format("[{:#>{}}{:.>{}}] {:3.0f} %  {}", "", full, "", cells - full,
                                   std::floor(100 * fraction), moment.stage);
    if (moment.left_s >= 0)
        line += fmt::format("  {} left", duration_text(moment.left_s));
    line += "  " + moment.cell;
    return line.substr(0, width);
}

std::string log_line(const Moment& moment) {
    std::string line =
        fmt::format("{}: {:.0f} %", moment.stage, 100 * std::clamp(moment.fraction, 0.0, 1.0));
    if (moment.left_s >= 0)
        line += fmt::format(", {} left", duration_text(moment.left_s));
    return moment.cell.empty() ? line : fmt::format("{}, {}", line, moment.cell);
}

Progress::Progress(std::FILE* out, std::chrono::seconds pause)
    : out_(out), is_terminal_(isatty(fileno(out)) == 1), pause_(pause) {}

void Progress::show(const Moment& moment) {
    if (!is_terminal_) {
        if (std::chrono::steady_clock::now() - said_ >= pause_)
            say(log_line(moment));
        return;
    }
    winsize size{};
    const bool known = ioctl(fileno(out_), TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    write("\r\x1b[K" + bar_line(moment, known ? size.ws_col - 1u : 79u));
    std::fflush(out_);
    drawn_ = true;
}

void Progress::say(const std::string& line) {
    clear();
    write(fmt::format("{}\n", line));
    std::fflush(out_);
    said_ = std::chrono::steady_clock::now();
}

void Progress::clear() {
    if (drawn_)
        write("\r\x1b[K");
    std::fflush(out_);
    drawn_ = false;
}

} // namespace boxwood::bench
