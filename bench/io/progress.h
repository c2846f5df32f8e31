#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>

namespace boxwood::bench {

/// Called before each piece of work: how many are done, of how many, and the cell that comes next.
using Report = std::function<void(std::size_t done, std::size_t total, const std::string& cell)>;

/// The time left, from the expected cost of what is done and what is to come, corrected by how long
/// the former took.
class Eta {
  public:
    explicit Eta(double expected_s) : total_s_(expected_s) {}
    void done(double expected_s) { done_s_ += expected_s; }
    double fraction() const;
    double left_s(double elapsed_s) const;

  private:
    double total_s_, done_s_ = 0;
};

/// "45 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

/// What the bar says.
struct Moment {
    std::string stage; ///< "preparing", "round 3/9"
    double fraction = 0;
    double left_s = -1; ///< negative: not known yet
    std::string cell;
};

/// One line of at most `width` columns, cut at the end of the cell's name.
std::string bar_line(const Moment& moment, std::size_t width);

/// The same for a log: "preparing: 12 %, 45 s left, uniform/n1000".
std::string log_line(const Moment& moment);

/// A bar on a terminal. On anything else what `say` is given, and a line for a log after each
/// `pause` without one.
class Progress {
  public:
    explicit Progress(std::FILE* out, std::chrono::seconds pause = std::chrono::seconds(30));
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;

    void show(const Moment& moment);
    /// A line that stays.
    void say(const std::string& line);
    bool is_terminal() const { return is_terminal_; }

  private:
    void clear();
    /// A full or closed file loses the text and nothing else.
    void write(const std::string& text) { std::fputs(text.c_str(), out_); }

    std::FILE* out_;
    bool is_terminal_, drawn_ = false;
    std::chrono::seconds pause_;
    std::chrono::steady_clock::time_point said_ = std::chrono::steady_clock::now();
};

} // namespace boxwood::bench
