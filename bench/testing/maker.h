#pragma once

#include "results/results.h"

#include <cstdint>
#include <functional>
#include <string>

namespace boxwood::bench {

/// Time in ns of a cell in a round.
using Clock = std::function<double(std::uint32_t round)>;

/// A result file of bare cells of one task and scene; a round is a shard.
struct Maker {
    results::Results results;

    explicit Maker(std::uint32_t rounds, const std::string& machine = "m", std::uint64_t t0 = 0) {
        results.env.resize(1);
        results.env[0].env_hash = machine;
        results.scenes.resize(1);
        results.scenes[0].content_hash = 11;
        for (std::uint32_t round = 0; round < rounds; ++round) {
            results::Shard shard;
            shard.shard_id = shard.round = round;
            shard.t0_utc_ns = t0 + round;
            results.shards.push_back(shard);
        }
    }
    std::uint32_t cell(const std::string& name, bool is_peer,
                       results::Status status = results::Status::exact) {
        const auto id = static_cast<std::uint32_t>(results.cells.size());
        results::Variant variant;
        variant.variant_id = id;
        variant.name = name;
        variant.is_peer = is_peer;
        results.variants.push_back(variant);
        results::Cell cell;
        cell.cell_id = cell.variant_id = id;
        cell.name = name;
        cell.task = "pairs";
        results.cells.push_back(cell);
        results::Check check;
        check.cell_id = id;
        check.status = status;
        if (status != results::Status::unchecked)
            results.checks.push_back(check);
        return id;
    }
    void time(std::uint32_t cell, results::Phase phase, const Clock& ns, std::uint32_t flags = 0) {
        for (const auto& shard : results.shards) {
            results::Sample sample;
            sample.cell_id = cell;
            sample.shard_id = shard.shard_id;
            sample.round = shard.round;
            sample.phase = phase;
            sample.wall_ns = ns(shard.round);
            sample.flags = flags;
            results.samples.push_back(sample);
        }
    }
};

inline Clock steady(double ns) {
    return [ns](std::uint32_t round) { return ns * (1 + 0.001 * (round * 7 % 5)); };
}

} // namespace boxwood::bench
