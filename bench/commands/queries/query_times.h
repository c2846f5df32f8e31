#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace boxwood::bench {

/// What a query took: to read its files, to build its trees and to answer. Nothing is repeated
/// unless times are wanted: then an answer is computed again, as often as fits in a fifth of a
/// second, as one run in a cold process says little of a question that takes microseconds.
class QueryTimes {
  public:
    explicit QueryTimes(bool are_wanted = false) : are_wanted_(are_wanted) {}

    template <class F> auto reading(const F& f) { return added_to(read_s_, f); }
    template <class F> auto building(const F& f) { return added_to(build_s_, f); }
    /// f(), which may be called again. share: of that fifth of a second, where there are several
    /// questions.
    template <class F> auto answering(const F& f, double share = 1) {
        const Clock::time_point start = Clock::now();
        auto answer = f();
        if (are_wanted_)
            repeat(seconds_since(start), share, [&] { f(); });
        return answer;
    }

    double read_s() const { return read_s_; }
    double build_s() const { return build_s_; }
    double first_query_s() const { return first_s_; } ///< of the first question
    double query_s() const;                           ///< the median of all runs but that one
    std::size_t runs() const { return runs_; }        ///< of which it is the median

    /// ",\"read_seconds\":..." to go before the end of an object; nothing unless wanted.
    std::string json() const;
    /// A line on stderr, if wanted.
    void report() const;

  private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    template <class F> static auto added_to(double& seconds, const F& f) {
        struct Adding {
            double& seconds;
            Clock::time_point start = Clock::now();
            ~Adding() { seconds += seconds_since(start); }
        } adding{seconds};
        return f();
    }
    void repeat(double first_s, double share, const std::function<void()>& question);

    bool are_wanted_;
    double read_s_ = 0, build_s_ = 0, first_s_ = -1;
    std::size_t runs_ = 0;
    std::vector<double> samples_;
};

/// The option --times.
void add_times_option(CLI::App& app, bool& are_wanted);

} // namespace boxwood::bench
