#include "bench/tasks/kernels/kernels.h"

#include "bench/tasks/kernels/kernel.h"
#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace boxwood::bench {
namespace {

std::vector<Rung> make_rungs(Ask ask) {
    switch (ask) {
    case Ask::triangle_triangle:
        return triangle_rungs();
    case Ask::ray_triangle:
        return ray_rungs();
    case Ask::ray_box:
        return ray_box_rungs();
    case Ask::vertex_face:
    case Ask::edge_edge:
        return continuous_rungs(ask);
    case Ask::obb_obb:
        return obb_rungs();
    case Ask::box_fit:
        return box_fit_rungs();
    default:
        return distance_rungs(ask);
    }
}

/// Rows and what makes them, of one ask.
struct Ladder {
    std::vector<Rung> rungs;
    std::vector<KernelInfo> infos;
};

const Ladder& ladder(Ask ask) {
    static const std::map<Ask, Ladder> all = [] {
        std::map<Ask, Ladder> ladders;
        for (const AskEntry& entry : asks()) {
            Ladder& ladder = ladders[entry.task];
            if (is_kernel_ask(entry.task))
                ladder.rungs = make_rungs(entry.task);
            for (const Rung& rung : ladder.rungs)
                ladder.infos.push_back(rung.info);
        }
        return ladders;
    }();
    return all.at(ask);
}

} // namespace

std::span<const KernelInfo> rungs(Ask ask) { return ladder(ask).infos; }

ContenderEntry rung_contender(Ask ask, std::string_view kernel) {
    const std::vector<Rung>& known = ladder(ask).rungs;
    const auto rung = std::ranges::find(known, kernel, [](const Rung& r) { return r.info.name; });
    if (rung == known.end())
        throw std::invalid_argument(
            unknown_word(std::string(to_string(ask)) + " kernel", kernel, names_of(rungs(ask))));
    ContenderEntry entry;
    entry.name = entry.kernel = kernel;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.promise = rung->info.promise;
    entry.summary = rung->info.summary;
    entry.notes = rung->asides;
    entry.precision = rung->precision;
    entry.params_json = fmt::format("{{\"family\": \"{}\", \"promise\": \"{}\"}}", to_string(ask),
                                    to_string(rung->info.promise));
    entry.unsupported = [ask](const Job& job) -> std::optional<std::string> {
        if (job.task != ask)
            return "answers " + std::string(to_string(ask)) + " only";
        if (job.executor != "serial" || job.threads != 1)
            return "runs on one thread only";
        return std::nullopt;
    };
    entry.make = [make = rung->make](const Job& job) { return make(job.scene->cases); };
    return entry;
}

} // namespace boxwood::bench
