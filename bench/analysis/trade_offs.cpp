#include "bench/analysis/trade_offs.h"

#include "bench/analysis/status.h"
#include "bench/analysis/times.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace boxwood::bench {

std::vector<results::BreakEven> trade_offs_of(const results::Results& results, double floor) {
    using results::Phase;
    struct Point {
        double build, query;
        std::uint32_t cell_id;
    };
    const MedianIndex medians(results);
    std::map<std::tuple<std::uint32_t, std::string, std::uint32_t>, std::vector<Point>> jobs;
    for (const results::Cell& cell : results.cells) {
        const Point point{medians.ns(cell.cell_id, Phase::build),
                          medians.ns(cell.cell_id, Phase::query), cell.cell_id};
        if (is_right(cell.status) && !std::isnan(point.build) && !std::isnan(point.query) &&
            std::isnan(medians.ns(cell.cell_id, Phase::update)))
            jobs[{cell.scene_id, cell.task, cell.threads}].push_back(point);
    }
    std::vector<results::BreakEven> all;
    for (auto& [job, points] : jobs) {
        std::ranges::sort(points, {}, [](const Point& p) { return std::pair(p.build, p.query); });
        const Point* cheap = nullptr;
        for (const Point& dear : points) {
            if (cheap && dear.query >= cheap->query)
                continue;
            if (cheap) {
                const bool is_beyond_noise = dear.build > cheap->build * (1 + floor) &&
                                             cheap->query > dear.query * (1 + floor);
                all.push_back({cheap->cell_id, dear.cell_id,
                               is_beyond_noise
                                   ? (dear.build - cheap->build) / (cheap->query - dear.query)
                                   : results::missing});
            }
            cheap = &dear;
        }
    }
    return all;
}

} // namespace boxwood::bench
