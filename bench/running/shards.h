#pragma once

#include "results/results.h"

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace boxwood::bench {

/// Held by one process at a time: a file that names its holder and is gone with it. Throws BadInput
/// with `message` and the holder if another process has it.
class Lock {
  public:
    Lock(std::filesystem::path file, const std::string& message);
    ~Lock();
    Lock(const Lock&) = delete;

  private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

/// The finished parts of one sweep on one machine state: files in
/// `<OUT>.shards/<sweep_hash>-<env_hash>/`, so that parts of another sweep are neither taken for
/// its own nor lost.
class Shards {
  public:
    Shards(const std::filesystem::path& out, std::string sweep_hash, std::string env_hash);
    /// Folders that are empty go.
    ~Shards();

    /// Makes the folder, sees that it takes data and keeps other sweeps from OUT. Throws BadInput
    /// if not: no such place, no permission, no space, another sweep.
    void open();

    std::filesystem::path sweep_file() const { return folder_ / "sweep.toml"; }
    std::filesystem::path prepared_file() const { return folder_ / "prepare.h5"; }
    std::filesystem::path round_file(unsigned round) const;
    const std::filesystem::path& folder() const { return folder_; }

    /// The preparation and the rounds that are there, whole, and of this sweep and machine.
    std::optional<results::Results> prepared() const { return read(prepared_file()); }
    std::map<unsigned, results::Results> rounds() const;

    /// Whether results are of this sweep and of this machine state.
    bool belongs(const results::Results& results) const;

    /// Deletes this sweep's folder, and the one around it if nothing else is in it.
    void remove();

  private:
    std::optional<results::Results> read(const std::filesystem::path& file) const;

    std::filesystem::path all_, folder_;
    std::optional<Lock> lock_;
    std::string sweep_hash_, env_hash_;
};

std::set<unsigned> rounds_in(const results::Results& results);

/// The results without shards, what was measured in them and what was derived: what `prepare` gave.
results::Results without_rounds(results::Results results);

} // namespace boxwood::bench
