#include "bench/analysis/trade_offs.h"

#include "bench/analysis/job.h"
#include "bench/analysis/status.h"
#include "bench/analysis/times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace boxwood::bench {

std::vector<results::BreakEven> trade_offs_of(const results::Results& results, double floor) {
    using results::Phase;
    struct Point {
        double build, query;
        std::uint32_t cell_id;
    };
    const MedianIndex medians(results);
    std::map<JobKey, std::vector<Point>> jobs;
    for (const results::Cell& cell : results.cells) {
        const Point point{medians.ns(cell.cell_id, Phase::build),
                          medians.ns(cell.cell_id, Phase::query), cell.cell_id};
        if (is_right(cell.status) && !std::isnan(point.build) && !std::isnan(point.query) &&
            std::isnan(medians.ns(cell.cell_id, Phase::update)))
            jobs[job_of(cell)].push_back(point);
    }
    std::vector<results::BreakEven> all;
    for (auto& [job, points] : jobs) {
        std::ranges::sort(points, {}, [](const Point& p) { return std::pair(p.build, p.query); });
        const Point* cheap = nullptr;
        for (const Point& dear : points) {
            if (cheap && dear.query >= cheap->query)
                continue;
            if (!cheap) {
                all.push_back({results::no_id, dear.cell_id, results::missing});
            } else {
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

void set_tree_fronts(results::Results& results, double floor) {
    struct Point {
        double build, cost;
        results::TreeRow* tree;
    };
    const MedianIndex medians(results);
    std::map<std::uint32_t, results::TreeRow*> trees;
    for (results::TreeRow& tree : results.trees) {
        tree.on_front = 0;
        trees[tree.cell_id] = &tree;
    }
    std::map<JobKey, std::vector<Point>> jobs;
    for (const results::Cell& cell : results.cells) {
        const double build = medians.ns(cell.cell_id, results::Phase::build);
        const auto tree = trees.find(cell.cell_id);
        if (is_right(cell.status) && !std::isnan(build) && tree != trees.end() &&
            tree->second->sah_cost > 0)
            jobs[job_of(cell)].push_back({build, tree->second->sah_cost, tree->second});
    }
    for (auto& [job, points] : jobs) {
        std::ranges::sort(points, {}, [](const Point& p) { return std::pair(p.build, p.cost); });
        std::vector<const Point*> front;
        for (const Point& point : points) {
            if (!front.empty() && point.cost >= front.back()->cost)
                continue;
            while (!front.empty() && point.build <= front.back()->build * (1 + floor))
                front.pop_back(); // as quick for all that is known, and a worse tree
            front.push_back(&point);
        }
        for (const Point* point : front)
            point->tree->on_front = 1;
    }
}

} // namespace boxwood::bench
