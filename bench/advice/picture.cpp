#include "bench/advice/advice.h"

#include "bench/io/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace boxwood::bench {
namespace {

constexpr double width = 720, height = 440, left = 84, right = 24, top = 48, bottom = 56;

/// A logarithmic axis over what is shown.
class Axis {
  public:
    Axis(double pixel_lo, double pixel_hi) : pixel_lo_(pixel_lo), pixel_hi_(pixel_hi) {}
    void show(double ns) {
        if (std::isfinite(ns) && ns > 0) {
            lo_ = std::min(lo_, ns);
            hi_ = std::max(hi_, ns);
        }
    }
    /// Some room on both sides, and a factor of two at least.
    void close() {
        const double room = std::max(1.08, std::sqrt(2 * lo_ / hi_));
        lo_ /= room;
        hi_ *= room;
    }
    double at(double ns) const {
        return pixel_lo_ + (pixel_hi_ - pixel_lo_) * std::log(ns / lo_) / std::log(hi_ / lo_);
    }
    /// 1, 2 and 5 times powers of ten within it; where these are few, more.
    std::vector<double> ticks() const {
        for (const std::vector<double>& digits :
             {std::vector<double>{1, 2, 5},
              {1, 1.5, 2, 3, 4, 5, 6, 8},
              {1, 1.2, 1.4, 1.6, 1.8, 2,   2.5, 3,   3.5, 4,  4.5,
               5, 5.5, 6,   6.5, 7,   7.5, 8,   8.5, 9,   9.5}})
            if (std::vector<double> all = of_digits(digits); all.size() > 2)
                return all;
        return {lo_ * 1.01, hi_ / 1.01};
    }

  private:
    std::vector<double> of_digits(const std::vector<double>& digits) const {
        std::vector<double> all;
        for (double power = 1e-3; power < 1e14; power *= 10)
            for (const double digit : digits)
                if (digit * power >= lo_ && digit * power <= hi_)
                    all.push_back(digit * power);
        return all;
    }

    double pixel_lo_, pixel_hi_, lo_ = 1e300, hi_ = 0;
};

std::string tick_text(double ns) {
    return ns < 1e3   ? fmt::format("{:.3g} ns", ns)
           : ns < 1e6 ? fmt::format("{:.3g} us", ns / 1e3)
           : ns < 1e9 ? fmt::format("{:.3g} ms", ns / 1e6)
                      : fmt::format("{:.3g} s", ns / 1e9);
}

class Picture {
  public:
    explicit Picture(const Advice& advice)
        : advice_(advice), build_(left, width - right), query_(height - bottom, top) {
        const auto show = [&](const Way& way) {
            for (const double ns : {way.build.lo, way.build.mid, way.build.hi})
                build_.show(ns);
            for (const double ns : {way.query.lo, way.query.mid, way.query.hi})
                query_.show(each(ns));
        };
        std::ranges::for_each(advice.ways, show);
        if (advice.rival)
            show(*advice.rival);
        build_.close();
        query_.close();
    }

    std::string svg() {
        axes();
        std::string line;
        for (const std::size_t i : advice_.front) {
            const Way& way = advice_.ways[i];
            line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L",
                                build_.at(way.build_ns), query_.at(each(way.query_ns)));
        }
        body_ += fmt::format("<path d=\"{}\" class=\"front\"/>\n", line);
        for (std::size_t i = 0; i < advice_.ways.size(); ++i)
            if (!is_on_front(i))
                point(advice_.ways[i], "way");
        if (advice_.rival)
            point(*advice_.rival, "rival");
        for (const std::size_t i : advice_.front)
            point(advice_.ways[i], "chosen");
        for (const Way& way : advice_.ways)
            taken_.push_back({build_.at(way.build_ns) - 6, query_.at(each(way.query_ns)), 12});
        if (advice_.rival)
            taken_.push_back({build_.at(advice_.rival->build_ns) - 6,
                              query_.at(each(advice_.rival->query_ns)), 12});
        for (const std::size_t i : advice_.front)
            label(advice_.ways[i]);
        if (advice_.rival)
            label(*advice_.rival);
        return head() + body_ + "</svg>\n";
    }

  private:
    double each(double ns) const { return ns / advice_.n_queries; }
    bool is_on_front(std::size_t i) const {
        return std::ranges::find(advice_.front, i) != advice_.front.end();
    }

