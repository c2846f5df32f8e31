#include "bench/explaining/drawing.h"

#include "bench/io/markup.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {

void Drawing::box(const Box& box, std::string_view kind, std::string label) {
    all_.extend(box);
    boxes_.push_back({box, kind, std::move(label)});
}
void Drawing::line(Vec3<float> p, Vec3<float> q) { lines_.emplace_back(p, q); }

std::string Drawing::svg() const {
    constexpr double side = 560, margin = 24, head = 40;
    const double wide = static_cast<double>(all_.max.x) - static_cast<double>(all_.min.x);
    const double high = static_cast<double>(all_.max.y) - static_cast<double>(all_.min.y);
    const double extent = std::max({wide, high, 1e-30});
    const auto x = [&](float at) {
        return margin + side * (static_cast<double>(at) - static_cast<double>(all_.min.x)) / extent;
    };
    const auto y = [&](float at) {
        return head + side * (static_cast<double>(all_.max.y) - static_cast<double>(at)) / extent;
    };
    const double width = side + 2 * margin, height = head + side * high / extent + margin;
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
        "<title>{2}</title>\n<style>:root{{color-scheme:light dark}}rect{{fill:none;"
        "stroke-width:1.2}}text{{fill:#222}}.page{{fill:#fff}}.node{{stroke:#9a9a9a}}"
        ".first{{stroke:#0b63b5;stroke-dasharray:5 3}}.second{{stroke:#b5480b;"
        "stroke-dasharray:2 3}}.item-a{{stroke:#0b63b5;stroke-width:3}}"
        ".item-b{{stroke:#b5480b;stroke-width:3}}.ray{{stroke:#1d8a3a;stroke-width:2}}"
        "@media(prefers-color-scheme:dark){{text{{fill:#ddd}}.page{{fill:#181818}}"
        ".first,.item-a{{stroke:#6ab0f3}}.second,.item-b{{stroke:#f0935a}}}}</style>\n"
        "<rect width=\"100%\" height=\"100%\" class=\"page\"/>\n<text x=\"{3:.0f}\" y=\"24\" "
        "font-weight=\"bold\">{2} (seen along z)</text>\n",
        width, height, escaped(title_), margin);
    for (const Drawn& drawn : boxes_) {
        const Box& box = drawn.box;
        out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                           "class=\"{}\"/>\n",
                           x(box.min.x), y(box.max.y), std::max(0.5, x(box.max.x) - x(box.min.x)),
                           std::max(0.5, y(box.min.y) - y(box.max.y)), drawn.kind);
        if (!drawn.label.empty())
            out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                               (x(box.min.x) + x(box.max.x)) / 2,
                               (y(box.min.y) + y(box.max.y)) / 2 + 4, drawn.label);
    }
    for (const auto& [p, q] : lines_)
        out += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" class=\"ray\"/>\n", x(p.x),
                           y(p.y), x(q.x), y(q.y));
    return out + "</svg>\n";
}

} // namespace boxwood::bench
