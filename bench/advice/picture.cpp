#include "bench/advice/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

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
    /// 1, 2 and 5 times powers of ten within it.
    std::vector<double> ticks() const {
        std::vector<double> all;
        for (double power = 1e-3; power < 1e14; power *= 10)
            for (const double digit : {1., 2., 5.})
                if (digit * power >= lo_ && digit * power <= hi_)
                    all.push_back(digit * power);
        return all;
    }

  private:
    double pixel_lo_, pixel_hi_, lo_ = 1e300, hi_ = 0;
};

std::string tick_text(double ns) {
    return ns < 1e3   ? fmt::format("{:g} ns", ns)
           : ns < 1e6 ? fmt::format("{:g} us", ns / 1e3)
           : ns < 1e9 ? fmt::format("{:g} ms", ns / 1e6)
                      : fmt::format("{:g} s", ns / 1e9);
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return out;
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
            ".grid{{stroke:#ddd}}.front{{stroke:#0b63b5;stroke-width:2;fill:none}}"
            ".chosen{{fill:#0b63b5;stroke:#0b63b5}}.way{{fill:#8a8a8a;stroke:#8a8a8a}}"
            ".rival{{fill:#b5480b;stroke:#b5480b}}"
            "@media(prefers-color-scheme:dark){{text{{fill:#ddd;stroke:#181818}}.page{{fill:#"
            "181818}}"
            ".grid{{stroke:#3a3a3a}}.front{{stroke:#6ab0f3}}.chosen{{fill:#6ab0f3;stroke:#6ab0f3}}"
            ".rival{{fill:#f0935a;stroke:#f0935a}}}}</style>\n"
            "<rect width=\"100%\" height=\"100%\" class=\"page\"/>\n"
            "<text x=\"{4:.0f}\" y=\"22\" font-weight=\"bold\">{2}</text>\n"
            "<text x=\"{4:.0f}\" y=\"39\" font-size=\"12\">joined: what to take, by {5} per build; "
            "lines: 95 % intervals; further down and further left is better</text>\n",
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

    /// Beside its point, at the first place where no other label is.
    void label(const Way& way) {
        const double x = build_.at(way.build_ns), y = query_.at(each(way.query_ns));
        const double wide = 7.2 * static_cast<double>(way.name.size());
        const bool to_the_left = x + 10 + wide > width - right;
        const double from = to_the_left ? x - 10 - wide : x + 10;
        double at = y - 8;
        for (int tries = 0; tries < 12; ++tries, at += (tries % 2 ? 16 : -16) * tries)
            if (at > top + 10 && at < height - bottom - 4 &&
                std::ranges::none_of(labels_, [&](const Label& other) {
                    return std::abs(other.y - at) < 15 && from < other.x + other.wide &&
                           other.x < from + wide;
                }))
                break;
        labels_.push_back({from, at, wide});
        body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                             to_the_left ? x - 10 : x + 10, at, to_the_left ? "end" : "start",
                             escaped(way.name));
    }

    struct Label {
        double x, y, wide;
    };
    const Advice& advice_;
    Axis build_, query_;
    std::string body_;
    std::vector<Label> labels_;
};

} // namespace

std::string advice_picture(const Advice& advice) { return Picture(advice).svg(); }

} // namespace boxwood::bench
