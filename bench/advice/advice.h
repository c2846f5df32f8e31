#pragma once

#include "bench/analysis/statistics.h"
#include "results/results.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// A way to build and keep a tree, as it was timed.
struct Way {
    std::uint32_t cell_id = 0;
    std::string name;                              ///< "binned_sah.wide8", "Embree: rtc_intersect1"
    std::string builder, layout;                   ///< ours
    double build_ns = unknown, query_ns = unknown; ///< medians; all queries together
    MedianInterval build, query;                   ///< in ns
};

/// From one way of the front to the next, which takes longer to build.
struct Step {
    MedianInterval queries; ///< per build, from which on the next is the better
    PairedRatio query;      ///< the queries of the first over those of the next
};

/// Numbers of queries per build for which a peer takes less than all of ours, beyond noise.
struct Loss {
    double from = 0, to = unknown;  ///< unknown: however many
    std::vector<std::string> peers; ///< which, each once
    double query_ratio = unknown; ///< the time of its queries over that of ours that is best there
};

/// Which way to take, by the number of queries per build.
struct Advice {
    std::string task, scene;
    std::string query_word;           ///< "rays"; "queries" where one query answers all
    double n_queries = 1;             ///< of the words above, as they were timed
    unsigned threads = 1;             ///< of tree and queries
    double floor = 0;                 ///< less than this part tells no two ways apart
    std::vector<Way> ways;            ///< all right ones of ours, by rising build time
    std::vector<std::size_t> front;   ///< of them, by rising build time: what to take
    std::vector<Step> steps;          ///< between them
    std::optional<double> wanted;     ///< queries per build, if they were said
    std::size_t best = 0;             ///< of `ways`: for the wanted number, else for those timed
    std::vector<std::size_t> as_good; ///< other ways that are not told apart from it there
    std::optional<Way> rival;         ///< the best peer for that number
    PairedRatio rival_ratio;          ///< its time over that of the best
    bool is_rival_distinct = false;
    std::vector<Loss> losses; ///< by rising numbers
};

/// Of one build and so many queries.
inline double total_ns(const Advice& advice, const Way& way, double queries) {
    return way.build_ns + queries / advice.n_queries * way.query_ns;
}

/// Ways are told apart only by differences beyond noise: see decide. Of a result with one scene and
/// one task that builds and queries. Throws BadInput if no way of ours was timed and right.
Advice advise(const results::Results& results, std::optional<double> wanted = {});

/// What to take, in words, with the lines of C++ and Python that do it.
std::string advice_text(const Advice& advice);
std::string advice_json(const Advice& advice);
/// Build against query, as an SVG: the front joined, with intervals; peers beside it.
std::string advice_picture(const Advice& advice);

} // namespace boxwood::bench
