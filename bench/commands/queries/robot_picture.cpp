#include "bench/commands/queries/robot_picture.h"

#include "bench/io/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

constexpr double width = 720, height = 340, left = 72, right = 20, top = 52, bottom = 48;

/// 1, 2 or 5 times a power of ten: about five to the whole.
double tick_of(double whole) {
    const double power = std::pow(10.0, std::floor(std::log10(whole / 5)));
    for (const double digit : {1., 2., 5.})
        if (whole / (digit * power) <= 6)
            return digit * power;
    return 10 * power;
}

class Picture {
  public:
    explicit Picture(const std::vector<LeastOfState>& states) : states_(states) {
        for (const LeastOfState& state : states)
            if (std::isfinite(state.least.hi))
                farthest_ = std::max(farthest_, state.least.hi);
        farthest_ = farthest_ > 0 ? 1.05 * farthest_ : 1;
        begin_ = states.front().time;
        end_ = std::max(states.back().time, begin_ + 1e-9);
    }

    std::string svg(const std::string& robot) {
        axes();
        collisions();
        band();
        line();
        const auto nearest = std::ranges::min_element(
            states_, {}, [](const LeastOfState& state) { return state.least.distance; });
        const auto n = std::ranges::count_if(states_, &LeastOfState::collides);
        return fmt::format(
                   "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
                   "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
                   "font-family=\"sans-serif\" font-size=\"13\">\n<title>{2}: least distance of "
                   "its links over time</title>\n<style>:root{{color-scheme:light dark}}"
                   "text{{fill:#222}}.page{{fill:#fff}}.grid{{stroke:#ddd}}"
                   ".hit{{fill:#b5480b;fill-opacity:.18}}.band{{fill:#0b63b5;fill-opacity:.3}}"
                   ".least{{stroke:#0b63b5;stroke-width:1.6;fill:none}}"
                   "@media(prefers-color-scheme:dark){{text{{fill:#ddd}}.page{{fill:#181818}}"
                   ".grid{{stroke:#3a3a3a}}.least{{stroke:#6ab0f3}}.band{{fill:#6ab0f3}}"
                   ".hit{{fill:#f0935a}}}}</style>\n"
                   "<rect width=\"100%\" height=\"100%\" class=\"page\"/>\n"
                   "<text x=\"{3:.0f}\" y=\"22\" font-weight=\"bold\">{2}: least distance of its "
                   "links</text>\n<text x=\"{3:.0f}\" y=\"40\" font-size=\"12\">{4} states; "
                   "nearest "
                   "{5:.4g} m at {6:.3g}; {7} collide (shaded); interval lo to hi as a "
                   "band</text>\n",
                   width, height, escaped(robot), left, states_.size(), nearest->least.distance,
                   nearest->time, n) +
               body_ + "</svg>\n";
    }

  private:
    double x(double time) const {
        return left + (width - left - right) * (time - begin_) / (end_ - begin_);
    }
    double y(double distance) const {
        return height - bottom -
               (height - top - bottom) * std::min(distance, farthest_) / farthest_;
    }

    void axes() {
        const double tick = tick_of(farthest_);
        for (double d = 0; d <= farthest_; d += tick)
            body_ += fmt::format("<path d=\"M{0:.0f} {1:.1f}H{2:.0f}\" class=\"grid\"/><text "
                                 "x=\"{3:.0f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g} m</text>\n",
                                 left, y(d), width - right, left - 8, y(d) + 4, d);
        const double step = std::max(1.0, tick_of(end_ - begin_));
        for (double t = begin_; t <= end_; t += step)
            body_ +=
                fmt::format("<path d=\"M{0:.1f} {1:.0f}V{2:.0f}\" class=\"grid\"/><text "
                            "x=\"{0:.1f}\" y=\"{3:.0f}\" text-anchor=\"middle\">{4:g}</text>\n",
                            x(t), top, height - bottom, height - bottom + 18, t);
        body_ += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">time, in "
                             "waypoints</text>\n",
                             (left + width - right) / 2, height - 10);
    }

    /// From half a step before to half a step behind each state that collides.
    void collisions() {
        for (std::size_t i = 0; i < states_.size(); ++i) {
            if (!states_[i].collides)
                continue;
            std::size_t last = i;
            while (last + 1 < states_.size() && states_[last + 1].collides)
                ++last;
            const auto half = [&](std::size_t a, std::size_t b) {
                return (states_[a].time + states_[b].time) / 2;
            };
            const double from = i == 0 ? states_[i].time : half(i - 1, i);
            const double to =
                last + 1 == states_.size() ? states_[last].time : half(last, last + 1);
            body_ +=
                fmt::format("<rect x=\"{:.1f}\" y=\"{:.0f}\" width=\"{:.1f}\" height=\"{:.0f}\" "
                            "class=\"hit\"/>\n",
                            x(from), top, std::max(1.0, x(to) - x(from)), height - top - bottom);
            i = last;
        }
    }

    void band() {
        std::string up, down;
        for (const LeastOfState& state : states_) {
            up += fmt::format("{}{:.1f} {:.1f}", up.empty() ? "M" : "L", x(state.time),
                              y(state.least.hi));
            down = fmt::format("L{:.1f} {:.1f}", x(state.time), y(state.least.lo)) + down;
        }
        body_ += fmt::format("<path d=\"{}{}Z\" class=\"band\"/>\n", up, down);
    }

    void line() {
        std::string path;
        for (const LeastOfState& state : states_)
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(state.time),
                                y(state.least.distance));
        body_ += fmt::format("<path d=\"{}\" class=\"least\"/>\n", path);
    }

    const std::vector<LeastOfState>& states_;
    double farthest_ = 0, begin_, end_;
    std::string body_;
};

} // namespace

std::string robot_picture(const std::string& robot, const std::vector<LeastOfState>& states) {
    return Picture(states).svg(robot);
}

} // namespace boxwood::bench