    std::string head() const {
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
            "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
            "<title>{2}: time to build against time to query, {3} ways of ours</title>\n"
            "<style>:root{{color-scheme:light "
            "dark}}text{{fill:#222;paint-order:stroke;stroke:#fff;stroke-width:3px}}.page{{fill:#"
            "fff}}"
            ".grid{{stroke:#ddd}}.lead{{stroke:#999;stroke-width:.7}}.front{{stroke:#0b63b5;stroke-"
            "width:2;fill:none}}"
            ".chosen{{fill:#0b63b5;stroke:#0b63b5}}.way{{fill:#8a8a8a;stroke:#8a8a8a}}"
            ".rival{{fill:#b5480b;stroke:#b5480b}}"
            "@media(prefers-color-scheme:dark){{text{{fill:#ddd;stroke:#181818}}.page{{fill:#"
            "181818}}"
            ".grid{{stroke:#3a3a3a}}.front{{stroke:#6ab0f3}}.chosen{{fill:#6ab0f3;stroke:#6ab0f3}}"
            ".rival{{fill:#f0935a;stroke:#f0935a}}}}</style>\n"
            "<rect width=\"100%\" height=\"100%\" class=\"page\"/>\n"
            "<text x=\"{4:.0f}\" y=\"22\" font-weight=\"bold\">{2}</text>\n"
            "<text x=\"{4:.0f}\" y=\"39\" font-size=\"12\">blue: what to take, by {5} per build; "
            "grey: ours; orange: the best peer; lower left is better; bars: 95 %</text>\n",
            width, height, escaped(advice_.scene), advice_.ways.size(), left, advice_.query_word);
    }

    void axes() {
        for (const double ns : build_.ticks())
            body_ += fmt::format("<path d=\"M{0:.1f} {1:.0f}V{2:.0f}\" class=\"grid\"/><text "
                                 "x=\"{0:.1f}\" y=\"{3:.0f}\" text-anchor=\"middle\">{4}</text>\n",
                                 build_.at(ns), top, height - bottom, height - bottom + 18,
                                 tick_text(ns));
        for (const double ns : query_.ticks())
            body_ += fmt::format("<path d=\"M{0:.0f} {1:.1f}H{2:.0f}\" class=\"grid\"/><text "
                                 "x=\"{3:.0f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                                 left, query_.at(ns), width - right, left - 8, query_.at(ns) + 4,
                                 tick_text(ns));
        body_ += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">time to build"
                             "</text>\n<text transform=\"translate(16 {:.0f}) rotate(-90)\" "
                             "text-anchor=\"middle\">time of {}</text>\n",
                             (left + width - right) / 2, height - 14, (top + height - bottom) / 2,
                             advice_.n_queries > 1 ? "each query" : "a query");
    }

    void point(const Way& way, std::string_view kind) {
        const double x = build_.at(way.build_ns), y = query_.at(each(way.query_ns));
        if (!std::isnan(way.build.lo))
            body_ += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"{}\"/>",
                                 build_.at(way.build.lo), y, build_.at(way.build.hi), kind);
        if (!std::isnan(way.query.lo))
            body_ +=
                fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" class=\"{}\"/>", x,
                            query_.at(each(way.query.lo)), query_.at(each(way.query.hi)), kind);
        body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" class=\"{}\"><title>{}"
                             "</title></circle>\n",
                             x, y, kind, escaped(way.name));
    }

    /// Near its point, at the nearest place that is taken by no other label and no point, else at
    /// one without labels; a line leads there.
    void label(const Way& way) {
        const double x = build_.at(way.build_ns), y = query_.at(each(way.query_ns));
        const double wide = 7.2 * static_cast<double>(way.name.size());
        const auto is_free = [&](const Taken& place, const std::vector<Taken>& others) {
            return std::ranges::none_of(others, [&](const Taken& other) {
                return std::abs(other.y - place.y) < 14 && place.x < other.x + other.wide &&
                       other.x < place.x + place.wide;
            });
        };
        std::optional<Taken> best;
        double best_far = 0;
        bool is_best_free = false;
        for (double up = -160; up <= 160; up += 8)
            for (const double from : {x + 10, x - 10 - wide, x - wide / 2}) {
                const Taken place{from, y + up, wide};
                if (from < left + 2 || from + wide > width - right || place.y < top + 10 ||
                    place.y > height - bottom - 8 || !is_free(place, labels_))
                    continue;
                const bool is_clear = is_free(place, taken_);
                const double far = std::abs(up) + (from == x - wide / 2 ? 4 : 0);
                if (!best || std::pair(!is_clear, far) < std::pair(!is_best_free, best_far)) {
                    best = place;
                    best_far = far;
                    is_best_free = is_clear;
                }
            }
        if (!best)
            return; // its point still has its name as a title
        labels_.push_back(*best);
        if (best_far > 20)
            body_ += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" class=\"lead\"/>\n", x,
                                 y, std::clamp(x, best->x, best->x + wide), best->y);
        body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", best->x, best->y + 4,
                             escaped(way.name));
    }

    /// What a text or a point takes: from x on, around y.
    struct Taken {
        double x, y, wide;
    };
    const Advice& advice_;
    Axis build_, query_;
    std::string body_;
    std::vector<Taken> labels_, taken_;
};

} // namespace

std::string advice_picture(const Advice& advice) { return Picture(advice).svg(); }

} // namespace boxwood::bench
